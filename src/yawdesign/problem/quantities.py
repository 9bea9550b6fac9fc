"""Quantities: texts such as ``626.48 kN/m`` into SI numbers that remember what was written, and back.

So exact arithmetic sees 626.48 and not its nearest double.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from numbers import Rational

from .units import LOWERED, MOST_CHARACTERS, RAISED, UnitError, kind_of, parse_unit, shortened

_GAP = r"[ _\u2009\u202f\u00a0]"
_NUMBER = re.compile(
    rf"""\s*(?P<number>[+\-\u2212]?
         (?:(?P<whole>[0-9]{{1,3}}(?:{_GAP}[0-9]{{3}})+(?![0-9])|[0-9]+)
            (?:\.(?P<part>(?:[0-9]{{3}}{_GAP})*(?!1\s*/)[0-9]{{1,3}}(?![0-9])|[0-9]*))?
          |\.(?P<bare>[0-9]+)))
         (?:[eE](?P<tens>[+-]?[0-9]+)
          |\s*[×·⋅*x]\s*10(?:(?:\^|\*\*)(?P<power>[+\-\u2212]?[0-9]+)|(?P<raised>{RAISED})))?""",
    re.VERBOSE,
)
_MOST_DIGITS, _MOST_TENS = 60, 400


class Written(float):
    """A float that remembers the exact number as it was written.

    Parameters
    ----------
    value : Fraction, int, str or float
        The number; a float stands for its shortest decimal.

    Examples
    --------
    >>> w = Written("626.48")
    >>> w, w.exact, w + 0.5
    (626.48, Fraction(15662, 25), 626.98)
    """

    __slots__ = ("exact",)
    exact: Fraction

    def __new__(cls, value: Fraction | float | str) -> Written:
        """Make the nearest double of `value`."""
        fraction = Fraction(value) if isinstance(value, str) else exact(value)
        self = super().__new__(cls, fraction)
        self.exact = fraction
        return self

    def __reduce__(self) -> tuple[type[Written], tuple[Fraction]]:
        return Written, (self.exact,)


def exact(value: Fraction | float) -> Fraction:
    """Return the exact number that `value` stands for.

    Parameters
    ----------
    value : Written, int, Fraction or float
        A plain float stands for its shortest written decimal.

    Returns
    -------
    Fraction
        The exact number.

    Examples
    --------
    >>> exact(626.48), exact(Written(Fraction(1, 3)))
    (Fraction(15662, 25), Fraction(1, 3))
    """
    if isinstance(value, Written):
        return value.exact
    if isinstance(value, Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    return Fraction(repr(float(value)))


def split_quantity(text: str) -> tuple[Fraction, str]:
    """Split a text into its number and its unit, which may be empty.

    Examples
    --------
    >>> split_quantity("1 046 770 N s/m")
    (Fraction(1046770, 1), 'N s/m')
    """
    match = _NUMBER.match(text[:MOST_CHARACTERS])
    if match is None:
        raise UnitError(f"{shortened(text.strip())!r} is not a number with a unit, such as 626.48 kN/m")
    tens = (match["tens"] or match["power"] or match["raised"] or "0").translate(LOWERED)
    _check_number(text, match, tens)
    digits = re.sub(_GAP, "", match["number"]).replace("\u2212", "-")
    return Fraction(f"{digits}e{tens}"), text[match.end() :].strip()


def _check_number(text: str, match: re.Match[str], tens: str) -> None:
    rest = text[match.end() :]
    if len(text) > MOST_CHARACTERS or sum(char.isdigit() for char in match["number"]) > _MOST_DIGITS:
        raise UnitError(f"{shortened(text)} is too long for a number with a unit")
    if rest.startswith((",", "'", "’")):
        sign = "a comma" if rest[0] == "," else "an apostrophe"
        raise UnitError(f"{shortened(text)} has {sign}: write the decimal point as '.', group digits with blanks")
    if re.match(rf"\^|\*\*|{RAISED}", rest):
        raise UnitError(f"{shortened(text)} is not one number: a power of ten is written 1e6 or 1×10^6")
    if re.match(rf"{_GAP}?[0-9.](?!\s*/)", rest):
        raise UnitError(f"{shortened(text)} is not one number: digits are grouped in threes, as in 1 046 770.5")
    if abs(int(tens)) > _MOST_TENS:
        raise UnitError(f"{shortened(text)} is too large or too small to compute with")


def parse_quantity(text: str, unit: str | None = None) -> Written:
    """Convert a text with a unit into its SI number.

    Parameters
    ----------
    text : str
        A number and a unit, such as ``"626.48 kN/m"``; a number alone is SI.
    unit : str, optional
        Any unit of the expected dimension. Without it every dimension is right.

    Returns
    -------
    Written
        The value in SI.

    Raises
    ------
    ProblemError
        If the text is no quantity or has another dimension.

    Examples
    --------
    >>> parse_quantity("300 km/h", "m/s"), parse_quantity("300 km/h").exact
    (83.33333333333333, Fraction(250, 3))
    """
    number, written_unit = split_quantity(text)
    size = parse_unit(written_unit) if written_unit else parse_unit(unit or "")
    if unit is not None and size.dimension != parse_unit(unit).dimension:
        raise UnitError(f"{shortened(text)} is {kind_of(written_unit)}, expected {kind_of(unit)} such as {unit}")
    return _in_doubles(number * (size.factor if written_unit else 1), text)


def _in_doubles(value: Fraction, text: str) -> Written:
    try:
        written = Written(value)
    except OverflowError:
        raise UnitError(f"{shortened(text)} is too large to compute with") from None
    if value and not written:
        raise UnitError(f"{shortened(text)} is too small to compute with")
    return written


def to_unit(value: float, unit: str) -> float:
    """Convert an SI value into a unit.

    Examples
    --------
    >>> to_unit(626480.0, "kN/m")
    626.48
    """
    factor = parse_unit(unit).factor
    return float(exact(value) / factor) if math.isfinite(value) else float(value)


def format_number(value: float, digits: int = 6) -> str:
    """Return a number with its digits grouped in threes, or as a power of ten where that reads better.

    Examples
    --------
    >>> format_number(1046770.0), format_number(1e18), format_number(0.7465)
    ('1 046 770', '1e+18', '0.7465')
    """
    if value == 0 or not math.isfinite(value):
        return f"{value:g}".replace("-0", "0")
    if not 1e-4 <= abs(value) < 1e9:
        return f"{value:.{digits}g}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    rounded = f"{float(f'{value:.{digits}g}'):,.{decimals}f}".replace(",", " ")
    return rounded.rstrip("0").rstrip(".") if "." in rounded else rounded


def format_quantity(value: float, unit: str, digits: int = 6) -> str:
    """Return an SI value as a text in a unit.

    Parameters
    ----------
    value : float
        The value in SI.
    unit : str
        The unit to show; ``"-"`` or an empty text for a plain number.
    digits : int
        Significant digits.

    Returns
    -------
    str
        Number and unit.

    Examples
    --------
    >>> format_quantity(626480.0, "kN/m"), format_quantity(300 / 3.6, "km/h"), format_quantity(0.15, "-")
    ('626.48 kN/m', '300 km/h', '0.15')
    """
    return f"{format_number(to_unit(value, unit), digits)} {unit.strip('-')}".strip()


def decimal_text(value: Fraction | float, unit: str = "") -> str:
    """Return the decimal of an SI value in a unit: exact, if it was written so, or else the shortest for its double.

    Parameters
    ----------
    value : Written, Fraction, int or float
        The value in SI.
    unit : str
        The unit to show; ``"-"`` or an empty text for a plain number.

    Examples
    --------
    >>> decimal_text(Written("626480"), "kN/m"), decimal_text(300 / 3.6, "km/h"), decimal_text(Written("0.1"), "%")
    ('626.48', '300', '10')
    """
    wanted, size = exact(value), parse_unit(unit).factor
    meant = None if wanted == Fraction(repr(float(value))) else _digits(wanted / size)
    if meant is None:
        near = float(wanted / size)
        texts = (f"{near:.{digits}g}" for digits in (15, 16, 17))
        shortest = next((text for text in texts if float(Fraction(text) * size) == float(value)), None)
        meant = _digits(Fraction(shortest)) if shortest else _digits(wanted / size)
    if meant is None:
        raise ValueError(f"{wanted} has no decimal in {unit}")
    return _spelled_out(*meant)


def _digits(value: Fraction) -> tuple[int, int] | None:
    """Return whole digits and a power of ten, if a number is a decimal that is not too long."""
    rest, twos, fives = value.denominator, 0, 0
    while rest % 2 == 0:
        rest, twos = rest // 2, twos + 1
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    if rest != 1:
        return None
    tens = max(twos, fives)
    whole = value.numerator * 2 ** (tens - twos) * 5 ** (tens - fives)
    power = -tens
    while whole and whole % 10 == 0:
        whole, power = whole // 10, power + 1
    return (whole, power) if len(str(abs(whole))) <= _MOST_DIGITS else None


def _spelled_out(whole: int, power: int) -> str:
    """Return a decimal with its digits in groups, or as a power of ten where that reads better."""
    digits, sign = str(abs(whole)), "-" if whole < 0 else ""
    if not -4 <= len(digits) + power <= 12:  # digits before the point
        return f"{sign}{digits[0]}{'.' * (len(digits) > 1)}{digits[1:]}e{power + len(digits) - 1}"
    digits += "0" * max(0, power)
    before, after = (digits[:power], digits[power:]) if power < 0 else (digits, "")
    if power < 0 and len(digits) <= -power:
        before, after = "0", digits.rjust(-power, "0")
    return f"{sign}{int(before):,}".replace(",", " ") + (f".{after}" if after else "")

"""Units such as ``kN·m/rad``: their exact size in SI and their dimension."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache

from .diagnostics import ProblemError, nearest

Dimension = tuple[int, int, int]  # powers of kg, m and s


# Bounds of what is computed with: texts come from anywhere.
MOST_CHARACTERS, MOST_BRACKETS, MOST_BITS, MOST_POWERS = 200, 9, 1000, 1000


class UnitError(ProblemError):
    """A text that is no quantity, or a quantity of the wrong dimension."""


def shortened(text: str) -> str:
    """Return a text that fits into a message."""
    return text if len(text) <= 40 else f"{text[:30]} ... ({len(text)} characters)"


@dataclass(frozen=True)
class Unit:
    """A unit: its size in SI, its dimension as powers of kg, m and s, and the power of its angles.

    Angles have no dimension; their power tells what is counted per radian from what is counted per turn.
    """

    factor: Fraction
    dimension: Dimension = (0, 0, 0)
    angle: int = 0

    def times(self, other: Unit, power: int = 1) -> Unit:
        """Return this unit times `other` to a whole `power`."""
        kg, m, s = (one + power * two for one, two in zip(self.dimension, other.dimension, strict=True))
        return Unit(self.factor * other.factor**power, (kg, m, s), self.angle + power * other.angle)

    @property
    def bounded(self) -> bool:
        """Whether size and powers are small enough to go on with."""
        bits = max(self.factor.numerator.bit_length(), self.factor.denominator.bit_length())
        return bits <= MOST_BITS and max(map(abs, (*self.dimension, self.angle))) <= MOST_POWERS


_ONE = Unit(Fraction(1))
_PREFIXES = {"": 0, "n": -9, "u": -6, "µ": -6, "μ": -6, "m": -3, "k": 3, "M": 6, "G": 9}
_PREFIXED = {
    "m": Unit(Fraction(1), (0, 1, 0)),
    "g": Unit(Fraction(1, 1000), (1, 0, 0)),
    "s": Unit(Fraction(1), (0, 0, 1)),
    "N": Unit(Fraction(1), (1, 1, -2)),
    "Hz": Unit(Fraction(1), (0, 0, -1)),
    "J": Unit(Fraction(1), (1, 2, -2)),
    "W": Unit(Fraction(1), (1, 2, -3)),
    "Pa": Unit(Fraction(1), (1, -1, -2)),
    "rad": Unit(Fraction(1), angle=1),
}
_POUND, _INCH, _GRAVITY = Fraction("0.45359237"), Fraction("0.0254"), Fraction("9.80665")  # by definition
_UNITS = {
    **{
        prefix + name: Unit(unit.factor * Fraction(10) ** tens, unit.dimension, unit.angle)
        for name, unit in _PREFIXED.items()
        for prefix, tens in _PREFIXES.items()
    },
    "cm": Unit(Fraction(1, 100), (0, 1, 0)),
    "dm": Unit(Fraction(1, 10), (0, 1, 0)),
    "t": Unit(Fraction(1000), (1, 0, 0)),
    "min": Unit(Fraction(60), (0, 0, 1)),
    "h": Unit(Fraction(3600), (0, 0, 1)),
    "mph": Unit(Fraction("0.44704"), (0, 1, -1)),
    "kgf": Unit(_GRAVITY, (1, 1, -2)),
    "lbf": Unit(_POUND * _GRAVITY, (1, 1, -2)),
    "lb": Unit(_POUND, (1, 0, 0)),
    "in": Unit(_INCH, (0, 1, 0)),
    "ft": Unit(12 * _INCH, (0, 1, 0)),
    "deg": Unit(Fraction(math.pi) / 180, angle=1),
    "°": Unit(Fraction(math.pi) / 180, angle=1),
    "%": Unit(Fraction(1, 100)),
    "1": _ONE,
}
_SLIPS = {"kmh": "km/h", "kph": "km/h", "kmph": "km/h", "sec": "s", "hr": "h", "kp": "kgf"}
_KINDS: dict[Dimension, tuple[str, str]] = {
    (0, 0, 0): ("a plain number", "-"),
    (1, 0, 0): ("a mass", "kg"),
    (0, 1, 0): ("a length", "m"),
    (0, 0, 1): ("a time", "s"),
    (0, 0, -1): ("a rate", "1/s"),
    (0, 1, -1): ("a speed", "m/s"),
    (1, 2, 0): ("a moment of inertia", "kg·m²"),
    (1, 1, -2): ("a force", "N"),
    (1, 0, -2): ("a stiffness", "N/m"),
    (1, 2, -2): ("a yaw stiffness", "N·m/rad"),
    (1, 0, -1): ("a damping", "N·s/m"),
    (1, 2, -1): ("a yaw damping", "N·s·m/rad"),
}
_LETTER = r"[^\W\d_]"
# A full stop is a sign of multiplication between two units that touch it, as in kN.s; elsewhere it belongs to a number.
_TOKEN = re.compile(rf"\s*(\*\*|\^|[*·⋅×/()]|(?<=[\w)])\.(?={_LETTER}|\()|[+-]?[0-9]+|{_LETTER}+|[°%])")
_TOUCHING = re.compile(rf"(?<={_LETTER})(?=[+-]?[0-9])")  # m2 is m^2
RAISED = "[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+"
LOWERED = str.maketrans("⁺⁻\u2212⁰¹²³⁴⁵⁶⁷⁸⁹", "+--0123456789")
_TIMES = frozenset("*·⋅×.")


@lru_cache(maxsize=512)
def parse_unit(text: str) -> Unit:
    """Parse a unit such as ``kN s/m``, ``kN·m/rad``, ``kg m^2`` or ``N/(m/s)``.

    Examples
    --------
    >>> parse_unit("km/h").factor
    Fraction(5, 18)
    """
    if text.strip() in ("", "-"):
        return _ONE
    if len(text) > MOST_CHARACTERS:
        raise UnitError(f"{shortened(text)!r} is too long for a unit")
    if text.count("(") > MOST_BRACKETS:
        raise UnitError(f"{shortened(text)!r} has more than {MOST_BRACKETS} brackets")
    tokens = _tokens(text)
    unit = _product(tokens, text)
    if tokens:
        raise UnitError(f"{shortened(text)!r} has a bracket too many")
    return unit


def _tokens(text: str) -> list[str]:
    """Return the tokens in reverse, so that the next one is popped off the end."""
    found: list[str] = []
    text = re.sub(RAISED, lambda raised: f"^{raised[0].translate(LOWERED)}", text.rstrip())
    text = _TOUCHING.sub("^", text)
    position = 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise UnitError(f"{text[position:].strip()[:20]!r} is not part of a unit")
        found.append(match[1])
        position = match.end()
    return found[::-1]


def _product(tokens: list[str], text: str) -> Unit:
    result, divided = _power(tokens, text), False
    while tokens and tokens[-1] != ")":
        sign = tokens.pop() if tokens[-1] in _TIMES or tokens[-1] == "/" else "*"
        if divided and sign != "/":
            raise UnitError(f"{shortened(text)!r} can be read in two ways: put what is divided by in brackets, N/(m/s)")
        divided = divided or sign == "/"
        result = _bounded(result.times(_power(tokens, text), -1 if sign == "/" else 1), text)
    return result


def _power(tokens: list[str], text: str) -> Unit:
    base = _atom(tokens, text)
    if not tokens or tokens[-1] not in ("^", "**"):
        return base
    tokens.pop()
    digits = tokens.pop() if tokens else ""
    if not re.fullmatch(r"[+-]?[0-9]", digits):
        raise UnitError(f"{shortened(text)!r} has a power that is not a small whole number")
    return _bounded(_ONE.times(base, int(digits)), text)


def _bounded(unit: Unit, text: str) -> Unit:
    if not unit.bounded:
        raise UnitError(f"{shortened(text)!r} is too large or too small a unit to compute with")
    return unit


def _atom(tokens: list[str], text: str) -> Unit:
    name = tokens.pop() if tokens else ""
    if name == "(":
        inner = _product(tokens, text)
        if not tokens:
            raise UnitError(f"{shortened(text)!r} lacks a closing bracket")
        tokens.pop()
        return inner
    if name in _UNITS:
        return _UNITS[name]
    raise UnitError(f"{shortened(text)!r} is not a known unit{_meant(name)}")


def _meant(name: str) -> str:
    found = _SLIPS.get(name) or next((unit for unit in _UNITS if unit.casefold() == name.casefold()), None)
    found = found or _parted(name[:6]) or (nearest(name, _UNITS) if len(name) > 1 else None)
    return f"; did you mean {found}?" if found else ""


def _parted(name: str) -> str | None:
    """Return the units that a short name consists of with blanks between them, the longest first: ``N mm``.

    No two of them measure the same: ``kgg`` is a slip of kg, not kg g.
    """
    if name in _UNITS:
        return name
    parts = ((name[:k], _parted(name[k:])) for k in range(len(name) - 1, 0, -1) if name[:k] in _UNITS)
    return next((f"{first} {rest}" for first, rest in parts if rest and not _alike(first, rest)), None)


def _alike(unit: str, others: str) -> bool:
    return any(_UNITS[unit].dimension == _UNITS[other].dimension for other in others.split())


@cache
def si_unit(unit: str) -> str:
    """Return the name of the SI unit of the same dimension.

    Examples
    --------
    >>> si_unit("MN/m")
    'N/m'
    """
    dimension = parse_unit(unit).dimension
    return _KINDS[dimension][1] if dimension in _KINDS else _spelled(dimension)


def _spelled(dimension: Dimension) -> str:
    return " ".join(f"{name}^{power}" for name, power in zip(("kg", "m", "s"), dimension, strict=True) if power)


def kind_of(unit: str) -> str:
    """Return what a unit measures, such as ``"a stiffness"``."""
    dimension = parse_unit(unit).dimension
    return _KINDS[dimension][0] if dimension in _KINDS else f"measured in {_spelled(dimension)}"


def unit_names(dimension: Dimension | None = None) -> tuple[str, ...]:
    """Return the names of all units, or of those of one dimension."""
    return tuple(name for name, unit in _UNITS.items() if dimension in (None, unit.dimension))

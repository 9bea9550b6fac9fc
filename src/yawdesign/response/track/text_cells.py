"""Numbers in the cells of a table: with a decimal point or comma, and chainages written as km+m."""

import math
import re
from collections.abc import Iterable

from yawdesign.problem.diagnostics import ProblemError
from yawdesign.problem.units import shortened

_NUMBER = re.compile(r"[+\-\u2212]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")
_GROUPED = re.compile(r"[+\-\u2212]?[1-9][0-9]{0,2}(?:,[0-9]{3})+")
_CHAINAGE = re.compile(r"([0-9]+)\+([0-9]{3}(?:[.,][0-9]*)?)")


def number(text: str) -> float:
    """Return the number that stands in a cell.

    Raises
    ------
    ProblemError
        If there is none, or none that can be computed with.

    Examples
    --------
    >>> number("-2.5e-3"), number("0,25")
    (-0.0025, 0.25)
    """
    if not text:
        raise ProblemError("the value is missing")
    if not _NUMBER.fullmatch(text):
        raise ProblemError(f"{shortened(text)!r} is not a number")
    found = float(text.replace(",", ".").replace("\u2212", "-"))
    if math.isinf(found):
        raise ProblemError(f"{shortened(text)!r} is too large to compute with")
    if not found and re.search("[1-9]", re.split("[eE]", text)[0]):
        raise ProblemError(f"{shortened(text)!r} is too small to compute with")
    return found


def chainage(text: str) -> float | None:
    """Return the metres of a chainage such as ``12+345.6``, or None where no + stands between digits.

    Raises
    ------
    ProblemError
        If the metres are not written with three digits.
    """
    if "+" not in re.sub(r"[eE]\+", "", text[1:]):
        return None
    found = _CHAINAGE.fullmatch(text)
    if not found:
        raise ProblemError(f"{shortened(text)!r} is not kilometres, + and three digits of metres, such as 12+034.5")
    return 1000 * number(found[1]) + number(found[2])


def comma_mistake(texts: Iterable[str]) -> str | None:
    """Return why the commas in the cells of a table cannot be read as decimal signs, or None.

    Examples
    --------
    >>> comma_mistake(["0,25", "1,435"]), comma_mistake(["0,25", "1.5"]) is None
    (None, False)
    """
    listed = list(texts)
    commas = [text for text in listed if "," in text]
    if commas and any("." in text for text in listed):
        return "has a comma, other numbers have a point: write all decimal signs alike, and none between thousands"
    if commas and all(_GROUPED.fullmatch(text) for text in commas):
        plain, point = commas[0].replace(",", ""), commas[0].replace(",", ".", 1)
        return f"may be {point} or {plain}: write the decimal sign as '.', and none between thousands"
    return None

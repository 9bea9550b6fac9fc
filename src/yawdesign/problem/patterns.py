"""Regular expressions for the schema: what an editor can tell of a unit.

No regular expression knows the dimension of every product of units. These refuse names that are no units, and the usual
ways to write what another kind of quantity is measured in; whatever else is written is left to the reader of the file.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache
from itertools import permutations

from .units import parse_unit, unit_names

# What engineers write, in any order of what is multiplied; each unit stands for all units of its dimension.
_USUAL = (
    *("kg", "m", "s", "N", "J", "W", "Pa", "Hz", "mph", "m/s", "1/s", "rad", "1/rad", "rad/s"),
    *("kg m^2", "kg m/s^2", "kg/s^2", "kg m^2/s^2", "kg/s", "kg m^2/s"),
    *("N/m", "N/rad", "N m", "N m/rad", "N s", "N s/m", "N/(m/s)", "N s m", "N s m/rad", "N m/(rad/s)"),
    *("m^2", "m/s^2", "kg/m", "N/m^2", "N s/m^2", "N s^2/m"),
)
_SIGNS = r"*·⋅×."
_TIMES = rf"(?:\s*[{_SIGNS}]\s*|\s+)"
_SQUARED = r"(?:\s*(?:\^|\*\*)\s*2|2|²)"
_LETTER = "[A-Za-zµμ]"


@cache
def unit_pattern(unit: str) -> str:
    """Return a regular expression of what may be written in place of a unit, nothing included.

    Parameters
    ----------
    unit : str
        Any unit of the right dimension.

    Examples
    --------
    >>> pattern = re.compile(unit_pattern("kg"))
    >>> [bool(pattern.fullmatch(text)) for text in ("t", "N s^2/m", "kN", "parsec")]
    [True, True, False, False]
    """
    dimension = parse_unit(unit).dimension
    wrong = [_spelled(usual) for usual in _USUAL if parse_unit(usual).dimension != dimension]
    plain = "" if any(dimension) else "-|"
    return rf"(?:{plain}(?!(?:{'|'.join(wrong)})\s*$){_expression()})?"


def _expression() -> str:
    """Return the pattern of units joined in any way; numbers stand only where they cannot belong to the quantity."""
    names = rf"(?:{_either([name for name in unit_names() if name != '1'])})(?!{_LETTER})"
    inside = rf"{names}|[()/*^{_SIGNS}]|[-+\u2212]?\d|[⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹]|\s"
    return rf"(?:1\s*/\s*)?(?:{names}|\()(?:{inside})*"


def _spelled(usual: str) -> str:
    """Return the pattern of a usual spelling: above the stroke in any order, below it as it stands."""
    above, stroke, below = usual.partition("/")
    factors = [_factor(factor) for factor in above.split()]
    orders = "|".join(_TIMES.join(order) for order in permutations(factors))
    return rf"(?:{orders}){_below(below) if stroke else ''}"


def _below(text: str) -> str:
    parts = [_factor(part) for part in text.strip("()").split("/")]
    divided = r"\s*/\s*".join(parts)
    return r"\s*/\s*" + (rf"\({divided}\)" if text.startswith("(") else divided)


def _factor(text: str) -> str:
    name, _, power = text.partition("^")
    alike = unit_names(parse_unit(name).dimension) if name != "1" else (name,)
    return f"(?:{_either(alike)})" + (_SQUARED if power else "")


def _either(names: Collection[str]) -> str:
    """Return the pattern of the names; those that differ in the first letter only are put together."""
    heads = {name: "".join(other[0] for other in names if other[1:] == name) for name in names}
    alone = (name for name in names if name[1:] not in names)
    return "|".join((f"[{heads[name]}]?" if heads[name] else "") + re.escape(name) for name in alone)

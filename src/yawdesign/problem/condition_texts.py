"""What conditions vary, in words: a value, or several, or a range of values, by the names of a problem file."""

from collections.abc import Sequence
from typing import Any

from .condition import CREEP_FACTOR, TOLERANCE
from .parameters import PARAMETERS
from .quantities import format_number, format_quantity

DIGITS = 4
SHOWN = 3  # values that are listed; of more, the ends and how many


def change_text(name: str, *values: Any) -> str:
    """Return in words what one name of a condition is.

    Parameters
    ----------
    name : str
        A parameter, ``speed`` or ``v``, ``creep_factor``, ``tolerance.K_m`` or ``load``.
    *values : float or str
        In SI units; a load by its name. Several are alternatives.

    Examples
    --------
    >>> change_text("tolerance.K_m", -0.1), change_text("speed", 300 / 3.6), change_text("lambda", 0.05, 0.1)
    ('K_m -10 %', '300 km/h', 'lambda 0.05, 0.1')
    """
    before, unit = _shape_of(name)
    texts = [_number(name, value, unit) for value in values]
    many = len(texts) > SHOWN and name != "load"
    shown = f"{texts[0]} ... {texts[-1]} ({len(texts)} values)" if many else ", ".join(texts)
    return f"{before} {shown} {unit.strip('-')}".strip()


def range_text(name: str, ends: Sequence[float]) -> str:
    """Return in words which values of one name of a condition a range holds. Parameters as in `change_text`.

    Examples
    --------
    >>> range_text("v", (200 / 3.6, 300 / 3.6)), range_text("tolerance.K_m", (-0.1, 0.1))
    ('200 ... 300 km/h', 'K_m -10 ... +10 %')
    """
    before, unit = _shape_of(name)
    low, high = (_number(name, end, unit) for end in ends)
    return f"{before} {low} ... {high} {unit.strip('-')}".strip()


def _shape_of(name: str) -> tuple[str, str]:
    """Return what stands before a value, and its unit."""
    if name in ("speed", "v"):
        return "", "km/h"
    if name == CREEP_FACTOR.key:
        return "creep x", "-"
    if name.startswith(TOLERANCE):
        return name.removeprefix(TOLERANCE), "%"
    return name, PARAMETERS[name].unit if name in PARAMETERS else "-"


def _number(name: str, value: Any, unit: str) -> str:
    if isinstance(value, str):
        return value
    sign = "+" if unit == "%" and value > 0 else ""
    text = format_number(100 * value, DIGITS) if unit == "%" else format_quantity(value, unit, DIGITS)
    return sign + text.removesuffix(unit.strip("-")).strip()

"""The axes of a sweep: how they are written, and what each does to the parameters."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi, prod
from typing import Any, cast

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import PARAMETERS, Parameter, ProblemError, format_quantity
from yawdesign.problem.condition import CREEP, CREEP_FACTOR, Condition
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.running import CURVE, SPEED
from yawdesign.problem.table import as_count, check_ends

MOST_VALUES = 10_000_000  # on one axis

# Axes that are no parameters of Table I; eq. (12) of the paper for the first two.
DERIVED = {
    "f_m": Parameter(
        key="f_m",
        symbol=r"f_\mathrm{m}",
        unit="Hz",
        meaning="lateral natural frequency of the motor suspension",
        hard=(0.0, 1e6),
        usual=(0.1, 100.0),
        source="3",
        motor=True,
    ),
    "xi_m": Parameter(
        key="xi_m",
        symbol=r"\xi_\mathrm{m}",
        unit="-",
        meaning="lateral damping ratio of the motor suspension",
        hard=(0.0, 1e6),
        usual=(0.01, 2.0),
        source="0.3",
        motor=True,
    ),
    "creep_factor": CREEP_FACTOR,
}
# Everything that can be an axis.
ROWS: Mapping[str, Parameter] = {**PARAMETERS, "v": replace(SPEED, key="v"), **DERIVED, **CURVE}
# What else an axis sets, beside the parameter of its name.
SETS = {"f_m": ("K_m",), "xi_m": ("C_m",), "creep_factor": CREEP}


@dataclass(frozen=True, eq=False)
class Axis:
    """An axis of a sweep.

    Parameters
    ----------
    name : str
        Key of a parameter or of a number of the curve, or ``v``, ``f_m``, ``xi_m``, ``creep_factor``.
    unit : str
        Unit of the values, SI.
    values : ndarray
        In rising order [`unit`].
    """

    name: str
    unit: str
    values: Float


def read_axis(name: str, values: object) -> Axis:
    """Return an axis of a known name; its values as in `read_values`."""
    row = ROWS[name]
    return Axis(name, "Hz" if row.unit == "Hz" else row.si, read_values(values, row))


def read_values(values: object, row: Parameter) -> Float:
    """Return the values of an axis in SI.

    Parameters
    ----------
    values : str, number or sequence
        A text ``"LOW:HIGH:N"`` or ``"LOW:HIGH:N:log"``, or numbers in SI or texts with a unit in rising order; one
        number or text is one value.
    row : Parameter
        What is varied: its unit and its range.

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    ProblemError
        If there is no value, or they do not rise, are no numbers or lie outside the hard range.

    Examples
    --------
    >>> read_values("150 km/h:450 km/h:4", ROWS["v"]) * 3.6
    array([150., 250., 350., 450.])
    >>> read_values(["1 kN s/m", 1e6], ROWS["C_s"])
    array([   1000., 1000000.])
    """
    if isinstance(values, str):
        return read_range(values, row)
    found = _numbers(values, row)
    if not found.size:
        raise ProblemError("has no values")
    _check(found, row)
    if not np.all(np.diff(found) > 0):
        k = int(np.argmin(np.diff(found) > 0))
        before, after = (format_quantity(float(x), row.unit) for x in found[k : k + 2])
        raise ProblemError(f"must rise: {after} comes after {before}")
    return found


def read_range(text: str, row: Parameter) -> Float:
    """Return the values that ``LOW:HIGH:N``, ``LOW:HIGH:N:log`` or a single ``VALUE`` stands for, in SI.

    Parameters
    ----------
    text : str
        Both ends, numbers in SI or with a unit; how many values, both ends included; ``log`` for equal ratios.
    row : Parameter
        What is varied: its unit and its range.

    Returns
    -------
    ndarray, shape (N,)

    Raises
    ------
    ProblemError
        With all that is wrong with it.
    """
    parts = [part.strip() for part in text.split(":")]
    if len(parts) == 1 and text:
        return np.array([float(row.accept(text))])
    if len(parts) not in (3, 4) or (len(parts) == 4 and parts[3] != "log"):
        raise ProblemError(f"{text!r} is no range: write LOW:HIGH:N or LOW:HIGH:N:log, such as 150 km/h:450 km/h:60")
    mistakes, ends, count = Mistakes(), (1.0, 2.0), 2
    with mistakes.under("N"):
        count = as_count(parts[2], 1, MOST_VALUES)
    with mistakes.under(""):
        ends = _ends(parts[0], parts[1], row, count)
    with mistakes.under("min"):
        if len(parts) == 4 and ends[0] <= 0:
            raise ProblemError(f"{parts[0]} is not above zero, where a logarithmic range must begin")
    mistakes.report()
    for end in parts[:2]:
        row.accept(end)
    return np.geomspace(*ends, count) if len(parts) == 4 else np.linspace(*ends, count)


def _ends(low: str, high: str, row: Parameter, count: int) -> tuple[float, float]:
    if count > 1:
        least, most = check_ends(low, high, row)
        return float(least), float(most)
    if row.check(low) != row.check(high):
        raise ProblemError(f"one value cannot be both {low} and {high}: write {low}")
    return float(row.check(low)), float(row.check(high))


def _numbers(values: object, row: Parameter) -> Float:
    try:
        found = np.asarray(values)
    except ValueError:
        raise ProblemError("is a list of lists, expected a list of values or a text LOW:HIGH:N") from None
    if found.ndim > 1:
        raise ProblemError(f"is an array of {found.ndim} dimensions, expected a list of values or a text LOW:HIGH:N")
    if found.ndim == 0:
        return np.array([row.accept(found.item())], dtype=float)
    if found.dtype.kind in "iuf":
        return found.astype(float)
    return np.array([row.accept(x) for x in cast(Iterable[Any], values)], dtype=float)


def _check(found: Float, row: Parameter) -> None:
    wrong = ~((found >= row.hard[0]) & (found <= row.hard[1]))
    if wrong.any():
        row.check(float(found[np.argmax(wrong)]))
    row.accept(float(found.max()))


def shape(axes: Sequence[Axis]) -> tuple[int, ...]:
    """Return the number of values of each axis."""
    return tuple(axis.values.size for axis in axes)


def block(axes: Sequence[Axis], start: int, stop: int) -> dict[str, Float]:
    """Return the axes' values at some points of the grid, which are counted with the last axis running fastest."""
    start, stop = max(start, 0), min(stop, prod(shape(axes)))
    places = np.unravel_index(np.arange(start, stop), shape(axes))
    return {axis.name: axis.values[place] for axis, place in zip(axes, places, strict=True)}


def applied(p: Mapping[str, float], point: Mapping[str, Any], hold: str = "C_m") -> dict[str, Any]:
    """Return the parameters at some points of a grid.

    Parameters
    ----------
    p : mapping
        The parameters of the problem in SI.
    point : mapping
        Values of the axes by name, numbers or arrays.
    hold : {"C_m", "xi_m"}
        What stays when the motors' frequency or mass changes: their damping C_m, or their damping ratio xi_m.

    Examples
    --------
    >>> p = {"M_m": 1765.0, "K_m": 626480.0, "C_m": 19950.0}
    >>> {name: round(x) for name, x in applied(p, {"f_m": 3.0, "xi_m": 0.3}).items()}
    {'M_m': 1765, 'K_m': 627115, 'C_m': 19962}
    """
    out = Condition(tuple((name, x) for name, x in point.items() if name not in ("f_m", "xi_m"))).applied(p)
    if "f_m" in point:
        out["K_m"] = out["M_m"] * (2 * pi * point["f_m"]) ** 2
    ratio = damping_ratio(p) if hold == "xi_m" else point.get("xi_m")
    if ratio is not None:
        out["C_m"] = 2 * ratio * np.sqrt(out["K_m"] * out["M_m"])
    return out


def damping_ratio(p: Mapping[str, float]) -> float:
    """Return the lateral damping ratio of the motor suspension, eq. (12)."""
    return float(p["C_m"] / (2 * np.sqrt(p["K_m"] * p["M_m"])))

"""What pictures of sweeps and of designs have in common: colours, words, scales, titles, critical curves."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import CriticalColumn
from yawdesign.output.pictures import large_numbers, literal, log_axis, quantity, wrapped
from yawdesign.output.regions import Line, chained
from yawdesign.output.style import AS_WRITTEN, critical_line
from yawdesign.problem import to_unit
from yawdesign.problem.quantities import format_number
from yawdesign.study.axes import ROWS, Axis
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = {"N·s/m": "kN·s/m", "m/s": "km/h"}  # units in which people see values
MEANING = {
    "stable": "becomes stable above",
    "unstable": "becomes unstable above",
    "neither": "unstable on both sides",
}
ON_MAP = {kind: rf"critical $C_\mathrm{{s}}$, {text}" for kind, text in MEANING.items()}
LABELS = {
    "decay_rate": "least decay rate",
    "damping_ratio": "least damping ratio",
    "critical": r"critical yaw damping $C_\mathrm{s}$",
    "C_sl": r"minimum yaw damping for stability $C_\mathrm{sl}$",
    "design": r"yaw damping $C_\mathrm{s}$ by the golden section",
    "critical_speed": "critical speed $v$",
    "stable": "",
}
LIMIT_TEXT = r"$C_\mathrm{su}$, limit of the curve"
ACROSS, UPRIGHT = 66, 34  # signs of a label in one line
OF_ONE_DAMPER = ("stable", "decay_rate", "damping_ratio", "critical_speed")  # what holds for one value of C_s
DECADES = 1000.0  # of a logarithmic scale, below its largest value
WIDE = 30.0  # ratio of values from which on a logarithmic scale reads better


def shown_unit(sweep: Sweep) -> str:
    """Return the unit in which people see the values of a sweep."""
    return "%" if sweep.quantity == "damping_ratio" else SHOWN.get(sweep.unit, sweep.unit)


def title(sweep: Sweep) -> str:
    """Return what the picture is of: the problem, and what is not on its axes."""
    problem, names = sweep.request.problem, {axis.name for axis in sweep.request.axes}
    parts = [literal(problem.title), *(f"equations {problem.equations}" for _ in range(problem.bogie.kind == "power"))]
    if problem.car_body is not None:
        parts.append("car body moving")
    parts.append(literal(sweep.conditions))
    C_s = problem.parameters().get("C_s")
    if sweep.quantity in OF_ONE_DAMPER and C_s is not None and "C_s" not in {*names, *sweep.provenance.get("at", {})}:
        parts.append(quantity("C_s", float(C_s)))
    for name, value in sweep.provenance.get("at", {}).items():
        parts.append(
            f"${ROWS[name].symbol}$ = {to_unit(value, ROWS[name].unit):.4g} {ROWS[name].unit.strip('-')}".strip()
        )
    if names & {"f_m", "M_m", "K_m"} and sweep.request.task.hold == "xi_m":
        parts.append(r"$\xi_\mathrm{m}$ held")
    elif "f_m" in names and "xi_m" not in names:
        parts.append(r"$C_\mathrm{m}$ held")
    return ", ".join(part for part in parts if part)


def shown_factor(name: str) -> float:
    """Return by what values of an axis in SI are multiplied to be seen in its unit."""
    return to_unit(1.0, ROWS[name].unit)


def axis_values(axis: Axis) -> Float:
    """Return the values of an axis in the unit in which people see it."""
    return axis.values * shown_factor(axis.name)


def axis_label(axis: Axis, signs: int = ACROSS) -> str:
    """Return the label of an axis, in lines of so many signs."""
    row = ROWS[axis.name]
    unit = f" [{row.unit}]" if row.unit != "-" else ""
    return wrapped(f"{row.meaning} ${row.symbol}${unit}", signs)


def value_label(sweep: Sweep, text: str = "") -> str:
    """Return the label of the values, for an axis that stands upright."""
    return wrapped(f"{text or LABELS[sweep.quantity]} [{shown_unit(sweep)}]", UPRIGHT)


def is_geometric(axis: Axis) -> bool:
    """Return whether the values of an axis have equal ratios."""
    x = axis.values
    return bool(x.size > 2 and x[0] > 0 and np.allclose(np.diff(np.log(x)), np.log(x[1] / x[0]), rtol=1e-3))


def scale_axis(ax: "Axes", axis: Axis, *, upright: bool = False) -> None:
    """Choose a logarithmic scale for an axis, its limits set, whose values have equal ratios."""
    if is_geometric(axis):
        log_axis(ax, upright=upright)
    else:
        large_numbers(ax.yaxis if upright else ax.xaxis)


def columns_of(sweep: Sweep, factor: float) -> list[CriticalColumn]:
    """Return all critical values at each place of the only axis."""
    values, roots = sweep.main * factor, sweep.columns["unstable_roots"]
    rows = zip(values, sweep.columns["omega"], roots, strict=True)
    return [CriticalColumn(*row) for row in rows]


def joined(pieces: list[Line]) -> list[Line]:
    """Return pieces of curves as whole lines, each to the right."""
    return chained([piece if piece[0] <= piece[-1] else piece[::-1] for piece in pieces])


def draw_lines(ax: "Axes", lines: dict[str, list[Any]], swap: bool = False, label: bool = True) -> None:
    """Draw the pieces of critical curves, coloured by what lies above them."""
    from matplotlib.collections import LineCollection

    for kind, pieces in lines.items():
        if pieces:
            lines_of_kind = joined(pieces)  # dashes go on from piece to piece
            points = [[(y, x) for x, y in line] for line in lines_of_kind] if swap else lines_of_kind
            text = MEANING[kind] if label else None
            ax.add_collection(LineCollection(points, label=text, **critical_line(kind)))


def mark_as_written(ax: "Axes", sweep: Sweep, across: str, upright: str) -> list[Any]:
    """Mark what the problem itself has, a point or several speeds, where it lies inside; return it for the legend."""
    if sweep.chart is None:
        return []
    found = [sweep.chart.as_written.get(name, ()) for name in (across, upright)]
    if not all(found):
        return []
    xs, ys = (
        [value * shown_factor(name) for value in values] for name, values in zip((across, upright), found, strict=True)
    )
    points = [(x, y) for x in xs for y in ys]
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    inside = [(x, y) for x, y in points if left <= x <= right and bottom <= y <= top]
    if not inside:
        return []
    told = ", ".join(_told(name, values) for name, values in zip((across, upright), found, strict=True))
    style = {**AS_WRITTEN, "linestyle": "solid" if len(inside) > 1 else "none"}
    return ax.plot(*zip(*(inside[0], inside[-1]), strict=True), label=f"as written: {told}", clip_on=False, **style)


def mark_place(ax: "Axes", sweep: Sweep, name: str) -> list[Any]:
    """Mark where on the axis the problem itself is, if it lies inside; return it for the legend."""
    values = () if sweep.chart is None else sweep.chart.as_written.get(name, ())
    low, high = ax.get_xlim()
    shown = [x for x in (value * shown_factor(name) for value in values) if low <= x <= high]
    if not shown:
        return []
    style = {**AS_WRITTEN, "marker": "^", "clip_on": False}
    place = ax.get_xaxis_transform()
    return ax.plot(shown, [0.0] * len(shown), transform=place, label=f"as written: {_told(name, values)}", **style)


def _told(name: str, values: tuple[float, ...]) -> str:
    row = ROWS[name]
    low, high = (format_number(to_unit(x, row.unit), 4) for x in (min(values), max(values)))
    number = low if low == high else f"{low} ... {high}"
    symbol = "" if name in ("C_s", "v") else f"${row.symbol}$ = "
    return f"{symbol}{number} {row.unit.strip('-')}".strip()

"""What pictures of sweeps and of designs have in common: colours, words, scales, titles, critical curves."""

import re
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import CriticalColumn
from yawdesign.output.pictures import literal
from yawdesign.output.style import BECOMES
from yawdesign.problem import to_unit
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
    "C_sl": r"least stable yaw damping $C_\mathrm{sl}$",
    "design": r"yaw damping $C_\mathrm{s}$",
    "critical_speed": "critical speed $v$",
    "stable": "",
}
BELOW = 36  # from axes down to a legend, past numbers and label [points]
SIGNS_BELOW, SIGNS_OF_A_MARK = 112, 9  # how many signs of a legend fit side by side, how many a mark takes
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
    for name, value in sweep.provenance.get("at", {}).items():
        parts.append(
            f"${ROWS[name].symbol}$ = {to_unit(value, ROWS[name].unit):.4g} {ROWS[name].unit.strip('-')}".strip()
        )
    if names & {"f_m", "M_m", "K_m"} and sweep.request.task.hold == "xi_m":
        parts.append(r"$\xi_\mathrm{m}$ held")
    elif "f_m" in names and "xi_m" not in names:
        parts.append(r"$C_\mathrm{m}$ held")
    return textwrap.fill(", ".join(part for part in parts if part), 90)


def axis_values(axis: Axis) -> Float:
    """Return the values of an axis in the unit in which people see it."""
    return axis.values * to_unit(1.0, ROWS[axis.name].unit)


def axis_label(axis: Axis) -> str:
    """Return the label of an axis."""
    row = ROWS[axis.name]
    unit = f" [{row.unit}]" if row.unit != "-" else ""
    return textwrap.fill(f"{row.meaning} ${row.symbol}${unit}", 70)


def is_geometric(axis: Axis) -> bool:
    """Return whether the values of an axis have equal ratios."""
    x = axis.values
    return bool(x.size > 2 and x[0] > 0 and np.allclose(np.diff(np.log(x)), np.log(x[1] / x[0]), rtol=1e-3))


def scale_axis(set_scale: Any, axis: Axis) -> None:
    """Choose a logarithmic scale for an axis whose values have equal ratios."""
    if is_geometric(axis):
        set_scale("log")


def legend_below(ax: "Axes", **options: Any) -> None:
    """Explain a picture that leaves no room inside, in as many columns as fit below it."""
    labels = [re.sub(r"[\\${}]|mathrm", "", label) for label in ax.get_legend_handles_labels()[1]]
    longest = max(map(len, labels), default=0)
    columns = max(1, min(3, SIGNS_BELOW // (longest + SIGNS_OF_A_MARK)))
    from matplotlib.transforms import ScaledTranslation

    figure: Any = ax.get_figure(root=True)
    below = ax.transAxes + ScaledTranslation(0, -BELOW / 72, figure.dpi_scale_trans)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below, ncols=columns, **options)


def columns_of(sweep: Sweep, factor: float) -> list[CriticalColumn]:
    """Return all critical values at each place of the only axis."""
    values, roots = sweep.main * factor, sweep.columns["unstable_roots"]
    rows = zip(values, sweep.columns["omega"], roots, strict=True)
    return [CriticalColumn(*row) for row in rows]


def draw_lines(ax: "Axes", lines: dict[str, list[Any]], swap: bool = False, label: bool = True) -> None:
    """Draw the pieces of critical curves, coloured by what lies above them."""
    from matplotlib.collections import LineCollection

    for kind, pieces in lines.items():
        if pieces:
            points = [[(y, x) for x, y in piece] for piece in pieces] if swap else pieces
            look = {"linestyles": "dashed", "linewidths": 1.0} if kind == "neither" else {"linewidths": 1.8}
            text = MEANING[kind] if label else None
            ax.add_collection(LineCollection(points, colors=BECOMES[kind], label=text, capstyle="round", **look))

"""Pictures of sweeps: a curve over one axis, a map over two."""

import textwrap
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import CriticalColumn, curves, stable_areas
from yawdesign.output.plots import literal, new_axes
from yawdesign.output.shown_units import shown_unit
from yawdesign.problem import ProblemError, to_unit
from yawdesign.problem.table import field_name
from yawdesign.study.axes import ROWS, Axis
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes


STABLE, UNSTABLE, UNKNOWN = "#cfe8cf", "#f4d3cf", "#d9d9d9"
COLOURS = {"stable": "#1b6e3a", "unstable": "#b2182b", "neither": "#7f7f7f"}
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
DECADES = 1000.0  # of a logarithmic scale, below its largest value
WIDE = 30.0  # ratio of values from which on a logarithmic scale reads better


def draw(sweep: Sweep, ax: "Axes | None" = None) -> "Axes":
    """Draw a sweep: over one axis the curve with all its branches, over two a map with the boundary of stability.

    An axis of a single value stands in the title.

    Parameters
    ----------
    sweep : Sweep
        Over one or two axes; of three choose a plane with `Sweep.at`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    from yawdesign.output import sweep_maps as study_maps

    check_drawn(sweep.axes)
    for axis in [axis for axis in sweep.axes if axis.values.size == 1]:
        sweep = sweep.at(**{field_name(axis.name): axis.values[0]})
    ax = new_axes(ax)
    if len(sweep.axes) == 2:
        return study_maps.draw_map(sweep, ax)
    (axis,) = sweep.axes
    x = axis_values(axis)
    {"critical": _branches, "critical_speed": _branches, "C_sl": _least, "design": _design}.get(
        sweep.quantity, _margin
    )(sweep, ax, x)
    ax.set_xlim(x[0], x[-1])
    scale_axis(ax.set_xscale, axis)
    ax.set_xlabel(axis_label(axis))
    if sweep.quantity != "stable":
        ax.set_ylabel(f"{LABELS[sweep.quantity]} [{shown_unit(sweep)}]")
    ax.set_title(title(sweep), loc="left", fontsize="medium")
    return ax


def check_drawn(axes: Sequence[Axis]) -> None:
    """Raise an error if a picture cannot show these axes: one or two of them have several values."""
    several = [axis.name for axis in axes if axis.values.size > 1]
    if not several:
        raise ProblemError("a single point has no picture: one axis needs two values or more")
    if len(several) > 2:
        text = f"{', '.join(several)} are {len(several)}: a picture has one or two axes of several values"
        raise ProblemError(f"{text}; in Python choose a plane, such as result.at(v=83.3)")


def title(sweep: Sweep) -> str:
    """Return what the picture is of: the problem, and what is not on its axes."""
    problem, names = sweep.request.problem, {axis.name for axis in sweep.request.axes}
    parts = [literal(problem.title), *(f"equations {problem.equations}" for _ in range(problem.bogie.kind == "power"))]
    if "v" not in names and sweep.quantity != "critical_speed":
        parts.append(
            " to ".join(f"{to_unit(v, 'km/h'):.4g}" for v in sorted({*problem.speeds[:1], *problem.speeds[-1:]}))
        )
        parts[-1] += " km/h"
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
    """Explain a picture that leaves no room inside."""
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, fontsize="small", frameon=False, **options)


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
            style = {"linestyles": "dashed", "linewidths": 1.0} if kind == "neither" else {"linewidths": 1.8}
            text = MEANING[kind] if label else None
            ax.add_collection(LineCollection(points, colors=COLOURS[kind], label=text, capstyle="round", **style))


def _branches(sweep: Sweep, ax: "Axes", x: Float, *, legend: bool = True) -> None:
    """Draw all critical values, and shade what is stable between them."""
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch

    columns = columns_of(sweep, to_unit(1.0, shown_unit(sweep)))
    low, high = _limits(sweep, ax)
    areas = list(stable_areas(x, columns, low, high))
    ax.add_collection(PolyCollection(areas, facecolors=STABLE, linewidths=0, antialiaseds=False, zorder=0))
    draw_lines(ax, curves(x, columns, low, high))
    handles, _ = ax.get_legend_handles_labels()
    if areas:
        handles.append(Patch(color=STABLE, label="stable"))
    if legend:
        legend_below(ax, handles=handles)


def _limits(sweep: Sweep, ax: "Axes") -> tuple[float, float]:
    """Set the limits of the ordinate, and return them."""
    factor = to_unit(1.0, shown_unit(sweep))
    found = sweep.main[np.isfinite(sweep.main)] * factor
    if sweep.quantity == "critical_speed":
        low, high = (v * factor for v in sweep.request.task.question.searched)
    elif not found.size:
        low, high = 0.0, 1000.0
    elif found.max() > WIDE * found.min():
        ax.set_yscale("log")
        low, high = max(found.min() / 2, found.max() / DECADES), found.max() * 2
    else:
        low, high = 0.0, 1.15 * found.max()
    ax.set_ylim(low, high)
    return low, high


def _least(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw the lower end of the stable interval, over all critical values where these are known."""
    y = sweep.main * to_unit(1.0, shown_unit(sweep))
    if sweep.boundary is not None:
        _branches(sweep.boundary, ax, x, legend=False)
    else:
        top = 1.15 * np.nanmax(y, initial=1.0)
        ax.fill_between(x, y, top, color=STABLE, label="stable above the curve", linewidth=0)
        ax.set_ylim(0, top)
    ax.plot(
        x,
        np.maximum(y, ax.get_ylim()[0]),
        color="black",
        linewidth=2.2,
        label=r"$C_\mathrm{sl}$ of the interval chosen",
    )
    _mark_none(ax, x, ~np.isfinite(y))
    legend_below(ax)


def _mark_none(ax: "Axes", x: Float, none: NDArray[np.bool_]) -> None:
    if none.any():
        over = ax.get_xaxis_transform()
        ax.fill_between(x, 0, 1, where=none, transform=over, color=UNSTABLE, label="stable for none", linewidth=0)


def _design(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw the design between the least stable damping and what the curve allows."""
    factor = to_unit(1.0, shown_unit(sweep))
    low, high, chosen = (sweep.columns[name] * factor for name in ("C_sl", "C_su", "C_s"))
    there = np.isfinite(chosen)
    ax.fill_between(x, low, high, where=there, color=STABLE, label="stable, and allowed in the curve", linewidth=0)
    ax.plot(x, low, color=COLOURS["stable"], label=r"$C_\mathrm{sl}$, least stable")
    ax.plot(x, high, color=COLOURS["unstable"], label=r"$C_\mathrm{su}$, limit of the curve")
    ax.plot(x, chosen, color="black", linewidth=2.2, label=r"$C_\mathrm{s}$, golden section")
    ax.set_ylim(bottom=0)
    if not there.all():
        ax.fill_between(
            x, 0, 1, where=~there, transform=ax.get_xaxis_transform(), color=UNKNOWN, label="no design", linewidth=0
        )
    legend_below(ax)


def _margin(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw a margin, or only the verdict, and shade where it is stable."""
    y = sweep.main.astype(float) - (0.5 if sweep.quantity == "stable" else 0.0)
    known = set()
    for start, stop, stable in _stretches(x, y, is_geometric(sweep.axes[0])):
        label = "_" if stable in known else "stable" if stable else "unstable"
        known.add(stable)
        ax.axvspan(start, stop, color=STABLE if stable else UNSTABLE, linewidth=0, label=label)
    if sweep.quantity == "stable":
        ax.set_yticks([])
    else:
        ax.plot(x, y * to_unit(1.0, shown_unit(sweep)), color="black", linewidth=1.8)
        ax.axhline(0, color="black", linewidth=0.8)
    legend_below(ax)


def _stretches(x: Float, y: Float, geometric: bool) -> Iterator[tuple[float, float, bool]]:
    """Yield the stretches on which the drawn curve is above zero, and those on which it is not."""
    u = np.log(x) if geometric else x
    for start, stop, y_1, y_2 in zip(u, u[1:], y, y[1:], strict=False):
        if np.isnan(y_1 + y_2):
            continue
        ends = [start, stop]
        if (y_1 > 0) != (y_2 > 0):
            ends.insert(1, start + (stop - start) * y_1 / (y_1 - y_2))
        signs = [bool(y_1 > 0), bool(y_2 > 0)] if len(ends) == 3 else [bool(y_1 > 0)]
        for (a, b), sign in zip(pairwise(np.exp(ends) if geometric else ends), signs, strict=True):
            yield float(a), float(b), sign

"""Pictures of sweeps: a curve over one axis, a map over two."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Bools, Float
from yawdesign.output.branches import CriticalColumn, curves, partners, stable_areas
from yawdesign.output.pictures import large_numbers, legend_below, log_axis, new_axes, set_title
from yawdesign.output.style import (
    BEFORE,
    CHOSEN_LINE,
    EXCLUDED,
    LIMIT_LINE,
    STABLE,
    UNKNOWN,
    UNSTABLE,
    area,
    span,
)
from yawdesign.output.sweep_maps import draw_map
from yawdesign.output.sweep_style import (
    DECADES,
    LABELS,
    LIMIT_TEXT,
    WIDE,
    axis_label,
    axis_values,
    columns_of,
    draw_lines,
    mark_as_written,
    mark_place,
    scale_axis,
    shown_factor,
    shown_unit,
    title,
    value_label,
)
from yawdesign.problem import ProblemError, to_unit
from yawdesign.problem.table import field_name
from yawdesign.study import chart
from yawdesign.study.axes import Axis
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UPRIGHT = {"critical": "C_s", "C_sl": "C_s", "design": "C_s", "critical_speed": "v"}  # what the ordinate is


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
    check_drawn(sweep.axes)
    for axis in [axis for axis in sweep.axes if axis.values.size == 1]:
        sweep = sweep.at(**{field_name(axis.name): axis.values[0]})
    ax = new_axes(ax)
    if len(sweep.axes) == 2:
        return draw_map(sweep, ax)
    (axis,) = sweep.axes
    x = axis_values(axis)
    ax.set(xlim=(x[0], x[-1]), xlabel=axis_label(axis))
    scale_axis(ax, axis)
    if sweep.quantity != "stable":
        ax.set_ylabel(value_label(sweep))
    {"critical": _branches, "critical_speed": _branches, "C_sl": _least, "design": _design}.get(
        sweep.quantity, _margin
    )(sweep, ax, x)
    _mark(ax, x, ~sweep.known, UNKNOWN, "not verified")
    handles = ax.get_legend_handles_labels()[0]
    upright = UPRIGHT.get(sweep.quantity)
    if sweep.quantity in ("critical", "C_sl"):
        handles += _limit(sweep, ax, x)
    handles += mark_as_written(ax, sweep, axis.name, upright) if upright else mark_place(ax, sweep, axis.name)
    if ax.get_yscale() == "linear":
        large_numbers(ax.yaxis)
    set_title(ax, title(sweep))
    legend_below(ax, handles)
    return ax


def check_drawn(axes: Sequence[Axis]) -> None:
    """Raise an error if a picture cannot show these axes: one or two of them have several values."""
    several = [axis.name for axis in axes if axis.values.size > 1]
    if not several:
        raise ProblemError("a single point has no picture: one axis needs two values or more")
    if len(several) > 2:
        text = f"{', '.join(several)} are {len(several)}: a picture has one or two axes of several values"
        raise ProblemError(f"{text}; in Python choose a plane, such as result.at(v=83.3)")


def _branches(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw all critical values, and shade what is stable between them."""
    factor = to_unit(1.0, shown_unit(sweep))
    low, high = _limits(sweep, ax)
    places, columns = _refined(sweep, x, factor)
    _shade(ax, places, columns, low, high)
    draw_lines(ax, curves(places, columns, low, high))


def _shade(ax: "Axes", x: Float, columns: list[CriticalColumn], low: float, high: float) -> None:
    """Fill what is stable, and hatch all that is not."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    areas = [Path([*points, points[0]], closed=True) for points in stable_areas(x, columns, low, high)]
    if areas:  # one path: between several, the ground would be seen
        ax.add_patch(PathPatch(Path.make_compound_path(*areas), label="stable", zorder=0.5, **area(STABLE)))
    span(ax, low, high, UNSTABLE, vertical=False, label="unstable")


def _refined(sweep: Sweep, x: Float, factor: float) -> tuple[Float, list[CriticalColumn]]:
    """Return where all critical values are known, and which: between the points, too, where their number changes."""
    columns = columns_of(sweep, factor)
    between = None if sweep.chart is None else sweep.chart.between
    if between is None:
        return x, columns
    places = np.concatenate([x, between["axis"] * shown_factor(sweep.axes[0].name)])
    rows = zip(between[sweep.quantity] * factor, between["omega"], between["unstable_roots"], strict=True)
    columns += [CriticalColumn(*row) for row in rows]
    order = np.argsort(places, kind="stable")
    return places[order], [columns[k] for k in order]


def _limits(sweep: Sweep, ax: "Axes") -> tuple[float, float]:
    """Set the limits of the ordinate, and return them."""
    factor = to_unit(1.0, shown_unit(sweep))
    found = sweep.main[np.isfinite(sweep.main)] * factor
    if sweep.quantity == "critical_speed":
        low, high = (v * factor for v in sweep.request.task.question.searched)
    elif not found.size:
        low, high = 0.0, 1000.0
    elif found.max() > WIDE * found.min():
        low, high = max(found.min() / 2, found.max() / DECADES), found.max() * 2
        ax.set_ylim(low, high)
        log_axis(ax, upright=True)
    else:
        low, high = 0.0, 1.15 * found.max()
    ax.set_ylim(low, high)
    return low, high


def _least(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw the lower end of the stable interval, over all critical values where these are known."""
    y = sweep.main * to_unit(1.0, shown_unit(sweep))
    if sweep.boundary is not None:
        _branches(sweep.boundary, ax, axis_values(sweep.boundary.axes[0]))
        shown = np.where(_jumps(sweep), np.nan, np.maximum(y, ax.get_ylim()[0]))
    else:
        top = 1.15 * np.nanmax(y, initial=1.0)
        ax.set_ylim(0, top)
        shown = y
        look = {**area(UNSTABLE), "zorder": 0}
        ax.fill_between(x, 0, y, label="unstable under some condition", **look)
        ax.fill_between(x, y, top, label="stable above the curve", zorder=0, **area(STABLE))
    _mark(ax, x, ~np.isfinite(y) & sweep.known, UNSTABLE, "stable for none")
    ax.plot(x, shown, label=r"$C_\mathrm{sl}$ of the interval chosen", **CHOSEN_LINE)


def _jumps(sweep: Sweep) -> Bools:
    """Return where the value chosen is continued by another one at the next place: there the curve is interrupted."""
    columns = columns_of(sweep.boundary, 1.0) if sweep.boundary is not None else []
    out = np.zeros(len(columns), dtype=bool)
    for k, (left, right) in enumerate(pairwise(columns)):
        one, two = (int(np.searchsorted(c.values, y * (1 - 1e-6))) if y > 0 else -1
                    for c, y in ((left, sweep.main[k]), (right, sweep.main[k + 1])))  # fmt: skip
        out[k] = min(one, two) >= 0 and (one, two) not in partners(left, right)
    return out


def _limit(sweep: Sweep, ax: "Axes", x: Float) -> list[Any]:
    """Draw what the curve allows, where it lies in the picture."""
    if sweep.chart is None or sweep.chart.C_su is None:
        return []
    y = sweep.chart.C_su * shown_factor("C_s")
    bottom, top = ax.get_ylim()
    return ax.plot(x, y, label=LIMIT_TEXT, **LIMIT_LINE) if np.any((y > bottom) & (y < top)) else []


def _mark(ax: "Axes", x: Float, where: Bools, colour: str, text: str) -> None:
    """Fill the places where there is no value with the reason."""
    if where.any():
        half = np.diff(x) / 2
        starts = x - np.concatenate([[0.0], half])
        stops = x + np.concatenate([half, [0.0]])
        for k, (first, last) in enumerate(_runs(where)):
            span(ax, starts[first], stops[last], colour, label="_" if k else text)


def _runs(mask: Bools) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False)).reshape(-1, 2)
    return [(int(first), int(last) - 1) for first, last in edges]


def _design(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw the design between the least stable damping and what the curve allows."""
    factor = to_unit(1.0, shown_unit(sweep))
    low, high, chosen = (sweep.columns[name] * factor for name in ("C_sl", "C_su", "C_s"))
    there = np.isfinite(chosen)
    top = 1.15 * np.nanmax(high, initial=1.0)
    ax.fill_between(x, 0, low, where=there, label="unstable", **{**area(UNSTABLE), "zorder": 0})
    ax.fill_between(x, low, high, where=there, label="stable, and allowed in the curve", zorder=0, **area(STABLE))
    ax.fill_between(x, high, top, where=there, label="beyond the limit of the curve", zorder=0, **area(EXCLUDED))
    ax.plot(x, low, label=r"$C_\mathrm{sl}$, minimum for stability", color=BEFORE)
    ax.plot(x, high, label=LIMIT_TEXT, **LIMIT_LINE)
    ax.plot(x, chosen, label=r"$C_\mathrm{s}$, golden section", **CHOSEN_LINE)
    ax.set_ylim(0, top)
    kinds = chart.kinds_of("design", sweep.columns, sweep.known)
    _mark(ax, x, kinds == chart.NONE, EXCLUDED, "no design")
    _mark(ax, x, kinds == chart.NEVER, UNSTABLE, r"stable for no $C_\mathrm{s}$")


def _margin(sweep: Sweep, ax: "Axes", x: Float) -> None:
    """Draw a margin, or only the verdict, and shade where it is stable."""
    looks = {chart.STABLE: (STABLE, "stable"), chart.UNSTABLE: (UNSTABLE, "unstable")}
    told = set()
    for start, stop, kind in (each for each in _stretches(sweep, x) if each[2] in looks):
        colour, text = looks[kind]
        span(ax, start, stop, colour, label="_" if kind in told else text)
        told.add(kind)
    if sweep.quantity == "stable":
        ax.set_yticks([])
        return
    ax.plot(x, sweep.main * to_unit(1.0, shown_unit(sweep)), label=LABELS[sweep.quantity], **CHOSEN_LINE)
    ax.axhline(0, color=LIMIT_LINE["color"], linewidth=0.8)


def _stretches(sweep: Sweep, x: Float) -> list[tuple[float, float, int]]:
    """Return the stretches of one verdict: from one place where it changes to the next."""
    if sweep.chart is None:
        kinds, crossings = chart.kinds_of(sweep.quantity, sweep.columns, sweep.known), np.full(x.size - 1, np.nan)
    else:
        kinds, crossings = sweep.chart.kinds, sweep.chart.crossings[0] * shown_factor(sweep.axes[0].name)
    changes = np.flatnonzero(kinds[1:] != kinds[:-1])
    middle = np.where(np.isfinite(crossings), crossings, (x[1:] + x[:-1]) / 2)
    ends = [x[0], *middle[changes], x[-1]]
    each = [int(kinds[0]), *(int(kinds[k + 1]) for k in changes)]
    return [(float(start), float(stop), kind) for (start, stop), kind in zip(pairwise(ends), each, strict=True)]

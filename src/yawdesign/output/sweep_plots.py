"""Pictures of sweeps: a curve over one axis, a map over two."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import curves, stable_areas
from yawdesign.output.pictures import new_axes
from yawdesign.output.style import BECOMES, STABLE, UNKNOWN, UNSTABLE
from yawdesign.output.sweep_maps import draw_map
from yawdesign.output.sweep_style import (
    DECADES,
    LABELS,
    WIDE,
    axis_label,
    axis_values,
    columns_of,
    draw_lines,
    is_geometric,
    legend_below,
    scale_axis,
    shown_unit,
    title,
)
from yawdesign.problem import ProblemError, to_unit
from yawdesign.problem.table import field_name
from yawdesign.study.axes import Axis
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    ax.plot(x, low, color=BECOMES["stable"], label=r"$C_\mathrm{sl}$, least stable")
    ax.plot(x, high, color=BECOMES["unstable"], label=r"$C_\mathrm{su}$, limit of the curve")
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

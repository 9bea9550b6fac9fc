"""Maps: sweeps over two axes."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import curves
from yawdesign.output.contours import colour_bar, draw_contours
from yawdesign.output.pictures import legend_below, set_title
from yawdesign.output.regions import Regions
from yawdesign.output.style import (
    BOUNDARY,
    EXCLUDED,
    LIMIT_LINE,
    STABLE,
    UNKNOWN,
    UNSTABLE,
    area,
    critical_line,
    hatched,
)
from yawdesign.output.sweep_style import (
    LIMIT_TEXT,
    ON_MAP,
    UPRIGHT,
    axis_label,
    axis_values,
    columns_of,
    joined,
    mark_as_written,
    scale_axis,
    shown_factor,
    shown_unit,
    title,
    value_label,
)
from yawdesign.problem import to_unit
from yawdesign.study import chart
from yawdesign.study.axes import Axis
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Above each other: values, areas without a value, lines.
AREAS, LINES = 1.5, 2.5
ABOVE = 9.0  # from a map to its title, past a mark on its edge [pt]
SEARCHED = {
    "critical": r"largest critical yaw damping $C_\mathrm{s}$",
    "critical_speed": "critical speed $v$, stable below",
}


class _Map:
    """A sweep over two axes as a picture has it: the speed stands upright."""

    def __init__(self, sweep: Sweep) -> None:
        first, second = sweep.axes
        self.sweep = sweep
        self.turned = second.name == "v" or first.name != "v"  # Matplotlib's rows run upwards
        self.across, self.upright = (first, second) if self.turned else (second, first)
        self.x, self.y = axis_values(self.across), axis_values(self.upright)
        self.regions = Regions(self.x, self.y, self.laid(self._kinds()), self._crossings(0), self._crossings(1))

    def laid(self, values: Any) -> Any:
        """Return values of the grid as Matplotlib has them, a row for each place of the upright axis."""
        return values.T if self.turned else values

    def _kinds(self) -> chart.Kinds:
        if self.sweep.chart is not None:
            return self.sweep.chart.kinds
        return chart.kinds_of(self.sweep.quantity, self.sweep.columns, self.sweep.known)

    def _crossings(self, side: int) -> Float:
        axis: Axis = (self.across, self.upright)[side]
        n, m = self.x.size, self.y.size
        if self.sweep.chart is None:
            return np.full((m, n - 1) if side == 0 else (m - 1, n), np.nan)
        found = self.sweep.chart.crossings[self.sweep.axes.index(axis)]
        return np.asarray(self.laid(found)) * shown_factor(axis.name)


def draw_map(sweep: Sweep, ax: "Axes") -> "Axes":
    """Draw a sweep over two axes; the speed stands upright."""
    drawn = _Map(sweep)
    ax.set(xlim=drawn.x[[0, -1]], xlabel=axis_label(drawn.across))
    ax.set(ylim=drawn.y[[0, -1]], ylabel=axis_label(drawn.upright, UPRIGHT))
    scale_axis(ax, drawn.across)
    scale_axis(ax, drawn.upright, upright=True)
    handles = _values(drawn, ax) if sweep.quantity != "stable" else []
    handles += _areas(drawn, ax)
    handles += _other_roots(drawn, ax)
    handles += _limit(drawn, ax)
    handles += mark_as_written(ax, sweep, drawn.across.name, drawn.upright.name)
    set_title(ax, title(sweep), pad=ABOVE)
    legend_below(ax, handles)
    return ax


def _looks(sweep: Sweep) -> dict[int, tuple[str, str]]:
    """Return colour and meaning of each kind of area that is no value."""
    speeds = sweep.quantity == "critical_speed"
    return {
        chart.STABLE: (STABLE, "stable"),
        chart.UNSTABLE: (UNSTABLE, "unstable"),
        chart.ALWAYS: (STABLE, "stable at every speed" if speeds else _always(sweep)),
        chart.NEVER: (UNSTABLE, "stable at no speed" if speeds else r"stable for no $C_\mathrm{s}$"),
        chart.LATER: (EXCLUDED, "stable from some speed on" if speeds else r"stable from some $C_\mathrm{s}$ on"),
        chart.NONE: (EXCLUDED, "no design"),
        chart.UNKNOWN: (UNKNOWN, "not verified"),
    }


def _always(sweep: Sweep) -> str:
    return "stable without a yaw damper" if sweep.quantity == "C_sl" else r"stable for every $C_\mathrm{s}$"


def _areas(drawn: _Map, ax: "Axes") -> list[Any]:
    """Fill the areas that have no value with what they stand for, and draw the line around what is stable."""
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch, PathPatch

    looks, regions, handles = _looks(drawn.sweep), drawn.regions, list[Any]()
    with_values = drawn.sweep.quantity in ("decay_rate", "damping_ratio")
    filled = [kind for kind in regions.found() if kind in looks and not (with_values and kind == chart.STABLE)]
    for kind in filled:
        colour, text = looks[kind]
        ax.add_patch(PathPatch(regions.outline(kind), zorder=AREAS, **area(colour)))
        handles.append(Patch(label=text, **area(colour)))
    bounding = next((kind for kind in (chart.STABLE, chart.ALWAYS, chart.VALUE) if kind in regions.inside), None)
    bounds = [] if bounding is None else regions.lines(bounding, chart.UNKNOWN)
    if bounds:
        lines = LineCollection(bounds, zorder=LINES, **_as_collection(BOUNDARY))
        lines.set_label("boundary of stability" if bounding == chart.STABLE else "boundary")
        ax.add_collection(lines)
        if bounding == chart.STABLE:
            handles.append(Line2D([], [], label="boundary of stability", **BOUNDARY))
    return handles


def _as_collection(look: dict[str, Any]) -> dict[str, Any]:
    return {"colors": look["color"], "linewidths": look["linewidth"], "linestyles": look["linestyle"]}


def _values(drawn: _Map, ax: "Axes") -> list[Any]:
    """Draw values as steps of colour between round numbers, with lines that are labelled, and a bar beside it."""
    sweep = drawn.sweep
    values = sweep.main
    if sweep.quantity in SEARCHED:
        values = chart.shown_values(sweep.quantity, sweep.columns)
    shown = np.where(sweep.known, values * to_unit(1.0, shown_unit(sweep)), np.nan)
    signed = sweep.quantity in ("decay_rate", "damping_ratio")
    if not signed:
        shown = np.where(shown > 0, shown, np.nan)
    regions = drawn.regions
    inside = [regions.outline(kind) for kind in regions.found() if kind in (chart.STABLE, chart.UNSTABLE, chart.VALUE)]
    steps = draw_contours(ax, drawn.x, drawn.y, drawn.laid(shown), inside, signed=signed)
    if steps is not None:
        colour_bar(ax, steps, value_label(sweep, SEARCHED.get(sweep.quantity, "")))
    return []


def _other_roots(drawn: _Map, ax: "Axes") -> list[Any]:
    """Draw where one more pair of roots becomes unstable in what is unstable already, as far as that is known."""
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    lines = drawn.sweep.boundary
    if lines is None or "C_s" not in (drawn.across.name, drawn.upright.name):
        return []
    (axis,) = lines.axes
    swapped = drawn.across.name == "C_s"
    ends = (drawn.x if swapped else drawn.y)[[0, -1]]
    pieces = curves(axis_values(axis), columns_of(lines, to_unit(1.0, "kN·s/m")), *ends)["neither"]
    points = [[(y, x) for x, y in line] for line in joined(pieces)] if swapped else joined(pieces)
    if not _seen(points, ax):
        return []
    look = critical_line("neither")
    ax.add_collection(LineCollection(points, zorder=LINES, label=ON_MAP["neither"], **look))
    return [Line2D([], [], color=look["colors"], linestyle=look["linestyles"][0], label=ON_MAP["neither"])]


def _seen(pieces: list[Any], ax: "Axes") -> bool:
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    return any(left < x < right and bottom < y < top for piece in pieces for x, y in piece)


def _limit_line(ax: "Axes", points: tuple[Float, Float]) -> list[Any]:
    return list(ax.plot(*points, label=LIMIT_TEXT, zorder=LINES, **LIMIT_LINE))


def _limit(drawn: _Map, ax: "Axes") -> list[Any]:
    """Draw what the curve allows, and hatch what is beyond it, where C_s is an axis: all, if nothing is allowed."""
    from matplotlib.patches import Patch, Polygon

    known = drawn.sweep.chart
    names = drawn.across.name, drawn.upright.name
    if known is None or known.C_su is None or "C_s" not in names:
        return []
    limit = known.C_su * shown_factor("C_s")
    swapped = names[0] == "C_s"
    along, (low, high) = (drawn.y, drawn.x[[0, -1]]) if swapped else (drawn.x, drawn.y[[0, -1]])
    if np.all(limit >= high):
        return []
    line = [] if np.all(limit <= low) else _limit_line(ax, (limit, along) if swapped else (along, limit))
    edge = [*zip(np.clip(limit, low, high), along, strict=True), (high, along[-1]), (high, along[0])]
    look = hatched(EXCLUDED)
    ax.add_patch(Polygon(edge if swapped else [(x, y) for y, x in edge], zorder=LINES - 0.5, **look))
    return [*line, Patch(label="beyond the limit of the curve", **look)]

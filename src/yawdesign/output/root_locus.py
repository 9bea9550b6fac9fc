"""The root locus: how eigenvalues move in the complex plane as a parameter grows."""

from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.label_places import Named, names_inside
from yawdesign.output.mode_paths import Paths
from yawdesign.output.pictures import legend_below, put_title
from yawdesign.output.style import HALO, LIMIT, STABLE, UNSTABLE, span
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NARROWEST, BELOW = 0.0055, 0.0036  # room right of zero and below it, relative to what is drawn beyond it
TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
TICKS_APART = 0.07  # of an axis
POINTED_AT = 6  # places of a path where its name may stand
ARROW_FROM = 0.06  # paths that are shorter than this part of the picture have no arrow


def draw_root_locus(paths: Paths, ax: "Axes", widest: float, target: float | None) -> "Axes":
    """Draw paths in the half of the complex plane above the real axis.

    Parameters
    ----------
    paths : Paths
        What to draw.
    ax : matplotlib.axes.Axes
        Where to draw.
    widest : float
        Decay rate at the left end [1/s].
    target : float or None
        A damping ratio [-] to draw as a line.
    """
    points = {k: _points(paths, k) for k in paths.shown}
    seen = {k: x for k, x in points.items() if np.any(x[:, 0] > -widest)}
    draw_plane(ax, widest, max(0.0, *(float(np.nanmax(x[:, 0])) for x in seen.values())), _top(seen, widest))
    for k, x in seen.items():
        _draw_path(ax, paths, k, x)
    _explain(ax, paths, target)
    put_title(ax, f"Root locus over the {paths.row.meaning}{paths.held}", paths.result.condition)
    legend_below(ax)
    _write_names(ax, paths, seen)
    return ax


def draw_plane(ax: "Axes", widest: float, farthest: float, top: float) -> None:
    """Prepare the complex plane above the real axis.

    Both scales are those of square roots: what is near the origin is seen beside what is fast, and lines of equal
    damping ratio stay straight.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    widest : float
        Decay rate at the left end [1/s].
    farthest : float
        Largest real part that is drawn [1/s].
    top : float
        Highest frequency that is drawn [Hz].
    """
    right = max(NARROWEST * widest, 1.4 * farthest)
    for set_scale in (ax.set_xscale, ax.set_yscale):
        set_scale("function", functions=(_root, _square))
    ax.set(xlim=(-widest, right), ylim=(-BELOW * top, top), xlabel="real part [1/s]", ylabel="frequency [Hz]")
    ax.set_xticks(ticks := _ticks(-widest, right), [f"{x:g}".replace("-", "−") for x in ticks])
    ax.set_yticks(ticks := _ticks(0.0, top), [f"{x:g}" for x in ticks])
    span(ax, -widest, 0, STABLE)
    span(ax, 0, right, UNSTABLE).set_zorder(0.7)  # above the grid
    ax.grid()
    ax.axvline(0, color=LIMIT, linewidth=1)
    ax.axhline(0, color=LIMIT, linewidth=0.6)
    box = {"facecolor": UNSTABLE, "edgecolor": "none", "boxstyle": "square,pad=0.2"}
    middle: dict[str, Any] = {"ha": "center", "va": "center", "rotation": 90, "fontsize": "small", "bbox": box}
    ax.text(right / 4, 0.85, "unstable", transform=ax.get_xaxis_transform(), **middle)


def _root(x: Any) -> Float:
    return np.asarray(np.sign(x) * np.sqrt(np.abs(x)))


def _square(x: Any) -> Float:
    return np.asarray(np.sign(x) * np.square(x))


def _ticks(low: float, high: float) -> list[float]:
    """Return round values of an axis from the outermost one inwards to zero, none too near to another."""
    least, chosen = TICKS_APART * float(_root(high) - _root(low)), [0.0]
    for value in (x for t in reversed(TICKS) for x in (-t, t) if low <= x <= high):
        if all(abs(float(_root(value) - _root(other))) > least for other in chosen):
            chosen.append(value)
    return sorted(chosen)


def damping_ray(ax: "Axes", ratio: float, label: str, **look: Any) -> None:
    """Draw where the damping ratio has a value, from the origin to the end of the picture."""
    left = ax.get_xlim()[0]
    high = -left * sqrt(1 / ratio**2 - 1) / (2 * pi)
    style: dict[str, Any] = {"color": LIMIT, "linestyle": (0, (8, 3)), "linewidth": 1.2} | look
    ax.plot([0, left], [0, high], label=label, scaley=False, **style)


def _points(paths: Paths, k: int) -> Float:
    """Return the path of a mode as real parts [1/s] and frequencies [Hz]."""
    result = paths.result
    points = np.column_stack([result.eigenvalues[:, k].real, result.frequency[:, k]])
    return np.asarray(points[np.isfinite(points).all(axis=1)])


def _top(points: dict[int, Float], widest: float) -> float:
    inside = [x[x[:, 0] > -widest, 1].max() for x in points.values()]
    return 1.12 * float(max([*inside, 0.0])) or 1.0


def _draw_path(ax: "Axes", paths: Paths, k: int, points: Float) -> None:
    look = paths.look(k)
    ax.plot(*points.T, **look)
    ax.plot(*points[0], "o", color=look["color"], markerfacecolor=HALO, markersize=5.5, zorder=3)
    ax.plot(*points[-1], "o", color=look["color"], markersize=5.5, zorder=3)
    middle = [x for x in _at_marks(paths, k) if np.isfinite(x).all()]
    if middle:
        ax.plot(*np.array(middle).T, "|", color=look["color"], markersize=5, markeredgewidth=1.2, zorder=3)
    _arrow(ax, points, look["color"])


def _arrow(ax: "Axes", points: Float, colour: str) -> None:
    """Draw an arrowhead in the middle of what is seen of a path."""
    seen = points[:, 0] >= ax.get_xlim()[0]
    pieces = np.split(points, np.flatnonzero(np.diff(seen)) + 1)  # a path may leave the picture and come back
    inside = max((piece for piece in pieces if piece[0, 0] >= ax.get_xlim()[0]), key=len, default=points[:1])
    places = ax.transAxes.inverted().transform(ax.transData.transform(inside))
    way = np.r_[0, np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))]
    if way[-1] < ARROW_FROM:
        return
    at = way[-1] * np.array([0.5, 0.52])
    start, stop = (tuple(np.interp(x, way, column) for column in inside.T) for x in at)
    arrow = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11}
    ax.annotate("", stop, start, arrowprops=arrow).set_in_layout(False)


def _marks(paths: Paths) -> Float:
    """Return round values of the parameter between its ends, in the unit in which people see it."""
    from matplotlib.ticker import LogLocator, MaxNLocator

    low, high = min(paths.values), max(paths.values)
    locator: Any = LogLocator(subs=(1.0,)) if paths.geometric else MaxNLocator(5, steps=[1, 2, 5, 10])
    values = np.asarray(locator.tick_values(low, high))
    return np.asarray(values[(values > low * (1 + 1e-9)) & (values < high * (1 - 1e-9))])


def _at_marks(paths: Paths, k: int) -> Float:
    order, result = np.argsort(paths.values), paths.result
    x = np.log(paths.values[order]) if paths.geometric else paths.values[order]
    marks = np.log(_marks(paths)) if paths.geometric else _marks(paths)
    columns = (result.eigenvalues[order, k].real, result.frequency[order, k])
    return np.column_stack([np.interp(marks, x, column) for column in columns])


def _explain(ax: "Axes", paths: Paths, target: float | None) -> None:
    """Say in the legend which values ends and marks belong to."""
    unit = paths.row.unit.strip("-")
    shown: dict[str, Any] = {"color": LIMIT, "linestyle": "none"}
    first, last = (f"{format_number(paths.values[k], 4)} {unit}".strip() for k in (0, -1))
    ax.plot([], [], "o", markerfacecolor=HALO, label=first, **shown)
    if target is not None:
        damping_ray(ax, target, f"damping ratio {100 * target:g} %")
    if len(marks := _marks(paths)):
        ax.plot([], [], "|", label=f"{', '.join(map(format_number, marks))} {unit}".strip(), **shown)
    ax.plot([], [], "o", label=last, **shown)


def _write_names(ax: "Axes", paths: Paths, seen: dict[int, Float]) -> None:
    result, left = paths.result, ax.get_xlim()[0]
    width, height = (float(_root(high) - _root(low)) for low, high in (ax.get_xlim(), ax.get_ylim()))
    places = np.vstack([_root(result.eigenvalues.real) / width, _root(result.frequency) / height])
    groups = paths.alike(list(seen), places)
    least = np.nanmin(paths.result.damping_ratio, axis=0)
    names = []
    for group in sorted(groups, key=lambda group: least[group[0]]):
        inside = seen[group[0]][(seen[group[0]][:, 0] >= left) & (seen[group[0]][:, 0] <= 0)]
        if len(inside):
            at = np.unique(np.linspace(len(inside) - 1, 0, POINTED_AT).astype(int))[::-1]
            names.append(Named("\n".join(paths.name(k) for k in group), inside[at], paths.look(group[0])))
    names_inside(ax, names, left, 0.0)

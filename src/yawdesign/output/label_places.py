"""Where the names of curves stand in a picture, so that none lies on another name or on a curve."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import Bbox

SIZE, SPACING = 8.33, 1.3  # of the letters [points], and from line to line relative to that
LEADER = 0.04  # from a curve's end to its name beside the axes, relative to the width of these
REACHES = (7.0, 14.0, 22.0, 32.0, 45.0, 60.0, 80.0)  # how far from a curve a name may stand [points]
DIRECTIONS = tuple(np.deg2rad(x) for x in (0, 90, 270, 180, 45, 315, 135, 225, 20, 340, 160, 200, 70, 290, 110, 250))
FAR = 40.0  # from where on distance is worse than a crossing [points]
ROOM = 2.0  # around a name [points]
STEP, MOST_STEPS = 4.0, 500  # along a curve [pixels]


@dataclass(frozen=True)
class Named:
    """What a name belongs to.

    Parameters
    ----------
    text : str
        The name.
    points : ndarray, shape (n, 2)
        Where it may be pointed at, in data, the best place first.
    look : mapping
        Colour and dashes of the curve.
    """

    text: str
    points: Float
    look: dict[str, Any]


def names_beside(ax: "Axes", names: Sequence[Named]) -> None:
    """Write names to the right of some axes, each at the height of its point, moved apart where they are crowded."""
    from scipy.optimize import isotonic_regression

    if not names:
        return
    figure: Any = ax.get_figure(root=True)
    line = SPACING * SIZE / (72 * figure.get_figheight() * ax.get_position().height)
    to_axes = ax.transData + ax.transAxes.inverted()
    heights = [float(np.clip(to_axes.transform(name.points[0])[1], 0, 1)) for name in names]
    order = np.argsort(heights, kind="stable")
    lines = np.array([1 + names[k].text.count("\n") for k in order])
    offsets = line * (np.cumsum(lines) - lines / 2)
    free = np.asarray(isotonic_regression(np.array(heights)[order] - offsets).x)
    places = np.clip(free, 0, max(0.0, 1 - line * lines.sum())) + offsets
    for k, place in zip(order, places, strict=True):
        end = (1.0, heights[k])
        joint = {"color": names[k].look["color"], "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0, "arrowstyle": "-"}
        ax.annotate(
            names[k].text,
            end,
            (1 + LEADER, place),
            xycoords="axes fraction",
            va="center",
            fontsize="small",
            arrowprops={**joint, "relpos": (0, 0.5)},
            annotation_clip=False,
        )


def names_inside(ax: "Axes", names: Sequence[Named], left: float, right: float) -> None:
    """Write names into some axes where nothing else is, each with a line to its curve.

    What else these axes hold is drawn before.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        With their final limits.
    names : sequence of Named
        What to write, the most important one first.
    left, right : float
        Between which values of the horizontal axis.
    """
    figure: Any = ax.get_figure(root=True)
    figure.draw_without_rendering()  # the layout of the whole figure is known from now on
    place = _Places(ax, left, right)
    for name in names:
        place.put(name)


class _Places:
    """What is taken in some axes, in pixels."""

    def __init__(self, ax: "Axes", left: float, right: float) -> None:
        self.ax, self.point = ax, ax.get_figure(root=True).dpi / 72  # type: ignore[union-attr]
        ends = ax.transData.transform([(left, 0), (right, 0)])[:, 0]
        self.room = (max(ends[0], ax.bbox.x0), ax.bbox.y0, min(ends[1], ax.bbox.x1), ax.bbox.y1)
        drawn: list[tuple[Any, Any]] = [(line.get_transform(), line.get_xydata()) for line in ax.get_lines()]
        lines = [transform.transform(points) for transform, points in drawn if len(points)]
        self.curves = np.vstack([_dense(x) for x in lines])
        self.taken: list[Bbox] = [
            text.get_window_extent() for text in ax.texts if text.get_visible() and text.get_text()
        ]
        self.leaders: list[Float] = []

    def put(self, name: Named) -> None:
        """Write a name at the place that costs least."""
        text = self.ax.text(0, 0, name.text, fontsize="small")
        box = text.get_window_extent()
        text.remove()
        best, anchor, middle = np.inf, np.zeros(2), np.zeros(2)
        for least, one, other in self._choices(name, box.width, box.height):
            if least >= best:
                break
            cost = least + self._cost(one, other, box.width, box.height, best - least)
            if cost < best:
                best, anchor, middle = cost, one, other
        self._write(name, anchor, middle, box)

    def _choices(self, name: Named, width: float, height: float) -> list[tuple[float, Float, Float]]:
        """Return what places cost at least, what they point at, and the middle of the text there."""
        found = []
        for (k, anchor), reach, angle in product(
            enumerate(self.ax.transData.transform(name.points)), REACHES, DIRECTIONS
        ):
            away = np.array([np.cos(angle), np.sin(angle)])
            middle = anchor + away * reach * self.point + np.sign(np.round(away, 2)) * np.array([width, height]) / 2
            found.append((reach * (1 + reach / FAR) + 3 * k, anchor, middle))
        return sorted(found, key=lambda choice: choice[0])

    def _cost(self, anchor: Float, middle: Float, width: float, height: float, most: float) -> float:
        """Return what is bad about a place; what takes long to find only if the rest costs less than `most`."""
        from matplotlib.transforms import Bbox

        half = np.array([width, height]) / 2 + ROOM * self.point
        box = Bbox([middle - half, middle + half])
        x0, y0, x1, y1 = self.room
        outside = max(0.0, x0 - box.x0, box.x1 - x1, y0 - box.y0, box.y1 - y1)
        if 1e3 * outside >= most:
            return float(1e3 * outside)
        leader = np.linspace(anchor, _nearest(box, anchor), 30)
        on_texts = sum(box.overlaps(other) for other in self.taken)
        through = sum(other.count_contains(leader) > 0 for other in self.taken)
        through += sum(_cross(leader[[0, -1]], other) for other in self.leaders)
        through += sum(box.count_contains(np.linspace(other[0], other[1], 30)) > 0 for other in self.leaders)
        cost = float(1e3 * outside + 1e4 * on_texts + 3e3 * through)
        if cost >= most:
            return cost
        cost += 20 * (struck := box.count_contains(self.curves)) + 200 * (struck > 0)
        if cost >= most:
            return cost
        near = np.linalg.norm(self.curves[:, None] - leader[None, 6::3], axis=2).min(axis=0) < 1.5 * self.point
        return float(cost + 15 * near.sum())

    def _write(self, name: Named, anchor: Float, middle: Float, box: "Bbox") -> None:
        from matplotlib.transforms import Bbox

        half = np.array([box.width, box.height]) / 2
        own = Bbox([middle - half, middle + half])
        end = _nearest(own, anchor)
        self.taken.append(own)
        self.leaders.append(np.array([anchor, end]))
        at: Any = self.ax.transData.inverted().transform(anchor)
        offset, stop = ((middle - anchor) / self.point, (end - anchor) / self.point)
        options: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": "center", "fontsize": "small"}
        self.ax.annotate(name.text, at, tuple(offset), **options).set_in_layout(False)
        joint = {"arrowstyle": "-", "color": name.look["color"], "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
        self.ax.annotate("", at, tuple(stop), textcoords="offset points", arrowprops=joint).set_in_layout(False)


def _dense(points: Float) -> Float:
    """Return points of a curve in pixels, no two neighbours farther apart than `STEP`."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    pieces = [
        np.linspace(start, stop, 1 + min(int(step / STEP), MOST_STEPS), endpoint=False)
        for start, stop, step in zip(points, points[1:], steps, strict=False)
        if np.isfinite(step)
    ]
    return np.vstack([*pieces, points[np.isfinite(points).all(axis=1)]])


def _nearest(box: "Bbox", point: Float) -> Float:
    """Return the point of a box that is nearest to another."""
    return np.clip(point, box.min, box.max)


def _cross(one: Float, other: Float) -> bool:
    """Return whether two pieces of straight lines cross."""

    def side(line: Float, point: Float) -> float:
        (ax, ay), (bx, by) = line
        return float(np.sign((bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)))

    return side(one, other[0]) != side(one, other[1]) and side(other, one[0]) != side(other, one[1])

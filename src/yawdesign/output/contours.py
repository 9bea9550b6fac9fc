"""Values on a grid as steps of colour between round numbers, with labelled lines."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.pictures import grouped
from yawdesign.output.style import GROUND_LINE, LIMIT, halo, steps_of_map
from yawdesign.output.sweep_style import DECADES, WIDE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path

STEPS, STEPS_BELOW = 8, 4  # about how many of them, and below zero
ROUND = (1, 2, 5, 10)
RARE = 2  # percent of the points that may lie below the lowest step of a logarithmic scale
LETTERS = 8.0  # size of labels [pt]
FILLED, LINES = 1.0, 2.0  # above each other


def draw_contours(ax: "Axes", x: Float, y: Float, values: Float, inside: "list[Path]", *, signed: bool) -> Any:
    """Draw values, and return the steps of colour for a bar that explains them; None where there is none to colour.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        With its limits and scales already set.
    x, y : ndarray, shapes (n,), (m,)
        Where the points are.
    values : ndarray, shape (m, n)
        In the unit people see; NaN where there is none, which other areas are to cover.
    inside : list of matplotlib.path.Path
        What bounds the areas that have lines.
    signed : bool
        Whether values below zero have lines only: they are not what is looked for.
    """
    known = values[np.isfinite(values)]
    if not known.size:
        return None
    whole = _continued(values)
    low, high = float(known.min()), float(known.max())
    if signed and low < 0:
        _lines(ax, x, y, whole, [level for level in _round(low, 0.0, STEPS_BELOW) if level < 0], inside)
        if high <= 0:
            return None
        low = 0.0
    levels = _levels(low, high, float(np.percentile(known, RARE)))
    extend = "min" if low < levels[0] else "neither"
    colours = steps_of_map(len(levels) - 1 + (extend == "min"))
    steps = ax.contourf(x, y, whole, levels=levels, colors=colours, extend=extend, zorder=FILLED)
    _lines(ax, x, y, whole, [level for level in levels if level > low], inside)
    return steps


def colour_bar(ax: "Axes", steps: Any, label: str) -> None:
    """Explain steps of colour in a bar beside a picture."""
    bar = ax.figure.colorbar(steps, ax=ax, label=label, spacing="uniform", pad=0.02)
    bar.set_ticks(steps.levels, labels=[grouped(level) for level in steps.levels])
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)


def _levels(low: float, high: float, usual: float) -> list[float]:
    if high - low <= 1e-9 * abs(high):
        low, high = low - 0.1 * abs(low) - 1e-9, high + 0.1 * abs(high) + 1e-9
    if low > 0 and high > WIDE * low:
        return _geometric(max(usual, high / DECADES), high)
    return _round(low, high, STEPS)


def _round(low: float, high: float, count: int) -> list[float]:
    from matplotlib.ticker import MaxNLocator

    return [float(level) for level in MaxNLocator(count, steps=list(ROUND)).tick_values(low, high)]


def _geometric(low: float, high: float) -> list[float]:
    """Return round numbers of about equal ratios that enclose what lies between two numbers."""
    first, last = int(np.floor(np.log10(low))), int(np.ceil(np.log10(high)))
    all_of_them = [m * 10.0**k for k in range(first, last + 1) for m in (1, 2, 5)]
    start = max(k for k, level in enumerate(all_of_them) if level <= low * (1 + 1e-9))
    stop = min(k for k, level in enumerate(all_of_them) if level >= high * (1 - 1e-9))
    return all_of_them[start : stop + 1]


def _continued(values: Float) -> Float:
    """Return values that go on as the nearest one where there is none, up to the line that ends them."""
    from scipy.ndimage import distance_transform_edt

    none = ~np.isfinite(values)
    places = distance_transform_edt(none, return_distances=False, return_indices=True)
    return np.asarray(values[tuple(places)])


def _lines(ax: "Axes", x: Float, y: Float, values: Float, levels: list[float], inside: "list[Path]") -> None:
    """Draw lines of equal values with their labels, both inside some areas alone."""
    from matplotlib.path import Path

    crossed = [level for level in levels if values.min() < level < values.max()]
    if not crossed or not inside:
        return
    lines = ax.contour(x, y, values, levels=crossed, zorder=LINES, **GROUND_LINE)
    labels = ax.clabel(lines, fmt=grouped, fontsize=LETTERS, colors=LIMIT, inline_spacing=3)
    lines.set_clip_path(Path.make_compound_path(*inside), ax.transData)
    kept: list[Any] = []
    frame = ax.get_window_extent()
    for label in labels:
        label.set(path_effects=halo(), zorder=3)
        box = label.get_window_extent()
        within = any(path.contains_point(label.get_position()) for path in inside)
        if not within or box.count_overlaps(kept) or not all(map(frame.contains, *zip(box.min, box.max, strict=True))):
            label.remove()
        else:
            kept.append(box)

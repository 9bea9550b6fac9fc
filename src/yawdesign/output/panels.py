"""Axes divided into several."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def divided(
    ax: "Axes", rows: Sequence[float] = (1.0,), columns: Sequence[float] = (1.0,), *, shared: bool = False
) -> list["Axes"]:
    """Return axes in the place of others, of which they keep the first one, row by row.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        What is divided.
    rows, columns : sequence of float
        Heights and widths, relative to each other.
    shared : bool
        Whether all have one horizontal axis, which is labelled below the last one alone.
    """
    grid = grid_in(ax, rows, columns)
    figure: Any = ax.get_figure()
    others = [grid[k] for k in range(1, len(rows) * len(columns))]
    found = [ax, *(figure.add_subplot(spec, sharex=ax if shared else None) for spec in others)]
    for one in found[:-1] if shared else []:
        one.tick_params(labelbottom=False)
    return found


def grid_in(ax: "Axes", rows: Sequence[float], columns: Sequence[float]) -> Any:
    """Return a grid in the place of some axes, of which they keep the first cell. Arguments as in `divided`."""
    figure: Any = ax.get_figure()
    if (place := ax.get_subplotspec()) is None:  # placed by hand
        left, bottom, width, height = ax.get_position().bounds
        place = figure.add_gridspec(1, 1, left=left, bottom=bottom, right=left + width, top=bottom + height)[0]
    grid = place.subgridspec(len(rows), len(columns), height_ratios=rows, width_ratios=columns)
    ax.set_subplotspec(grid[0, 0])
    return grid

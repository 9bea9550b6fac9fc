"""Picture of an optimum: the design variables between their bounds, before and after."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.damper.status import Status
from yawdesign.output.pictures import NothingToDrawError, legend_below, new_axes, set_title
from yawdesign.output.style import BEFORE, CHOSEN, HALO, REST
from yawdesign.output.tables import margin
from yawdesign.problem import PARAMETERS, format_quantity, to_unit
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.damper.optimum import Optimum

HEIGHT, ROW = 1.5, 0.72  # of a picture without variables, of each of them [inch]
ASIDE = 0.14  # of the width: nearer to an end a label stands beside its mark, inside the picture


def draw_optimum(result: "Optimum", ax: "Axes | None" = None) -> "Axes":
    """Draw where each design variable lies between its bounds, before and at the optimum.

    Parameters
    ----------
    result : Optimum
        Of `yawdesign.optimise`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    if result.margin is None:
        raise NothingToDrawError(f"there is nothing to draw: {result.status}: {result.message}")
    given, ax = ax, new_axes(ax)
    names = list(result.bounds)
    if given is None:
        figure: Any = ax.get_figure(root=True)
        figure.set_size_inches(figure.get_figwidth(), HEIGHT + ROW * len(names))
    places = [0.0, 100.0, *(place for name in names if (place := _place_before(name, result)) is not None)]
    free = 0.03 * (max(places) - min(places))
    ax.set(xlim=(min(places) - free, max(places) + free), ylim=(len(names) - 0.4, -0.6))
    for row, name in enumerate(names):
        _variable(ax, row, name, result)
    ax.set_yticks(range(len(names)), [_bounds(name, result) for name in names])
    ax.set_xlabel("place between the bounds, on a logarithmic scale [%]")
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    before, after = margin(result.margin_before, result.objective), margin(result.margin, result.objective)
    text = f"Least {result.objective.replace('_', ' ')}: {before} before, {after} after"
    set_title(ax, text, result.searched, left=120.0)
    legend_below(ax)
    return ax


def _place_before(name: str, result: "Optimum") -> float | None:
    """Return where a variable was before [%], also outside the bounds; None if a logarithmic scale has no place."""
    bound, before = result.bounds[name], result.before[name]
    if before is None or before <= 0 or bound.min <= 0:
        return None
    return float(100 * np.log(before / bound.min) / np.log(bound.max / bound.min))


def _bounds(name: str, result: "Optimum") -> str:
    """Return the label of a variable: its symbol and its bounds."""
    row, bound = PARAMETERS[name], result.bounds[name]
    low = format_number(to_unit(bound.min, row.unit), 4)
    return f"${row.symbol}$\n{low} ... {format_quantity(bound.max, row.unit, 4)}"


def _variable(ax: "Axes", row: int, name: str, result: "Optimum") -> None:
    bound, before, unit = result.bounds[name], result.before[name], PARAMETERS[name].unit
    was = _place_before(name, result)
    place = 100 * bound.position
    found = "optimum" if result.status == Status.OPTIMAL else "best found"
    ax.plot([0, 100], [row, row], color=REST, linewidth=6, solid_capstyle="butt", zorder=0)
    if before is not None and was is not None:
        look: dict[str, Any] = {"markerfacecolor": HALO, "markeredgewidth": 1.8, "markersize": 9}
        ax.plot([was], [row], "s", color=BEFORE, label="_" if row else "before", **look)
        _write(ax, was, row, format_quantity(before, unit, 4), BEFORE, -16)
        if abs(was - place) > 1:
            arrow = {"arrowstyle": "->", "color": CHOSEN, "linewidth": 1.4, "shrinkA": 6, "shrinkB": 6}
            ax.annotate("", (place, row), (was, row), arrowprops=arrow)
    ax.plot([place], [row], "o", color=CHOSEN, markersize=9, label="_" if row else found)
    _write(ax, place, row, format_quantity(bound.value, unit, 4), CHOSEN, 9)


def _write(ax: "Axes", place: float, row: int, text: str, colour: str, aside: float) -> None:
    """Write a value above or below its mark."""
    low, high = ax.get_xlim()
    across = (place - low) / (high - low)
    align = "left" if across < ASIDE else "right" if across > 1 - ASIDE else "center"  # it stays inside the picture
    look: dict[str, Any] = {"ha": align, "color": colour, "fontsize": "small"}
    ax.annotate(text, (place, row), (0, aside), textcoords="offset points", **look)

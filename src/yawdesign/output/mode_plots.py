"""Pictures of modes along a parameter: the root locus, damping or frequency."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.label_places import Named, names_beside
from yawdesign.output.mode_paths import Paths
from yawdesign.output.pictures import NothingToDrawError, legend_below, log_axis, new_axes, put_title
from yawdesign.output.root_locus import draw_root_locus
from yawdesign.output.style import BECOMES, BECOMES_DASHES, LIMIT, UNSTABLE, span
from yawdesign.problem import format_quantity
from yawdesign.problem.table import as_choice

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.modes.followed_modes import FollowedModes

QUANTITIES = ("root_locus", "damping_ratio", "frequency")
HIGHEST = 60.0  # damping ratio that is drawn [%]: what is damped more is no concern


def mode_paths(
    result: "FollowedModes",
    ax: "Axes | None" = None,
    *,
    of: str = "root_locus",
    widest: float = 40.0,
    target: float | None = None,
) -> "Axes":
    """Draw followed modes: their root locus, or their damping ratio or frequency over the parameter.

    Parameters
    ----------
    result : FollowedModes
        What `yawdesign.follow_modes` returns.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    of : {"root_locus", "damping_ratio", "frequency"}
        What to draw.
    widest : float
        Modes that decay faster than this everywhere [1/s] are left out. Of a vehicle with two bogies the ten of
        least damping ratio are drawn, and of two that differ in how the bogies move together the less damped one.
    target : float, optional
        A damping ratio [-] to draw as a line, such as 0.05.
    """
    as_choice(of, QUANTITIES)
    ax = new_axes(ax)
    paths = Paths.of(result, widest)
    if not paths.shown:
        raise NothingToDrawError(f"all modes decay faster than {widest:g} 1/s: give a larger `widest`")
    if of == "root_locus":
        return draw_root_locus(paths, ax, widest, target)
    return _over_parameter(paths, ax, of, target)


def _over_parameter(paths: Paths, ax: "Axes", of: str, target: float | None) -> "Axes":
    result, is_frequency = paths.result, of == "frequency"
    curves = result.frequency if is_frequency else 100 * result.damping_ratio
    curves = np.where(result.frequency > 0, curves, np.nan)
    waving = [k for k in paths.shown if np.any(result.frequency[:, k] > 0)]
    if not waving:
        raise NothingToDrawError(f"no mode that is drawn oscillates: {', '.join(map(paths.name, paths.shown))}")
    for k in waving:
        ax.plot(paths.values, curves[:, k], label="_", **paths.look(k))
    ax.set(xlabel=paths.label, xlim=(min(paths.values), max(paths.values)))
    ax.set(ylabel="frequency [Hz]" if is_frequency else "damping ratio [%]")
    if paths.geometric:
        log_axis(ax)
    _limits(ax, curves[:, waving], is_frequency)
    ax.grid()
    ax.axhline(0, color=LIMIT, linewidth=1)
    if target is not None and not is_frequency:
        label = f"required, {100 * target:g} %"
        ax.axhline(100 * target, color=LIMIT, linestyle=(0, (8, 3)), linewidth=1.2, label=label)
    _mark_critical(paths, ax)
    names_beside(ax, [*_names(paths, ax, curves, waving)])
    put_title(ax, f"{'Frequency' if is_frequency else 'Damping ratio'} of the modes{paths.held}", result.condition)
    if ax.get_legend_handles_labels()[1]:
        legend_below(ax)
    return ax


def _limits(ax: "Axes", curves: Float, is_frequency: bool) -> None:
    """Show what matters, and of damping ratios what is unstable, as an area that the grid does not strike through."""
    highest, lowest = float(np.nanmax(curves)), float(np.nanmin(curves))
    if is_frequency:
        ax.set_ylim(0, 1.05 * highest)
        return
    top = min(HIGHEST, 1.05 * highest)
    bottom = min(-0.09 * top, 1.3 * lowest)
    ax.set_ylim(bottom, top)
    span(ax, bottom, 0, UNSTABLE, vertical=False).set_zorder(0.7)
    box = {"facecolor": UNSTABLE, "edgecolor": "none", "boxstyle": "square,pad=0.15"}
    place = (0.01, 0.5 * bottom)
    ax.text(*place, "unstable", transform=ax.get_yaxis_transform(), va="center", fontsize="small", bbox=box)


def _mark_critical(paths: Paths, ax: "Axes") -> None:
    for value, becomes in paths.critical:
        text = f"becomes {becomes} at about {format_quantity(value, paths.row.unit, 3)}"
        look: Any = {"color": BECOMES[becomes], "linestyles": BECOMES_DASHES[becomes], "linewidth": 1.4}
        ax.vlines(paths.in_unit(value), 0, ax.get_ylim()[1], label=text, **look)


def _names(paths: Paths, ax: "Axes", curves: Float, waving: list[int]) -> Any:
    """Yield names at the right ends of the curves; those of curves that lie on each other are one."""
    bottom, top = ax.get_ylim()
    last = int(np.argmax(paths.values))
    for group in paths.alike(waving, curves / (top - bottom)):
        text = "\n".join(paths.name(k) for k in group)
        seen = curves[:, group[0]] <= top
        if np.any(seen):
            end = curves[last, group[0]]
            yield Named(text, np.array([[paths.values[last], end if np.isfinite(end) else 0.0]]), paths.look(group[0]))

"""A picture of stationary responses: their root mean squares, in a panel for each unit."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from yawdesign.output.panels import grid_in
from yawdesign.output.pictures import legend_below, literal, new_axes, put_title, quantity
from yawdesign.output.response_words import SHOWN, body_name, meaning
from yawdesign.output.style import CHOSEN, LIMIT, SERIES, WIDTH
from yawdesign.problem import format_quantity
from yawdesign.vehicle.elements import parted
from yawdesign.vehicle.signals import DIRECTIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.stationary import StationaryResponse

LINE, OF_REST = 0.18, 2.4  # heights of a bar, and of axes, title and legend [inch]
OF_LETTER = 5.0  # width of a letter of the names [points]
PANELS = ("lateral displacement", "yaw", "lateral acceleration", "force")
UNITS = {"lateral displacement": "m", "yaw": "rad", "lateral acceleration": "m/s^2", "force": "N"}
OF_INPUT = {"alignment": ("o", SERIES[1]), "cross_level": ("D", SERIES[2])}


def draw_stationary(result: "StationaryResponse", ax: "Axes | None" = None) -> "Axes":
    """Draw root mean squares of motions, accelerations and forces, and what alignment and cross-level give alone.

    Parameters
    ----------
    result : StationaryResponse
        Of `yawdesign.stationary_response`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; each unit has axes of its own in their place.
    """
    groups = {panel: sorted((x for x in result.rms if _panel(x) == panel), key=_rank) for panel in PANELS}
    moved, accelerated, forces = (groups[panel] for panel in (PANELS[0], *PANELS[2:]))
    first = new_axes(ax)
    rows = [len(names) + 0.5 for names in (moved, accelerated, forces)]
    if ax is None:
        first.figure.set_size_inches(WIDTH, OF_REST + LINE * sum(rows))  # type: ignore[union-attr]
    grid, figure = grid_in(first, rows, (1, 1)), first.figure
    others = [figure.add_subplot(place) for place in (grid[0, 1], grid[1, :], grid[2, :])]
    for panel, (what, names) in zip((first, *others), groups.items(), strict=True):
        _bars(panel, result, what, names, moved if what == PANELS[1] else names)
    others[0].tick_params(axis="y", labelleft=False)
    left = OF_LETTER * max(len(_short(x, what)) for what, names in groups.items() for x in names)
    at = f"{format_quantity(result.speed, 'km/h', 4)}, {quantity('C_s', result.C_s)}"
    put_title(first, f"Stationary motion on {literal(result.track)}, {result.band}, {at}", result.condition, left=left)
    handles, _ = first.get_legend_handles_labels()
    legend_below(others[-1], handles=[handles[-1], *handles[:-1]], left=left)
    return first


def _rank(name: str) -> tuple[int, str]:
    """Return the order of bodies from above to below; forces as they are."""
    part, ends = parted(name.split("_")[1])
    return ("cbmw".find(part), ends) if _panel(name) != PANELS[3] else (0, "")


def _panel(name: str) -> str:
    """Return in which panel a response is drawn; none of them is an empty text."""
    direction, body, *rate = name.split("_")
    if direction in DIRECTIONS and (part := parted(body)[0]) in "bwmc":
        if not rate and direction == "y":
            return PANELS[0]
        if not rate and DIRECTIONS[direction] == "yaw":
            return PANELS[1]
        return PANELS[2] if direction == "y" and rate == ["acceleration"] and part in "bc" else ""
    return PANELS[3] if "force" in name and "pair" not in name else ""


def _bars(ax: "Axes", result: "StationaryResponse", what: str, names: Sequence[str], beside: Sequence[str]) -> None:
    """Draw the bars of a panel in the lines of names that stand beside it."""
    factor, unit = SHOWN[UNITS[what]]
    lines = [_short(x, what) for x in beside]
    places = [lines.index(_short(x, what)) for x in names]
    ax.barh(places, [factor * result.rms[x] for x in names], height=0.6, color=CHOSEN, label="root mean square")
    for source, (sign, colour) in OF_INPUT.items():
        values = [factor * result.rms_of[source][x] for x in names]
        look: dict[str, Any] = {"markerfacecolor": colour, "color": LIMIT, "markersize": 4.5, "markeredgewidth": 0.6}
        ax.plot(values, places, sign, label=f"from {source.replace('_', '-')} alone", linestyle="none", **look)
    ax.set_yticks(range(len(lines)), lines, fontsize="small")
    ax.set(ylim=(len(lines) - 0.4, -0.6), xlabel=f"{what} [{unit}]")
    ax.set_xlim(left=0)
    ax.tick_params(axis="y", length=0)
    ax.grid(axis="x")


def _short(name: str, what: str) -> str:
    return meaning(name).replace(" force", "") if what == "force" else body_name(name.split("_")[1])

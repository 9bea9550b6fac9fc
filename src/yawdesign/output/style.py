"""The visual language of all pictures: colours, lines, hatches and sizes, each with one meaning."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

# Areas: stable ones are pale, unstable ones are hatched, so that both are told apart in grey print.
STABLE, UNSTABLE, UNKNOWN, EXCLUDED = "#dcefe4", "#f6d5cd", "#d9d9d9", "#fdf3d0"
HATCHES = {UNSTABLE: "////", UNKNOWN: "....", EXCLUDED: "\\\\"}
HATCH_COLOUR = "#c98b80"
# Lines: what is chosen, limits, critical values.
CHOSEN, LIMIT, BEFORE = "#1f4e9e", "#000000", "#5b6770"
BECOMES = {"stable": "#1b6e3a", "unstable": "#b2182b", "neither": "#7f7f7f"}
BECOMES_DASHES = {"stable": "solid", "unstable": (0, (6, 2)), "neither": (0, (1.5, 1.5))}
# Several curves of one picture: colours that stay apart for every kind of colour vision, each with its own dashes.
SERIES = ("#1f4e9e", "#d55e00", "#009e73", "#8a5ca8", "#5b6770", "#b58900", "#000000")
DASHES = (
    "solid",
    (0, (6, 2)),
    (0, (6, 2, 1.5, 2)),
    (0, (1.5, 1.5)),
    (0, (9, 2)),
    (0, (4, 1.5, 1, 1.5, 1, 1.5)),
    "solid",
)
GRID, REST = "#d5d9de", "#c8ccd2"
MAP, MAP_OF_SIGNS = "cividis", "PuOr"  # both rise in grey, too
WIDTH, HEIGHT = 7.0, 4.5  # of a picture [inch]

SETTINGS: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # comes with Matplotlib: every machine sets the same
    "font.size": 10.0,
    "axes.titlesize": "medium",
    "axes.titleweight": "normal",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": "small",
    "lines.linewidth": 1.8,
    "hatch.color": HATCH_COLOUR,
    "hatch.linewidth": 0.6,
    "svg.fonttype": "path",
    "svg.hashsalt": "yawdesign",
}


def line_of(number: int) -> dict[str, Any]:
    """Return colour and dashes of the curve with a number, counted from 0; no pair comes again in 42 curves."""
    again, place = divmod(number, len(SERIES))
    return {"color": SERIES[place], "linestyle": DASHES[(place + again) % len(DASHES)]}


def span(
    ax: "Axes", low: float, high: float, colour: str, *, vertical: bool = True, label: str | None = None
) -> "Patch":
    """Fill a part of an axis with what a colour stands for, hatched where it has a hatch.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    low, high : float
        Ends of the part, in data.
    colour : str
        One of `STABLE`, `UNSTABLE`, `UNKNOWN`, `EXCLUDED`.
    vertical : bool
        Whether the part is one of the horizontal axis, over the whole height.
    label : str, optional
        In the legend.
    """
    draw = ax.axvspan if vertical else ax.axhspan
    return draw(low, high, label=label, zorder=0, **area(colour))


def area(colour: str) -> dict[str, Any]:
    """Return how an area with a colour is filled."""
    return {"facecolor": colour, "hatch": HATCHES.get(colour), "edgecolor": HATCH_COLOUR, "linewidth": 0.0}

"""The visual language of all pictures: colours, lines, hatches and sizes, each with one meaning."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

# Areas: stable ones are pale, unstable ones are hatched, so that both are told apart in grey print.
STABLE, UNSTABLE, UNKNOWN, EXCLUDED = "#dcefe4", "#f6d5cd", "#d9d9d9", "#fdf3d0"
HATCHES = {UNSTABLE: "////", UNKNOWN: "....", EXCLUDED: "\\\\"}
HATCH_COLOUR, EXCLUDED_HATCH = "#c98b80", "#a08a4c"
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
MORE, LESS = "#1f4e9e", "#f0b27a"  # what a parameter's growing and falling does, apart in grey too
# Dampers of a catalogue, by what speaks against them: signs differ in shape, and not in colour alone.
VERDICTS = {
    "ok": ("o", "#1b6e3a"),
    "unverified": ("D", "#7f7f7f"),
    "misses a requirement": ("s", "#b58900"),
    "unstable": ("x", "#b2182b"),
    "exceeds the curve's limit": ("^", "#5b6770"),
    "outside the bounds": ("v", "#8a5ca8"),
}
MAP, DARKEST = "cividis", 0.3  # rises in grey, too; from where on black labels are read on it
HALO = "#ffffff"  # around letters and marks on a coloured ground
WIDTH, HEIGHT = 7.0, 4.5  # of a picture [inch]
# Lines and marks with one meaning in all pictures.
BOUNDARY: dict[str, Any] = {"color": LIMIT, "linewidth": 1.8, "linestyle": "solid"}
LIMIT_LINE: dict[str, Any] = {"color": LIMIT, "linewidth": 1.3, "linestyle": (0, (5, 3))}
CHOSEN_LINE: dict[str, Any] = {"color": CHOSEN, "linewidth": 2.2, "linestyle": "solid"}
GROUND_LINE: dict[str, Any] = {"colors": LIMIT, "linewidths": 0.7, "linestyles": "solid"}  # of equal values on a map
LESS_BAR: dict[str, Any] = {"facecolor": LESS, "hatch": "xxx", "edgecolor": HALO, "linewidth": 0.5}
AS_WRITTEN: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "color": LIMIT,
    "markerfacecolor": HALO,
    "markeredgewidth": 1.8,
    "markersize": 8,
    "zorder": 6,
}

# Colours of pages by the names of variables of their style sheets; on a dark screen those of pictures, too.
PAGE = {
    "ink": LIMIT,
    "paper": HALO,
    "soft": "#4a525a",
    "line": GRID,
    "shade": "#f4f6f8",
    "link": CHOSEN,
    "good": "#14602f",
    "good-back": "#e3f2e8",
    "bad": "#a01622",
    "bad-back": "#fbe6e2",
    "doubt": "#6b5200",
    "doubt-back": EXCLUDED,
}
DARK = {
    "ink": "#e8eaed",
    "paper": "#14171b",
    "soft": "#b3bac2",
    "line": "#3c434b",
    "shade": "#1e2329",
    "link": "#8fb8ff",
    "good": "#7fd69b",
    "good-back": "#16301f",
    "bad": "#ff9d92",
    "bad-back": "#3a1a18",
    "doubt": "#f0d070",
    "doubt-back": "#352c10",
    "stable": "#1d3a2a",
    "unstable": "#4a2622",
    "unknown": "#3a3d41",
    "excluded": "#3d3618",
    "hatch": "#a3685d",
    "chosen": "#8fb8ff",
    "before": "#aab3bb",
    "grid": "#343a42",
    "rest": "#59616a",
    "becomes-stable": "#7fd69b",
    "becomes-unstable": "#ff8f85",
    "becomes-neither": "#b0b0b0",
    "series-0": "#8fb8ff",
    "series-1": "#ff9d4d",
    "series-2": "#4fd1ab",
    "series-3": "#c9a3e6",
    "series-4": "#aab3bb",
    "series-5": "#e0be4a",
}

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
    "hatch.linewidth": 0.6,
    "svg.fonttype": "path",
    "svg.hashsalt": "yawdesign",
}


def line_of(number: int) -> dict[str, Any]:
    """Return colour and dashes of the curve with a number, counted from 0; no pair comes again in 42 curves."""
    again, place = divmod(number, len(SERIES))
    return {"color": SERIES[place], "linestyle": DASHES[(place + again) % len(DASHES)]}


def critical_line(kind: str) -> dict[str, Any]:
    """Return how a line of critical values is drawn, above which a vehicle becomes stable, unstable, or neither."""
    width = 1.1 if kind == "neither" else 1.8
    return {"colors": BECOMES[kind], "linestyles": [BECOMES_DASHES[kind]], "linewidths": width}


def steps_of_map(count: int) -> list[Any]:
    """Return the colours of a map in a number of steps, the darkest first."""
    import matplotlib

    return list(matplotlib.colormaps[MAP]([DARKEST + (1 - DARKEST) * k / max(1, count - 1) for k in range(count)]))


def halo(width: float = 2.5) -> list[Any]:
    """Return what makes letters readable on a coloured or hatched ground."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=width, foreground=HALO)]


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
    edge = EXCLUDED_HATCH if colour == EXCLUDED else HATCH_COLOUR
    return {"facecolor": colour, "hatch": HATCHES.get(colour), "edgecolor": edge, "linewidth": 0.0}


def hatched(colour: str) -> dict[str, Any]:
    """Return how an area is marked with what a colour stands for without hiding what is below it."""
    return {"facecolor": "none", "hatch": HATCHES[colour], "edgecolor": EXCLUDED_HATCH, "linewidth": 0.0}

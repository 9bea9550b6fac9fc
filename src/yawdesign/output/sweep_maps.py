"""Maps: sweeps over two axes."""

from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.branches import curves
from yawdesign.output.style import BECOMES, STABLE, UNKNOWN, UNSTABLE
from yawdesign.output.sweep_style import (
    DECADES,
    LABELS,
    ON_MAP,
    WIDE,
    axis_label,
    axis_values,
    columns_of,
    draw_lines,
    legend_below,
    scale_axis,
    shown_unit,
    title,
)
from yawdesign.problem import to_unit
from yawdesign.study.result import Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_map(sweep: Sweep, ax: "Axes") -> "Axes":
    """Draw a sweep over two axes; the speed stands upright."""
    first, second = sweep.axes
    across, upright = (second, first) if first.name == "v" else (first, second)
    turned = across is first  # Matplotlib's rows run upwards
    x, y = axis_values(across), axis_values(upright)
    handles = (_verdicts if sweep.quantity == "stable" else _values)(sweep, ax, x, y, turned)
    handles += _boundary(sweep, ax, across.name, x, y, turned)
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), xlabel=axis_label(across), ylabel=axis_label(upright))
    scale_axis(ax.set_xscale, across)
    scale_axis(ax.set_yscale, upright)
    ax.set_title(title(sweep), loc="left", fontsize="medium")
    if handles:
        legend_below(ax, handles=handles)
    return ax


def _upright(values: Any, turned: bool) -> Any:
    return values.T if turned else values


def _patch(colour: str, text: str) -> Any:
    from matplotlib.patches import Patch

    return Patch(facecolor=colour, edgecolor="#555555", linewidth=0.5, label=text)


def _verdicts(sweep: Sweep, ax: "Axes", x: Float, y: Float, turned: bool) -> list[Any]:
    from matplotlib.colors import ListedColormap

    verdict = np.where(sweep.known, np.where(sweep.good, 0, 1), 2)
    looks = ((STABLE, "stable"), (UNSTABLE, "unstable"), (UNKNOWN, "not verified"))
    colours = ListedColormap([colour for colour, _ in looks])
    ax.pcolormesh(x, y, _upright(verdict, turned), cmap=colours, vmin=0, vmax=2, shading="nearest", rasterized=True)
    return [_patch(*looks[k]) for k in np.unique(verdict)]


def _values(sweep: Sweep, ax: "Axes", x: Float, y: Float, turned: bool) -> list[Any]:
    """Draw values as colours, with a bar that explains them; grey where there is none."""
    values, text = _shown(sweep)
    shown = np.ma.masked_invalid(values * to_unit(1.0, shown_unit(sweep)))
    handles = []
    if sweep.quantity in ("C_sl", "design", "critical", "critical_speed"):
        handles += _special(sweep, ax, x, y, turned)
        shown = np.ma.masked_less_equal(shown, 0)
    mesh = ax.pcolormesh(
        x, y, _upright(shown, turned), shading="nearest", rasterized=True, zorder=1, **_colours(sweep, shown)
    )
    lowest = mesh.get_clim()[0]
    below = shown.count() and lowest is not None and shown.min() < lowest
    extend = "min" if below else "neither"
    ax.figure.colorbar(mesh, ax=ax, label=f"{text} [{shown_unit(sweep)}]", extend=extend)
    return handles


def _shown(sweep: Sweep) -> tuple[Float, str]:
    """Return the values of a map and their name; of several values the one that matters most."""
    if sweep.quantity == "critical":
        return np.fmax.reduce(sweep.main, axis=-1), r"largest critical yaw damping $C_\mathrm{s}$"
    if sweep.quantity == "critical_speed":
        roots = sweep.columns["unstable_roots"]
        lost = np.where((roots[..., :-1] == 0) & (roots[..., 1:] > 0), sweep.main, np.nan)
        return np.fmin.reduce(lost, axis=-1), "least speed at which stability is lost $v$"
    return sweep.main, LABELS[sweep.quantity]


def _colours(sweep: Sweep, shown: Any) -> dict[str, Any]:
    from matplotlib.colors import LogNorm, TwoSlopeNorm

    if not shown.count():
        return {"cmap": "viridis", "vmin": 0, "vmax": 1}
    low, high = float(shown.min()), float(shown.max())
    if sweep.quantity in ("decay_rate", "damping_ratio") and low < 0:
        span = high if high > 0 else -low
        return {"cmap": "RdBu", "norm": TwoSlopeNorm(0, -span, span)}
    if low > 0 and high > WIDE * low:
        return {"cmap": "viridis", "norm": LogNorm(max(low, high / DECADES), high)}
    return {"cmap": "viridis", "vmin": low, "vmax": high}


def _special(sweep: Sweep, ax: "Axes", x: Float, y: Float, turned: bool) -> list[Any]:
    """Colour the places without a value, by the reason."""
    from matplotlib.colors import ListedColormap

    values = _shown(sweep)[0]
    none = ~np.isfinite(values)
    always, never = _always_and_never(sweep, values, none)
    place = np.select([~sweep.known, always, never, none], [3, 0, 1, 2], -1)
    looks = [(STABLE, _always(sweep)), (UNSTABLE, _never(sweep)), ("#fdf3d0", "no design"), (UNKNOWN, "not verified")]
    colours = ListedColormap([colour for colour, _ in looks])
    cells = np.ma.masked_less(place, 0)
    ax.pcolormesh(x, y, _upright(cells, turned), cmap=colours, vmin=0, vmax=3, shading="nearest", rasterized=True)
    return [_patch(*looks[k]) for k in np.unique(place) if k >= 0]


def _always_and_never(sweep: Sweep, values: Float, none: Any) -> tuple[Any, Any]:
    if "unstable_roots" in sweep.columns:
        return none & sweep.good, none & ~sweep.good
    if sweep.quantity == "C_sl":
        return values == 0, none
    return np.zeros_like(none), none & (sweep.columns["status"] == "stable for none")


def _without_damper(sweep: Sweep) -> Float:
    """Return 1 where the bogie is stable, without any yaw damping where that is asked for, else 0."""
    if sweep.quantity in ("C_sl", "design"):
        return np.asarray(sweep.columns["C_sl"] == 0, dtype=float)
    if sweep.quantity == "critical":
        return np.asarray(sweep.columns["unstable_roots"][..., 0] == 0, dtype=float)
    return sweep.good.astype(float)


def _always(sweep: Sweep) -> str:
    return "stable at every speed" if sweep.quantity == "critical_speed" else r"stable for every $C_\mathrm{s}$"


def _never(sweep: Sweep) -> str:
    return "stable at no speed" if sweep.quantity == "critical_speed" else r"stable for no $C_\mathrm{s}$"


def _boundary(sweep: Sweep, ax: "Axes", across: str, x: Float, y: Float, turned: bool) -> list[Any]:
    """Draw the boundary of stability: exact where the critical values are known, else between the points."""
    from matplotlib.lines import Line2D

    if sweep.boundary is not None:
        (axis,) = sweep.boundary.axes
        ends = (x if across == "C_s" else y)[[0, -1]]
        lines = curves(axis_values(axis), columns_of(sweep.boundary, to_unit(1.0, "kN·s/m")), *ends)
        draw_lines(ax, lines, swap=across == "C_s")
        return [Line2D([], [], color=BECOMES[kind], label=ON_MAP[kind]) for kind, found in lines.items() if found]
    inside = sweep.main if sweep.quantity in ("decay_rate", "damping_ratio") else _without_damper(sweep) - 0.5
    if min(inside.shape) < 2 or not (np.nanmin(inside) < 0 < np.nanmax(inside)):
        return []
    ax.contour(x, y, _upright(inside, turned), levels=[0], colors="black", linewidths=1.5)
    return [Line2D([], [], color="black", label=_line(sweep))]


def _line(sweep: Sweep) -> str:
    return (
        "stable without a yaw damper" if sweep.quantity in ("C_sl", "design", "critical") else "boundary of stability"
    )

"""Pictures of the answer for uncertain parameters."""

from collections.abc import Sequence
from math import floor, log10
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Array
from yawdesign.output.mark_labels import MarkLabel, draw_labels
from yawdesign.output.panels import divided
from yawdesign.output.pictures import NothingToDrawError, legend_below, new_axes, set_title, wrapped
from yawdesign.output.style import BEFORE, CHOSEN, LESS_BAR, LIMIT, MORE, REST, STABLE, UNSTABLE, span
from yawdesign.problem import PARAMETERS, to_unit
from yawdesign.problem.condition import CREEP_FACTOR
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_choice

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.study.uncertainty import Uncertainty

OF = ("both", "tornado", "margin", "C_sl")
UNITS = {"decay_rate": "1/s", "damping_ratio": "%", "C_sl": "kN·s/m"}
NAMES = {"C_sl": r"minimum yaw damping for stability $C_\mathrm{sl}$"}
BINS, BAR = 30, 0.7  # bars of a distribution, height of a bar of a parameter
HEIGHT = 6.0  # of a picture with both [inch]
MARKED = {"5": (0, (1.5, 1.5)), "50": "solid", "95": (0, (1.5, 1.5))}  # percentiles, and how they are drawn


def draw_uncertainty(result: "Uncertainty", ax: "Axes | None" = None, *, of: str | None = None) -> "Axes":
    """Draw how the margin or C_sl is distributed, and what each uncertain parameter does to the margin.

    Parameters
    ----------
    result : Uncertainty
        Of `yawdesign.uncertainty`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    of : {"both", "tornado", "margin", "C_sl"}, optional
        How often the margin or C_sl has which value; the change of the margin for one standard deviation of each
        parameter to either side, from its gradient; or, if nothing is asked for, both of the margin.

    Returns
    -------
    matplotlib.axes.Axes
        With the title.
    """
    of = of or ("both" if _effects(result) else "margin")
    as_choice(of, OF)
    given, ax = ax, new_axes(ax)
    if of == "both" and given is None:
        figure: Any = ax.get_figure(root=True)
        figure.set_size_inches(figure.get_figwidth(), HEIGHT)
    if of == "both":
        ax, below = divided(ax, (1.0, 1.0))
        _tornado(result, below)
        legend_below(below)
    marks = _tornado(result, ax) if of == "tornado" else _distribution(result, ax, "C_sl" if of == "C_sl" else "margin")
    value, (low, high) = result.probability_unstable, result.interval
    text = f"between {low:.2g} and {high:.2g}" if value is None else f"{value:.4g} ± {(high - low) / 2:.1g}"
    title = f"Probability of instability: {text}"
    set_title(ax, title, result.held_under)
    legend_below(ax)
    ax.get_figure(root=True).draw_without_rendering()  # type: ignore[union-attr]  # lays out, labels find their places
    set_title(ax, title, result.held_under, pad=draw_labels(ax, marks, 3.0) + 5.0)
    return ax


def _symbol(name: str) -> str:
    rows = {**PARAMETERS, CREEP_FACTOR.key: CREEP_FACTOR, SPEED.key: SPEED}
    return f"${rows[name].symbol}$"


def _effects(result: "Uncertainty") -> dict[str, float]:
    """Return what each parameter does to the margin, the smallest effect first."""
    known = {name: x.margin for name, x in result.effects.items() if x.margin is not None}
    return dict(sorted(known.items(), key=lambda item: abs(item[1])))


def _tornado(result: "Uncertainty", ax: "Axes") -> list[MarkLabel]:
    """Draw the change of the margin for one standard deviation of each parameter to either side."""
    effects = _effects(result)
    if not effects:
        raise NothingToDrawError("there is nothing to draw: the margin has no derivatives")
    unit = UNITS[result.objective]
    middle = to_unit(result.margin, unit)
    rows = range(len(effects))
    for sign, look, label in (
        (1, {"facecolor": MORE}, "one standard deviation more"),
        (-1, LESS_BAR, "one standard deviation less"),
    ):
        widths = [sign * to_unit(effect, unit) for effect in effects.values()]
        ax.barh(rows, widths, BAR, left=middle, label=label, **look)
    low, high = ax.get_xlim()
    if low < 0:
        span(ax, low, min(0.0, high), UNSTABLE, label="unstable")
        ax.set_xlim(low, high)
    ax.axvline(middle, color=LIMIT, linewidth=1.2)
    ax.set_yticks(rows, [_symbol(name) for name in effects])
    ax.set_xlabel(f"least {result.objective.replace('_', ' ')} [{unit}], by its gradient at the values as designed")
    return [MarkLabel(middle, f"as designed: {middle:.4g} {unit}", LIMIT)]


def _distribution(result: "Uncertainty", ax: "Axes", of: str) -> list[MarkLabel]:
    """Draw how often a quantity has which value; return some percentiles to be written."""
    unit = UNITS[result.objective if of == "margin" else of]
    quantiles = [(to_unit(x, unit), level) for level, x in enumerate(result.quantiles[of]) if x is not None]
    if not quantiles:
        raise NothingToDrawError("there is nothing to draw: no C_s is stable for any sample")
    values, levels = zip(*quantiles, strict=True)
    ends = _ends(values)
    shares = np.diff(np.interp(ends, values, levels))
    ax.bar(ends[:-1], shares, np.diff(ends), align="edge", color=REST, edgecolor=BEFORE, linewidth=0.6, zorder=2)
    low, high = float(ends[0]), float(ends[-1])
    if of == "margin":
        low, high = min(low, 0.0), max(high, 0.0)
        for start, stop, colour, text in ((low, 0.0, UNSTABLE, "unstable"), (0.0, high, STABLE, "stable")):
            if start < stop:
                span(ax, start, stop, colour, label=text)
    labels = []
    decimals = max(0, 2 - floor(log10(max(abs(low), abs(high)))))
    for level, dashes in MARKED.items():
        value = result.percentiles[of].get(level)
        if value is not None:
            shown = to_unit(value, unit)
            ax.axvline(shown, color=CHOSEN, linestyle=dashes, linewidth=1.6, zorder=3)
            labels.append(MarkLabel(shown, f"{level} %: {_rounded(shown, decimals)} {unit}", CHOSEN))
    name = NAMES.get(of, f"least {result.objective.replace('_', ' ')}")
    none = 100 - max(levels)
    beside = f"; stable for no $C_\\mathrm{{s}}$ in {none} %" if none else ""
    ax.set_xlabel(wrapped(f"{name} [{unit}]{beside}", 66))
    ax.set(xlim=(low, high), ylabel=f"share of {result.percentiles_from} samples\n[% in each bar]")
    return labels


def _rounded(value: float, decimals: int) -> str:
    """Return a number with so many decimals: all of one picture are rounded alike."""
    return f"{round(value, decimals) + 0.0:,.{decimals}f}".replace(",", " ").replace("-", "−")


def _ends(values: Sequence[float]) -> Array:
    """Return the ends of bars of one width that hold all values."""
    low, high = min(values), max(values)
    if high <= low:
        low, high = low - 0.5, high + 0.5
    return np.linspace(low, high, BINS + 1)

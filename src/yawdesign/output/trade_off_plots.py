"""Picture of the front between margin and rotational resistance, with the design along it."""

from typing import TYPE_CHECKING, Any

from yawdesign.damper.curving import RAISING
from yawdesign.output.pictures import NothingToDrawError, large_numbers, legend_below, log_axis, new_axes, set_title
from yawdesign.output.style import BEFORE, CHOSEN, CHOSEN_LINE, EXCLUDED, HALO, LIMIT_LINE, UNSTABLE, span
from yawdesign.output.sweep_style import SHOWN, WIDE
from yawdesign.problem import PARAMETERS, to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.damper.pareto_front import TradeOff

FRONT, PANEL = 4.6, 1.45  # heights [inch]
UNITS = {"decay_rate": ("least decay rate", "1/s", 1.0), "damping_ratio": ("least damping ratio", "%", 100.0)}
MARKS = (("golden", "D", "golden section, other variables as written"), ("written", "s", "design as written"))
BESIDE = 0.05  # from the limit to the end of the axis, of its length
WITHIN = 1 + 1e-9  # times the limit of the curve: a design at the limit keeps it


def draw_trade_off(result: "TradeOff", ax: "Axes | None" = None) -> "Axes":
    """Draw the margin over the rotational resistance and, on a new figure, the design variables along it below.

    Parameters
    ----------
    result : TradeOff
        Of `yawdesign.trade_off`.
    ax : matplotlib.axes.Axes, optional
        Where to draw the front alone.
    """
    if not result.front:
        raise NothingToDrawError(f"there is nothing to draw: {result.status}: {result.message}")
    below: list[Axes] = []
    if ax is None:
        ax, below = _panels(len(result.variables))
    _draw_front(result, ax)
    for panel, name in zip(below, result.variables, strict=False):
        _draw_variable(result, panel, name)
    last = (below or [ax])[-1]
    last.set_xlabel("rotational resistance $T/(4Qa)$ [-]")
    legend_below(last, ax.get_legend_handles_labels()[0])
    if below:
        below[0].get_figure(root=True).align_ylabels()  # type: ignore[union-attr]
    return ax


def _panels(count: int) -> "tuple[Axes, list[Axes]]":
    """Return axes for the front on a new figure, and below them as many that share their abscissa."""
    first = new_axes(None)
    figure: Any = first.get_figure(root=True)
    first.remove()
    figure.set_size_inches(7.0, FRONT + PANEL * count)
    axes = figure.subplots(1 + count, 1, sharex=True, height_ratios=[FRONT, *[PANEL] * count], squeeze=False)[:, 0]
    return axes[0], list(axes[1:])


def _draw_front(result: "TradeOff", ax: "Axes") -> None:
    name, unit, factor = UNITS[result.objective]
    label = "largest margin with this resistance"
    ax.plot(*_along(result, "margin", factor), marker="o", markersize=5, label=label, zorder=3, **CHOSEN_LINE)
    _mark_points(result, ax, "margin", factor, 9, labels=True)
    ax.set_ylabel(f"{name} [{unit}]")
    low, high = ax.get_ylim()
    if low < 0:
        span(ax, low, min(0.0, high), UNSTABLE, vertical=False, label="unstable")
        ax.set_ylim(low, high)
    _limit(result, ax, labels=True)
    ends = "" if result.ends_at is None else f": no more margin from {result.ends_at:.4g} on"
    set_title(ax, f"Margin and rotational resistance{ends}", result.searched)


def _mark_points(result: "TradeOff", ax: "Axes", name: str, factor: float, size: float, *, labels: bool) -> None:
    """Mark the largest margin within the limit, and what stands beside the front."""
    within = [point for point in result.front if point["rotational_resistance"] <= result.limit * WITHIN]
    marks = [(within[-1], "*", "largest margin within the limit", CHOSEN, size + 5)] if within else []
    for key, marker, text in MARKS:
        if (point := getattr(result, key)) is not None and point[name] is not None:
            marks.append((point, marker, text, BEFORE, size - 1))
    for point, marker, text, colour, large in marks:
        place = point["rotational_resistance"], point[name] * factor
        look: dict[str, Any] = {
            "markerfacecolor": HALO,
            "markeredgewidth": 1.6,
            "markersize": large,
            "linestyle": "none",
        }
        ax.plot(*place, marker=marker, color=colour, label=text if labels else "_", zorder=4, **look)


def _draw_variable(result: "TradeOff", ax: "Axes", name: str) -> None:
    row = PARAMETERS[name]
    unit = SHOWN.get(row.unit, row.unit)
    factor = to_unit(1.0, unit)
    resistance, values = _along(result, name, factor)
    ax.plot(resistance, values, marker="o", markersize=4, **CHOSEN_LINE)
    _mark_points(result, ax, name, factor, 6, labels=False)
    # The resistance is linear in what it rises with.
    if name not in RAISING and min(values) > 0 and max(values) > WIDE / 3 * min(values):
        log_axis(ax, upright=True)
    else:
        large_numbers(ax.yaxis)
    _limit(result, ax, labels=False)
    ax.set_ylabel(f"${row.symbol}$" + (f"\n[{unit}]" if unit != "-" else ""))


def _along(result: "TradeOff", key: str, factor: float) -> tuple[list[float], list[float]]:
    points = result.front
    return [point["rotational_resistance"] for point in points], [point[key] * factor for point in points]


def _limit(result: "TradeOff", ax: "Axes", *, labels: bool) -> None:
    """Draw the limit of the curve, and hatch what is beyond it."""
    low, high = ax.get_xlim()
    high = max(high, result.limit + BESIDE * (result.limit - low))
    line = ax.axvline(result.limit, **LIMIT_LINE)
    if high > result.limit:
        beyond = span(ax, max(low, result.limit), high, EXCLUDED)
        beyond.set_label("beyond the limit" if labels else "_")
    line.set_label(f"limit of the curve, {result.limit:.4g}" if labels else "_")
    ax.set_xlim(low, high)
    ax.grid(visible=True)

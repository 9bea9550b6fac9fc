"""Picture of the front between margin and rotational resistance, with the design along it."""

from typing import TYPE_CHECKING, Any

from yawdesign.damper.curving import RAISING
from yawdesign.output.pictures import new_axes, under_conditions
from yawdesign.output.sweep_style import SHOWN, WIDE
from yawdesign.problem import PARAMETERS, ProblemError, to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.damper.pareto_front import TradeOff

FRONT, PANEL = 4.6, 1.45  # heights [inch]
UNITS = {"decay_rate": ("least decay rate", "1/s", 1.0), "damping_ratio": ("least damping ratio", "%", 100.0)}
MARKS = (("golden", "D", "golden section, other variables as written"), ("written", "s", "design as written"))
LINE = "#1f4e9e"


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
        raise ProblemError(f"there is nothing to draw: {result.status}: {result.message}")
    below: list[Axes] = []
    if ax is None:
        ax, below = _panels(len(result.variables))
    _draw_front(result, ax)
    for panel, name in zip(below, result.variables, strict=False):
        _draw_variable(result, panel, name)
    (below or [ax])[-1].set_xlabel("rotational resistance $T/(4Qa)$ [-]")
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
    ax.plot(*_along(result, "margin", factor), "-o", color=LINE, label="largest margin with this resistance", zorder=3)
    _limit(result, ax, label=f"limit of the curve, {result.limit:.4g}")
    for key, marker, text in MARKS:
        if (point := getattr(result, key)) is not None:
            place = point["rotational_resistance"], point["margin"] * factor
            ax.plot(*place, marker, color="black", markerfacecolor="white", markersize=8, label=text, zorder=4)
    ax.set_ylabel(f"{name} [{unit}]")
    ax.grid(color="#dddddd", linewidth=0.6)
    ends = "" if result.ends_at is None else f": no more margin from {result.ends_at:.4g} on"
    title = f"Margin and rotational resistance{ends}"
    ax.set_title(under_conditions(title, result.searched), loc="left", fontsize="medium")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.12), ncols=2, fontsize="small", frameon=False)


def _draw_variable(result: "TradeOff", ax: "Axes", name: str) -> None:
    row = PARAMETERS[name]
    unit = SHOWN.get(row.unit, row.unit)
    factor = to_unit(1.0, unit)
    resistance, values = _along(result, name, factor)
    ax.plot(resistance, values, "-o", color=LINE, markersize=4)
    _limit(result, ax)
    for key, marker, _ in MARKS:
        point = getattr(result, key)
        if point is not None and point[name] is not None:
            place = point["rotational_resistance"], point[name] * factor
            ax.plot(*place, marker, color="black", markerfacecolor="white", markersize=6)
    # The resistance is linear in what it rises with.
    if name not in RAISING and min(values) > 0 and max(values) > WIDE / 3 * min(values):
        ax.set_yscale("log")
        ax.yaxis.set_minor_formatter("")
    ax.set_ylabel(f"${row.symbol}$" + (f"\n[{unit}]" if unit != "-" else ""))
    ax.grid(color="#dddddd", linewidth=0.6)


def _along(result: "TradeOff", key: str, factor: float) -> tuple[list[float], list[float]]:
    points = result.front
    return [point["rotational_resistance"] for point in points], [point[key] * factor for point in points]


def _limit(result: "TradeOff", ax: "Axes", **label: Any) -> None:
    ax.axvline(result.limit, color="black", linestyle="dashed", linewidth=1.2, **label)

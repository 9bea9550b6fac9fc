"""Pictures of the answer for uncertain parameters."""

from typing import TYPE_CHECKING

from yawdesign.output.pictures import new_axes, under_conditions
from yawdesign.output.style import STABLE, UNSTABLE
from yawdesign.problem import PARAMETERS, ProblemError, to_unit
from yawdesign.problem.condition import CREEP_FACTOR
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_choice

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.study.uncertainty import Uncertainty

OF = ("tornado", "margin", "C_sl")
UNITS = {"decay_rate": "1/s", "damping_ratio": "%", "C_sl": "kN·s/m"}
GROWS, FALLS = "#1f4e9e", "#f2a48c"  # apart in grey, too


def draw_uncertainty(result: "Uncertainty", ax: "Axes | None" = None, *, of: str = "tornado") -> "Axes":
    """Draw what each uncertain parameter does to the margin, or how margin or C_sl is distributed.

    Parameters
    ----------
    result : Uncertainty
        Of `yawdesign.uncertainty`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    of : {"tornado", "margin", "C_sl"}
        The change of the margin for one standard deviation of each parameter to either side, from its gradient; or
        the cumulative distribution of the margin or of C_sl.
    """
    as_choice(of, OF)
    ax = new_axes(ax)
    (_tornado if of == "tornado" else _distribution)(result, ax, of)
    value, (low, high) = result.probability_unstable, result.interval
    text = f"between {low:.2g} and {high:.2g}" if value is None else f"{value:.4g} ± {(high - low) / 2:.1g}"
    ax.set_title(
        under_conditions(f"Probability of instability: {text}", result.held_under), loc="left", fontsize="medium"
    )
    return ax


def _symbol(name: str) -> str:
    rows = {**PARAMETERS, CREEP_FACTOR.key: CREEP_FACTOR, SPEED.key: SPEED}
    return f"${rows[name].symbol}$"


def _tornado(result: "Uncertainty", ax: "Axes", of: str) -> None:
    effects = {name: x.margin for name, x in result.effects.items() if x.margin is not None}
    if not effects:
        raise ProblemError("there is nothing to draw: the margin has no derivatives")
    names = sorted(effects, key=lambda name: abs(effects[name]))
    unit = UNITS[result.objective]
    middle = to_unit(result.margin, unit)
    for sign, colour, label in ((1, GROWS, "one standard deviation more"), (-1, FALLS, "one standard deviation less")):
        widths = [sign * to_unit(effects[name], unit) for name in names]
        ax.barh(range(len(names)), widths, left=middle, color=colour, label=label)
    ax.axvline(middle, color="black", linewidth=1)
    ax.set_yticks(range(len(names)), [_symbol(name) for name in names])
    ax.set_xlabel(f"least {result.objective.replace('_', ' ')} [{unit}], by its gradient at the values as designed")
    ax.legend(fontsize="small")


def _distribution(result: "Uncertainty", ax: "Axes", of: str) -> None:
    unit = UNITS[result.objective if of == "margin" else of]
    known = [(to_unit(x, unit), level) for level, x in enumerate(result.quantiles[of]) if x is not None]
    if not known:
        raise ProblemError("there is nothing to draw: no C_s is stable for any sample")
    ax.plot(*zip(*known, strict=True), color=GROWS, linewidth=2)
    low, high = ax.get_xlim()
    if of == "margin":
        ax.axvspan(min(low, 0.0), 0, color=UNSTABLE, linewidth=0, label="unstable")
        ax.axvspan(0, max(high, 0.0), color=STABLE, linewidth=0, label="stable")
        ax.legend(fontsize="small")
        ax.set_xlabel(f"least {result.objective.replace('_', ' ')} [{unit}]")
    else:
        ax.set_xlabel(rf"least stable yaw damping $C_\mathrm{{sl}}$ [{unit}]")
    ax.set(xlim=(low, high), ylim=(0, 100), ylabel=f"samples with less, of {result.percentiles_from} [%]")

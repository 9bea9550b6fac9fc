"""A picture of critical speeds. Nothing is computed here."""

from typing import TYPE_CHECKING

import numpy as np

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.critical_speed_tables import up_to_text
from yawdesign.output.pictures import literal, new_axes, under_conditions
from yawdesign.output.style import BECOMES, STABLE, UNSTABLE
from yawdesign.output.sweep_style import legend_below
from yawdesign.output.tables import speed
from yawdesign.problem import to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.hunting.critical_speed import CriticalSpeeds


def draw_critical_speeds(result: "CriticalSpeeds", ax: "Axes | None" = None) -> "Axes":
    """Draw the least decay rate of all modes over the speed under the worst condition, and where stability ends.

    Parameters
    ----------
    result : CriticalSpeeds
        Of `yawdesign.critical_speed`.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    low, high = (to_unit(end, "km/h") for end in result.searched)
    end = high if result.stable_up_to is None else max(low, to_unit(result.stable_up_to, "km/h"))
    ax.axvspan(low, end, color=STABLE, linewidth=0, label="stable")
    if end < high:
        ax.axvspan(end, high, color=UNSTABLE, linewidth=0, label="from the first unstable speed on")
    condition = {name: value for name, value in result.worst_condition.items() if name != "speed"}
    label = f"decay rate, {literal(condition_text(condition)) or 'values as given'}"
    ax.plot(to_unit(1.0, "km/h") * np.array(result.speeds), result.decay_rates, color="#1f4e9e", label=label)
    ax.axhline(0.0, color="black", linewidth=0.8)
    for each in result.critical_speeds:
        ax.axvline(to_unit(each.v, "km/h"), color=BECOMES[each.becomes], linewidth=1.5)
    wanted = f"1.1 v = {speed(result.speed_wanted)}"
    ax.axvline(to_unit(result.speed_wanted, "km/h"), color="black", linestyle="dashed", label=wanted)
    ax.set(xlim=(low, high), xlabel="running speed $v$ [km/h]", ylabel="least decay rate of all modes [1/s]")
    found = f"none up to {up_to_text(result)}" if result.stable_up_to is None else up_to_text(result)
    ax.set_title(under_conditions(f"Critical speed: {found}", result.conditions), loc="left", fontsize="medium")
    legend_below(ax)
    return ax

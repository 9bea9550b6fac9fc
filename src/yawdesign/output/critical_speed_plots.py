"""A picture of critical speeds. Nothing is computed here."""

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.critical_speed_tables import up_to_text
from yawdesign.output.mark_labels import MarkLabel, draw_labels
from yawdesign.output.pictures import legend_below, literal, new_axes, set_title
from yawdesign.output.style import BECOMES, BECOMES_DASHES, CHOSEN_LINE, LIMIT, LIMIT_LINE, STABLE, UNSTABLE, span
from yawdesign.problem import format_quantity, to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.hunting.critical_speed import CriticalSpeeds
NEITHER = "critical speed, unstable on both sides"  # where one more pair of roots crosses the axis


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
    _bands(result, ax, low, high)
    label = f"least decay rate, {condition_of_curve(result)}"
    ax.plot(to_unit(1.0, "km/h") * np.array(result.speeds), result.decay_rates, label=literal(label), **CHOSEN_LINE)
    ax.axhline(0.0, color=LIMIT, linewidth=0.8)
    ax.set(xlim=(low, high), xlabel="running speed $v$ [km/h]", ylabel="least decay rate of all modes [1/s]")
    marks = _marks(result, ax)
    found = f"none up to {up_to_text(result)}" if result.stable_up_to is None else _speed(result.stable_up_to)
    if result.stable_up_to == 0:
        found = f"unstable at {low:.4g} km/h already"
    title = f"Critical speed: {found}, $C_\\mathrm{{s}}$ = {format_quantity(result.C_s, 'kN·s/m', 4)}"
    set_title(ax, title, result.conditions)
    legend_below(ax)
    ax.get_figure(root=True).draw_without_rendering()  # type: ignore[union-attr]  # lays out, labels find their places
    set_title(ax, title, result.conditions, pad=draw_labels(ax, marks, 3.0) + 5.0)
    return ax


def condition_of_curve(result: "CriticalSpeeds") -> str:
    """Return in words under which condition the decay rates over the speed are."""
    condition = {name: value for name, value in result.worst_condition.items() if name != "speed"}
    return condition_text(condition) or "values as given"


def _speed(value: float) -> str:
    return format_quantity(value, "km/h", 4)


def _bands(result: "CriticalSpeeds", ax: "Axes", low: float, high: float) -> None:
    """Fill what is stable and what is not, from one critical speed to the next."""
    looks = {"stable": (STABLE, "stable"), "unstable": (UNSTABLE, "unstable")}
    changes = [(to_unit(each.v, "km/h"), each.becomes) for each in result.critical_speeds if each.becomes in looks]
    first = "unstable" if result.stable_up_to == 0 else "stable"
    told = set()
    for (start, kind), (stop, _) in pairwise([(low, first), *changes, (high, "")]):
        colour, text = looks[kind]
        if stop > start:
            span(ax, start, stop, colour, label="_" if kind in told else text)
            told.add(kind)


def _marks(result: "CriticalSpeeds", ax: "Axes") -> list[MarkLabel]:
    """Draw critical and required speeds; return their values to be written."""
    labels = []
    for each in result.critical_speeds:
        x = to_unit(each.v, "km/h")
        line = ax.axvline(x, color=BECOMES[each.becomes], linestyle=BECOMES_DASHES[each.becomes], linewidth=1.5)
        if each.becomes == "neither":
            line.set_label("_" if NEITHER in ax.get_legend_handles_labels()[1] else NEITHER)
        else:
            labels.append(MarkLabel(x, f"{_speed(each.v)}, becomes {each.becomes}", BECOMES[each.becomes]))
    asked = {round(each.wanted, 9): "required" for each in result.requirements if each.name.endswith("critical_speed")}
    asked.setdefault(round(result.speed_wanted, 9), "1.1 v for tests")
    for wanted, text in asked.items():
        x = to_unit(wanted, "km/h")
        ax.axvline(x, **LIMIT_LINE)
        labels.append(MarkLabel(x, f"{text}: {_speed(wanted)}", LIMIT))
    return labels

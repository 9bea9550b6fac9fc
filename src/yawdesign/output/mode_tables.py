"""Modes, and what becomes of them along a parameter, as tables for a terminal."""

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.output.tables import damping, speed, verified
from yawdesign.problem import format_quantity
from yawdesign.study.axes import ROWS
from yawdesign.vehicle.elements import parted

if TYPE_CHECKING:
    from collections.abc import Mapping

    from yawdesign.response.modes.followed_modes import FollowedModes
    from yawdesign.response.modes.named_modes import Modes, NamedMode

LEAST_SHARE, MOST_NAMED = 0.05, 3
LONGEST = 40  # name of a mode on one line
PARTS = {"1": "leading bogie", "2": "trailing bogie"}


def _table(title: str, *columns: str, wrapped: bool = False) -> Table:
    table = Table(title=title, title_justify="left", title_style="bold", padding=(0, 0), pad_edge=True)
    table.add_column("mode", no_wrap=not wrapped)
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    return table


def modes_tables(result: "Modes") -> RenderableType:
    """Return the tables of `Modes`."""
    title = f"Modes at {speed(result.speed)} with C_s = {damping(result.C_s)}, slowest decay first"
    two = any(mode.car_body is not None for mode in result.modes)
    table = _table(title, "[Hz]", "damping\n[%]", "decay\n[1/s]", wrapped=two)
    table.add_column("takes part [%]")
    for mode in result.modes:
        frequency = f"{mode.frequency:.3f}" if mode.frequency else "-"
        numbers = (frequency, f"{100 * mode.damping_ratio:.2f}", f"{mode.decay_rate:.4g}")
        table.add_row(mode.name, *numbers, _shares(_by_bogie(mode.participation)))
    hunting = result.hunting or "none: nothing that oscillates depends on the conicity"
    sways = map(_sway, filter(_is_sway, result.modes))
    checked = f"checked: {verified(result.checked)}"
    lines = [f"hunting: {hunting}", *sways, condition_in_words(result.condition), checked]
    return Group(table, *map(Text, lines))


def _is_sway(mode: "NamedMode") -> bool:
    """Return whether a mode is an oscillation that grows in which the car body moves farther than the wheelsets."""
    return mode.decay_rate < 0 < mode.frequency and mode.car_body is not None and mode.car_body > 1


def _sway(mode: "NamedMode") -> str:
    return (
        f"LOW-CONICITY SWAY: {mode.name} grows, and the car body moves {_times(mode)} as far as the wheelsets; "
        "wheel and rail feed it, and a bogie under a car body that stands still does not show it"
    )


def _times(mode: "NamedMode") -> str:
    return f"{mode.car_body:.2g} times"


def _by_bogie(participation: "Mapping[str, float]") -> "Mapping[str, float]":
    """Return the shares of both bogies and of the car body, if there are two; of each coordinate and damper if not."""
    if "y_c" not in participation:
        return participation
    out: dict[str, float] = {}
    for name, share in participation.items():
        part = PARTS.get(parted(name)[1][:1], "car body")
        out[part] = out.get(part, 0.0) + share
    return out


def _shares(participation: "Mapping[str, float]") -> str:
    largest = sorted(participation.items(), key=lambda item: -item[1])[:MOST_NAMED]
    return ", ".join(f"{name} {100 * share:.0f}" for name, share in largest if share >= LEAST_SHARE)


def followed_tables(result: "FollowedModes") -> RenderableType:
    """Return the tables of `FollowedModes`."""
    first, last = (_shown(result, float(value)) for value in result.values[[0, -1]])
    title = f"Modes over {result.axis}, from {first} to {last}"
    table = _table(
        title,
        "[Hz] at\nfirst",
        "last",
        "damping [%]\nfirst",
        "last",
        "least",
        "at",
        wrapped=max(map(len, result.names)) > LONGEST,
    )
    for k, name in enumerate(result.names):
        ratio = 100 * result.damping_ratio[:, k]
        least = int(np.nanargmin(ratio))
        ends = [_number(values[i]) for values in (result.frequency[:, k], ratio) for i in (0, -1)]
        table.add_row(name, *ends, _number(ratio[least]), _shown(result, float(result.values[least])))
    certainty = f"least certainty of a link: {100 * np.nanmin(result.certainty):.0f} %"
    lines = [_meeting(result, k) for k in range(len(result.meetings))]
    checked = "yes" if result.checked else "NO: a link is not sure, or an eigenvalue is not exact"
    under = condition_in_words(result.condition)
    return Group(table, *map(Text, (*lines, certainty, under, f"checked: {checked}")))


def _number(value: float) -> str:
    """Return a frequency [Hz] or a damping ratio [%]; a mode that is not there, or does not oscillate, has none."""
    return "-" if not value or np.isnan(value) else f"{value:.3g}"


def _shown(result: "FollowedModes", value: float) -> str:
    return format_quantity(value, ROWS[result.axis].unit, 4)


def _meeting(result: "FollowedModes", k: int) -> str:
    meeting = result.meetings[k]
    who, where = " and ".join(meeting.modes), _shown(result, 0.5 * (meeting.low + meeting.high))
    return f"{who} {meeting.kind} at {where}"

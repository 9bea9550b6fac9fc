"""Modes, and what becomes of them along a parameter, as tables for a terminal."""

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.tables import damping, speed, verified
from yawdesign.problem import format_quantity
from yawdesign.study.axes import ROWS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from yawdesign.response.modes.followed_modes import FollowedModes
    from yawdesign.response.modes.named_modes import Modes

LEAST_SHARE, MOST_NAMED = 0.05, 3


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, title_justify="left", title_style="bold", padding=(0, 0), pad_edge=True)
    table.add_column("mode", no_wrap=True)
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    return table


def modes_tables(result: "Modes") -> RenderableType:
    """Return the tables of `Modes`."""
    title = f"Modes at {speed(result.speed)} with C_s = {damping(result.C_s)}, slowest decay first"
    table = _table(title, "[Hz]", "damping\n[%]", "decay\n[1/s]")
    table.add_column("takes part [%]")
    for mode in result.modes:
        frequency = f"{mode.frequency:.3f}" if mode.frequency else "-"
        numbers = (frequency, f"{100 * mode.damping_ratio:.2f}", f"{mode.decay_rate:.4g}")
        table.add_row(mode.name, *numbers, _shares(mode.participation))
    hunting = result.hunting or "none: nothing that oscillates depends on the conicity"
    return Group(table, Text(f"hunting: {hunting}"), Text(f"checked: {verified(result.checked)}"))


def _shares(participation: "Mapping[str, float]") -> str:
    largest = sorted(participation.items(), key=lambda item: -item[1])[:MOST_NAMED]
    return ", ".join(f"{name} {100 * share:.0f}" for name, share in largest if share >= LEAST_SHARE)


def followed_tables(result: "FollowedModes") -> RenderableType:
    """Return the tables of `FollowedModes`."""
    first, last = (_shown(result, float(value)) for value in result.values[[0, -1]])
    title = f"Modes over {result.axis}, from {first} to {last}"
    table = _table(title, "[Hz] at\nfirst", "last", "damping [%]\nfirst", "last", "least", "at")
    for k, name in enumerate(result.names):
        ratio = 100 * result.damping_ratio[:, k]
        least = int(np.nanargmin(ratio))
        ends = [_number(values[i]) for values in (result.frequency[:, k], ratio) for i in (0, -1)]
        table.add_row(name, *ends, _number(ratio[least]), _shown(result, float(result.values[least])))
    certainty = f"least certainty of a link: {100 * np.nanmin(result.certainty):.0f} %"
    lines = [_meeting(result, k) for k in range(len(result.meetings))]
    checked = "yes" if result.checked else "NO: a link is not sure, or an eigenvalue is not exact"
    return Group(table, *(Text(line) for line in (*lines, certainty, f"checked: {checked}")))


def _number(value: float) -> str:
    """Return a frequency [Hz] or a damping ratio [%]; a mode that is not there, or does not oscillate, has none."""
    return "-" if not value or np.isnan(value) else f"{value:.3g}"


def _shown(result: "FollowedModes", value: float) -> str:
    return format_quantity(value, ROWS[result.axis].unit, 4)


def _meeting(result: "FollowedModes", k: int) -> str:
    meeting = result.meetings[k]
    who, where = " and ".join(meeting.modes), _shown(result, 0.5 * (meeting.low + meeting.high))
    return f"{who} {meeting.kind} at {where}"

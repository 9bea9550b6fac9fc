"""Modes, and what becomes of them along a parameter, as tables for a terminal."""

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.tables import damping, speed
from yawdesign.problem import PARAMETERS, format_quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from yawdesign.response.following import FollowedModes
    from yawdesign.response.modes import Modes

LEAST_SHARE, MOST_NAMED = 0.05, 5


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, title_justify="left", title_style="bold")
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k == 0 else "right")
    return table


def modes_tables(result: "Modes") -> RenderableType:
    """Return the tables of `Modes`."""
    title = f"Modes at {speed(result.speed)} with C_s = {damping(result.C_s)}, slowest decay first"
    table = _table(title, "mode", "frequency [Hz]", "damping ratio [%]", "decay rate [1/s]")
    table.add_column("takes part [%]")
    for mode in result.modes:
        frequency = f"{mode.frequency:.3f}" if mode.frequency else "no oscillation"
        numbers = (frequency, f"{100 * mode.damping_ratio:.2f}", f"{mode.decay_rate:.4g}")
        table.add_row(mode.name, *numbers, _shares(mode.participation))
    checked = "yes, by two independent ways" if result.checked else "NO: the two ways differ"
    return Group(table, Text(f"checked: {checked}"))


def _shares(participation: "Mapping[str, float]") -> str:
    largest = sorted(participation.items(), key=lambda item: -item[1])[:MOST_NAMED]
    return ", ".join(f"{name} {100 * share:.0f}" for name, share in largest if share >= LEAST_SHARE)


def followed_tables(result: "FollowedModes") -> RenderableType:
    """Return the tables of `FollowedModes`."""
    first, last = (_shown(result, float(value)) for value in result.values[[0, -1]])
    title = f"Modes over {result.axis} from {first} to {last}"
    columns = ("frequency [Hz]", "damping ratio [%]", "least damping ratio [%]", "at", "sure")
    table = _table(title, "mode", *columns)
    for k, name in enumerate(result.names):
        ratio = 100 * result.damping_ratio[:, k]
        least = int(np.nanargmin(ratio))
        place = _shown(result, float(result.values[least]))
        ends = [" ... ".join(_ends(values[:, k], scale)) for values, scale in _ranges(result)]
        table.add_row(name, *ends, f"{ratio[least]:.2f}", place, _sure(result, k))
    checked = "yes" if result.checked else "NO"
    lines = [_meeting(result, k) for k in range(len(result.meetings))]
    return Group(table, *(Text(line) for line in lines), Text(f"checked: {checked}"))


def _ranges(result: "FollowedModes") -> "tuple[tuple[np.ndarray[tuple[int, ...], np.dtype[np.float64]], float], ...]":
    return (result.frequency, 1.0), (result.damping_ratio, 100.0)


def _ends(values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]", scale: float) -> list[str]:
    return ["-" if np.isnan(value) else f"{scale * value:.3g}" for value in values[[0, -1]]]


def _sure(result: "FollowedModes", k: int) -> str:
    least = np.nanmin(result.certainty[:, k]) if np.any(np.isfinite(result.certainty[:, k])) else np.nan
    return "-" if np.isnan(least) else f"{100 * least:.0f} %"


def _shown(result: "FollowedModes", value: float) -> str:
    return format_quantity(value, "km/h" if result.axis == "v" else PARAMETERS[result.axis].unit, 4)


def _meeting(result: "FollowedModes", k: int) -> str:
    meeting = result.meetings[k]
    who, where = " and ".join(meeting.modes), _shown(result, 0.5 * (meeting.low + meeting.high))
    return f"{who} {meeting.kind} at {where}"

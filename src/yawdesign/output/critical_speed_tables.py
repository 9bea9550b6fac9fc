"""Critical speeds as tables for a terminal; nothing is computed here."""

from math import pi
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.tables import damping, facts, requirement_tables, scope_lines, speed, titled, verified

if TYPE_CHECKING:
    from yawdesign.hunting.critical_speed import CriticalSpeeds


def critical_speed_tables(result: "CriticalSpeeds") -> RenderableType:
    """Return the tables of a `CriticalSpeeds`."""
    low, high = (speed(end) for end in result.searched)
    tests = "reached" if result.reaches else "NOT REACHED"
    rows = [
        ("stable at every speed", f"{low} ... {up_to_text(result)}" if result.stable_up_to != 0 else "no"),
        ("searched", f"{low} ... {high}"),
        ("worst condition", condition_text(result.worst_condition)),
        ("1.1 v, at which vehicles are tested for acceptance", f"{speed(result.speed_wanted)}: {tests}"),
        ("checked", verified(result.checked)),
    ]
    summary = facts(f"With C_s = {damping(result.C_s)}", rows)
    beside = [*_speeds(result), *requirement_tables(result.requirements)]
    return Group(_answer(result), *scope_lines(result.scope), summary, *beside)


def up_to_text(result: "CriticalSpeeds") -> str:
    """Return in words up to which speed a vehicle is stable."""
    return speed(result.searched[1] if result.stable_up_to is None else result.stable_up_to)


def _answer(result: "CriticalSpeeds") -> Text:
    if not result.checked:
        answer = Text("NOT VERIFIED: the two ways differ", "bold yellow")
    elif result.stable_up_to is None:
        answer = Text(f"none up to {up_to_text(result)}", "bold green")
    elif result.stable_up_to == 0:
        answer = Text(f"UNSTABLE at {speed(result.searched[0])} already", "bold red")
    else:
        answer = Text(up_to_text(result), "bold green" if result.reaches else "bold red")
    return Text("Critical speed: ").append_text(answer).append(f", under {result.conditions}.")


def _speeds(result: "CriticalSpeeds") -> list[Table]:
    table = titled("Critical speeds", "speed", "frequency [Hz]", "above it")
    table.add_column("with", justify="left")
    for each in result.critical_speeds:
        becomes = {"neither": "still unstable"}.get(each.becomes, each.becomes)
        condition = condition_text(each.condition) or "values as given"
        table.add_row(speed(each.v), f"{each.omega / (2 * pi):.4f}", becomes, condition)
    return [table] if table.row_count else []

"""What to change where there is no answer, as a table for a terminal; nothing is computed here."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import RenderableType
from rich.text import Text

from yawdesign.output.tables import margin, titled
from yawdesign.problem import PARAMETERS, format_quantity

if TYPE_CHECKING:
    from yawdesign.damper.relaxations import Relaxation

DIGITS = 4
LONG = 16  # signs of a key that stand in one line
SPEED_KINDS = ("speed", "critical_speed")


def relaxation_tables(
    conflict: Sequence[str], relaxations: "Sequence[Relaxation]", objective: str
) -> list[RenderableType]:
    """Return what conflicts, and what to change, one number at a time.

    Parameters
    ----------
    conflict : sequence of str
        What cannot be had together.
    relaxations : sequence of Relaxation
        The least change of each number.
    objective : {"decay_rate", "damping_ratio"}
        What the margins of their designs are.
    """
    found: list[RenderableType] = [Text(_together(conflict))] if conflict else []
    enough = [one for one in relaxations if one.met]
    if enough:
        variables = list(enough[0].design)
        table = titled("What to change, one at a time", "", "from", "to", "change", *variables, "margin")
        for column in table.columns:
            column.overflow = "fold"  # a number that is cut off would be another one
        table.columns[0].no_wrap = True
        for one in enough:
            design = (format_quantity(one.design[name], PARAMETERS[name].unit, DIGITS) for name in variables)
            change = [shown_value(one.name, x) for x in (one.now, one.value or 0.0)]
            share = f"{100 * (one.change or 0.0):+.3g} %"
            table.add_row(_in_two_lines(one.name), *change, share, *design, margin(one.margin, objective))
        found.append(table)
    helpless = [
        f"{one.name} ({_reach(one)} {shown_value(one.name, one.searched)})" for one in relaxations if not one.met
    ]
    if helpless:
        found.append(Text(f"Not enough alone: {', '.join(helpless)}."))
    return found


def _in_two_lines(name: str) -> str:
    """Return a key with a line break after its first part where it is long, and no other."""
    return name.replace(".", ".\n", 1) if len(name) > LONG else name


def _reach(relaxation: "Relaxation") -> str:
    """Return how far a number was changed, in words before the farthest value: a parameter went to zero as well."""
    return "0 ..." if relaxation.kind == "parameter" else "to"


def _together(conflict: Sequence[str]) -> str:
    if len(conflict) == 1:
        return f"What cannot be had: {conflict[0]}, whatever else is given up."
    return f"What cannot be had together: {', '.join(conflict)}, whatever else is given up."


def shown_value(name: str, value: float) -> str:
    """Return the value of a number by its key in a problem file, with its unit."""
    key = name.removesuffix(".max").removesuffix(".min").rpartition(".")[2]
    if name.startswith("requirements.") and key != "critical_speed":
        return margin(value, key)
    row = PARAMETERS.get(key)
    unit = "km/h" if key in SPEED_KINDS else row.unit if row else "-"
    return format_quantity(value, unit, DIGITS + 1)

"""The front between margin and rotational resistance as a table for a terminal; nothing is computed here."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.tables import titled
from yawdesign.problem import PARAMETERS, to_unit
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from yawdesign.damper.pareto_front import TradeOff

MARGINS = {"decay_rate": "decay rate [1/s]", "damping_ratio": "damping ratio [%]"}
DIGITS = 5


def trade_off_tables(result: "TradeOff") -> RenderableType:
    """Return the tables of a `TradeOff`."""
    first = Text(f"{result.status}: {result.message}.\nUnder {result.searched}.")
    beside = [("golden", result.golden), ("written", result.written)]
    known = [(name, point) for name, point in beside if point is not None]
    return Group(first, *([_table(result, known)] if result.front or known else []))


def _table(result: "TradeOff", beside: list[tuple[str, Mapping[str, Any]]]) -> Table:
    names = result.variables or tuple(name for name in ("C_s", "K_m", "C_m") if beside[0][1][name] is not None)
    units = {name: PARAMETERS[name].unit for name in names}
    columns = ("T/(4Qa)", MARGINS[result.objective], *(f"{name} [{unit}]" for name, unit in units.items()))
    table = titled(f"{len(result.front)} points, each the best found with its resistance", "", *columns, "stable")
    table.add_column("worst condition")
    for name, point in [*((str(k), point) for k, point in enumerate(result.front, 1)), *beside]:
        shown = point["margin"] * (1 if result.objective == "decay_rate" else 100)
        values = [format_number(to_unit(point[key], unit), DIGITS) for key, unit in units.items()]
        stable = ("yes" if point["stable"] else "NO") if point["checked"] else "not verified"
        worst = Text(condition_text(point["worst_condition"]))
        table.add_row(name, f"{point['rotational_resistance']:.5f}", f"{shown:.5g}", *values, stable, worst)
    return table

"""The front between margin and rotational resistance as a table for a terminal; nothing is computed here."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table

from yawdesign.hunting.scope import ONE_ONLY
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.tables import facts, titled, verdict_lines
from yawdesign.problem import PARAMETERS, to_unit
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from yawdesign.damper.pareto_front import TradeOff

MARGINS = {"decay_rate": "decay rate\n[1/s]", "damping_ratio": "damping ratio\n[%]"}
DIGITS = 5


def trade_off_tables(result: "TradeOff") -> RenderableType:
    """Return the tables of a `TradeOff`."""
    first = verdict_lines(result.status, f"under {result.searched}", result.message)
    beside = [("golden", result.golden), ("written", result.written)]
    known = [(name, point) for name, point in beside if point is not None]
    if not (result.front or known):
        return first
    points = [*((str(k), point) for k, point in enumerate(result.front, 1)), *known]
    return Group(first, _table(result, points), *_worst(result, points))


Points = list[tuple[str, Mapping[str, Any]]]


def _table(result: "TradeOff", points: Points) -> Table:
    names = result.variables or tuple(name for name in ("C_s", "K_m", "C_m") if points[0][1][name] is not None)
    units = {name: PARAMETERS[name].unit for name in names}
    columns = ("T/(4Qa)", MARGINS[result.objective], *(f"{name}\n[{unit}]" for name, unit in units.items()))
    count = len(result.front)
    head = f"{count} points, each" if count > 1 else "1 point,"
    table = titled(f"{head} the best found with its resistance", "", *columns, "stable")
    for column in table.columns:
        column.no_wrap, column.overflow = True, "fold"  # a number that is cut off would be another one
    for name, point in points:
        shown = point["margin"] * (1 if result.objective == "decay_rate" else 100)
        values = [format_number(to_unit(point[key], unit), DIGITS) for key, unit in units.items()]
        stable = ("yes" if point["stable"] else "NO") if point["checked"] else "not verified"
        table.add_row(name, f"{point['rotational_resistance']:.5f}", f"{shown:.5g}", *values, stable)
    return table


def _worst(result: "TradeOff", points: Points) -> list[Table]:
    """Return under which condition each point has its margin, where there is more than one."""
    if result.searched.startswith(ONE_ONLY):
        return []
    found: dict[str, list[str]] = {}
    for name, point in points:
        found.setdefault(condition_text(point["worst_condition"]), []).append(name)
    return [facts("Worst conditions", [(", ".join(names), text) for text, names in found.items()])]

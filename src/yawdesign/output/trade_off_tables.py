"""The front between margin and rotational resistance as a table for a terminal; nothing is computed here."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.tables import facts, margin, titled
from yawdesign.problem import PARAMETERS, format_quantity

if TYPE_CHECKING:
    from yawdesign.damper.pareto_front import TradeOff

NAMES = {"decay_rate": "least decay rate", "damping_ratio": "least damping ratio"}
DIGITS = 5


def trade_off_tables(result: "TradeOff") -> RenderableType:
    """Return the tables of a `TradeOff`."""
    answer = [("answer", f"{result.status}: {result.message}"), ("limit of the curve", f"{result.limit:.5g}")]
    if result.ends_at is not None:
        answer.append(("more resistance leaves no more margin from", f"{result.ends_at:.5g}"))
    beside = [("golden section", result.golden), ("as written", result.written)]
    known = [(name, point) for name, point in beside if point is not None]
    tables = [_table(result, known)] if result.front or known else []
    return Group(facts("Trade-off of margin and rotational resistance", answer), *tables)


def _table(result: "TradeOff", beside: list[tuple[str, Mapping[str, Any]]]) -> Table:
    names = result.variables or tuple(name for name in ("C_s", "K_m", "C_m") if beside[0][1][name] is not None)
    columns = ("T/(4Qa)", NAMES[result.objective], *names, "worst condition", "stable")
    table = titled(f"{len(result.front)} points, each the best found with its resistance", "", *columns)
    table.columns[-2].justify = "left"
    rows = [(str(k), point) for k, point in enumerate(result.front, 1)]
    for name, point in [*rows, *beside]:
        values = [format_quantity(point[key], PARAMETERS[key].unit, DIGITS) for key in names]
        stable = ("yes" if point["stable"] else "NO") if point["checked"] else "not verified"
        cells = [f"{point['rotational_resistance']:.5f}", margin(point["margin"], result.objective), *values]
        table.add_row(name, *cells, Text(condition_text(point["worst_condition"])), stable)
    return table

"""The paper's numbers beside those computed, as tables; nothing is computed here."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.tables import titled

if TYPE_CHECKING:
    from yawdesign.study.reproduced_row import ReproducedRow
    from yawdesign.study.reproduction import Reproduction

VERDICT = {True: "yes", False: "NO", None: "-"}
OTHER, GROUPED = "reciprocal", 1000.0  # the equations that are named, and from where digits are grouped
HEADS = ("what", "printed", "computed", "deviation [%]", "agrees", "erratum")


def reproduction_tables(result: "Reproduction") -> RenderableType:
    """Return the tables of a `Reproduction`."""
    own = [table_of(where, rows) for where, rows in sections(result.rows)]
    return Group(*verdict(result), *own, *notes(result.rows))


def verdict(result: "Reproduction") -> list[Text]:
    """Return in lines how much agrees, whether it is checked, and what is not as in the paper."""
    compared = result.compared
    agreeing = sum(bool(row.agrees) for row in compared)
    count = f"{agreeing} of {len(compared)} rows that can be compared agree with the paper"
    others = f"{len(result.rows) - len(compared)} others are shown beside it"
    lines = [Text(f"{count}; {others}.", "bold")]
    lines.append(Text("Equations as printed, unless a row says: with the motors' reaction on the frame."))
    unsure = [row for row in result.rows if not row.checked]
    confirmed = "every computed number was confirmed by a second route"
    lines.append(Text(f"NOT VERIFIED: {len(unsure)} rows" if unsure else f"Checked: {confirmed}."))
    for key, (printed, used) in result.changed.items():
        lines.append(Text(f"{key} is {used:.9g} here and {printed:.9g} in Table I [SI].", "bold yellow"))
    return lines


def sections(rows: Iterable["ReproducedRow"]) -> list[tuple[str, list["ReproducedRow"]]]:
    """Return the rows by table, figure and equation, in the order of the paper."""
    order = dict.fromkeys(row.where for row in rows)
    return [(where, [row for row in rows if row.where == where]) for where in order]


def table_of(where: str, rows: Sequence["ReproducedRow"]) -> Table:
    """Return the table of one part of the paper."""
    title = f"Eq. {where}" if where.startswith("(") else where
    table = titled(title, *HEADS)
    for row in rows:
        table.add_row(*cells(row))
    return table


def cells(row: "ReproducedRow") -> tuple[str, ...]:
    """Return a row in words."""
    return (
        named(row),
        shown(row.printed),
        shown(row.computed),
        deviation_of(row),
        agreement(row),
        "" if row.misprint is None else str(row.misprint),
    )


def named(row: "ReproducedRow") -> str:
    """Return what a row is about, with its unit and with the equations that are not as printed."""
    unit = f" [{row.unit}]" if row.unit.strip("-") else ""
    return f"{row.what}{', with reaction' if row.equations == OTHER else ''}{unit}"


def agreement(row: "ReproducedRow") -> str:
    """Return in a word whether a row agrees."""
    return VERDICT[row.agrees] if row.checked else "not verified"


def deviation_of(row: "ReproducedRow") -> str:
    """Return the deviation of a row in %, as people read it."""
    if not row.deviation:
        return "" if row.deviation is None else "0"
    return f"{row.deviation:+.{0 if abs(row.deviation) >= 100 else 2}{'f' if abs(row.deviation) >= 100 else 'g'}}"


def shown(value: float | str | None) -> str:
    """Return a value as people read it, in SI.

    Examples
    --------
    >>> shown(4e7), shown(90702.8898), shown(0.746_5)
    ('40 000 000', '90 702.89', '0.7465')
    """
    if value is None:
        return "-"
    if isinstance(value, str):
        return value
    if abs(value) < GROUPED:
        return f"{value:.6g}"
    return f"{value:,.2f}".removesuffix(".00").replace(",", " ")


def notes(rows: Iterable["ReproducedRow"]) -> list[RenderableType]:
    """Return why rows are not compared or may differ, each reason once."""
    told = [(row.where, row.reason) for row in rows if row.reason and row.where != "Table I"]
    by_reason = groupby(sorted(dict.fromkeys(told), key=lambda x: x[1]), key=lambda x: x[1])
    lines = [Text(f"{', '.join(where for where, _ in group)}: {reason}.") for reason, group in by_reason]
    return [Text("\nWhy, and numbers of docs/errata.md above", "bold"), *lines]

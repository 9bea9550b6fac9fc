"""Tables that hold at any width: no value is cut, and no number is broken.

Columns get the room that their longest word needs, and share what is left. Where there is not enough of it, each row
becomes a block with one line for each of its values.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from rich.cells import cell_len
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.problem.characters import in_order

KEPT = "\ufffe"  # stands for a blank at which no line ends; no text of a user holds it
# What is tried, one after the other: blanks beside a cell (None: as the table has them), and the least room of a column
# of text, unless it needs less.
TRIED = ((None, 16), (0, 16), (0, 10))
# Blanks inside of a number, and between a number and its unit.
_INSIDE = re.compile(
    r"(?<= x) (?=\d)|(?<=±) (?=\d)|(?<=\d) (?=±)"
    r"|(?<=\d) (?=\d{3}(?!\d)|[kMGmµ]?(?:N|m|rad|g|t|s|Hz|W)(?![A-Za-z])|km/h|1/s|%|°)"
)


def fitted(shown: RenderableType, width: int) -> Group:
    """Return tables and lines that fit into a width.

    Parameters
    ----------
    shown : Group, Table, Text or str
        What the functions of this room return.
    width : int
        Signs in a line.
    """
    return Group(*_parts(shown, width))


def unbroken(text: str, blank: str) -> str:
    """Return a text with a sign in place of each blank inside of a number, or between a number and its unit."""
    return _INSIDE.sub(blank, text)


def as_read(text: str) -> str:
    """Return a text with plain blanks, once its lines are made."""
    return text.replace(KEPT, " ")


def _parts(shown: Any, width: int) -> Iterator[RenderableType]:
    if isinstance(shown, Group):
        for part in shown.renderables:
            yield from _parts(part, width)
    elif isinstance(shown, Table):
        if shown.title:
            yield _kept(shown.title, str(shown.title_style or ""))
        yield _table(shown, width)
    else:
        yield _kept(shown)


def _kept(shown: Any, style: str = "") -> Text:
    """Return a text whose numbers stay whole, and that leaves the order of what stands around it."""
    text = shown.copy() if isinstance(shown, Text) else Text(str(shown), style)
    text.plain = unbroken(in_order(as_read(text.plain)), KEPT)
    text.overflow = "fold"
    return text


@dataclass(frozen=True)
class _Column:
    """A column of a table with the widths it needs: to break no word, no line of a cell, and not its head."""

    justify: Any
    header: Text
    cells: Sequence[Text]
    least: int
    cell: int
    whole: int


def _column(justify: Any, header: Text, cells: Sequence[Text], text: int) -> _Column:
    """Return a column; `text` is the least room of one of text."""
    texts = [cell.plain for cell in cells]
    line = max((cell_len(line) for text in texts for line in text.split("\n")), default=0)
    word = max((cell_len(word) for text in (header.plain, *texts) for word in text.split()), default=1)
    least = max(word, min(line, text) if justify == "left" else 1)
    head = max(map(cell_len, header.plain.split("\n")))
    return _Column(justify, header, cells, least, max(least, line), max(least, line, head))


def _table(table: Table, width: int) -> Table:
    _, right, _, left = table.padding
    parts = [(x.justify, _kept(x.header), [_kept(cell) for cell in x.cells]) for x in table.columns]
    for blanks, text in TRIED:
        columns = [_column(*part, text) for part in parts]
        beside = (left, right) if blanks is None else (blanks, blanks)
        room = width - len(columns) * (sum(beside) + 1) - 1
        if sum(column.least for column in columns) <= room:
            return _with_widths(table, columns, _shared(columns, room), beside)
    if table.show_header:
        return _table(_stacked(table, columns), width)
    return _with_widths(table, columns, _narrowed(columns, room), beside)


def _shared(columns: Sequence[_Column], room: int) -> list[int]:
    """Return widths: what is left goes to the cells, then to heads, and first to those that need the least of it."""
    widths = [column.least for column in columns]
    for wanted in ([column.cell for column in columns], [column.whole for column in columns]):
        left, todo = room - sum(widths), sorted(range(len(columns)), key=lambda k: wanted[k] - widths[k])
        for done, k in enumerate(todo):
            more = min(wanted[k] - widths[k], left // (len(todo) - done))
            widths[k] += more
            left -= more
    return widths


def _narrowed(columns: Sequence[_Column], room: int) -> list[int]:
    """Return widths of columns with words that do not fit: these are broken."""
    widths = [min(column.least, max(room // len(columns), 1)) for column in columns]
    widths[-1] = max(room - sum(widths[:-1]), 1)
    return widths


def _with_widths(table: Table, columns: Sequence[_Column], widths: Sequence[int], beside: tuple[int, int]) -> Table:
    left, right = beside
    out = Table(show_header=table.show_header, box=table.box, padding=(0, right, 0, left))
    for column, width in zip(columns, widths, strict=True):
        out.add_column(column.header, justify=column.justify, width=width, overflow="fold")
    for k, row in enumerate(table.rows):
        out.add_row(*(column.cells[k] for column in columns), style=row.style, end_section=row.end_section)
    return out


def _stacked(table: Table, columns: Sequence[_Column]) -> Table:
    """Return a table with a block for each row: a line for each of its values, with the head of its column."""
    out = Table(show_header=False, box=table.box, padding=table.padding)
    for k, row in enumerate(table.rows):
        lines = [(column.header, column.cells[k]) for column in columns if column.cells[k].plain]
        for place, (header, cell) in enumerate(lines, 1):
            out.add_row(Text(" ".join(header.plain.split())), cell, style=row.style, end_section=place == len(lines))
    return out

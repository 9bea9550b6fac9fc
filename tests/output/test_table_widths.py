"""Tables hold at any width: nothing is cut, no number and no word is broken, nothing is wider than the terminal."""

import re
from collections import Counter

import pytest
from rich.cells import cell_len
from rich.console import Group
from rich.table import Table
from rich.text import Text

from yawdesign.output.table_widths import KEPT, fitted
from yawdesign.output.tables import facts, rendered, titled
from yawdesign.output.tables_by_result import tables_of

WIDTHS = (60, 80, 120)
GROUPED = re.compile(r"-?\d{1,3}(?: \d{3})+(?:\.\d+)?")


def texts(shown):
    """Yield all texts of tables, as the functions that make them give them."""
    if isinstance(shown, Group):
        for part in shown.renderables:
            yield from texts(part)
    elif isinstance(shown, Table):
        yield str(shown.title or "")
        for column in shown.columns:
            yield from (cell.plain if isinstance(cell, Text) else str(cell) for cell in column.cells)
            if shown.show_header:
                yield str(column.header)
    else:
        yield shown.plain if isinstance(shown, Text) else str(shown)


def words(text):
    return Counter(re.sub("[─-╿]", " ", text).split())


def check(shown, width, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(width))
    text, given = rendered(shown), list(texts(shown))
    assert "…" not in text
    assert KEPT not in text
    assert max(map(cell_len, text.splitlines())) <= width
    heads = {str(column.header) for table in tables_in(shown) for column in table.columns}
    wanted = sum((words(each) for each in given if each not in heads), Counter())
    assert wanted - words(text) == Counter()
    grouped = Counter(number for each in given for number in GROUPED.findall(each))
    assert not grouped - Counter(GROUPED.findall(re.sub("[│┃]", "|", text)))


def tables_in(shown):
    if isinstance(shown, Group):
        for part in shown.renderables:
            yield from tables_in(part)
    elif isinstance(shown, Table):
        yield shown


@pytest.mark.parametrize("width", WIDTHS)
def test_every_result(kind_of_result, width, results, monkeypatch):
    check(tables_of(results[kind_of_result]), width, monkeypatch)


def test_a_row_becomes_a_block_where_there_is_no_room(monkeypatch):
    table = titled("Some", "name", *(f"number {k} [N·s/m]" for k in range(5)))
    for row in range(2):
        table.add_row(f"row{row}", *(f"{row + 1} 046 {k}70.25" for k in range(5)))
    monkeypatch.setenv("COLUMNS", "120")
    assert re.search(r"row0 │ +1 046 070.25 │", rendered(table))
    check(table, 60, monkeypatch)
    blocks = rendered(table)
    assert len(blocks.splitlines()) == 1 + 2 * 6 + 3
    assert re.search(r"│ number 3 \[N·s/m\] │ 2 046 370.25 +│", blocks)
    check(table, 40, monkeypatch)


def test_room_goes_to_cells_before_heads():
    table = titled("", "a", "a head of many words", "b")
    table.columns[2].justify = "left"
    table.add_row("x", "1", "two words and two more words")
    (shown,) = fitted(table, 48).renderables
    assert [column.width for column in shown.columns] == [1, 9, 28]


def test_a_word_that_no_line_can_hold_is_broken_and_not_cut(monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    text = rendered(facts("", [("name", "x" * 150), ("y" * 70, "value")]))
    assert (text.count("x"), text.count("y")) == (150, 70)
    assert max(map(len, text.splitlines())) <= 60


@pytest.mark.parametrize("text", ["1 046 770 N·s/m", "300 km/h", "0.5 %", "creep x 0.7", "12 1/s", "-3 °"])
def test_a_number_stays_with_its_unit(text):
    (shown,) = fitted(Text(text), 10).renderables
    assert " " not in shown.plain.removeprefix("creep ")


def test_a_number_does_not_stick_to_words():
    (shown,) = fitted(Text("12 of 30 points and 5 men"), 10).renderables
    assert KEPT not in shown.plain

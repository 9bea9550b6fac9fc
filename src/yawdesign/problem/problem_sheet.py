"""A problem as a sheet of a workbook: a row for each value, with its dotted key, its unit and what it means."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Literal

from .catalogue_file import DAMPERS
from .diagnostics import Diagnostic, ProblemError
from .document import Document, Mapping, Node, Scalar, Sequence, compose
from .quantities import split_quantity
from .table import shown
from .workbook import MISTAKE, TEXT, Cell, Row, Workbook

SHEET = "problem"
HEADS = ("key", "value", "unit", "meaning")
MOST_ROWS = 2_000
# `cases.NAME.leading.C_s`: what stands behind the name, which is the user's and may have points.
_OF_CASE = re.compile(r"(?P<name>.+?)\.(?P<key>(?:(?:leading|trailing)\.)?\w+)", re.DOTALL)


@dataclass
class SheetDocument(Document):
    """A workbook as a document: its nodes stand in cells, counted by `Node.start`."""

    cells: list[str] = field(default_factory=list)
    told: set[str] = field(default_factory=set)

    def note(
        self, node: Node, message: str, key: str = "", severity: Literal["error", "warning"] = "error"
    ) -> Diagnostic:
        """Add a diagnostic about a cell, unless its mistake is told already."""
        found = self._at(node, message, key, severity)
        if found.cell not in self.told:
            self.diagnostics.append(found)
        return found

    def wrong(self, node: Node) -> Scalar:
        """Return what stands for a value whose mistake is told: its key is there, and nothing more is said of it."""
        self.told.add(self.cells[node.start])
        return Scalar(node.start, node.end)

    def _at(self, node: Node, message: str, key: str, severity: Literal["error", "warning"]) -> Diagnostic:
        cell = self.cells[min(node.start, len(self.cells) - 1)]
        place = Diagnostic(message=message, key=key, severity=severity, path=self.path, cell=cell)
        return replace(place, line=node.start)  # their order; it is not shown

    def place(self, cell: Cell | str) -> Node:
        """Return the node of a cell."""
        self.cells.append(cell.place if isinstance(cell, Cell) else cell)
        return Node(len(self.cells) - 1, len(self.cells))


@dataclass
class _Branch:
    """Values by key that are still coming."""

    where: Node
    keys: dict[str, Node] = field(default_factory=dict)
    values: dict[str, _Branch | Node] = field(default_factory=dict)

    def finished(self) -> Mapping:
        """Return them as a node."""
        inner = {key: x.finished() if isinstance(x, _Branch) else x for key, x in self.values.items()}
        return Mapping(self.where.start, self.where.end, keys=self.keys, values=inner)


def workbook_document(name: str) -> SheetDocument:
    """Return what the workbook of a name says of a problem; its mistakes are noted in the document.

    Raises
    ------
    ProblemError
        If it is no workbook, or has no sheet named problem.
    """
    book = Workbook(name)
    sheets = {sheet.strip().lower(): sheet for sheet in book.sheets}
    if SHEET not in sheets:
        there = ", ".join(shown(sheet) for sheet in book.sheets)
        raise book.error(f"has no sheet {SHEET}; it has {there}")
    document = SheetDocument("", name, cells=[f"{sheets[SHEET]}!A1"])
    root = _Branch(Node(0, 0))
    rows = book.rows(sheets[SHEET], MOST_ROWS)
    for key, value, unit in _entries(document, rows):
        _add(document, root, key, value, unit)
    if DAMPERS in sheets:
        _add_dampers(document, root, sheets[DAMPERS])
    document.root = root.finished() if root.values else Scalar(0, 0)
    return document


def _columns(document: SheetDocument, head: Row) -> dict[str, int]:
    """Return the place of each column by its name."""
    found = {cell.text.lower(): k for k, cell in reversed(head.items()) if cell.kind == TEXT}
    missing = [name for name in HEADS[:2] if name not in found]
    if missing:
        where = document.place(next(iter(head.values())))
        text = f"the column {' and the column '.join(missing)} is missing: the first row has {', '.join(HEADS)}"
        raise document.fail(where, text)
    return found


def _entries(document: SheetDocument, rows: list[Row]) -> Iterator[tuple[Cell, Cell, Cell | None]]:
    """Yield key, value and unit of each row that has a value, also one that is a mistake, which is told."""
    if not rows:
        return
    columns = _columns(document, rows[0])
    unit_column = columns.get("unit", -1)
    for row in rows[1:]:
        key, value, unit = row.get(columns["key"]), row.get(columns["value"]), row.get(unit_column)
        if key is not None and key.text.startswith("#"):
            continue
        wrong = [cell for cell in (key, value, unit) if cell is not None and cell.kind == MISTAKE]
        for cell in wrong:
            document.note(document.place(cell), cell.text, key.text if key is not None and key is not cell else "")
        if value is None or key in wrong or (key is None and wrong):
            continue
        if key is None:
            document.note(document.place(value), "has no key in front of it")
        else:
            yield key, value, unit


def path_of(key: str, *, whole: bool) -> tuple[str, ...]:
    """Return the path that a dotted key means; names of cases and loads are the user's, and may have points.

    Parameters
    ----------
    key : str
        Dotted key.
    whole : bool
        Whether the value has keys of its own: then what stands behind `cases` is the name of one.
    """
    first, _, rest = key.partition(".")
    head: tuple[str, ...] = (first,)
    if first == "conditions" and rest.startswith("load."):
        head, rest = (first, "load"), rest.removeprefix("load.")
    elif first != "cases":
        return tuple(key.split("."))
    inside = None if whole else _OF_CASE.fullmatch(rest)
    return (*head, inside["name"], inside["key"]) if inside else (*head, *([rest] if rest else []))


def _add(document: SheetDocument, root: _Branch, key: Cell, value: Cell, unit: Cell | None) -> None:
    """Put the value of a row into the tree."""
    where, node = document.place(key), _value(document, value, unit, key.text)
    path, branch = path_of(key.text, whole=isinstance(node, Mapping)), root
    for k, part in enumerate(path[:-1]):
        inner = branch.values.setdefault(part, _Branch(where))
        branch.keys.setdefault(part, where)
        if not isinstance(inner, _Branch):
            first = document.cells[branch.keys[part].start]
            document.note(where, f"{'.'.join(path[: k + 1])} has a value already, in {first}", key.text)
            return
        branch = inner
    if path[-1] in branch.keys:
        first = document.cells[branch.keys[path[-1]].start]
        document.note(where, f"stands twice, first in {first}", key.text)
        return
    branch.keys[path[-1]], branch.values[path[-1]] = where, node


def _value(document: SheetDocument, value: Cell, unit: Cell | None, key: str) -> Node:
    """Return the node of a value: lists and ranges are written as in a problem file, [0.1, 0.2] or {min: 1, max: 2}."""
    where = document.place(value)
    if MISTAKE in (value.kind, unit.kind if unit else None):
        return document.wrong(where)
    if value.kind != TEXT or key == "title" or not value.text.startswith(("[", "{")):
        node: Node = Scalar(where.start, where.end, text=value.text, plain=key != "title")
    else:
        try:
            node = _moved(compose(value.text, document.path).root, where)
        except ProblemError as error:
            document.note(where, error.diagnostics[0].message, key)
            return document.wrong(where)
    return _with_unit(document, node, unit, key) if unit else node


def _moved(node: Node, to: Node) -> Node:
    """Return a tree all of which stands in one cell."""
    place = {"start": to.start, "end": to.end}
    if isinstance(node, Mapping):
        keys = dict.fromkeys(node.keys, to)
        return replace(node, **place, keys=keys, values={key: _moved(x, to) for key, x in node.values.items()})
    if isinstance(node, Sequence):
        return replace(node, **place, items=tuple(_moved(x, to) for x in node.items))
    return replace(node, **place)


def _with_unit(document: SheetDocument, node: Node, unit: Cell, key: str) -> Node:
    """Return a value with the unit that stands beside it, which is that of every number in a list or a range."""
    if isinstance(node, Sequence):
        return replace(node, items=tuple(_with_unit(document, x, unit, key) for x in node.items))
    if isinstance(node, Mapping):
        inner = {k: x if k == "steps" else _with_unit(document, x, unit, key) for k, x in node.values.items()}
        return replace(node, values=inner)
    if not isinstance(node, Scalar):
        return node
    try:
        own = split_quantity(node.text)[1]
    except ProblemError:
        return node  # a word such as rigid, or what is wrong with it is told later
    if own:
        document.note(node, f"{shown(node.text)} has a unit, and another one stands beside it: {shown(unit.text)}", key)
        return document.wrong(node)
    return replace(node, text=node.text if unit.text == "-" else f"{node.text} {unit.text}")


def _add_dampers(document: SheetDocument, root: _Branch, sheet: str) -> None:
    """Name the workbook itself as the catalogue of the design: its sheet of dampers is read as any other."""
    where = document.place(f"{sheet}!A1")
    design = root.values.setdefault("design", _Branch(where))
    root.keys.setdefault("design", where)
    if not isinstance(design, _Branch):
        return
    if "catalogue" in design.keys:
        text = f"the dampers stand in the sheet {DAMPERS}: leave this row out, or rename the sheet"
        document.note(design.keys["catalogue"], text, "design.catalogue")
    name = FilePath(document.path).name
    design.keys["catalogue"], design.values["catalogue"] = where, Scalar(*_ends(where), text=name, plain=False)


def _ends(node: Node) -> tuple[int, int]:
    return node.start, node.end

"""A catalogue of yaw dampers from a file of columns, with the place of every mistake."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from .damper_catalogue import COLUMNS, NEEDED, QUANTITIES, CatalogueDamper
from .diagnostics import Diagnostic, ProblemError, nearest, suggestion
from .document import Document
from .quantities import split_quantity
from .table import shown
from .text_files import text_of
from .units import kind_of, parse_unit
from .workbook import MISTAKE, Workbook, is_workbook

MOST_BYTES = 10_000_000
MOST_ROWS = 100_000
MOST_SHOWN = 20  # mistakes
DAMPERS = "dampers"  # sheet of a workbook
EMPTY = "is empty: the first line names the columns"
_HEAD = re.compile(r"(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+\s*\D*")


@dataclass(frozen=True)
class _Cell:
    """A cell: what it says, and where."""

    text: str
    line: int
    column: int
    source: str
    place: str = ""  # in a workbook

    def mistake(self, path: str, key: str, message: str) -> Diagnostic:
        return Diagnostic(
            path=path,
            line=self.line,
            column=self.column,
            key=key,
            message=message,
            source_line=self.source,
            cell=self.place,
            length=len(self.text) or 1,
        )


def read_catalogue(path: str | PathLike[str]) -> tuple[CatalogueDamper, ...]:
    """Read a catalogue of yaw dampers: columns apart by commas, semicolons or tabs, or a workbook (.xlsx).

    The first line has the names of the columns with their units: ``name, damping [kN s/m], stiffness [MN/m]``, and
    maybe ``per_side``, ``blow_off [kN]``, ``damping_after [kN s/m]``. A cell may have its own unit. Empty lines and
    lines that begin with # are left out. Of a workbook it is the sheet ``dampers``, or the only one.

    Parameters
    ----------
    path : path
        Name of the file.

    Returns
    -------
    tuple of CatalogueDamper
        In SI units, in the order of the file.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong.
    """
    name = fspath(path)
    sheet = _WorkbookSheet(name) if is_workbook(name) else _Sheet(name, text_of(name, MOST_BYTES))
    found = sheet.dampers()
    if len(sheet.mistakes) > MOST_SHOWN:
        more = f"and {len(sheet.mistakes) - MOST_SHOWN} more mistakes"
        raise ProblemError([*sheet.mistakes[:MOST_SHOWN], Diagnostic(path=name, message=more)])
    if sheet.mistakes:
        raise ProblemError(sheet.mistakes)
    return found


def with_catalogue(document: Document, data: dict[str, Any]) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return the data of a problem with the dampers of the file that it names, which is looked for beside it.

    Where that has mistakes, these come with the data without a catalogue.
    """
    design = data.get("design")
    named = design.get("catalogue") if isinstance(design, dict) else None
    if not isinstance(named, str):
        return data, ()
    place = Path(document.path).parent / named
    others = {key: value for key, value in data["design"].items() if key != "catalogue"}
    try:
        return {**data, "design": {**others, "catalogue": read_catalogue(place)}}, ()
    except ProblemError as error:
        found = error.diagnostics
    if any(each.line is None and not each.message.startswith("and ") for each in found):
        text = f"{named} {found[0].message}; it was looked for as {place}"
        document.note(document.find(("design", "catalogue")), text, "design.catalogue")
        found = ()
    return {**data, "design": others}, found


def with_named_catalogue(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a problem with the dampers of the file that it names, which is looked for as it is named."""
    design = data.get("design")
    if not isinstance(design, Mapping) or not isinstance(named := design.get("catalogue"), str):
        return dict(data)
    return {**data, "design": {**design, "catalogue": read_catalogue(named)}}


class _Sheet:
    """A file as cells with their places, and the mistakes in it so far."""

    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.mistakes: list[Diagnostic] = []
        numbered = enumerate(text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), 1)
        lines = [(n, line) for n, line in numbered if line.strip() and line.lstrip()[0] != "#"]
        _check_count(path, len(lines))
        self.separator = next((sign for sign in ";\t" if sign in lines[0][1]), ",")
        self.lines = lines

    def dampers(self) -> tuple[CatalogueDamper, ...]:
        """Return what the rows say, those without mistakes."""
        units = self._heads()
        if self.mistakes:
            return ()
        found: dict[str, tuple[CatalogueDamper, int]] = {}
        for line, source in self.lines[1:]:
            cells = self._cells(line, source)
            if not cells:
                continue
            if len(cells) != len(units):
                hint = "; the decimal sign is a point" if self.separator == "," and len(cells) > len(units) else ""
                self._note(cells[-1], "", f"the row has {len(cells)} cells, and there are {len(units)} columns{hint}")
                continue
            row = dict(zip(units, cells, strict=True))
            damper = self._damper(row, units)
            if damper is None:
                continue
            if damper.name in found:
                first = found[damper.name][1]
                self._note(row["name"], "name", f"{shown(damper.name)} stands twice, first on line {first}")
            found.setdefault(damper.name, (damper, line))
        return tuple(damper for damper, _ in found.values())

    def _note(self, cell: _Cell, key: str, message: str) -> None:
        self.mistakes.append(cell.mistake(self.path, key, message))

    def _heads(self) -> Mapping[str, str | None]:
        """Return the units of the columns by their names, in the order of the file."""
        found: dict[str, str | None] = {}
        meant: set[str | None] = set()
        cells = self._cells(*self.lines[0])
        for cell in cells:
            head = _HEAD.fullmatch(cell.text)
            name, unit = (head["name"], head["unit"]) if head else (cell.text, None)
            if name not in COLUMNS:
                bare = name.partition("(")[0].strip()
                meant.add(nearest(bare, COLUMNS))
                near = suggestion(bare, COLUMNS)
                self._note(cell, "", f"{shown(cell.text)} is no column{near}; columns are {', '.join(COLUMNS)}")
            elif name in found:
                self._note(cell, name, "stands twice")
            found[name] = unit
            self._check_unit(cell, name, unit)
        missing = [name for name in NEEDED if name not in found and name not in meant]
        if cells and missing:
            self._note(cells[0], "", f"the column {' and the column '.join(missing)} is missing")
        return found

    def _check_unit(self, cell: _Cell, name: str, unit: str | None) -> None:
        if unit is None or name not in COLUMNS:
            return
        row = QUANTITIES.get(name)
        wanted = row.unit if row else "-"
        try:
            if parse_unit(unit).dimension != parse_unit(wanted).dimension:
                text = f"[{unit}] is the unit of {kind_of(unit)}, expected {kind_of(wanted)}"
                raise ProblemError(f"{text} such as [{wanted}]" if row else f"{text}: {name} has no unit")
        except ProblemError as error:
            self._note(cell, name, error.diagnostics[0].message)

    def _cells(self, line: int, source: str) -> list[_Cell]:
        """Return the cells of a line; none, and a mistake, where a quote is left open."""
        try:
            [texts] = csv.reader([source], delimiter=self.separator, skipinitialspace=True, strict=True)
        except (csv.Error, ValueError) as error:
            self._note(_Cell(source, line, 1, source), "", f"cannot be read as cells: {error}")
            return []
        starts = _starts(source, self.separator)
        return [_Cell(text.strip(), line, start, source) for text, start in zip(texts, starts, strict=False)]

    def _damper(self, row: Mapping[str, _Cell], units: Mapping[str, str | None]) -> CatalogueDamper | None:
        before, values = len(self.mistakes), dict[str, Any]()
        for name, cell in row.items():
            if not cell.text and name not in NEEDED:
                continue
            try:
                values[name] = _value(name, cell.text, units[name])
            except ProblemError as error:
                self._note(cell, name, error.diagnostics[0].message)
        if len(self.mistakes) > before:
            return None
        try:
            return CatalogueDamper(**values)
        except ProblemError as error:
            for each in error.diagnostics:
                self._note(row[each.key], each.key, each.message)
        return None


class _WorkbookSheet(_Sheet):
    """The same of a sheet of a workbook."""

    separator = ""

    def __init__(self, path: str) -> None:
        self.path, self.mistakes = path, []
        book = Workbook(path)
        sheets = {sheet.strip().lower(): sheet for sheet in book.sheets}
        sheet = sheets.get(DAMPERS) or (book.sheets[0] if len(book.sheets) == 1 else None)
        if sheet is None:
            raise book.error(f"has no sheet {DAMPERS}, and not one only; it has {', '.join(map(shown, book.sheets))}")
        rows = [row for row in book.rows(sheet, MOST_ROWS + 1) if not next(iter(row.values())).text.startswith("#")]
        _check_count(path, len(rows))
        self.last = max(rows[0])
        self.rows = dict(enumerate(rows, 1))
        self.lines = [(n, "") for n in self.rows]

    def _cells(self, line: int, source: str) -> list[_Cell]:
        row = self.rows[line]
        wrong = [cell for cell in row.values() if cell.kind == MISTAKE]
        for cell in wrong:
            self._note(_Cell("", line, 1, source, cell.place), "", cell.text)
        beyond = [cell for k, cell in row.items() if k > self.last]
        if beyond and not wrong:
            self._note(_Cell("", line, 1, source, beyond[0].place), "", "stands in no column: it has no head")
        if wrong or beyond:
            return []
        first = next(iter(row.values())).place
        places = [row[k].place if k in row else first for k in range(self.last + 1)]
        texts = [row[k].text if k in row else "" for k in range(self.last + 1)]
        return [_Cell(text, line, k, source, place) for k, (text, place) in enumerate(zip(texts, places, strict=True))]


def _check_count(path: str, lines: int) -> None:
    message = "" if 1 < lines <= MOST_ROWS + 1 else f"has more than {MOST_ROWS} dampers"
    if lines < 2:
        message = "has no damper in it, only the heads of the columns" if lines else EMPTY
    if message:
        raise ProblemError([Diagnostic(path=path, message=message)])


def _value(name: str, text: str, unit: str | None) -> str:
    """Return what a cell says as a text with its unit."""
    row = QUANTITIES.get(name)
    if not text:
        raise ProblemError("has no value")
    if row is None or (row.rigid and text == "rigid"):
        return text
    if _DECIMAL_COMMA.fullmatch(text):
        raise ProblemError(f"{shown(text)}: the decimal sign is a point, {shown(text.replace(',', '.'))}")
    if split_quantity(text)[1]:
        return text
    if unit is None:
        raise ProblemError(
            f"{shown(text)} has no unit: head the column {name} [{row.unit}], or write {text} {row.unit}"
        )
    return f"{text} {unit}"


def _starts(source: str, separator: str) -> Iterator[int]:
    """Yield the columns at which the cells of a line begin, counted from 1; separators in quotes are none."""
    quoted, begin = False, 0
    for k, sign in enumerate((*source, separator)):
        quoted ^= sign == '"'
        if sign == separator and not quoted:
            cell = source[begin:k]
            yield begin + len(cell) - len(cell.lstrip()) + 1
            begin = k + 1

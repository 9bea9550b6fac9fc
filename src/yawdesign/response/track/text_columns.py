"""Tables in text files: numbers in columns whose heads have units, with the place of every mistake."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem.diagnostics import Diagnostic, ProblemError, nearest
from yawdesign.problem.units import kind_of, parse_unit, shortened
from yawdesign.response.track.text_sheets import KM_M, Fields, Heading, Sheet, is_chainage, report

Reader = Callable[[str], float]
_NUMBER = re.compile(r"[+\-\u2212]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")
_GROUPED = re.compile(r"[+\-\u2212]?[1-9][0-9]{0,2}(?:,[0-9]{3})+")
_CHAINAGE = re.compile(r"([0-9]+)\+([0-9]{3}(?:[.,][0-9]*)?)")
_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}


@dataclass(frozen=True)
class Column:
    """A column that a file may have.

    Parameters
    ----------
    units : tuple of str
        Units of the dimensions that are accepted.
    required : bool
        Whether the file must have it.
    counted : str
        What a unit that counts other angles than the first of the units is told; without it angles do not count.
    chainage : bool
        Whether values may be written as km+m.
    """

    units: tuple[str, ...]
    required: bool = True
    counted: str = ""
    chainage: bool = False


@dataclass(frozen=True, eq=False)
class Table:
    """The columns of a file that are used.

    Parameters
    ----------
    sheet : Sheet
        What stands in the file.
    index : mapping of str to int
        Which column has which name.
    values : mapping of str to ndarray
        Columns in SI.
    units : mapping of str to str
        Units as written.
    notes : tuple of str
        What a reader of the results must know.
    """

    sheet: Sheet
    index: Mapping[str, int]
    values: Mapping[str, Float]
    units: Mapping[str, str]
    notes: tuple[str, ...]

    @property
    def name(self) -> str:
        """Name of the file."""
        return self.sheet.name

    def mistake(self, row: int, column: str, message: str) -> Diagnostic:
        """Return a mistake at a row (counted from 0) and a column."""
        return _at(self.sheet, row, self.index[column], column, message)


def read_columns(sheet: Sheet, columns: Mapping[str, Column]) -> Table:
    """Return the columns of a sheet as numbers in SI; what is no column of these is noted and left out.

    Parameters
    ----------
    sheet : Sheet
        The file.
    columns : mapping of str to Column
        The columns that it may have.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong.
    """
    report(_head_mistakes(sheet, columns))
    index = {head.name: k for k, head in enumerate(sheet.heads) if head.name in columns}
    units = {name: sheet.heads[k].unit or "" for name, k in index.items()}
    count = len(sheet.heads)
    rows = [row for row, (_, fields) in enumerate(sheet.body) if _length(fields, count) == count]
    readers = {x: _chainages(unit) if columns[x].chainage else _scaled(unit) for x, unit in units.items()}
    values, found = _numbers(sheet, index, readers, rows)
    found = [*_lengths(sheet, rows), *_commas(sheet, index, rows), *found]
    report(sorted(found, key=lambda d: (d.line or 0, d.column or 0)))
    commas = _first_comma(sheet, index)
    other = [head.name or f"column {k}" for k, head in enumerate(sheet.heads, 1) if head.name not in columns]
    notes = [f"not used: {', '.join(map(shortened, other))}"] if other else []
    notes += [f"the comma is read as decimal sign: {commas} is {number(commas):g}"] if commas else []
    return Table(sheet, index, values, units, tuple(notes))


def _head_mistakes(sheet: Sheet, columns: Mapping[str, Column]) -> list[Diagnostic]:
    found, names = [], sheet.names()
    for k, head in enumerate(sheet.heads):
        try:
            if head.name in columns and head.name in names[:k]:
                raise ProblemError("stands twice")
            _check_head(head, columns, names)
        except ProblemError as error:
            found.append(sheet.mistake(head, error.diagnostics[0].message))
    for name in (x for x, column in columns.items() if column.required and x not in names):
        message = f"there is no column {name} [{columns[name].units[0]}]"
        found.append(Diagnostic(path=sheet.name, line=sheet.line, column=1, message=message))
    return found


def _check_head(head: Heading, columns: Mapping[str, Column], names: list[str]) -> None:
    if head.name not in columns:
        meant = nearest(head.name, columns)
        if meant and meant not in names:
            right = f"{meant} [{columns[meant].units[0]}]"
            raise ProblemError(f"is not known here; did you mean {right}? The columns are {', '.join(columns)}")
        return
    column = columns[head.name]
    if head.unit is None:
        raise ProblemError(f"has no unit: write {head.name} [{column.units[0]}]")
    if not (column.chainage and is_chainage(head.unit)):
        _check_unit(head.unit, column)


def _check_unit(unit: str, column: Column) -> None:
    right, expected = [parse_unit(other) for other in column.units], f"expected {' or '.join(column.units)}"
    try:
        size = parse_unit(unit)
    except ProblemError as error:
        raise ProblemError(f"{error.diagnostics[0].message}; {expected}") from None
    if all(size.dimension != other.dimension for other in right):
        raise ProblemError(f"{unit or '[]'} is {kind_of(unit)}, {expected}")
    if column.counted and size.angle != right[0].angle:
        raise ProblemError(f"{unit} {column.counted}")


def _length(fields: Fields, count: int) -> int:
    """Return the number of fields of a row; a separator at its end makes none."""
    return count if len(fields) == count + 1 and not fields[-1][1] else len(fields)


def _lengths(sheet: Sheet, rows: Sequence[int]) -> list[Diagnostic]:
    """Return the rows that have more or fewer fields than there are heads."""
    count, found, good = len(sheet.heads), [], set(rows)
    named, by = ", ".join(map(shortened, sheet.names())), _SEPARATORS[sheet.separator]
    for line, fields in (part for row, part in enumerate(sheet.body) if row not in good):
        hint = "; with decimal commas, separate columns by semicolons" if len(fields) > count else ""
        message = f"there are {len(fields)} values, expected {count} separated by {by}: {named}"
        message += hint if sheet.separator == "," else ""
        found.append(Diagnostic(path=sheet.name, line=line, column=1, message=message))
    return found


def _at(sheet: Sheet, row: int, column: int, key: str, message: str) -> Diagnostic:
    line, fields = sheet.body[row]
    return Diagnostic(path=sheet.name, line=line, column=fields[column][0], key=key, message=message)


def _commas(sheet: Sheet, index: Mapping[str, int], rows: Sequence[int]) -> list[Diagnostic]:
    """Return the numbers with a comma if it may be something else than a decimal sign."""
    if sheet.separator == ",":
        return []
    places = [(row, name, k, sheet.body[row][1][k][1]) for row in rows for name, k in index.items()]
    why = comma_mistake(text for *_, text in places)
    return [
        _at(sheet, row, k, name, f"{shortened(text)!r} {why}") for row, name, k, text in places if why and "," in text
    ]


def _first_comma(sheet: Sheet, index: Mapping[str, int]) -> str:
    """Return the first number with a decimal comma, or an empty text."""
    texts = (fields[k][1] for _, fields in sheet.body for k in index.values())
    return next((text for text in texts if "," in text and "+" not in text), "")


def _numbers(
    sheet: Sheet, index: Mapping[str, int], readers: Mapping[str, Reader], rows: Sequence[int]
) -> tuple[dict[str, Float], list[Diagnostic]]:
    found: list[Diagnostic] = []
    values = {name: np.zeros(len(rows)) for name in index}
    for name, k in index.items():
        for place, row in enumerate(rows):
            try:
                values[name][place] = readers[name](sheet.body[row][1][k][1])
            except ProblemError as error:
                found.append(_at(sheet, row, k, name, error.diagnostics[0].message))
    return values, found


def _scaled(unit: str) -> Reader:
    factor = float(parse_unit(unit).factor)

    def read(text: str) -> float:
        value = number(text) * factor
        if math.isinf(value):
            raise ProblemError(f"{shortened(text)!r} is too large to compute with")
        return value

    return read


def _chainages(unit: str) -> Reader:
    plain = None if is_chainage(unit) else _scaled(unit)

    def read(text: str) -> float:
        metres = chainage(text)
        if metres is None and plain is None:
            raise ProblemError(f"{shortened(text)!r} is not {KM_M}, such as 12+034.5")
        return plain(text) if metres is None and plain else float(metres or 0)

    return read


def number(text: str) -> float:
    """Return the number that stands in a cell.

    Raises
    ------
    ProblemError
        If there is none, or none that can be computed with.

    Examples
    --------
    >>> number("-2.5e-3"), number("0,25")
    (-0.0025, 0.25)
    """
    if not text:
        raise ProblemError("the value is missing")
    if not _NUMBER.fullmatch(text):
        raise ProblemError(f"{shortened(text)!r} is not a number")
    found = float(text.replace(",", ".").replace("\u2212", "-"))
    if math.isinf(found):
        raise ProblemError(f"{shortened(text)!r} is too large to compute with")
    if not found and re.search("[1-9]", re.split("[eE]", text)[0]):
        raise ProblemError(f"{shortened(text)!r} is too small to compute with")
    return found


def chainage(text: str) -> float | None:
    """Return the metres of a chainage such as ``12+345.6``, or None where no + stands between digits.

    Raises
    ------
    ProblemError
        If the metres are not written with three digits.
    """
    if "+" not in re.sub(r"[eE]\+", "", text[1:]):
        return None
    found = _CHAINAGE.fullmatch(text)
    if not found:
        raise ProblemError(f"{shortened(text)!r} is not kilometres, + and three digits of metres, such as 12+034.5")
    return 1000 * number(found[1]) + number(found[2])


def comma_mistake(texts: Iterable[str]) -> str | None:
    """Return why the commas in the cells of a table cannot be read as decimal signs, or None.

    Examples
    --------
    >>> comma_mistake(["0,25", "1,435"]), comma_mistake(["0,25", "1.5"]) is None
    (None, False)
    """
    listed = list(texts)
    commas = [text for text in listed if "," in text]
    if commas and any("." in text for text in listed):
        return "has a comma, other numbers have a point: write all decimal signs alike, and none between thousands"
    if commas and all(_GROUPED.fullmatch(text) for text in commas):
        plain, point = commas[0].replace(",", ""), commas[0].replace(",", ".", 1)
        return f"may be {point} or {plain}: write the decimal sign as '.', and none between thousands"
    return None

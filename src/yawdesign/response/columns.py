"""Tables in text files: numbers in columns whose heads have units, with the place of every mistake."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike, fspath

import numpy as np

from yawdesign.problem.diagnostics import Diagnostic, ProblemError, unknown_key
from yawdesign.problem.units import kind_of, parse_unit
from yawdesign.response.system import Float
from yawdesign.response.text_file import text_of

MOST_SHOWN = 20


@dataclass(frozen=True)
class Column:
    """A column that a file may have.

    Parameters
    ----------
    units : tuple of str
        Units of the dimensions that are accepted.
    required : bool
        Whether the file must have it.
    """

    units: tuple[str, ...]
    required: bool = True


@dataclass(frozen=True, eq=False)
class Table:
    """What stands in a file.

    Parameters
    ----------
    name : str
        Name of the file.
    values : mapping of str to ndarray
        Columns in SI.
    units : mapping of str to str
        Units as written in the head.
    lines : list of int
        Line of each row.
    places : list of list of int
        Where each field of each row begins, counted from 1.
    order : list of str
        Names in the order of the columns.
    """

    name: str
    values: Mapping[str, Float]
    units: Mapping[str, str]
    lines: list[int]
    places: list[list[int]]
    order: list[str]

    def mistake(self, row: int, column: str, message: str) -> Diagnostic:
        """Return a mistake at a row (counted from 0) and a column."""
        place = self.places[row][self.order.index(column)]
        return Diagnostic(path=self.name, line=self.lines[row], column=place, key=column, message=message)


def report(found: list[Diagnostic]) -> None:
    """Raise all mistakes, or the first of them and how many more there are."""
    if len(found) > MOST_SHOWN:
        more = Diagnostic(path=found[0].path, message=f"and {len(found) - MOST_SHOWN} more mistakes of this kind")
        found = [*found[:MOST_SHOWN], more]
    if found:
        raise ProblemError(found)


def read_columns(path: str | PathLike[str], columns: Mapping[str, Column]) -> Table:
    """Read a file of numbers separated by commas or semicolons, whose first line is ``name [unit], name [unit], ...``.

    Empty lines and lines that begin with # are left out.

    Parameters
    ----------
    path : path
        Name of the file.
    columns : mapping of str to Column
        The columns that it may have.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong.
    """
    name = fspath(path)
    rows = _rows(name)
    if not rows:
        raise ProblemError([Diagnostic(path=name, message="the file is empty")])
    (line, head), *body = rows
    order, units, factors = _head(name, line, head, columns)
    found: list[Diagnostic] = []
    data = np.empty((len(body), len(order)))
    for k, (line, fields) in enumerate(body):
        data[k], mistakes = _numbers(name, line, fields, order)
        found += mistakes
    report(found)
    values = {x: data[:, k] * factors[k] for k, x in enumerate(order)}
    return Table(name, values, units, [n for n, _ in body], [[p for p, _ in fields] for _, fields in body], order)


Fields = list[tuple[int, str]]  # where each begins, and what it says


def _rows(name: str) -> list[tuple[int, Fields]]:
    every = enumerate(text_of(name).splitlines(), 1)
    lines = [(n, line) for n, line in every if line.strip() and line.lstrip()[0] != "#"]
    separator = ";" if lines and ";" in lines[0][1] else ","
    return [(n, _split(line, separator)) for n, line in lines]


def _split(line: str, separator: str) -> Fields:
    fields, start = [], 1
    for part in line.split(separator):
        fields.append((start + len(part) - len(part.lstrip()), part.strip().strip('"')))
        start += len(part) + 1
    return fields


def _head(
    name: str, line: int, fields: Fields, columns: Mapping[str, Column]
) -> tuple[list[str], dict[str, str], list[float]]:
    found: list[Diagnostic] = []
    order: list[str] = []
    units: dict[str, str] = {}
    factors: list[float] = []
    for place, text in fields:
        key, unit = (part.strip(" ]") for part in (*text.split("[", 1), "")[:2])
        try:
            if key in order:
                raise ProblemError("stands twice")
            factors.append(_factor(key, unit, columns, "[" in text))
        except ProblemError as error:
            message = error.diagnostics[0].message
            found.append(Diagnostic(path=name, line=line, column=place, key=key, message=message))
        order.append(key)
        units[key] = unit
    for key in (x for x, column in columns.items() if column.required and x not in order):
        example = f"{key} [{columns[key].units[0]}]"
        found.append(Diagnostic(path=name, line=line, column=1, message=f"there is no column {example}"))
    report(found)
    return order, units, factors


def _factor(key: str, unit: str, columns: Mapping[str, Column], has_unit: bool) -> float:
    if key not in columns:
        raise ProblemError(unknown_key(key, columns) + f"; the columns are {', '.join(columns)}")
    allowed = columns[key].units
    if not has_unit:
        raise ProblemError(f"has no unit: write {key} [{allowed[0]}]")
    size = parse_unit(unit)
    if all(size.dimension != parse_unit(other).dimension for other in allowed):
        raise ProblemError(f"{unit} is {kind_of(unit)}, expected {' or '.join(allowed)}")
    return float(size.factor)


def _numbers(name: str, line: int, fields: Fields, order: list[str]) -> tuple[list[float], list[Diagnostic]]:
    if len(fields) != len(order):
        message = f"there are {len(fields)} values, expected {len(order)}: {', '.join(order)}"
        return [np.nan] * len(order), [Diagnostic(path=name, line=line, column=1, message=message)]
    values, found = [], []
    for (place, text), key in zip(fields, order, strict=True):
        values.append(_number(text))
        if not np.isfinite(values[-1]):
            message = f"{text!r} is not a number" if text else "the value is missing"
            found.append(Diagnostic(path=name, line=line, column=place, key=key, message=message))
    return values, found


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan

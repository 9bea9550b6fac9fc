"""Text files of columns as heads and texts: separators, units in or below the heads, and the place of everything."""

import re
from dataclasses import dataclass, replace
from os import PathLike, fspath

from yawdesign.problem.diagnostics import Diagnostic, ProblemError
from yawdesign.problem.text_files import text_of
from yawdesign.problem.units import Unit, parse_unit, shortened

MOST_BYTES = 50_000_000  # about 400 km of track, measured every quarter of a metre
MOST_SHOWN = 20
KM_M = "km+m"  # the unit of chainages such as 12+345.6
_HEAD = re.compile(r"(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")


@dataclass(frozen=True)
class Heading:
    """Head of a column: where it stands, the name, and the unit if there is one."""

    place: int
    name: str
    unit: str | None


Fields = list[tuple[int, str]]  # where each begins, counted from 1, and what it says


@dataclass(frozen=True)
class Sheet:
    """A file as heads and texts.

    Parameters
    ----------
    name : str
        Name of the file.
    separator : str
        What stands between columns.
    line : int
        Line of the heads.
    heads : list of Heading
        One for each column.
    body : list of tuple
        Line and fields of each row.
    """

    name: str
    separator: str
    line: int
    heads: list[Heading]
    body: list[tuple[int, Fields]]

    def mistake(self, head: Heading, message: str) -> Diagnostic:
        """Return a mistake in a head."""
        return Diagnostic(path=self.name, line=self.line, column=head.place, key=head.name, message=message)

    def names(self) -> list[str]:
        """Return the names of the columns."""
        return [head.name for head in self.heads]


def report(found: list[Diagnostic]) -> None:
    """Raise all mistakes, or the first of them and how many more there are."""
    if len(found) > MOST_SHOWN:
        more = Diagnostic(path=found[0].path, message=f"and {len(found) - MOST_SHOWN} more mistakes of this kind")
        found = [*found[:MOST_SHOWN], more]
    if found:
        raise ProblemError(found)


def read_sheet(path: str | PathLike[str]) -> Sheet:
    """Read a file of columns separated by commas, semicolons or tabs, the first line ``name [unit], name [unit], ...``.

    Empty lines and lines that begin with # are left out. The units may also stand in the second line.

    Parameters
    ----------
    path : path
        Name of the file.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong with the heads.
    """
    name = fspath(path)
    every = enumerate(text_of(name, MOST_BYTES).split("\n"), 1)
    lines = [(n, line) for n, line in every if line.strip() and line.lstrip()[0] != "#"]
    if not lines:
        raise ProblemError([Diagnostic(path=name, message="the file is empty")])
    head = lines[0][1]
    separator = next((sign for sign in ";,\t" if sign in head), ",")
    (line, fields), *body = [(n, _split(text, separator)) for n, text in lines]
    sheet = Sheet(name, separator, line, [_heading(name, line, *field) for field in fields], body)
    return _with_units_below(sheet) if body and _has_units(body[0][1]) else sheet


def _split(line: str, separator: str) -> Fields:
    fields, start = [], 1
    for part in line.split(separator):
        fields.append((start + len(part) - len(part.lstrip()), part.strip().strip('"').strip()))
        start += len(part) + 1
    return fields


def _heading(name: str, line: int, place: int, text: str) -> Heading:
    found = _HEAD.fullmatch(text)
    if found is None:
        message = f"{shortened(text)!r} is not one head, name [unit]: separate columns by commas, semicolons or tabs"
        raise ProblemError([Diagnostic(path=name, line=line, column=place, message=message)])
    return Heading(place, found["name"], found["unit"])


def _has_units(fields: Fields) -> bool:
    """Return whether a row consists of units."""
    texts = [_bare_unit(text) for _, text in fields]
    return any(texts) and all(not text or (_unit(text) is not None and text != "1") for text in texts)


def _bare_unit(text: str) -> str:
    return text.removeprefix("[").removesuffix("]").strip()


def _unit(text: str) -> Unit | None:
    try:
        return parse_unit("m" if is_chainage(text) else text)
    except ProblemError:
        return None


def is_chainage(unit: str) -> bool:
    """Return whether a unit is that of chainages."""
    return unit.replace(" ", "") == KM_M


def _with_units_below(sheet: Sheet) -> Sheet:
    """Return the sheet with the units of its second line, which must be those of the heads that have one."""
    (line, fields), *body = sheet.body
    found, heads = [], []
    for head, (place, text) in zip(sheet.heads, fields, strict=False):
        unit = _bare_unit(text) or None
        if unit and head.unit is not None and _unit(unit) != _unit(head.unit):
            message = f"the unit here is {unit}, in the head it is {head.unit}"
            found.append(Diagnostic(path=sheet.name, line=line, column=place, key=head.name, message=message))
        heads.append(replace(head, unit=head.unit if head.unit is not None else unit))
    report(found)
    return replace(sheet, heads=[*heads, *sheet.heads[len(heads) :]], body=body)

"""A problem as a workbook: its values as rows of a sheet, with units and meanings, and its dampers as another."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from .catalogue_file import DAMPERS
from .damper_catalogue import COLUMNS, QUANTITIES
from .diagnostics import ProblemError
from .document import Document, Mapping, Node, Scalar, Sequence, compose
from .parameters import ADDED, BOGIE, PARAMETERS, VERTICAL
from .problem_sheet import HEADS, SHEET, path_of
from .quantities import split_quantity
from .running import CURVE
from .starter import starter
from .workbook_writing import MOST_SIGNS, SheetRows

DIGITS = 16  # with which openpyxl writes a number
MEANINGS = {
    "title": "any text",
    "equations": "reciprocal, or as-printed to compare with the paper",
    "bogie.kind": "power: two motors hung on the frame; trailer: none",
    "speed": "running speed; several: [200 km/h, 300 km/h]; a range: speed.min, speed.max",
    "curve.load": "Q is the axle load W (axle) or the wheel load W/2 (wheel)",
    "design.objective": "decay_rate or damping_ratio: what is made as large as possible",
}


def problem_sheets(text: str) -> dict[str, SheetRows]:
    """Return the sheets of a problem that is given as the text of a problem file."""
    document = compose(text, SHEET)
    rows, dampers = [], Sequence(0, 0)
    for path, node in _leaves(document.root, ()):
        if path == ("design", "catalogue") and isinstance(node, Sequence):
            dampers = node
        else:
            rows.append(_row(document, path, node))
    sheets = {SHEET: SheetRows(HEADS, rows)}
    return sheets | ({DAMPERS: _catalogue(dampers)} if dampers.items else {})


def starter_sheets(kind: str, *, car_body: bool) -> dict[str, SheetRows]:
    """Return the sheets of a problem to start from, in which what a bogie may have besides stands without values."""
    sheets = problem_sheets(starter(kind, car_body=car_body))
    rows = list(sheets[SHEET].rows)
    end = 1 + max(k for k, row in enumerate(rows) if row[0].startswith("bogie."))
    more = [BOGIE[key] for key in ADDED if not (car_body and key in VERTICAL)]
    rows[end:end] = [(f"bogie.{row.key}", None, row.unit, f"{row.meaning} (may be left empty)") for row in more]
    return {**sheets, SHEET: SheetRows(HEADS, rows)}


def _leaves(node: Node, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Node]]:
    """Yield what is to stand in a row, with its path."""
    if isinstance(node, Mapping) and node.values and not _ambiguous(node, path):
        for key, inner in node.values.items():
            yield from _leaves(inner, (*path, key))
    else:
        yield path, node


def _ambiguous(node: Mapping, path: tuple[str, ...]) -> bool:
    """Return whether a dotted key would not be read as the path that it stands for."""
    paths = [(*path, key) for key in node.values]
    leaves = [x for x, inner in zip(paths, node.values.values(), strict=True) if not isinstance(inner, Mapping)]
    return any(path_of(".".join(x), whole=False) != x for x in leaves)


def _row(document: Document, path: tuple[str, ...], node: Node) -> tuple[Any, ...]:
    key = ".".join(path)
    meaning = MEANINGS.get(key) or _meaning(path)
    if not isinstance(node, Scalar):
        written = document.text[node.start : node.end]
        if len(written) > MOST_SIGNS:
            raise ProblemError(f"{key} is too long for a cell: keep the problem as YAML")
        return (key, written, None, meaning)
    return (key, *_value_and_unit(node), meaning)


def _meaning(path: tuple[str, ...]) -> str | None:
    if path[0] in ("bogie", "car_body") and path[-1] in PARAMETERS:
        return PARAMETERS[path[-1]].meaning
    if path[0] == "curve" and path[-1] in CURVE:
        return CURVE[path[-1]].meaning
    named = [PARAMETERS[key].meaning for part in path[1:] if (key := part.rpartition(".")[2]) in PARAMETERS]
    return named[-1] if named else None


def _value_and_unit(node: Scalar) -> tuple[Any, str | None]:
    """Return the number and the unit of a quantity; a number that a cell cannot hold exactly stays a text."""
    if node.plain and node.text in ("true", "false"):
        return node.text == "true", None
    if not node.plain:
        return node.text, None
    try:
        number, unit = split_quantity(node.text)
    except ProblemError:
        return node.text, None
    nearest = float(number)
    if Fraction(f"{nearest:.{DIGITS}g}") != number:
        return node.text, None
    return (int(nearest) if nearest.is_integer() and abs(nearest) < 1e15 else nearest), unit or None


def _catalogue(dampers: Sequence) -> SheetRows:
    """Return the sheet of the dampers, with the units of their columns in the heads."""
    names = [name for name in COLUMNS if any(isinstance(x, Mapping) and name in x.values for x in dampers.items)]
    heads = [f"{name} [{QUANTITIES[name].unit}]" if name in QUANTITIES else name for name in names]
    rows = [[_damper_cell(name, x.values.get(name)) for name in names] for x in dampers.items if isinstance(x, Mapping)]
    return SheetRows(heads, rows)


def _damper_cell(name: str, node: Node | None) -> Any:
    if not isinstance(node, Scalar):
        return None
    value, unit = _value_and_unit(node)
    wanted = QUANTITIES[name].unit if name in QUANTITIES else None
    return value if unit == wanted else node.text

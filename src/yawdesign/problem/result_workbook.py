"""A result as sheets of a workbook: what it has once, each of its tables, and where it comes from."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from dataclasses import fields
from datetime import UTC, datetime
from importlib import import_module
from typing import Any

from .data_frames import UNITS, only_row
from .workbook_writing import SheetRows

SUMMARY, PROVENANCE = "summary", "provenance"
SPEEDS = dict.fromkeys(("stable_up_to", "speed_wanted"), "m/s")
# What several of it are called -> what one is called.
PLURALS = {
    **{"eigenvalues": "eigenvalue", "stable_intervals": "C_s", "speeds": "speed", "decay_rates": "decay_rate"},
    "searched": "speed",
}


def result_sheets(result: Any, tables: Mapping[str, Mapping[str, Any]], own: Mapping[str, str]) -> dict[str, SheetRows]:
    """Return the sheets of a result.

    Parameters
    ----------
    result : Result
        The result.
    tables : mapping of str to mapping
        Its tables: columns by name.
    own : mapping of str to str
        SI units of columns that mean something else elsewhere.
    """
    known = {**UNITS, **SPEEDS, **_of_margin(result), **own}
    told, entries = only_row(result).items(), result.to_dict().keys()  # what is drawn is no entry
    rows = [(name, x[0], _unit(name, known)) for name, x in told if name.partition(".")[0] in entries]
    sheets = {SUMMARY: SheetRows(("what", "value", "unit"), rows)}
    for name, columns in tables.items():
        heads = [f"{head} [{unit}]" if (unit := _unit(head, known)) else head for head in columns]
        if values := [list(row) for row in zip(*columns.values(), strict=True)]:
            sheets[name] = SheetRows(heads, values)
    sheets |= dict(_lists(result, known))
    return sheets | {PROVENANCE: SheetRows(("what", "value"), [*_provenance(result)])}


def _of_margin(result: Any) -> dict[str, str]:
    """Return the units of margins, which depend on what was maximised."""
    unit = {"decay_rate": "1/s", "damping_ratio": "-"}.get(getattr(result, "objective", ""))
    return dict.fromkeys(("margin", "margin_before", "next_margin"), unit) if unit else {}


def _lists(result: Any, known: Mapping[str, str]) -> Iterator[tuple[str, SheetRows]]:
    """Yield what a result has as plain lists: of numbers, of complex numbers, of intervals."""
    for field in fields(result):
        values = getattr(result, field.name)
        rows = [_listed(x) for x in values] if isinstance(values, (tuple, list)) else []
        if not rows or not rows[0] or any(len(row) != len(rows[0]) for row in rows):
            continue
        heads = {1: [field.name], 2: ["real", "imaginary"] if isinstance(values[0], complex) else ["from", "to"]}
        unit = _unit(PLURALS.get(field.name, field.name), known)
        names = heads.get(len(rows[0]), [str(k) for k in range(len(rows[0]))])
        yield field.name, SheetRows([f"{head} [{unit}]" if unit else head for head in names], rows)


def _listed(value: Any) -> list[Any]:
    """Return the cells of an entry of a list; none if it is no number, word or pair of these."""
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, (int, float, str)):
        return [value]
    if isinstance(value, (tuple, list)) and all(isinstance(x, (int, float)) for x in value):
        return list(value)
    return []


def _unit(name: str, known: Mapping[str, str]) -> str | None:
    unit = known.get(name) or known.get(name.rpartition(".")[2])
    return None if unit in (None, "-") else unit


def _provenance(result: Any) -> Iterator[tuple[str, Any]]:
    yield "result", type(result).__name__
    yield "units", "SI, in the heads of the columns"
    yield "yawdesign", import_module("yawdesign").__version__
    yield "Python", platform.python_version()
    yield "written", datetime.now(UTC).isoformat(timespec="seconds")
    yield from _flat(getattr(result, "provenance", {}))


def _flat(data: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in data.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value

"""Workbooks that are written: sheets of rows, texts as texts whatever they hold."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import Any

from .characters import is_refused
from .diagnostics import ProblemError
from .whole_files import refuse_existing, write_whole
from .workbook import ENDING, is_workbook, openpyxl

MOST_SIGNS = 32_000  # of a cell; Excel has room for 32 767
WIDEST = 60  # column, in signs
_TAKEN_FOR_FORMULAS = ("=", "+", "-", "@")
_TAKEN_FOR_CHARACTERS = re.compile("_(?=x[0-9A-Fa-f]{4}_)")
_NOT_IN_NAMES = re.compile(r"[\\/*?:\[\]]")


@dataclass(frozen=True)
class SheetRows:
    """A sheet to write.

    Parameters
    ----------
    heads : sequence of str
        Of the columns.
    rows : sequence of sequence
        Numbers, texts, truth values, or None for an empty cell.
    """

    heads: Sequence[str]
    rows: Sequence[Sequence[Any]]


def write_workbook(path: str | PathLike[str], sheets: Mapping[str, SheetRows], *, replace: bool = False) -> None:
    """Write a workbook, as a whole or not at all.

    Parameters
    ----------
    path : path
        Its name ends in .xlsx.
    sheets : mapping of str to SheetRows
        By their names.
    replace : bool
        Whether it may take the place of another file.

    Raises
    ------
    ProblemError
        If the name has another ending, there is such a file, or openpyxl is not installed.
    """
    if not is_workbook(str(path)):
        raise ProblemError(f"{path} must end in {ENDING}")
    refuse_existing(Path(path), replace)
    book = openpyxl().Workbook()
    book.remove(book.active)
    for name, sheet in sheets.items():
        _fill(book.create_sheet(_NOT_IN_NAMES.sub("-", name)[:31]), sheet)
    content = io.BytesIO()
    book.save(content)
    write_whole(Path(path), content.getvalue(), replace=replace)


def _fill(page: Any, sheet: SheetRows) -> None:
    from openpyxl.styles import Font

    for n, row in enumerate([sheet.heads, *sheet.rows], 1):
        for k, value in enumerate(row, 1):
            if value is not None:
                _put(page.cell(n, k), value)
    for cell in page[1]:
        cell.font = Font(bold=True)
    page.freeze_panes = "A2"
    for k, head in enumerate(sheet.heads, 1):
        longest = max([len(str(head)), *(len(str(row[k - 1])) for row in sheet.rows[:500] if k <= len(row))])
        page.column_dimensions[page.cell(1, k).column_letter].width = min(WIDEST, longest + 2)


def _put(cell: Any, value: Any) -> None:
    """Put a value into a cell; a text that begins like a formula is none."""
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, (bool, int)) or (isinstance(value, float) and isfinite(value)):
        cell.value = float(value) if isinstance(value, float) else value
        return
    text = cell_text(str(value))
    cell.value = text
    cell.data_type = "s"
    cell.quotePrefix = text.startswith(_TAKEN_FOR_FORMULAS)


def cell_text(value: str) -> str:
    """Return a text as a cell can hold it: what it cannot hold is shown as missing, and too long a text ends in dots.

    Examples
    --------
    >>> cell_text("a" + chr(7) + "b") == "a" + chr(0xFFFD) + "b"
    True
    """
    shown = "".join("\ufffd" if is_refused(sign) and sign != "\n" else sign for sign in value)
    shown = _TAKEN_FOR_CHARACTERS.sub("_x005F_", shown)
    return shown if len(shown) <= MOST_SIGNS else f"{shown[:MOST_SIGNS]}..."

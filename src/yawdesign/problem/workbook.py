"""Workbooks as sheets of cells: opened only when they are small, formulas by the values that were kept with them."""

from __future__ import annotations

import io
import re
import zipfile
from dataclasses import dataclass
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Any

from .characters import refusal
from .diagnostics import Diagnostic, ProblemError

ENDING = ".xlsx"
MOST_BYTES = 10_000_000  # of the file
MOST_UNPACKED = 60_000_000  # bytes
MOST_PARTS = 1_000
MOST_COLUMNS, LAST_ROW = 20, 1_048_576
INSTALL = 'Excel files need openpyxl: pip install "yawdesign[excel]"'
NUMBER, TEXT, SWITCH, MISTAKE = "number", "text", "switch", "mistake"
_LETTERS = "ABCDEFGHIJKLMNOPQRST"
_ESCAPED = re.compile("_x([0-9A-Fa-f]{4})_")  # how a workbook writes a character that it could not hold otherwise


@dataclass(frozen=True)
class Cell:
    """A cell that is not empty.

    Parameters
    ----------
    place : str
        Sheet and cell, such as ``problem!B7``.
    text : str
        What it says; of a number its shortest decimal.
    kind : str
        ``number``, ``text``, ``switch``, or ``mistake``: then the text says what is wrong.
    """

    place: str
    text: str
    kind: str


Row = dict[int, Cell]  # by the columns, counted from 0


def is_workbook(name: str) -> bool:
    """Return whether the name of a file is that of a workbook."""
    return name.lower().endswith(ENDING)


def openpyxl() -> Any:
    """Return the library that reads and writes workbooks.

    Raises
    ------
    ProblemError
        If it is not installed.
    """
    try:
        import openpyxl
    except ImportError:
        raise ProblemError(INSTALL) from None
    return openpyxl


class Workbook:
    """A workbook that is read.

    Parameters
    ----------
    name : str
        Name of the file.

    Raises
    ------
    ProblemError
        If it cannot be read, is too large, or is no workbook.
    """

    def __init__(self, name: str) -> None:
        library = openpyxl()
        self.name = name
        try:
            content = _content_of(Path(name))
            # Twice: the values that were kept, and the formulas, of which some may have none.
            opened = partial(library.load_workbook, read_only=True)
            self._books = [opened(io.BytesIO(content), data_only=kept) for kept in (True, False)]
        except ProblemError as error:
            raise self.error(error.diagnostics[0].message) from None
        except (OSError, ValueError) as error:
            raise self.error(f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
        except Exception as error:  # noqa: BLE001 - a damaged workbook shows itself in many ways
            raise self.error(f"is no workbook that can be read ({type(error).__name__})") from None

    def error(self, message: str, cell: str = "") -> ProblemError:
        """Return the error that ends the reading."""
        return ProblemError([Diagnostic(path=self.name, cell=cell, message=message)])

    @property
    def sheets(self) -> tuple[str, ...]:
        """Names of the sheets."""
        return tuple(sheet.title for sheet in self._books[0].worksheets)

    def rows(self, sheet: str, most: int) -> list[Row]:
        """Return the rows of a sheet that are not empty.

        Raises
        ------
        ProblemError
            If there are more than `most`, or the sheet is damaged.
        """
        found: list[Row] = []
        both = (book[sheet].iter_rows(max_row=LAST_ROW, max_col=MOST_COLUMNS) for book in self._books)
        try:
            for k, (values, formulas) in enumerate(zip(*both, strict=False), 1):
                pairs = enumerate(zip(values, formulas, strict=False))
                cells = {n: cell for n, (x, y) in pairs if (cell := _cell(f"{sheet}!{_LETTERS[n]}{k}", x, y))}
                if cells:
                    found.append(cells)
                if len(found) > most:
                    break
        except Exception as error:  # noqa: BLE001 - as above
            raise self.error(f"is no workbook that can be read ({type(error).__name__})", sheet) from None
        if len(found) > most:
            raise self.error(f"has more than {most} rows", sheet)
        return found


def _content_of(path: Path) -> bytes:
    """Return a file that is not larger, and does not unpack to more, than a workbook of numbers does."""
    if path.exists() and not path.is_file():
        raise ProblemError("is no file")
    with path.open("rb") as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ProblemError(f"is larger than {MOST_BYTES / 1e6:g} MB: give a part of it")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            parts = archive.infolist()
            if len(parts) > MOST_PARTS or sum(part.file_size for part in parts) > MOST_UNPACKED:
                raise ProblemError(f"unpacks to more than {MOST_UNPACKED / 1e6:g} MB: give a part of it")
            if any(b"<!DOCTYPE" in archive.read(part) for part in parts if part.filename.endswith((".xml", ".rels"))):
                raise ProblemError("declares a document type, which no workbook does")
    except zipfile.BadZipFile:
        raise ProblemError("is no workbook: save it as Excel workbook (.xlsx)") from None
    return content


def _cell(place: str, value: Any, formula: Any) -> Cell | None:
    """Return a cell; nothing if it is empty."""
    if value.value is None:
        why = "holds a formula without a value: open the file in Excel or LibreOffice, and save it"
        return Cell(place, why, MISTAKE) if formula.data_type == "f" else None
    found = Cell(place, *_content(value))
    return found if found.text else None


def _content(cell: Any) -> tuple[str, str]:
    """Return what a cell says, and what kind of value that is."""
    x = cell.value
    if isinstance(x, bool):
        return str(x).lower(), SWITCH
    if isinstance(x, (int, float)):
        share = "%" in str(cell.number_format)
        return (f"{Decimal(repr(x)) * 100:f} %" if share else repr(x)), NUMBER
    if not isinstance(x, str):
        return "is a date or a time: write the number, or format the cell as text", MISTAKE
    if cell.data_type == "e":
        return f"holds the error {x}", MISTAKE
    text = _ESCAPED.sub(lambda match: chr(int(match[1], 16)), x).strip()
    why = refusal(text.replace("\n", " "))
    return (text, TEXT) if why is None else (why, MISTAKE)

"""What every result has in common: frozen plain data, a dictionary for JSON, a readable table."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

from .data_frames import chosen_table, data_frame, only_row, tables_in
from .notebook_view import NotebookView
from .result_workbook import result_sheets
from .workbook_writing import write_workbook

if TYPE_CHECKING:
    import pandas


MOST_ENTRIES, MOST_KEYS = 6, 12  # of a list, and of a mapping, that a line of a result's table shows


@dataclass(frozen=True, repr=False)
class Result(NotebookView):
    """A result: its attributes are the keys of `to_dict`."""

    def _entries(self) -> Mapping[str, Any]:
        """Return its values by the keys of `to_dict`."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold; what does not exist is None, a complex number is [re, im]."""
        return {name: plain(value) for name, value in self._entries().items()}

    def to_pandas(self, of: str | None = None) -> "pandas.DataFrame":
        """Return one of its tables as a table of pandas, with a row for each entry; one row if it has no table.

        Parameters
        ----------
        of : str, optional
            Which: the name of an attribute that has entries, such as ``"requirements"``; the first of them if not
            given. Values are in SI units, those of the columns stand in ``attrs["units"]``.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        ProblemError
            If there is no such table, or pandas is not installed.
        """
        tables = self._tables()
        if not tables and of is None:
            return data_frame(only_row(self), self._units())
        return data_frame(tables[chosen_table(self, tables, of)], self._units())

    def to_excel(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write its tables as a workbook, a sheet each, with SI units in the heads and where it comes from.

        Parameters
        ----------
        path : path
            Its name ends in .xlsx.
        replace : bool
            Whether another file may be replaced.

        Raises
        ------
        ProblemError
            If there is a file and it may not be replaced, or openpyxl is not installed (``yawdesign[excel]``).
        """
        write_workbook(path, result_sheets(self, self._tables(), self._units()), replace=replace)

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        """Return its tables by name, the first one first: columns by name."""
        return dict(tables_in(self))

    def _units(self) -> Mapping[str, str]:
        """Return the SI units of columns that mean something else elsewhere."""
        return {}

    def __repr__(self) -> str:
        rows = [(name, _cell(value)) for name, value in self._entries().items()]
        width = max(len(name) for name, _ in rows)
        return "\n".join([type(self).__name__, *(f"  {name:<{width}}  {cell}" for name, cell in rows)])


def plain(value: Any) -> Any:
    """Return a value as JSON can hold it."""
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        entries = value.tolist() if hasattr(value, "tolist") else value
        return [plain(entry) for entry in entries] if isinstance(entries, (list, tuple)) else plain(entries)
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, Mapping):
        return _first([f"{key}={_cell(entry)}" for key, entry in [*value.items()][:MOST_KEYS]], len(value))
    if isinstance(value, (list, tuple)):
        return _first([_cell(entry) for entry in value[:MOST_ENTRIES]], len(value))
    if isinstance(value, complex):
        return f"{value.real:.6g}{value.imag:+.6g}j"
    if is_dataclass(value) and not isinstance(value, type):
        return "(" + ", ".join(f"{f.name}={_cell(getattr(value, f.name))}" for f in fields(value)) + ")"
    return str(value)


def _first(cells: list[str], count: int) -> str:
    """Return the first entries of a list or a mapping, and how many there are if these are not all."""
    rest = [f"... ({count} in all)"] if count > len(cells) else []
    return ", ".join([*cells, *rest]) or "none"

"""Problem files: from text to a checked problem, with all mistakes at once and the place of each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any, BinaryIO, Literal

from .catalogue_file import with_catalogue
from .changes import NewValue, changed
from .diagnostics import Diagnostic, ProblemError
from .document import MOST_BYTES, Document, Path, compose, plain_data
from .doubts import doubts
from .faults import dotted, placed
from .file_data import checked_data
from .presets import without_removed
from .problem import Problem
from .problem_sheet import workbook_document
from .workbook import is_workbook

Report = tuple[Problem | None, tuple[Diagnostic, ...]]


def load(path: str | PathLike[str]) -> Problem:
    """Read a problem file, or a workbook (.xlsx) with a sheet named problem.

    Parameters
    ----------
    path : path
        Name of the file.

    Returns
    -------
    Problem
        The problem, in SI.

    Raises
    ------
    ProblemError
        If the file cannot be read or has mistakes; all of them are listed.
    """
    return _accepted(read(path))


def loads(text: str, name: str = "<text>") -> Problem:
    """Read a problem from a text.

    Parameters
    ----------
    text : str
        YAML 1.2.
    name : str
        Name that stands in messages.

    Returns
    -------
    Problem
        The problem, in SI.

    Raises
    ------
    ProblemError
        If the text has mistakes; all of them are listed.

    Examples
    --------
    >>> loads("{bogie: {base: table1}, speed: 250 km/h}").bogie.K_m
    626480.0
    """
    return _accepted(read_text(text, name))


def read(path: str | PathLike[str], changes: Iterable[NewValue] = ()) -> Report:
    """Read a problem file and report everything that was found, warnings included.

    Parameters
    ----------
    path : path
        Name of the file.
    changes : iterable of NewValue
        In place of what the file says.

    Returns
    -------
    problem : Problem or None
        None if there are errors.
    diagnostics : tuple of Diagnostic
        Errors and warnings in the order of the lines.
    """
    name = fspath(path)
    if is_workbook(name):
        return _read_workbook(name, changes)
    try:
        with open(name, "rb") as file:  # noqa: PTH123 - any name must do, also one that Path would change
            return read_stream(file, name, changes)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return None, (Diagnostic(path=name, message=f"cannot be read: {reason}"),)


def read_stream(stream: BinaryIO, name: str, changes: Iterable[NewValue] = ()) -> Report:
    """Read a problem from an open file as `read` does; more than a problem file may hold is not waited for."""
    try:
        return read_text(_decoded(stream.read(MOST_BYTES + 1), name), name, changes)
    except ProblemError as error:
        return None, error.diagnostics


def read_text(text: str, name: str = "<text>", changes: Iterable[NewValue] = ()) -> Report:
    """Read a problem from a text and report everything that was found, warnings included."""
    try:
        document = compose(text, name)
    except ProblemError as error:
        return None, _sorted(error.diagnostics)
    return _read_document(document, changes)


def _read_workbook(name: str, changes: Iterable[NewValue]) -> Report:
    try:
        document = workbook_document(name)
    except ProblemError as error:
        return None, _sorted(error.diagnostics)
    return _read_document(document, changes)


def _read_document(document: Document, changes: Iterable[NewValue]) -> Report:
    data = plain_data(document.root)
    if not isinstance(data, dict):
        empty = data is None
        document.note(document.root, "the file is empty" if empty else "a problem is a list of 'key: value' lines")
        return None, tuple(document.diagnostics)
    new = changed(data, changes)
    data, mistakes = with_catalogue(document, new.data)
    document.diagnostics += (*new.mistakes, *mistakes)
    noted = _Noted(document, new.labels)
    problem = _validated(noted, data)
    if document.diagnostics:
        return None, _sorted(document.diagnostics)
    if problem is not None:
        for path, doubt in doubts(problem, without_removed(data)):
            noted.note(path, doubt, severity="warning")
    return problem, _sorted(document.diagnostics)


@dataclass(frozen=True)
class _Noted:
    """A document some values of which are changed: what is wrong with these is told by the name of the change."""

    document: Document
    places: Mapping[Path, str]

    def note(
        self, path: Path, message: str, *, at_key: bool = False, severity: Literal["error", "warning"] = "error"
    ) -> None:
        """Add a diagnostic about the value at a path."""
        for length in range(len(path), 0, -1):
            if label := self.places.get(path[:length]):
                rest = dotted(path[length:])
                text = f"{rest}: {message}" if rest else message
                self.document.diagnostics.append(Diagnostic(key=label, message=text, severity=severity))
                return
        self.document.note(self.document.find(path, key=at_key), message, dotted(path), severity)


def _sorted(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(diagnostics, key=lambda d: (d.path, d.line or 0, d.column or 0)))


def _accepted(report: Report) -> Problem:
    problem, diagnostics = report
    if problem is None:
        raise ProblemError(d for d in diagnostics if d.severity == "error")
    return problem


def _decoded(content: bytes, name: str) -> str:
    if len(content) > MOST_BYTES:
        raise ProblemError([Diagnostic(path=name, message=f"is larger than {MOST_BYTES // 1024} KiB")])
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        column = error.start - content.rfind(b"\n", 0, error.start)
        text = "is not UTF-8 text: save the file as UTF-8"
        raise ProblemError([Diagnostic(path=name, line=line, column=column, message=text)]) from None


def _validated(document: _Noted, data: dict[str, Any]) -> Problem | None:
    """Return the problem that the data describe, or note all that is wrong with them."""
    checked = checked_data(data)
    found = checked.faults
    if not found:
        try:
            return Problem(**checked.parts)
        except ProblemError as error:
            found = placed(checked.filled, error.diagnostics)
    for fault in dict.fromkeys(found):
        document.note(fault.path, fault.message, at_key=fault.at_key)
    return None

"""Mistakes in a problem: where they are, what is wrong, and what would be right."""

from __future__ import annotations

import dataclasses
import sys
import warnings
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal, Self

from .characters import visible

_WIDEST_LINE = 160  # characters of a source line that a message repeats
_SYNONYMS = {
    **{"conicity": "lambda", "v": "speed", "velocity": "speed", "axle_load": "W", "variable": "variables"},
    **{"speed": "v", "frequency": "f_m"},  # among the axes of a sweep
}


@dataclass(frozen=True, kw_only=True)
class Diagnostic:
    """One mistake, or one doubt, in a problem.

    Parameters
    ----------
    message : str
        What is wrong and what is allowed.
    key : str
        Dotted name of the value, such as ``bogie.K_ds``; empty for the text as a whole.
    severity : {"error", "warning"}
        A warning is a value that is allowed but unusual.
    path : str
        Name of the file; empty for a problem made in Python.
    line, column : int or None
        Where the value starts, counted from 1; None for a problem made in Python.
    source_line : str
        The line as it was written.
    cell : str
        Sheet and cell of a workbook, such as ``problem!B7``; empty for texts.
    length : int
        Number of characters to underline.
    at_key : bool
        Whether it is the key that is wrong, and not its value.
    """

    message: str
    key: str = ""
    severity: Literal["error", "warning"] = "error"
    path: str = ""
    line: int | None = None
    column: int | None = None
    source_line: str = ""
    length: int = 1
    cell: str = ""
    at_key: bool = False

    def render(self) -> str:
        """Return the message as shown to a person: place, text, source line and underline."""
        parts = (self.path, self.cell) if self.cell else (self.path, self.line, self.column)
        place = ":".join(str(part) for part in parts if part not in ("", None))
        head = visible(": ".join(part for part in (place, self.severity, self.key, self.message) if part))
        return f"{head}\n{self._underlined()}" if self.line and self.source_line.strip() else head

    def to_dict(self) -> dict[str, Any]:
        """Return plain data that JSON can hold: its place, file included, and what it says."""
        place: dict[str, Any] = {"file": self.path or None}
        if self.cell:
            place |= {"cell": self.cell}
        else:
            place |= {"line": self.line, "column": self.column, "length": self.length}
        return {**place, "key": self.key, "message": self.message, "source_line": self.source_line}

    def _underlined(self) -> str:
        column = (self.column or 1) - 1
        start = max(0, column - _WIDEST_LINE // 2)
        shown = self.source_line[start : start + _WIDEST_LINE]
        shown = "".join(char if char.isprintable() else " " for char in shown).rstrip()
        carets = "^" * max(1, min(self.length, len(shown) - (column - start)))
        return f"{self.line:6d} | {shown}\n{'':6} | {' ' * (column - start)}{carets}"


class ProblemError(ValueError):
    """The problem has mistakes; ``diagnostics`` lists all of them and ``str()`` shows them.

    Parameters
    ----------
    diagnostics : str or iterable of Diagnostic
        The mistakes; a text makes one without a position.
    """

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, diagnostics: str | Iterable[Diagnostic]) -> None:
        listed = [Diagnostic(message=diagnostics)] if isinstance(diagnostics, str) else diagnostics
        self.diagnostics = tuple(listed)
        super().__init__(self.diagnostics)

    def __str__(self) -> str:
        return "\n".join(diagnostic.render() for diagnostic in self.diagnostics)

    def under(self, key: str) -> Self:
        """Return the same mistakes, named as found under `key`."""
        return type(self)(replace(d, key=".".join(part for part in (key, d.key) if part)) for d in self.diagnostics)


def wrong_key(message: str) -> ProblemError:
    """Return the error for a key that should not be there, or not here."""
    return ProblemError([Diagnostic(message=message, at_key=True)])


class UnitWarning(UserWarning):
    """A number without a unit was read in SI where people think in another unit."""


def warn_of_unit(text: str) -> None:
    """Warn of a number without a unit, at the line outside the package that gave it."""
    inside = str(Path(__file__).parents[1]), dataclasses.__file__, "<string>"  # as a dataclass's __init__ is called
    frame, level = sys._getframe(), 1
    while frame.f_back and frame.f_code.co_filename.startswith(inside):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, UnitWarning, stacklevel=level)


class Mistakes:
    """Collects mistakes so that all of them are reported at once.

    Examples
    --------
    >>> mistakes = Mistakes()
    >>> with mistakes.under("W"):
    ...     raise ProblemError("too heavy")
    >>> mistakes.found[0].render()
    'error: W: too heavy'
    """

    def __init__(self) -> None:
        self.found: list[Diagnostic] = []
        self._key = ""

    def under(self, key: str) -> Self:
        """Name the key that the next ``with`` block looks at."""
        self._key = key
        return self

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if not isinstance(error, ProblemError):
            return False
        self.found.extend(error.under(self._key).diagnostics)
        return True

    def report(self) -> None:
        """Raise a ProblemError if there was any mistake."""
        if self.found:
            raise ProblemError(self.found)


def _plain(name: str) -> str:
    return name.casefold().replace("_", "").replace("-", "").replace(" ", "")


def nearest(name: str, allowed: Collection[str]) -> str | None:
    """Return the allowed name that `name` was most likely meant to be, or None.

    Examples
    --------
    >>> nearest("K1x", ["K_1x", "K_1y"]), nearest("conicity", ["lambda"]), nearest("zzz", ["K_1x"])
    ('K_1x', 'lambda', None)
    """
    name = name[:80]
    plain = {_plain(candidate): candidate for candidate in reversed(tuple(allowed))}
    wanted = _SYNONYMS.get(name.casefold())
    if wanted in allowed:
        return wanted
    if _plain(name) in plain:
        return plain[_plain(name)]
    close = get_close_matches(name, allowed, n=1, cutoff=0.6) or get_close_matches(_plain(name), plain, n=1, cutoff=0.6)
    return plain.get(close[0], close[0]) if close else None


def suggestion(name: str, allowed: Collection[str]) -> str:
    """Return ``"; did you mean X?"`` or, where nothing is near, an empty text."""
    found = nearest(name, allowed)
    return f"; did you mean {found}?" if found else ""


def unknown_key(key: str, allowed: Collection[str]) -> str:
    """Return the message for a name that is not known."""
    return f"is not known here{suggestion(key, allowed)}"

"""Problem files: from text to a checked problem, with all mistakes at once and the place of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from os import PathLike, fspath
from typing import Any

from pydantic import BaseModel, ValidationError

from .build import build
from .diagnostics import Diagnostic, ProblemError
from .document import MOST_BYTES, Document, Path, compose, plain_data
from .faults import dotted, faults
from .file_shape import PRESETS, problem_model
from .parameters import PARAMETERS
from .presets import preset_bogie
from .problem import Problem
from .running import CURVE, SPEED
from .table import Parameter

Report = tuple[Problem | None, tuple[Diagnostic, ...]]


def load(path: str | PathLike[str]) -> Problem:
    """Read a problem file.

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


def read(path: str | PathLike[str]) -> Report:
    """Read a problem file and report everything that was found, warnings included.

    Parameters
    ----------
    path : path
        Name of the file.

    Returns
    -------
    problem : Problem or None
        None if there are errors.
    diagnostics : tuple of Diagnostic
        Errors and warnings in the order of the lines.
    """
    name = fspath(path)
    try:
        with open(name, "rb") as file:  # noqa: PTH123 - any name must do, also one that Path would change
            return read_text(_decoded(file.read(MOST_BYTES + 1), name), name)
    except ProblemError as error:
        return None, error.diagnostics
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return None, (Diagnostic(path=name, message=f"cannot be read: {reason}"),)


def read_text(text: str, name: str = "<text>") -> Report:
    """Read a problem from a text and report everything that was found, warnings included."""
    try:
        document = compose(text, name)
    except ProblemError as error:
        return None, _sorted(error.diagnostics)
    data = plain_data(document.root)
    if not isinstance(data, dict):
        empty = data is None
        document.note(document.root, "the file is empty" if empty else "a problem is a list of 'key: value' lines")
        return None, tuple(document.diagnostics)
    model = _validated(document, data)
    problem = None
    if model is not None and not document.diagnostics:
        problem = build(model)
        _add_doubts(document, data)
    return problem, _sorted(document.diagnostics)


def _sorted(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(diagnostics, key=lambda d: (d.line or 0, d.column or 0)))


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


def _validated(document: Document, data: dict[str, Any]) -> BaseModel | None:
    """Return the data as a model, or note all that is wrong with it."""
    filled, complete = _with_base(data)
    kind = _kind(data)
    try:
        return problem_model(kind, complete=complete).model_validate(filled)
    except ValidationError as error:
        for fault in faults(error, kind):
            node = document.find(fault.path, key=fault.at_key)
            document.note(node, fault.message, dotted(fault.path))
        return None


def _with_base(data: dict[str, Any]) -> tuple[dict[str, Any], bool]:
    """Return the data with the preset's values filled in, and whether all parameters must now be there."""
    bogie = data.get("bogie")
    if not isinstance(bogie, dict) or "base" not in bogie:
        return data, True
    if bogie["base"] not in PRESETS:
        return data, False
    return {**data, "bogie": preset_bogie(bogie["base"], _kind(data)) | bogie}, True


def _kind(data: Mapping[str, Any]) -> str:
    bogie = data.get("bogie")
    return "trailer" if isinstance(bogie, dict) and bogie.get("kind") == "trailer" else "power"


def _add_doubts(document: Document, data: dict[str, Any]) -> None:
    """Note the values that are accepted but unusual."""
    for path, row, value in _written_values(data):
        doubt = row.doubt(value)
        if doubt:
            document.note(document.find(path), doubt, dotted(path), "warning")


def _written_values(data: dict[str, Any]) -> Iterator[tuple[Path, Parameter, Any]]:
    """Yield path, table row and value of every quantity that stands in the text."""
    for key, value in data["bogie"].items():
        if key in PARAMETERS:
            yield ("bogie", key), PARAMETERS[key], value
    for key, value in data.get("curve", {}).items():
        if key in CURVE:
            yield ("curve", key), CURVE[key], value
    speed = data["speed"]
    ends = {("speed", end): speed[end] for end in ("min", "max")} if isinstance(speed, dict) else {("speed",): speed}
    yield from ((path, SPEED, value) for path, value in ends.items())
    for key, bounds in data.get("design", {}).get("variables", {}).items():
        for end, value in bounds.items():
            yield ("design", "variables", key, end), PARAMETERS[key], value

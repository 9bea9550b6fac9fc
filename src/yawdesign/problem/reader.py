"""Problem files: from text to a checked problem, with all mistakes at once and the place of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any

from pydantic import BaseModel, ValidationError

from .diagnostics import Diagnostic, ProblemError, nearest, suggestion
from .document import MOST_BYTES, Document, Path, compose, plain_data
from .file_shape import PRESETS, build, problem_model
from .parameters import MOTOR_KEYS, NO_MOTOR, PARAMETERS, parameter_keys
from .presets import preset_bogie
from .problem import Problem
from .running import CURVE, SPEED
from .table import Parameter

Report = tuple[Problem | None, tuple[Diagnostic, ...]]

_NO_ROBUST = "robust design is not part of this version: remove this key to get the answer for the nominal problem"
_TAGS = ("<range>", "<value>")
_TOP = ("title", "equations", "bogie", "speed", "curve", "design")


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


@dataclass(frozen=True)
class Fault:
    """A mistake by its place in the data; `at_key` if it is the key that is wrong and not the value."""

    path: Path
    message: str
    at_key: bool = False


def dotted(path: Path) -> str:
    """Return a path as shown in messages, such as ``bogie.K_ds``; long names are cut."""
    return ".".join(str(part)[:60] for part in path)


def faults(error: ValidationError, kind: str) -> Iterator[Fault]:
    """Yield all mistakes that pydantic found in a problem with a bogie of this kind."""
    all_found = [(found, _path(found["loc"])) for found in error.errors(include_url=False)]
    meant = {_meant(path, kind) for found, path in all_found if found["type"] == "extra_forbidden"}
    for found, path in all_found:
        if found["type"] != "missing" or path not in meant:
            yield from _told(found, path, kind)


def _meant(path: Path, kind: str) -> Path:
    """Return the path that a misspelt key was meant to be: it is not reported as missing too."""
    name = nearest(str(path[-1]), _allowed(path[:-1], kind))
    return (*path[:-1], name) if name else ()


def _path(loc: tuple[int | str, ...]) -> Path:
    """Return the path in the file: pydantic also names the branch it took where a speed may be a range."""
    return loc[:1] + loc[2:] if loc[:1] == ("speed",) and loc[1:2] and loc[1] in _TAGS else loc


def _told(found: Any, path: Path, kind: str) -> Iterator[Fault]:
    match found["type"]:
        case "value_error":
            yield from (Fault(path, d.message) for d in found["ctx"]["error"].diagnostics)
        case "missing":
            yield Fault(path, f"is missing{_meaning(path)}", at_key=True)
        case "extra_forbidden":
            yield Fault(path, _unknown(path, kind), at_key=True)
        case _:
            value = found["input"]
            what = "has no value" if value is None else "is not what stands here"
            yield Fault(path, f"{what}, expected keys and values: {', '.join(_allowed(path, kind)[:4])} ...")


def _meaning(path: Path) -> str:
    rows = {"bogie": PARAMETERS, "curve": CURVE}.get(str(path[0]), {})
    row = rows.get(str(path[-1])) if len(path) == 2 else None
    return f": {row.meaning}, such as {row.example}" if row else ""


def _unknown(path: Path, kind: str) -> str:
    key, around = str(path[-1]), path[:-1]
    if path == ("robust",):
        return _NO_ROBUST
    if kind == "trailer" and key in MOTOR_KEYS and around in (("bogie",), ("design", "variables")):
        return NO_MOTOR
    allowed = _allowed(around, kind)
    near = suggestion(key, allowed)
    if not near and key in PARAMETERS and not around:
        near = "; it belongs under bogie"
    return f"is not a known key{near}" if near else f"is not a known key; known here: {', '.join(allowed)}"


def _allowed(around: Path, kind: str) -> tuple[str, ...]:
    """Return the keys that may stand at a place."""
    match around:
        case ():
            return _TOP
        case ("bogie",):
            return ("kind", "base", *parameter_keys(kind))
        case ("curve",):
            return (*CURVE, "load")
        case ("speed",):
            return ("min", "max", "steps")
        case ("design",):
            return ("objective", "variables")
        case ("design", "variables"):
            return parameter_keys(kind)
        case _:
            return ("min", "max")

"""Pydantic's findings in our own words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from .diagnostics import nearest, suggestion
from .document import Path
from .parameters import MOTOR_KEYS, NO_MOTOR, PARAMETERS, parameter_keys
from .running import CURVE

_NO_ROBUST = "robust design is not part of this version: remove this key to get the answer for the nominal problem"
_TAGS = ("<range>", "<value>")
_TOP = ("title", "equations", "bogie", "speed", "curve", "design")


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

"""The mistakes in the data of a problem file: what is wrong, and at which place."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any

from pydantic import ValidationError

from .cases import read_cases
from .condition import Conditions
from .consistency import Values, misfits
from .creep import CREEP, MADE
from .diagnostics import Diagnostic, ProblemError, nearest
from .distributions import read_distributions
from .document import Path
from .file_shape import SWITCHES
from .outside_the_model import answer_to, why_unknown
from .parameters import BOGIE, CAR_BODY, MOTOR_KEYS, NO_MOTOR, bogie_keys, incomplete, parameter_keys
from .requirements import MEASURES, read_requirements
from .running import CURVE
from .table import Parameter
from .variables import default_variables
from .written_conditions import OWN_KEYS, read_conditions

_NO_ROBUST = "is not a known key: what must hold stands under conditions, such as lambda: [0.05, 0.40]"
_TAGS = ("<range>", "<value>")
_SEVERAL = {("bogie",): "bogies", ("car_body",): "cars"}  # as what a list of them is answered
TOP = (
    *("title", "equations", "bogie", "car_body", "speed", "curve", "conditions", "cases", "requirements", "design"),
    "uncertainty",
)
_ROWS: Mapping[str, Mapping[str, Parameter]] = {"bogie": BOGIE, "car_body": CAR_BODY, "curve": CURVE}


@dataclass(frozen=True)
class Fault:
    """A mistake by its place in the data; `at_key` if it is the key that is wrong and not the value."""

    path: Path
    message: str
    at_key: bool = False

    @property
    def diagnostic(self) -> Diagnostic:
        """The same without a place in a text."""
        return Diagnostic(key=dotted(self.path), message=self.message, at_key=self.at_key)


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


def disagreements(data: Mapping[str, Any], kind: str) -> Iterator[Fault]:
    """Yield what does not fit together in data that have other mistakes: these are left out."""
    bogie, car_body = _known("bogie", data, kind), _known("car_body", data, kind) if "car_body" in data else None
    design = data.get("design")
    variables = design.get("variables") if isinstance(design, dict) else default_variables(kind)
    cases = read_cases(data["cases"])[0] if "cases" in data else ()
    known = (*bogie_keys(kind), *CAR_BODY)
    found = misfits(
        kind=kind,
        equations=data.get("equations"),
        bogie=bogie,
        car_body=car_body,
        speed_count=len(data["speed"]) if isinstance(data.get("speed"), list) else 1,
        curve="curve" in data,
        variables=[key for key in known if isinstance(variables, Mapping) and key in variables],
        cases=cases,
        conditions=read_conditions(data["conditions"])[0] if "conditions" in data else Conditions(),
        requirements=read_requirements(data["requirements"])[0] if "requirements" in data else (),
        uncertainty=read_distributions(data["uncertainty"])[0] if "uncertainty" in data else (),
    )
    yield from placed(data, chain(incomplete(bogie), found))


def _known(part: str, data: Mapping[str, Any], kind: str) -> Values:
    """Return what is given of a part, or must be; None where it is missing or wrong, which is told elsewhere."""
    written = data.get(part)
    given = written if isinstance(written, dict) else {}
    known: dict[str, float | None] = {}
    for name, value in given.items():
        path = (part, name) if name in _ROWS[part] else _meant((part, name), kind)
        row = _ROWS[part].get(str(path[-1])) if path[:-1] == (part,) else None
        if row:
            known[row.key] = _checked(row, value)
    always = parameter_keys(kind) if part == "bogie" else [key for key, row in CAR_BODY.items() if not row.optional]
    return dict.fromkeys(always, None) | known


def _checked(row: Parameter, value: object) -> float | None:
    try:
        return float(row.check(value))
    except ProblemError:
        return None


def placed(data: Mapping[str, Any], found: Iterable[Diagnostic]) -> list[Fault]:
    """Return diagnostics as faults, with their places in the data."""
    return [Fault(_named(data, each.key), each.message, each.at_key) for each in found]


def _named(data: object, name: str) -> Path:
    """Return the path of a dotted name; keys may have points in them."""
    inner = data if isinstance(data, dict) else {}
    for key in sorted(inner, key=len, reverse=True):
        if name == key:
            return (key,)
        if name.startswith(f"{key}."):
            return (key, *_named(inner[key], name.removeprefix(f"{key}.")))
    return tuple(name.split(".")) if name else ()


def _meant(path: Path, kind: str) -> Path:
    """Return the path that a misspelt or misplaced key was meant to be: it is not reported as missing too."""
    around, key = path[:-1], str(path[-1])
    home = _home(key, around, kind)
    if home is not None:
        return (*home, key)
    name = nearest(key, _allowed(around, kind))
    return (*around, name) if name else ()


def _home(key: str, around: Path, kind: str) -> Path | None:
    """Return the part of a problem to which a key belongs that stands in another."""
    if len(around) > 1:
        return None
    places: tuple[Path, ...] = ((), *((part,) for part in (*_ROWS, "conditions", "requirements")))
    return next((place for place in places if place != around and key in _allowed(place, kind)), None)


def _path(loc: tuple[int | str, ...]) -> Path:
    """Return the path in the file: pydantic also names the branch it took where a speed may be a range."""
    if loc[:1] == ("speed",) and loc[1:2] and loc[1] in _TAGS:
        return loc[:1] + loc[2:]
    return loc


def _told(found: Any, path: Path, kind: str) -> Iterator[Fault]:
    match found["type"]:
        case "value_error":
            for each in found["ctx"]["error"].diagnostics:
                yield Fault((*path, *_named(found["input"], each.key)), each.message, each.at_key)
        case "missing":
            yield Fault(path, f"is missing{_meaning(path)}", at_key=True)
        case "extra_forbidden":
            yield Fault(path, _unknown(path, kind), at_key=True)
        case _:
            value = found["input"]
            if path in _SEVERAL and isinstance(value, list):
                yield Fault(path, str(answer_to(_SEVERAL[path])))
                return
            what = "has no value" if value is None else "is not what stands here"
            yield Fault(path, f"{what}, expected keys and values: {', '.join(_allowed(path, kind)[:4])} ...")


def _meaning(path: Path) -> str:
    row = _ROWS.get(str(path[0]), {}).get(str(path[-1])) if len(path) == 2 else None
    return f": {row.meaning}, such as {row.example}" if row else ""


def _unknown(path: Path, kind: str) -> str:
    key, around = str(path[-1]), path[:-1]
    if path == ("robust",):
        return _NO_ROBUST
    if kind == "trailer" and key in MOTOR_KEYS and around in (("bogie",), ("design", "variables")):
        return NO_MOTOR
    if key in MADE and around == ("bogie",):
        return "follows from creep: remove one of the two"
    home = _home(key, around, kind)
    if home is not None:
        place = f"under {dotted(home)}" if home else f"beside {dotted(around)}, not in it"
        return f"is not a known key here; it belongs {place}"
    allowed = _allowed(around, kind)
    return why_unknown(key, allowed, "is not a known key")


def _allowed(around: Path, kind: str) -> tuple[str, ...]:
    """Return the keys that may stand at a place."""
    match around:
        case ():
            return TOP
        case ("bogie",):
            return ("kind", "base", *bogie_keys(kind), *SWITCHES["bogie"], "creep")
        case ("bogie", "creep"):
            return tuple(CREEP)
        case ("car_body",):
            return ("base", *CAR_BODY, *SWITCHES["car_body"])
        case ("curve",):
            return (*CURVE, "load")
        case ("conditions",):
            return OWN_KEYS
        case ("requirements",):
            return tuple(MEASURES)
        case ("speed",):
            return ("min", "max", "steps")
        case ("design",):
            return ("objective", "variables", "catalogue")
        case ("design", "variables"):
            return tuple(dict.fromkeys((*bogie_keys(kind), *CAR_BODY)))
        case _:
            return ("min", "max")

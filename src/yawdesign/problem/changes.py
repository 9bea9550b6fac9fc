"""New values of keys of a problem file, by their own name or by their place: those of `--set` and of `replace`."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from .cases import ONE_BOGIE
from .condition import CREEP_FACTOR
from .consistency import why_absent
from .creep import MADE, creep_coefficients
from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion
from .document import Path, compose, plain_data
from .faults import TOP
from .file_shape import SWITCHES
from .outside_the_model import why_unknown
from .parameters import CAR_BODY, PARAMETERS, VERTICAL, bogie_keys
from .presets import REMOVED, kind_of_bogie, with_presets
from .running import CURVE
from .table import key_of, shown
from .variables import DEFAULT_BOUNDS, default_variables

_NAMED_BY_USERS = (("cases",), ("conditions", "load"))
_QUOTES = ("'", '"')


@dataclass(frozen=True)
class NewValue:
    """A new value of one key.

    Parameters
    ----------
    name : str
        A key of bogie, car body, curve or speed, ``objective``, ``creep_factor``, or a dotted path, such as
        ``design.variables.C_s.max``.
    value : object
        What stands there then; None removes the key.
    label : str
        What messages call it.
    """

    name: str
    value: Any
    label: str


def written_value(text: str, option: str = "--set") -> NewValue:
    """Return the new value that ``NAME=VALUE`` says; the value is YAML.

    Examples
    --------
    >>> written_value("conditions.lambda=[0.1, 0.2]").value
    ['0.1', '0.2']
    """
    label = f"{option} {shown(text)}"
    name, sign, value = text.partition("=")
    name = name.strip()
    if not sign or not name:
        raise ProblemError('expected NAME=VALUE, such as C_s="800 kN s/m"').under(label)
    if name == "title" and not value.strip().startswith(_QUOTES):
        return NewValue(name, value.strip(), label)  # whatever YAML would make of it
    try:
        return NewValue(name, plain_data(compose(value, label).root), label)
    except ProblemError as error:
        raise ProblemError(error.diagnostics[0].message).under(label) from None


@dataclass(frozen=True)
class ChangedData:
    """Data with new values in them.

    Parameters
    ----------
    data : dict
        With those new values that are right so far.
    labels : dict
        What messages call each, by its place.
    mistakes : list of Diagnostic
        What is wrong with the others.
    """

    data: dict[str, Any]
    labels: dict[Path, str] = field(default_factory=dict)
    mistakes: list[Diagnostic] = field(default_factory=list)


def changed(data: Mapping[str, Any], values: Iterable[NewValue]) -> ChangedData:
    """Return data with new values in them.

    The new value of a parameter takes the place of the conditions of its name, as an axis of a sweep does; one of
    ``f_11`` or ``f_22`` that of ``creep`` too.
    """
    mistakes, places = Mistakes(), dict[Path, NewValue]()
    for each in sorted(values, key=lambda each: each.name not in TOP):  # parts as a whole come first
        with mistakes.under(each.label):
            path = _place(each, data)
            if len(path) == 1:
                data = _with(data, path, each.value)
            if path in places:
                raise ProblemError(f"{'.'.join(map(str, path))} is given twice")
            places[path] = each
    names = {str(path[1]) for path in places if len(path) == 2 and path[0] in ("bogie", "car_body")}
    found: Mapping[str, Any] = data
    if names:
        found = _without_creep(_without_conditions(data, names), names, places)
    if any(path[:2] == ("design", "variables") and len(path) > 2 for path in places):
        found = _with_variables(found)
    for path, each in places.items():
        with mistakes.under(each.label):
            if len(path) == 1:
                continue
            found = _with(found, path, each.value)
    return ChangedData(dict(found), {path: each.label for path, each in places.items()}, mistakes.found)


def _place(given: NewValue, data: Mapping[str, Any]) -> Path:
    """Return the path in the data that a name means."""
    name = key_of(given.name)
    if name in TOP:
        return (name,)
    first, point, rest = name.partition(".")
    if point and first in TOP:
        return (first, *_inner((first,), rest, data.get(first), given.value))
    kind = kind_of_bogie(data)
    places = _places(data, kind)
    if name in places:
        return (*places[name], name)
    if name in PARAMETERS:
        part = with_presets(data)[0].get("bogie")
        raise ProblemError(why_absent(name, kind, dict.fromkeys(part) if isinstance(part, dict) else {}))
    raise ProblemError(why_unknown(name, (*places, *TOP)))


def _places(data: Mapping[str, Any], kind: str) -> dict[str, Path]:
    """Return the part to which each name belongs that stands alone, the first one of these."""
    places: dict[str, Path] = {CREEP_FACTOR.key: ("conditions",), "objective": ("design",)}
    if "curve" in data:
        places |= dict.fromkeys((*CURVE, "load"), ("curve",))
    if "car_body" in data:
        places |= dict.fromkeys((*CAR_BODY, *SWITCHES["car_body"]), ("car_body",))
    places |= dict.fromkeys(("kind", *bogie_keys(kind), *SWITCHES["bogie"]), ("bogie",))
    return places | (dict.fromkeys(VERTICAL, ("car_body",)) if "car_body" in data else {})


def _inner(around: Path, rest: str, node: object, value: object) -> Iterator[str]:
    """Yield the keys of a dotted name below a place; keys may have points in them."""
    inside = node if isinstance(node, Mapping) else {}
    known = [key for key in inside if rest == key or rest.startswith(f"{key}.")]
    if known:
        key = max(known, key=len)
    elif around in _NAMED_BY_USERS:
        if not isinstance(value, Mapping):
            name = next((rest.removesuffix(f".{each}") for each in ONE_BOGIE if rest.endswith(f".{each}")), None)
            name = name or rest.rpartition(".")[0] or rest
            there = f"there are {', '.join(inside)}" if inside else "it holds nothing yet"
            raise ProblemError(f"{shown(name)} is not known under {'.'.join(map(str, around))}; {there}")
        key = rest
    elif around[:-1] in _NAMED_BY_USERS:
        key = rest  # `leading.C_s` is one key
    else:
        key = rest.partition(".")[0]
    yield key if around in _NAMED_BY_USERS else key_of(key)
    if len(rest) > len(key):
        yield from _inner((*around, key), rest[len(key) + 1 :], inside.get(key), value)


def _with(data: Mapping[str, Any], path: Path, value: Any, around: str = "") -> dict[str, Any]:
    """Return data with one value changed, added or, where that is None, removed."""
    key, found = str(path[0]), dict(data)
    if len(path) > 1:
        inside = found.get(key, {})
        if not isinstance(inside, Mapping):
            where = f"{around}{key}"
            raise ProblemError(f"{where} is {shown(inside)}, which has no {path[1]}: give {where} as a whole")
        found[key] = _with(inside, path[1:], value, f"{around}{key}.")
    elif value is not None:
        found[key] = value
    elif around in ("bogie.", "car_body."):
        found[key] = REMOVED
    elif key in found or not around:
        found.pop(key, None)
    else:
        raise ProblemError(f"is not there to be removed{suggestion(key, found)}")
    return found


def _with_variables(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return data with the design variables written out, which are the usual ones where there are none."""
    design = data.get("design", {})
    if not isinstance(design, Mapping) or "variables" in design:
        return data
    usual = default_variables(kind_of_bogie(data))
    bounds = {key: dict(zip(("min", "max"), DEFAULT_BOUNDS[key], strict=True)) for key in usual}
    return {**data, "design": {**design, "variables": bounds}}


def _without_creep(data: Mapping[str, Any], names: Collection[str], bodies: Collection[Path]) -> Mapping[str, Any]:
    """Return data with creep coefficients in the place of what they follow from, or without them, if that is given."""
    bogie = data.get("bogie")
    if not isinstance(bogie, Mapping):
        return data
    found = dict(bogie)
    if any(path[:2] == ("bogie", "creep") for path in bodies):
        found = {key: value for key, value in found.items() if key not in MADE}
    elif "creep" in found and not set(MADE).isdisjoint(names):
        with suppress(ProblemError, TypeError, KeyError):  # what is wrong with them is told later
            filled = with_presets(data)[0]["bogie"]
            found |= creep_coefficients(filled["W"], filled["r"], **found["creep"])
            del found["creep"]
    return {**data, "bogie": found}


def _without_conditions(data: Mapping[str, Any], names: Collection[str]) -> Mapping[str, Any]:
    """Return data without the conditions in whose place other values come, and without loads that then are none."""
    conditions = data.get("conditions")
    gone = {*names, *((CREEP_FACTOR.key,) if not set(MADE).isdisjoint(names) else ())}
    if not isinstance(conditions, Mapping):
        return data
    kept = {key: value for key, value in conditions.items() if key_of(key) not in gone}
    if isinstance(loads := kept.pop("load", None), Mapping):
        left = {name: _others(load, gone) for name, load in loads.items()}
        left = {name: load for k, (name, load) in enumerate(left.items()) if load not in [*left.values()][:k]}
        kept |= {"load": left} if any(left.values()) else {}
    others = {key: value for key, value in data.items() if key != "conditions"}
    return others | ({"conditions": kept} if kept else {})


def _others(load: object, names: Collection[str]) -> object:
    return {key: x for key, x in load.items() if key_of(key) not in names} if isinstance(load, Mapping) else load

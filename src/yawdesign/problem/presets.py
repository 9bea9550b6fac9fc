"""Bogies and car bodies from the literature that come with the package, as problem files beside this module."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from .creep import MADE
from .document import compose, plain_data
from .file_shape import PRESETS
from .parameters import bogie_keys

REMOVED = object()  # stands for a value that a change removes, also where a preset has one


@cache
def preset_text(name: str) -> str:
    """Return the file of a preset."""
    return files(__package__).joinpath("presets", f"{name}.yaml").read_text(encoding="utf-8")


@cache
def preset(name: str) -> Any:
    """Return the data of a preset."""
    return plain_data(compose(preset_text(name), name).root)


def preset_bogie(name: str, kind: str) -> dict[str, Any]:
    """Return a preset's bogie by key, without what it does not have; a trailer bogie gets no motor values."""
    bogie = preset(name)["bogie"]
    return {"kind": kind} | {key: bogie[key] for key in bogie_keys(kind) if key in bogie}


def preset_car_body(name: str) -> dict[str, Any]:
    """Return a preset's car body by key."""
    return dict(preset(name)["car_body"])


def with_presets(data: Mapping[str, Any]) -> tuple[dict[str, Any], frozenset[str]]:
    """Return data with the values of presets filled in, and the parts of which nothing may be missing."""
    filled, complete = dict(data), set(PRESETS)
    for part, names in PRESETS.items():
        given = data.get(part)
        if not isinstance(given, dict):
            continue
        kept = {key: value for key, value in given.items() if value is not REMOVED}
        if "base" not in kept:
            continue
        base = kept["base"]
        if base not in names:
            complete.remove(part)
            continue
        values = preset_bogie(base, kind_of_bogie(data)) if part == "bogie" else preset_car_body(base)
        filled[part] = {key: x for key, x in values.items() if key not in MADE or "creep" not in kept} | given
    return without_removed(filled), frozenset(complete)


def without_removed(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return data without the values that a change has removed."""
    found = dict(data)
    for part in PRESETS:
        if isinstance(given := found.get(part), dict):
            found[part] = {key: value for key, value in given.items() if value is not REMOVED}
    return found


def kind_of_bogie(data: Mapping[str, Any]) -> str:
    """Return the kind of bogie that a file is about."""
    bogie = data.get("bogie")
    return "trailer" if isinstance(bogie, dict) and bogie.get("kind") == "trailer" else "power"

"""Bogies and car bodies from the literature that come with the package, as problem files beside this module."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from .creep import MADE
from .diagnostics import Mistakes
from .document import compose, plain_data
from .file_shape import PRESETS, build, problem_model
from .parameters import KINDS, bogie_keys
from .problem import EQUATIONS, Problem
from .table import as_choice


@cache
def preset_text(name: str) -> str:
    """Return the file of a preset."""
    return files(__package__).joinpath("presets", f"{name}.yaml").read_text(encoding="utf-8")


@cache
def _preset(name: str) -> Any:
    return plain_data(compose(preset_text(name), name).root)


def preset_bogie(name: str, kind: str) -> dict[str, Any]:
    """Return a preset's bogie by key, without what it does not have; a trailer bogie gets no motor values."""
    bogie = _preset(name)["bogie"]
    return {"kind": kind} | {key: bogie[key] for key in bogie_keys(kind) if key in bogie}


def preset_car_body(name: str) -> dict[str, Any]:
    """Return a preset's car body by key."""
    return dict(_preset(name)["car_body"])


def with_presets(data: dict[str, Any]) -> tuple[dict[str, Any], frozenset[str]]:
    """Return data with the values of presets filled in, and the parts of which nothing may be missing."""
    filled, complete = dict(data), set(PRESETS)
    for part, names in PRESETS.items():
        given = data.get(part)
        if not isinstance(given, dict) or "base" not in given:
            continue
        base = given["base"]
        if base not in names:
            complete.remove(part)
            continue
        preset = preset_bogie(base, kind_of_bogie(data)) if part == "bogie" else preset_car_body(base)
        filled[part] = {key: x for key, x in preset.items() if key not in MADE or "creep" not in given} | given
    return filled, frozenset(complete)


def kind_of_bogie(data: Mapping[str, Any]) -> str:
    """Return the kind of bogie that a file is about."""
    bogie = data.get("bogie")
    return "trailer" if isinstance(bogie, dict) and bogie.get("kind") == "trailer" else "power"


def table1(kind: str = "power", equations: str = "reciprocal") -> Problem:
    """Return the bogie of Table I at 300 km/h with the curve of the paper's example.

    Parameters
    ----------
    kind : {"power", "trailer"}
        With the motors, or without them and otherwise the same.
    equations : {"reciprocal", "as-printed"}
        Whether the motors' yaw reaction acts on the frame, or is left out as in the paper's equations.

    Returns
    -------
    Problem
        The problem.

    References
    ----------
    Y. Yu, J. Wang, Y. Song, L. Zhao: Stability Analysis of Power Bogie System and Forward Design of Its Yaw Damper
    Damping Parameter. Table I and section V-B.

    Examples
    --------
    >>> table1().bogie.M_b, table1().speeds
    (7186.0, (83.33333333333333,))
    """
    mistakes = Mistakes()
    for name, value, choices in (("kind", kind, KINDS), ("equations", equations, EQUATIONS)):
        with mistakes.under(name):
            as_choice(value, choices)
    mistakes.report()
    data = _preset("table1") | {"bogie": preset_bogie("table1", kind), "equations": equations}
    if kind == "trailer":
        data["title"] = "Trailer bogie with the values of Table I"
    return build(problem_model(kind).model_validate(data))

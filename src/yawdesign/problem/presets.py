"""Bogies from the literature that come with the package, as problem files beside this module."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from .diagnostics import Mistakes
from .document import compose, plain_data
from .file_shape import build, problem_model
from .parameters import KINDS, parameter_keys
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
    return {"kind": kind} | {key: bogie[key] for key in parameter_keys(kind) if key in bogie}


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

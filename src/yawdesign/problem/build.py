"""From validated models to the problem that the other rooms work with."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from .parameters import Bogie
from .problem import Problem
from .running import Curve, SpeedRange
from .table import field_name
from .variables import Design, Variable


def build(model: BaseModel) -> Problem:
    """Return the problem that a validated model describes."""
    data = given(model)
    speed = data["speed"]
    return Problem(
        title=data.get("title", ""),
        equations=data.get("equations", "reciprocal"),
        bogie=_bogie(data["bogie"]),
        speed=SpeedRange(**speed) if isinstance(speed, dict) else speed,
        curve=Curve(**data["curve"]) if "curve" in data else None,
        design=_design(data.get("design", {})),
    )


def given(model: BaseModel) -> dict[str, Any]:
    """Return the values that were given, by key, nested models included."""
    values = {key: getattr(model, key) for key in type(model).model_fields if key in model.model_fields_set}
    return {key: given(value) if isinstance(value, BaseModel) else value for key, value in values.items()}


def _bogie(data: dict[str, Any]) -> Bogie:
    return Bogie(**{field_name(key): value for key, value in data.items() if key != "base"})


def _design(data: dict[str, Any]) -> Design:
    variables = {key: Variable(**bounds) for key, bounds in data.get("variables", {}).items()}
    return Design(objective=data.get("objective", "decay_rate"), variables=variables)

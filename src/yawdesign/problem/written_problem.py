"""A problem, and each of its parts, as the data of a problem file: exact numbers in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from .cases import Case
from .condition import Conditions
from .distributions import Distribution
from .distributions import written as written_distributions
from .file_shape import SWITCHES
from .parameters import Bogie, CarBody, given_of
from .requirements import Requirement
from .requirements import written as written_requirements
from .running import Curve, SpeedRange
from .table import RIGID
from .variables import Design


def written(part: Any) -> Any:
    """Return a part of a problem as a problem file has it; whatever is no such part as it is.

    Examples
    --------
    >>> written(SpeedRange(min=50.0, max="80 m/s"))
    {'min': 50.0, 'max': 80.0, 'steps': 11}
    """
    match part:
        case Bogie():
            return {"kind": part.kind} | _given(part, "bogie")
        case CarBody():
            return _given(part, "car_body")
        case Curve() | SpeedRange():
            return {each.name: getattr(part, each.name) for each in fields(part)}
        case Design():
            return _design(part)
        case Conditions():
            return part.written
        case [*several] if several and not isinstance(part, str):
            return _several(several)
        case _:
            return part


def _given(part: Bogie | CarBody, name: str) -> dict[str, Any]:
    found: dict[str, Any] = {key: "rigid" if value == RIGID else value for key, value in given_of(part).items()}
    switches = {key: getattr(part, key) for key, (usual, _) in SWITCHES[name].items() if getattr(part, key) != usual}
    return found | switches


def _design(design: Design) -> dict[str, Any]:
    found: dict[str, Any] = {"objective": design.objective}
    if design.variables:
        found["variables"] = {key: {"min": x.min, "max": x.max} for key, x in design.variables.items()}
    if design.catalogue:
        found["catalogue"] = [damper.written for damper in design.catalogue]
    return found


def _several(parts: list[Any]) -> Any:
    """Return what stands several times: faults, requirements, distributions, or speeds."""
    if all(isinstance(each, Case) for each in parts):
        return {case.name: {change.key: change.written for change in case.changes} for case in parts}
    if all(isinstance(each, Requirement) for each in parts):
        return written_requirements(tuple(parts))
    if all(isinstance(each, Distribution) for each in parts):
        return written_distributions(parts)
    return parts


def in_plain_numbers(data: Any) -> Any:
    """Return data with plain numbers in the place of exact ones: as JSON holds them."""
    if isinstance(data, Mapping):
        return {key: in_plain_numbers(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [in_plain_numbers(value) for value in data]
    return float(data) if isinstance(data, float) else data


def with_text_keys(data: Any) -> Any:
    """Return data in which every key is a text, as in a file."""
    if isinstance(data, Mapping):
        return {str(key): with_text_keys(value) for key, value in data.items()}
    return [with_text_keys(value) for value in data] if isinstance(data, list) else data

"""Under which conditions an answer holds, and what it does not hold: said in a line beside it."""

from collections.abc import Mapping, Sequence
from typing import Any

from yawdesign.problem.condition import CREEP, CREEP_FACTOR, Condition
from yawdesign.problem.condition_texts import change_text, range_text
from yawdesign.problem.conditions import ConditionSet
from yawdesign.vehicle.vehicle import Vehicle

ONE_ONLY = "one condition only"
LOW_CONICITY = 0.2  # below about this a car body that moves may ask for many times the damping

STANDS_STILL = (
    "The car body stands still here: its sway and yaw, and what they do to the bogies at low conicity or reduced "
    "creep, are not in this answer. Give `car_body` to have them."
)
NOT_TO_BE_RELIED_ON = (
    "DO NOT RELY ON THIS AT CONICITY {:.3g}. The car body stands still here, and below a conicity of about 0.2, or "
    "with reduced creep, a car body that moves may ask for many times this damping (low-conicity sway). Give "
    "`car_body`."
)


def scope(vehicles: Sequence[Vehicle]) -> str:
    """Return what an answer about a vehicle does not hold; empty where a car body moves in it.

    Parameters
    ----------
    vehicles : sequence of Vehicle
        It under each of its conditions.
    """
    if any(vehicle.model.has_car_body for vehicle in vehicles):
        return ""
    conicity = min(float(vehicle.p["lambda"]) for vehicle in vehicles)
    return NOT_TO_BE_RELIED_ON.format(conicity) if conicity < LOW_CONICITY else STANDS_STILL


def conditions_told(conditions: ConditionSet, p: Mapping[str, Any] | None = None) -> str:
    """Return in words under which conditions an answer holds.

    Parameters
    ----------
    conditions : ConditionSet
        Those of a problem.
    p : mapping, optional
        The vehicle's numbers in SI units: where there is one condition only, its conicity is told too.

    Examples
    --------
    >>> from yawdesign import table1
    >>> from yawdesign.problem.conditions import condition_set
    >>> conditions_told(condition_set(table1()), {"lambda": 0.1})
    'one condition only: lambda 0.1, creep as given, 300 km/h'
    """
    values = _listed(conditions.lists)
    if conditions.is_one:
        if p is not None and "lambda" not in values:
            values = {"lambda": [p["lambda"]], **values}
        texts = {name: change_text(name, *each) for name, each in values.items()}
        creep = [] if CREEP_FACTOR.key in values or set(CREEP) & values.keys() else ["creep as given"]
        speed = [texts.pop("speed")] if "speed" in texts else []
        return f"{ONE_ONLY}: " + ", ".join([*texts.values(), *creep, *speed])
    each_of = "; ".join(change_text(name, *each) for name, each in values.items())
    if not conditions.ranges:
        return f"all {len(conditions.lists)} conditions ({each_of})"
    ranges = ", ".join(range_text(name, ends) for name, ends in conditions.ranges)
    beside = f", each with {each_of}" if each_of else ""
    return f"every condition that a search found in {ranges}{beside} (no proof)"


def _listed(conditions: Sequence[Condition]) -> dict[str, list[Any]]:
    """Return the values that come in a list of conditions, by name, each once."""
    found: dict[str, list[Any]] = {}
    for condition in conditions:
        for name, value in condition.described.items():
            known = found.setdefault(name, [])
            if value not in known:
                known.append(value)
    return found

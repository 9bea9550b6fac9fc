"""What the files of an export say of the vehicle they belong to."""

from collections.abc import Mapping
from typing import Any

from yawdesign.problem import Problem
from yawdesign.problem.parameters import parameter_keys
from yawdesign.vehicle.vehicle import Model

PARTS = {
    "M_c": "car body on two bogies",
    "I_b": "roll of the bogie frame",
    "C_1x": "longitudinal primary dampers",
    "C_1y": "lateral primary dampers",
    "J_wy": "gyroscopic moment of the wheelsets",
}


def added_parts(problem: Problem) -> tuple[str, ...]:
    """Return what a vehicle has beside the paper's bogie.

    Examples
    --------
    >>> import yawdesign as yd
    >>> added_parts(yd.table1()), added_parts(yd.table1().replace(J_wy=180.0))
    ((), ('gyroscopic moment of the wheelsets',))
    """
    return tuple(part for key, part in PARTS.items() if key in problem.keys)


def rigid_joints(problem: Problem) -> tuple[str, ...]:
    """Return the joints that are rigid, by the names of their stiffnesses.

    Examples
    --------
    >>> import yawdesign as yd
    >>> rigid_joints(yd.table1().replace(K_ds="rigid"))
    ('K_ds',)
    """
    primary = (f"K_d1{axis}" for axis in "xy" if f"C_1{axis}" in problem.keys)
    return tuple(key for key in (*parameter_keys(problem.bogie.kind), *primary) if key not in problem.keys)


def in_words(problem: Problem) -> tuple[str, ...]:
    """Return all in which a vehicle differs from the paper's bogie.

    Examples
    --------
    >>> import yawdesign as yd
    >>> in_words(yd.table1().replace(K_ds="rigid", gravitational_stiffness=False))
    ('K_ds rigid', 'no gravitational stiffness')
    """
    return (*added_parts(problem), *(f"{key} rigid" for key in rigid_joints(problem)), *sorted(problem.flags))


def described(problem: Problem) -> Mapping[str, Any]:
    """Return the same as the manifest has it: nothing for the paper's bogie."""
    if not in_words(problem):
        return {}
    return {
        "car_body": problem.car_body is not None,
        "parts": added_parts(problem),
        "rigid_joints": rigid_joints(problem),
        "flags": sorted(problem.flags),
    }


def short_name(model: Model) -> str:
    """Return what a vehicle is called in names of files and systems."""
    return "vehicle" if model.has_car_body else "bogie"

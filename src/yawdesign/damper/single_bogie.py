"""What one bogie under a car body that stands still would have answered, and where a vehicle's answer parts from it.

A single bogie knows nothing of the car body's sway and yaw, which at low conicity or reduced creep take the bogies with
them. So its answer is compared over conicity and creep, for the numbers of this vehicle.
"""

from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.condition import CREEP, CREEP_FACTOR, TOLERANCE
from yawdesign.problem.conditions import ConditionSet
from yawdesign.vehicle.vehicle import Model, Vehicle

CREEP_FACTORS = (1.0, 0.7, 0.5)
CONICITIES = (0.02, 0.5)
POINTS = 97  # in that range: 3.4 % from one to the next
APART = 1.1  # times the single bogie's damping: with more they part


@dataclass(frozen=True)
class Parting:
    """At which conicities a vehicle needs more yaw damping than a single bogie, at a creep factor.

    Parameters
    ----------
    creep_factor : float
        What f_11 and f_22 are multiplied by [-].
    conicities : tuple of (low, high)
        Ranges, to 3.4 %, in which the damping above which the vehicle is stable is more than 1.1 times that of the
        single bogie [-].
    """

    creep_factor: float
    conicities: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class SingleBogie:
    """The forward design of one bogie under a car body that stands still, beside that of the vehicle.

    Parameters
    ----------
    C_sl, C_s : float or None
        Lower end of its stable interval, and its design [N s/m].
    stable_intervals : tuple of (low, high)
        Where it would be stable [N s/m]; high is infinite where there is no limit.
    status : str
        What kind of answer its design is.
    stable : bool or None
        Whether its C_s is stable under the car body that moves; None if it has none.
    partings : tuple of Parting
        At which conicities the vehicle needs more damping, for some creep factors.
    searched : tuple of float
        Between which conicities they were compared [-].
    speed : float
        At which speed [m/s], the highest of the problem.
    """

    C_sl: float | None
    C_s: float | None
    stable_intervals: tuple[tuple[float, float], ...]
    status: str
    stable: bool | None
    partings: tuple[Parting, ...]
    searched: tuple[float, float]
    speed: float


def of_bogie(conditions: ConditionSet, model: Model) -> ConditionSet:
    """Return what conditions of a vehicle say of one of its bogies."""
    kept = {*model.bogie.parameters, CREEP_FACTOR.key}
    changed = [change for one in conditions.lists for change in (*one.changes, *(one.load.changes if one.load else ()))]
    named = {name for name, _ in (*changed, *conditions.ranges)}
    return conditions.without({name for name in named if name.removeprefix(TOLERANCE) not in kept})


def partings(vehicle: Vehicle) -> tuple[Parting, ...]:
    """Return at which conicities a vehicle needs more yaw damping than one of its bogies alone.

    Parameters
    ----------
    vehicle : Vehicle
        With a car body; its own conicity is not looked at.
    """
    conicity = np.geomspace(*CONICITIES, POINTS)
    apart = _apart(vehicle, np.tile(conicity, (len(CREEP_FACTORS), 1)))
    return tuple(Parting(factor, _ranges(conicity, row)) for factor, row in zip(CREEP_FACTORS, apart, strict=True))


def _ranges(conicity: Float, apart: Bools) -> tuple[tuple[float, float], ...]:
    """Return the ranges of neighbouring points that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], apart, [False]]).astype(int)))
    return tuple((float(conicity[a]), float(conicity[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True))


def _apart(vehicle: Vehicle, conicity: Float) -> Bools:
    """Return where a vehicle needs more damping, a row for each creep factor."""
    factor = np.repeat(CREEP_FACTORS, conicity.shape[1])
    changes = {"lambda": conicity.ravel(), **{key: vehicle.p[key] * factor for key in CREEP}}
    needed, alone = (_needed(v, changes) for v in (vehicle, vehicle.bogie))
    return np.asarray(needed > APART * alone).reshape(conicity.shape)


def _needed(vehicle: Vehicle, changes: dict[str, Float]) -> Float:
    """Return the damping above which a vehicle is stable [N s/m]: infinite if there is none, 0 if it needs none."""
    size = len(changes["lambda"])
    field = critical_field(ParameterSets(vehicle.model, {**vehicle.p, **changes}, size))
    last = np.sum(~np.isnan(field.unstable_roots), axis=1) - 1
    count = np.take_along_axis(field.unstable_roots, last[:, None], axis=1)[:, 0]
    return np.where(count == 0, np.max(np.nan_to_num(field.critical), axis=1, initial=0.0), np.inf)

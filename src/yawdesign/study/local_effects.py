"""What each uncertain parameter does at the values as designed, by exact derivatives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from yawdesign.damper.capping import CappingMode
from yawdesign.damper.capping import sensitivity as margin_sensitivity
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues
from yawdesign.hunting.sensitivity import sensitivity
from yawdesign.problem.condition import CREEP, CREEP_FACTOR, Condition
from yawdesign.study.answers import evaluate
from yawdesign.study.replicates import UncertainVehicle
from yawdesign.vehicle.vehicle import Vehicle

SAME = 1e-6  # relative difference of one critical value, found in two ways


@dataclass(frozen=True)
class Effect:
    """What one parameter does.

    Parameters
    ----------
    margin : float or None
        Change of the margin when the parameter grows by one standard deviation, linearly: [1/s] or [-].
    sensitivity : float or None
        d ln C_sl / d ln p [-].
    """

    margin: float | None
    sensitivity: float | None


@dataclass(frozen=True)
class AsDesigned:
    """The vehicle as designed, under the worst of the conditions that stay.

    Parameters
    ----------
    margin : float
        There: [1/s] or [-].
    condition : Condition
        The worst.
    effects : mapping name -> Effect
        Of every uncertain parameter.
    """

    margin: float
    condition: Condition
    effects: Mapping[str, Effect]


def as_designed(vehicle: UncertainVehicle, objective: str) -> AsDesigned:
    """Return the margin of the vehicle as designed, and what each parameter does there.

    Parameters
    ----------
    vehicle : UncertainVehicle
        Which.
    objective : {"decay_rate", "damping_ratio"}
        Which margin.
    """
    question, p = vehicle.question, vehicle.uncertain.parameters
    each = [(question.model.at(condition.applied(p)), condition) for condition in question.conditions]
    modes = [_worst_mode(here, question.variables, objective) for here, _ in each]
    k = int(np.argmin([mode.margin for mode in modes]))
    of_margin, of_C_sl = margin_sensitivity(each[k][0], modes[k], objective), _of_C_sl(vehicle, each)
    effects = {}
    for one in vehicle.uncertain.distributions:
        designed = vehicle.uncertain.designed(one)
        relative = _of(one.key, of_margin)
        step = one.deviation(designed) / designed if designed else 0.0
        change = None if relative is None else relative * modes[k].margin * step
        effects[one.name] = Effect(change, _of(one.key, of_C_sl))
    return AsDesigned(modes[k].margin, each[k][1], effects)


def _worst_mode(vehicle: Vehicle, variables: Sequence[str], objective: str) -> CappingMode:
    movable = vehicle.model.movable(variables)
    chosen = [motion for motion in vehicle.model.motions if motion.name in movable]
    modes = [
        CappingMode(motion, complex(s), float(MARGINS[objective](np.array([s]))))
        for motion in chosen
        for s in motion_eigenvalues(vehicle, motion).ravel()
    ]
    return min(modes, key=lambda mode: mode.margin)


def _of_C_sl(vehicle: UncertainVehicle, each: Sequence[tuple[Vehicle, Condition]]) -> dict[str, float]:
    """Return d ln C_sl / d ln p; empty where there is no C_sl, or several speeds or conditions share none."""
    question, p = vehicle.question, vehicle.uncertain.parameters
    C_sl = float(evaluate(replace(question, of="C_sl"), p, threads=1).columns["C_sl"][0])
    for here, condition in each if C_sl > 0 else ():
        found = evaluate(replace(question, of="critical", conditions=(condition,)), p, threads=1).columns
        for value, omega in zip(found["critical"][0], found["omega"][0], strict=True):
            if abs(value / condition.damping_factor - C_sl) < SAME * C_sl:
                return sensitivity(here, float(value), float(omega))
    return {}


def _of(key: str, relative: Mapping[str, float]) -> float | None:
    """Return the derivative with respect to a parameter; that of the creep factor is that of both coefficients."""
    keys = CREEP if key == CREEP_FACTOR.key else (key,)
    return sum(relative[name] for name in keys) if all(name in relative for name in keys) else None

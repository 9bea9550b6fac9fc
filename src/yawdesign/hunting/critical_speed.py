"""Critical speeds: up to which speed the vehicle of a problem is stable, and whether tests can be run at 1.1 v."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.requirements import required
from yawdesign.hunting.scope import conditions_told, scope
from yawdesign.hunting.stable_speeds import MARGIN_OF_TESTS, CriticalSpeed, stable_speeds
from yawdesign.hunting.verdict import RequirementVerdict, given_damping
from yawdesign.problem import Problem
from yawdesign.problem.result import Result
from yawdesign.vehicle.vehicle import Vehicle

DRAWN = 149  # speeds at which the decay rate is computed


@dataclass(frozen=True, repr=False)
class CriticalSpeeds(Result):
    """Up to which speed a vehicle is stable under all conditions, whatever speeds the problem names.

    Parameters
    ----------
    critical_speeds : tuple of CriticalSpeed
        In rising order [m/s]. Under one condition all of them; under several listed ones those that bound what is
        stable under all. Where conditions are ranges, or more than 32, only the lowest: further ones are not searched.
    stable_up_to : float or None
        Every speed from the lowest searched one up to this is stable [m/s]; 0 where that one is not; None beyond the
        searched range.
    searched : tuple of float
        Between which speeds [m/s].
    worst_condition : mapping
        Where stability ends: ``speed`` [m/s], others in SI units, a load by its name. If it does not, the condition of
        the least decay rate of all modes.
    C_s : float
        Damping of the pair of yaw dampers of each bogie as designed [N s/m].
    speed_wanted : float
        1.1 times the highest speed of the problem [m/s], at which vehicles are tested for acceptance.
    reaches : bool
        Whether every speed up to that is stable.
    requirements : tuple of RequirementVerdict
        Critical speeds that are required.
    speeds, decay_rates : tuple of float
        Speeds [m/s] and least decay rates of all modes [1/s] under the worst condition.
    conditions : str
        Under which conditions this holds, and how the worst one was found.
    scope : str
        What this answer does not hold; empty where a car body moves in it.
    checked : bool
        True if eigenvalues lie on the imaginary axis at the critical speeds, and Routh's array and eigenvalues agree on
        both sides of where stability ends.
    """

    critical_speeds: tuple[CriticalSpeed, ...]
    stable_up_to: float | None
    searched: tuple[float, float]
    worst_condition: Mapping[str, Any]
    C_s: float
    speed_wanted: float
    reaches: bool
    requirements: tuple[RequirementVerdict, ...]
    speeds: tuple[float, ...]
    decay_rates: tuple[float, ...]
    conditions: str
    scope: str
    checked: bool


def critical_speed(problem: Problem) -> CriticalSpeeds:
    """Return up to which speed a problem's vehicle is stable under all conditions, with the yaw damping written in it.

    Looks from 10 to 600 km/h, whatever speeds the problem names; further, where twice the critical speed that is
    required, or 1.1 times the highest speed of the problem, is more.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.

    Returns
    -------
    CriticalSpeeds
        The critical speeds [m/s], under which condition, and what requires them.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``.

    Examples
    --------
    >>> import yawdesign as yd
    >>> found = yd.critical_speed(yd.table1().replace(C_s="200 kN s/m"))
    >>> round(found.stable_up_to * 3.6, 1), found.reaches
    (377.9, True)
    """
    given_damping(problem)
    judged = Judged(problem, {name: float(value) for name, value in problem.parameters().items()})
    found = stable_speeds(judged)
    asked = tuple(each for each in problem.requirements if each.measure == "critical_speed")
    of_speeds = replace(problem, requirements=asked)
    faults = [Judged(of_speeds, judged.p, case) for case in problem.cases]
    requirements = required(Judged(of_speeds, judged.p), faults)
    wanted = MARGIN_OF_TESTS * float(max(problem.speeds))
    speeds = np.linspace(*found.searched, DRAWN)
    sets = under_conditions(judged.model, judged.p, [(found.worst.with_values({"v": speeds}), DRAWN)])
    return CriticalSpeeds(
        critical_speeds=found.critical,
        stable_up_to=found.up_to,
        searched=found.searched,
        worst_condition=found.worst.described,
        C_s=judged.p["C_s"],
        speed_wanted=wanted,
        reaches=found.up_to is None or found.up_to >= wanted,
        requirements=requirements,
        speeds=tuple(speeds.tolist()),
        decay_rates=tuple(judged.every_mode.of(sets).tolist()),
        conditions=conditions_told(judged.conditions.without({"v"}), judged.p),
        scope=scope(Vehicle.of(problem)),
        checked=found.checked and all(each.checked for each in requirements),
    )

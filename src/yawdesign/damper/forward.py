"""Forward design of the yaw damper: stable intervals, curving limit, golden section (eqs (11) to (15))."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

import numpy as np

from yawdesign.damper.curving import ENOUGH, curving_conditions, excess, largest_resistance, least_curving_limit
from yawdesign.damper.single_bogie import CONICITIES, SingleBogie, of_bogie, partings
from yawdesign.damper.stable_intervals import ConditionLookedAt, StableUnderAll, stable_under_all
from yawdesign.damper.status import Status
from yawdesign.hunting.all_conditions import case_verdicts
from yawdesign.hunting.critical_damping import CriticalValue, Interval
from yawdesign.hunting.requirements import requirement_verdicts
from yawdesign.hunting.scope import conditions_told, scope
from yawdesign.hunting.sensitivity import sensitivity
from yawdesign.hunting.verdict import CaseVerdict, RequirementVerdict
from yawdesign.problem import Curve, Problem
from yawdesign.problem.conditions import ConditionSet, condition_set
from yawdesign.problem.result import Result
from yawdesign.vehicle.vehicle import Model, Vehicle


@dataclass(frozen=True)
class Critical(CriticalValue):
    """A critical value and the condition it belongs to.

    Parameters
    ----------
    speed : float
        Running speed [m/s].
    condition : mapping
        Its values by the names of the problem file, ``speed`` [m/s] among them; SI values, a load by its name.
    """

    speed: float
    condition: Mapping[str, Any]


@dataclass(frozen=True, repr=False)
class ForwardDesign(Result):
    """Answer of the forward design.

    Values of C_s are those as designed: a tolerance of C_s is in the verdicts.

    Parameters
    ----------
    critical : tuple of Critical
        The critical values, ascending under each condition: all of what is listed and of the ends of ranges (with more
        than 64 those that bound a stable interval), and of the conditions inside ranges those that bound one.
    stable_intervals : tuple of (low, high)
        Open intervals of C_s [N s/m] that are stable under every condition; high is infinite where there is no limit.
    C_sl : float or None
        Lower end of the stable interval the design lies in [N s/m]; without a design that of the lowest interval.
    C_su : float or None
        What the curve allows under every condition, eq. (14) [N s/m].
    C_s : float or None
        Golden section 0.382 of the way from C_sl to C_su, or to the end of the stable interval if that is lower
        [N s/m].
    status : Status
        What kind of answer this is.
    message : str
        The same in a sentence, and what to do.
    stable : bool
        Whether that C_s is stable under every condition, by eigenvalues and by Routh's array.
    rotational_resistance : float or None
        The largest T / (4 Q a) with that C_s under any condition [-].
    sensitivity : mapping
        d ln C_sl / d ln p [-] for every parameter p and the speed v, under the condition that sets C_sl.
    load : str or None
        The load that stands for Q in eq. (13): axle or wheel.
    checked : bool
        Whether the stable intervals were confirmed by two ways of counting roots.
    worst_condition : mapping
        The condition that sets C_sl, as in `Critical`; empty where none does, since every lower C_s is stable.
    searched : str
        Under which conditions this holds, and how the worst ones were found.
    requirements : tuple of RequirementVerdict
        What must be reached, and whether this C_s does; empty without a C_s.
    cases : tuple of CaseVerdict
        The stability with each fault; empty without a C_s.
    single_bogie : SingleBogie or None
        For a vehicle with a car body: what one of its bogies alone would have answered.
    scope : str
        What this answer does not hold; empty where a car body moves in it.
    """

    critical: tuple[Critical, ...]
    stable_intervals: tuple[Interval, ...]
    C_sl: float | None
    C_su: float | None
    C_s: float | None
    status: str
    message: str
    stable: bool
    rotational_resistance: float | None
    sensitivity: Mapping[str, float]
    load: str | None
    checked: bool
    worst_condition: Mapping[str, Any] = field(default_factory=dict)
    searched: str = ""
    requirements: tuple[RequirementVerdict, ...] = ()
    cases: tuple[CaseVerdict, ...] = ()
    single_bogie: SingleBogie | None = None
    scope: str = ""


def design(problem: Problem) -> ForwardDesign:
    """Return the forward design of a problem's yaw damper.

    Parameters
    ----------
    problem : Problem
        ``C_s`` need not be given; without a curve there may be no upper limit and so no choice.

    Returns
    -------
    ForwardDesign
        Critical values, C_sl, C_su and C_s [N s/m], and what kind of answer it is.

    Examples
    --------
    >>> import yawdesign as yd
    >>> result = yd.design(yd.table1(equations="as-printed"))
    >>> round(result.C_sl, 3), round(result.C_su, 3), round(result.C_s)
    (90702.89, 2593442.982, 1046750)
    """
    p = problem.parameters()
    found = forward_design(Model.of(problem), p, condition_set(problem), problem.curve)
    if found.C_s is None:
        return found
    chosen = {**p, "C_s": found.C_s}
    requirements, cases = requirement_verdicts(problem, chosen), case_verdicts(problem, chosen)
    checked = all(x.checked for x in requirements) and all(x.checked for x in cases)
    return replace(found, requirements=requirements, cases=cases, checked=found.checked and checked)


def forward_design(model: Model, p: Mapping[str, Any], conditions: ConditionSet, curve: Curve | None) -> ForwardDesign:
    """Return the forward design of a vehicle; with a car body, what a single bogie would have answered stands in it.

    Parameters
    ----------
    model : Model
        The vehicle's equations.
    p : mapping
        Its numbers as designed, in SI units; C_s is not looked at.
    conditions : ConditionSet
        Under which everything must hold.
    curve : Curve or None
        What limits C_s.
    """
    numbers = {name: float(x) for name, x in p.items() if name != "C_s"}
    designed = model.at(numbers)
    upper = None if curve is None else least_curving_limit(numbers, curving_conditions(conditions), curve)
    known, found = _forward_design(designed, conditions, curve, upper)
    if not model.has_car_body:
        return found
    _, alone = _forward_design(designed.bogie, of_bogie(conditions, model), curve, upper)
    fastest = max(condition.speed for condition in conditions.corners)
    beside = SingleBogie(
        C_sl=alone.C_sl,
        C_s=alone.C_s,
        stable_intervals=alone.stable_intervals,
        status=alone.status,
        stable=None if alone.C_s is None else known.is_stable(alone.C_s),
        partings=partings(designed.replace(v=fastest)),
        searched=CONICITIES,
        speed=fastest,
    )
    return replace(found, single_bogie=beside)


def _forward_design(
    designed: Vehicle, conditions: ConditionSet, curve: Curve | None, upper: float | None
) -> tuple[StableUnderAll, ForwardDesign]:
    known = stable_under_all(designed, conditions, inf if upper is None else upper)
    C_sl, golden = (None if np.isnan(x[0]) else float(x[0]) for x in (known.decision.C_sl, known.decision.C_s))
    checked = known.checked and (golden is None or known.is_stable(golden))
    status = Status.named(known.decision.status[0]) if checked else Status.UNVERIFIED
    C_s = golden if checked else None
    resisted = C_s and curve and largest_resistance(designed.p, C_s, curving_conditions(conditions), curve)
    worst, slopes = _bounding(known, C_sl)
    return known, ForwardDesign(
        critical=tuple(_told(x, one) for one in known.shown for x in one.damping.critical),
        stable_intervals=known.decision.stable_intervals(0),
        C_sl=C_sl,
        C_su=upper,
        C_s=C_s,
        status=status,
        message=status.told(_excess(status, C_sl, designed.p, conditions, curve)),
        stable=C_s is not None,
        rotational_resistance=resisted or None,
        sensitivity=slopes,
        load=None if curve is None else curve.load,
        checked=checked,
        worst_condition=worst,
        searched=conditions_told(conditions, designed.p),
        scope=scope([designed.under(condition) for condition in conditions.corners]),
    )


def _excess(
    status: Status, C_sl: float | None, p: Mapping[str, Any], conditions: ConditionSet, curve: Curve | None
) -> str:
    """Return in words what the curve's limit is short of, where that is why there is no design."""
    if curve is None or status not in (Status.INFEASIBLE, Status.INFEASIBLE_IN_CURVE):
        return ""
    # Another suspension has another C_sl; the limit and the radius have no part in it.
    C_s, given = (0.0, ENOUGH) if status == Status.INFEASIBLE_IN_CURVE else (C_sl, ("limit", "R"))
    each = [condition.applied({**p, "C_s": C_s}) for condition in curving_conditions(conditions)]
    return excess(each, ("C_s",), curve, given)


def _told(x: CriticalValue, one: ConditionLookedAt) -> Critical:
    return Critical(x.C_s, x.omega, x.becomes, x.residual, one.condition.speed, one.condition.described)


def _bounding(known: StableUnderAll, C_sl: float | None) -> tuple[dict[str, Any], dict[str, float]]:
    """Return the condition that sets C_sl, and the sensitivities under it."""
    found = known.bounding(C_sl)
    if found is None:
        return {}, {}
    one, x = found
    return one.condition.described, sensitivity(one.vehicle, x.C_s * one.condition.damping_factor, x.omega)

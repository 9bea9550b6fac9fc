"""The intervals of C_s in which a vehicle is stable under every condition.

First all combinations of what is listed and of the ends of ranges. Then, inside the ranges, conditions that take
something away from an interval: at its ends, at the golden section and at places between, until none is found. That is
a search and no proof. All values are of C_s as designed: under a tolerance of C_s the vehicle has another one.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import exp, inf, log

import numpy as np

from yawdesign.damper.decision import Crossings, Decision, decide, together
from yawdesign.hunting.critical_damping import CriticalDamping, CriticalValue, critical_damping
from yawdesign.hunting.many import margins
from yawdesign.hunting.many.critical_table import natural_damping
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.routh import count_unstable
from yawdesign.hunting.verdict import stability_at
from yawdesign.hunting.worst_condition import exceeds_everywhere, worst_conditions
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet
from yawdesign.vehicle.vehicle import Vehicle

MOST_ALONE = 64  # conditions that are all looked at by themselves; of more, those that bound an interval
MOST_STEPS = 20_000  # combinations with the speeds of the first look; of more the ends of the speeds alone
INSIDE = 1e-6  # how far from an end of an interval, relative to it, conditions are looked for that move it
PLACES = 9  # between the ends of an interval
REACH = 1e3  # how far towards 0 and infinity, as a ratio to the nearest value that is known
MOST_ADDED = 100  # conditions
SAME = 1e-8  # of two critical values, relative


@dataclass(frozen=True)
class ConditionLookedAt:
    """A condition with the critical values under it.

    Parameters
    ----------
    condition : Condition
        Which one.
    vehicle : Vehicle
        It under the condition.
    damping : CriticalDamping
        Critical values of C_s as designed [N s/m].
    others_stable : bool
        Whether the motions that no yaw damper reaches are stable.
    """

    condition: Condition
    vehicle: Vehicle
    damping: CriticalDamping
    others_stable: bool

    @classmethod
    def of(cls, designed: Vehicle, condition: Condition) -> "ConditionLookedAt":
        """Return a condition of a vehicle, whose numbers are those as designed."""
        vehicle, factor = designed.under(condition), condition.damping_factor
        found = critical_damping(vehicle)
        values = tuple(replace(x, C_s=x.C_s / factor) for x in found.critical)
        return cls(condition, vehicle, replace(found, critical=values), others_stable(vehicle))

    @property
    def crossings(self) -> Crossings:
        """Its critical values and counts of unstable roots, as `decide` takes them."""
        return np.array([[x.C_s for x in self.damping.critical]]), np.array([self.damping.unstable_roots])

    def value_at(self, end: float) -> CriticalValue | None:
        """Return the critical value that is the end of an interval, if one is."""
        return next((x for x in self.damping.critical if abs(x.C_s - end) <= SAME * end), None)

    def is_stable(self, C_s: float) -> bool:
        """Return whether eigenvalues and Routh's array both say that a damping as designed is stable."""
        verdict = stability_at(self.vehicle.replace(C_s=C_s * self.condition.damping_factor))
        return verdict.stable and verdict.checked


@dataclass(frozen=True)
class OtherConditions:
    """Many conditions that are looked at together, and bound no interval.

    Parameters
    ----------
    conditions : tuple of Condition
        Which ones.
    sets : ParameterSets
        The vehicle under each of them.
    crossings : Crossings
        Where none of them is unstable, as if they were one condition.
    checked, others_stable : bool
        As of a single condition, for all of them.
    """

    conditions: tuple[Condition, ...]
    sets: ParameterSets
    crossings: Crossings
    checked: bool
    others_stable: bool

    def are_stable(self, C_s: float) -> bool:
        """Return whether a damping as designed is stable under all of them, by Routh's array."""
        factors = np.array([condition.damping_factor for condition in self.conditions])
        yes, sure = margins.stable(self.sets.replace(C_s=C_s * factors))
        return bool(np.all(yes & sure))


@dataclass(frozen=True)
class StableUnderAll:
    """What is stable under all conditions that were looked at.

    Parameters
    ----------
    each : tuple of ConditionLookedAt
        Those that are looked at by themselves: the listed ones first.
    listed : int
        So many of them are no finds of the search inside ranges.
    others : OtherConditions or None
        Where there are many, those that are not.
    most : float
        What the curve allows [N s/m]; infinite without one.
    """

    each: tuple[ConditionLookedAt, ...]
    listed: int
    others: OtherConditions | None
    most: float

    @cached_property
    def decision(self) -> Decision:
        """The forward design between the critical values of all conditions."""
        crossings = [one.crossings for one in self.each] + [x.crossings for x in self._others]
        steady = all(one.others_stable for one in self.each) and all(x.others_stable for x in self._others)
        return decide(crossings, np.array([self.most]), np.array([steady]))

    @property
    def _others(self) -> list[OtherConditions]:
        return [self.others] if self.others else []

    @property
    def checked(self) -> bool:
        """Whether all critical values were confirmed by two ways of counting roots."""
        return all(one.damping.checked for one in self.each) and all(x.checked for x in self._others)

    @property
    def shown(self) -> tuple[ConditionLookedAt, ...]:
        """The conditions that are told: the listed ones, and of those found inside ranges what bounds an interval."""
        ends = [end for interval in self.decision.stable_intervals(0) for end in interval if 0 < end < inf]
        found = (one for one in self.each[self.listed :] if any(one.value_at(end) for end in ends))
        return (*self.each[: self.listed], *found)

    def bounding(self, end: float | None) -> tuple[ConditionLookedAt, CriticalValue] | None:
        """Return the condition that sets an end of an interval, with its critical value; None if none does."""
        found = [(one, one.value_at(end)) for one in self.each if end]
        return next(((one, value) for one, value in found if value), None)

    def is_stable(self, C_s: float) -> bool:
        """Return whether a damping as designed is stable under all of them, by the second route too."""
        return all(one.is_stable(C_s) for one in self.each) and all(x.are_stable(C_s) for x in self._others)

    def with_condition(self, one: ConditionLookedAt) -> "StableUnderAll":
        """Return the same with one more condition."""
        return replace(self, each=(*self.each, one))

    def places(self, natural: float) -> Iterator[tuple[float, bool]]:
        """Yield where in the intervals to look for worse conditions, and whether closely, the most important first."""
        intervals = self.decision.stable_intervals(0)
        golden = float(self.decision.C_s[0])
        parts = [part for interval in intervals for part in _parts(*interval, self.most)]
        scales = [_scale(low, high, natural) for low, high in parts]
        for low, high in scales:
            inside = min(INSIDE, log(high / low) / 4)
            yield low * exp(inside), True
            yield high * exp(-inside), True
        if not np.isnan(golden):
            yield golden, True
        for low, high in scales:
            yield from ((low * (high / low) ** (k / (PLACES + 1)), False) for k in range(1, PLACES + 1))


def others_stable(vehicle: Vehicle) -> bool:
    """Return whether all motions that no yaw damper reaches are stable; no C_s can help there."""
    others = [motion for motion in vehicle.motions if not motion.varied]
    return all(count_unstable(motion.polynomial(0)) == 0 for motion in others)


def _parts(low: float, high: float, most: float) -> list[tuple[float, float]]:
    """Return an interval, cut at what the curve allows."""
    ends = [low, most, high] if low < most < high else [low, high]
    return [*pairwise(ends)]


def _scale(low: float, high: float, natural: float) -> tuple[float, float]:
    """Return the ends between which an interval is looked at on a geometric scale."""
    return low or min(high, natural) / REACH, high if high < inf else max(low, natural) * REACH


def stable_under_all(designed: Vehicle, conditions: ConditionSet, most: float) -> StableUnderAll:
    """Return what is stable under all conditions; inside ranges the worst are searched for.

    Parameters
    ----------
    designed : Vehicle
        With its numbers as designed; its own C_s is not looked at.
    conditions : ConditionSet
        Lists and ranges.
    most : float
        What the curve allows [N s/m]; infinite without one.
    """
    known = _listed(designed, conditions, most)
    return _with_worst_inside(known, designed, conditions) if conditions.ranges else known


def _listed(designed: Vehicle, conditions: ConditionSet, most: float) -> StableUnderAll:
    many = len(conditions.corners) * conditions.steps > MOST_STEPS
    listed = conditions.corners if many else conditions.first_look
    if len(listed) <= MOST_ALONE:
        each = tuple(ConditionLookedAt.of(designed, condition) for condition in listed)
        return StableUnderAll(each, len(each), None, most)
    sets = _sets(designed, listed)
    field, steady = critical_field(sets), margins.others_stable(sets)
    critical = field.critical / np.array([[condition.damping_factor] for condition in listed])
    ends = together(critical, field.unstable_roots)[0].ravel()
    bounds = {int(np.argmax(np.any(critical == end, axis=1))) for end in ends}
    each = tuple(ConditionLookedAt.of(designed, listed[k]) for k in sorted(bounds))
    rest = np.array([k for k in range(len(listed)) if k not in bounds])
    others = OtherConditions(
        tuple(listed[k] for k in rest),
        sets.part(rest),
        together(critical[rest], field.unstable_roots[rest]),
        checked=not field.unverified.any() and bool(np.all(steady[1])),
        others_stable=bool(np.all(steady[0])),
    )
    return StableUnderAll(each, len(each), others, most)


def _sets(designed: Vehicle, conditions: Sequence[Condition]) -> ParameterSets:
    return under_conditions(designed.model, designed.p, [(condition, 1) for condition in conditions])


def _with_worst_inside(known: StableUnderAll, designed: Vehicle, conditions: ConditionSet) -> StableUnderAll:
    """Return the same with conditions inside ranges, until none is found that takes away from an interval."""
    natural = float(natural_damping(_sets(designed, [conditions.corners[0]]))[0])
    clear: set[float] = set()
    for _ in range(MOST_ADDED):
        worse = None
        for place, closely in known.places(natural):
            if place in clear:
                continue
            worse = _unstable_at(place, closely, designed, conditions)
            if worse and worse not in [one.condition for one in known.each]:
                break
            clear.add(place)
        else:
            return known
        known = known.with_condition(ConditionLookedAt.of(designed, worse))
    return known


def _unstable_at(C_s: float, closely: bool, designed: Vehicle, conditions: ConditionSet) -> Condition | None:
    """Return the condition under which a damping as designed is unstable, the most unstable one; None if there is none.

    Not closely: only where a grid of conditions has one.
    """
    model, p = designed.model, {**designed.p, "C_s": C_s}
    measure = Measure("decay_rate", model.parameters)
    if not closely and exceeds_everywhere(model, p, conditions, measure, 0.0):
        return None
    worst = worst_conditions(model, p, conditions, measure)[0]
    return worst.condition if worst.margin < 0 else None

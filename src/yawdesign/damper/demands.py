"""What a design must reach beside its largest margin: requirements as verdicts at a level, under their conditions."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin
from yawdesign.problem import Problem
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet, condition_set
from yawdesign.problem.requirements import Requirement
from yawdesign.problem.running import LOWEST_SEARCHED
from yawdesign.vehicle.vehicle import Model

# What counts as one in the shortfall from a requirement: its level, but at least this [1/s], [-].
LEAST_SCALE = {"decay_rate": 0.1, "damping_ratio": 0.01}
RESERVE = {"decay_rate": 1e-5, "damping_ratio": 1e-6}  # where no more than stability is wanted [1/s], [-]
SPARE = 1e-6  # share by which more than what is required is demanded where a worst condition inside ranges is searched
SCALE_OF_UNSTABLE = 1.0  # [1/s], of what a damping ratio falls short of where it is negative


@dataclass(frozen=True)
class Demand:
    """A requirement as a level of a margin.

    Parameters
    ----------
    requirement : Requirement
        What must be reached.
    measure : Measure
        Which margin.
    level : float
        What it must exceed [1/s], [-].
    conditions : ConditionSet
        Under which.
    """

    requirement: Requirement
    measure: Measure
    level: float
    conditions: ConditionSet

    @property
    def enough(self) -> float:
        """What meets the requirement where conditions are ranges: nearly the level [1/s], [-]."""
        return self.level * (1 - SPARE / 2)

    @property
    def scale(self) -> float:
        """What counts as one in its shortfall [1/s], [-]."""
        if self.requirement.measure == "critical_speed":
            return SCALE_OF_UNSTABLE
        return max(self.level, LEAST_SCALE[self.measure.objective])


def demands(problem: Problem, model: Model) -> tuple[Demand, ...]:
    """Return the requirements of a problem, those of faults for each fault."""
    given, variables = condition_set(problem), tuple(problem.design.variables)
    found = []
    for each in problem.requirements:
        for case in problem.cases if each.of_cases else (None,):
            if each.measure == "critical_speed":
                # The speed at which stability ends is one of all motions.
                measure = Measure("decay_rate", model.parameters, case)
                found.append(
                    Demand(each, measure, RESERVE["decay_rate"], given.with_speeds(LOWEST_SEARCHED, float(each.wanted)))
                )
            else:
                spare = SPARE if given.ranges else 0.0
                level = max(float(each.wanted) * (1 + spare), RESERVE[each.measure])
                found.append(Demand(each, Measure(each.measure, variables, case), level, given))
    return tuple(found)


class Demanded:
    """A demand under some of its conditions, of many designs.

    Parameters
    ----------
    demand : Demand
        What is demanded.
    conditions : sequence of Condition
        Under which it is looked at.
    """

    def __init__(self, demand: Demand, conditions: Sequence[Condition]) -> None:
        self.demand = demand
        self.conditions = tuple(conditions)
        self.worst_margin = WorstMargin(self.conditions, demand.measure)

    @cached_property
    def _decay(self) -> WorstMargin:
        measure = Measure("decay_rate", self.demand.measure.variables, self.demand.measure.case)
        return WorstMargin(self.conditions, measure)

    def worst_of(self, sets: ParameterSets) -> Float:
        """Return the margins that are demanded [1/s], [-]."""
        return self.worst_margin.of(sets)

    def met_within(self, sets: ParameterSets, short: Float) -> Bools:
        """Return where the shortfall is less than a given one, shape (n,); 0 asks whether the demand is met."""
        demand = self.demand
        level = demand.level - short * demand.scale
        if demand.measure.objective == "decay_rate":
            return self.worst_margin.exceeds(sets, level)
        out = np.zeros(sets.size, dtype=bool)
        stable = level >= 0
        if stable.any():
            out[stable] = self.worst_margin.exceeds(sets.part(stable), level[stable])
        if not stable.all():
            out[~stable] = self._decay.exceeds(sets.part(~stable), level[~stable] / demand.scale * SCALE_OF_UNSTABLE)
        return out

    def shortfall(self, sets: ParameterSets) -> Float:
        """Return by how much the demand is missed, shape (n,); zero or less where it is met [-]."""
        demand = self.demand
        reached = self.worst_margin.of(sets)
        if demand.measure.objective == "damping_ratio" and (unstable := reached < 0).any():
            decay = self._decay.of(sets.part(unstable))
            reached[unstable] = decay / SCALE_OF_UNSTABLE * demand.scale
        return np.asarray((demand.level - reached) / demand.scale)

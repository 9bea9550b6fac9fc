"""The design space in which one number of the problem gives way: what is best there is the least change of it.

At a share of the way, 0 ... 1, the number is changed, and a design meets all demands or does not: one verdict for each
point, as for a margin. The merit of a design is minus the least share at which it meets them.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from yawdesign.damper.changed_problem import Way
from yawdesign.damper.demands import Demand, Demanded, demands
from yawdesign.damper.design_space import Space, Values
from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.condition import Condition
from yawdesign.problem.requirements import Requirement

SECTIONS, SHARES = 5, 64  # how often the least share is enclosed, and by how many shares
CLOSER = 1e-6  # a share is less than another only if it is by so much, relative
STABILITY = "stability"  # what is demanded where no margin is


@dataclass(frozen=True)
class SlowedMeasure(Measure):
    """A margin at a speed that is at most one of the values of a set.

    Parameters
    ----------
    highest : str
        Its name among the values.
    """

    highest: str = "speed"

    def _of_case(self, sets: ParameterSets) -> ParameterSets:
        return super()._of_case(sets.replace(v=np.minimum(sets.values["v"], sets.values[self.highest])))


@dataclass(frozen=True)
class RelaxedSpace(Space):
    """Design space of a problem of which one number is relaxed.

    Parameters
    ----------
    way : Way
        Which number, and how far.
    """

    way: Way = field(kw_only=True)

    @cached_property
    def demands(self) -> tuple[Demand, ...]:
        """What every design must reach, stability where no margin is required."""
        found = demands(self.problem, self.model)
        if is_stability_demanded(self.problem.requirements):
            measure = Measure("decay_rate", self.model.parameters)
            found = (*found, Demand(Requirement(STABILITY, 0.0), measure, 0.0, self.condition_set))
        return tuple(self._slowed(demand) for demand in found)

    def _slowed(self, demand: Demand) -> Demand:
        of_speeds = demand.requirement.measure == "critical_speed"
        if not (self._is_relaxed(demand) if of_speeds else self.way.kind == "speed"):
            return demand
        measure = demand.measure
        slowed = SlowedMeasure(measure.objective, measure.variables, measure.case, highest=self.way.name)
        return replace(demand, measure=slowed)

    def _is_relaxed(self, demand: Demand) -> bool:
        return self.way.name == f"requirements.{demand.requirement.name}"

    @cached_property
    def demanded(self) -> tuple[Demanded, ...]:
        """The demands under the conditions that are looked at; of those for the margin stability is looked at."""
        known = [demand.conditions.corners for demand in self.demands]
        if self.known:
            known = [*self.known[1:], self.known[0]][: len(self.demands)]
        return tuple(Demanded(demand, some) for demand, some in zip(self.demands, known, strict=True))

    def known_at(self, value: float) -> tuple[tuple[Condition, ...], ...]:
        """Return the conditions that are looked at where the number has a value, as those of the problem with it."""
        if not self.known:
            return ()
        slowed = [self.way.kind == "speed", *(isinstance(x.measure, SlowedMeasure) for x in self.demands)]
        return tuple(
            tuple(dict.fromkeys(_slowed(condition, value) for condition in some)) if slow else some
            for some, slow in zip(self.known, slowed, strict=False)
        )

    def values_at(self, x: Float, share: Float) -> Values:
        """Return all values at points of the unit cube, shape (variables, n), each at its share of the way."""
        value = self.way.at(share)
        changed = {self.way.key: value} if self.way.kind == "parameter" else {}
        return self._placed(x, {**self.fixed, **changed, self.way.name: value})

    def _bounds_with(self, name: str, known: Values) -> tuple[Any, Any]:
        low, high = self.bounds(name)
        value = known.get(self.way.name, self.way.now)
        if self.way.name == f"design.variables.{name}.max":
            return low, value
        return (value, high) if self.way.name == f"design.variables.{name}.min" else (low, high)

    def in_curve(self, values: Values) -> list[Values]:
        """Return the same; a larger limit is as good as an axle load that is larger by as much, eq. (13)."""
        found = super().in_curve(values)
        if self.way.kind != "limit":
            return found
        more = values.get(self.way.name, self.way.now) / self.way.now
        return [{**p, "W": p["W"] * more} for p in found]

    @property
    def passes_curve(self) -> bool:
        """Whether any design keeps the curve's limit at any share of the way."""
        shares = np.linspace(0, 1, SHARES)
        values = self.values_at(np.repeat(self.gentlest[:, None], SHARES, axis=1), shares)
        return bool(np.any(self.feasible(values)))

    def met(self, x: Float, share: Float) -> Bools:
        """Return where a design meets everything that is demanded at a share of the way, shape (n,).

        Parameters
        ----------
        x : array, shape (variables, n)
            Points of the cube.
        share : array, shape (n,)
            0 ... 1 [-].
        """
        values = self.values_at(x, share)
        sets = ParameterSets(self.model, values, x.shape[1])
        out = np.broadcast_to(self.feasible(values), x.shape[1]).copy()
        for one in self.demanded:
            left = np.flatnonzero(out)
            out[left] = one.met_within(sets.part(left), self._short(one.demand, values[self.way.name][left]))
        return out

    def _short(self, demand: Demand, value: Float) -> Float:
        """Return the shortfall that a relaxed requirement allows, as a share of its scale."""
        if self._is_relaxed(demand) and demand.requirement.measure != "critical_speed":
            return np.asarray((demand.level - value) / demand.scale)
        return np.zeros(len(value))

    def beats_at(self, x: Float, level: Float) -> Bools:
        """Return where the merit exceeds a level, shape (n,), at points of the cube; below -1 any share will do.

        There half of the points are looked at with the whole way, others at one share each: more is not always better.
        """
        n = x.shape[1]
        anywhere = np.where(np.arange(n) % 2, 1.0, np.arange(n) / n)
        return self.met(x, np.where(level < -1, anywhere, np.clip(-level * (1 - CLOSER), 0, 1)))

    def margins_at(self, x: Float) -> Float:
        """Return the merits, minus infinity where no share is enough."""
        n = x.shape[1]
        low, width, merit = np.zeros(n), 1.0, np.full(n, -np.inf)
        left = np.arange(n)
        for _ in range(SECTIONS):
            width /= SHARES
            shares = low[left] + width * np.arange(1, SHARES + 1)[:, None]
            met = self.met(np.tile(x[:, left], SHARES), shares.reshape(-1)).reshape(SHARES, len(left))
            low[left] += np.argmax(met, axis=0) * width
            left = left[met.any(axis=0)]
        merit[left] = -(low[left] + width)
        return merit


def is_stability_demanded(requirements: tuple[Requirement, ...]) -> bool:
    """Return whether stability must be demanded beside requirements, of which none is a margin of the vehicle."""
    return all(each.of_cases or each.measure == "critical_speed" for each in requirements)


def _slowed(condition: Condition, value: float) -> Condition:
    return condition.with_values({"v": min(condition.speed, value)})

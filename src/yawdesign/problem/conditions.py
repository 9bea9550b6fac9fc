"""The conditions of a problem as one set: every combination of what is listed, and every value of its ranges."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import prod

from .condition import CREEP, TOLERANCE, Condition, Load
from .problem import Problem
from .running import SpeedRange


@dataclass(frozen=True)
class ConditionSet:
    """The conditions under which everything must hold.

    Parameters
    ----------
    lists : tuple of Condition
        Every combination of listed values and loads.
    ranges : tuple of (name, (low, high))
        Every value between both ends comes with each of them, in SI units [SI].
    steps : int
        Number of speeds of the first look, where the speed is a range.
    """

    lists: tuple[Condition, ...]
    ranges: tuple[tuple[str, tuple[float, float]], ...] = ()
    steps: int = 11

    @property
    def corners(self) -> tuple[Condition, ...]:
        """Every combination of what is listed and of the ends of the ranges."""
        return self._with(dict(self.ranges))

    @property
    def first_look(self) -> tuple[Condition, ...]:
        """The corners, and the speeds between them."""
        ends: dict[str, tuple[float, ...]] = dict(self.ranges)
        if "v" in ends:
            low, high = ends["v"]
            ends["v"] = SpeedRange(min=low, max=high, steps=self.steps).values
        return self._with(ends)

    def grid(self, most: int, each: int = 9) -> tuple[Condition, ...]:
        """Return the corners and conditions between them: `each` values of every range, of the speed its `steps`.

        Fewer of each where that would make more than `most` conditions, down to the corners.
        """
        counts = {name: self.steps if name == "v" else each for name, _ in self.ranges}
        while len(self.lists) * prod(counts.values()) > most and max(counts.values()) > 2:
            largest = max(counts, key=lambda name: counts[name])
            counts[largest] -= 1
        ends = dict(self.ranges)
        return self._with({name: _spaced(*ends[name], n) for name, n in counts.items()})

    def _with(self, values: Mapping[str, tuple[float, ...]]) -> tuple[Condition, ...]:
        combinations = [dict(zip(values, each, strict=True)) for each in product(*values.values())]
        return tuple(_speed_first(each.with_values(more)) for each in self.lists for more in combinations)

    def at(self, place: int, values: Mapping[str, float]) -> Condition:
        """Return the condition with given values of the ranges, and what is listed at a place."""
        return _speed_first(self.lists[place].with_values(values))

    def without(self, names: Collection[str]) -> ConditionSet:
        """Return what remains where other values of some names are given."""
        gone = {*names, *(("creep_factor",) if set(CREEP) & set(names) else ())}
        ranges = tuple(x for x in self.ranges if x[0] not in gone)
        return ConditionSet(distinct(self.lists, names), ranges, self.steps)

    def with_speeds(self, low: float, high: float) -> ConditionSet:
        """Return the same conditions at every speed between two [m/s]."""
        lists = distinct(self.lists, {"v"})
        others = tuple(x for x in self.ranges if x[0] != "v")
        return ConditionSet(lists, (("v", (low, high)), *others), self.steps)

    @property
    def is_one(self) -> bool:
        """Whether there is no other condition than one."""
        return len(self.lists) == 1 and not self.ranges


def _spaced(low: float, high: float, n: int) -> tuple[float, ...]:
    """Return values between two ends, both included."""
    return (low, *(low + (high - low) * k / (n - 1) for k in range(1, n - 1)), high)


def _speed_first(condition: Condition) -> Condition:
    return replace(condition, changes=tuple(sorted(condition.changes, key=lambda change: change[0] != "v")))


def condition_set(problem: Problem) -> ConditionSet:
    """Return the conditions of a problem, its speeds among them."""
    given, speed = problem.conditions, problem.speed
    lists: dict[str, tuple[float, ...]] = {} if isinstance(speed, SpeedRange) else {"v": problem.speeds}
    lists |= dict(given.values)
    ranges: dict[str, tuple[float, float]] = {}
    if isinstance(speed, SpeedRange):
        ranges["v"] = (speed.min, speed.max)
    ranges |= dict(given.ranges)
    ranges |= {f"{TOLERANCE}{name}": (-share, share) for name, share in given.tolerance}
    loads: tuple[Load | None, ...] = given.loads or (None,)
    steps = speed.steps if isinstance(speed, SpeedRange) else 11
    combinations = [tuple(zip(lists, each, strict=True)) for each in product(*lists.values())]
    every = tuple(Condition(changes, load) for changes in combinations for load in loads)
    return ConditionSet(every, tuple(ranges.items()), steps)


def conditions(problem: Problem) -> tuple[Condition, ...]:
    """Return the conditions of a problem that are looked at first: of ranges their ends, and some speeds between."""
    return condition_set(problem).first_look


def distinct(conditions: Iterable[Condition], given: Collection[str]) -> tuple[Condition, ...]:
    """Return what remains of conditions where some names are given, each once."""
    return tuple(dict.fromkeys(condition.without(given) for condition in conditions))

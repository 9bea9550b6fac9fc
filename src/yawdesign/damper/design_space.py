"""The design space of a problem: its variables as a unit cube.

The curve's limit is built into the cube: the coordinate of C_s runs up to what the curve allows with the other
variables, so every point of the cube with ``C_su`` above the lower bound is feasible.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from yawdesign.damper.curving import (
    LOWERING,
    RAISING,
    curving_conditions,
    curving_limit,
    resistance_scale,
    resisting_moment,
)
from yawdesign.damper.demands import RESERVE, Demand, Demanded, demands
from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin
from yawdesign.hunting.worst_condition import worst_conditions
from yawdesign.problem import PARAMETERS, Curve, Problem
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet, condition_set
from yawdesign.vehicle.vehicle import Model

Values = dict[str, Any]

# The merit of a design that misses a requirement is less than that of any that meets them: -MISSED (1 + shortfall).
# An unstable one misses more than any stable one: its shortfall is UNSTABLE and the rate at which it grows [1/s].
MISSED = 1e6
UNSTABLE = 100.0
STEADY = RESERVE["decay_rate"]  # decay rate from which a design counts as stable there, so that it surely is [1/s]
NEARLY_UNSTABLE = 1e-3  # margins below it are looked at closer [1/s], [-]
WORSE = 2e-6  # a condition is added to those looked at if the margin is lower there by so much, relative


@dataclass(frozen=True)
class Space:
    """Design space of a problem.

    Parameters
    ----------
    problem : Problem
        Its design variables span the space.
    pairs : int, optional
        So many pairs of roots, those of the least margins, are left out of the margin that is to be largest.
    floor : float, optional
        What the margin of all roots must reach [1/s], [-].
    anchors_given : tuple of mapping
        Values of the variables of designs that any search must know.
    known : tuple of tuple of Condition, optional
        The conditions that are looked at: those of the margin, and those of each demand. By default the corners of
        all ranges.
    demanding : bool, optional
        Whether requirements are looked at.
    near : float, optional
        Designs whose margin falls behind that of the best anchor by more than this share are not searched for: for a
        search that begins close to the best design.
    """

    problem: Problem
    pairs: int = 0
    floor: float = -np.inf
    anchors_given: tuple[Mapping[str, float], ...] = ()
    known: tuple[tuple[Condition, ...], ...] = ()
    demanding: bool = True
    near: float | None = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the variables, C_s last if it is one of them."""
        names = list(self.problem.design.variables)
        return tuple(sorted(names, key=lambda name: name == "C_s"))

    @cached_property
    def fixed(self) -> Values:
        """Return the parameters that stay, C_s among them if it is given."""
        p = self.problem.parameters()
        return {name: float(value) for name, value in p.items() if name not in self.names}

    @property
    def curve(self) -> Curve | None:
        """The curve of the problem."""
        return self.problem.curve

    @property
    def objective(self) -> str:
        """What is to be largest."""
        return self.problem.design.objective

    @cached_property
    def model(self) -> Model:
        """Which equations."""
        return Model.of(self.problem)

    @cached_property
    def condition_set(self) -> ConditionSet:
        """The conditions under which everything must hold."""
        return condition_set(self.problem)

    @cached_property
    def measure(self) -> Measure:
        """The margin that is to be largest, under one condition."""
        return Measure(self.objective, self.names, pairs=self.pairs, floor=self.floor)

    @cached_property
    def demands(self) -> tuple[Demand, ...]:
        """What every design must reach."""
        return demands(self.problem, self.model) if self.demanding else ()

    @cached_property
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions that are looked at."""
        return self.known[0] if self.known else self.condition_set.corners

    @cached_property
    def demanded(self) -> tuple[Demanded, ...]:
        """The demands under the conditions that are looked at."""
        known = self.known[1:] if len(self.known) > 1 else [demand.conditions.corners for demand in self.demands]
        return tuple(Demanded(demand, some) for demand, some in zip(self.demands, known, strict=True))

    @cached_property
    def loads(self) -> tuple[Condition, ...]:
        """The conditions that differ for the curve, through which every bogie runs at the curve's own speed."""
        return curving_conditions(self.condition_set)

    @cached_property
    def worst_margin(self) -> WorstMargin:
        """The margin that is to be largest."""
        return WorstMargin(self.conditions, self.measure)

    @cached_property
    def steady(self) -> WorstMargin:
        """The decay rate, whatever margin is to be largest."""
        return WorstMargin(self.conditions, Measure("decay_rate", self.names))

    def with_worst(self, x: Float) -> "Space | None":
        """Return the space that also looks at the conditions in which a design is worse than in those known.

        None if there are none by more than a share of `WORSE`, and none in which a requirement is missed that is met
        in those known: a search has found none.
        """
        values = {name: float(np.squeeze(value)) for name, value in self.values(x).items()}
        sets = ParameterSets(self.model, values, 1)
        looked = [(self.measure, self.condition_set, self.worst_margin.of(sets), self.conditions, np.inf)]
        looked += [
            (one.demand.measure, one.demand.conditions, one.worst_of(sets), one.conditions, one.demand.enough)
            for one in self.demanded
        ]
        known, more = [], False
        for measure, conditions, (least,), have, enough in looked:
            found = worst_conditions(self.model, values, conditions, measure) if conditions.ranges else ()
            limit = max(float(least) - WORSE * abs(float(least)), enough if least >= enough else -np.inf)
            new = [worst.condition for worst in found if worst.margin < limit and worst.condition not in have]
            known.append((*have, *new))
            more = more or bool(new)
        return replace(self, known=tuple(known)) if more else None

    def bounds(self, name: str) -> tuple[float, float]:
        """Return lower and upper bound of a variable in SI, as written."""
        variable = self.problem.design.variables[name]
        return float(variable.min), float(variable.max)

    def values(self, x: Float) -> Values:
        """Return all parameters and C_s at points of the unit cube, shape (variables, ...)."""
        return self._placed(x, dict(self.fixed))

    def _placed(self, x: Float, out: Values) -> Values:
        """Return other values with those of the variables in them."""
        for name, coordinate in zip(self.names, x, strict=True):
            out[name] = between(*self._ends(name, out), coordinate, scale(name))
        return out

    def coordinates(self, values: Mapping[str, float]) -> Float:
        """Return the point of the unit cube that belongs to given values, moved to its surface if outside."""
        known = {**self.fixed, **values}
        return np.array([fraction(*self._ends(name, known), float(values[name]), scale(name)) for name in self.names])

    def _ends(self, name: str, known: Values) -> tuple[Any, Any]:
        """Return the ends of a coordinate: the bounds, and for C_s what the curve allows with the other values."""
        low, high = self._bounds_with(name, known)
        if name == "C_s" and self.curve is not None:
            for load, p in zip(self.loads, self.in_curve(known), strict=True):
                high = np.minimum(high, curving_limit(p, self.curve) / load.damping_factor)
            return low, np.maximum(low, high)
        return low, high

    def _bounds_with(self, name: str, known: Values) -> tuple[Any, Any]:
        """Return the bounds of a variable where other values are known."""
        return self.bounds(name)

    def in_curve(self, values: Values) -> list[Values]:
        """Return the parameters with which the curve is passed, under each of the conditions that differ for it."""
        return [load.applied(values) for load in self.loads]

    @cached_property
    def gentlest(self) -> Float:
        """The point of the cube with the least rotational resistance; what has no part in it is in the middle."""
        return np.array([0.0 if name in RAISING else 1.0 if name in LOWERING else 0.5 for name in self.names])

    @cached_property
    def anchors(self) -> Float:
        """Points of the cube that any search must know: the gentlest, and the design as written if it lies inside."""
        points, p = [self.gentlest], {name: float(v) for name, v in self.problem.parameters().items()}
        if all(name in p and self.bounds(name)[0] <= p[name] <= self.bounds(name)[1] for name in self.names):
            points.append(self.coordinates(p))
        points += [self.coordinates(given) for given in self.anchors_given]
        return np.array(points).T

    def feasible(self, values: Values) -> Bools:
        """Return where the curve's limit is kept (within rounding)."""
        kept, curve = np.asarray(True), self.curve
        if curve is None:
            return kept
        for p in self.in_curve(values):
            allowed = curve.limit * resistance_scale(p, curve)
            kept = kept & (allowed * (1 + 1e-12) >= resisting_moment(p, p["C_s"], curve))
        return kept

    def beats(self, values: Values, level: Float | float) -> Bools:
        """Return where the merit of a design exceeds a level; a ratio below zero counts as zero.

        Parameters
        ----------
        values : mapping
            Parameters and C_s in SI units: numbers, or arrays of one shape (n,).
        level : number or array
            [1/s] or [-]; below -`MISSED` that of designs that miss a requirement. With requirements, a level from there
            to zero asks whether these are met, of stable designs and unstable ones.
        """
        sets, shape = self._sets(values)
        level = np.broadcast_to(np.asarray(level, dtype=float), sets.size)
        out = np.broadcast_to(self.feasible(values), shape).reshape(-1).copy()
        short = np.maximum(-(level + MISSED) / MISSED, 0.0) if self.demanded else np.zeros(sets.size)
        left = np.flatnonzero(out & (short == 0))
        out[left] = self.worst_margin.exceeds(sets.part(left), level[left])
        left = np.flatnonzero(out & (short > 0))
        out[left] = self.steady.exceeds(sets.part(left), STEADY - np.maximum(short[left] - UNSTABLE, 0.0))
        for one in self.demanded:
            left = np.flatnonzero(out & (short <= UNSTABLE))
            out[left] = one.met_within(sets.part(left), short[left])
        return out.reshape(shape)

    @cached_property
    def is_slow(self) -> bool:
        """Whether a requirement takes eigenvalues for a verdict."""
        return any(one.demand.measure.by_eigenvalues for one in self.demanded)

    def beats_at(self, x: Float, level: Float) -> Bools:
        """Return the same at points of the cube, shape (variables, points)."""
        return np.broadcast_to(self.beats(self.values(x), level), x.shape[1:])

    def margins(self, values: Values) -> Float:
        """Return the merits: margins, less than -`MISSED` where a requirement, or with one stability, is missed.

        Minus infinity where the curve's limit is exceeded. Parameters as in `beats`.
        """
        sets, shape = self._sets(values)
        merit = np.full(sets.size, np.nan)
        if self.demanded:
            short = np.clip(np.max([one.shortfall(sets) for one in self.demanded], axis=0), None, UNSTABLE)
            missed = np.flatnonzero(short > 0)
            growth = STEADY - self.steady.of(sets.part(missed))
            short[missed] = np.where(growth >= 0, UNSTABLE + growth, short[missed])
            merit = np.where(short > 0, -MISSED * (1 + short), np.nan)
        met = np.flatnonzero(np.isnan(merit))
        merit[met] = self.worst_margin.of(sets.part(met))
        if self.demanded and (low := met[merit[met] < NEARLY_UNSTABLE]).size:
            growth = STEADY - self.steady.of(sets.part(low))
            merit[low] = np.where(growth >= 0, -MISSED * (1 + UNSTABLE + growth), merit[low])
        return np.where(self.feasible(values), merit.reshape(shape), -np.inf)

    def meets(self, x: Float) -> bool:
        """Return whether a point of the cube meets the requirements under the conditions that are looked at."""
        sets, _ = self._sets(self.values(x))
        return all(one.shortfall(sets)[0] <= 0 for one in self.demanded)

    def under_each(self, values: Values) -> Float:
        """Return the margins under every condition, shape (conditions, n). Parameters as in `beats`."""
        return self.worst_margin.under_each(self._sets(values)[0])

    def _sets(self, values: Values) -> tuple[ParameterSets, tuple[int, ...]]:
        shape = np.broadcast_shapes(*map(np.shape, values.values()))
        return ParameterSets(self.model, values, int(np.prod(shape))), shape

    def margins_at(self, x: Float) -> Float:
        """Return the margins at points of the cube, shape (variables, points)."""
        return np.broadcast_to(self.margins(self.values(x)), x.shape[1:])


def scale(name: str) -> float:
    """Return the size [SI] below which a coordinate of the cube is linear in a parameter; above, it is geometric."""
    usual = PARAMETERS[name].usual
    return float(usual[0] or usual[1])


def between(low: Any, high: Any, x: Any, size: float) -> Any:
    """Return the point at fraction x between two bounds, linear below a size and geometric above it."""
    width = _width(low, high, size)
    return np.clip(low + (high - low) * (np.expm1(width * x) / np.expm1(width)), low, high)


def fraction(low: float, high: float, value: float, size: float) -> float:
    """Return the inverse of `between`, for a value outside the bounds that of the nearest."""
    if high <= low:
        return 0.0
    width, inside = _width(low, high, size), min(max(value, low), high)
    return min(float(np.log1p((inside - low) / (high - low) * np.expm1(width)) / width), 1.0)


def _width(low: Any, high: Any, size: float) -> Any:
    # Bounds nearer than this are a straight line; without a least width, the narrowest have the quotient 0/0.
    return np.maximum(np.log1p((high - low) / (low + size)), 1e-12)

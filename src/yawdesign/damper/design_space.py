"""The design space of a problem: its variables as a unit cube.

The curve's limit is built into the cube: the coordinate of C_s runs up to what the curve allows with the other
variables, so every point of the cube with ``C_su`` above the lower bound is feasible.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from yawdesign.damper.curving import LOWERING, RAISING, curving_limit, resistance_scale, resisting_moment
from yawdesign.damper.worst_margin import WorstMargin
from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem import PARAMETERS, Curve, Problem
from yawdesign.problem.conditions import Condition, conditions, distinct
from yawdesign.vehicle.vehicle import Model

Values = dict[str, Any]


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
    anchor : mapping, optional
        Values of the variables of a design that reaches it.
    """

    problem: Problem
    pairs: int = 0
    floor: float = -np.inf
    anchor: Mapping[str, float] | None = None

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
    def conditions(self) -> tuple[Condition, ...]:
        """The conditions under which everything must hold."""
        return conditions(self.problem)

    @cached_property
    def loads(self) -> tuple[Condition, ...]:
        """The conditions that differ for the curve, through which every bogie runs at the curve's own speed."""
        return distinct(self.conditions, {"v"})

    @cached_property
    def worst_margin(self) -> WorstMargin:
        """The margin that is to be largest."""
        return WorstMargin(self.conditions, self.objective, self.names, self.pairs, self.floor)

    def bounds(self, name: str) -> tuple[float, float]:
        """Return lower and upper bound of a variable in SI, as written."""
        variable = self.problem.design.variables[name]
        return float(variable.min), float(variable.max)

    def values(self, x: Float) -> Values:
        """Return all parameters and C_s at points of the unit cube, shape (variables, ...)."""
        out = dict(self.fixed)
        for name, coordinate in zip(self.names, x, strict=True):
            out[name] = between(*self._ends(name, out), coordinate, scale(name))
        return out

    def coordinates(self, values: Mapping[str, float]) -> Float:
        """Return the point of the unit cube that belongs to given values, moved to its surface if outside."""
        known = {**self.fixed, **values}
        places = [fraction(*self._ends(name, known), float(values[name]), scale(name)) for name in self.names]
        return np.asarray(np.clip(np.array(places), 0, 1))

    def _ends(self, name: str, known: Values) -> tuple[float, Any]:
        """Return the ends of a coordinate: the bounds, and for C_s what the curve allows with the other values."""
        low, high = self.bounds(name)
        if name == "C_s" and self.curve is not None:
            for load in self.loads:
                high = np.minimum(high, curving_limit(load.applied(known), self.curve))
            return low, np.maximum(low, high)
        return low, high

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
        if self.anchor is not None:
            points.append(self.coordinates(self.anchor))
        return np.array(points).T

    def feasible(self, values: Values) -> Bools:
        """Return where the curve's limit is kept (within rounding)."""
        kept, curve = np.asarray(True), self.curve
        if curve is None:
            return kept
        for p in (load.applied(values) for load in self.loads):
            allowed = curve.limit * resistance_scale(p, curve)
            kept = kept & (allowed * (1 + 1e-12) >= resisting_moment(p, p["C_s"], curve))
        return kept

    def beats(self, values: Values, level: Float | float) -> Bools:
        """Return where a design is feasible and its margin exceeds a level; a ratio below zero counts as zero.

        Parameters
        ----------
        values : mapping
            Parameters and C_s in SI units: numbers, or arrays of one shape (n,).
        level : number or array
            [1/s] or [-].
        """
        sets, shape = self._sets(values)
        exceeded = self.worst_margin.exceeds(sets, np.broadcast_to(np.asarray(level, dtype=float), sets.size))
        return exceeded.reshape(shape) & self.feasible(values)

    def margins(self, values: Values) -> Float:
        """Return the margins, minus infinity where the curve's limit is exceeded. Parameters as in `beats`."""
        sets, shape = self._sets(values)
        return np.where(self.feasible(values), self.worst_margin.of(sets).reshape(shape), -np.inf)

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
    return np.clip(low + (low + size) * np.expm1(_width(low, high, size) * x), low, high)


def fraction(low: float, high: float, value: float, size: float) -> float:
    """Return the inverse of `between`."""
    return float(_width(low, value, size) / _width(low, high, size)) if high > low else 0.0


def _width(low: Any, high: Any, size: float) -> Any:
    return np.log1p((high - low) / (low + size))

"""The design space of a problem: its variables as a unit cube, and the margins at its points.

The curve's limit is built into the cube: the coordinate of C_s runs up to what the curve allows with the other
variables, so every point of the cube with ``C_su`` above the lower bound is feasible.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.curving import LOWERING, RAISING, curving_limit, resistance_scale, resisting_moment
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.eigenvalues import MARGINS
from yawdesign.hunting.old import core_eigenvalues, fixed_factors
from yawdesign.hunting.routh import damped_more, decays_faster
from yawdesign.problem import PARAMETERS, Curve, Problem
from yawdesign.problem.conditions import Condition, conditions
from yawdesign.vehicle.old import characteristic

Values = dict[str, Any]

# The dampers that have joints, and the stiffnesses of these. Where a damper is so weak that its stroke's own root -K/c
# lies further out than this [1/s], its joint counts as rigid: it moves no other root by more than rounding does, and an
# eigenvalue that large would spoil all others. A damper without damping has no such root at all.
JOINTS: Mapping[str, str] = {"C_s": "K_ds", "C_m": "K_dm", "C_t": "K_dt"}
FASTEST = 1e10
JOINTED = frozenset(JOINTS)
LEAST = 1.0  # [N s/m]: what is as good as no damping where 0 cannot stand


@dataclass(frozen=True)
class Space:
    """Design space of a problem.

    Parameters
    ----------
    problem : Problem
        Its design variables span the space; its speeds are the conditions.
    """

    problem: Problem

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the variables, C_s last if it is one of them."""
        names = list(self.problem.design.variables)
        return tuple(sorted(names, key=lambda name: name == "C_s"))

    @cached_property
    def fixed(self) -> Values:
        """Return the parameters that stay, C_s among them if it is given."""
        p = self.problem.bogie.parameters()
        return {name: float(value) for name, value in p.items() if name not in self.names}

    @property
    def curve(self) -> Curve | None:
        """The curve of the problem."""
        return self.problem.curve

    @cached_property
    def cases(self) -> tuple[Condition, ...]:
        """The conditions over which a margin is the worst."""
        return conditions(self.problem)

    @cached_property
    def model(self) -> dict[str, str]:
        """The keywords that choose the equations."""
        return self.problem.model

    @cached_property
    def movable(self) -> tuple[str, ...]:
        """Names of the decoupled motions that some variable moves; they count in the margin."""
        p = {**self.problem.bogie.parameters(), "v": self.cases[0].speed}
        fixed = fixed_factors(p, self.names, **self.model)
        return tuple(name for name in characteristic(p, **self.model).factors if name not in fixed)

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
            return low, np.clip(curving_limit(known, self.curve), low, high)
        return low, high

    @cached_property
    def gentlest(self) -> Float:
        """The point of the cube with the least rotational resistance; what has no part in it is in the middle."""
        return np.array([0.0 if name in RAISING else 1.0 if name in LOWERING else 0.5 for name in self.names])

    @cached_property
    def anchors(self) -> Float:
        """Points of the cube that any search must know: the gentlest, and the design as written if it lies inside."""
        points, p = [self.gentlest], {name: float(v) for name, v in self.problem.bogie.parameters().items()}
        if all(name in p and self.bounds(name)[0] <= p[name] <= self.bounds(name)[1] for name in self.names):
            points.append(self.coordinates(p))
        return np.array(points).T

    def feasible(self, values: Values) -> NDArray[np.bool_]:
        """Return where the curve's limit is kept (within rounding)."""
        if self.curve is None:
            return np.asarray(True)
        T = resisting_moment(values, values["C_s"], self.curve)
        allowed = self.curve.limit * resistance_scale(values, self.curve)
        return np.asarray(allowed * (1 + 1e-12) >= T)

    def beats(self, values: Values, level: Float | float) -> NDArray[np.bool_]:
        """Return where the margin exceeds a level, by Routh's array in every condition; a ratio below zero as zero."""
        return np.asarray(_piecewise(self._beats, values, level) & self.feasible(values))

    def _beats(self, values: Values, level: Float | float) -> NDArray[np.bool_]:
        verdict = np.asarray(True)
        ratio = self.problem.design.objective == "damping_ratio"
        for case in self.cases:
            c = characteristic(case.applied(values), **self.model)
            for p in [c.core(values["C_s"]), *(c.factors[name] for name in self.movable)]:
                floor = np.maximum(level, 0) if ratio else level
                verdict = verdict & (damped_more(p, floor) if ratio else decays_faster(p, floor))
        return verdict

    def margins(self, values: Values) -> Float:
        """Return the margins from eigenvalues, minus infinity where the curve's limit is exceeded."""
        return np.where(self.feasible(values), _piecewise(self._margins, values), -np.inf)

    def _margins(self, values: Values) -> Float:
        measure = MARGINS[self.problem.design.objective]
        worst = np.asarray(np.inf)
        for case in self.cases:
            p = case.applied(values)
            worst = np.minimum(worst, measure(core_eigenvalues(p, values["C_s"], **self.model)))
            for factor in (characteristic(p, **self.model).factors[name] for name in self.movable):
                worst = np.minimum(worst, measure(quadratic_roots(factor)))
        return worst

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


def rigid_joints(values: Values) -> dict[str, NDArray[np.bool_]]:
    """Return, by the stiffness of each joint, where it counts as rigid beside its damper."""
    return {K: np.asarray(values[c] * FASTEST < values[K]) for c, K in JOINTS.items() if c in values}


def _piecewise(function: Callable[..., Any], values: Values, *more: Any) -> Any:
    """Return a function of values, some of them arrays, evaluated apart for each set of joints that count as rigid."""
    rigid = rigid_joints(values)
    pattern = np.asarray(sum(2**k * is_rigid for k, is_rigid in enumerate(rigid.values())))
    out = np.asarray(0.0)
    for code in np.unique(pattern):
        stiff = {K: np.inf for k, K in enumerate(rigid) if code >> k & 1}
        chosen = pattern == code
        if np.all(chosen):
            return function(values | stiff, *more)
        part = function(_picked(chosen, values) | stiff, *(_picked(chosen, x) for x in more))
        out = out if out.shape else np.zeros(pattern.shape, dtype=part.dtype)
        out[chosen] = part
    return out


def _picked(chosen: NDArray[np.bool_], value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _picked(chosen, each) for name, each in value.items()}
    return value[chosen] if np.shape(value) else value


def quadratic_roots(p: tuple[Any, ...]) -> NDArray[np.complex128]:
    """Return the two roots of quadratics, last axis."""
    c, b, a = (np.asarray(q, dtype=complex) for q in p)
    root = np.sqrt(b * b - 4 * a * c)
    return np.stack(np.broadcast_arrays((-b + root) / (2 * a), (-b - root) / (2 * a)), axis=-1)

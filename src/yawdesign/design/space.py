"""The design space of a problem: its variables as a unit cube, and the margins at its points.

The curve's limit is built into the cube: the coordinate of C_s runs up to what the curve allows with the other
variables, so every point of the cube with ``C_su`` above the lower bound is feasible.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.bogie.characteristic import characteristic
from yawdesign.design.conditions import Condition, conditions
from yawdesign.design.curving import curving_limit, resistance_scale, resisting_moment
from yawdesign.problem import Curve, Problem
from yawdesign.stability.modes import MARGINS, core_eigenvalues
from yawdesign.stability.routh import damped_more, decays_faster
from yawdesign.stability.verdict import fixed_factors

Float = NDArray[np.float64]
Values = dict[str, Any]

# A damper with joints and no damping at all has a state less: as variables these begin at next to nothing [N s/m].
JOINTED = frozenset({"C_s", "C_m", "C_t"})
LEAST = 1.0


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
        """Return lower and upper bound of a variable in SI."""
        variable = self.problem.design.variables[name]
        low = max(float(variable.min), LEAST) if name in JOINTED else float(variable.min)
        return low, max(low, float(variable.max))

    def values(self, x: Float) -> Values:
        """Return all parameters and C_s at points of the unit cube, shape (variables, ...)."""
        out = dict(self.fixed)
        for name, coordinate in zip(self.names, x, strict=True):
            low, high = self.bounds(name)
            if name == "C_s" and self.curve is not None:
                high = np.clip(curving_limit(out, self.curve), low, high)
            out[name] = between(low, high, coordinate)
        return out

    def coordinates(self, values: Mapping[str, float]) -> Float:
        """Return the point of the unit cube that belongs to given values, moved to its surface if outside."""
        out, known = [], {**self.fixed, **values}
        for name in self.names:
            low, high = self.bounds(name)
            if name == "C_s" and self.curve is not None:
                high = float(np.clip(curving_limit(known, self.curve), low, high))
            out.append(fraction(low, high, float(values[name])))
        return np.asarray(np.clip(np.array(out), 0, 1))

    def feasible(self, values: Values) -> NDArray[np.bool_]:
        """Return where the curve's limit is kept (within rounding)."""
        if self.curve is None:
            return np.asarray(True)
        T = resisting_moment(values, values["C_s"], self.curve)
        allowed = self.curve.limit * resistance_scale(values, self.curve)
        return np.asarray(allowed * (1 + 1e-12) >= T)

    def beats(self, values: Values, level: Float | float) -> NDArray[np.bool_]:
        """Return where the margin exceeds a level, by Routh's array in every condition; a ratio below zero as zero."""
        verdict = self.feasible(values)
        ratio = self.problem.design.objective == "damping_ratio"
        for case in self.cases:
            c = characteristic(case.applied(values), **self.model)
            for p in [c.core(values["C_s"]), *(c.factors[name] for name in self.movable)]:
                floor = np.maximum(level, 0) if ratio else level
                verdict = verdict & (damped_more(p, floor) if ratio else decays_faster(p, floor))
        return verdict

    def margins(self, values: Values) -> Float:
        """Return the margins from eigenvalues, minus infinity where the curve's limit is exceeded."""
        measure = MARGINS[self.problem.design.objective]
        worst = np.asarray(np.inf)
        for case in self.cases:
            p = case.applied(values)
            worst = np.minimum(worst, measure(core_eigenvalues(p, values["C_s"], **self.model)))
            for factor in (characteristic(p, **self.model).factors[name] for name in self.movable):
                worst = np.minimum(worst, measure(quadratic_roots(factor)))
        return np.where(self.feasible(values), worst, -np.inf)

    def margins_at(self, x: Float) -> Float:
        """Return the margins at points of the cube, shape (variables, points)."""
        return np.broadcast_to(self.margins(self.values(x)), x.shape[1:])


def between(low: Any, high: Any, x: Any) -> Any:
    """Return the point at fraction x between two bounds, geometrically if the lower one is positive."""
    if low > 0:
        return np.clip(low * (high / low) ** x, low, high)
    return low + (high - low) * x


def fraction(low: float, high: float, value: float) -> float:
    """Return the inverse of `between`."""
    if high <= low:
        return 0.0
    return float(np.log(value / low) / np.log(high / low)) if low > 0 else (value - low) / (high - low)


def quadratic_roots(p: tuple[Any, ...]) -> NDArray[np.complex128]:
    """Return the two roots of quadratics, last axis."""
    c, b, a = (np.asarray(q, dtype=complex) for q in p)
    root = np.sqrt(b * b - 4 * a * c)
    return np.stack(np.broadcast_arrays((-b + root) / (2 * a), (-b - root) / (2 * a)), axis=-1)

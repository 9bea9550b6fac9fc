"""The NLP of a vehicle whose polynomials are of high degree: models of its margins near a design, step by step.

Of degree 50, equal coefficients say too little in double precision, and roots as unknowns jump. So the margins of the
modes that matter are taken from the eigenvalues at a few designs nearby, as polynomials of second degree of the design;
IPOPT finds the largest least one of them within a trust region, which grows where the models hold and shrinks where
they do not. Where several modes tie, as they do at most optima, this converges as fast as Newton's method.
"""

from collections.abc import Mapping
from functools import cached_property
from itertools import combinations
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from yawdesign.damper.demands import Demand
from yawdesign.damper.design_space import MISSED, Space, Values
from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues
from yawdesign.hunting.many.measure import FASTEST, Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin
from yawdesign.problem.condition import Condition

OPTIONS: Mapping[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.max_iter": 60,
    "ipopt.tol": 1e-9,
    "ipopt.mu_init": 1e-3,
    "ipopt.bound_relax_factor": 0.0,
    "error_on_fail": False,
    "show_eval_warnings": False,
}
MODES = 12  # those with the least margins, which have a model
APART = (3e-5, 1e-3)  # least and most distance of the designs that a model is made of, in the cube
CONDITIONS = 10  # those of the least margins, of each margin that counts
MOST_STEPS = 40
RADIUS, LEAST_RADIUS = 0.03, 1e-8  # of the trust region, in the cube
MOST_CURVED = 8  # variables with which models are of second degree; with more, of first
HOLDS = 0.5  # part of the promised gain with which a model holds


class _Models(NamedTuple):
    """Margins m0 + slope dx + dx curvature dx / 2 of some modes around a design.

    Parameters
    ----------
    centre : array, shape (variables,)
        The design.
    margin : array, shape (modes,)
        There: [1/s] or [-].
    slope, curvature : array, shape (modes, variables), (modes, variables, variables)
        Derivatives to the coordinates of the cube.
    capped : array, shape (modes,)
        1 for those that need no more than their floor, 0 for others.
    floor : array, shape (modes,)
        What the capped ones need [1/s] or [-].
    """

    centre: Float
    margin: Float
    slope: Float
    curvature: Float
    capped: Float
    floor: Float


class _Rows(NamedTuple):
    """Margins of some modes at some points, shape (modes, points), which of them are capped, and their floors."""

    margin: Float
    capped: Float
    floor: Float


class LocalImprover:
    """IPOPT on models of the margins, from any start in a design space. Parameters as in `nlp.Improver`."""

    def __init__(self, space: Space, options: Mapping[str, Any]) -> None:
        self.space = space
        self.options = options
        self.modes = MODES * (2 if space.demands else 1)

    def improve(self, x: Float, margin: float) -> list[Float]:
        """Return the point that is reached from a point of the cube with a given margin; none if it is that one."""
        radius, best, value = RADIUS, x, margin
        for _ in range(MOST_STEPS):
            models = self._models(best, float(np.clip(radius / 10, *APART)), value)
            there, promised = self._solved(models, best, value, radius)
            found = float(np.squeeze(self.space.margins_at(there[:, None])))
            if found - value > HOLDS * (promised - value):
                radius *= 2
            else:
                radius /= 4
            if found > value:
                best, value = there, found
            if radius < LEAST_RADIUS:
                break
        return [best] if value > margin else []

    @cached_property
    def _solver(self) -> ca.Function:
        """The NLP: largest t of the models within the trust region; all of its numbers are parameters."""
        d, n = len(self.space.names), self.modes
        t, step = ca.SX.sym("t"), ca.SX.sym("step", d)
        margin, capped, floor = (ca.SX.sym(name, n) for name in ("margin", "capped", "floor"))
        slope, curvature = ca.SX.sym("slope", n, d), [ca.SX.sym(f"curvature_{k}", d, d) for k in range(n)]
        curved = ca.vertcat(*(ca.bilin(each, step, step) / 2 for each in curvature))
        least = margin + slope @ step + curved - capped * floor - (1 - capped) * t
        numbers = ca.vertcat(margin, capped, floor, ca.vec(slope), *(ca.vec(each) for each in curvature))
        nlp = {"x": ca.vertcat(t, step), "p": numbers, "f": -t, "g": least}
        return ca.nlpsol("models", "ipopt", nlp, {**OPTIONS, **self.options})

    def _solved(self, models: _Models, x: Float, margin: float, radius: float) -> tuple[Float, float]:
        """Return the best point of the models within a radius around a point, and the margin that they promise."""
        size = max(abs(margin), 1e-3)  # the NLP's unit of margins; that of its steps is the radius
        numbers = [(models.margin - margin) / size, models.capped, (models.floor - margin) / size]
        numbers += [(models.slope * radius / size).ravel(order="F")]
        numbers += [(each * radius**2 / size).ravel(order="F") for each in models.curvature]
        offset = (x - models.centre) / radius  # of the point from where the models were made
        low, high = np.maximum(-1, -x / radius) + offset, np.minimum(1, (1 - x) / radius) + offset
        found = self._solver(
            x0=np.concatenate([[0.0], np.clip(offset, low, high)]),
            p=np.concatenate(numbers),
            lbx=np.concatenate([[-np.inf], low]),
            ubx=np.concatenate([[np.inf], high]),
            lbg=0.0,
            ubg=np.inf,
        )
        t, step = np.split(np.array(found["x"]).ravel(), [1])
        if not np.all(np.isfinite(step)):
            return x, margin
        return np.clip(models.centre + radius * step, 0, 1), margin + size * float(t[0])

    def _models(self, x: Float, apart: float, merit: float) -> _Models:
        """Return the models around a point of the cube of a given merit, from points that are so far apart."""
        d = len(x)
        centre = np.clip(x, apart, 1 - apart)
        pairs = [*combinations(range(d), 2)] if d <= MOST_CURVED else []
        unit = np.eye(d) * apart
        steps = [np.zeros(d), *unit, *(-unit), *(a for i, j in pairs for a in (unit[i] + unit[j], -unit[i] - unit[j]))]
        rows = self._rows(centre[:, None] + np.array(steps).T, merit)
        margins = rows.margin
        here, up, down = margins[:, 0], margins[:, 1 : 1 + d], margins[:, 1 + d : 1 + 2 * d]
        slope, curvature = (up - down) / (2 * apart), np.zeros((self.modes, d, d))
        if d <= MOST_CURVED:
            second = up + down - 2 * here[:, None]
            curvature[:, range(d), range(d)] = second / apart**2
            for (i, j), both in zip(pairs, np.split(margins[:, 1 + 2 * d :], max(len(pairs), 1), axis=1), strict=False):
                mixed = (both.sum(axis=1) - 2 * here - second[:, i] - second[:, j]) / (2 * apart**2)
                curvature[:, i, j] = curvature[:, j, i] = mixed
        return _Models(centre, here, slope, curvature, rows.capped, rows.floor)

    def _rows(self, x: Float, merit: float) -> _Rows:
        """Return the margins of the modes that matter at the first of some points, those of capped modes first."""
        values, missed = self.space.values(x), merit < -MISSED
        near = {name: float(np.ravel(value)[0]) for name, value in values.items()}
        parts: list[_Rows] = []
        if not missed:
            parts = [self._of_objective(values, condition) for condition in self._worst(near, self.space.worst_margin)]
        parts += [
            self._of_demand(values, one.demand, condition, merit, missed)
            for one in self.space.demanded
            for condition in self._worst(near, one.worst_margin)
        ]
        rows = _Rows(*(np.concatenate(column) for column in zip(*parts, strict=True)))
        level = np.where(rows.capped > 0, rows.floor, merit)
        least = np.argsort(rows.margin[:, 0] - level, kind="stable")
        least = np.resize(least[: self.modes], self.modes)  # of fewer modes some twice
        return _Rows(*(column[least] for column in rows))

    def _worst(self, values: Values, looked_at: WorstMargin) -> list[Condition]:
        """Return the conditions of the least margins of a design."""
        if len(looked_at.conditions) <= CONDITIONS:
            return list(looked_at.conditions)
        each = looked_at.under_each(ParameterSets(self.space.model, values, 1))[:, 0]
        return [looked_at.conditions[k] for k in np.argsort(each, kind="stable")[:CONDITIONS]]

    def _of_objective(self, values: Values, condition: Condition) -> _Rows:
        """Return the margins that are to be large under a condition; with pairs the first ones are capped."""
        margin = self._of_modes(values, condition, self.space.measure)
        capped = (np.arange(len(margin)) < self.space.pairs).astype(float)
        return _Rows(margin, capped, np.full(len(margin), self.space.floor if self.space.pairs else 0.0))

    def _of_demand(self, values: Values, demand: Demand, condition: Condition, merit: float, missed: bool) -> _Rows:
        """Return the margins of a requirement under a condition, in the unit of the merit.

        Where requirements are missed they are what is to be large; otherwise they need no more than their level.
        """
        spare = (self._of_modes(values, condition, demand.measure) - demand.level) / demand.scale
        if missed:
            return _Rows(-MISSED * (1 - spare), np.zeros(len(spare)), np.zeros(len(spare)))
        return _Rows(merit + max(abs(merit), 1e-3) * spare, np.ones(len(spare)), np.full(len(spare), merit))

    def _of_modes(self, values: Values, condition: Condition, measure: Measure) -> Float:
        """Return the least margins of the first point at all points, the least first, shape (modes, points)."""
        vehicle = self.space.model.at(condition.applied(values))
        vehicle = vehicle.with_fault(measure.case) if measure.case else vehicle
        joints, p = vehicle.model.joints.items(), vehicle.p
        stiff = {K: np.inf for c, K in joints if np.any(np.asarray(p[c]) * FASTEST < p[K])}
        vehicle = vehicle.replace(**stiff) if stiff else vehicle
        movable = vehicle.model.movable(measure.variables)
        chosen = [motion for motion in vehicle.model.motions if motion.name in movable]
        every = [np.atleast_2d(motion_eigenvalues(vehicle, motion)) for motion in chosen]
        points = max(len(s) for s in every)  # a motion that no variable moves is the same at all of them
        own = np.concatenate([_followed(np.broadcast_to(s, (points, s.shape[1])), measure.objective) for s in every])
        return own[np.argsort(own[:, 0], kind="stable")][: self.modes]


def _followed(s: Complex, objective: str) -> Float:
    """Return the margins of all modes of the first point at all points, shape (modes, points)."""
    modes = s[0][s[0].imag >= 0]
    near = np.argmin(np.abs(s[None, :, :] - modes[:, None, None]), axis=2)
    return np.asarray(MARGINS[objective](np.take_along_axis(s, near.T, axis=1).T[..., None]))

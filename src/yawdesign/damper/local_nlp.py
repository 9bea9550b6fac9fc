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

from yawdesign.damper.design_space import Space
from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues

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
        1 for those that need no more than the floor, 0 for others.
    """

    centre: Float
    margin: Float
    slope: Float
    curvature: Float
    capped: Float


class LocalImprover:
    """IPOPT on models of the margins, from any start in a design space. Parameters as in `nlp.Improver`."""

    def __init__(self, space: Space, options: Mapping[str, Any]) -> None:
        self.space = space
        self.options = options

    def improve(self, x: Float, margin: float) -> list[Float]:
        """Return the point that is reached from a point of the cube with a given margin; none if it is that one."""
        radius, best, value = RADIUS, x, margin
        for _ in range(MOST_STEPS):
            models = self._models(best, float(np.clip(radius / 10, *APART)))
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
        d = len(self.space.names)
        t, step = ca.SX.sym("t"), ca.SX.sym("step", d)
        margin, capped, floor = ca.SX.sym("margin", MODES), ca.SX.sym("capped", MODES), ca.SX.sym("floor")
        slope, curvature = ca.SX.sym("slope", MODES, d), [ca.SX.sym(f"curvature_{k}", d, d) for k in range(MODES)]
        curved = ca.vertcat(*(ca.bilin(each, step, step) / 2 for each in curvature))
        least = margin + slope @ step + curved - capped * floor - (1 - capped) * t
        numbers = ca.vertcat(margin, capped, floor, ca.vec(slope), *(ca.vec(each) for each in curvature))
        nlp = {"x": ca.vertcat(t, step), "p": numbers, "f": -t, "g": least}
        return ca.nlpsol("models", "ipopt", nlp, {**OPTIONS, **self.options})

    def _solved(self, models: _Models, x: Float, margin: float, radius: float) -> tuple[Float, float]:
        """Return the best point of the models within a radius around a point, and the margin that they promise."""
        size = max(abs(margin), 1e-3)  # the NLP's unit of margins; that of its steps is the radius
        floor = (self.space.floor - margin) / size if self.space.pairs else 0.0
        numbers = [(models.margin - margin) / size, models.capped, np.array([floor])]
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

    def _models(self, x: Float, apart: float) -> _Models:
        """Return the models around a point of the cube, from points that are so far apart."""
        d = len(x)
        centre = np.clip(x, apart, 1 - apart)
        pairs = [*combinations(range(d), 2)] if d <= MOST_CURVED else []
        unit = np.eye(d) * apart
        steps = [np.zeros(d), *unit, *(-unit), *(a for i, j in pairs for a in (unit[i] + unit[j], -unit[i] - unit[j]))]
        margins, capped = self._margins(centre[:, None] + np.array(steps).T)
        here, up, down = margins[:, 0], margins[:, 1 : 1 + d], margins[:, 1 + d : 1 + 2 * d]
        slope, curvature = (up - down) / (2 * apart), np.zeros((MODES, d, d))
        if d <= MOST_CURVED:
            second = up + down - 2 * here[:, None]
            curvature[:, range(d), range(d)] = second / apart**2
            for (i, j), both in zip(pairs, np.split(margins[:, 1 + 2 * d :], max(len(pairs), 1), axis=1), strict=False):
                mixed = (both.sum(axis=1) - 2 * here - second[:, i] - second[:, j]) / (2 * apart**2)
                curvature[:, i, j] = curvature[:, j, i] = mixed
        return _Models(centre, here, slope, curvature, capped)

    def _margins(self, x: Float) -> tuple[Float, Float]:
        """Return the margins of the modes that matter at the first of some points, shape (modes, points).

        Also which of them are capped.
        """
        found: list[tuple[Float, Float]] = []
        for condition in self.space.conditions:
            vehicle = self.space.model.at(condition.applied(self.space.values(x)))
            movable = self.space.model.movable(self.space.names)
            chosen = [motion for motion in self.space.model.motions if motion.name in movable]
            own = np.concatenate([self._of_modes(motion_eigenvalues(vehicle, motion)) for motion in chosen])
            own = own[np.argsort(own[:, 0], kind="stable")][:MODES]
            found.append((own, (np.arange(len(own)) < self.space.pairs).astype(float)))
        margins, capped = (np.concatenate(parts) for parts in zip(*found, strict=True))
        least = np.argsort(np.where(capped > 0, -np.inf, margins[:, 0]), kind="stable")
        least = np.resize(least[:MODES], MODES)  # of fewer modes some twice
        return margins[least], capped[least]

    def _of_modes(self, s: Complex) -> Float:
        """Return the margins of all modes of the first point at all points, shape (modes, points)."""
        s = np.atleast_2d(s)
        modes = s[0][s[0].imag >= 0]
        near = np.argmin(np.abs(s[None, :, :] - modes[:, None, None]), axis=2)
        return np.asarray(MARGINS[self.space.objective](np.take_along_axis(s, near.T, axis=1).T[..., None]))

"""The least rotational resistance with which a design leaves a given margin and meets the requirements."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from yawdesign.damper.curving import rotational_resistance
from yawdesign.damper.design_space import Space, Values
from yawdesign.damper.search import search
from yawdesign.damper.stencils import refine
from yawdesign.hunting.arrays import Bools, Float
from yawdesign.problem.arguments import Progress
from yawdesign.problem.progress import rounds

MOST_ROUNDS = 10  # in which conditions are added
KEPT = 6  # points that are refined to the end


@dataclass(frozen=True)
class LeastResistance(Space):
    """A design space whose merit is minus the rotational resistance; minus infinity where the margin is too small.

    Parameters
    ----------
    level : float, optional
        What the margin must exceed [1/s], [-].
    """

    level: float = 0.0

    def beats(self, values: Values, level: Float | float) -> Bools:
        """Return where the merit exceeds a level. Parameters as in `Space.beats`."""
        merit = -resistances(self, values)
        shape = np.broadcast_shapes(*map(np.shape, values.values()))
        out = np.broadcast_to(merit > level, shape).copy()
        some = {name: np.broadcast_to(value, shape)[out] if np.ndim(value) else value for name, value in values.items()}
        if out.any():
            out[out] = super().beats(some, self.level)
        return out

    def margins(self, values: Values) -> Float:
        """Return the merits. Parameter as in `beats`."""
        enough = super().beats(values, self.level)
        return np.where(enough, -resistances(self, values), -np.inf)

    def gentlest_design(self, seed: int, progress: Progress) -> tuple[Self, Float] | None:
        """Return the point of the cube with the largest merit, and the space with all conditions that decide it.

        None if no design that was found leaves the margin and meets the requirements.

        Parameters
        ----------
        seed : int
            Of the search points.
        progress : callable
            Called with a text and the share that is done.
        """
        space = self
        for _, told in zip(range(MOST_ROUNDS), rounds(progress), strict=False):
            found = search(space, seed, told)
            if not found.shape[1]:
                return None
            x = space.polished(found[:, :KEPT], seed)
            more = space.with_worst(x)
            if not isinstance(more, type(self)):
                break
            space = more
        return space, x

    def polished(self, x: Float, seed: int) -> Float:
        """Return the best point near some points of the cube, shape (variables,)."""
        rng = np.random.default_rng(seed)
        for radius in (1e-2, 1e-4):  # the first comes to a halt at a ridge
            x = refine(self, x, self.margins_at(x), rng, radius=radius, until=1e-9)
        return x[:, 0]


def resistances(space: Space, values: Values) -> Float:
    """Return the largest T / (4 Q a) [-] of designs under all conditions; the space has a curve.

    Parameters
    ----------
    space : Space
        With the conditions and the curve.
    values : mapping
        Parameters and C_s in SI units: numbers, or arrays of one shape (n,).
    """
    assert space.curve is not None
    loads = [load.applied(values) for load in space.loads]
    return np.asarray(np.max([rotational_resistance(p, p["C_s"], space.curve) for p in loads], axis=0))

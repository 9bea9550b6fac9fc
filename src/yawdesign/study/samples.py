"""Samples of uncertain parameters: points of a unit cube, and the values that their distributions make of them.

Scrambled Sobol points fill the cube evenly: a share of them is more accurate than one of independent random points.
Each replicate is scrambled anew, and the scatter of the replicates tells the error; a formula for independent samples
would not.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri, stdtrit
from scipy.stats import qmc

from yawdesign.hunting.arrays import Float
from yawdesign.problem.condition import applied
from yawdesign.problem.distributions import CUT, Distribution

REPLICATES = 16
TOGETHER = 2**16  # points that are drawn at a time: memory does not grow with the number of samples
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Draw:
    """How the points of one replicate are drawn.

    Parameters
    ----------
    dimension : int
        Number of coordinates.
    size : int
        Number of points, a power of two.
    seed : tuple of int
        What the random numbers start from.
    independent : bool
        Whether the points are independent, instead of those of a scrambled Sobol sequence.
    """

    dimension: int
    size: int
    seed: tuple[int, ...]
    independent: bool = False

    def parts(self) -> Iterator[Float]:
        """Yield all points, some at a time; every coordinate lies between 0 and 1, and is neither."""
        rng = np.random.default_rng(self.seed)
        sequence = None if self.independent else qmc.Sobol(self.dimension, rng=rng)
        for start in range(0, self.size, TOGETHER):
            n = min(TOGETHER, self.size - start)
            u = sequence.random(n) if sequence else rng.random((n, self.dimension))
            yield np.clip(u, 2.0**-32, 1 - 2.0**-32)  # half of the spacing of a sequence


@dataclass(frozen=True)
class Uncertain:
    """Parameters of a vehicle, some of which have a distribution.

    Parameters
    ----------
    parameters : mapping
        Values as designed, ``C_s`` and maybe ``v`` among them [SI].
    distributions : tuple of Distribution
        Of some of them, or of ``creep_factor``.
    """

    parameters: Mapping[str, float]
    distributions: tuple[Distribution, ...]

    def designed(self, one: Distribution) -> float:
        """Return the value as designed; 1 of the creep factor."""
        return float(self.parameters.get(one.key, 1.0))

    @property
    def can_be_widened(self) -> bool:
        """Whether there is a normal or a lognormal distribution."""
        return any(one.kind != "uniform" for one in self.distributions)

    def at(self, u: Float, widened: float = 1.0) -> dict[str, Any]:
        """Return the parameters at points of the unit cube.

        Parameters
        ----------
        u : array, shape (n, distributions)
            The points.
        widened : float
            Factor of the standard deviation of the normal, and of the logarithm of the lognormal ones.
        """
        values = {one.key: self._values(one, u[:, k], widened) for k, one in enumerate(self.distributions)}
        return applied(self.parameters, values.items())

    def _values(self, one: Distribution, u: Float, widened: float) -> Float:
        designed = self.designed(one)
        if one.kind == "uniform":
            low, high = one.ends(designed)
            return low + (high - low) * u
        z = scores(u, widened)
        if one.kind == "normal":
            return designed * (1 + one.numbers[0].value * z)
        s = one.log_deviation
        return np.asarray(designed * np.exp(s * z - s * s / 2))

    def weights(self, u: Float, widened: float) -> Float:
        """Return how much likelier points are than where they were drawn with widened distributions, shape (n,)."""
        own = [k for k, one in enumerate(self.distributions) if one.kind != "uniform"]
        z = scores(u[:, own], widened)
        whole = widened * (1 - 2 * ndtr(-CUT / widened)) / (1 - 2 * ndtr(-CUT))
        return np.asarray(np.prod(whole * np.exp(-(z * z) / 2 * (1 - widened**-2)), axis=1))


def scores(u: Float, widened: float = 1.0) -> Float:
    """Return values of a normal distribution about 0 that ends at five standard deviations of 1, widened or not."""
    tail = ndtr(-CUT / widened)
    return np.asarray(widened * ndtri(tail + (1 - 2 * tail) * u))


@dataclass(frozen=True)
class Estimate:
    """A mean of replicates, with its 95 % interval by Student's t.

    Parameters
    ----------
    value : float
        The mean.
    half_width : float
        Of the interval.
    """

    value: float
    half_width: float

    @classmethod
    def of(cls, replicates: Any) -> "Estimate":
        """Return the estimate from one value of each replicate."""
        x = np.asarray(replicates, dtype=float)
        t = float(stdtrit(len(x) - 1, (1 + CONFIDENCE) / 2))
        return cls(float(x.mean()), t * float(x.std(ddof=1)) / len(x) ** 0.5)


@dataclass(frozen=True)
class Indices:
    """Sobol indices of a function, by replicates: arrays of shape (inputs,).

    Parameters
    ----------
    first, total : array
        Share of the variance that an input has alone, and together with others.
    """

    first: Float
    total: Float


def sobol_indices(function: Callable[[Float], Float], dimension: int, size: int, seed: tuple[int, ...]) -> Indices:
    """Return the Sobol indices of a function on the unit cube from one replicate, by Saltelli's and Jansen's sums.

    Parameters
    ----------
    function : callable
        Takes points, shape (n, dimension), and returns one value each.
    dimension, size, seed
        Number of inputs; points, a power of two, of which ``size (dimension + 2)`` are evaluated; see `Draw`.
    """
    (both,) = Draw(2 * dimension, size, seed).parts()
    a, b = both[:, :dimension], both[:, dimension:]
    points = [a, b]
    for k in range(dimension):
        points.append(a.copy())
        points[-1][:, k] = b[:, k]
    of_a, of_b, *mixed = np.split(function(np.concatenate(points)), dimension + 2)
    both_sides = np.concatenate([of_a, of_b])
    variance, mean = both_sides.var(), both_sides.mean()
    with np.errstate(all="ignore"):
        first = np.array([np.mean((of_b - mean) * (x - of_a)) for x in mixed]) / variance
        total = np.array([np.mean((of_a - x) ** 2) for x in mixed]) / (2 * variance)
    return Indices(first, total)

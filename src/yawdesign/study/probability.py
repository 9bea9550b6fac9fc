"""The probability that an uncertain vehicle is unstable, and what the samples cannot tell of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import betaincinv

from yawdesign.hunting.arrays import Array
from yawdesign.study.replicates import Counted, UncertainVehicle, Workers
from yawdesign.study.samples import CONFIDENCE, REPLICATES, Draw, Estimate

LEAST_FAILURES = 50  # with fewer there is no answer from plain samples
WIDENED = 1.6  # standard deviations, to find rare failures


@dataclass(frozen=True)
class Probability:
    """A probability and how it was found.

    Parameters
    ----------
    value : float or None
        The probability, if the samples can tell it.
    interval : tuple of (low, high)
        In which it lies with 95 %.
    samples, failures, unverified : int
        How many samples there were, how many of them were unstable, and how many have no verified verdict.
    status : str
        ``estimated``, ``rare`` (by importance sampling) or ``too few failures``.
    method : str
        How it was found, in words.
    """

    value: float | None
    interval: tuple[float, float]
    samples: int
    failures: int
    unverified: int
    status: str
    method: str


def probability_unstable(workers: Workers, vehicle: UncertainVehicle, samples: int, seed: int) -> Probability:
    """Return the probability of instability.

    Parameters
    ----------
    workers : Workers
        Who computes.
    vehicle : UncertainVehicle
        Whose.
    samples : int
        `REPLICATES` times a power of two.
    seed : int
        Of the samples.
    """
    plain = _counted(workers.within(0.0, 0.5), "samples", vehicle, draws(vehicle, samples, seed))
    failures = sum(x.unstable for x in plain)
    if LEAST_FAILURES <= failures <= samples - LEAST_FAILURES:
        text = f"{REPLICATES} replicates of {samples // REPLICATES} scrambled Sobol points, interval by Student's t"
        return _estimated(plain, "estimated", f"{text} from the scatter of the replicates")
    if failures < LEAST_FAILURES and vehicle.uncertain.can_be_widened:
        wide = _counted(
            workers.within(0.5, 0.75), "rare failures", vehicle, draws(vehicle, samples, seed, kind=1), WIDENED
        )
        weight, squared = sum(x.weight for x in wide), sum(x.squared for x in wide)
        found = _estimated(wide, "rare", _of_widened(samples))
        if squared and weight**2 / squared >= LEAST_FAILURES and found.interval[0] > 0:
            return found
    independent = draws(vehicle, samples, seed, kind=2, independent=True)
    return _bounded(_counted(workers.within(0.75, 1.0), "independent samples", vehicle, independent), failures)


def draws(
    vehicle: UncertainVehicle, samples: int, seed: int, *, kind: int = 0, independent: bool = False
) -> list[Draw]:
    """Return how the samples of all replicates are drawn."""
    d = len(vehicle.uncertain.distributions)
    return [Draw(d, samples // REPLICATES, (seed, kind, k), independent) for k in range(REPLICATES)]


def _counted(
    workers: Workers, text: str, vehicle: UncertainVehicle, draws: Sequence[Draw], widened: float = 1.0
) -> list[Counted]:
    found: list[Counted] = workers.all(text, vehicle.counted, [(draw, widened) for draw in draws])
    return found


def _of_widened(samples: int) -> str:
    return (
        f"too few failures in {samples} plain samples; importance sampling: standard deviations of normal and "
        f"lognormal distributions times {WIDENED:g}, {REPLICATES} replicates of {samples // REPLICATES} "
        "scrambled Sobol points, interval by Student's t from the scatter of the replicates"
    )


def _estimated(counted: Sequence[Counted], status: str, method: str) -> Probability:
    """Return the estimate of replicates; samples without a verdict widen the interval upwards."""
    found = Estimate.of([x.weight / x.size for x in counted])
    samples, unverified = sum(x.size for x in counted), sum(x.unverified for x in counted)
    low = max(0.0, found.value - found.half_width)
    high = min(1.0, found.value + found.half_width + unverified / samples)
    failures = sum(x.unstable for x in counted)
    return Probability(found.value, (low, high), samples, failures, unverified, status, method)


def _bounded(counted: Sequence[Counted], failures: int) -> Probability:
    """Return between which bounds independent samples see the probability, by the binomial distribution."""
    n, unverified = sum(x.size for x in counted), sum(x.unverified for x in counted)
    k, tail = sum(x.unstable for x in counted), (1 - CONFIDENCE) / 2
    low = float(betaincinv(k, n - k + 1, tail)) if k else 0.0
    worst = k + unverified
    high = float(betaincinv(worst + 1, n - worst, 1 - tail)) if worst < n else 1.0
    rare = failures < n // 2
    text = f"{failures} of {n} scrambled Sobol points are unstable" if rare else f"{n - failures} of {n} are stable"
    text += f": fewer than {LEAST_FAILURES} tell no probability; bounds by {n} independent samples (binomial)"
    return Probability(None, (low, high), n, failures, unverified, "too few failures", text)


def percentiles(values: Array, levels: Sequence[float]) -> tuple[float | None, ...]:
    """Return percentiles of values; what does not exist, NaN, counts as larger than all others and is None."""
    x = np.sort(np.asarray(values, dtype=float))  # NaN comes last
    found = x[np.minimum((np.asarray(levels) / 100 * len(x)).astype(int), len(x) - 1)]
    return tuple(None if np.isnan(y) else float(y) for y in found)

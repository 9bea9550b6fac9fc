"""The decision of the forward design, on arrays: stable intervals, golden section, and what kind of answer that is.

One design is an array of length one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Bools, Float

GOLDEN = 0.382

Crossings = tuple[Float, Float]


@dataclass(frozen=True)
class Decision:
    """What the forward design decides for each of n vehicles; NaN where there is nothing to choose.

    Parameters
    ----------
    low, high : array, shape (n, m)
        Ends of the intervals of C_s between all critical values [N s/m], in rising order; high is infinite in the last.
    stable : array of bool, shape (n, m)
        Which of them are stable under every condition.
    C_sl, C_s : array, shape (n,)
        Lower end of the interval the design lies in, or else of the lowest stable one, and the design [N s/m].
    status : array of str, shape (n,)
        What kind of answer this is: the word of a `Status`.
    """

    low: Float
    high: Float
    stable: Bools
    C_sl: Float
    C_s: Float
    status: NDArray[np.str_]

    def stable_intervals(self, k: int) -> tuple[tuple[float, float], ...]:
        """Return the open intervals of C_s in which a vehicle is stable under every condition [N s/m]."""
        stable = self.stable[k] & (self.low[k] < self.high[k])
        return tuple(zip(self.low[k][stable].tolist(), self.high[k][stable].tolist(), strict=True))


def decide(crossings: Sequence[Crossings], upper: Float, others_stable: Bools) -> Decision:
    """Return the forward design between the critical values of n vehicles.

    The longest part below the curve's limit of an interval that is stable under every condition is chosen, and in it
    the golden section 0.382.

    Parameters
    ----------
    crossings : sequence of (array, shape (n, m), array, shape (n, m + 1))
        For each condition the critical values in rising order [N s/m], filled up with NaN, and the number of unstable
        roots in the intervals between them.
    upper : array, shape (n,)
        What the curve allows [N s/m], infinite without a curve.
    others_stable : array of bool, shape (n,)
        Whether the motions that no yaw damper reaches are stable.
    """
    low, high, stable = _common(crossings)
    stable &= others_stable[:, None]
    top = np.minimum(high, upper[:, None])
    width = np.where(stable & (top > low), top - low, -np.inf)
    best = np.argmax(width, axis=1)[:, None]
    some = np.take_along_axis(width, best, axis=1)[:, 0] > 0
    start, end = (np.take_along_axis(x, best, axis=1)[:, 0] for x in (low, top))
    lowest = np.min(np.where(stable, low, np.inf), axis=1)
    any_stable = stable.any(axis=1)
    C_sl = np.where(some, start, np.where(any_stable, lowest, np.nan))
    with np.errstate(invalid="ignore"):
        C_s = np.where(some & np.isfinite(end), GOLDEN * end + (1 - GOLDEN) * start, np.nan)
    everywhere = (stable & (low == 0) & np.isinf(high)).any(axis=1)
    parts = np.sum(width > 0, axis=1)
    cases = {  # the first that applies
        Status.UNDAMPED: ~others_stable,
        Status.STABLE_FOR_NONE: ~any_stable,
        Status.INFEASIBLE_IN_CURVE: upper <= 0,
        Status.INFEASIBLE: ~some,
        Status.PARTLY_UNSTABLE: (end < upper) | (parts > 1),
        Status.NO_UPPER_LIMIT: np.isinf(end),
        Status.STABLE_FOR_EVERY: everywhere,
    }
    return Decision(low, high, stable, C_sl, C_s, np.select([*cases.values()], [*cases], Status.OK))


def _common(crossings: Sequence[Crossings]) -> tuple[Float, Float, Bools]:
    """Return the ends of the intervals between the critical values of all conditions, and whether each is stable."""
    values = np.sort(np.concatenate([critical for critical, _ in crossings], axis=1), axis=1)
    n = len(values)
    low = np.concatenate([np.zeros((n, 1)), values], axis=1)
    high = np.concatenate([np.where(np.isnan(values), np.inf, values), np.full((n, 1), np.inf)], axis=1)
    inside = np.where(np.isinf(high), np.where(low > 0, 2 * low, 1.0), (low + high) / 2)
    stable = ~np.isnan(low)
    for critical, unstable_roots in crossings:
        with np.errstate(invalid="ignore"):
            place = np.sum(critical[:, None, :] < inside[:, :, None], axis=2)
        # Without critical values below, every interval has the count of the first one.
        stable &= np.take_along_axis(unstable_roots, place, axis=1) == 0
    return low, high, stable


def together(critical: Float, unstable_roots: Float) -> Crossings:
    """Return where one vehicle is stable under many conditions, as the critical values of a single one.

    Parameters
    ----------
    critical : array, shape (n, m)
        Its critical values under each condition, in rising order [N s/m], filled up with NaN.
    unstable_roots : array, shape (n, m + 1)
        Number of unstable roots in the intervals between them, filled up with NaN.
    """
    n = len(critical)
    unstable = np.nan_to_num(unstable_roots) > 0
    low = np.concatenate([np.zeros((n, 1)), critical], axis=1)[unstable]
    high = np.concatenate([np.where(np.isnan(critical), np.inf, critical), np.full((n, 1), np.inf)], axis=1)[unstable]
    order = np.argsort(low, kind="stable")
    low, reached = low[order], np.maximum.accumulate(high[order])
    # Between what the lower ones reach and the next one nothing is unstable.
    starts, ends = np.concatenate([[0.0], reached]), np.concatenate([low, [np.inf]])
    gap = ends > starts
    values = np.stack([starts[gap], ends[gap]], axis=1).ravel()
    values = values[(values > 0) & np.isfinite(values)]
    counts = (np.arange(len(values) + 1.0) + (0 if gap[0] else 1)) % 2
    return values[None], counts[None]

"""The forward design of many points at once: `yawdesign.damper.forward`, on arrays."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.forward import GOLDEN, UNDAMPED
from yawdesign.hunting.arrays import Bools, Float
from yawdesign.hunting.many.critical_values import CriticalField


@dataclass(frozen=True)
class Choice:
    """What the forward design chooses at every point; NaN where there is nothing to choose."""

    C_sl: Float
    C_s: Float
    status: NDArray[np.str_]


def choose(fields: Sequence[CriticalField], upper: Float, damped: Bools) -> Choice:
    """Return the choice between the stable intervals common to all fields.

    Parameters
    ----------
    fields : sequence of CriticalField
        One for each speed.
    upper : array, shape (n,)
        What the curve allows [N s/m], infinite without a curve.
    damped : array of bool, shape (n,)
        Whether the motions that no yaw damper reaches are damped.
    """
    low, high, stable = _common(fields)
    stable &= damped[:, None]
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
    everywhere = stable & (low == 0) & np.isinf(high)
    status = np.select(
        [
            ~damped,
            ~any_stable,
            upper <= 0,
            ~some,
            (end < upper) | (np.sum(width > 0, axis=1) > 1),
            np.isinf(end),
            everywhere.any(axis=1),
        ],
        [
            *(UNDAMPED, "stable for none", "infeasible in the curve", "infeasible", "partly unstable"),
            *("no upper limit", "stable for every C_s"),
        ],
        "ok",
    )
    return Choice(C_sl, C_s, status)


def _common(fields: Sequence[CriticalField]) -> tuple[Float, Float, Bools]:
    """Return the ends of the intervals between the critical values of all fields, and whether each is stable."""
    values = np.sort(np.concatenate([field.critical for field in fields], axis=1), axis=1)
    n = len(values)
    low = np.concatenate([np.zeros((n, 1)), values], axis=1)
    high = np.concatenate([np.where(np.isnan(values), np.inf, values), np.full((n, 1), np.inf)], axis=1)
    inside = np.where(np.isinf(high), np.where(low > 0, 2 * low, 1.0), (low + high) / 2)
    stable = ~np.isnan(low)
    for field in fields:
        with np.errstate(invalid="ignore"):
            place = np.sum(field.critical[:, None, :] < inside[:, :, None], axis=2)
        # Without critical values below, every interval has the count of the first one.
        stable &= np.take_along_axis(field.unstable_roots, place, axis=1) == 0
    return low, high, stable

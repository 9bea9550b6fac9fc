"""Critical speeds: where, for a given yaw damping, stability is gained or lost as the bogie runs faster.

The polynomial is of fourth degree in 1/v, so there is no closed set of equations as for C_s. The unstable roots are
counted at closely spaced speeds. A quotient of Hurwitz minors vanishes where a pair of roots crosses the imaginary
axis: between two speeds with the same count its least magnitude is looked for, and where it reaches zero there are two
changes that undo each other. Every change is halved down to rounding.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float, Index
from yawdesign.hunting.eigenvalues import count_undamped
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.critical_table import Rows
from yawdesign.hunting.many.margins import eigenvalues
from yawdesign.hunting.many.parameter_sets import ParameterSets

SPEEDS = 240  # between which changes are looked for
WITHIN = 12  # the same inside each interval with a change
SECTIONS = 28  # of the search for a least magnitude: down to a millionth of the interval
TOUCHING = 1e-3  # of the magnitude beside it: a least one below this is looked at by eigenvalues
TOGETHER = 8192  # points that are counted at once
HALVINGS = 30
ON_AXIS = 1e-6  # largest |Re| of the root at a critical speed, relative to max(1, |s|)


@dataclass(frozen=True)
class SpeedField:
    """Critical speeds of many vehicles.

    Parameters
    ----------
    critical, omega : array, shape (n, m)
        v [m/s] in rising order, and angular frequency [rad/s]; filled up with NaN.
    unstable_roots : array, shape (n, m + 1)
        Number of roots in the right half-plane in every interval between them; filled up with NaN.
    count : array of int, shape (n,)
        How many there are.
    recomputed : array of bool, shape (n,)
        Whether a count was doubtful somewhere, and was left to the eigenvalues.
    unverified : array of bool, shape (n,)
        Whether a speed was not confirmed by an eigenvalue on the imaginary axis, or a pair of roots touches it.
    """

    critical: Float
    omega: Float
    unstable_roots: Float
    count: Index
    recomputed: Bools
    unverified: Bools


def critical_speeds(sets: ParameterSets, searched: tuple[float, float]) -> SpeedField:
    """Return all speeds at which the number of unstable roots of the coupled motion changes.

    Parameters
    ----------
    sets : ParameterSets
        With ``C_s``; their own ``v`` is not looked at.
    searched : tuple of float
        Between which speeds [m/s].
    """
    v = np.linspace(*searched, SPEEDS + 1)
    start, mended = _sampled(sets, np.arange(sets.size), np.tile(v, (sets.size, 1)))
    first = _intervals(sets, start)
    inner = np.linspace(first.low, first.high, WITHIN + 1, axis=-1)
    within, _ = _sampled(sets, first.owner, inner)
    found = _intervals(sets, within)
    owner, speed, above = _changes(sets, found)
    s = _nearest(sets, owner, speed)
    rows = Rows(owner, speed, sets.size)
    unverified = np.zeros(sets.size, dtype=bool)
    unverified[owner[~_close(s)]] = True
    unverified[np.concatenate([first.touching, found.touching])] = True
    return SpeedField(
        critical=rows.spread(speed),
        omega=rows.spread(np.abs(s.imag)),
        unstable_roots=np.concatenate([start.counts[:, :1], rows.spread(above)], axis=1),
        count=rows.count,
        recomputed=mended,
        unverified=unverified,
    )


class _Samples(NamedTuple):
    """Counts of unstable roots at rising speeds, a row for each stretch that is looked at.

    `nearness` is zero where a pair of roots lies on the imaginary axis.
    """

    owner: Index
    v: Float
    counts: Float
    nearness: Float


class _Intervals(NamedTuple):
    """Intervals of speed with different counts at their ends, and who has a pair of roots that touches the axis."""

    owner: Index
    low: Float
    high: Float
    before: Float
    after: Float
    touching: Index


def _sampled(sets: ParameterSets, owner: Index, v: Float) -> tuple[_Samples, Bools]:
    """Return what is counted for every owner at its row of speeds, and where eigenvalues had to be asked."""
    counts, nearness = np.empty((2, *v.shape))
    mended = np.zeros(sets.size, dtype=bool)
    step = max(1, TOGETHER // max(1, len(owner)))
    for first in range(0, v.shape[1] if len(owner) else 0, step):
        some = v[:, first : first + step]
        whose = np.repeat(owner, some.shape[1])
        count, doubtful, near = _count(sets.part(whose).replace(v=some.ravel()))
        counts[:, first : first + step] = count.reshape(some.shape)
        nearness[:, first : first + step] = np.abs(near).reshape(some.shape)
        mended[whose[doubtful]] = True
    return _Samples(owner, v, counts, nearness), mended


def _intervals(sets: ParameterSets, samples: _Samples) -> _Intervals:
    """Return the intervals between neighbouring speeds in which the count changes, also those where it changes back."""
    row, cell = np.nonzero(np.diff(samples.counts, axis=1))
    plain = (samples.owner[row], *(x[row, cell + k] for x in (samples.v, samples.counts) for k in (0, 1)))
    owner, low, high, count = _dips(samples)
    middle, inside, ratio = _least(sets, owner, low, high, count)
    back = inside != count
    halves = (
        (owner[back], low[back], middle[back], count[back], inside[back]),
        (owner[back], middle[back], high[back], inside[back], count[back]),
    )
    near = ~back & (ratio < TOUCHING)
    touching = owner[near][_close(_nearest(sets, owner[near], middle[near]))]
    owners, lows, highs, befores, afters = (np.concatenate(column) for column in zip(plain, *halves, strict=True))
    return _Intervals(owners, lows, highs, befores, afters, touching)


def _dips(samples: _Samples) -> tuple[Index, Float, Float, Float]:
    """Return where the nearness has a least value among speeds of the same count: whose, between which, the count."""
    same = np.diff(samples.counts, axis=1) == 0
    beyond = np.full((len(same), 1), False)
    left, right = np.concatenate([beyond, same], axis=1), np.concatenate([same, beyond], axis=1)
    near = samples.nearness
    lower_left = np.concatenate([~beyond, near[:, 1:] <= near[:, :-1]], axis=1) | ~left
    lower_right = np.concatenate([near[:, :-1] < near[:, 1:], ~beyond], axis=1) | ~right
    row, k = np.nonzero(lower_left & lower_right & (left | right))
    low, high = samples.v[row, k - left[row, k]], samples.v[row, k + right[row, k]]
    return samples.owner[row], low, high, samples.counts[row, k]


def _least(sets: ParameterSets, owner: Index, low: Float, high: Float, count: Float) -> tuple[Float, Float, Float]:
    """Return where in each interval the nearness is least (golden section), or any place found with another count.

    Also the count there, and the nearness relative to the first one looked at.
    """
    place, inside, least = (low + high) / 2, count.copy(), np.full(len(owner), np.inf)
    if not len(owner):
        return place, inside, least
    golden = (np.sqrt(5) - 1) / 2

    def looked_at(v: Float) -> Float:
        nonlocal place, inside, least
        here, _, near = _count(sets.part(owner).replace(v=v))
        size = np.abs(near)
        better = (inside == count) & ((here != count) | (size < least))
        place, inside, least = (np.where(better, *pair) for pair in ((v, place), (here, inside), (size, least)))
        return size

    left, right = high - golden * (high - low), low + golden * (high - low)
    at_left, at_right = looked_at(left), looked_at(right)
    first = np.maximum(at_left, at_right)
    for _ in range(SECTIONS):
        to_left = at_left < at_right
        low, high = np.where(to_left, low, left), np.where(to_left, right, high)
        new = np.where(to_left, high - golden * (high - low), low + golden * (high - low))
        size = looked_at(new)
        left, right = np.where(to_left, new, right), np.where(to_left, left, new)
        at_left, at_right = np.where(to_left, size, at_right), np.where(to_left, at_left, size)
    with np.errstate(all="ignore"):
        return place, inside, least / first


def _count(sets: ParameterSets) -> tuple[Float, Bools, Float]:
    """Return the number of unstable roots at every point, by Routh's array or, if in doubt, by eigenvalues.

    Also where these were asked, and the nearness to a change.
    """
    count, doubts, near = counts.unstable_roots(sets.model, sets.zeros)(sets.values)
    doubtful = doubts > 0
    if doubtful.any():
        count[doubtful] = count_undamped(eigenvalues(sets.part(doubtful), sets.model.motions[0]))
    return count, doubtful, near


def _changes(sets: ParameterSets, found: _Intervals) -> tuple[Index, Float, Float]:
    """Return whose count changes at which speed, and the count above it."""
    owner, low, high, before, after, _ = found
    pieces: list[tuple[Any, ...]] = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    while len(owner):
        below, above, count = low, high, after
        for _ in range(HALVINGS):
            middle = (below + above) / 2
            here, _, _ = _count(sets.part(owner).replace(v=middle))
            same = here == before
            below, above = np.where(same, middle, below), np.where(same, above, middle)
            count = np.where(same, count, here)
        pieces.append((owner, (below + above) / 2, count))
        more = count != after
        owner, low, high = owner[more], above[more], high[more]
        before, after = count[more], after[more]
    whole = [np.concatenate(column) for column in zip(*pieces, strict=True)]
    return whole[0], whole[1], whole[2]


def _nearest(sets: ParameterSets, owner: Index, v: Float) -> Complex:
    """Return of every owner at its speed the eigenvalue that is nearest to the imaginary axis."""
    if not len(owner):
        return np.zeros(0, dtype=complex)
    s = eigenvalues(sets.part(owner).replace(v=v), sets.model.motions[0])
    nearest = np.argmin(np.abs(s.real) / np.maximum(1, np.abs(s)), axis=1)[:, None]
    return np.take_along_axis(s, nearest, axis=1)[:, 0]


def _close(s: Complex) -> Bools:
    return np.asarray(np.abs(s.real) < ON_AXIS * np.maximum(1, np.abs(s)))

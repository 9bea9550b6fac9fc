"""Which root at one value of a parameter is which at the next: the step is halved until there is no doubt.

Roots are continuous in every parameter; that is what makes a root "the same". Between two places a step is believed if

* the mean of the slopes at both ends, from left and right eigenvectors, leads from each root to its partner, and to no
  other one nearly as well,
* the biorthogonal products of the eigenvectors of both ends pair the roots in the same way,
* no two roots turn around each other by more than 60 degrees: in a near-coalescence they turn by up to 180, and whoever
  steps over it exchanges them.

Of roots that are all but one at both ends (see :mod:`yawdesign.response.modes.doublets`) the second alone is asked.

Every one of these conditions reads the same from either end, so a path does not depend on the direction. Real roots of
one part of a motion cannot pass each other without meeting; where two meet they leave the axis as a conjugate pair. By
convention the larger real root belongs to the root above the axis.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.doublets import by_motion, clusters, near
from yawdesign.response.modes.eigenvectors import Eigensystem, rounding

DOUBT = 0.25  # largest error of a partner's prediction, relative to that of the next best root
TURN = 0.5  # cosine of 60 degrees
FINEST = 2.0**-30  # of a step, where halving ends
AT_AXIS = 1e-3  # imaginary part relative to the size of a root at which it arrives at the real axis
PAIR, REAL, NEAR, LOST = KINDS = ("become a pair", "become two real roots", "pass close by", "cannot be told apart")


@dataclass(frozen=True)
class Place:
    """The spectrum of one part of a motion at one value of a parameter."""

    value: float
    matrix: Float
    spectrum: Eigensystem


@dataclass(frozen=True)
class RootStep:
    """Which root of one place is which of the next.

    Parameters
    ----------
    low, high : float
        Parameter at both places.
    partner : ndarray of int
        For each root of the first place its place in the second spectrum.
    certainty : ndarray
        For each root 1 - (error of the prediction)/(error for the next best root), between 0 and 1.
    sure : bool
        Whether all conditions hold.
    meeting : tuple of int
        The roots of the first place that meet, or come too near each other to be told apart; empty if there are none.
    kind : str
        What these do, one of `KINDS`.
    """

    low: float
    high: float
    partner: Index
    certainty: Float
    sure: bool
    meeting: tuple[int, ...] = ()
    kind: str = ""


def follow(start: Place, end: Place, at: Callable[[float], Place], share: float = 1.0) -> list[RootStep]:
    """Return the links from one place to another, through as many places between them as it takes.

    Parameters
    ----------
    start, end : Place
        The ends of the step.
    at : callable
        Returns the place at a value of the parameter.
    share : float
        The part of the user's step that this step is.
    """
    step = link(start, end)
    if step.sure:
        return [step]
    middle = between(start.value, end.value)
    if share < FINEST or middle in (start.value, end.value) or _are_one(start, end, step):
        return [_accepted(start.spectrum, end.spectrum, step)]
    between_them = at(middle)
    return follow(start, between_them, at, share / 2) + follow(between_them, end, at, share / 2)


def _are_one(start: Place, end: Place, step: RootStep) -> bool:
    """Return whether the roots in doubt are one within rounding at both ends: no smaller step tells them apart."""
    p, q = start.spectrum.s, end.spectrum.s
    roots = [k for k in step.meeting if p[k].imag >= 0 or q[step.partner[k]].imag >= 0]
    ends = ((start.matrix, p[roots]), (end.matrix, q[step.partner[roots]]))
    return len(roots) > 1 and all(np.abs(s - s[0]).max() <= rounding(matrix) for matrix, s in ends)


def between(low: float, high: float) -> float:
    """Return the geometric mean of two positive numbers, the arithmetic mean of others."""
    return float(np.sqrt(low) * np.sqrt(high)) if low > 0 and high > 0 else (low + high) / 2


def link(start: Place, end: Place) -> RootStep:
    """Return which root is which at two places, and whether that is sure."""
    p, q = start.spectrum, end.spectrum
    if p.real != q.real:
        return _at_a_meeting(start, end)
    change = end.matrix - start.matrix
    error = np.abs(_distance(p.s, q.s) - (p.velocity(change)[:, None] + q.velocity(change)) / 2)
    alike = _likeness(p, q)
    partner, one = _told_by_motion(p, q, alike, _pairs(p, error))
    certainty = _certainty(p, q, error, partner, one)
    turned = _turned(p, q, partner, one)
    most = alike.argmax(axis=1)
    unlike = (most != partner) & ~one[np.arange(len(most)), np.argsort(partner)[most]]
    doubt = (certainty <= 1 - DOUBT) | turned | unlike
    return RootStep(
        start.value, end.value, partner, certainty, not doubt.any(), tuple(np.flatnonzero(doubt).tolist()), LOST
    )


def _distance(s: Complex, other: Complex) -> Complex:
    return np.asarray(other[None, :] - s[:, None])


def _pairs(p: Eigensystem, error: Float) -> Index:
    """Return the partners: real roots keep their order, those above the axis are matched with the least error."""
    above = p.real + (len(p.s) - p.real) // 2
    _, chosen = linear_sum_assignment(error[p.real : above, p.real : above])
    return np.concatenate([np.arange(p.real), chosen + p.real, chosen + above]).astype(np.intp)


def _told_by_motion(p: Eigensystem, q: Eigensystem, alike: Float, partner: Index) -> tuple[Index, NDArray[np.bool_]]:
    """Return the partners, and which roots need not be told apart by their place.

    These are zeros of bodies that no spring holds, and roots that are all but one at both ends: real ones, which keep
    their order, and others if their motions tell which is which.
    """
    one = near(p.s) & near(q.s[partner])
    partner, pairs = partner.copy(), (len(p.s) - p.real) // 2
    for same in clusters(p.s, one):
        told = by_motion(alike, same, partner[same])
        if told is None:
            one[np.ix_(same, same)] = False
        else:
            partner[same], partner[same + pairs] = told, told + pairs
    return partner, one


def _certainty(p: Eigensystem, q: Eigensystem, error: Float, partner: Index, one: NDArray[np.bool_]) -> Float:
    """Return how much better each partner is predicted than any other root, seen from both ends."""
    n = np.arange(len(partner))
    own = error[n, partner]
    others = error.copy()
    others[:, partner] = np.where(one | np.eye(len(n), dtype=bool), np.inf, error[:, partner])
    next_best = np.minimum(others.min(axis=1), others.min(axis=0)[partner])
    return np.asarray(1 - np.minimum(1, own / np.maximum(next_best, np.finfo(float).tiny)))


def _turned(p: Eigensystem, q: Eigensystem, partner: Index, one: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which roots above the axis turn too far around another one."""
    r, n = p.real, len(p.s)
    above = np.arange(r, r + (n - r) // 2)
    before, after = (_distance(s, s) for s in (p.s[above], q.s[partner[above]]))
    cosine = np.real(before * after.conj())
    turned = (cosine < TURN * np.abs(before) * np.abs(after)) & ~one[np.ix_(above, above)]
    out = np.zeros(n, dtype=bool)
    out[above] = out[above + len(above)] = turned.any(axis=1)
    return out


def _likeness(p: Eigensystem, q: Eigensystem) -> Float:
    """Return how much the eigenvectors of each root are like those of each root of the other end, shape (p, q).

    The products of left and right eigenvectors of two places do not depend on units, and each row of them sums to 1.
    """
    return np.asarray(np.abs((p.left.T @ q.right) * (q.left.T @ p.right).T))


def _at_a_meeting(start: Place, end: Place) -> RootStep:
    """Return the link over a step in which real roots meet, or a conjugate pair arrives at the real axis."""
    p, q = start.spectrum, end.spectrum
    if p.real > q.real:
        partner, meeting = _merge(p, q)
    else:
        backwards, meeting = _merge(q, p)
        partner = np.argsort(backwards)
        meeting = tuple(int(backwards[k]) for k in meeting)
    certainty = np.ones(len(partner))
    certainty[list(meeting)] = np.nan
    kind = PAIR if p.real > q.real else REAL
    return RootStep(start.value, end.value, partner.astype(np.intp), certainty, False, meeting, kind)


def _merge(p: Eigensystem, q: Eigensystem) -> tuple[Index, tuple[int, ...]]:
    """Return the partners where neighbouring real roots of p are conjugate pairs in q, and those real roots."""
    lost: list[int] = []
    for _ in range((p.real - q.real) // 2):
        left = [k for k in range(p.real) if k not in lost]
        gap = [_cost_without(p, q, (*lost, a, b)) for a, b in pairwise(left)]
        k = int(np.argmin(gap))
        lost += [left[k], left[k + 1]]
    return _matched_without(p, q, tuple(sorted(lost)))[0], tuple(sorted(lost))


def _cost_without(p: Eigensystem, q: Eigensystem, lost: tuple[int, ...]) -> float:
    return _matched_without(p, q, tuple(sorted(lost)))[1]


def _matched_without(p: Eigensystem, q: Eigensystem, lost: tuple[int, ...]) -> tuple[Index, float]:
    """Return the partners if the given real roots of p are pairs in q, and how far all roots then are apart."""
    kept = [k for k in range(p.real) if k not in lost]
    pairs = list(zip(lost[::2], lost[1::2], strict=True))
    n_p, n_q = (len(p.s) - p.real) // 2, (len(q.s) - q.real) // 2
    above_p, above_q = np.arange(p.real, p.real + n_p), np.arange(q.real, q.real + n_q)
    centres = np.array([(p.s[a] + p.s[b]) / 2 for a, b in pairs])
    apart = np.abs(_distance(np.concatenate([p.s[above_p], centres]), q.s[above_q]))
    rows, chosen = linear_sum_assignment(apart)
    m = min(len(kept), q.real)
    cost = apart[rows, chosen].sum() + np.abs(p.s[kept[:m]] - q.s[:m]).sum()
    partner = np.full(len(p.s), -1)
    partner[kept[:m]] = np.arange(m)
    for row, column in zip(rows, chosen, strict=True):
        upper, lower = (above_p[row], above_p[row] + n_p) if row < n_p else pairs[row - n_p]
        partner[upper], partner[lower] = above_q[column], above_q[column] + n_q
    return partner.astype(np.intp), float(cost)


def _accepted(p: Eigensystem, q: Eigensystem, step: RootStep) -> RootStep:
    """Return the last link of a halving that did not end in certainty."""
    if p.real != q.real:
        return step
    certainty = step.certainty.copy()
    above = [k for k in step.meeting if p.s[k].imag > 0]
    at_axis = np.abs(p.s[above].imag) < AT_AXIS * np.abs(p.s[above])
    # Next to a meeting on the real axis: real roots keep their order, a pair alone is itself, and of pairs that arrive
    # together it is a convention, as with the real roots that they become, which is which.
    if len(above) < 2 or at_axis.all():
        certainty[list(step.meeting)] = np.nan
        return replace(step, certainty=certainty, meeting=())
    certainty[list(step.meeting)] = 0.0
    return replace(step, certainty=certainty)

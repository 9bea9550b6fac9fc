"""Roots that are all but one: their motion, and not their place, tells which is which.

The bogies of a vehicle have the same motions, alike and against each other, and hardly anything but the car body's
inertia couples some of them. Their roots differ by less than any step along a parameter could resolve, over its whole
range; but in the one both bogies move alike, and in the other one against the other.
"""

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Complex, Float, Index

ONE = 1e-8  # distance of two roots relative to their size below which they are told apart by their motion
PURE = 0.75  # share of a motion that a root must have to be told by it
INDEPENDENT = 1e-6  # ratio of singular values below which eigenvectors are taken for one


def near(s: Complex, apart: float = ONE) -> NDArray[np.bool_]:
    """Return which roots are all but one, shape (roots, roots)."""
    return np.asarray(np.abs(s[:, None] - s) <= apart * np.abs(s))


def clusters(s: Complex, within: NDArray[np.bool_]) -> list[Index]:
    """Return the places of roots above the real axis that are all but one, two and more of them."""
    left, found = [int(k) for k in np.flatnonzero(s.imag > 0)], []
    while left:
        same = [k for k in left if within[left[0], k]]
        left = [k for k in left if k not in same]
        if len(same) > 1:
            found.append(np.array(same))
    return found


def pure_motions(left: Complex, right: Complex) -> Complex | None:
    """Return how motions that share no state are made of those of some roots; None if the roots' own are not distinct.

    Parameters
    ----------
    left, right : ndarray, shape (states, roots)
        Eigenvectors, biorthogonal.

    Returns
    -------
    ndarray, shape (roots, motions)
        Motions ``right @ x`` in which every state has another share; of roots that are exactly one any of their
        combinations is an eigenvector, and these are the ones that do not depend on rounding.
    """
    unit = right / np.linalg.norm(right, axis=0)
    size = np.linalg.svd(unit, compute_uv=False)
    if size[-1] < INDEPENDENT * size[0]:
        return None
    weight = np.arange(len(right))  # any numbers that differ from state to state
    _, made = np.linalg.eig(np.linalg.solve(left.T @ right, left.T @ (weight[:, None] * right)))
    return np.asarray(made) if np.linalg.cond(made) < 1 / INDEPENDENT else None


def purify(s: Complex, left: Complex, right: Complex, rounding: float) -> bool:
    """Give roots that are one within rounding the eigenvectors of motions that share no state; say if there are any."""
    found = False
    for same in clusters(s, np.abs(s[:, None] - s) <= rounding):
        made = pure_motions(left[:, same], right[:, same])
        if made is not None:
            found = True
            right[:, same] = right[:, same] @ made
            left[:, same] = left[:, same] @ np.linalg.inv(made).T
    return found


def by_motion(alike: Float, same: Index, partner: Index) -> Index | None:
    """Return the partners of roots that are all but one at both ends of a step; None where their motions do not tell.

    Parameters
    ----------
    alike : ndarray, shape (roots, roots)
        Biorthogonal products of the eigenvectors of both ends.
    same : ndarray of int
        The roots at the first end.
    partner : ndarray of int
        Their places at the second end, in any order.
    """
    product = alike[np.ix_(same, partner)]
    chosen = product.argmax(axis=1)
    if len({*chosen.tolist()}) < len(same) or np.any(product.max(axis=1) < PURE):
        return None
    return np.asarray(partner[chosen], dtype=np.intp)

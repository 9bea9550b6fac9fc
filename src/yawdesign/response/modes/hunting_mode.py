"""Which mode is the hunting of a bogie: the oscillation that comes from the conicity of its wheels.

A wheelset that rolls freely swings at a frequency that grows with the square root of the conicity (Klingel), so the
relative change of its root is half that of the conicity; a motor, or a frame on stiff springs, hardly feels it. In a
bogie both are mixed, and the motion that becomes unstable may move the frame or the motors more than the wheelsets.
"""

from collections.abc import Sequence

import numpy as np

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.eigenvectors import Eigensystem

DEPENDS = 0.1  # of the largest dependence on the conicity: a root with less is not hunting


def conicity_share(change: Float, places: Sequence[Index], found: Sequence[Eigensystem]) -> Float:
    """Return by how much each root depends on the conicity, |d ln s / d ln lambda|.

    Parameters
    ----------
    change : ndarray
        What the conicity adds to the state matrix; since it does so linearly, also the derivative to ln lambda.
    places, found : sequences
        States and spectrum of each part of the motion.
    """
    moved = [part.velocity(change[np.ix_(states, states)]) for states, part in zip(places, found, strict=True)]
    s = np.concatenate([part.s for part in found])
    return np.asarray(np.abs(np.concatenate(moved)) / np.where(s == 0, 1, np.abs(s)))


def hunting_root(s: Complex, conicity: Float) -> int | None:
    """Return the place of the hunting root: the least decaying oscillation of those that depend on the conicity.

    An oscillation depends on it if it does so by a tenth of what the one that depends most does. One that grows always
    counts, since only the contact of wheel and rail can feed it.

    Parameters
    ----------
    s : ndarray
        Roots of the bogie [1/s].
    conicity : ndarray
        |d ln s / d ln lambda| of each.

    Returns
    -------
    int or None
        None if nothing that oscillates depends on the conicity.
    """
    waves = s.imag > 0
    largest = float(np.max(conicity[waves], initial=0.0))
    hunts = waves & ((conicity >= DEPENDS * largest) & (largest > 0) | (s.real > 0))
    return int(np.argmax(np.where(hunts, s.real, -np.inf))) if hunts.any() else None

"""Paths of the roots of one part of a motion, and the names that these have where they are at home."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.eigenvectors import spectrum
from yawdesign.response.modes.encounters import Encounter, Walk, walk
from yawdesign.response.modes.links import LOST, Place
from yawdesign.response.modes.names import NamedRoot


@dataclass(frozen=True)
class Path:
    """The roots of one part of a motion along a parameter.

    Parameters
    ----------
    s : ndarray, shape (points, roots)
        Roots, each column the same one [1/s].
    home : ndarray, shape (roots,)
        The same at the value where they get their names.
    certainty : ndarray, shape (points - 1, roots)
        As in `FollowedModes`.
    encounters : tuple of Encounter
        Who meets whom; of the way home only who cannot be told apart there.
    """

    s: Complex
    home: Complex
    certainty: Float
    encounters: tuple[Encounter, ...]


def follow_part(values: Float, home: float, matrices: Callable[[float], Float], states: Index) -> Path:
    """Follow the roots of one part of a motion.

    Parameters
    ----------
    values : ndarray
        Of the parameter, rising or falling.
    home : float
        The value where the roots get their names.
    matrices : callable
        Returns the state matrix at a value.
    states : ndarray of int
        States of the part.
    """

    @cache
    def at(value: float) -> Place:
        matrix = matrices(value)[np.ix_(states, states)]
        return Place(value, matrix, spectrum(matrix))

    walked = walk(values, at)
    given = np.flatnonzero(np.isin(walked.values, values))
    # An order of the paths that does not depend on the direction of the walk.
    sort = np.lexsort((-walked.s[given].imag.mean(axis=0), size(walked.s[given])))
    rank = np.argsort(sort)
    s, lost = _at_home(walked, home, at)
    return Path(
        s=walked.s[np.ix_(given, sort)],
        home=s[sort],
        certainty=np.minimum.reduceat(walked.certainty, given[:-1])[:, sort],
        encounters=tuple(replace(e, roots=tuple(rank[list(e.roots)].tolist())) for e in (*walked.encounters, *lost)),
    )


def _at_home(walked: Walk, home: float, at: Callable[[float], Place]) -> tuple[Complex, list[Encounter]]:
    """Return what the root of each path is at home, and where on the way there roots cannot be told apart."""
    near = int(np.argmin(np.abs(walked.values - home)))
    start, order = float(walked.values[near]), walked.order[near]
    if start == home:
        return at(home).spectrum.s[order], []
    way = walk(np.array([start, home]), at)
    path = np.argsort(order)
    lost = [replace(e, roots=tuple(path[list(e.roots)].tolist())) for e in way.encounters if e.kind == LOST]
    return way.s[-1, order], lost


def names_at_home(path: Path, states: Index, roots: Sequence[NamedRoot]) -> list[str]:
    """Return the name of each root of a part; a root below the real axis has the name of its conjugate, marked.

    Parameters
    ----------
    path : Path
        The part's roots.
    states : ndarray of int
        Its states.
    roots : sequence of NamedRoot
        The roots of the whole motion at home.
    """
    named = [(root.s, root.name) for root in roots if root.states[0] in states]
    named += [(s.conjugate(), f"{name}, second root") for s, name in named if s.imag]
    _, chosen = linear_sum_assignment(np.abs(path.home[:, None] - np.array([s for s, _ in named])))
    return [named[k][1] for k in chosen]


def size(s: Complex) -> Float:
    """Return the mean distance of roots from the origin along the first axis, the same if that is walked backwards."""
    return np.asarray(np.exp(np.mean(np.log(np.abs(s) + 1e-300), axis=0)))

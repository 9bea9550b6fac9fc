"""Paths of the roots along a parameter: the links of all steps together, who meets whom, and their names at home."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.arrays import Complex, Float, Index
from yawdesign.response.modes.eigenvectors import spectrum
from yawdesign.response.modes.links import LOST, NEAR, Place, follow
from yawdesign.response.modes.names import NamedRoot

CLOSE = 1e-3  # distance of two roots relative to their size at which they are said to pass close by


@dataclass(frozen=True)
class Encounter:
    """Two roots that meet, or nearly.

    Parameters
    ----------
    low, high : float
        It happens between these values of the parameter.
    roots : tuple of int
        Numbers of the paths.
    kind : str
        One of `KINDS`.
    s : complex
        Where [1/s].
    distance : float
        How near they come [1/s]; 0 for roots that meet.
    """

    low: float
    high: float
    roots: tuple[int, ...]
    kind: str
    s: complex
    distance: float


@dataclass(frozen=True)
class Walk:
    """All places that a walk along the parameter has visited.

    Parameters
    ----------
    values : ndarray, shape (places,)
        Parameter.
    order : ndarray of int, shape (places, roots)
        For each path its place in the spectrum.
    s : ndarray, shape (places, roots)
        Roots, each column one path.
    certainty : ndarray, shape (places - 1, roots)
        As in `RootStep`, by path.
    encounters : tuple of Encounter
        In the order in which they happen.
    """

    values: Float
    order: NDArray[np.intp]
    s: Complex
    certainty: Float
    encounters: tuple[Encounter, ...]


def walk(values: Float, at: Callable[[float], Place]) -> Walk:
    """Follow the roots of one part of a motion through values of a parameter.

    Parameters
    ----------
    values : ndarray
        Rising or falling.
    at : callable
        Returns the place at a value of the parameter.
    """
    places = [at(float(value)) for value in values]
    links = [step for start, end in pairwise(places) for step in follow(start, end, at)]
    order = [np.arange(len(places[0].spectrum.s))]
    certainty, met = [], []
    for step in links:
        here = order[-1]
        certainty.append(step.certainty[here])
        if step.meeting:
            where = complex(np.mean(at(step.low).spectrum.s[list(step.meeting)]))
            who = tuple(int(k) for k in np.flatnonzero(np.isin(here, step.meeting)))
            met.append(Encounter(step.low, step.high, who, step.kind, where, 0.0))
        order.append(step.partner[here])
    visited = np.array([places[0].value, *(step.high for step in links)])
    s = np.stack([at(float(value)).spectrum.s[k] for value, k in zip(visited, order, strict=True)])
    near = _close_by(visited, s, met)
    return Walk(visited, np.array(order), s, np.array(certainty), (*met, *near))


def _close_by(values: Float, s: Complex, met: Sequence[Encounter]) -> list[Encounter]:
    """Return where two oscillating roots come near each other without meeting; one place for every two roots."""
    known = {encounter.roots for encounter in met}
    waving = np.flatnonzero(np.any(s.imag > 0, axis=0))
    found = []
    for i, k in combinations(waving.tolist(), 2):
        both = (s[:, i].imag > 0) & (s[:, k].imag > 0)
        apart = np.where(both, np.abs(s[:, i] - s[:, k]), np.inf)
        n = int(np.argmin(apart))
        if 0 < apart[n] < CLOSE * abs(s[n, i]) and (i, k) not in known:
            low, high = values[max(n - 1, 0)], values[min(n + 1, len(values) - 1)]
            where = complex(s[n, i] + s[n, k]) / 2
            found.append(Encounter(float(low), float(high), (i, k), NEAR, where, float(apart[n])))
    return found


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

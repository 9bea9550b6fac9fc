"""A walk along a parameter: the links of all its steps put together to paths, and who meets whom on the way."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.response.modes.links import NEAR, Place, follow

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

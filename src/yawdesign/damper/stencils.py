"""The largest value of a function on a unit cube near some points, by shrinking random stencils.

Whether a value exceeds a level is one verdict, which costs far less than the value: so a stencil is looked at with
verdicts, and values are computed of what has passed.
"""

from typing import Protocol

import numpy as np

from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.problem.arguments import Progress

LEAST = 1e-10  # gain that counts, relative: below it verdicts and values differ by rounding
MOST_TRIES = 12  # looks at a stencil: half of its points are better than any one, but for rounding near an optimum


class Landscape(Protocol):
    """What has a value at every point of a unit cube."""

    def beats_at(self, x: Float, level: Float) -> Bools:
        """Return where the value exceeds a level, shape (n,), at points of the cube, shape (variables, n)."""

    def margins_at(self, x: Float) -> Float:
        """Return the values at points of the cube, shape (variables, n)."""


def refine(
    landscape: Landscape,
    x: Float,
    margin: Float,
    rng: np.random.Generator,
    *,
    radius: float = 0.03,
    until: float = 1e-5,
    rounds: int = 40,
    points: int = 192,
    tries: int = MOST_TRIES,
    progress: Progress = lambda text, part: None,
) -> Float:
    """Return points improved by shrinking random stencils, all at once, the best first.

    Each point has a radius of its own, which grows with success and shrinks without, until it is small enough or the
    rounds are over. Half of a stencil follows the
    last successful step, and so it follows a ridge. Points that have come close to a better one are dropped.
    """
    d, n = x.shape
    x, margin, size, step = x.copy(), margin.copy(), np.full(n, radius), np.zeros((d, n))
    for count in range(rounds):
        k = np.flatnonzero(size > until)
        if not k.size:
            break
        progress("refining the best designs", count / rounds)
        trial = _stencil(x[:, k], size[k], step[:, k], points, rng)
        better, value = _best_of(landscape, trial, margin[k], tries)
        won = value > margin[k]
        step[:, k] = np.where(won, better - x[:, k], step[:, k] * 0.5)
        x[:, k], margin[k] = np.where(won, better, x[:, k]), np.where(won, value, margin[k])
        size[k] = np.where(won, np.minimum(1.5 * size[k], 0.2), 0.7 * size[k])
        keep = distinct(x, margin, size)
        x, margin, size, step = x[:, keep], margin[keep], size[keep], step[:, keep]
    return x[:, np.argsort(-margin, kind="stable")]


def _stencil(x: Float, size: Float, step: Float, points: int, rng: np.random.Generator) -> Float:
    d, n = x.shape
    noise = rng.standard_normal((d, n, points)) * size[:, None] * rng.random((1, n, points)) ** 2
    along = step[:, :, None] * rng.exponential(1.5, (1, n, points)) * (np.arange(points) % 2)
    return np.asarray(np.clip(x[:, :, None] + noise + along, 0, 1))


def _best_of(landscape: Landscape, trial: Float, level: Float, tries: int) -> tuple[Float, Float]:
    """Return the best point of each stencil and its margin, at least the given level, found with verdicts."""
    d, n, m = trial.shape
    x, owner = trial.reshape(d, -1), np.repeat(np.arange(n), m)
    best, margin = trial[:, :, 0].copy(), level.copy()
    for _ in range(tries):
        level = margin[owner]  # minus infinity where the curve's limit is exceeded
        beats = landscape.beats_at(x, level + LEAST * np.where(np.isfinite(level), np.abs(level), 0))
        x, owner = x[:, beats], owner[beats]
        if not len(owner):
            break
        row, one = np.unique(owner, return_index=True)
        found = landscape.margins_at(x[:, one])
        better = found > margin[row]
        best[:, row[better]], margin[row[better]] = x[:, one[better]], found[better]
        x, owner = np.delete(x, one, axis=1), np.delete(owner, one)
    return best, margin


def distinct(x: Float, margin: Float, size: Float) -> Index:
    """Return the points to go on with: none close to a better one, none ten per cent behind late."""
    keep: list[int] = []
    for k in np.argsort(-margin, kind="stable"):
        near = any(np.max(np.abs(x[:, k] - x[:, j])) < max(size[k], 1e-3) for j in keep)
        late = bool(keep) and size[k] < 1e-3 and margin[k] < margin[keep[0]] - 0.1 * abs(margin[keep[0]])
        if not near and not late:
            keep.append(int(k))
    return np.array(keep, dtype=np.intp)

"""Global search of a design space: dense verdicts first, then refinement of the best point of many cells.

A margin is the least of many smooth functions, with kinks and coalescing roots at its best points, and has many local
optima. A verdict "is the margin above this level" costs a small part of the margin itself; so all points get a verdict
against the best margin of their own cell; of those that pass one gets its margin, the others a verdict against that,
and so on until none is left.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from yawdesign.damper.design_space import Space
from yawdesign.damper.stencils import refine
from yawdesign.hunting.arrays import Float, Index
from yawdesign.problem.arguments import Progress
from yawdesign.problem.progress import between

BLOCK = 100_000  # points at once: enough to hide Python's overhead, few enough for any memory
SLOW = 8192  # points in all, where verdicts take a thousand times as long
CELLS = 6  # cells per axis in up to three variables, each with a best point of its own; in all about 6^3
STARTS = 20  # cells that are refined, in up to three variables; in more of them more
FIRST = 512  # points that give the cells their first levels
OTHERS = 4900  # points in the variables other than C_s
LINE = 72  # points along C_s
GAIN = 1e-4  # what a cell's best must be beaten by, relative: smaller differences are left to the refinement
MOST_LOOKS = 40  # at the points of a block; as half of them are better than any one, about ten are needed
REFINED_FROM = 0.6  # share of a search after which its best points are refined
LOWEST = -1e9  # level of cells without a point: less than any merit
MOST_SPLIT = 9  # variables whose axes are divided into cells: their number doubles with each


@dataclass
class _DesignCells:
    """The best point of every cell; the last of the axes are divided, C_s among them."""

    x: Float
    margin: Float
    per_axis: int
    axes: int

    @classmethod
    def of(cls, d: int) -> Self:
        """Return the cells of a cube of d variables, with no points in them yet."""
        axes = min(d, MOST_SPLIT)
        per_axis = CELLS if d <= 3 else max(2, round(CELLS ** (3 / d)))
        return cls(np.full((d, per_axis**axes), 0.5), np.full(per_axis**axes, -np.inf), per_axis, axes)

    def index(self, x: Float) -> Index:
        """Return the cell of each point."""
        cells = np.minimum((x[-self.axes :] * self.per_axis).astype(int), self.per_axis - 1)
        return np.asarray(np.ravel_multi_index(tuple(cells), (self.per_axis,) * self.axes))

    def offer(self, x: Float, margin: Float) -> None:
        """Keep those points that are better than their cell's best."""
        rising = np.argsort(margin)  # of several points in a cell the last one stays
        x, margin = x[:, rising], margin[rising]
        cell = self.index(x)
        better = margin > self.margin[cell]
        self.margin[cell[better]], self.x[:, cell[better]] = margin[better], x[:, better]


def search(space: Space, seed: int, progress: Progress) -> Float:
    """Return refined points of the cube, shape (variables, points), the best first."""
    d, rng = len(space.names), np.random.default_rng(seed)
    cells = _DesignCells.of(d)
    first = np.concatenate([rng.random((d, FIRST)), space.anchors], axis=1)
    cells.offer(first, space.margins_at(first))
    floor = LOWEST if space.near is None else _near(space, space.near, cells, rng)
    blocks = list(_blocks(space, rng))
    most = SLOW // len(blocks) if space.is_slow else BLOCK
    for k, x in enumerate(blocks):
        progress("searching the design space", REFINED_FROM * k / len(blocks))
        _look(space, cells, x[:, rng.permutation(x.shape[1])[:most]], floor)
    order = np.argsort(-cells.margin, kind="stable")[: STARTS * min(max(1, d - 2), MOST_SPLIT)]
    order = order[np.isfinite(cells.margin[order]) & (cells.margin[order] >= floor)]
    late = between(progress, REFINED_FROM, 1.0)
    return refine(space, cells.x[:, order], cells.margin[order], rng, progress=late)


def _near(space: Space, share: float, cells: _DesignCells, rng: np.random.Generator) -> float:
    """Offer what the anchors become when they are refined, and return which margins are searched for."""
    x = refine(space, space.anchors, space.margins_at(space.anchors), rng)
    margin = space.margins_at(x)
    cells.offer(x, margin)
    return max(LOWEST, float(margin[0] - share * abs(margin[0])))


def _look(space: Space, cells: _DesignCells, x: Float, floor: float) -> None:
    """Look at points in any order, and keep the best one of every cell, of those above a floor."""
    for _ in range(MOST_LOOKS):
        level = np.maximum(cells.margin[cells.index(x)], floor)
        x = x[:, space.beats_at(x, level + GAIN * np.abs(level))]
        if not x.shape[1]:
            break
        _, one = np.unique(cells.index(x), return_index=True)
        cells.offer(x[:, one], space.margins_at(x[:, one]))
        x = np.delete(x, one, axis=1)


def _blocks(space: Space, rng: np.random.Generator) -> Iterator[Float]:
    """Yield blocks of points: a grid in up to two variables beside C_s, a Sobol sequence in more; a line in C_s."""
    has_damping = space.names[-1] == "C_s"
    others = len(space.names) - has_damping
    line = {0: 20_000, 1: 400}.get(others, LINE) if has_damping else 1
    total = OTHERS if has_damping else 262_144
    points = _others(others, total, rng)
    size = max(1, BLOCK // line)
    for start in range(0, points.shape[1], size):
        block = points[:, start : start + size]
        if not has_damping:
            yield block
            continue
        # Every line has its own phase, so that together they miss no damping.
        steps = (np.arange(line) + rng.random((block.shape[1], 1))) / line
        wide = np.broadcast_to(block[:, :, None], (others, *steps.shape))
        yield np.concatenate([wide.reshape(others, steps.size), steps.reshape(1, -1)])


def _others(d: int, total: int, rng: np.random.Generator) -> Float:
    if d == 0:
        return np.zeros((0, 1))
    if d > 2:
        from scipy.stats import qmc  # takes longer to import than a search in up to three variables

        return np.asarray(qmc.Sobol(d, rng=rng).random(1 << (total - 1).bit_length()).T)
    n = round(total ** (1 / d)) if d == 2 else min(total, 2000)
    axes = np.meshgrid(*[np.linspace(0, 1, n)] * d, indexing="ij")
    jitter = rng.random((d, 1)) - 0.5
    return np.clip(np.stack([axis.ravel() for axis in axes]) + jitter / n, 0, 1)

"""Critical speeds: where, for a given yaw damping, stability is gained or lost as the bogie runs faster.

The polynomial is of fourth degree in 1/v, so there is no closed set of equations as for C_s. The unstable roots are
counted at closely spaced speeds, and every change is halved down to rounding. Two changes that undo each other between
two neighbouring speeds are not seen.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.stability.many import kernels
from yawdesign.stability.many.block import Block
from yawdesign.stability.many.critical_values import Rows
from yawdesign.stability.modes import count_undamped
from yawdesign.study.margins import eigenvalues
from yawdesign.study.question import Answers, Question

Float = NDArray[np.float64]
Ints = NDArray[np.intp]

SPEEDS = 240  # between which changes are looked for
TOGETHER = 8192  # points that are counted at once
HALVINGS = 34
ON_AXIS = 1e-6  # largest |Re| of the root at a critical speed, relative to max(1, |s|)


def critical_speeds(question: Question, block: Block) -> Answers:
    """Return all speeds at which the number of unstable roots of the coupled motion changes."""
    v = np.linspace(question.speeds[0], question.speeds[-1], SPEEDS + 1)
    counts, mended = _counts(question, block, v)
    owner, cell = np.nonzero(np.diff(counts, axis=1))
    found = _changes(question, block, owner, v[cell], v[cell + 1], counts[owner, cell], counts[owner, cell + 1])
    owner, speed, above = found
    s = eigenvalues(question, block.part(owner).with_values(v=speed)) if len(owner) else np.zeros((0, 1), dtype=complex)
    nearest = np.argmin(np.abs(s.real) / np.maximum(1, np.abs(s)), axis=1)[:, None]
    s = np.take_along_axis(s, nearest, axis=1)[:, 0]
    rows = Rows(owner, speed, block.size)
    unstable = np.concatenate([counts[:, :1], rows.spread(above)], axis=1)
    unverified = np.zeros(block.size, dtype=bool)
    unverified[owner[~(np.abs(s.real) < ON_AXIS * np.maximum(1, np.abs(s)))]] = True
    columns = {
        "critical_speed": rows.spread(speed),
        "omega": rows.spread(np.abs(s.imag)),
        "unstable_roots": unstable,
        "count": rows.count,
    }
    return Answers(columns, mended, unverified)


def _counts(question: Question, block: Block, v: Float) -> tuple[Float, NDArray[np.bool_]]:
    """Return the number of unstable roots at every point and speed, and where eigenvalues had to be asked."""
    counts = np.empty((block.size, len(v)))
    mended = np.zeros(block.size, dtype=bool)
    step = max(1, TOGETHER // block.size)
    for first in range(0, len(v), step):
        some = v[first : first + step]
        owner = np.repeat(np.arange(block.size), len(some))
        count, doubtful = _count(question, block.part(owner).with_values(v=np.tile(some, block.size)))
        counts[:, first : first + step] = count.reshape(block.size, -1)
        mended[owner[doubtful]] = True
    return counts, mended


def _count(question: Question, block: Block) -> tuple[Float, NDArray[np.bool_]]:
    """Return the number of unstable roots at every point, by Routh's array or, if in doubt, by eigenvalues."""
    count, doubts = kernels.unstable_roots(question.kind, question.equations, block.zeros)(block.values)
    doubtful = doubts > 0
    if doubtful.any():
        count[doubtful] = count_undamped(eigenvalues(question, block.part(doubtful)))
    return count, doubtful


def _changes(
    question: Question, block: Block, owner: Ints, low: Float, high: Float, before: Float, after: Float
) -> tuple[Ints, Float, Float]:
    """Return whose count changes at which speed, and the count above it."""
    pieces: list[tuple[Any, ...]] = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    while len(owner):
        below, above, count = low, high, after
        for _ in range(HALVINGS):
            middle = (below + above) / 2
            here, _ = _count(question, block.part(owner).with_values(v=middle))
            same = here == before
            below, above = np.where(same, middle, below), np.where(same, above, middle)
            count = np.where(same, count, here)
        pieces.append((owner, (below + above) / 2, count))
        more = count != after
        owner, low, high = owner[more], above[more], high[more]
        before, after = count[more], after[more]
    whole = [np.concatenate(column) for column in zip(*pieces, strict=True)]
    return whole[0], whole[1], whole[2]

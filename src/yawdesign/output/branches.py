"""Curves of many values at each place: which value continues which, and what is stable between them."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from yawdesign.hunting.arrays import Float

Points = list[tuple[float, float]]

# What the bogie becomes when the quantity grows through a critical value.
KINDS = ("stable", "unstable", "neither")


class CriticalColumn:
    """All critical values at one place of the axis, in rising order, and what lies between them.

    Parameters
    ----------
    values, omega : sequence of float
        Critical values and frequencies, filled up with NaN.
    unstable_roots : sequence of float
        Below the first value, between the first and the second, ..., filled up with NaN.
    """

    def __init__(self, values: Float, omega: Float, unstable_roots: Float) -> None:
        self.values = values[~np.isnan(values)]
        self.omega = omega[: self.values.size]
        self.roots = unstable_roots[: self.values.size + 1]

    @property
    def kinds(self) -> list[str]:
        """What the bogie becomes above each value."""
        return ["stable" if not b and a else "unstable" if b and not a else "neither" for a, b in pairwise(self.roots)]

    def stable(self, bottom: float, top: float) -> list[tuple[float, float]]:
        """Return the stable intervals between two ends; of those beyond an end the place of that end."""
        ends = [bottom, *np.clip(self.values, bottom, top), top]
        return [pair for pair, n in zip(pairwise(ends), self.roots, strict=False) if n == 0]


def partners(left: CriticalColumn, right: CriticalColumn) -> list[tuple[int, int]]:
    """Return which value of a place continues which value of the next: nearest neighbours of the same kind."""
    if left.values.size == right.values.size and left.kinds == right.kinds:
        return [(k, k) for k in range(left.values.size)]
    distance = np.abs(np.log(left.omega)[:, None] - np.log(right.omega)) + 0.2 * np.abs(
        np.log(left.values)[:, None] - np.log(right.values)
    )
    same = np.array(left.kinds, dtype=object)[:, None] == np.array(right.kinds, dtype=object)
    distance = np.where(same, distance, np.inf)
    if not distance.size:
        return []
    near_right, near_left = distance.argmin(axis=1), distance.argmin(axis=0)
    pairs = [(k, int(j)) for k, j in enumerate(near_right) if near_left[j] == k]
    return [pair for pair in pairs if np.isfinite(distance[pair])]


def curves(x: Float, columns: list[CriticalColumn], bottom: float, top: float) -> dict[str, list[Points]]:
    """Return the pieces of the curves, by what the bogie becomes above them.

    Between two places a curve may turn back, or leave through the bottom or the top: its end is drawn half way.
    """
    out: dict[str, list[Points]] = {kind: [] for kind in KINDS}
    for (x_1, left), (x_2, right) in pairwise(zip(x, columns, strict=True)):
        pairs = partners(left, right)
        for k, j in pairs:
            out[left.kinds[k]].append([(x_1, left.values[k]), (x_2, right.values[j])])
        middle = (x_1 + x_2) / 2
        sides = ((x_1, left, right, {k for k, _ in pairs}), (x_2, right, left, {j for _, j in pairs}))
        for place, column, other, taken in sides:
            for k, end in _ends(column, other, taken, bottom, top):
                out[column.kinds[k]].append([(place, column.values[k]), (middle, end)])
    return out


def _ends(
    column: CriticalColumn, other: CriticalColumn, taken: set[int], bottom: float, top: float
) -> Iterator[tuple[int, float]]:
    """Yield the values that the other place does not continue, with where they go: to a neighbour or out of sight."""
    loose = [k for k in range(column.values.size) if k not in taken]
    folded = _folded(column, other, loose)
    for k in loose:
        if k in folded or k - 1 in folded:
            pair = column.values[[k, k + 1] if k in folded else [k - 1, k]]
            yield k, float(np.sqrt(pair.prod()))
        elif k == 0 and other.roots[0] == column.roots[1]:
            yield k, bottom
        elif k == column.values.size - 1 and other.roots[other.values.size] == column.roots[k]:
            yield k, top


def _folded(column: CriticalColumn, other: CriticalColumn, loose: list[int]) -> set[int]:
    """Return the values that turn back into the next one, each in one fold.

    First come those with the same count on both sides, which the other place has too.
    """
    kinds, roots, folded = column.kinds, column.roots, set[int]()
    able = [k for k in loose if k + 1 in loose and kinds[k] != kinds[k + 1]]
    for k in sorted(able, key=lambda k: (roots[k] != roots[k + 2], roots[k] not in other.roots)):
        if not {k - 1, k, k + 1} & folded:
            folded.add(k)
    return folded


def stable_areas(x: Float, columns: list[CriticalColumn], bottom: float, top: float) -> Iterator[Points]:
    """Yield polygons that cover what is stable."""
    for (x_1, left), (x_2, right) in pairwise(zip(x, columns, strict=True)):
        if left.kinds == right.kinds and np.array_equal(left.roots, right.roots):
            for (a, b), (c, d) in zip(left.stable(bottom, top), right.stable(bottom, top), strict=False):
                yield [(x_1, a), (x_2, c), (x_2, d), (x_1, b)]
            continue
        middle = (x_1 + x_2) / 2
        for start, stop, column in ((x_1, middle, left), (middle, x_2, right)):
            yield from ([(start, a), (stop, a), (stop, b), (start, b)] for a, b in column.stable(bottom, top))

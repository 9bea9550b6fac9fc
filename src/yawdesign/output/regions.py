"""Areas of one kind on a grid, and the lines between them: through where the kind changes between two points.

The points are never on the wrong side of a line: between two points of different kinds it passes through the one place
that is known to lie between them.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Float

if TYPE_CHECKING:
    from matplotlib.path import Path

Point = tuple[float, float]
Line = list[Point]

FEWEST_JOINED = 3  # lines that meet inside a cell, in its middle


class Regions:
    """The areas of each kind of a grid.

    Parameters
    ----------
    x, y : ndarray, shapes (n,), (m,)
        Where the points of the grid are.
    kinds : ndarray of int, shape (m, n)
        What each point is.
    across, upright : ndarray, shapes (m, n - 1), (m - 1, n)
        At which x the kind changes between a point and the next one in its row, at which y in its column; half way
        where that is NaN.
    """

    def __init__(self, x: Float, y: Float, kinds: NDArray[np.int8], across: Float, upright: Float) -> None:
        self.x, self.y, self.kinds = x, y, kinds
        self.across = np.where(np.isfinite(across), across, (x[:-1] + x[1:]) / 2)
        self.upright = np.where(np.isfinite(upright), upright, ((y[:-1] + y[1:]) / 2)[:, None])
        self.inside: dict[int, list[tuple[Line, frozenset[int]]]] = {}  # with what else there is in the cell
        for kind, line, beside in self._lines_inside():
            self.inside.setdefault(kind, []).append((line, beside))

    def found(self) -> list[int]:
        """Return the kinds that there are, the smallest number first."""
        return [int(kind) for kind in np.unique(self.kinds)]

    def lines(self, kind: int, without: int | None = None) -> list[Line]:
        """Return the lines that bound what is of one kind, without the frame of the picture and one other kind."""
        return chained([line for line, beside in self.inside.get(kind, []) if without not in beside])

    def outline(self, kind: int) -> "Path":
        """Return the area of one kind as one path, to be filled."""
        from matplotlib.path import Path

        frame = [line for mine, line in self._frame() if mine == kind]
        loops = chained([*(line for line, _ in self.inside.get(kind, [])), *frame])
        return Path.make_compound_path(*(Path(np.array([*loop, loop[0]]), closed=True) for loop in loops))

    def _lines_inside(self) -> Iterator[tuple[int, Line, frozenset[int]]]:
        """Yield the pieces inside the cells whose corners differ, with the kind on their left and the others."""
        k = self.kinds
        mixed = (k[:-1, :-1] != k[:-1, 1:]) | (k[1:, :-1] != k[1:, 1:]) | (k[:-1, :-1] != k[1:, :-1])
        for j, i in zip(*np.nonzero(mixed), strict=True):
            corners = [k[j, i], k[j, i + 1], k[j + 1, i + 1], k[j + 1, i]]  # counterclockwise
            sides = (
                (self.across[j, i], self.y[j]),
                (self.x[i + 1], self.upright[j, i + 1]),
                (self.across[j + 1, i], self.y[j + 1]),
                (self.x[i], self.upright[j, i]),
            )
            changes = [n for n in range(4) if corners[n] != corners[(n + 1) % 4]]
            places = [(float(sides[n][0]), float(sides[n][1])) for n in changes]
            middle = [tuple(np.mean(places, axis=0).tolist())] if len(places) >= FEWEST_JOINED else []
            for before, (n, here) in zip([places[-1], *places], zip(changes, places, strict=True), strict=False):
                beside = frozenset(int(kind) for kind in corners if kind != corners[n])
                yield int(corners[n]), [here, *middle, before], beside

    def _frame(self) -> Iterator[tuple[int, Line]]:
        """Yield the pieces of the frame, counterclockwise, each with its kind."""
        rows, columns = self.kinds.shape
        walk = [(0, i) for i in range(columns)] + [(j, columns - 1) for j in range(1, rows)]
        walk += [(rows - 1, i) for i in range(columns - 2, -1, -1)] + [(j, 0) for j in range(rows - 2, -1, -1)]
        for one, two in pairwise(walk):
            start, stop = self._point(one), self._point(two)
            if self.kinds[one] == self.kinds[two]:
                yield int(self.kinds[one]), [start, stop]
            else:
                j, i = min(one[0], two[0]), min(one[1], two[1])
                same_row = one[0] == two[0]
                change = (float(self.across[j, i]), start[1]) if same_row else (start[0], float(self.upright[j, i]))
                yield int(self.kinds[one]), [start, change]
                yield int(self.kinds[two]), [change, stop]

    def _point(self, place: tuple[int, int]) -> Point:
        return float(self.x[place[1]]), float(self.y[place[0]])


def chained(pieces: list[Line]) -> list[Line]:
    """Return pieces joined end to start; those that begin at no end come first, closed loops after them."""
    starts: dict[Point, list[Line]] = {}
    for piece in pieces:
        starts.setdefault(piece[0], []).append(piece)
    ends = {piece[-1] for piece in pieces}
    out = []
    for first in [point for point in starts if point not in ends] + list(starts):
        while starts[first]:
            line = list(starts[first].pop())
            while starts.get(line[-1]):
                line += starts[line[-1]].pop()[1:]
            out.append(line)
    return out

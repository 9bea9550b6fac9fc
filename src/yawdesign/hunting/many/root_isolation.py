"""All positive roots of many polynomials at once, each in an interval of its own.

On an interval a polynomial is written in Bernstein's basis: where the coefficients do not change their sign there is
no root, where they change it once there is exactly one (Descartes), and elsewhere the interval is halved. A coefficient
within the rounding of the polynomial has no sign: its interval is halved too, until it is one that has one. What stays
open, such as two roots closer than rounding tells from none, is left undecided: no root is missed or taken for two.
"""

from functools import lru_cache
from math import comb
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Float

CELLS = 28
RANGE = (1e-4, 1e4)  # of the variable, in cells spaced geometrically; two more cells reach from zero and to infinity
HALVINGS = 30
MOST = 32  # open intervals of a polynomial: where more are open it is lost in rounding, and given up
BLOCK = 1024  # polynomials
ROUNDING = 3e-13  # of a value of the polynomial, relative to the size of what it is the sum of


class Sizes(Protocol):
    """Sums of the magnitudes of what the values of the polynomials are made of; they rise with x."""

    def at(self, owner: NDArray[np.intp], x: Float) -> Float:
        """Return the size of some polynomials, each at a place of its own."""

    def table(self, some: slice, x: Float) -> Float:
        """Return the sizes of some polynomials at all places, shape (places, polynomials)."""


class Isolated(NamedTuple):
    """Intervals with exactly one root each, in no order.

    Parameters
    ----------
    owner : array of int
        Which polynomial the root belongs to.
    low, high : array
        Ends of the interval.
    undecided : array of bool
        For every polynomial, whether some interval was still undecided after the last halving.
    """

    owner: NDArray[np.intp]
    low: Float
    high: Float
    undecided: NDArray[np.bool_]


def isolate(F: Float, sizes: Sizes) -> Isolated:
    """Return intervals around all positive roots.

    Parameters
    ----------
    F : array, shape (degree + 1, n)
        Coefficients of n polynomials, lowest power first.
    sizes : Sizes
        The polynomials are known to within `ROUNDING` of them.
    """
    n = F.shape[1]
    parts = [_isolate(F[:, k : k + BLOCK], sizes, k) for k in range(0, n, BLOCK)]
    owner, low, high, undecided = (np.concatenate([part[k] for part in parts]) for k in range(4))
    flags = np.zeros(n, dtype=bool)
    flags[undecided] = True
    return Isolated(owner, low, high, flags)


def _isolate(F: Float, sizes: Sizes, offset: int) -> tuple[Any, Float, Float, Any]:
    order, n = F.shape
    basis, low, high, inverse = _cells(order)
    cells = _Cells(low, high, inverse, order - 1, offset, sizes)
    coefficients = (basis @ F).reshape(order, len(low), n)
    # The value at an edge is rounded in two ways; both cells must see the same sign, or a root there counts twice.
    coefficients[0, 1:-1] = coefficients[-1, :-2]
    coefficients[-1, -1] = np.copysign(coefficients[-1, -1], coefficients[-1, -2])
    rounding = cells.rounding_at_first(n)
    changes, certain = _sign_changes(coefficients, rounding)
    cell, owner = np.nonzero((changes > 0) | ~certain)
    state: list[Any] = [owner, cell, np.zeros(len(cell)), np.ones(len(cell)), rounding[cell, owner]]
    state.append(coefficients[:, cell, owner])
    done, state = _sorted_out(state, changes[cell, owner], certain[cell, owner])
    pieces, given_up = [done], []
    for _ in range(HALVINGS):
        crowded = np.bincount(state[0], minlength=n) > MOST
        given_up.append(np.flatnonzero(crowded))
        state = [x[..., ~crowded[state[0]]] for x in state]
        if not len(state[0]):
            break
        state = _halved(state)
        done, state = _sorted_out(state, *_judged(state, cells))
        pieces.append(done)
    owner, cell, left, right = (np.concatenate([piece[k] for piece in pieces]) for k in range(4))
    start, end = cells.ends(cell, left, right)
    return owner + offset, start, np.minimum(end, _farthest(F)[owner]), np.concatenate([state[0], *given_up]) + offset


class _Cells(NamedTuple):
    """The cells, for some polynomials of a degree that begin at an offset."""

    low: Float
    high: Float
    inverse: NDArray[np.bool_]
    degree: int
    offset: int
    sizes: Sizes

    def rounding_at_first(self, n: int) -> Float:
        """Return what of a Bernstein coefficient may be rounding, for all cells and polynomials."""
        x, factor = self._largest(np.arange(len(self.low)), self.high)
        return factor[:, None] * self.sizes.table(slice(self.offset, self.offset + n), x)

    def rounding(self, cell: NDArray[np.intp], owner: NDArray[np.intp], right: Float) -> Float:
        """Return the same on parts of cells that reach up to `right` of their width."""
        x, factor = self._largest(cell, self.low[cell] + right * (self.high - self.low)[cell])
        return factor * self.sizes.at(owner + self.offset, x)

    def _largest(self, cell: NDArray[np.intp], end: Float) -> tuple[Float, Float]:
        """Return where the size is largest on a part of a cell, and by what it is to be multiplied there.

        In the cell that reaches to infinity the polynomial is taken in 1/x, and its size is largest at the near end.
        """
        turned = self.inverse[cell]
        with np.errstate(divide="ignore"):
            return np.where(turned, 1 / end, end), ROUNDING * np.where(turned, end**self.degree, 1.0)

    def ends(self, cell: Any, left: Float, right: Float) -> tuple[Float, Float]:
        """Return the ends of parts of cells."""
        low, width = self.low[cell], (self.high - self.low)[cell]
        ends, turned = (low + left * width, low + right * width), self.inverse[cell]
        with np.errstate(divide="ignore"):
            return np.where(turned, 1 / ends[1], ends[0]), np.where(turned, 1 / ends[0], ends[1])


def _farthest(F: Float) -> Float:
    """Return Fujiwara's bound on the magnitude of all roots."""
    with np.errstate(all="ignore"):
        logarithms = np.log(np.abs(F[:-1] / F[-1])) / np.arange(len(F) - 1, 0, -1)[:, None]
    return np.asarray(2 * np.exp(np.minimum(np.max(logarithms, axis=0), 300.0)))


def _judged(state: list[Any], cells: "_Cells") -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """Return the sign changes in intervals, and whether every coefficient is large enough to have a sign.

    The rounding of an interval itself is computed only where that of a larger one leaves a sign open.
    """
    owner, cell, _, right, rounding, b = state
    changes, certain = _sign_changes(b, rounding)
    open_ = np.flatnonzero(~certain)
    if len(open_):
        rounding[open_] = cells.rounding(cell[open_], owner[open_], right[open_])
        changes[open_], certain[open_] = _sign_changes(b[:, open_], rounding[open_])
    return changes, certain


def _sorted_out(
    state: list[Any], changes: NDArray[np.uint8], certain: NDArray[np.bool_]
) -> tuple[list[Any], list[Any]]:
    """Return the intervals with one root, and those that may have more."""
    one, more = certain & (changes == 1), ~certain | (changes > 1)
    return [x[one] for x in state[:4]], [x[..., more] for x in state]


def _halved(state: list[Any]) -> list[Any]:
    """Return both halves of all intervals (de Casteljau)."""
    owner, cell, left, right, rounding, b = state
    middle = (left + right) / 2
    first, last, b = np.empty_like(b), np.empty_like(b), b.copy()
    for k in range(len(b)):
        first[k], last[-1 - k] = b[0], b[-1]
        b = (b[1:] + b[:-1]) / 2
    whole = np.concatenate([first, last], axis=1)
    first_half, second_half = (owner, cell, left, middle, rounding), (owner, cell, middle, right, rounding)
    return [*map(np.concatenate, zip(first_half, second_half, strict=True)), whole]


def _sign_changes(coefficients: Float, rounding: Float) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """Return the number of sign changes, and whether every coefficient is large enough to have a sign."""
    negative = coefficients < -rounding
    certain = np.all(negative == (coefficients < rounding), axis=0)
    return np.sum(negative[1:] != negative[:-1], axis=0, dtype=np.uint8), certain


@lru_cache
def _cells(size: int) -> tuple[Float, Float, Float, NDArray[np.bool_]]:
    """Return the matrix from powers to Bernstein coefficients on every cell, the cells' ends, and which are in 1/x."""
    edges = np.geomspace(*RANGE, CELLS + 1)
    low, high = [0.0, *edges[:-1], 0.0], [*edges, 1 / edges[-1]]
    inverse = np.array([False] * (CELLS + 1) + [True])
    matrices = [_to_bernstein(size, a, b) for a, b in zip(low, high, strict=True)]
    matrices[-1] = matrices[-1][:, ::-1]
    return np.stack(matrices, axis=1).reshape(-1, size), np.array(low), np.array(high), inverse


def _to_bernstein(size: int, low: float, high: float) -> Float:
    """Return the matrix from coefficients of powers of x to those of Bernstein's basis on (low, high)."""
    degree = size - 1
    shifted = np.array([[comb(k, i) * low ** (k - i) if k >= i else 0.0 for k in range(size)] for i in range(size)])
    shifted *= (high - low) ** np.arange(size)[:, None]
    mixed = np.array([[comb(j, i) / comb(degree, i) for i in range(size)] for j in range(size)])
    return np.asarray(mixed @ shifted)

"""All positive roots of many polynomials at once, each in an interval of its own.

On an interval a polynomial is written in Bernstein's basis: where the coefficients do not change their sign there is
no root, where they change it once there is exactly one (Descartes), and elsewhere the interval is halved. So no root is
missed or taken for two, however close it lies to others, down to rounding.
"""

from functools import lru_cache
from math import comb
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

CELLS = 40
RANGE = (1e-4, 1e4)  # of the variable, in cells spaced geometrically; two more cells reach from zero and to infinity
HALVINGS = 30
BLOCK = 1024  # polynomials


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


def isolate(F: Float) -> Isolated:
    """Return intervals around all positive roots.

    Parameters
    ----------
    F : array, shape (degree + 1, n)
        Coefficients of n polynomials, lowest power first.
    """
    n = F.shape[1]
    parts = [_isolate(F[:, k : k + BLOCK], k) for k in range(0, n, BLOCK)]
    owner, low, high, undecided = (np.concatenate([part[k] for part in parts]) for k in range(4))
    flags = np.zeros(n, dtype=bool)
    flags[undecided] = True
    return Isolated(owner, low, high, flags)


def _isolate(F: Float, offset: int) -> tuple[Any, Float, Float, Any]:
    size, n = F.shape
    basis, low, high, inverse = _cells(size)
    coefficients = (basis @ F).reshape(size, len(low), n)
    # The value at an edge is rounded in two ways; both cells must see the same sign, or a root there counts twice.
    coefficients[0, 1:-1] = coefficients[-1, :-2]
    coefficients[-1, -1] = np.copysign(coefficients[-1, -1], coefficients[-1, -2])
    changes = _sign_changes(coefficients)
    cell, owner = np.nonzero(changes)
    found = changes[cell, owner]
    state: list[Any] = [owner, cell, np.zeros(len(cell)), np.ones(len(cell)), coefficients[:, cell, owner]]
    done, state = _sorted_out(state, found)
    pieces = [done]
    for _ in range(HALVINGS):
        if not len(state[0]):
            break
        state, found = _halved(state)
        done, state = _sorted_out(state, found)
        pieces.append(done)
    owner, cell, left, right = (np.concatenate([piece[k] for piece in pieces]) for k in range(4))
    width = high[cell] - low[cell]
    ends = low[cell] + left * width, low[cell] + right * width
    turned = inverse[cell]
    with np.errstate(divide="ignore"):
        start, end = np.where(turned, 1 / ends[1], ends[0]), np.where(turned, 1 / ends[0], ends[1])
    return owner + offset, start, np.minimum(end, _farthest(F)[owner]), state[0] + offset


def _farthest(F: Float) -> Float:
    """Return Fujiwara's bound on the magnitude of all roots."""
    with np.errstate(all="ignore"):
        logarithms = np.log(np.abs(F[:-1] / F[-1])) / np.arange(len(F) - 1, 0, -1)[:, None]
    return np.asarray(2 * np.exp(np.minimum(np.max(logarithms, axis=0), 300.0)))


def _sorted_out(state: list[Any], changes: NDArray[np.uint8]) -> tuple[list[Any], list[Any]]:
    """Return the intervals with one root, and those that may have more."""
    one, more = changes == 1, changes > 1
    return [x[one] for x in state[:4]], [x[..., more] for x in state]


def _halved(state: list[Any]) -> tuple[list[Any], NDArray[np.uint8]]:
    """Return both halves of all intervals (de Casteljau), and the sign changes in them."""
    owner, cell, left, right, b = state
    middle = (left + right) / 2
    first, last, b = np.empty_like(b), np.empty_like(b), b.copy()
    for k in range(len(b)):
        first[k], last[-1 - k] = b[0], b[-1]
        b = (b[1:] + b[:-1]) / 2
    whole = np.concatenate([first, last], axis=1)
    halves = [np.concatenate([x, y]) for x, y in ((owner, owner), (cell, cell), (left, middle), (middle, right))]
    return [*halves, whole], _sign_changes(whole)


def _sign_changes(coefficients: Float) -> NDArray[np.uint8]:
    negative = coefficients < 0
    return np.asarray(np.sum(negative[1:] != negative[:-1], axis=0, dtype=np.uint8))


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

"""All critical values of the yaw damping at many points at once, each checked.

The same mathematics as in :mod:`yawdesign.stability.critical`, on arrays: the roots of ``E_B O_A - E_A O_B`` are
isolated, refined on A and B themselves, and the unstable roots of the bogie are counted in every interval of C_s. A
point passes if every root's residual is small, no count is doubtful, and every count differs from the one before by
what the crossing root's velocity says. What fails is recomputed the thorough way.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from yawdesign.stability.critical import TIGHT, CriticalDamping, even_odd
from yawdesign.stability.routh import TIME_UNIT
from yawdesign.study import kernels
from yawdesign.study.block import Block
from yawdesign.study.isolation import isolate

Float = NDArray[np.float64]

CONVERGED = 1e-10  # relative length of the last step; Newton's method has then squared its error
ITERATIONS = 100


@dataclass(frozen=True)
class CriticalField:
    """Critical values of many points.

    Parameters
    ----------
    critical, omega : array, shape (n, m)
        C_s [N s/m] in rising order, and angular frequency [rad/s]; filled up with NaN.
    unstable_roots : array, shape (n, m + 1)
        Number of roots in the right half-plane in every interval between them; filled up with NaN.
    passed : array of bool, shape (n,)
        Whether all checks agree.
    """

    critical: Float
    omega: Float
    unstable_roots: Float
    passed: NDArray[np.bool_]

    def with_rows(self, rows: Mapping[int, CriticalDamping]) -> "CriticalField":
        """Return the field with the critical values of some points replaced."""
        least = max(self.critical.shape[1], *(len(sets.critical) for sets in rows.values()))
        critical, omega = (_widened(x, least) for x in (self.critical, self.omega))
        unstable = _widened(self.unstable_roots, least + 1)
        for k, sets in rows.items():
            _fill(critical[k], [x.C_s for x in sets.critical])
            _fill(omega[k], [x.omega for x in sets.critical])
            _fill(unstable[k], sets.unstable_roots)
        return CriticalField(critical, omega, unstable, self.passed)


def _widened(rows: Float, width: int) -> Float:
    return np.pad(rows, ((0, 0), (0, width - rows.shape[1])), constant_values=np.nan)


def _fill(row: Float, values: Sequence[float]) -> None:
    row[:] = np.nan
    row[: len(values)] = values


class _Parts(NamedTuple):
    """Even and odd parts in x = w^2 of A and of B, coefficients along the first axis."""

    even_a: Float
    odd_a: Float
    even_b: Float
    odd_b: Float

    def of(self, owner: NDArray[np.intp]) -> "_Parts":
        return _Parts(*(np.take(part, owner, axis=1) for part in self))


class _Crossings(NamedTuple):
    """Roots on the imaginary axis: whose they are, where, which way they go, and how exact they are."""

    owner: NDArray[np.intp]
    C_s: Float
    omega: Float
    direction: Float
    residual: Float


def critical_field(block: Block, *, kind: str, equations: str) -> CriticalField:
    """Return the critical values at many points, without recomputing those that fail a check.

    Parameters
    ----------
    block : Block
        The points, with ``v``.
    kind, equations : str
        As in `yawdesign.bogie.vehicles.bogie`.
    """
    tape, (na, nb, _) = kernels.boundaries(kind, equations, block.zeros - {"C_s"})
    results = tape(block.values)
    A, B, F = results[:na], results[na : na + nb], results[na + nb :]
    n = results.shape[1]
    isolated = isolate(F)
    with np.errstate(all="ignore"):  # what overflows has no small residual, and fails
        found = _crossings(A, B, isolated.owner, isolated.low, isolated.high)
    rows = Rows(found.owner, found.C_s, n)
    critical, omega, direction, residual = map(rows.spread, found[1:])
    unstable, doubtful = _counted(A, B, critical, block.values["K_ds"])
    known = ~np.isnan(critical)
    steps = np.diff(unstable, axis=1)
    with np.errstate(invalid="ignore"):
        right = np.where(known, (steps == 2 * direction) & (residual < TIGHT), True).all(axis=1)
    return CriticalField(critical, omega, unstable, right & ~doubtful & ~isolated.undecided)


def _crossings(A: Float, B: Float, owner: NDArray[np.intp], low: Float, high: Float) -> _Crossings:
    parts = _Parts(*(np.array(half) for p in (A, B) for half in even_odd(tuple(p))))
    mine = parts.of(owner)
    x = _refined(mine, low, high)
    (ea, oa, eb, ob), (dea, doa, deb, dob) = _values(mine, x)
    C_s = -(ea * eb + x * oa * ob) / (eb * eb + x * ob * ob)
    keep = (C_s > 0) & np.isfinite(C_s)
    omega = np.sqrt(x)
    # P = A + C_s B on the axis, its derivative with respect to omega, and the velocity of its root.
    even, odd = dea + C_s * deb, doa + C_s * dob
    slope = 2 * omega * even + 1j * (oa + C_s * ob + 2 * x * odd)
    velocity = -1j * (eb + 1j * omega * ob) / slope
    error = np.hypot(ea + C_s * eb, omega * (oa + C_s * ob)) / _size(A, B, owner, C_s, omega)
    columns = (x[keep] for x in (C_s, omega * TIME_UNIT, np.sign(velocity.real), error))
    return _Crossings(owner[keep], *columns)


def _refined(parts: _Parts, low: Float, high: Float) -> Float:
    """Return the root of E_B O_A - E_A O_B in every interval by Newton's method, kept inside by halving."""
    rising = _function(parts, low)[0] < 0
    root = _middle(low, high)
    active, x = np.arange(len(root)), root
    for _ in range(ITERATIONS):
        value, slope = _function(parts, x)
        below = (value < 0) == rising
        low, high = np.where(below, x, low), np.where(below, high, x)
        new = x - value / slope
        new = np.where((new >= low) & (new <= high), new, _middle(low, high))
        moving = np.abs(new - x) > CONVERGED * new
        root[active] = x = new
        if 2 * np.count_nonzero(moving) < len(active):  # to carry the finished along costs less than to part them
            active, parts = active[moving], parts.of(np.flatnonzero(moving))
            x, low, high, rising = x[moving], low[moving], high[moving], rising[moving]
        if not len(active):
            break
    return root


def _middle(low: Float, high: Float) -> Float:
    """Return the geometric mean: an interval may reach over many powers of ten."""
    return np.where(low > 0, np.sqrt(low) * np.sqrt(high), high / 2)


def _function(parts: _Parts, x: Float) -> tuple[Float, Float]:
    (ea, oa, eb, ob), (dea, doa, deb, dob) = _values(parts, x)
    return eb * oa - ea * ob, deb * oa + eb * doa - dea * ob - ea * dob


def _values(parts: _Parts, x: Float) -> tuple[list[Float], list[Float]]:
    """Return the values of all parts, and their derivatives with respect to x."""
    values, slopes = zip(*(_horner(part, x) for part in parts), strict=True)
    return list(values), list(slopes)


def _horner(p: Float, x: Float) -> tuple[Float, Float]:
    value, slope = p[-1].copy(), np.zeros_like(x)
    for a in p[-2::-1]:
        slope *= x
        slope += value
        value *= x
        value += a
    return value, slope


def _size(A: Float, B: Float, owner: NDArray[np.intp], C_s: Float, omega: Float) -> Float:
    """Return the sum of the magnitudes of what A + C_s B is made of on the axis."""
    a, _ = _horner(np.abs(np.take(A, owner, axis=1)), omega)
    b, _ = _horner(np.abs(np.take(B, owner, axis=1)), omega)
    return np.asarray(a + np.abs(C_s) * b)


class Rows:
    """A table with a row for every point, filled from its left end with values in rising order.

    Parameters
    ----------
    owner : array of int
        To which point each value belongs.
    key : array
        By what the values of a point are ordered.
    n : int
        Number of points.
    """

    def __init__(self, owner: NDArray[np.intp], key: Float, n: int) -> None:
        self._order = np.lexsort((key, owner))
        self._owner = owner[self._order]
        self.count = np.bincount(owner, minlength=n)
        self._rank = np.arange(len(owner)) - np.repeat(np.cumsum(self.count) - self.count, self.count)

    def spread(self, column: Float) -> Float:
        """Return the table of a column; what is not there is NaN."""
        out = np.full((len(self.count), int(self.count.max(initial=0))), np.nan)
        out[self._owner, self._rank] = column[self._order]
        return out


def _counted(A: Float, B: Float, critical: Float, K_ds: Any) -> tuple[Float, NDArray[np.bool_]]:
    """Return the number of unstable roots in every interval of C_s, and where a count is doubtful."""
    n, m = critical.shape
    C_s = np.full((n, m + 1), np.nan)
    C_s[:, 1:] = 2 * critical
    C_s[:, 1:-1] = np.where(np.isnan(critical[:, 1:]), C_s[:, 1:-1], np.sqrt(critical[:, :-1] * critical[:, 1:]))
    C_s[:, 0] = np.broadcast_to(K_ds, n) / TIME_UNIT
    if m:
        C_s[:, 0] = np.where(np.isnan(critical[:, 0]), C_s[:, 0], critical[:, 0] / 2)
    row, column = np.nonzero(~np.isnan(C_s))
    size = max(len(A), len(B))
    core = np.zeros((size, len(row)))
    core[: len(A)] += np.take(A, row, axis=1)
    core[: len(B)] += C_s[row, column] * np.take(B, row, axis=1)
    count, doubts = kernels.counts(size)({f"a{k}": core[k] for k in range(size)})
    unstable = np.full((n, m + 1), np.nan)
    unstable[row, column] = count
    doubtful = np.zeros(n, dtype=bool)
    doubtful[row[doubts > 0]] = True
    return unstable, doubtful

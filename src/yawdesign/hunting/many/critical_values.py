"""All critical values of the yaw damping at many points at once, in double precision, each checked.

On the stability boundary A(j w) + C_s B(j w) = 0 with real w and C_s: the complex number -A/B is real and positive.
With x = w^2 and the polynomials split into even and odd parts, that happens at the positive roots of
``E_B O_A - E_A O_B`` where -E_A/E_B > 0. These roots are isolated, refined on A and B themselves, and the unstable
roots of the bogie are counted in every interval of C_s, in the first one towards 0 and in the last one towards
infinity. A point passes if no root may be missed, every value is known to eight digits, no count is doubtful, and every
count differs from the one before by what the crossing root's velocity says. What fails is computed with many digits.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Array, Bools, Float, Index
from yawdesign.hunting.exact import ExactValues, NotDecidedError, exact_critical_values
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.root_isolation import isolate
from yawdesign.hunting.receptance import Receptance
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.vehicle.polynomials import even_odd
from yawdesign.vehicle.vehicle import Vehicle

ACCURATE = 5e-9  # largest relative error of a critical value that rounding may cause
ROUNDING = 2e-15  # of the coefficients
FAR = 1e60  # from a damping whose joint relaxes at 100 rad/s to where 0 and infinity are looked at
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
        Number of roots in the right half-plane in every interval between them, from C_s towards 0 to C_s towards
        infinity; filled up with NaN.
    recomputed : array of bool, shape (n,)
        Whether double precision did not decide, and the values come from decimals of many digits.
    unverified : array of bool, shape (n,)
        Whether these did not decide either: the values are those of double precision and no verdict.
    """

    critical: Float
    omega: Float
    unstable_roots: Float
    recomputed: Bools
    unverified: Bools

    def values_at(self, k: int) -> tuple[list[float], list[float]]:
        """Return the critical values of a point, and their frequencies."""
        known = ~np.isnan(self.critical[k])
        return self.critical[k][known].tolist(), self.omega[k][known].tolist()

    def counts_at(self, k: int) -> tuple[int, ...]:
        """Return the number of unstable roots in every interval of a point."""
        row = self.unstable_roots[k]
        return tuple(int(count) for count in row[~np.isnan(row)])


def critical_field(sets: ParameterSets) -> CriticalField:
    """Return the critical values of many vehicles, computed with many digits where double precision does not decide.

    Parameters
    ----------
    sets : ParameterSets
        With ``v``; their own ``C_s`` is not looked at.
    """
    field, passed = in_double_precision(sets)
    failed = np.flatnonzero(~passed)
    return recomputed(field, sets, failed) if len(failed) else field


def recomputed(field: CriticalField, sets: ParameterSets, points: Iterable[int]) -> CriticalField:
    """Return the field with some of its points computed with many digits."""
    found = {k: _exact(sets.vehicle_at(k)) for k in points}
    least = max(field.critical.shape[1], *(len(x.critical) for x in found.values() if x), 0)
    critical, omega = (_widened(x, least) for x in (field.critical, field.omega))
    unstable = _widened(field.unstable_roots, least + 1)
    done, open_ = field.recomputed.copy(), field.unverified.copy()
    for k, values in found.items():
        done[k], open_[k] = True, values is None
        if values:
            _fill(critical[k], [C_s for C_s, _ in values.critical])
            _fill(omega[k], [w for _, w in values.critical])
            _fill(unstable[k], values.unstable_roots)
    return CriticalField(critical, omega, unstable, done, open_)


def _exact(vehicle: Vehicle) -> ExactValues | None:
    try:
        return exact_critical_values(vehicle)
    except NotDecidedError:
        return None


def _widened(rows: Float, width: int) -> Float:
    return np.pad(rows, ((0, 0), (0, width - rows.shape[1])), constant_values=np.nan)


def _fill(row: Float, values: Iterable[Any]) -> None:
    numbers = [float(x) for x in values]
    row[:] = np.nan
    row[: len(numbers)] = numbers


class _Parts(NamedTuple):
    """Even and odd parts in x = w^2 of A and of B, coefficients along the first axis."""

    even_a: Float
    odd_a: Float
    even_b: Float
    odd_b: Float

    def of(self, owner: Index) -> "_Parts":
        return _Parts(*(np.take(part, owner, axis=1) for part in self))


class _Sizes:
    """What the values of E_B O_A - E_A O_B are the sum of, in magnitude."""

    def __init__(self, A: Float, B: Float) -> None:
        self._parts = [np.abs(half) for p in (A, B) for half in (p[::2], p[1::2])]

    def at(self, owner: Index, x: Float) -> Float:
        """Return the size of some polynomials, each at a place of its own."""
        return self._product([_value(part[:, owner], x) for part in self._parts])

    def table(self, some: slice, x: Float) -> Float:
        """Return the sizes of some polynomials at all places, shape (places, polynomials)."""
        return self._product([np.vander(x, len(part), increasing=True) @ part[:, some] for part in self._parts])

    @staticmethod
    def _product(values: list[Float]) -> Float:
        even_a, odd_a, even_b, odd_b = values
        return even_b * odd_a + even_a * odd_b


class _Crossings(NamedTuple):
    """Roots on the imaginary axis: whose they are, where, which way they go, and their largest relative errors."""

    owner: Index
    C_s: Float
    omega: Float
    direction: Float
    error: Float


def in_double_precision(sets: ParameterSets) -> tuple[CriticalField, Bools]:
    """Return the critical values of many vehicles, and whether double precision decides them.

    Parameters
    ----------
    sets : ParameterSets
        With ``v``.
    """
    tape, (na, nb, _) = counts.boundaries(sets.model, sets.zeros - {"C_s"})
    results = tape(sets.values)
    A, B, F = results[:na], results[na : na + nb], results[na + nb :]
    n = results.shape[1]
    with np.errstate(all="ignore"):  # what overflows has no certain sign or no small error, and fails
        isolated = isolate(F, _Sizes(A, B))
        x = _refined(np.take(F, isolated.owner, axis=1), isolated.low, isolated.high)
        found = _crossings(A, B, isolated.owner, x)
    rows = Rows(found.owner, found.C_s, n)
    critical, omega, direction, error = map(rows.spread, found[1:])
    unstable, doubtful = _counted(A, B, critical, _natural(sets))
    known = ~np.isnan(critical)
    steps = np.diff(unstable, axis=1)
    with np.errstate(invalid="ignore"):
        right = np.where(known, (steps == 2 * direction) & (error < ACCURATE), True).all(axis=1)
    none = np.zeros(n, dtype=bool)
    return CriticalField(critical, omega, unstable, none, none), right & ~doubtful & ~isolated.undecided


def _crossings(A: Float, B: Float, owner: Index, x: Float) -> _Crossings:
    """Return what belongs to the roots x = w^2 whose damping is positive."""
    parts = _Parts(*(np.array(half) for p in (A, B) for half in even_odd(tuple(p)))).of(owner)
    ea, oa, eb, ob = (_value(part, x) for part in parts)
    C_s = _damping(ea, oa, eb, ob, x)
    keep = np.flatnonzero((C_s > 0) & np.isfinite(C_s))
    parts = parts.of(keep)
    owner, x, before = owner[keep], x[keep], C_s[keep]
    (ea, oa, eb, ob), (dea, doa, deb, dob) = zip(*(value_and_slope(part, x) for part in parts), strict=True)
    # One step on A and B themselves: the product of both has lost digits that they have.
    x = x - (eb * oa - ea * ob) / (deb * oa + eb * doa - dea * ob - ea * dob)
    ea, oa, eb, ob = (_value(part, x) for part in parts)
    C_s = _damping(ea, oa, eb, ob, x)
    lost = ~((C_s > 0) & np.isfinite(C_s))
    C_s = np.where(lost, before, C_s)
    omega = np.sqrt(x)
    # P = A + C_s B on the axis, its derivative with respect to omega, and the velocity of its root.
    even, odd = dea + C_s * deb, doa + C_s * dob
    slope = 2 * omega * even + 1j * (oa + C_s * ob + 2 * x * odd)
    pull = eb + 1j * omega * ob
    velocity = -1j * pull / slope
    # What is off by r on the axis is made up for by a C_s that is off by dC_s: pull dC_s + slope dw = -r.
    largest_ea, largest_oa, largest_eb, largest_ob = (_value(np.abs(part), x) for part in parts)
    size = largest_ea + omega * largest_oa + C_s * (largest_eb + omega * largest_ob)
    residual = np.hypot(ea + C_s * eb, omega * (oa + C_s * ob))
    error = (residual + ROUNDING * size) * np.abs(slope) / (C_s * np.abs((pull * np.conj(slope)).imag))
    return _Crossings(owner, C_s, omega * TIME_UNIT, np.sign(velocity.real), np.where(lost, np.inf, error))


def _damping(ea: Float, oa: Float, eb: Float, ob: Float, x: Float) -> Float:
    """Return the C_s at which A + C_s B is smallest on the axis: zero at a crossing."""
    return -(ea * eb + x * oa * ob) / (eb * eb + x * ob * ob)


def _refined(F: Float, low: Float, high: Float) -> Float:
    """Return the root of each polynomial in its interval by Newton's method, kept inside by halving."""
    rising = _value(F, low) < 0
    root = _middle(low, high)
    active, x = np.arange(len(root)), root
    for _ in range(ITERATIONS):
        value, slope = value_and_slope(F, x)
        below = (value < 0) == rising
        low, high = np.where(below, x, low), np.where(below, high, x)
        new = x - value / slope
        new = np.where((new >= low) & (new <= high), new, _middle(low, high))
        moving = np.abs(new - x) > CONVERGED * new
        root[active] = x = new
        if 2 * np.count_nonzero(moving) < len(active):  # to carry the finished along costs less than to part them
            active, F = active[moving], F[:, moving]
            x, low, high, rising = x[moving], low[moving], high[moving], rising[moving]
        if not len(active):
            break
    return root


def _middle(low: Float, high: Float) -> Float:
    """Return the geometric mean: an interval may reach over many powers of ten."""
    return np.where(low > 0, np.sqrt(low) * np.sqrt(high), high / 2)


def _value(p: Float, x: Float) -> Float:
    value: Float = p[-1].copy()
    for a in p[-2::-1]:
        value *= x
        value += a
    return value


def value_and_slope(p: Float, x: Array) -> tuple[Array, Array]:
    """Return values and derivatives of many polynomials, lowest power first, each at a real or complex place."""
    value, slope = p[-1].astype(x.dtype), np.zeros_like(x)
    for a in p[-2::-1]:
        slope *= x
        slope += value
        value *= x
        value += a
    return value, slope


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

    def __init__(self, owner: Index, key: Float, n: int) -> None:
        self._order = np.lexsort((key, owner))
        self._owner = owner[self._order]
        self.count = np.bincount(owner, minlength=n)
        self._rank = np.arange(len(owner)) - np.repeat(np.cumsum(self.count) - self.count, self.count)

    def spread(self, column: Float) -> Float:
        """Return the table of a column; what is not there is NaN."""
        out = np.full((len(self.count), int(self.count.max(initial=0))), np.nan)
        out[self._owner, self._rank] = column[self._order]
        return out


def _natural(sets: ParameterSets) -> Float:
    """Return the C_s whose joint relaxes at 100 rad/s; for a rigid joint one of the vehicle's size."""
    joint = sets.model.joints.get("C_s")
    if joint is None:
        return Receptance(sets.vehicle).natural(sets.size)
    return np.broadcast_to(sets.values[joint], sets.size) / TIME_UNIT


def _counted(A: Float, B: Float, critical: Float, natural: Float) -> tuple[Float, Bools]:
    """Return the number of unstable roots in every interval of C_s, and where a count is doubtful."""
    n, m = critical.shape
    C_s = np.full((n, m + 1), np.nan)
    # Each value's upper neighbour; beyond the last one infinity.
    upper = np.concatenate([critical[:, 1:], np.full((n, 1), np.nan)], axis=1)[:, :m]
    C_s[:, 1:] = np.where(np.isnan(upper), FAR * natural[:, None], np.sqrt(critical) * np.sqrt(upper))
    C_s[:, 1:][np.isnan(critical)] = np.nan
    C_s[:, 0] = natural / FAR
    row, column = np.nonzero(~np.isnan(C_s))
    size = max(len(A), len(B))
    core = np.zeros((size, len(row)))
    core[: len(A)] += np.take(A, row, axis=1)
    core[: len(B)] += C_s[row, column] * np.take(B, row, axis=1)
    count, doubts = counts.counts(size)({f"a{k}": core[k] for k in range(size)})
    unstable = np.full((n, m + 1), np.nan)
    unstable[row, column] = count
    doubtful = np.zeros(n, dtype=bool)
    doubtful[row[doubts > 0]] = True
    return unstable, doubtful

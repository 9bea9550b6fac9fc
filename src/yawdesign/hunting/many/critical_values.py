"""All critical values of the yaw damping at many points at once, in double precision, each checked.

On the stability boundary A(j w) + C_s B(j w) = 0 with real w and C_s: the complex number -A/B is real and positive.
With x = w^2 and the polynomials split into even and odd parts, that happens at the positive roots of
``E_B O_A - E_A O_B`` where -E_A/E_B > 0. These roots are isolated, refined on A and B themselves, and the unstable
roots of the bogie are counted in every interval of C_s, in the first one towards 0 and in the last one towards
infinity. A point passes if no root may be missed, every value is known to eight digits, no count is doubtful, and every
count differs from the one before by what the crossing root's velocity says. What fails is computed with many digits.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Array, Bools, Float, Index
from yawdesign.hunting.exact import ExactValues, NotDecidedError, exact_critical_values
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.critical_table import CriticalField, Rows, counted, natural_damping
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.root_isolation import isolate
from yawdesign.hunting.many.vehicle_branches import followed_branches
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.vehicle_values import VehicleValues, vehicle_values
from yawdesign.vehicle.polynomials import even_odd
from yawdesign.vehicle.vehicle import Vehicle

ACCURATE = 5e-9  # largest relative error of a critical value that rounding may cause
ROUNDING = 2e-15  # of the coefficients
CONVERGED = 1e-10  # relative length of the last step; Newton's method has then squared its error
ITERATIONS = 100


def critical_field(sets: ParameterSets) -> CriticalField:
    """Return the critical values of many vehicles, one by one and with many digits where this way does not decide.

    Parameters
    ----------
    sets : ParameterSets
        With ``v``; their own ``C_s`` is not looked at.
    """
    field, passed = (in_double_precision if _is_linear(sets) else followed_branches)(sets)
    failed = np.flatnonzero(~passed)
    return recomputed(field, sets, failed) if len(failed) else field


def _is_linear(sets: ParameterSets) -> bool:
    """Return whether the polynomial is linear in C_s: there is one link of yaw dampers."""
    return sets.model.motions[0].dampers == 1


def recomputed(field: CriticalField, sets: ParameterSets, points: Iterable[int]) -> CriticalField:
    """Return the field with some of its points computed by themselves, with many digits where there is need."""
    one = _exact if _is_linear(sets) else _one
    found = {k: one(sets.vehicle_at(k)) for k in points}
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


def _one(vehicle: Vehicle) -> VehicleValues | None:
    found = vehicle_values(vehicle)
    return found if found.decided else None


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
    unstable, doubtful = counted((A, B), critical, natural_damping(sets))
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

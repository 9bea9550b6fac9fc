"""All critical values of a vehicle with several links of yaw dampers, by three routes that check each other.

The state matrix gives every C_s at which two eigenvalues are opposite to each other; from there the receptance at the
yaw dampers leads to the roots on the imaginary axis, to the last digits; and eigenvalues and Routh's array of the
polynomial count the unstable roots between the values. Every count must differ from the one before by what the roots
that cross there say.
"""

from collections.abc import Sequence
from functools import reduce
from itertools import groupby, pairwise
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float
from yawdesign.hunting.eigenvalues import count_undamped, motion_eigenvalues, polished
from yawdesign.hunting.exact import NotDecidedError, exact_critical_values
from yawdesign.hunting.opposite_eigenvalues import opposite_eigenvalues
from yawdesign.hunting.receptance import Receptance
from yawdesign.hunting.routh import count_unstable
from yawdesign.vehicle.polynomials import Polynomial, add, scale
from yawdesign.vehicle.vehicle import Vehicle

ON_AXIS = 1e-3  # largest |Re s| / |s| of a root that is looked at: values that nearly coincide are known to few digits
REACH = 1e12  # from a damping natural to the vehicle to the farthest that double precision is asked for
FAR = 1e60  # and to where 0 and infinity are looked at
SAME = 1e-8  # relative difference of C_s and omega of what was found twice
APART = 1e-6  # relative difference of two values between which roots are counted
SLOWEST = 1e-9  # of the fastest eigenvalue: where one is slower, pairs of values have been missed
REFINED = 1e-10  # -Re s / |s| with which a polished root counts as stable

Value = tuple[float, float, float]  # C_s, omega, direction


class VehicleValues(NamedTuple):
    """Critical values and the unstable roots between them.

    Parameters
    ----------
    critical : tuple of (C_s, omega)
        Damping of the pair of yaw dampers [N s/m], in rising order, and angular frequency [rad/s].
    unstable_roots : tuple of int
        From C_s towards 0 to C_s towards infinity.
    decided : bool
        Whether all counts agree; otherwise they are no verdict.
    """

    critical: tuple[tuple[float, float], ...]
    unstable_roots: tuple[int, ...]
    decided: bool


def vehicle_values(vehicle: Vehicle) -> VehicleValues:
    """Return all critical values of the yaw damping, computed with many digits where double precision does not decide.

    Parameters
    ----------
    vehicle : Vehicle
        Its numbers are floats; its own C_s is not looked at.
    """
    found = in_double_precision(vehicle)
    if found.decided:
        return found
    try:
        exact = exact_critical_values(vehicle)
    except NotDecidedError:
        return found
    return VehicleValues(tuple((float(x), float(w)) for x, w in exact.critical), exact.unstable_roots, True)


def in_double_precision(vehicle: Vehicle) -> VehicleValues:
    """Return the critical values as double precision has them. Parameters as in `vehicle_values`."""
    receptance = Receptance(vehicle)
    if not receptance.size:
        routh, eigenvalues = count_unstable(vehicle.coupled.polynomial(0)), _unstable(vehicle, 0.0, 0)
        return VehicleValues((), (routh,), routh == eigenvalues)
    natural = float(receptance.natural()[0])
    zeros = _roots_at_zero(vehicle.coupled.coefficients)
    found = _found(vehicle, receptance, natural, zeros)
    resolved = _are_resolved(motion_eigenvalues(vehicle.replace(C_s=natural), vehicle.model.motions[0]), zeros)
    groups = _groups(found)
    places = _places([[x for x, _, _ in group] for group in groups], natural)
    measured = [_unstable(vehicle, C_s, zeros) for C_s in places]
    ends = [count_unstable(_at(vehicle, C_s)) for C_s in (natural / FAR, natural * FAR)]
    decided = resolved and ends == [measured[0], measured[-1]] and None not in measured
    counts = [measured[0] or 0]
    for group, after in zip(groups, measured[1:], strict=True):
        steps = [int(2 * direction) for _, _, direction in group]
        decided &= len({*steps}) == 1 and counts[-1] + sum(steps) == after
        counts += [counts[-1] + sum(steps[: k + 1]) for k in range(len(steps))]
    return VehicleValues(tuple((C_s, w) for C_s, w, _ in found), tuple(counts), decided)


def _are_resolved(s: Complex, zeros: int) -> bool:
    """Return whether the slowest eigenvalue is not lost in the rounding of the fastest."""
    size = np.sort(np.abs(s))[zeros:]
    return bool(size[0] > SLOWEST * size[-1])


def _found(vehicle: Vehicle, receptance: Receptance, natural: float, zeros: int) -> list[Value]:
    """Return all roots on the imaginary axis, each once, in rising order of C_s."""
    near = opposite_eigenvalues(vehicle, natural, zeros)
    near = near[(near > natural / REACH) & (near < natural * REACH)]
    s = motion_eigenvalues(vehicle.replace(C_s=near), vehicle.model.motions[0]) if len(near) else np.zeros((0, 0))
    which, root = np.nonzero((s.imag > 0) & (np.abs(s.real) < ON_AXIS * np.abs(s)))
    first = receptance.followed((1 / near[which]).astype(complex), s.imag[which, root])
    C_s, omega = _different(first.C_s[first.found], first.omega[first.found])
    # What coincides there is as many roots as there are eigenvalues of M: each of them is followed by itself.
    values, _ = receptance.eigenvalues(omega)
    place, k = np.nonzero(np.abs(values * C_s[:, None] - 1) < APART)
    each = receptance.followed(values[place, k], omega[place])
    own = each.found & _same(each.C_s, C_s[place]) & _same(each.omega, omega[place])
    return sorted(zip(*(x[own].tolist() for x in each[:3]), strict=True))


def _different(C_s: Float, omega: Float) -> tuple[Float, Float]:
    """Return the places that are not the same as one before them."""
    same = _same(C_s[:, None], C_s) & _same(omega[:, None], omega)
    first = ~np.any(np.tril(same, -1), axis=1)
    return C_s[first], omega[first]


def _same(a: Float, b: Float) -> Bools:
    return np.asarray(np.abs(a - b) < SAME * b)


def _groups(rows: Sequence[Value]) -> list[list[Value]]:
    """Return the values in rising order, those in one group between which no roots can be counted."""
    apart: Any = np.cumsum([0, *(b[0] > a[0] * (1 + APART) for a, b in pairwise(rows))]) if rows else []
    return [[row for _, row in group] for _, group in groupby(zip(apart, rows, strict=True), key=lambda pair: pair[0])]


def _places(groups: Sequence[Sequence[float]], natural: float) -> list[float]:
    """Return one damping in every interval between groups of values."""
    if not groups:
        return [natural]
    between = [float(np.sqrt(a[-1] * b[0])) for a, b in pairwise(groups)]
    return [groups[0][0] / 2, *between, 2 * groups[-1][-1]]


def _unstable(vehicle: Vehicle, C_s: float, zeros: int) -> int | None:
    """Return the number of unstable roots where eigenvalues and Routh's array agree."""
    p = vehicle.coupled.polynomial(C_s)
    routh = count_unstable(p)
    s = motion_eigenvalues(vehicle.replace(C_s=C_s), vehicle.model.motions[0])
    s = s[np.argsort(np.abs(s))[zeros:]]
    if zeros + int(count_undamped(s)) == routh or zeros + _refined_count(p[zeros:], s) == routh:
        return routh
    return None


def _refined_count(p: Polynomial, s: Complex) -> int:
    """Return how many eigenvalues are not stable after Newton's method on the polynomial."""
    s = polished(p, s)
    return int(np.sum(s.real > -REFINED * np.abs(s)))


def _at(vehicle: Vehicle, C_s: float) -> Polynomial:
    """Return the polynomial at a damping near zero or infinity, scaled."""
    parts = vehicle.coupled.coefficients
    size = max(abs(a) * C_s**power for power, p in enumerate(parts) for a in p)
    return reduce(add, (scale(p, C_s**power / size) for power, p in enumerate(parts)))


def _roots_at_zero(coefficients: Sequence[Polynomial]) -> int:
    """Return how many roots are zero whatever C_s is."""
    return min(next((k for k, a in enumerate(p) if a != 0), len(p)) for p in coefficients if any(a != 0 for a in p))

"""All critical values of the yaw damping, and the intervals of stability between them.

On the stability boundary A(j w) + C_s B(j w) = 0 with real w and C_s: the complex number -A/B is real and positive.
With x = w^2 and the polynomials split into even and odd parts, that happens at the positive roots of
``E_B O_A - E_A O_B`` where -E_A/E_B > 0. The smallest critical value need not be the boundary of stability, and
stability may be lost again above another: eq. (11) of the paper and its "minimum positive real root" do not see that.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from yawdesign.bogie.characteristic import Characteristic, characteristic
from yawdesign.bogie.polynomials import Polynomial, add, evaluate, multiply, scale, scale_variable, trim
from yawdesign.bogie.vehicles import Parameters
from yawdesign.stability.graphs import polish
from yawdesign.stability.modes import backward_error, core_eigenvalues, count_undamped, roots
from yawdesign.stability.routh import TIME_UNIT, count_unstable

Float = NDArray[np.float64]
Interval = tuple[float, float]

# Frequencies at which the sign of the phase is looked at, beside the roots of the polynomial in w^2 [rad/s].
GRID = np.geomspace(1e-3, 1e6, 3001)
TIGHT = 1e-9  # largest backward error of a critical value that counts as checked


@dataclass(frozen=True)
class CriticalValue:
    """A yaw damping at which a pair of roots lies on the imaginary axis.

    Parameters
    ----------
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    omega : float
        Angular frequency of the motion at the boundary [rad/s].
    becomes : {"stable", "unstable", "neither"}
        What the bogie becomes when C_s grows through the value.
    residual : float
        Backward error of the characteristic polynomial at (C_s, j omega).
    """

    C_s: float
    omega: float
    becomes: str
    residual: float


@dataclass(frozen=True)
class CriticalDamping:
    """All critical values, and the stability between them.

    Parameters
    ----------
    critical : tuple of CriticalValue
        In ascending order of C_s.
    unstable_roots : tuple of int
        Number of roots of the coupled motion in the right half-plane, below the first critical value, between the
        first and the second, ..., above the last.
    checked : bool
        True if Routh's array and the eigenvalues give the same numbers in every interval, and each critical value
        changes them the way its root crosses the axis.
    """

    critical: tuple[CriticalValue, ...]
    unstable_roots: tuple[int, ...]
    checked: bool

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """The open intervals of C_s that `unstable_roots` counts; the last one has no end."""
        return tuple(pairwise([0.0, *(c.C_s for c in self.critical), np.inf]))

    @property
    def stable_intervals(self) -> tuple[Interval, ...]:
        """The open intervals of C_s in which the coupled motion is stable."""
        return tuple(i for i, n in zip(self.intervals, self.unstable_roots, strict=True) if n == 0)


def critical_damping(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> CriticalDamping:
    """Return all critical values of the yaw damping of the coupled motion.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units and ``v``, all floats.
    kind, equations : str
        As in `yawdesign.bogie.vehicles.bogie`.
    """
    c = characteristic(p, kind=kind, equations=equations)
    found = sorted(polish(p, crossings(c), kind=kind, equations=equations))
    places = _places([C_s for C_s, _ in found], p["K_ds"])
    routh = [count_unstable(c.core(C_s)) for C_s in places]
    modes = [int(count_undamped(core_eigenvalues(p, C_s, kind=kind, equations=equations))) for C_s in places]
    values = tuple(
        CriticalValue(C_s, omega, _becomes(before, after), _residual(c, C_s, omega))
        for (C_s, omega), before, after in zip(found, routh, routh[1:], strict=False)
    )
    steps = [after - before == 2 * _direction(c, x) for x, before, after in zip(values, routh, routh[1:], strict=False)]
    return CriticalDamping(
        values, tuple(routh), all(steps) and routh == modes and all(x.residual < TIGHT for x in values)
    )


def crossings(c: Characteristic) -> list[tuple[float, float]]:
    """Return every (C_s, omega) with C_s > 0 at which a root lies on the imaginary axis, in double precision."""
    places = np.unique(
        np.concatenate([GRID, *(x * (1 + np.array([-1e-4, -1e-7, 0, 1e-7, 1e-4])) for x in _candidates(c))])
    )
    sign = np.sign(_phase(c, places))
    brackets = [(places[k], places[k + 1]) for k in np.flatnonzero(sign[:-1] * sign[1:] < 0)]
    touched = [places[k] for k in np.flatnonzero(sign == 0)]
    found = touched + [_zero(c, low, high) for low, high in brackets]
    ratios = [(-evaluate(c.A, 1j * w) / evaluate(c.B, 1j * w), w) for w in found]
    return [(float(ratio.real), float(w)) for ratio, w in ratios if ratio.real > 0 and np.isfinite(ratio)]


def _zero(c: Characteristic, low: float, high: float) -> float:
    """Return where the phase is zero between two frequencies at which it was seen with different signs."""

    def phase(omega: float) -> float:
        return float(_phase(c, np.asarray(omega)))

    # An end that is the root itself has the sign of its rounding error, which may differ between arrays and numbers.
    if phase(low) * phase(high) >= 0:
        return min(low, high, key=lambda omega: abs(phase(omega)))
    return float(brentq(phase, low, high, xtol=1e-15 * high, rtol=1e-14))


def _phase(c: Characteristic, omega: Float) -> Float:
    """Return the sine of the angle between A(j w) and B(j w)."""
    ratio = evaluate(c.A, 1j * omega) / evaluate(c.B, 1j * omega)
    return np.asarray(ratio.imag / np.abs(ratio))


def _candidates(c: Characteristic) -> list[float]:
    """Return the frequencies of the positive, or nearly real, roots of E_B O_A - E_A O_B in w^2."""
    (even_a, odd_a), (even_b, odd_b) = (even_odd(scale_variable(p, TIME_UNIT)) for p in (c.A, c.B))
    x = roots(trim(add(multiply(even_b, odd_a), scale(multiply(even_a, odd_b), -1))))
    near = x[(x.real > 0) & (np.abs(x.imag) < 0.1 * x.real)]
    return [float(w) for w in np.sqrt(near.real) * TIME_UNIT]


def even_odd(p: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Return the even part E(x) and the odd part O(x) of p(j w) = E(x) + j w O(x), x = w^2."""
    even, odd = p[::2], p[1::2]
    return tuple(a * (-1) ** k for k, a in enumerate(even)), tuple(a * (-1) ** k for k, a in enumerate(odd))


def _places(values: Sequence[float], K_ds: float) -> list[float]:
    """Return one damping in every interval; without critical values the one whose joint relaxes at 100 rad/s."""
    if not values:
        return [K_ds / TIME_UNIT]
    return [values[0] / 2, *(float(np.sqrt(a * b)) for a, b in pairwise(values)), 2 * values[-1]]


def _becomes(before: int, after: int) -> str:
    if before and not after:
        return "stable"
    return "unstable" if after and not before else "neither"


def _residual(c: Characteristic, C_s: float, omega: float) -> float:
    return float(backward_error(c.core(C_s), 1j * np.asarray(omega)))


def _direction(c: Characteristic, x: CriticalValue) -> int:
    """Return +1 if the root at a critical value moves to the right as C_s grows, else -1."""
    derivative = tuple(k * a for k, a in enumerate(c.core(x.C_s)))[1:]
    velocity = -evaluate(c.B, 1j * x.omega) / evaluate(derivative, 1j * x.omega)
    return int(np.sign(velocity.real))

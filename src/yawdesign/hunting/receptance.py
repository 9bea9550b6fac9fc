"""The receptance at the yaw dampers: what displaces them when they push, all other parts of the vehicle in place.

With the law ``1 / (1/(C_s share s) + 1/K)`` of every yaw damper the vehicle has a root s exactly if 1/C_s is an
eigenvalue of ``M(s) = -s share (G(s) + 1/K)``, where G is the receptance without them: 1 x 1 for a bogie, 2 x 2 for a
vehicle with a car body. G comes from the dynamic stiffness, so it shares nothing with polynomials or state matrices.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.vehicle.elements import Link, Mass, Maxwell, Single, WheelRailContact
from yawdesign.vehicle.polynomials import Polynomial, derivative, evaluate, times
from yawdesign.vehicle.vehicle import Vehicle

ITERATIONS = 30
CONVERGED, ENOUGH = 1e-13, 1e-8  # relative length of the last step: of all, and with which one counts as found


class Crossings(NamedTuple):
    """Where eigenvalues of M(j omega) are real and positive: roots on the imaginary axis.

    Parameters
    ----------
    C_s : array, shape (n,)
        Damping of the pair of yaw dampers [N s/m].
    omega : array, shape (n,)
        Angular frequency [rad/s].
    direction : array, shape (n,)
        +1 if the root moves to the right as C_s grows, else -1.
    found : array of bool, shape (n,)
        Whether the method has come to an end.
    """

    C_s: Float
    omega: Float
    direction: Float
    found: Bools


class Receptance:
    """The matrix M(s) of a vehicle, or of many whose numbers are arrays.

    Parameters
    ----------
    vehicle : Vehicle
        Its own C_s is not looked at.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        coordinates = vehicle.model.motions[0].coordinates
        self._place = {x: k for k, x in enumerate(sorted(coordinates))}
        inside = [e for e in vehicle.folded if not coordinates.isdisjoint(_acts_on(e))]
        dampers = [e for e in inside if isinstance(e, Link) and e.varied and not _is_zero(e.share)]
        self._others = [e for e in inside if not (isinstance(e, Link) and e.varied)]
        self._shares = [e.share for e in dampers]
        self._softness = [_softness(e) for e in dampers]
        self._displacement = [self._row(e.displacement) for e in dampers]
        self._force = [self._row(e.force) for e in dampers]

    @property
    def size(self) -> int:
        """Number m of links of yaw dampers that are there."""
        return len(self._shares)

    def at(self, s: Complex) -> tuple[Complex, Complex]:
        """Return M and its derivative with respect to s, shape (n, m, m), at n places; of many vehicles each has its own."""
        Z, slope = np.zeros((2, len(s), len(self._place), len(self._place)), dtype=complex)
        for element in self._others:
            for (row, column), value, steep in _stiffness(element, s):
                if row in self._place and column in self._place:
                    where = (slice(None), self._place[row], self._place[column])
                    Z[where] += value
                    slope[where] += steep
        n = len(s)
        force = self._filled(self._force, n).transpose(0, 2, 1)
        displacement = self._filled(self._displacement, n)
        response = np.linalg.solve(Z, force)
        G = displacement @ response
        steep = -displacement @ np.linalg.solve(Z, slope @ response)
        share = np.zeros((n, self.size, 1))
        for k, (own, soft) in enumerate(zip(self._shares, self._softness, strict=True)):
            share[:, k, 0] = own
            G[:, k, k] += soft
        s = s[:, None, None]
        return -s * share * G, -share * (G + s * steep)

    def natural(self, n: int = 1) -> Float:
        """Return the C_s [N s/m] that belongs to the largest eigenvalue of M at 100 rad/s, for n vehicles."""
        values, _ = self.eigenvalues(np.full(n, TIME_UNIT))
        return np.asarray(1 / np.abs(values).max(axis=1))

    def followed(self, mu: Complex, omega: Float) -> Crossings:
        """Return where the eigenvalue of M(j omega) nearest to mu becomes real, by Newton's method over omega."""
        w, wanted = omega, mu
        with np.errstate(all="ignore"):
            for _ in range(ITERATIONS):
                values, slopes = self.eigenvalues(w)
                k = np.argmin(np.abs(values - wanted[:, None]), axis=1)[:, None]
                value, slope = (np.take_along_axis(x, k, axis=1)[:, 0] for x in (values, slopes))
                new = np.clip(w - value.imag / slope.imag, w / 2, 2 * w)
                step = np.abs(new - w) / w
                if not np.any(step > CONVERGED):
                    break
                wanted, w = value + slope * (new - w), np.where(np.isfinite(new), new, w)
            # A root on the axis moves with d mu = -j slope ds; and mu falls as C_s grows.
            return Crossings(1 / value.real, w, -np.sign(slope.imag), (step < ENOUGH) & (value.real > 0))

    def eigenvalues(self, omega: Float) -> tuple[Complex, Complex]:
        """Return the eigenvalues of M(j omega) and their derivatives with respect to omega, shape (n, m)."""
        M, steep = self.at(1j * omega)
        lost = ~(np.isfinite(M) & np.isfinite(steep)).all(axis=(1, 2))
        M[lost] = 0
        values, right = np.linalg.eig(M)
        # The rows of the inverse are the left eigenvectors, scaled; where two eigenvectors are one there is no slope.
        slopes = 1j * np.einsum("nki,nij,njk->nk", np.linalg.pinv(right), steep, right)
        values[lost] = np.nan
        return values, slopes

    def _row(self, coefficients: Any) -> dict[int, Any]:
        return {self._place[x]: g for x, g in coefficients.items() if x in self._place}

    def _filled(self, rows: list[dict[int, Any]], n: int) -> Float:
        out = np.zeros((n, len(rows), len(self._place)))
        for k, row in enumerate(rows):
            for column, g in row.items():
                out[:, k, column] = g
        return out


def _softness(damper: Link) -> Any:
    """Return 1/K of the joints of a yaw damper."""
    (law,) = damper.laws
    return 1 / law.K if isinstance(law, Maxwell) else 0


def _is_zero(x: Any) -> bool:
    return bool(np.ndim(x) == 0 and x == 0)


def _acts_on(element: Single) -> Iterable[str]:
    match element:
        case Mass():
            return (element.coordinate,)
        case WheelRailContact():
            return (element.y, element.phi)
        case Link():
            return element.force
    return ()


def _stiffness(element: Single, s: Complex) -> Iterable[tuple[tuple[str, str], Any, Any]]:
    """Yield the entries (row, column) of an element's dynamic stiffness, with their derivatives with respect to s."""
    match element:
        case Mass():
            yield (element.coordinate, element.coordinate), element.m * s * s, 2 * element.m * s
        case WheelRailContact():
            for place, p in element.entries().items():
                yield place, evaluate(p, s), evaluate(derivative(p), s)
        case Link():
            parts = [_force(law.numerator, law.denominator, s) for law in element.laws]
            value, slope = sum(x for x, _ in parts), sum(y for _, y in parts)
            for row, force in element.force.items():
                for column, g in element.displacement.items():
                    each = times(force, g)
                    yield (row, column), each * value, each * slope


def _force(numerator: Polynomial, denominator: Polynomial, s: Complex) -> tuple[Any, Any]:
    """Return numerator / denominator and its derivative."""
    n, d = evaluate(numerator, s), evaluate(denominator, s)
    return n / d, (evaluate(derivative(numerator), s) * d - n * evaluate(derivative(denominator), s)) / (d * d)

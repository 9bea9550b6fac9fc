"""All values of C_s at which two eigenvalues are opposite to each other: a pair on the imaginary axis, or s and -s.

With mu = 1/C_s the state matrix is A(mu), linear in mu but for the yaw dampers' few channels. Two eigenvalues add up to
zero exactly where the Kronecker sum of A with itself is singular. From one place mu_0 that is an eigenvalue problem,
with as many unknowns as states times yaw dampers: no frequency is scanned, and nothing can fall between two of them.
"""

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.vehicle.elements import Link, Mass
from yawdesign.vehicle.vehicle import Vehicle

REAL = 1e-3  # largest angle of what counts as real: two values that nearly coincide come with imaginary parts


def opposite_eigenvalues(vehicle: Vehicle, reference: float, zeros: int = 0) -> Float:
    """Return every C_s > 0 at which two eigenvalues of the coupled motion add up to zero, some of them many times.

    They are good to some digits, and there may be others among them, which rounding made of 0 and infinity.

    Parameters
    ----------
    vehicle : Vehicle
        Its numbers are floats; its own C_s is not looked at.
    reference : float
        A C_s that is none of them [N s/m]; those next to it are known best.
    zeros : int
        How many roots are zero whatever C_s is.
    """
    A, P, Q, D = _channels(vehicle.replace(C_s=reference))
    values, V = np.linalg.eig(A)
    p, q = np.linalg.solve(V, P.astype(complex)), Q @ V
    # What stays at zero is not reached by the yaw dampers: a shift or a yaw of the whole vehicle.
    moving = np.argsort(np.abs(values))[zeros:]
    theta = np.linalg.eigvals(_pencil(values[moving], p[moving], q[:, moving], D))
    with np.errstate(all="ignore"):
        C_s = reference / (1 + reference / theta)
        real = np.isfinite(C_s) & (C_s.real > 0) & (np.abs(C_s.imag) < REAL * C_s.real)
    return np.sort(C_s.real[real])


def _pencil(values: Complex, p: Complex, q: Complex, D: Float) -> Complex:
    """Return the matrix whose eigenvalues are 1 / (mu - mu_0), in the coordinates of the modes.

    With x' = A x + P w, y = Q x + D w and w = (mu - mu_0) y, two solutions x_1, x_2 with opposite s have
    ``A X + X A' = (mu - mu_0) (P Y' - Y P')`` for X = x_1 x_2' - x_2 x_1' and Y = x_1 y_2' - x_2 y_1', and
    ``Y = X Q' + (mu - mu_0) Y D'``; Y is the unknown.
    """
    n, m = p.shape
    inverse = 1 / (values[:, None] + values[None, :])
    K = np.einsum("ib,aj,ij->iajb", p, q, inverse)
    own = np.einsum("kb,ak,ik->iab", p, q, inverse)
    K[np.arange(n), :, np.arange(n), :] += D - own
    return np.asarray(K.reshape(n * m, n * m))


def _channels(vehicle: Vehicle) -> tuple[Float, Float, Float, Float]:
    """Return A, P, Q and D: what a change of mu = 1/C_s does through the yaw dampers."""
    coupled, system = vehicle.model.motions[0], vehicle.folded_state_space
    A, C_s, half = motion_matrix(vehicle, coupled), float(vehicle.C_s), len(system.coordinates)
    place = {state: k for k, state in enumerate(system.states_of(coupled.coordinates))}
    columns: list[tuple[Float, Float, float]] = []
    for k, (link, _) in enumerate(system.strokes):
        if link.varied:
            own = place[2 * half + k]
            columns.append((np.eye(len(A))[own], A[own] * C_s, 0.0))  # the row of the stroke is a multiple of mu
    masses = {e.coordinate: e for e in system.elements if isinstance(e, Mass)}
    dampers = [e for e in system.elements if isinstance(e, Link) and e.varied]
    for link in dampers:
        if link.share and not link.maxwell:  # a joint that is rigid
            push, rate = np.zeros((2, len(A)))
            for x, mass in masses.items():
                if x in coupled.coordinates:
                    own = place[half + system.coordinates.index(x)]
                    push[own] = link.force.get(x, 0) / mass.m * C_s
                    rate[own] = link.displacement.get(x, 0) * link.share * C_s
            columns.append((push, rate, -C_s))
    P, Q, D = (np.array(part) for part in zip(*columns, strict=True))
    return A, P.T, Q, np.diag(D)

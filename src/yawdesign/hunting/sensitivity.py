"""Derivatives of a critical value to every parameter, by left and right eigenvectors of the state matrix.

With the eigenvectors x and y' of an eigenvalue s the derivative ds/dp is ``y' dA/dp x / y' x``. On the boundary Re s
stays zero, so that ``dC_s/dp = -Re(ds/dp) / Re(ds/dC_s)``. The entries of A are differentiated exactly, as a graph of a
few hundred operations; the graph of the polynomial, which `yawdesign.hunting.boundary` differentiates, is much larger.
"""

from functools import lru_cache

import casadi as ca
import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.hunting.boundary import parameter_names
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.vehicle.vehicle import Model, Vehicle

ON_BOUNDARY = 1e-6  # farthest from the given place, relative to it, that the eigenvalue may lie
SINGLE = 1e-10  # least |y' x| of eigenvectors of length 1: below it two eigenvalues are one, without derivatives


def sensitivity(vehicle: Vehicle, C_s: float, omega: float) -> dict[str, float]:
    """Return d ln C_s / d ln p [-] of a critical value for every parameter p and v.

    Parameters
    ----------
    vehicle : Vehicle
        Its numbers are floats; its own C_s is not looked at.
    C_s, omega : float
        The critical value [N s/m] and the angular frequency there [rad/s].

    Returns
    -------
    dict
        By the names of the parameters. Empty if the derivatives do not exist: two critical values that have just met,
        or two eigenvalues that coincide; or if no eigenvalue lies at j omega.
    """
    names = parameter_names(vehicle.p)
    A = motion_matrix(vehicle.replace(C_s=C_s), vehicle.model.motions[0])
    s, right = np.linalg.eig(A)
    k = int(np.argmin(np.abs(s - 1j * omega)))
    left = np.linalg.pinv(right)[k]
    if abs(s[k] - 1j * omega) > ON_BOUNDARY * omega or np.linalg.norm(left) > 1 / SINGLE:
        return {}
    weights: Float = np.outer(left, right[:, k]).real
    values = [float(vehicle.p[name]) for name in names]
    zeros = frozenset(name for name, x in zip(names, values, strict=True) if x == 0)
    slopes = np.array(_slopes(vehicle.model, names, zeros)(weights, values, C_s)).ravel()
    with np.errstate(all="ignore"):
        relative = -slopes[:-1] * values / (slopes[-1] * C_s)
    return dict(zip(names, relative.tolist(), strict=True)) if np.all(np.isfinite(relative)) else {}


@lru_cache
def _slopes(model: Model, names: tuple[str, ...], zeros: frozenset[str]) -> ca.Function:
    """Return the derivatives of sum(weights * A) with respect to the parameters and C_s: (weights, p, C_s) -> slopes.

    Dampers without damping have no states.
    """
    p = ca.SX.sym("p", len(names) + 1)
    vehicle = model.at({name: 0 if name in zeros else p[k] for k, name in enumerate(names)}, C_s=p[len(names)])
    system = vehicle.folded_state_space
    place = {state: k for k, state in enumerate(system.states_of(model.motions[0].coordinates))}
    weights = ca.SX.sym("weights", len(place), len(place))
    inside = [(place[i], place[j], x) for (i, j), x in system.A.items() if i in place and j in place]
    total = sum(weights[i, j] * x for i, j, x in inside)
    slopes = ca.gradient(total, p)
    return ca.Function("slopes", [weights, p[:-1], p[-1]], [slopes], ["weights", "p", "C_s"], ["slopes"])

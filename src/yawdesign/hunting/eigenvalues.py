"""Eigenvalues of a vehicle, motion by motion, and the margins that are read from them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.polynomials import Polynomial, derivative, evaluate, scale_variable
from yawdesign.vehicle.state_space import fill
from yawdesign.vehicle.vehicle import Vehicle

EXACT = 1e-9  # largest backward error with which an eigenvalue counts as a root of the characteristic polynomial


def state_matrix(vehicle: Vehicle) -> Float:
    """Return the state matrix of a vehicle in the coordinates of each end (25 states, 15 without motors).

    Parameters
    ----------
    vehicle : Vehicle
        With numbers or arrays that broadcast against each other.

    Returns
    -------
    ndarray, shape (..., n, n)
    """
    return dense(vehicle.state_space.A, vehicle.state_space.size)


def folded_matrix(vehicle: Vehicle) -> Float:
    """Return the state matrix of a vehicle in half sums and half differences of both ends, in which motions are apart.

    Parameters
    ----------
    vehicle : Vehicle
        With numbers or arrays that broadcast against each other.

    Returns
    -------
    ndarray, shape (..., n, n)
    """
    return dense(vehicle.folded_state_space.A, vehicle.folded_state_space.size)


def motion_matrix(vehicle: Vehicle, motion: Motion) -> Float:
    """Return the state matrix of one motion of a vehicle, whose eigenvalues are the roots of its polynomial.

    Parameters
    ----------
    vehicle : Vehicle
        With numbers or arrays that broadcast against each other.
    motion : Motion
        One of its motions, or of its model's; its polynomial is not looked at.

    Returns
    -------
    ndarray, shape (..., n, n)
    """
    system = vehicle.folded_state_space
    place = {state: k for k, state in enumerate(system.states_of(motion.coordinates))}
    return dense({(place[i], place[j]): x for (i, j), x in system.A.items() if i in place and j in place}, len(place))


def dense(entries: Mapping[tuple[int, int], Any], rows: int, columns: int | None = None) -> Float:
    """Return entries as a matrix, a square one if no number of columns is given; as a stack, if they are arrays.

    Parameters
    ----------
    entries : mapping (row, column) -> number or array
        What is not zero.
    rows, columns : int
        Size of the matrix.

    Returns
    -------
    ndarray, shape (..., rows, columns)
    """
    shape = np.broadcast_shapes(*{getattr(value, "shape", ()) for value in entries.values()})
    return np.asarray(fill(entries, np.zeros((*shape, rows, rows if columns is None else columns))))


def motion_eigenvalues(vehicle: Vehicle, motion: Motion) -> Complex:
    """Return the eigenvalues of one motion of a vehicle [1/s] along the last axis. Parameters as in `motion_matrix`."""
    return np.asarray(np.linalg.eigvals(motion_matrix(vehicle, motion)), dtype=complex)


def eigenvalues(vehicle: Vehicle) -> Complex:
    """Return all eigenvalues of a vehicle of floats [1/s], the least damped first, conjugates together."""
    # What belongs to a motion is the model's: the polynomials of these numbers are not needed.
    return in_order(np.concatenate([motion_eigenvalues(vehicle, motion) for motion in vehicle.model.motions]))


def in_order(s: Complex) -> Complex:
    """Return roots, the least damped first, conjugates together."""
    return np.asarray(sorted(s, key=lambda s: (-s.real, abs(s.imag), -s.imag)), dtype=complex)


def roots(p: Polynomial) -> Complex:
    """Return the roots of a real polynomial, lowest power first [1/s]."""
    down = np.trim_zeros(np.array(p[::-1], dtype=float), "f")
    unit = (abs(down[-1] / down[0])) ** (1 / max(len(down) - 1, 1)) or 1.0
    return np.asarray(np.roots(down / down[0] / unit ** np.arange(len(down))) * unit)


def decay_rate(s: Complex) -> Float:
    """Return minus the largest real part [1/s] over the last axis."""
    return np.asarray(-np.max(s.real, axis=-1))


def damping_ratio(s: Complex) -> Float:
    """Return the least -Re(s)/|s| over the last axis; a stable real root counts as 1."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.min(np.where(s == 0, 0.0, -s.real / np.abs(s)), axis=-1))


MARGINS = {"decay_rate": decay_rate, "damping_ratio": damping_ratio}


def polished(p: Polynomial, s: Complex) -> Complex:
    """Return eigenvalues after steps of Newton's method on their polynomial.

    A matrix with a root that is very fast, such as that of a damper with hardly any damping, gives the slow ones with
    the rounding of the fast one. No eigenvalue moves more than a quarter of the way to another one: none is lost.

    Parameters
    ----------
    p : tuple
        Real coefficients, lowest power first.
    s : array
        Eigenvalues [1/s], in any order.
    """
    scaled = scale_variable(p, TIME_UNIT)
    gap = np.abs(s[:, None] - s[None, :]) / TIME_UNIT
    np.fill_diagonal(gap, np.inf)
    start = w = s / TIME_UNIT
    with np.errstate(all="ignore"):
        for _ in range(3):
            outside = np.abs(w) > 1
            z = np.where(outside, 1 / w, w)
            near, far = (z - evaluate(q, z) / evaluate(derivative(q), z) for q in (scaled, scaled[::-1]))
            new = np.where(outside, 1 / far, near)
            w = np.where(np.isfinite(new) & (np.abs(new - start) < gap.min(axis=1) / 4), new, w)
    return np.asarray(w * TIME_UNIT)


def backward_error(p: Polynomial, s: Complex) -> Float:
    """Return |p(s)| / sum |a_k| |s|^k: how far s is from being an exact root, relative to the coefficients."""
    s = np.asarray(s)
    scaled = scale_variable(p, TIME_UNIT)
    # Powers of a stiff joint's root overflow; for large s the polynomial is taken in 1/s.
    outside = np.abs(s) > TIME_UNIT
    w = np.where(outside, TIME_UNIT / np.where(outside, s, 1), s / TIME_UNIT)
    return np.where(outside, _relative(scaled[::-1], w), _relative(scaled, w))


def _relative(p: Polynomial, s: Complex) -> Float:
    # A root at zero is found to within the rounding of the others: powers of less than this say nothing.
    size = np.maximum(np.abs(s), 1e-3)
    return np.asarray(np.abs(evaluate(p, s)) / evaluate(tuple(np.abs(a) for a in p), size))


def count_undamped(s: Complex) -> NDArray[np.int64]:
    """Return the number of roots over the last axis that are not in the left half-plane, or within rounding of it."""
    return np.asarray(np.sum(s.real > -1e-10 * np.maximum(1, np.abs(s)), axis=-1))

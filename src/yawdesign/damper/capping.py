"""The modes that cap a margin: those with the least margin that the design variables hardly move.

The sway of a car body is one: wherever the yaw dampers and the motors' suspension stand, its margin is about the same,
and behind it the margins of hunting would not be looked at.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import casadi as ca
import numpy as np

from yawdesign.damper.design_space import Space
from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.eigenvalues import MARGINS, motion_matrix
from yawdesign.response.modes.named_modes import modes_at
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.vehicle import Vehicle

HARDLY = 0.2  # a mode is hardly moved if its margin changes by less, relative to the largest, over the bounds
GIVEN_AWAY = 0.02  # of the largest worst margin, for the margin of the remaining modes
STEPS = (12, 48, 192)  # in which a mode is followed to a bound; more where it is not clear which mode is which
CLEAR = 3.0  # a mode is clear if its part in the followed one is so many times that of any other
INSIDE = 1e-3  # how far from the faces of the cube modes are followed: a damper without damping has one state less


@dataclass(frozen=True)
class CappingMode:
    """A mode that caps the margin.

    Parameters
    ----------
    motion : Motion
        The motion it belongs to.
    s : complex
        Its eigenvalue [1/s].
    margin : float
        Its own margin: [1/s] or [-].
    """

    motion: Motion
    s: complex
    margin: float


def capping_modes(space: Space, x: Float) -> tuple[CappingMode, ...]:
    """Return the modes that cap the margin of a design, the least margin first.

    They are those which the variables hardly move, of all modes below the first one that they do move and that leaves
    more than what may be given away.

    Parameters
    ----------
    space : Space
        The design space.
    x : array, shape (variables,)
        The design; the modes are those under its worst condition.
    """
    found: list[CappingMode] = []
    condition = int(space.under_each(space.values(x)).argmin())
    modes = _modes(space, x, condition)
    for mode in modes:
        if _is_hardly_moved(space, x, condition, mode):
            found.append(mode)
        elif mode.margin > (1 + GIVEN_AWAY) * modes[0].margin:
            break
    return tuple(found)


def _modes(space: Space, x: Float, condition: int) -> list[CappingMode]:
    """Return the oscillations of a design that count in its margin, the least margin first; none if it is unstable."""
    modes = [
        CappingMode(motion, complex(s), float(MARGINS[space.objective](np.array([s]))))
        for motion in _counted(space)
        for s in np.linalg.eigvals(_matrix(space, x, condition, motion))
    ]
    modes = sorted(modes, key=lambda mode: mode.margin)
    oscillations = [mode for mode in modes if mode.s.imag > 0]
    return oscillations if modes[0].margin > 0 and modes[0].s.imag else []


def _counted(space: Space) -> list[Motion]:
    movable = space.model.movable(space.names)
    return [motion for motion in space.model.motions if motion.name in movable]


def _matrix(space: Space, x: Float, condition: int, motion: Motion) -> Float:
    """Return the state matrices of a motion at points of the cube, shape (points, n, n), or (n, n) at one."""
    inside = np.clip(x, INSIDE, 1 - INSIDE)
    return motion_matrix(space.model.at(space.conditions[condition].applied(space.values(inside))), motion)


def _is_hardly_moved(space: Space, x: Float, condition: int, mode: CappingMode) -> bool:
    """Return whether the margin of a mode stays nearly the same while each variable goes to either of its bounds."""
    least = most = mode.margin
    for k, end in product(range(len(x)), (0.0, 1.0)):
        there = x.copy()
        there[k] = end
        s = _followed(space, condition, mode, x, there)
        if s is None:
            return False
        margins = MARGINS[space.objective](s[:, None])
        least, most = min(least, margins.min()), max(most, margins.max())
        if most - least >= HARDLY * most:
            return False
    return True


def _followed(space: Space, condition: int, mode: CappingMode, start: Float, end: Float) -> Complex | None:
    """Return the eigenvalues of a mode on the straight way from one design to another; None if it cannot be told."""
    for steps in STEPS:
        way = start[:, None] + (end - start)[:, None] * np.linspace(0, 1, steps + 1)
        s, right = np.linalg.eig(_matrix(space, way, condition, mode.motion))
        places = [int(np.argmin(np.abs(s[0] - mode.s)))]
        for here, there in pairwise(right):
            share = np.abs(np.linalg.solve(here, there)[places[-1]])  # of the mode here in each of the modes there
            largest, second = np.argsort(-share)[:2]
            if share[largest] < CLEAR * share[second]:
                break
            places.append(int(largest))
        else:
            return np.asarray(s[np.arange(steps + 1), places])
    return None


def names_of(vehicle: Vehicle, modes: Sequence[CappingMode]) -> str:
    """Return what modes are called."""
    named = modes_at(vehicle)
    return ", ".join(min(named, key=lambda one: abs(one.eigenvalue - mode.s)).name for mode in modes)


def sensitivity(vehicle: Vehicle, mode: CappingMode, objective: str) -> dict[str, float]:
    """Return d ln margin / d ln p [-] of a mode for every parameter p and the speed, the largest first.

    ``ds/dp = l (dA/dp) r`` with the left and the right eigenvector, ``l r = 1``, and the matrix's own derivatives.
    """
    names = [key for key, value in vehicle.p.items() if value]
    symbols = ca.SX.sym("p", len(names))
    other = vehicle.model.at({**vehicle.p, **dict(zip(names, ca.vertsplit(symbols), strict=True))})
    place = {k: i for i, k in enumerate(vehicle.folded_state_space.states_of(mode.motion.coordinates))}
    left, right = _vectors(vehicle, mode)
    entries = {(i, j): x for (i, j), x in other.folded_state_space.A.items() if i in place and j in place}
    weights = np.array([left[place[i]] * right[place[j]] for i, j in entries])
    slopes = ca.Function("slopes", [symbols], [ca.jacobian(ca.vertcat(*entries.values()), symbols)])
    numbers = np.array([float(vehicle.p[key]) for key in names])
    slope = numbers * (weights @ np.array(slopes(numbers)))  # d s / d ln p
    s = mode.s
    grown = -slope.real if objective == "decay_rate" else s.imag * (np.conj(s) * slope).imag / abs(s) ** 3
    change = grown / mode.margin
    return {names[k]: float(change[k]) for k in np.argsort(-np.abs(change), kind="stable")}


def at_design(vehicle: Vehicle, mode: CappingMode, objective: str) -> CappingMode:
    """Return a mode at another design, at which it is nearly the same."""
    every = np.linalg.eigvals(motion_matrix(vehicle, mode.motion))
    s = complex(every[np.argmin(np.abs(every - mode.s))])
    return replace(mode, s=s, margin=float(MARGINS[objective](np.array([s]))))


def _vectors(vehicle: Vehicle, mode: CappingMode) -> tuple[Complex, Complex]:
    """Return the left and the right eigenvector of a mode, whose product is 1."""
    s, right = np.linalg.eig(motion_matrix(vehicle, mode.motion))
    k = int(np.argmin(np.abs(s - mode.s)))
    return np.linalg.inv(right)[k], right[:, k]

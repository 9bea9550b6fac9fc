"""The bogie at one speed as x' = A x + B u, y = C x + D u: the track as input, all that is of interest as output.

The inputs u are alignment [m] and cross-level angle [rad] under the front wheelset, then under the rear one.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem
from yawdesign.vehicle.elements import Link, Mass, Single, WheelRailContact
from yawdesign.vehicle.old import DAMPERS, PAIR_FORCE, YAW_DAMPER, YAW_DISPLACEMENT, StateSpace, bogie, physical
from yawdesign.vehicle.signals import acceleration, of_damper, velocity

INPUTS = ("alignment", "cross_level")


@dataclass(frozen=True, eq=False)
class System:
    """The bogie at one speed, linear in its states and in the track.

    Parameters
    ----------
    A, B, C, D : ndarray
        State, input, output and feed-through matrices.
    outputs : mapping name -> row of C and D
        Displacements ``y_b``, velocities ``y_b_velocity``, accelerations, forces and strokes.
    coordinates : tuple of str
        The displacements, in the order of the first states.
    elements : tuple
        What the bogie is made of.
    v, C_s : float
        Speed [m/s] and damping of the pair of yaw dampers [N s/m].
    lag : float
        Time by which the rear wheelset sees the track later, 2 a / v [s].
    p : mapping
        Symbols of Table I in SI units.
    model : mapping
        Keywords ``kind`` and ``equations`` of the model.
    """

    A: Float
    B: Float
    C: Float
    D: Float
    outputs: Mapping[str, int]
    coordinates: tuple[str, ...]
    elements: tuple[Single, ...]
    v: float
    C_s: float
    lag: float
    p: Mapping[str, float]
    model: Mapping[str, str]

    @property
    def eigenvalues(self) -> Complex:
        """Eigenvalues of A [1/s]."""
        return np.asarray(np.linalg.eigvals(self.A), dtype=complex)

    def harmonic_input(self, omega: Float, name: str) -> Complex:
        """Return u of a harmonic of amplitude 1 under the front wheelset, shape (len(omega), 4)."""
        u = np.zeros((len(omega), 2 * len(INPUTS)), dtype=complex)
        column = INPUTS.index(name)
        u[:, column] = 1
        u[:, column + len(INPUTS)] = np.exp(-1j * omega * self.lag)
        return u


def system_at(problem: Problem, v: float) -> System:
    """Return the bogie of a problem at a speed [m/s]; an error if it has no C_s."""
    p = {**problem.bogie.parameters(), "v": v, "C_s": given_damping(problem)}
    model = problem.model
    elements = physical(bogie(p, **model))
    space = StateSpace(elements)
    A = np.asarray(space.fill(np.zeros((space.size, space.size))))
    B = np.zeros((space.size, len(space.input_names)))
    for place, value in space.inputs.items():
        B[place] = value
    rows = {**_motions(space, A, B), **_contact_forces(space, elements), **_dampers(space)}
    C, D = (np.array([row[k] for row in rows.values()]) for k in (0, 1))
    outputs = {name: k for k, name in enumerate(rows)}
    v, C_s, a = float(v), float(p["C_s"]), float(p["a"])
    return System(A, B, C, D, outputs, space.coordinates, tuple(elements), v, C_s, 2 * a / v, p, model)


def coordinates(problem: Problem) -> tuple[str, ...]:
    """Return the displacements of a problem's bogie."""
    p = {**problem.bogie.parameters(), "v": 1.0}
    elements = physical(bogie(p, kind=problem.bogie.kind, equations=problem.equations))
    return tuple(e.coordinate for e in elements if isinstance(e, Mass))


Rows = dict[str, tuple[Float, Float]]


def _motions(space: StateSpace, A: Float, B: Float) -> Rows:
    n, no_input = len(space.coordinates), np.zeros(B.shape[1])
    unit = np.eye(space.size)
    named = list(enumerate(space.coordinates))
    return (
        {x: (unit[i], no_input) for i, x in named}
        | {velocity(x): (unit[n + i], no_input) for i, x in named}
        | {acceleration(x): (A[n + i], B[n + i]) for i, x in named}
    )


def _contact_forces(space: StateSpace, elements: Iterable[Single]) -> Rows:
    """Return the lateral force of the rails on each wheelset, gravity and creep together."""
    rows: Rows = {}
    n = len(space.coordinates)
    for contact in (e for e in elements if isinstance(e, WheelRailContact)):
        c, d = np.zeros(space.size), np.zeros(len(space.input_names))
        for (row, x), polynomial in contact.entries().items():
            for order, value in enumerate(polynomial if row == contact.y else ()):
                c[order * n + space.coordinates.index(x)] = -value
        for (row, name), force in contact.inputs().items():
            if row == contact.y:
                d[space.input_names.index(name)] = force
        rows[f"lateral_force_{contact.y[-1]}"] = c, d
    return rows


def _dampers(space: StateSpace) -> Rows:
    """Return force and stroke of each damper, and force and displacement of the pair of yaw dampers."""
    rows: Rows = {}
    no_input = np.zeros(len(space.input_names))
    for state, (link, law) in enumerate(space.strokes, 2 * len(space.coordinates)):
        displacement, stroke = _displacement(space, link), np.eye(space.size)[state]
        force = law.K * (displacement - stroke)
        rows[of_damper(link.name, "force")] = force / DAMPERS.get(link.name, 1), no_input
        rows[of_damper(link.name, "stroke")] = stroke, no_input
        if link.name == YAW_DAMPER:
            rows[PAIR_FORCE], rows[YAW_DISPLACEMENT] = (force, no_input), (displacement, no_input)
    return rows


def _displacement(space: StateSpace, link: Link) -> Float:
    c = np.zeros(space.size)
    for x, g in link.displacement.items():
        c[space.coordinates.index(x)] = g
    return c

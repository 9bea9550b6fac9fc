"""The linear model in state space: matrices of any number type, and the names and units of states and outputs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca

from yawdesign.vehicle.catalogue import Parameters
from yawdesign.vehicle.elements import Link, Maxwell, Single
from yawdesign.vehicle.old import PAIR_FORCE, YAW_DAMPER, YAW_DISPLACEMENT, StateSpace, bogie, physical, unit_of
from yawdesign.vehicle.polynomials import Number
from yawdesign.vehicle.signals import SignalNames, of_damper, velocity


@dataclass(frozen=True)
class Names:
    """Names and SI units along the matrices A, B, C and D.

    Parameters
    ----------
    states, inputs, outputs : tuple of str
        Coordinates ``y_b``, velocities ``y_b_velocity``, dampers' strokes ``yaw_damper_stroke``; track inputs;
        coordinates, velocities, ``yaw_damper_pair_force`` and ``yaw_damper_displacement``. See `SignalNames` for what
        they were called before.
    state_units, input_units, output_units : tuple of str
        In the same order.
    """

    states: SignalNames
    inputs: tuple[str, ...]
    outputs: SignalNames
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]


def _assembled(p: Parameters, C_s: Number, model: Mapping[str, str]) -> tuple[list[Single], StateSpace]:
    elements = physical(bogie({**p, "C_s": C_s}, **model))
    return elements, StateSpace(elements)


def state_names(p: Parameters, C_s: Number, model: Mapping[str, str]) -> Names:
    """Return the names that belong to `state_space_matrices`. Arguments as there."""
    _, system = _assembled(p, C_s, model)
    x = system.coordinates
    moves = (*x, *(velocity(name) for name in x))
    states = SignalNames((*moves, *(of_damper(link.name, "stroke") for link, _ in system.strokes)))
    outputs = SignalNames((*moves, PAIR_FORCE, YAW_DISPLACEMENT))
    units = [tuple(map(unit_of, names)) for names in (states, system.input_names, outputs)]
    return Names(states, system.input_names, outputs, *units)


def state_space_matrices(p: Parameters, C_s: Number, model: Mapping[str, str]) -> dict[str, ca.SX]:
    """Return A, B, C and D.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units and ``v``, numbers or SX.
    C_s : number
        Damping of the pair of yaw dampers [N s/m].
    model : mapping
        ``kind`` and ``equations`` as in `yawdesign.vehicle.catalogue.bogie`.
    """
    elements, system = _assembled(p, C_s, model)
    n, moves, inputs = system.size, 2 * len(system.coordinates), len(system.input_names)
    C = ca.SX(moves + 2, n)
    C[:moves, :moves] = ca.SX.eye(moves)
    for (row, column), value in _yaw_damper(elements, system).items():
        C[moves + row, column] = value
    return {
        "A": _filled(ca.SX(n, n), system.entries),
        "B": _filled(ca.SX(n, inputs), system.inputs),
        "C": C,
        "D": ca.SX(moves + 2, inputs),
    }


def _filled(matrix: ca.SX, entries: Mapping[tuple[int, int], Any]) -> ca.SX:
    for (row, column), value in entries.items():
        matrix[row, column] = value
    return matrix


def _yaw_damper(elements: list[Single], system: StateSpace) -> dict[tuple[int, int], Any]:
    """Return the rows of force K (u - z) and displacement u; the damper is the first with a joint, so z is too."""
    link = next(e for e in elements if isinstance(e, Link) and e.name == YAW_DAMPER)
    law = next(law for law in link.laws if isinstance(law, Maxwell))
    stroke = 2 * len(system.coordinates)
    damped = not (isinstance(law.c, (int, float)) and law.c == 0)
    rows: dict[tuple[int, int], Any] = {(0, stroke): -law.K} if damped else {}
    for x, g in link.displacement.items():
        place = system.coordinates.index(x)
        rows[1, place] = g
        if damped:
            rows[0, place] = law.K * g
    return rows

"""Table II and Fig. 2 of the paper: what a disturbance sin 6t of the front wheelset does to the frame."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import isclose, pi, sqrt
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Complex
from yawdesign.response.run.frequency import outputs
from yawdesign.response.run.simulate import Simulation, simulate
from yawdesign.response.run.system import System
from yawdesign.response.track.tracks import Sinusoid
from yawdesign.study.paper_bogie import EQUATIONS, PaperBogie
from yawdesign.study.printed_values import (
    ADAMS_RMS,
    DISTURBANCE,
    PROPOSED_RMS,
    RELATIVE_DEVIATION,
    SPEED_OF_FIGURE_2,
)
from yawdesign.study.reproduced_row import PRINTED, ReproducedRow, row
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.polynomials import evaluate
from yawdesign.vehicle.vehicle import Vehicle

PERIODS = 20
DRAWN = 10.0  # [s]
SAME = 1e-6  # relative difference of two routes that is none
ACCELERATIONS = {"lateral": ("y_b", "m/s^2"), "yaw": ("phi_b", "rad/s^2")}
UNKNOWN = (
    "the amplitude's unit, where it enters, the initial conditions and the time window are not printed: absolute "
    "values cannot be reproduced, and nothing is fitted to them"
)
LAST_DIGIT = 0.0005  # half of the last digit of the deviations [%]


@dataclass(frozen=True)
class Reading:
    """One way in which the disturbance may be meant.

    Parameters
    ----------
    words : str
        What moves.
    ratio : float
        Of the frame's lateral to its yaw acceleration [m/rad].
    check : str
        The second route to it.
    checked : bool
        Whether both agree.
    """

    words: str
    ratio: float
    check: str
    checked: bool


def figure_2(bogie: PaperBogie) -> Simulation:
    """Return the run of Fig. 2, with an amplitude of 1 m under the front wheelset, from rest."""
    return _run(bogie, "rest", DRAWN)


def table_2(bogie: PaperBogie, drawn: Simulation) -> Iterator[ReproducedRow]:
    """Yield Fig. 2 and Table II: what does not depend on the amplitude is compared, the rest is shown."""
    again = _run(bogie, "rest", DRAWN, step=drawn.runs[0].step / 2)
    settled = _run(bogie, "stationary", PERIODS * 2 * pi / DISTURBANCE)
    system = _system(bogie.vehicles[PRINTED])
    amplitudes = _under_rail(system)
    for name, (coordinate, unit) in ACCELERATIONS.items():
        response = f"{coordinate}_acceleration"
        one, other = drawn.rms[response], again.rms[response]
        yield row(
            *("Fig. 2", f"{name} acceleration of the frame, RMS of 10 s from rest, the rail moved by 1 m"),
            computed=one,
            unit=unit,
            equations=PRINTED,
            reason=UNKNOWN,
            misprint=13,
            check="with half the time step",
            checked=isclose(one, other, rel_tol=1e-3) and drawn.checked,
        )
        rms, amplitude = settled.rms[response], abs(amplitudes[coordinate])
        yield row(
            *("Table II", f"{name} acceleration of the frame, stationary RMS, the rail moved by 1 m"),
            printed=PROPOSED_RMS[name],
            computed=rms,
            unit=unit,
            equations=PRINTED,
            reason=UNKNOWN,
            misprint=13,
            check="the frequency response",
            checked=isclose(rms, amplitude * DISTURBANCE**2 / sqrt(2), rel_tol=1e-3),
        )
    for name in ACCELERATIONS:
        yield row(
            *("Table II", f"relative deviation of the {name} accelerations that are printed, in %"),
            printed=RELATIVE_DEVIATION[name],
            computed=100 * (PROPOSED_RMS[name] / ADAMS_RMS[name] - 1),
            unit="-",
            tolerance=100 * LAST_DIGIT / RELATIVE_DEVIATION[name],
            reason="half of the last digit that is printed",
            check="from printed numbers alone",
        )
    yield from _ratios(bogie)


def _ratios(bogie: PaperBogie) -> Iterator[ReproducedRow]:
    printed = {name: x["lateral"] / x["yaw"] for name, x in (("proposed", PROPOSED_RMS), ("ADAMS/Rail", ADAMS_RMS))}
    for equations in EQUATIONS:
        found = readings(bogie.vehicles[equations])
        for reading in found:
            yield row(
                *("Table II", f"ratio of lateral to yaw acceleration, {reading.words}"),
                printed=printed["proposed"],
                computed=reading.ratio,
                unit="m/rad",
                equations=equations,
                reason="one of the two ways in which the disturbance may enter",
                misprint=13,
                check=reading.check,
                checked=reading.checked,
            )
        low, high = sorted(reading.ratio for reading in found)
        for name, ratio in printed.items():
            yield row(
                *("Table II", f"ratio of lateral to yaw acceleration, {name} model, within both ways"),
                printed=ratio,
                computed=f"{low:.4g} ... {high:.4g}",
                unit="m/rad",
                equations=equations,
                agrees=low <= ratio <= high,
                reason="the ratio depends on no amplitude; it should lie between the two ways to enter",
                misprint=13,
                check="both ends by two routes",
                checked=all(reading.checked for reading in found),
            )


def readings(vehicle: Vehicle) -> tuple[Reading, Reading]:
    """Return both ways in which the disturbance may enter: the wheelset itself is moved, or the rail under it."""
    system = _system(vehicle)
    moved, forced = _ratio(_moved_wheelset(system)), _ratio(_forced_wheelset(system))
    rail, by_force = _ratio(_under_rail(system)), _ratio(_under_rail_by_polynomials(system))
    return (
        Reading(
            "the front wheelset itself moved", moved, "a force on the wheelset", isclose(moved, forced, rel_tol=SAME)
        ),
        Reading(
            "the rail moved under it, through gravity and conicity",
            rail,
            "the polynomial matrix",
            isclose(rail, by_force, rel_tol=SAME),
        ),
    )


def _run(bogie: PaperBogie, start: str, duration: float, step: float | None = None) -> Simulation:
    track = Sinusoid(1.0, DISTURBANCE)
    problem = bogie.problems[PRINTED]
    return simulate(problem, track, speed=SPEED_OF_FIGURE_2 / 3.6, start=start, duration=duration, step=step)


def _system(vehicle: Vehicle) -> System:
    return System(vehicle.replace(v=SPEED_OF_FIGURE_2 / 3.6))


def _ratio(amplitudes: dict[str, complex]) -> float:
    return abs(amplitudes["y_b"]) / abs(amplitudes["phi_b"])


def _by_name(names: tuple[str, ...], x: Any) -> dict[str, complex]:
    return {name: complex(value) for name, value in zip(names, x, strict=True)}


def _under_rail(system: System) -> dict[str, complex]:
    """Return the amplitudes of the coordinates when the rail under the front wheelset moves by 1 m, by states."""
    u = np.zeros((1, len(system.space.inputs)), dtype=complex)
    u[0, 0] = 1
    y = outputs(system, np.array([DISTURBANCE]), u)[0]
    return {name: complex(y[system.outputs[name]]) for name in system.coordinates}


def _dynamic_stiffness(system: System) -> tuple[tuple[str, ...], Complex]:
    """Return the nodes and the polynomial matrix at j omega."""
    entries = polynomial_matrix(system.vehicle.physical)
    nodes = tuple(dict.fromkeys(node for node, _ in entries))
    matrix = np.zeros((len(nodes), len(nodes)), dtype=complex)
    for (node, column), p in entries.items():
        matrix[nodes.index(node), nodes.index(column)] = evaluate(p, 1j * DISTURBANCE)
    return nodes, matrix


def _moved_wheelset(system: System) -> dict[str, complex]:
    """Return the amplitudes of all others when the front wheelset's lateral displacement is given as 1 m."""
    nodes, matrix = _dynamic_stiffness(system)
    moved = nodes.index("y_w1")
    free = [k for k in range(len(nodes)) if k != moved]
    x = np.linalg.solve(matrix[np.ix_(free, free)], -matrix[free, moved])
    return _by_name(tuple(nodes[k] for k in free), x)


def _forced_wheelset(system: System) -> dict[str, complex]:
    """Return the amplitudes under a lateral force on the front wheelset, by states: the same ratios."""
    place, size = system.coordinates.index("y_w1"), len(system.coordinates)
    force = np.zeros(len(system.A), dtype=complex)
    force[size + place] = 1
    x = np.linalg.solve(1j * DISTURBANCE * np.eye(len(system.A)) - system.A, force)
    return _by_name(system.coordinates, x[:size])


def _under_rail_by_polynomials(system: System) -> dict[str, complex]:
    """Return the amplitudes under the forces by which a rail moved by 1 m acts on the front wheelset."""
    nodes, matrix = _dynamic_stiffness(system)
    p = system.vehicle.p
    force = np.zeros(len(nodes), dtype=complex)
    # eqs (2) with y_w1 - y_a in the place of y_w1 in the gravity and conicity terms
    force[nodes.index("y_w1")] = p["W"] * p["lambda"] / p["b"]
    force[nodes.index("phi_w1")] = 2 * p["f_22"] * p["b"] * p["lambda"] / p["r"]
    return _by_name(nodes, np.linalg.solve(matrix, force))

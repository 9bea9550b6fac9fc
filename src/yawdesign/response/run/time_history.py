"""The vehicle's motion over a track: where it starts, what drives it, and its history."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import unknown_key
from yawdesign.response.run.frequency import states
from yawdesign.response.run.system import System
from yawdesign.response.run.time_steps import (
    clock_of,
    first_order_hold,
    forced,
    forced_by_lines,
    march,
    settled,
    time_step,
)
from yawdesign.response.track.lines import Clock, Lines, synthesise
from yawdesign.response.track.measured import MeasuredTrack
from yawdesign.response.track.tracks import AnyTrack, RandomTrack

USUAL_DURATION = 60.0  # [s]
USUAL_GROWTH, LEAST_DURATION = 7.0, 2.0  # an unstable bogie usually runs until it has grown by exp(7), or for 2 s
MOST_GROWTH = 250.0  # logarithm; a run that would grow by more is cut short, before squares of its numbers overflow


@dataclass(frozen=True, eq=False)
class History:
    """What happens during a run.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    time, distance : ndarray, shape (n,)
        Time [s] and way of the first wheelset [m].
    values : mapping of str to ndarray
        Track inputs (``alignment_1`` under the first wheelset, ...) and responses, in SI.
    units : mapping of str to str
        Their SI units.
    """

    speed: float
    time: Float
    distance: Float
    values: Mapping[str, Float]
    units: Mapping[str, str]

    def __getitem__(self, name: str) -> Float:
        return self.values[self._known(name)]

    def _known(self, name: str) -> str:
        if name not in self.values:
            raise ProblemError(f"{name} {unknown_key(name, self.values)}; there are {', '.join(self.values)}")
        return name

    def unit(self, name: str) -> str:
        """Return the SI unit of a column.

        Parameters
        ----------
        name : str
            One of `values`.
        """
        return self.units[self._known(name)]


@dataclass(frozen=True, eq=False)
class Plan:
    """How to run.

    Parameters
    ----------
    track : AnyTrack
        What to run over.
    duration, length : float or None
        Duration [s] or length [m] of a run, one of them at most.
    step : float or None
        Time step [s].
    start : str
        "stationary", "rest" or "offset".
    offset : mapping of str to float
        Displacements at the start.
    """

    track: AnyTrack
    duration: float | None
    length: float | None
    step: float | None
    start: str
    offset: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A motion, step by step.

    Parameters
    ----------
    start : str
        How it started.
    clock : Clock
        The instants.
    transition : ndarray
        exp(A step).
    u, y : ndarray
        Inputs and outputs at all instants.
    """

    start: str
    clock: Clock
    transition: Float
    u: Float
    y: Float

    def history(self, system: System) -> History:
        """Return inputs and outputs by name."""
        space, time = system.space, self.clock.time
        names, units = (*space.inputs, *space.outputs), (*space.input_units, *space.output_units)
        values = dict(zip(names, (*self.u.T, *self.y.T), strict=True))
        return History(system.v, time, time * system.v, values, dict(zip(names, units, strict=True)))


def move(system: System, plan: Plan, told: Callable[[float], Any] = lambda part: None) -> Trajectory:
    """Return the motion of a vehicle over a track; `told` is called with the share that is done."""
    told(0.0)
    clock = planned_clock(system, plan)
    hold = first_order_hold(system.A, system.B, clock.step)
    u, lines = _inputs(system, plan.track, clock)
    force = forced(hold, u) if lines is None else forced_by_lines(system, hold, lines, clock)
    start = "rest" if plan.start == "stationary" and not system.stable else plan.start
    x = _first_state(system, plan, start, hold.transition, force, u, lines)
    y = march(hold.transition, force, x, lambda part: told((1 + part) / 2)) @ system.C.T + u @ system.D.T
    return Trajectory(start, clock, hold.transition, u, y)


def planned_clock(system: System, plan: Plan) -> Clock:
    """Return the instants of the run of a vehicle."""
    abscissa = system.abscissa
    duration = plan.duration if plan.length is None else plan.length / system.v
    if isinstance(plan.track, MeasuredTrack):
        longest = plan.track.duration(system.wheelsets)
        if duration is not None and duration > longest * (1 + 1e-9):
            raise ProblemError(
                f"{plan.track.name}: {duration:g} s are too long, the measured track ends after {longest:.4g} s "
                f"at {3.6 * system.v:.4g} km/h"
            )
        duration = longest if duration is None else duration
    if duration is None:
        unstable = abscissa * USUAL_DURATION > USUAL_GROWTH
        duration = max(LEAST_DURATION, USUAL_GROWTH / abscissa) if unstable else USUAL_DURATION
    if abscissa * duration > MOST_GROWTH:
        duration = MOST_GROWTH / abscissa
    return clock_of(duration, time_step(system, plan.track.fastest(system.v), plan.step))


def _inputs(system: System, track: AnyTrack, clock: Clock) -> tuple[Float, Lines | None]:
    """Return the inputs at all instants, and their lines where these are few enough to be taken exactly."""
    if isinstance(track, MeasuredTrack):
        return track.inputs(system.wheelsets, clock), None
    if isinstance(track, RandomTrack):
        return synthesise(track.lines(system.wheelsets, clock.step * clock.steps), clock), None
    lines = track.lines(system.wheelsets)
    turned = np.exp(1j * np.outer(clock.time, lines.omega))
    return np.asarray((turned @ lines.amplitudes).real, dtype=float), lines


def _first_state(
    system: System, plan: Plan, start: str, transition: Float, force: Float, u: Float, lines: Lines | None
) -> Float:
    if start == "rest":
        return np.zeros(len(system.A))
    if start == "offset":
        return _displaced(system, plan.offset)
    if lines is not None:
        return np.asarray(states(system, lines.omega, lines.amplitudes).real.sum(axis=0))
    if isinstance(plan.track, RandomTrack):
        return settled(transition, force)
    return np.asarray(-np.linalg.solve(system.A, system.B @ u[0]))


def _displaced(system: System, offset: Mapping[str, float]) -> Float:
    """Return the state of a vehicle that was held displaced until its dampers had come to rest."""
    n = len(system.coordinates)
    x = np.zeros(len(system.A))
    for name, value in offset.items():
        x[system.coordinates.index(name)] = value
    strokes = slice(2 * n, None)
    if len(x) > 2 * n:
        x[strokes] = -np.linalg.solve(system.A[strokes, strokes], system.A[strokes, :n] @ x[:n])
    return x

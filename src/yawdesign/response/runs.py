"""One run of the bogie over a track: its history, and what is read from it."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log

import numpy as np

from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import unknown_key
from yawdesign.response.decay import fitted_rate
from yawdesign.response.frequency import states
from yawdesign.response.march import clock_of, first_order_hold, forced, forced_by_lines, march, settled, time_step
from yawdesign.response.measured import MeasuredTrack
from yawdesign.response.stationary import stationary_rms
from yawdesign.response.system import Float, System, unit_of
from yawdesign.response.track import Clock, Lines, RandomTrack, synthesise
from yawdesign.response.tracks import AnyTrack
from yawdesign.stability.modes import Complex, core_eigenvalues

USUAL_DURATION = 60.0  # [s]
MOST_GROWTH = 250.0  # logarithm; a run that would grow by more is cut short, before squares of its numbers overflow
AGREE = 0.01  # relative difference of two ways to the same number that is still called the same
NEUTRAL = 1e-2  # [1/s]: growth rates are compared relative to at least this


@dataclass(frozen=True, eq=False)
class History:
    """What happens during a run.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    time, distance : ndarray, shape (n,)
        Time [s] and way of the front wheelset [m].
    values : mapping of str to ndarray
        Track inputs (``alignment_1`` under the front wheelset, ...) and responses, in SI.
    """

    speed: float
    time: Float
    distance: Float
    values: Mapping[str, Float]

    def __getitem__(self, name: str) -> Float:
        if name not in self.values:
            raise ProblemError(f"{name} {unknown_key(name, self.values)}; there are {', '.join(self.values)}")
        return self.values[name]

    def unit(self, name: str) -> str:
        """Return the SI unit of a column.

        Parameters
        ----------
        name : str
            One of `values`.
        """
        return "rad" if name.startswith("cross_level") else unit_of(name)


@dataclass(frozen=True)
class Run:
    """What is read from one run.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    start : str
        "stationary", "rest" or "offset"; an unstable bogie starts from rest where "stationary" was asked for.
    duration, step : float
        Length of the run and time step [s].
    stable : bool
        Whether all eigenvalues lie in the left half-plane.
    spectral_abscissa : float
        Largest real part of the eigenvalues [1/s].
    fitted_rate : float
        Growth rate fitted on a free motion, computed with the same time steps [1/s]; negative if it dies out.
    frequency, damping_ratio : float or None
        Of the least damped oscillation of the coupled motion [Hz], [-].
    settles : bool
        Whether amplitudes settle: eigenvalues and fitted rate are both negative.
    verdict : str
        The same in words.
    rms, peak : mapping of str to float
        Root mean square and largest size of every response in this run, in SI.
    rms_stationary : mapping of str to float, or None
        Root mean square on an endless track of the same spectrum, by integration over the spectrum; None if the bogie
        is unstable or the track not random.
    checked : bool
        True if fitted rate and eigenvalue agree to 1 %, and, in a stationary run over a random track, the root mean
        square of y_b and phi_b and the sum over their frequency responses.
    """

    speed: float
    start: str
    duration: float
    step: float
    stable: bool
    spectral_abscissa: float
    fitted_rate: float
    frequency: float | None
    damping_ratio: float | None
    settles: bool
    verdict: str
    rms: Mapping[str, float]
    peak: Mapping[str, float]
    rms_stationary: Mapping[str, float] | None
    checked: bool


@dataclass(frozen=True, eq=False)
class Plan:
    """How to run.

    Parameters
    ----------
    track : Track
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


def run(system: System, plan: Plan) -> tuple[Run, History]:
    """Run a bogie over a track."""
    s = system.eigenvalues
    abscissa = float(s.real.max())
    clock = _clock(system, plan, abscissa)
    hold = first_order_hold(system.A, system.B, clock.step)
    u, lines = _inputs(system, plan.track, clock)
    force = forced(hold, u) if lines is None else forced_by_lines(system, hold, lines, clock)
    start = "rest" if plan.start == "stationary" and abscissa >= 0 else plan.start
    x = _first_state(system, plan, start, hold.transition, force, u, lines)
    y = march(hold.transition, force, x) @ system.C.T + u @ system.D.T
    rate, _ = fitted_rate(hold.transition, clock.step, len(system.coordinates), _slowest(s))
    rms = _named(system, np.sqrt(np.mean(y**2, axis=0)))
    random = isinstance(plan.track, RandomTrack) and abscissa < 0
    expected = stationary_rms(system, plan.track) if random and isinstance(plan.track, RandomTrack) else None
    checked = _agree(rate, abscissa) and (start != "stationary" or _as_expected(system, plan.track, clock, rms))
    frequency, ratio = hunting(system)
    settles = abscissa < 0 and rate < 0
    report = Run(
        speed=system.v,
        start=start,
        duration=clock.step * clock.steps,
        step=clock.step,
        stable=abscissa < 0,
        spectral_abscissa=abscissa,
        fitted_rate=rate,
        frequency=frequency,
        damping_ratio=ratio,
        settles=settles,
        verdict=_verdict(rate, settles, abscissa < 0),
        rms=rms,
        peak=_named(system, np.max(np.abs(y), axis=0)),
        rms_stationary=expected,
        checked=checked,
    )
    return report, _history(system, clock, u, y)


def _clock(system: System, plan: Plan, abscissa: float) -> Clock:
    duration = plan.duration if plan.length is None else plan.length / system.v
    if isinstance(plan.track, MeasuredTrack):
        longest = plan.track.duration(system)
        if duration is not None and duration > longest * (1 + 1e-9):
            raise ProblemError(
                f"{plan.track.name}: {duration:g} s are too long, the measured track ends after {longest:.4g} s "
                f"at {3.6 * system.v:.4g} km/h"
            )
        duration = longest if duration is None else duration
    duration = USUAL_DURATION if duration is None else duration
    if abscissa * duration > MOST_GROWTH:
        duration = MOST_GROWTH / abscissa
    return clock_of(duration, time_step(system, plan.track.fastest(system.v), plan.step))


def _inputs(system: System, track: AnyTrack, clock: Clock) -> tuple[Float, Lines | None]:
    """Return the inputs at all instants, and their lines where these are few enough to be taken exactly."""
    if isinstance(track, MeasuredTrack):
        return track.inputs(system, clock), None
    if isinstance(track, RandomTrack):
        return synthesise(track.lines(system, clock.step * clock.steps), clock), None
    lines = track.lines(system)
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
    """Return the state of a bogie that was held displaced until its dampers had come to rest."""
    n = len(system.coordinates)
    x = np.zeros(len(system.A))
    for name, value in offset.items():
        x[system.coordinates.index(name)] = value
    strokes = slice(2 * n, None)
    if len(x) > 2 * n:
        x[strokes] = -np.linalg.solve(system.A[strokes, strokes], system.A[strokes, :n] @ x[:n])
    return x


def _named(system: System, values: Float) -> dict[str, float]:
    return {name: float(values[k]) for name, k in system.outputs.items()}


def _history(system: System, clock: Clock, u: Float, y: Float) -> History:
    inputs = ("alignment_1", "cross_level_1", "alignment_2", "cross_level_2")
    values = {name: u[:, k] for k, name in enumerate(inputs)}
    values |= {name: y[:, k] for name, k in system.outputs.items()}
    return History(system.v, clock.time, clock.time * system.v, values)


def _slowest(s: Complex) -> float:
    """Return the frequency whose period is a window in which to measure amplitudes [Hz]."""
    near = s[(s.imag > 0) & (s.real > s.real.max() - 10)]
    return float(near.imag.min() / (2 * np.pi)) if len(near) else float(max(1.0, abs(s.real.max())))


def _agree(one: float, two: float) -> bool:
    return abs(one - two) <= AGREE * max(abs(two), NEUTRAL)


def _as_expected(system: System, track: AnyTrack, clock: Clock, rms: Mapping[str, float]) -> bool:
    """Tell whether the run has the mean squares that frequency responses give for the lines of its track."""
    if not isinstance(track, RandomTrack):
        return True
    lines = track.lines(system, clock.step * clock.steps)
    x = states(system, lines.omega, lines.amplitudes)
    squares = np.sum(np.abs(x) ** 2, axis=0) / 2
    return all(_close(rms[name], np.sqrt(squares[system.coordinates.index(name)])) for name in ("y_b", "phi_b"))


def _close(one: float, two: float) -> bool:
    return abs(one - two) <= AGREE * abs(two)


def hunting(system: System) -> tuple[float | None, float | None]:
    """Return frequency [Hz] and damping ratio of the least damped oscillation of the coupled motion."""
    s = core_eigenvalues(system.p, system.C_s, **system.model)
    swings = s[s.imag > 0]
    if not len(swings):
        return None, None
    ratios = -swings.real / np.abs(swings)
    k = int(np.argmin(ratios))
    return float(swings[k].imag / (2 * np.pi)), float(ratios[k])


def _verdict(rate: float, settles: bool, stable: bool) -> str:
    if settles:
        return f"amplitudes settle: a free motion falls to a tenth in {log(10) / -rate:.3g} s"
    if stable or rate <= 0:
        return "on the edge of stability: the motion itself does not tell whether amplitudes settle"
    return (
        f"UNSTABLE: amplitudes do not settle, they grow tenfold in {log(10) / rate:.3g} s; root mean square and peak "
        "belong to this length of run alone (flanges and saturating creep would limit them, a linear model has neither)"
    )

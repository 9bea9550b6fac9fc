"""What is read from a run: sizes of the responses, growth or decay, and whether amplitudes settle."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log, pi

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.problem.arguments import Progress
from yawdesign.problem.progress import unseen
from yawdesign.response.modes.names import named_roots
from yawdesign.response.run.frequency import states
from yawdesign.response.run.ride_comfort import weighted_in_run
from yawdesign.response.run.stationary import stationary_rms
from yawdesign.response.run.system import System
from yawdesign.response.run.time_history import History, Plan, Trajectory, move
from yawdesign.response.track.lines import Clock
from yawdesign.response.track.tracks import AnyTrack, RandomTrack
from yawdesign.vehicle.elements import Mass
from yawdesign.vehicle.vehicle import Vehicle

AGREE = 0.01  # relative difference of two ways to the same number that is still called the same
ROUNDING = 1e-9  # of the largest displacement: less is none
NEUTRAL = 1e-2  # [1/s]: growth rates are compared relative to at least this
SLOW = ("car body", "bogie frame")  # bodies for which the straight lines between two instants are no coarse track
FASTEST_DECAY = 50.0  # logarithm by which a motion may change within one window of the fit


@dataclass(frozen=True)
class Run:
    """What is read from one run.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    start : str
        "stationary", "rest" or "offset"; an unstable vehicle starts from rest where "stationary" was asked for.
    duration, step : float
        Length of the run and time step [s].
    stable : bool
        Whether all eigenvalues lie in the left half-plane.
    spectral_abscissa : float
        Largest real part of the eigenvalues [1/s].
    fitted_rate : float
        Growth rate fitted on a free motion, computed with the same time steps [1/s]; negative if it dies out.
    frequency, damping_ratio : float or None
        Of the hunting [Hz], [-]: the mode that `yawdesign.modes` calls so; None if nothing that oscillates depends on
        the conicity.
    settles : bool
        Whether amplitudes settle: eigenvalues and fitted rate are both negative.
    verdict : str
        The same in words.
    rms, peak : mapping of str to float
        Root mean square and largest size of every response in this run, in SI.
    rms_weighted : mapping of str to float
        Root mean square of the car body's lateral acceleration above each bogie in this run, weighted by W_d of ISO
        2631-1 [m/s^2]; empty without a car body.
    rms_stationary : mapping of str to float, or None
        Root mean square on a track of the same spectrum without an end, in SI, by integration over the spectrum; None
        if the vehicle is unstable or the track not random.
    checked : bool
        True if fitted rate and eigenvalue agree to 1 %, and, in a stationary run over a random track, the root mean
        squares of bogie frames and car body and the sums over their frequency responses.
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
    rms_weighted: Mapping[str, float]
    rms_stationary: Mapping[str, float] | None
    checked: bool


def run(system: System, plan: Plan, progress: Progress = unseen) -> tuple[Run, History]:
    """Run a vehicle over a track; `progress` is called with a text and the share that is done."""
    at = f"at {3.6 * system.v:.4g} km/h"
    trajectory = move(system, plan, lambda part: progress(f"running {at}", 0.7 * part))
    progress(f"checking the run {at}", 0.7)
    return _report(system, plan.track, trajectory), trajectory.history(system)


def _report(system: System, track: AnyTrack, trajectory: Trajectory) -> Run:
    abscissa, clock = system.abscissa, trajectory.clock
    slowest = _slowest(system.eigenvalues)
    rate, _ = fitted_rate(trajectory.transition, clock.step, len(system.coordinates), slowest)
    rms = system.named(np.sqrt(np.mean(trajectory.y**2, axis=0)))
    frequency, ratio = hunting(system.vehicle)
    stable = system.stable
    settles = stable and rate < 0
    as_expected = trajectory.start != "stationary" or _as_expected(system, track, clock, rms)
    return Run(
        speed=system.v,
        start=trajectory.start,
        duration=clock.step * clock.steps,
        step=clock.step,
        stable=stable,
        spectral_abscissa=abscissa,
        fitted_rate=rate,
        frequency=frequency,
        damping_ratio=ratio,
        settles=settles,
        verdict=_verdict(rate, settles, stable),
        rms=rms,
        peak=system.named(np.max(np.abs(trajectory.y), axis=0)),
        rms_weighted=weighted_in_run(system, trajectory.y, clock.step),
        rms_stationary=stationary_rms(system, track) if stable and isinstance(track, RandomTrack) else None,
        checked=_agree(rate, abscissa) and as_expected,
    )


def _slowest(s: Complex) -> float:
    """Return the frequency whose period is a window in which to measure amplitudes [Hz]."""
    near = s[(s.imag > 0) & (s.real > s.real.max() - 10)]
    slowest = float(near.imag.min() / (2 * np.pi)) if len(near) else 1.0
    return max(slowest, float(abs(s.real.max())) / FASTEST_DECAY)


def _agree(one: float, two: float) -> bool:
    return abs(one - two) <= AGREE * max(abs(two), NEUTRAL)


def _as_expected(system: System, track: AnyTrack, clock: Clock, rms: Mapping[str, float]) -> bool:
    """Tell whether the run has the mean squares that frequency responses give for the lines of its track."""
    if not isinstance(track, RandomTrack):
        return True
    lines = track.lines(system.wheelsets, clock.step * clock.steps)
    x = states(system, lines.omega, lines.amplitudes)
    expected = np.sqrt(np.sum(np.abs(x[:, : len(system.coordinates)]) ** 2, axis=0) / 2)
    still = ROUNDING * float(expected.max())  # a frame that nothing couples to the wheelsets does not move
    slow = {e.coordinate for e in system.space.elements if isinstance(e, Mass) and e.body in SLOW}
    sizes = {name: size for name, size in zip(system.coordinates, expected, strict=True) if name in slow}
    return all(abs(rms[name] - size) <= AGREE * size + still for name, size in sizes.items())


def hunting(vehicle: Vehicle) -> tuple[float | None, float | None]:
    """Return frequency [Hz] and damping ratio of the hunting of a vehicle, the same root as in `yawdesign.modes`."""
    root = next((root for root in named_roots(vehicle) if root.hunting), None)
    if root is None:
        return None, None
    s = root.s
    return s.imag / (2 * pi), -s.real / abs(s)


def _verdict(rate: float, settles: bool, stable: bool) -> str:
    if settles:
        return f"amplitudes settle: a free motion falls to a tenth in {log(10) / -rate:.3g} s"
    if stable or rate <= 0:
        return "on the edge of stability: the motion itself does not tell whether amplitudes settle"
    return (
        f"UNSTABLE: amplitudes do not settle, they grow tenfold in {log(10) / rate:.3g} s; root mean square and peak "
        "belong to this length of run alone (flanges and saturating creep would limit them, a linear model has neither)"
    )


SAMPLES = 40  # instants in which the size of the motion is averaged
MOST_WINDOWS = 1500
REGRESSION = 30  # windows that a straight line is laid through
SETTLED = 1e-3  # the slope has settled when it changes by less than this part of itself


def fitted_rate(transition: Float, step: float, coordinates: int, slowest: float) -> tuple[float, float]:
    """Return the growth rate [1/s] fitted on a free motion, negative if it dies out, and how long that was watched [s].

    All coordinates are displaced by different amounts and released. In each of many equal windows the root mean square
    of the displacements is taken; a straight line through its logarithm has the slope looked for, once the faster modes
    have died out and the slope no longer changes.

    Parameters
    ----------
    transition : ndarray, shape (n, n)
        exp(A step).
    step : float
        Time step [s].
    coordinates : int
        Number of states, from the first one on, that are displacements.
    slowest : float
        Frequency of the slowest oscillation that matters [Hz]; a window holds one period of it.
    """
    stride = max(1, round(1 / (slowest * SAMPLES * step)))
    jump = np.linalg.matrix_power(transition, stride)
    window = SAMPLES * stride * step
    x = np.zeros(len(transition))
    x[:coordinates] = 1 + np.arange(coordinates) / coordinates
    levels: list[float] = []
    lifted, before = 0.0, np.nan
    while len(levels) < MOST_WINDOWS:
        for _ in range(REGRESSION):
            x, size = _watch(jump, x, coordinates)
            levels.append(np.log(size) + lifted)
            scale = float(np.linalg.norm(x))
            x, lifted = x / scale, lifted + np.log(scale)
        half = levels[-max(REGRESSION, len(levels) // 2) :]
        slope = float(np.polyfit(window * np.arange(len(half)), half, 1)[0])
        if abs(slope - before) <= SETTLED * abs(slope):
            break
        before = slope
    return slope, len(levels) * window


def _watch(jump: Float, x: Float, coordinates: int) -> tuple[Float, float]:
    total = 0.0
    for _ in range(SAMPLES):
        x = jump @ x
        total += float(x[:coordinates] @ x[:coordinates])
    return x, float(np.sqrt(total / SAMPLES))

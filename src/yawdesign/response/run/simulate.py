"""Runs of a problem's vehicle over a track, at one speed or several."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, Chosen, chosen
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress, checked
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.progress import between
from yawdesign.problem.result import Result
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_choice, as_quantity, as_seed, as_several
from yawdesign.response.run.damper_component import DamperComponent, components
from yawdesign.response.run.run import Run, run
from yawdesign.response.run.system import System, system_at
from yawdesign.response.run.time_history import History, Plan, planned_clock
from yawdesign.response.track.tracks import Band, as_track
from yawdesign.vehicle.signals import BOGIES, first_looked_at
from yawdesign.vehicle.vehicle import Model

USUAL_OFFSET = 0.01  # [m]
MOST_TOGETHER = 10_000_000  # steps of all runs, which are kept in memory: about 5 GB
STARTS = ("stationary", "rest", "offset")


@dataclass(frozen=True, repr=False, eq=False)
class Simulation(Result):
    """The vehicle on a track: what was read from the runs, and their histories.

    Names of responses: the coordinates ``y_b, phi_b, y_w1, ...``, with ``_velocity`` and ``_acceleration``;
    ``lateral_force_1`` and ``_2``, what the rails do to each wheelset by gravity and creep; ``yaw_damper_force`` and
    ``yaw_damper_stroke`` of each yaw damper's piston, ``yaw_damper_displacement`` with its joints, and
    ``yaw_damper_pair_force`` of both together; ``lateral_damper_force_1``, ``lateral_damper_stroke_1``, ``..._2``, and
    likewise for the motors' dampers. The state space and the FMU use the same names.

    Under a car body ``y_c, psi_c, th_c`` the number of the bogie comes first, 1 for the leading one: ``y_b1, y_w12,
    lateral_force_21, yaw_damper_force_2, ...``; ``y_c1_acceleration`` and ``y_c2_acceleration`` are those of the car
    body above the centres of both bogies, as high as its centre of mass.

    Parameters
    ----------
    track : str
        What was run over.
    notes : tuple of str
        What else there is to know about the track.
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    settles : bool
        Whether amplitudes settle at every speed.
    speed : float
        The speed of the least decay rate [m/s], to which the next entries belong.
    rms, peak : mapping of str to float
        Root mean square and largest size of each response there, in SI.
    damper : DamperComponent or None
        The yaw damper as a component, there, of two bogies that with the greater force; None if C_s is 0.
    dampers : tuple of DamperComponent
        The yaw dampers of both bogies, the leading one first; one of a bogie alone.
    runs : tuple of Run
        One for each speed.
    checked : bool
        True if all checks of all runs hold.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] if there
        is one only, and what else is not as written, in SI units.
    histories : tuple of History
        One for each speed; they are not part of `to_dict`.
    """

    track: str
    notes: tuple[str, ...]
    C_s: float
    settles: bool
    speed: float
    rms: Mapping[str, float]
    peak: Mapping[str, float]
    damper: DamperComponent | None
    dampers: tuple[DamperComponent, ...]
    runs: tuple[Run, ...]
    checked: bool
    condition: Mapping[str, Any]
    histories: tuple[History, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, without the histories."""
        return {name: value for name, value in super().to_dict().items() if name != "histories"}

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        columns: dict[str, Any] = {
            "speed": np.concatenate([np.full(len(one.time), one.speed) for one in self.histories]),
            "time": np.concatenate([one.time for one in self.histories]),
            "distance": np.concatenate([one.distance for one in self.histories]),
        }
        names = self.histories[0].values
        columns |= {name: np.concatenate([one.values[name] for one in self.histories]) for name in names}
        return {"histories": columns, **{name: x for name, x in super()._tables().items() if name != "histories"}}

    def _units(self) -> Mapping[str, str]:
        return self.histories[0].units

    def __repr__(self) -> str:
        head = f"Simulation on {self.track} with C_s = {self.C_s:.9g} N s/m"
        rows = (
            f"  {3.6 * one.speed:.4g} km/h: {', '.join(self._sizes(one))} (RMS), "
            f"free motion {one.fitted_rate:+.4g} 1/s; {one.verdict}"
            for one in self.runs
        )
        return "\n".join([head, *rows])

    def _sizes(self, one: Run) -> Iterator[str]:
        for name in first_looked_at(one.rms):
            unit = self.histories[0].unit(name)
            factor, prefix = (1e3, "m") if unit in ("m", "rad") else (1.0, "")
            yield f"{name} {factor * one.rms[name]:.4g} {prefix}{unit}"


def simulate(
    problem: Problem,
    track: Any = "german-low",
    *,
    speed: Any = None,
    duration: Any = None,
    length: Any = None,
    step: Any = None,
    start: str = "stationary",
    offset: Any = None,
    band: Any = None,
    seed: int | None = None,
    condition: Asked = AS_WRITTEN,
    progress: Progress = lambda text, part: None,
) -> Simulation:
    """Run a problem's vehicle over a track: its bogie alone, or a car body on two of them.

    The time steps are exact for inputs that run straight from one instant to the next (first-order hold by the matrix
    exponential), and for harmonic tracks exact as they are.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.
    track : str, path, Spectrum or track
        ``german-low`` (default), ``german-high``, ``fra-1`` to ``fra-6``, ``german:A_a=2e-7,A_v=4e-7`` or
        ``fra:A=2e-6`` with other coefficients [m^2 rad/m], ``harmonic`` (20 m, 5 mm), ``sinusoid`` (of Table II),
        ``smooth``, a file with a measured track or a spectrum (`read_track`, `read_spectrum`), or one of the objects
        `Harmonic`, `Sinusoid`, `Spectrum`, `RandomTrack`, `MeasuredTrack`.
    speed : float, str or sequence of them, optional
        Speeds [m/s] or texts with units; those of the problem if not given.
    duration, length : float or str, optional
        Duration [s] or length [m] of each run; if not given, 60 s, of an unstable bogie less (until it has grown a
        thousandfold), or the whole of a measured track. A random track repeats itself after this length.
    step : float or str, optional
        Largest time step [s]; 1 ms, or finer where the bogie or the track move faster, if not given.
    start : {"stationary", "rest", "offset"}
        Already in the stationary motion (on a measured track: settled on its first values; an unstable bogie, which has
        no stationary motion, starts from rest instead), at rest, or displaced.
    offset : float, str or mapping of str to float
        For the start "offset": lateral displacement of all bodies [m], 10 mm if not given, or displacements by
        coordinate [m], [rad].
    band : Band or pair, optional
        Of a spectrum, as frequencies ``("0.3 Hz", "40 Hz")``, the default, or along the track
        ``("0.024 1/m", "0.333 1/m")``.
    seed : int, optional
        Of a spectrum's random phases; 0 if not given.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, the speeds among them, or values such as
        ``{"lambda": 0.4, "creep_factor": 0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the
        others stay as written.
    progress : callable
        Called with a text and the part that is done, 0 to 1.

    Returns
    -------
    Simulation

    Raises
    ------
    ProblemError
        If a value is not accepted, a file has mistakes, ``C_s`` is missing, or the step is too coarse.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")
    >>> result = yd.simulate(problem, speed=["250 km/h", "300 km/h"])
    >>> [round(1e3 * run.rms["y_b"], 2) for run in result.runs]  # mm
    [3.41, 3.85]
    >>> [round(run.fitted_rate, 2) for run in result.runs], result.settles
    ([-1.68, -1.37], True)
    """
    found: dict[str, Any] = {}
    mistakes = Mistakes()
    for name, read in (
        ("track", lambda: as_track(track, band=_band(band), seed=as_seed(seed))),
        ("speed", lambda: _speeds(speed)),
        ("duration", lambda: _positive(duration, "s")),
        ("length", lambda: _positive(length, "m", alone=duration is None)),
        ("step", lambda: _positive(step, "s")),
        ("start", lambda: as_choice(start, STARTS)),
        ("offset", lambda: _offsets(problem, offset, start)),
    ):
        with mistakes.under(name if name != "track" else ""):
            found[name] = read()
    with mistakes.under(""):
        given_damping(problem)
        asked = chosen(problem, condition, found.pop("speed", ()))
    mistakes.report()
    return _simulation(asked, Plan(**found), progress)


def _simulation(asked: Chosen, plan: Plan, progress: Progress) -> Simulation:
    runs: list[Run] = []
    histories: list[History] = []
    systems = [system_at(asked.problem, float(v)) for v in asked.speeds]
    _check_steps(systems, plan)
    for k, system in enumerate(systems):
        one, history = run(system, plan, between(progress, k / len(systems), (k + 1) / len(systems)))
        runs.append(one)
        histories.append(history)
    worst, system = max(zip(runs, systems, strict=True), key=lambda both: both[0].spectral_abscissa)
    dampers = components(system, worst)
    return Simulation(
        track=plan.track.name,
        notes=plan.track.notes,
        C_s=given_damping(asked.problem),
        settles=all(one.settles for one in runs),
        speed=worst.speed,
        rms=worst.rms,
        peak=worst.peak,
        damper=max(dampers, key=lambda damper: damper.force_rms, default=None),
        dampers=dampers,
        runs=tuple(runs),
        checked=all(one.checked for one in runs) and all(damper.checked for damper in dampers),
        condition=asked.described(worst.speed if len(runs) == 1 else None),
        histories=tuple(histories),
    )


def _check_steps(systems: Sequence[System], plan: Plan) -> None:
    steps = sum(planned_clock(system, plan).steps for system in systems)
    if steps > MOST_TOGETHER:
        text = f"{len(systems)} runs have {steps} steps together, at most {MOST_TOGETHER} are kept"
        raise ProblemError(f"speed: {text}: give fewer speeds or shorter runs")


def response_names(problem: Problem) -> tuple[str, ...]:
    """Return the names of all track inputs and responses of a problem's vehicle, as in `History.values`.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.
    """
    space = system_at(problem, problem.speeds[0]).space
    return (*space.inputs, *space.outputs)


def damper_component(problem: Problem, bogie: str = "", **options: Any) -> DamperComponent:
    """Return the yaw damper as a component to order, with what it does in a run.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s`` that is more than 0.
    bogie : {"leading", "trailing"}, optional
        Of a vehicle with a car body; that with the greater force if not given.
    **options
        Of `simulate`, for the run.

    Returns
    -------
    DamperComponent
        Dynamic stiffness, phase and force of the damper, with units.

    Raises
    ------
    ProblemError
        If ``C_s`` is 0, or as `simulate` does.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")
    >>> damper = yd.damper_component(problem, duration="10 s")
    >>> damper.C_each, round(damper.at_hunting.stiffness / 1e6, 2)
    (523385.0, 15.44)
    """
    names = {f"yaw damper {end}": which for end, which in BOGIES.items()} if problem.car_body else {}
    if bogie:
        if not names:
            raise ProblemError(f"bogie: {bogie!r} is none of two: leave it out, or give the problem a car_body")
        as_choice(bogie, tuple(names.values()))
    found = checked(simulate)(problem, **options)
    dampers = [damper for damper in found.dampers if not bogie or names[damper.name] == bogie]
    if not dampers:
        raise ProblemError("bogie.C_s is 0: there is no yaw damper to order")
    return max(dampers, key=lambda damper: damper.force_rms)


def _band(band: Any) -> Band | None:
    if band is None or isinstance(band, Band):
        return band
    if isinstance(band, str) or len(as_several(band)) != 2:
        raise ProblemError(f"band: {band!r} is not a pair, such as ('0.3 Hz', '40 Hz')")
    return Band(*band)


def _speeds(speed: Any) -> tuple[float, ...]:
    """Return speeds that are given in place of those of the problem [m/s]."""
    if speed is None:
        return ()
    listed = as_several(speed)
    if not listed:
        raise ProblemError("no speed is given")
    return tuple(SPEED.accept(v) for v in listed)


def _positive(value: Any, unit: str, *, alone: bool = True) -> float | None:
    if value is None:
        return None
    if not alone:
        raise ProblemError("give duration or length, not both")
    number = float(as_quantity(value, unit))
    if not number > 0:
        raise ProblemError(f"{value} must be more than 0")
    return number


def _offsets(problem: Problem, offset: Any, start: str) -> dict[str, float]:
    if start != "offset":
        if offset is not None:
            raise ProblemError('is used with the start "offset" alone')
        return {}
    units = Model.of(problem).coordinates
    offset = USUAL_OFFSET if offset is None else offset
    given = offset if isinstance(offset, Mapping) else {x: offset for x, unit in units.items() if unit == "m"}
    mistakes = Mistakes()
    values = {}
    for name, value in given.items():
        with mistakes.under(name):
            if name not in units:
                raise ProblemError(unknown_key(name, tuple(units)))
            values[name] = float(as_quantity(value, units[name]))
    mistakes.report()
    return values

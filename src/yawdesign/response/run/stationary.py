"""Stationary root mean squares on a random track, by integration over the spectrum."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.result import Result
from yawdesign.response.run.frequency import at_one_speed, outputs
from yawdesign.response.run.ride_comfort import accelerations, horizontal_weight
from yawdesign.response.run.system import System, system_at
from yawdesign.response.track.lines import INPUTS
from yawdesign.response.track.tracks import POINTS, WEIGHTS, RandomTrack, as_track

GRID = 150  # cells over the band, before the modes are looked at more closely
NEAR = 24  # cells on either side of a mode


@dataclass(frozen=True, repr=False)
class StationaryResponse(Result):
    """Root mean square of every response on a random track without an end.

    Parameters
    ----------
    track : str
        Name of the spectrum.
    band : str
        The part of the spectrum that is used.
    speed, C_s : float
        Speed [m/s] and damping of the pair of yaw dampers [N s/m].
    rms : mapping of str to float
        By response, in SI.
    rms_of : mapping of str to mapping
        The same, in SI, from "alignment" alone and from "cross_level" alone; the squares add up.
    rms_weighted : mapping of str to float
        Root mean square of the car body's lateral acceleration above each bogie, weighted by W_d of ISO 2631-1 [m/s^2];
        empty without a car body.
    method : str
        How it was found.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and what else is not as
        written, in SI units.
    """

    track: str
    band: str
    speed: float
    C_s: float
    rms: Mapping[str, float]
    rms_of: Mapping[str, Mapping[str, float]]
    rms_weighted: Mapping[str, float]
    method: str
    condition: Mapping[str, Any]

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        inputs = {which: [sizes[name] for name in self.rms] for which, sizes in self.rms_of.items()}
        return {"rms": {"name": list(self.rms), "rms": list(self.rms.values()), **inputs}}


def stationary_response(
    problem: Problem, track: Any = "german-low", *, speed: Any = None, condition: Asked = AS_WRITTEN
) -> StationaryResponse:
    """Return the stationary root mean square of every response, an integral over the spectrum.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.
    track : str or RandomTrack
        A spectrum, as in `simulate`; texts have the band from 0.3 to 40 Hz.
    speed : float or str, optional
        Speed [m/s] or text with a unit; the problem's own if it has a single one.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    StationaryResponse
        The RMS of every response, with its unit.

    Raises
    ------
    ProblemError
        If the bogie is unstable, so that nothing is stationary, or the track is not random.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")
    >>> round(1e3 * yd.stationary_response(problem).rms["y_b"], 2)  # mm
    3.85
    """
    road = as_track(track)
    if not isinstance(road, RandomTrack):
        raise ProblemError(f"track: {road.name} is not random, a stationary root mean square needs a spectrum")
    asked, v = at_one_speed(problem, condition, speed)
    system = system_at(asked.problem, v)
    if not system.stable:
        raise ProblemError(f"the vehicle is unstable at {3.6 * system.v:.4g} km/h: there is no stationary motion")
    found = {which: _mean_squares(system, road, which) for which in INPUTS}
    plain, weighted = np.sqrt(sum(found.values()))
    return StationaryResponse(
        track=road.name,
        band=str(road.band),
        speed=system.v,
        C_s=system.C_s,
        rms=system.named(plain),
        rms_of={which: system.named(np.sqrt(squares[0])) for which, squares in found.items()},
        rms_weighted={name: float(weighted[system.outputs[name]]) for name in accelerations(system)},
        method="integral over the spectrum",
        condition=asked.described(v),
    )


def stationary_rms(system: System, track: RandomTrack) -> dict[str, float]:
    """Return the stationary root mean square of every output of a stable vehicle."""
    return system.named(np.sqrt(sum(_mean_squares(system, track, which)[0] for which in INPUTS)))


def _mean_squares(system: System, track: RandomTrack, which: str) -> Float:
    """Return the mean squares of all outputs from one input, and with every output weighted by W_d, shape (2, m)."""
    if which not in track.spectrum.densities:
        return np.zeros((2, len(system.outputs)))
    edges = _cells(system, *(2 * np.pi * f for f in track.band.hertz(system.v)))
    half = np.diff(edges) / 2
    omega = ((edges[1:] + edges[:-1]) / 2)[:, None] + half[:, None] * POINTS
    S = track.spectrum.density(which, omega.ravel() / system.v) / system.v
    H = outputs(system, omega.ravel(), system.wheelsets.harmonic(omega.ravel(), which))
    weights = np.array([np.ones(omega.size), np.abs(horizontal_weight(omega.ravel())) ** 2])
    return np.asarray(weights * (half[:, None] * WEIGHTS).ravel() * S @ np.abs(H) ** 2)


def _cells(system: System, low: float, high: float) -> Float:
    """Return the ends of the cells of integration [rad/s], small where a mode resonates."""
    s = system.eigenvalues
    near = np.sinh(np.linspace(-6, 6, 2 * NEAR + 1))
    around = (s[s.imag > 0].imag[:, None] + np.abs(s[s.imag > 0].real)[:, None] * near).ravel()
    edges = np.concatenate([np.geomspace(low, high, GRID), around])
    return np.asarray(np.unique(np.clip(edges, low, high)))

"""The check of a synthesised track: its own spectrum beside the one it was made from."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.result import Result
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_choice, as_quantity, as_seed
from yawdesign.response.track.lines import INPUTS, MOST_STEPS, Clock, Wheelsets, synthesise
from yawdesign.response.track.tracks import RandomTrack, as_track

SEGMENTS = 16  # of a sample, for Welch's method
PER_WAVE = 10  # points in the shortest wave
CELLS = 2000


@dataclass(frozen=True, repr=False, eq=False)
class SpectrumCheck(Result):
    """Density of a synthesised sample beside the density it should have, over the wavenumber.

    Parameters
    ----------
    track : str
        Name of the spectrum.
    input : str
        "alignment" or "cross_level".
    wavenumber : ndarray, shape (n,)
        In the band [rad/m].
    target, sample : ndarray, shape (n,)
        One-sided densities [m^2/(rad/m)] or [rad^2/(rad/m)]; that of the sample by Welch's method.
    rms_target, rms_sample : float
        Root of the integral of the target over the band, and root mean square of the sample [m] or [rad].
    """

    track: str
    input: str
    wavenumber: Float
    target: Float
    sample: Float
    rms_target: float
    rms_sample: float

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        return {"densities": {name: getattr(self, name) for name in ("wavenumber", "target", "sample")}}

    def _units(self) -> Mapping[str, str]:
        unit = {"alignment": "m", "cross_level": "rad"}[self.input]
        return dict.fromkeys(("target", "sample"), f"{unit}^2/(rad/m)")


def spectrum_check(
    track: Any = "german-low",
    input: str = "alignment",  # noqa: A002 - the word of the field
    *,
    speed: Any = 300 / 3.6,
    length: Any = 20e3,
    seed: int | None = None,
) -> SpectrumCheck:
    """Return the spectrum of a synthesised track beside the one it was made from.

    Parameters
    ----------
    track : str or RandomTrack
        A spectrum, as in `simulate`.
    input : {"alignment", "cross_level"}
        What to look at.
    speed : float or str
        Speed [m/s] or text with a unit, by which a band in Hz becomes one along the track.
    length : float or str
        Length of the sample [m] or text with a unit.
    seed : int, optional
        Of the sample; 0 if not given.

    Returns
    -------
    SpectrumCheck
        Densities of the track beside those of the spectrum.

    Raises
    ------
    ProblemError
        If the track is not random, or its spectrum says nothing about the input.
    """
    from scipy.signal import welch

    mistakes = Mistakes()
    with mistakes.under("input"):
        as_choice(input, INPUTS)
    with mistakes.under("speed"):
        v = float(SPEED.accept(speed))
    with mistakes.under("length"):
        way = float(as_quantity(length, "m"))
        if not way > 0:
            raise ProblemError(f"{length} must be more than 0")
    mistakes.report()
    road = as_track(track, seed=as_seed(seed))
    if not isinstance(road, RandomTrack) or input not in road.spectrum.densities:
        raise ProblemError(f"track: {road.name} has no spectrum of {input}")
    low, high = road.band.hertz(v)
    steps = 2 * int(np.ceil(way / v * high * PER_WAVE / 2))
    if steps > MOST_STEPS:
        raise ProblemError(f"length: {way:g} m take {steps} points, at most {MOST_STEPS} are made")
    clock = Clock(way / v / steps, steps)
    first = Wheelsets(v, (0.0,), 0.0)
    sample = synthesise(road.lines(first, way / v), clock)[:-1, INPUTS.index(input)]
    f, S = welch(sample, fs=steps / way, nperseg=steps // SEGMENTS, detrend=False)
    inside = (f >= low / v) & (f <= high / v)
    W = 2 * np.pi * f[inside]
    return SpectrumCheck(
        track=road.name,
        input=input,
        wavenumber=W,
        target=road.spectrum.density(input, W),
        sample=S[inside] / (2 * np.pi),
        rms_target=float(np.sqrt(road.power(input, v, np.geomspace(low, high, CELLS)).sum())),
        rms_sample=float(np.sqrt(np.mean(sample**2))),
    )

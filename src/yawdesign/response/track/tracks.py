"""Tracks: what the wheelsets meet as they run along, each later by its distance from the first one; and their names."""

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike, fspath
from os.path import exists
from pathlib import Path
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.arguments import checked, named
from yawdesign.problem.diagnostics import Mistakes, suggestion
from yawdesign.problem.quantities import parse_quantity
from yawdesign.problem.table import as_choice, as_quantity
from yawdesign.problem.units import shortened
from yawdesign.response.track.lines import INPUTS, WAVELENGTH, Lines, Wheelsets
from yawdesign.response.track.measured import MeasuredTrack, track_of
from yawdesign.response.track.spectra import FORMS, SPECTRA, Spectrum, form_of
from yawdesign.response.track.tabulated_spectra import is_spectrum, spectrum_of
from yawdesign.response.track.text_sheets import read_sheet

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(6)
FEWEST_LINES = 2
TABLE_2 = 6.0  # angular frequency of the disturbance of Table II [rad/s]


@dataclass(frozen=True)
class Smooth:
    """A perfect track, for free motions."""

    name = "smooth"
    notes = ("a perfect track",)

    def fastest(self, v: float) -> float:
        """Return zero: nothing excites."""
        return 0.0

    def lines(self, wheelsets: Wheelsets) -> Lines:
        """Return no lines."""
        return Lines(np.zeros(0), wheelsets.harmonic(np.zeros(0), INPUTS[0]))


@named
@dataclass(frozen=True)
class Harmonic:
    """A harmonic track.

    Parameters
    ----------
    wavelength : float or str
        Wavelength [m] or text with a unit.
    amplitude : float or str
        Amplitude [m] of the alignment, or [rad] of the cross-level angle, or text with a unit.
    input : {"alignment", "cross_level"}
        What varies.

    Examples
    --------
    >>> Harmonic("20 m", "5 mm").amplitude
    0.005
    """

    wavelength: Any = 20.0
    amplitude: Any = 0.005
    input: str = "alignment"
    name = "harmonic"

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("wavelength"):
            object.__setattr__(self, "wavelength", float(WAVELENGTH.check(self.wavelength)))
        with mistakes.under("input"):
            as_choice(self.input, INPUTS)
        with mistakes.under("amplitude"):
            object.__setattr__(self, "amplitude", float(as_quantity(self.amplitude, self._unit)))
        mistakes.report()

    @property
    def _unit(self) -> str:
        return "rad" if isinstance(self.input, str) and self.input == "cross_level" else "m"

    @property
    def notes(self) -> tuple[str, ...]:
        """Amplitude and wavelength."""
        return (f"{self.input} of amplitude {self.amplitude:g} {self._unit}, wavelength {self.wavelength:g} m",)

    def fastest(self, v: float) -> float:
        """Return v / wavelength [Hz]."""
        return float(v / self.wavelength)

    def lines(self, wheelsets: Wheelsets) -> Lines:
        """Return the one line of this track."""
        omega = np.array([2 * np.pi * self.fastest(wheelsets.v)])
        return Lines(omega, self.amplitude * wheelsets.harmonic(omega, self.input))


@named
@dataclass(frozen=True)
class Sinusoid:
    """The disturbance of the paper's Table II: the track under the front wheelset moves by ``amplitude sin(omega t)``.

    Parameters
    ----------
    amplitude : float or str
        Amplitude [m] or text with a unit; the paper prints no unit.
    omega : float
        Angular frequency [rad/s]; the paper has 6.
    """

    amplitude: Any = 1.0
    omega: float = TABLE_2
    name = "sinusoid"

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("amplitude"):
            object.__setattr__(self, "amplitude", float(as_quantity(self.amplitude, "m")))
        with mistakes.under("omega"):
            object.__setattr__(self, "omega", float(as_quantity(self.omega, "rad/s")))
            if not self.omega > 0:
                raise ProblemError(f"{self.omega:g} must be more than 0")
        mistakes.report()

    @property
    def notes(self) -> tuple[str, ...]:
        """What is assumed."""
        return (
            f"y_a = {self.amplitude:g} m sin({self.omega:g} t) under the front wheelset alone, through gravity and "
            "conicity; unit, place of entry and time window of Table II are not printed",
        )

    def fastest(self, v: float) -> float:
        """Return the frequency, the same at every speed [Hz]."""
        return self.omega / (2 * np.pi)

    def lines(self, wheelsets: Wheelsets) -> Lines:
        """Return the one line of this track."""
        amplitudes = np.zeros((1, len(wheelsets.lags) * len(INPUTS)), dtype=complex)
        amplitudes[0, 0] = -1j * self.amplitude
        return Lines(np.array([self.omega]), amplitudes)


@named
@dataclass(frozen=True)
class Band:
    """What part of a spectrum is used.

    Parameters
    ----------
    low, high : float or str
        Frequencies as the train meets them [Hz] (numbers, or texts such as "0.3 Hz"), or cycles along the track
        ("0.024 1/m"), both ends in the same unit.
    """

    low: Any = 0.3
    high: Any = 40.0

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        ends: list[float] = []
        for key in ("low", "high"):
            with mistakes.under(f"band.{key}"):
                ends.append(self._checked(getattr(self, key)))
        mistakes.report()
        if self._along(self.low) != self._along(self.high):
            raise ProblemError(f"band: {self.low} and {self.high} must both be in Hz, or both in 1/m")
        if not ends[0] < ends[1]:
            raise ProblemError(f"band: the lower end {self.low} must be less than the upper end {self.high}")

    def _along(self, end: Any) -> bool:
        return isinstance(end, str) and end.strip().endswith("m")

    def _checked(self, end: Any) -> float:
        value = float(parse_quantity(end, "1/m") if self._along(end) else as_quantity(end, "Hz"))
        if not value > 0:
            raise ProblemError(f"{end} must be more than 0")
        return value

    def hertz(self, v: float) -> tuple[float, float]:
        """Return both ends at a speed [Hz]."""
        low, high = (self._checked(end) * (v if self._along(end) else 1.0) for end in (self.low, self.high))
        return low, high

    def __str__(self) -> str:
        return " to ".join(end if isinstance(end, str) else f"{end:g} Hz" for end in (self.low, self.high))


@checked
@dataclass(frozen=True, eq=False)
class RandomTrack:
    """Random irregularity with a given spectrum: harmonics of fixed amplitude and random phase, periodic in the run.

    Parameters
    ----------
    spectrum : Spectrum
        The densities.
    band : Band
        The part of the spectrum that is used.
    seed : int
        Of the phases: equal seeds give equal tracks.
    """

    spectrum: Spectrum
    band: Band = Band()
    seed: int = 0

    @property
    def name(self) -> str:
        """The spectrum's name."""
        return self.spectrum.name

    @property
    def notes(self) -> tuple[str, ...]:
        """Band and seed, and what the spectrum has to say."""
        return (f"irregularity from {self.band}, seed {self.seed}", *self.spectrum.notes)

    def fastest(self, v: float) -> float:
        """Return the upper end of the band [Hz]."""
        return self.band.hertz(v)[1]

    def power(self, which: str, v: float, edges: Float) -> Float:
        """Return the mean square of an irregularity between frequencies [Hz], as much of it as the band holds."""
        edges = 2 * np.pi / v * np.clip(edges, *self.band.hertz(v))
        middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
        W = middle[:, None] + half[:, None] * POINTS
        return np.asarray(half * (self.spectrum.density(which, W.ravel()).reshape(W.shape) @ WEIGHTS))

    def lines(self, wheelsets: Wheelsets, duration: float) -> Lines:
        """Return the harmonics of a run, at multiples of 1 / duration [s]."""
        v = wheelsets.v
        low, high = self.band.hertz(v)
        n = np.arange(max(1, round(low * duration)), round(high * duration) + 1)
        if len(n) < FEWEST_LINES:
            raise ProblemError(f"a run of {duration:g} s is too short for a track irregularity from {self.band}")
        edges = (np.append(n, n[-1] + 1) - 0.5) / duration
        edges[[0, -1]] = low, high
        omega = np.asarray(2 * np.pi * n / duration, dtype=float)
        random = np.random.default_rng(self.seed)
        first = np.empty((len(n), len(INPUTS)), dtype=complex)
        for k, which in enumerate(INPUTS):
            phase = np.exp(2j * np.pi * random.random(len(n)))
            first[:, k] = np.sqrt(2 * self.power(which, v, edges)) * phase
        return Lines(omega, wheelsets.passing(omega, first))


AnyTrack = Smooth | Harmonic | Sinusoid | RandomTrack | MeasuredTrack
PLAIN: dict[str, Callable[[], AnyTrack]] = {"harmonic": Harmonic, "sinusoid": Sinusoid, "smooth": Smooth}
NAMES = (*SPECTRA, *PLAIN, *(f"{form}:..." for form in FORMS))


def as_track(track: Any, *, band: Band | None = None, seed: int | None = None) -> AnyTrack:
    """Return the track that is meant.

    Parameters
    ----------
    track : str, path, Spectrum or track
        ``german-low``, ``german-high``, ``fra-1`` to ``fra-6``; coefficients of one's own such as
        ``german:A_a=2e-7,A_v=4e-7`` or ``fra:A=2e-6``; ``harmonic`` (20 m, 5 mm), ``sinusoid`` (Table II), ``smooth``;
        the name of a file with a measured track or with a spectrum; a `Spectrum`, or a track.
    band : Band, optional
        Of a spectrum; 0.3 to 40 Hz if not given.
    seed : int, optional
        Of a spectrum; 0 if not given.

    Raises
    ------
    ProblemError
        If there is no such track, its file has mistakes, or it is no spectrum and band or seed are given.
    """
    if not isinstance(track, (str, PathLike, Spectrum, AnyTrack)):
        raise ProblemError(f"track: {track!r} is no track: give one of {', '.join(NAMES)}, or a file")
    found = track if isinstance(track, (Spectrum, AnyTrack)) else _of_text(fspath(track))
    if isinstance(found, Spectrum):
        return RandomTrack(found, band or Band(), seed or 0)
    for name, given in (("band", band), ("seed", seed)):
        if given is not None:
            raise ProblemError(f"{name}: the track {found.name} takes none, a spectrum does")
    return found


def _of_text(text: str) -> Spectrum | AnyTrack:
    if text in PLAIN:
        return PLAIN[text]()
    if text in SPECTRA:
        return SPECTRA[text]
    if text.partition(":")[0] in FORMS and ":" in text:
        return form_of(text)
    if not exists(text) and not Path(text).suffix:  # noqa: PTH110 - also of names that are too long
        raise ProblemError(
            f"track: {shortened(text)!r} is not one of {', '.join(NAMES)}, nor a file{suggestion(text, NAMES)}"
        )
    sheet = read_sheet(text)
    return spectrum_of(sheet) if is_spectrum(sheet) else track_of(sheet)


def shaped(track: str, *, wavelength: str | None, amplitude: str | None) -> str | AnyTrack:
    """Return a track with the wavelength and amplitude given, which only ``harmonic`` and ``sinusoid`` have."""
    given = {name: x for name, x in (("wavelength", wavelength), ("amplitude", amplitude)) if x is not None}
    if track == "harmonic":
        return Harmonic(**given)
    if track == "sinusoid" and wavelength is None:
        return Sinusoid(amplitude) if given else Sinusoid()
    if given:
        raise ProblemError(f"track: {track} has no {' and no '.join(given)} to choose")
    return track

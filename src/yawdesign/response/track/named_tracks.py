"""From the name of a track, or of a file, to the track."""

from collections.abc import Callable
from os import PathLike, fspath
from os.path import exists
from pathlib import Path
from typing import Any

from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import suggestion
from yawdesign.problem.units import shortened
from yawdesign.response.track.measured import MeasuredTrack, track_of
from yawdesign.response.track.spectra import FORMS, SPECTRA, Spectrum, form_of
from yawdesign.response.track.tabulated_spectra import is_spectrum, spectrum_of
from yawdesign.response.track.text_sheets import read_sheet
from yawdesign.response.track.tracks import Band, Harmonic, RandomTrack, Sinusoid, Smooth

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

"""Pictures of how the vehicle answers a track: frequency responses, and the spectrum of a track that was made."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.output.panels import divided
from yawdesign.output.pictures import legend_below, literal, log_axis, log_numbers, new_axes, put_title, quantity
from yawdesign.output.response_words import body_name
from yawdesign.output.style import line_of
from yawdesign.problem import ProblemError, format_quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.frequency import FrequencyResponse
    from yawdesign.response.track.spectrum_check import SpectrumCheck

PER = {"alignment": "m of alignment", "cross_level": "rad of cross-level"}
PANELS = (("y", "Lateral", "m"), ("phi", "Yaw", "rad"))  # what coordinates begin with, and what they are
LIKE = {"psi": "phi"}
BODIES = ("c", "b", "b1", "b2")  # what is drawn of a vehicle, in the order of the lines


def frequency_response(result: "FrequencyResponse", ax: "Axes | None" = None) -> "Axes":
    """Draw the amplitudes of frames and car body over frequency: lateral ones above, yaw below.

    Parameters
    ----------
    result : FrequencyResponse
        At several wavelengths.
    ax : Axes, optional
        Where to draw; what belongs to yaw stands in axes of its own in the lower half of them.
    """
    if np.ndim(result.frequency) == 0:
        raise ProblemError("one wavelength makes no curve: give several to frequency_response")
    panels = divided(new_axes(ax), rows=(1, 1), shared=True)
    there = [body for body in BODIES if f"y_{body}" in result.amplitudes]
    for panel, (direction, word, unit) in zip(panels, PANELS, strict=True):
        for name, amplitude in result.amplitudes.items():
            stem, body = name.split("_")
            if LIKE.get(stem, stem) == direction and body in there:
                look: dict[str, Any] = line_of(there.index(body))
                panel.plot(result.frequency, abs(amplitude), label=body_name(body), **look)
        panel.set(xscale="log", yscale="log", ylabel=f"{word} [{unit} per\n{PER[result.input]}]")
        panel.grid()
    upper, lower = panels
    lower.set_xlim(float(np.min(result.frequency)), float(np.max(result.frequency)))
    log_axis(lower)
    lower.set_xlabel("frequency [Hz]")
    _add_wavelengths(upper, result.speed)
    title = f"Response to a harmonic track at {format_quantity(result.speed, 'km/h', 4)}, {quantity('C_s', result.C_s)}"
    put_title(upper, title + ("" if result.stable else " (unstable: free motions grow)"), result.condition)
    legend_below(lower)
    return upper


def _add_wavelengths(ax: "Axes", speed: float) -> None:
    """Draw a second horizontal axis above: the wavelengths of the track."""

    def other(x: Any) -> Any:
        return speed / np.maximum(x, 1e-9)

    above = ax.secondary_xaxis("top", functions=(other, other))
    above.set_xlabel("wavelength of the track [m]")
    log_numbers(above.xaxis, few=True)


def spectrum_check(result: "SpectrumCheck", ax: "Axes | None" = None) -> "Axes":
    """Draw the spectrum of a synthesised track beside the one it was made from.

    Parameters
    ----------
    result : SpectrumCheck
        What `spectrum_check` returns.
    ax : Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    factor, unit, density = {"alignment": (1e3, "mm", "m²"), "cross_level": (1e3, "mrad", "rad²")}[result.input]
    what = result.input.replace("_", "-")
    for k, (values, rms, text) in enumerate(_spectra(result)):
        look: dict[str, Any] = {**line_of(k), "linewidth": (0.8, 2.0)[k]}
        ax.loglog(result.wavenumber, values, label=f"{text}: {factor * rms:.3f} {unit} RMS", **look)
    ax.set(xlabel="wavenumber [rad/m]", ylabel=f"density of {what} [{density}/(rad/m)]")
    ax.margins(x=0)
    log_axis(ax)
    ax.grid()
    put_title(ax, f"Spectrum of a synthesised track: {what}, {literal(result.track)}")
    legend_below(ax)
    return ax


def _spectra(result: "SpectrumCheck") -> Sequence[tuple[Any, float, str]]:
    sample = (result.sample, result.rms_sample, "synthesised sample (Welch's method)")
    return sample, (result.target, result.rms_target, "asked for, in the band")

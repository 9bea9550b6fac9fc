"""Answers to a harmonic and to a random track as tables; nothing is computed here."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table

from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.output.response_words import SHOWN, meaning
from yawdesign.output.tables import damping, facts, speed, titled, verified
from yawdesign.problem import format_quantity

if TYPE_CHECKING:
    from yawdesign.response.run.frequency import FrequencyResponse
    from yawdesign.response.run.stationary import StationaryResponse
    from yawdesign.response.track.spectrum_check import SpectrumCheck

INPUT_UNITS = {"alignment": "m", "cross_level": "rad"}


def frequency_response_tables(result: "FrequencyResponse") -> RenderableType:
    """Return the tables of a `FrequencyResponse`: each answer, of several wavelengths the largest."""
    lengths, frequencies = np.atleast_1d(result.wavelength), np.atleast_1d(result.frequency)
    several = f"{lengths.min():g} ... {lengths.max():g} m, {lengths.size} values"
    rows = [
        ("input", f"{result.input.replace('_', '-')} of amplitude 1 {INPUT_UNITS[result.input]}"),
        ("wavelength", several if lengths.size > 1 else f"{lengths[0]:g} m"),
        ("frequency", " ... ".join(f"{f:.4g}" for f in sorted({frequencies.min(), frequencies.max()})) + " Hz"),
        ("free motions", "die out" if result.stable else "GROW: this is the motion without them"),
        ("condition", condition_in_words(result.condition)),
        ("checked", verified(result.checked)),
    ]
    at = f"at {speed(result.speed)} with C_s = {damping(result.C_s)}"
    title = "Largest amplitude of each coordinate" if lengths.size > 1 else "Amplitude of each coordinate"
    answers = titled(title, "", "meaning", "amplitude", "unit", "phase [°]", "wavelength [m]", "[Hz]")
    answers.columns[1].justify = answers.columns[3].justify = "left"
    for name, values in result.amplitudes.items():
        each = np.atleast_1d(values)
        k = int(np.argmax(np.abs(each)))
        numbers = f"{np.degrees(np.angle(each[k])):.1f}", f"{lengths[k]:.5g}", f"{frequencies[k]:.4g}"
        unit = f"{_unit(name)}/{INPUT_UNITS[result.input]}"
        answers.add_row(name, meaning(name), f"{abs(each[k]):.5g}", unit, *numbers)
    return Group(facts(f"Harmonic track, {at}", rows), answers)


def stationary_tables(result: "StationaryResponse") -> RenderableType:
    """Return the tables of a `StationaryResponse`."""
    rows = [
        ("band", result.band),
        ("found by", result.method),
        ("condition", condition_in_words(result.condition)),
        *(
            (f"{meaning(name)}, weighted by W_d", f"{value:.4g} m/s² RMS")
            for name, value in result.rms_weighted.items()
        ),
    ]
    at = f"at {speed(result.speed)} with C_s = {damping(result.C_s)}"
    return Group(facts(f"Track {result.track} without an end, {at}", rows), _sizes(result))


def _sizes(result: "StationaryResponse") -> Table:
    table = titled(
        "Root mean squares", "", "RMS", "unit", *(f"from {which.replace('_', '-')}" for which in result.rms_of)
    )
    table.columns[2].justify = "left"
    for name, value in result.rms.items():
        factor, unit = _shown_in(name)
        table.add_row(name, f"{factor * value:.4g}", unit, *(f"{factor * x[name]:.4g}" for x in result.rms_of.values()))
    return table


def _shown_in(name: str) -> tuple[float, str]:
    """Return the factor and the unit in which a response is shown."""
    base = name.removesuffix("_velocity").removesuffix("_acceleration")
    rates = {"_velocity": "/s", "_acceleration": "/s^2"}
    rate = next((unit for end, unit in rates.items() if name.endswith(end)), "")
    return SHOWN["N" if "force" in name else f"{_unit(base)}{rate}"]


def _unit(name: str) -> str:
    """Return the SI unit of a displacement by its name."""
    return "rad" if name.startswith(("phi", "psi", "th")) else "m"


def spectrum_tables(result: "SpectrumCheck") -> RenderableType:
    """Return the table of a `SpectrumCheck`."""
    return facts(f"{result.input.replace('_', '-').capitalize()} of a sample of {result.track}", _spectrum(result))


def _spectrum(result: "SpectrumCheck") -> Iterator[tuple[str, str]]:
    unit = {"alignment": "mm", "cross_level": "mrad"}[result.input]
    low, high = float(result.wavenumber[0]), float(result.wavenumber[-1])
    yield "wavenumbers", f"{low:.4g} ... {high:.4g} rad/m, {result.wavenumber.size} values"
    yield "RMS by the spectrum", format_quantity(result.rms_target, unit, 5)
    yield "RMS of the sample", format_quantity(result.rms_sample, unit, 5)
    yield "sample over spectrum, mean of all wavenumbers", f"{np.mean(result.sample / result.target):.4f}"

"""Spectra in files: name, unit and densities must say the same, and what they say is read rightly."""

import itertools
import re

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.track.tracks import as_track

WAVENUMBERS = np.geomspace(0.002, 10, 400)
LOW = yd.SPECTRA["german-low"]


def written(tmp_path, text, name="track.csv"):
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    return file


def mistakes(tmp_path, text):
    with pytest.raises(yd.ProblemError) as error:
        yd.read_spectrum(written(tmp_path, text))
    return str(error.value).replace(str(tmp_path), "")


def test_spectrum_from_a_file(tmp_path):
    W = np.geomspace(0.01, 10, 400)
    low = yd.SPECTRA["german-low"]
    S, T = low.density("alignment", W), low.density("cross_level", W)
    lines = [f"{a:.8e}, {b:.8e}, {c:.8e}" for a, b, c in zip(W, S, T, strict=True)]
    head = "wavenumber [rad/m], alignment [m^2/(rad/m)], cross_level [rad^2/(rad/m)]"
    spectrum = yd.read_spectrum(written(tmp_path, "\n".join([head, *lines])))
    between = np.sqrt(W[1:] * W[:-1])
    for which in ("alignment", "cross_level"):
        assert spectrum.density(which, between) == pytest.approx(low.density(which, between), rel=1e-3)
    lines = [f"{a:.8e}, {b:.8e}" for a, b in zip(W / (2 * np.pi), 2 * np.pi * S, strict=True)]
    per_cycle = written(tmp_path, "\n".join(["spatial_frequency [1/m], alignment [m^2/(1/m)]", *lines]), "cycles.csv")
    assert yd.read_spectrum(per_cycle).density("alignment", between) == pytest.approx(
        low.density("alignment", between), rel=1e-3
    )
    problem = yd.table1()
    rms = [yd.stationary_response(problem, x).rms_of["alignment"]["y_b"] for x in (str(per_cycle), "german-low")]
    assert rms[0] == pytest.approx(rms[1], rel=1e-3)


def test_mistakes_in_a_spectrum(tmp_path):
    head = "wavenumber [rad/m], alignment [m^2/(rad/m)]"
    text = mistakes(tmp_path, f"{head}\n0.1, 1e-6\n0.2, -1e-6\n0.15, 1e-7\n")
    assert "track.csv:3:6: error: alignment: the density -1e-06 is negative" in text
    assert "track.csv:4:1: error: wavenumber: 0.15 must be more than 0 and more than the one before" in text
    wrong = mistakes(tmp_path, "wavenumber [rad/m], alignment [m^2]\n0.1, 1e-6\n0.2, 1e-6\n")
    assert "alignment" in wrong
    assert "fewer than two" in mistakes(tmp_path, f"{head}\n0.1, 1e-6\n")


def spectrum_file(tmp_path, variable, density, x=WAVENUMBERS, S=None):
    S = LOW.density("alignment", WAVENUMBERS) if S is None else S
    lines = [f"{a:.12e}, {b:.12e}" for a, b in zip(x, S, strict=True)]
    return written(tmp_path, "\n".join([f"{variable}, alignment [{density}]", *lines]))


def rms(file):
    return 1e3 * yd.stationary_response(yd.table1(), str(file)).rms["y_b"]


PER_RADIAN = ("m^2/(rad/m)", "m^3/rad", "m2.m/rad", "m²·m/rad")
PER_CYCLE = ("m^2/(1/m)", "m^3", "m2.m", "m²/m⁻¹")


@pytest.mark.parametrize("density", PER_RADIAN)
def test_a_density_per_radian_over_the_wavenumber(tmp_path, density):
    assert rms(spectrum_file(tmp_path, "wavenumber [rad/m]", density)) == pytest.approx(4.018, abs=5e-4)


@pytest.mark.parametrize("density", PER_CYCLE)
def test_a_density_per_cycle_over_the_spatial_frequency(tmp_path, density):
    S = 2 * np.pi * LOW.density("alignment", WAVENUMBERS)
    file = spectrum_file(tmp_path, "spatial_frequency [1/m]", density, WAVENUMBERS / (2 * np.pi), S)
    assert rms(file) == pytest.approx(4.018, abs=5e-4)


def test_other_sizes_of_the_units(tmp_path):
    S = LOW.density("alignment", WAVENUMBERS)
    for variable, density, x, factor in (
        ("wavenumber [rad/km]", "mm^2/(rad/m)", 1e3, 1e6),
        ("wavenumber [mrad/m]", "m^2/(mrad/m)", 1e3, 1e-3),
        ("wavenumber [deg/m]", "mm^2/(deg/m)", 180 / np.pi, 1e6 * np.pi / 180),
    ):
        file = spectrum_file(tmp_path, variable, density, x * WAVENUMBERS, factor * S)
        assert yd.read_spectrum(file).density("alignment", np.array([0.5])) == pytest.approx(
            LOW.density("alignment", np.array([0.5])), rel=1e-3
        )


VARIABLES = {
    "wavenumber": ("rad/m", PER_RADIAN),
    "spatial_frequency": ("1/m", PER_CYCLE),
}
UNITS = ("rad/m", "1/m", "m^-1", "m", "Hz", "rad/s", "-", "rad", "")
DENSITIES = (*PER_RADIAN, *PER_CYCLE, "m^2", "m^2/Hz", "m^2 s", "m", "mm", "m^2/(rad/s)", "m^2 rad/m", "m^2/m", "")


@pytest.mark.parametrize("name", [*VARIABLES, "frequency", "angular_frequency", "wavelength", "k", "Wavenumber", "x"])
def test_every_other_head_is_refused_with_the_right_writing(tmp_path, name):
    right_unit, right_densities = VARIABLES.get(name, (None, ()))
    for unit, density in itertools.product(UNITS, DENSITIES):
        if unit in (right_unit, {"1/m": "m^-1"}.get(right_unit)) and density in right_densities:
            continue
        file = spectrum_file(tmp_path, f"{name} [{unit}]", density)
        with pytest.raises(yd.ProblemError) as error:
            as_track(file)
        first = str(error.value).splitlines()[0].replace(str(tmp_path), "")
        assert re.match(r"/track\.csv:1:\d+: error: ", first), first
        spectrum = name in VARIABLES or (unit != "" and density in (*PER_RADIAN, *PER_CYCLE))
        assert not spectrum or re.search(r"(write|expected|did you mean|over|needs)", first), first


@pytest.mark.parametrize(
    ("head", "messages"),
    [
        (
            "wavenumber [1/m], alignment [m^2/(1/m)]",
            [
                ":1:1: error: wavenumber: 1/m is not clear: write wavenumber [rad/m], 2π over the wavelength, or "
                "spatial_frequency [1/m], 1 over it",
                ":1:19: error: alignment: m^2/(1/m) is not the density over wavenumber [rad/m], which is "
                "[m^2/(rad/m)]; over spatial_frequency [1/m] it would be another",
            ],
        ),
        (
            "spatial_frequency [rad/m], alignment [m^2/(rad/m)]",
            [
                ":1:1: error: spatial_frequency: rad/m is not clear: write wavenumber [rad/m]",
                ":1:28: error: alignment: m^2/(",
            ],
        ),
        (
            "wavenumber [rad/m], alignment [m^2/(1/m)]",
            [":1:21: error: alignment: m^2/(1/m) is not the density over wave"],
        ),
        (
            "spatial_frequency [1/m], alignment [m^2/(rad/m)]",
            [
                ":1:26: error: alignment: m^2/(rad/m) is not the density over "
                "spatial_frequency [1/m], which is [m^2/(1/m)]"
            ],
        ),
        ("wavenumber [rad/m], alignment [m^3]", [":1:21: error: alignment: m^3 is not the density over wavenumber"]),
        (
            "wavenumber [rad/m], alignment [m^2/(rad/m)], cross_level [rad^2/(1/m)]",
            [":1:46: error: cross_level: rad^2/(1/m) "],
        ),
        (
            "wavenumber [rad/m], spatial_frequency [1/m], alignment [m^2/(rad/m)]",
            [":1:21: error: spatial_frequency: a spectrum has one variable, here it is wavenumber"],
        ),
        (
            "frequency [Hz], alignment [m^2/Hz]",
            [
                ":1:1: error: frequency: a spectrum over time belongs to one speed v: write "
                "spatial_frequency [1/m], which is f/v"
            ],
        ),
        ("omega [rad/s], alignment [m^2/(rad/s)]", [":1:1: error: omega: a spectrum over time belongs to one speed v"]),
        (
            "wavelength [m], alignment [m^2/(1/m)]",
            [":1:1: error: wavelength: write spatial_frequency [1/m], 1 over the wavel"],
        ),
        ("k [rad/m], alignment [m^2/(rad/m)]", [":1:1: error: k: is not clear: write wavenumber [rad/m]"]),
        (
            "Wavenumber [rad/m], alignment [m^2/(rad/m)]",
            [":1:1: error: Wavenumber: is not clear: write wavenumber [rad/m]"],
        ),
        ("wavenumber, alignment [m^2/(rad/m)]", [":1:1: error: wavenumber: has no unit: write wavenumber [rad/m]"]),
        (
            "wavenumber (rad/m), alignment [m^2/(rad/m)]",
            [":1:1: error: wavenumber (rad/m): is not clear: write wavenumber [rad"],
        ),
        ("wavenumber [cycles/m], alignment [m^2/(rad/m)]", ["'cycles/m' is not a known unit; expected rad/m"]),
    ],
)
def test_heads_that_contradict_themselves(tmp_path, head, messages):
    file = written(tmp_path, f"{head}\n0.1, 1e-6, 1\n0.2, 1e-6, 1\n")
    with pytest.raises(yd.ProblemError) as error:
        as_track(file)
    for message in messages:
        assert message in str(error.value)


def test_columns_in_any_order_units_below_and_decimal_commas(tmp_path):
    S = LOW.density("alignment", WAVENUMBERS)
    lines = [f"{b:.12e};x;{a:.12e}".replace(".", ",") for a, b in zip(WAVENUMBERS, S, strict=True)]
    file = written(tmp_path, "\n".join(["alignment;remark;wavenumber", "m^2/(rad/m);;rad/m", *lines]))
    assert rms(file) == pytest.approx(4.018, abs=5e-4)
    notes = "\n".join(as_track(file).notes)
    assert "not used: remark" in notes
    assert "the comma is read as decimal sign" in notes


@pytest.mark.parametrize("cell", ["1_0", "nan", "inf", "1e400", "", "x", "1e-400", "0x10", "1,5"])
def test_cells_that_are_no_numbers(tmp_path, cell):
    text = f"wavenumber [rad/m]; alignment [m^2/(rad/m)]\n0.1; 1e-6\n0.2; {cell}\n"
    assert "/track.csv:3:6: error: alignment: " in mistakes(tmp_path, text) or cell == ""


def test_densities_of_another_unit_are_noted(tmp_path):
    S = LOW.density("alignment", WAVENUMBERS)
    for factor, note in ((1e6, True), (1e-6, True), (1, False)):
        notes = yd.read_spectrum(spectrum_file(tmp_path, "wavenumber [rad/m]", "m^2/(rad/m)", S=factor * S)).notes
        assert any("is the unit right?" in text for text in notes) == note

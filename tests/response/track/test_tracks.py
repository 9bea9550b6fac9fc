"""Tracks: densities, band, synthesis, and the rear wheelset a wheelbase behind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import yawdesign as yd
from yawdesign.response.track.lines import Clock, Wheelsets, synthesise
from yawdesign.response.track.spectra import SPECTRA, fra, german
from yawdesign.response.track.tracks import NAMES, as_track


def deviation(spectrum, low=0.024, high=0.333):
    """Return the standard deviation [mm] in a band given in cycles per metre."""
    square, _ = quad(lambda W: spectrum.density("alignment", np.array([W]))[0], 2 * np.pi * low, 2 * np.pi * high)
    return 1e3 * np.sqrt(square)


@pytest.mark.parametrize(
    ("spectrum", "expected"),
    [
        (SPECTRA["fra-5"], 3.06242),
        (fra(0.2095e-4), 5.07784),  # the vertical profile of class 5 has the same form
        (SPECTRA["fra-6"], 2.04262),
    ],
)
def test_published_standard_deviations(spectrum, expected):
    assert deviation(spectrum) == pytest.approx(expected, rel=1e-5)


def test_standard_deviation_per_cycle():
    """S_f(f) = 2 pi S_W(2 pi f): the same deviation by integration over cycles per metre."""
    S = SPECTRA["fra-5"].density
    square, _ = quad(lambda f: 2 * np.pi * S("alignment", np.array([2 * np.pi * f]))[0], 0.024, 0.333)
    assert 1e3 * np.sqrt(square) == pytest.approx(3.06242, rel=1e-5)


def test_german_spectrum_by_hand():
    W, W_c, W_r, W_s = 0.5, 0.8246, 0.0206, 0.4380
    common = W_c**2 / ((W**2 + W_r**2) * (W**2 + W_c**2))
    for name, A_a, A_v in (("german-low", 2.119e-7, 4.032e-7), ("german-high", 6.125e-7, 1.08e-6)):
        spectrum = SPECTRA[name]
        assert spectrum.density("alignment", np.array([W])) == pytest.approx(A_a * common)
        angle = A_v / 0.75**2 * common * W**2 / (W**2 + W_s**2)
        assert spectrum.density("cross_level", np.array([W])) == pytest.approx(angle)


def test_values_from_memory_say_so():
    for n in range(1, 7):
        notes = " ".join(as_track(f"fra-{n}").notes)
        assert ("from memory" in notes) == (n < 5)
        assert "cross-level angle is zero" in notes


@pytest.mark.parametrize("band", [("0.3 Hz", "40 Hz"), ("0.024 1/m", "0.333 1/m")])
@pytest.mark.parametrize("which", ["alignment", "cross_level"])
def test_sample_has_the_power_of_its_band(band, which):
    road = yd.RandomTrack(SPECTRA["german-high"], yd.Band(*band))
    result = yd.spectrum_check(road, which, speed="200 km/h", length=5e3)
    square, _ = quad(lambda W: road.spectrum.density(which, np.array([W]))[0], *band_edges(road, 200 / 3.6), limit=200)
    assert result.rms_target == pytest.approx(np.sqrt(square), rel=1e-6)
    assert result.rms_sample == pytest.approx(np.sqrt(square), rel=1e-3)


def band_edges(road, v):
    return [2 * np.pi * f / v for f in road.band.hertz(v)]


@pytest.mark.parametrize("which", ["alignment", "cross_level"])
def test_sample_has_the_spectrum_it_was_made_from(which):
    result = yd.spectrum_check("german-low", which, length="40 km", seed=3)
    middle = slice(5, -5)  # at the ends of the band Welch's window reaches beyond it
    ratio = (result.sample / result.target)[middle]
    assert ratio.mean() == pytest.approx(1, abs=0.03)
    parts = np.array_split(ratio, 12)
    assert [part.mean() for part in parts] == pytest.approx([1] * 12, abs=0.12)


def test_published_deviation_of_a_sample():
    road = yd.RandomTrack(SPECTRA["fra-5"], yd.Band("0.024 1/m", "0.333 1/m"))
    assert 1e3 * yd.spectrum_check(road, length="10 km").rms_sample == pytest.approx(3.06242, rel=1e-4)


def test_equal_seeds_equal_tracks():
    samples = [yd.simulate(yd.table1(), duration=2, seed=seed).histories[0]["alignment_1"] for seed in (1, 1, 2)]
    assert np.array_equal(samples[0], samples[1])
    assert not np.allclose(samples[0], samples[2])


def test_alignment_and_cross_level_are_independent():
    history = yd.simulate(yd.table1(), duration=120).histories[0]
    assert abs(np.corrcoef(history["alignment_1"], history["cross_level_1"])[0, 1]) < 0.1


@pytest.mark.parametrize("n", [2, 4])
def test_the_wheelsets_behind_meet_the_same_track_later(n):
    """Two wheelsets of a bogie, or four of a vehicle with two bogies 17.5 m apart; the first meets the same in both."""
    wheelsets = Wheelsets(50.0, (0.0, 2.5 / 50, 17.5 / 50, 20 / 50)[:n], 1.493)
    clock = Clock(wheelsets.lags[1] / 20, 1600)
    u = synthesise(as_track("german-low").lines(wheelsets, clock.step * clock.steps), clock)
    assert u.shape == (1601, 2 * n)
    for k, later in enumerate((0, 20, 140, 160)[:n]):
        assert u[: 1601 - later, :2] == pytest.approx(u[later:, 2 * k : 2 * k + 2], abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.1, 10), st.floats(1.5, 20), st.floats(20, 100))
def test_power_of_a_band_adds_up(low, factor, v):
    road = yd.RandomTrack(SPECTRA["german-low"], yd.Band(low, low * factor))
    edges = np.linspace(low / 2, 2 * low * factor, 300)
    square, _ = quad(lambda W: road.spectrum.density("alignment", np.array([W]))[0], *band_edges(road, v))
    assert road.power("alignment", v, edges).sum() == pytest.approx(square, rel=1e-4)


def test_own_coefficients_and_own_spectrum():
    road = as_track("german:A_a=2.119e-7, A_v=4.032e-7")
    W = np.array([0.03, 0.3])
    for which in ("alignment", "cross_level"):
        assert road.spectrum.density(which, W) == pytest.approx(SPECTRA["german-low"].density(which, W))
    assert as_track("fra:A=0.0762e-4").spectrum.density("alignment", W) == pytest.approx(
        SPECTRA["fra-5"].density("alignment", W)
    )
    own = yd.Spectrum("flat", {"alignment": lambda W: np.full_like(W, 1e-6)})
    assert as_track(own).power("alignment", 50.0, np.array([1.0, 2.0])) == pytest.approx(2 * np.pi / 50 * 1e-6)


@pytest.mark.parametrize(
    ("track", "message"),
    [
        ("german-lo", "did you mean german-low"),
        ("fra-7", "fra-6"),
        ("nothing.csv", "cannot be read"),
        ("german:A_a=1", "A_v"),
        ("german:A_a=x,A_v=1,A_b=2", "'x' is not a number"),
        ("german:A_a=x,A_v=1,A_b=2", "A_b"),
        ("german:A_a=1_0,A_v=1", "A_a: '1_0' is not a number"),
        ("german:A_a=1e400,A_v=1", "too large"),
        ("german:A_a=1,A_v=1,A_a=2", "A_a: stands twice"),
        ("german:A_a,A_v=1", "A_a: the value is missing"),
        ("fra:W_A=1", "A: is missing"),
        ("g" * 5000, "5000 characters"),
        ("german-\0low", "is not one of"),
        ("g" * 5000 + ".csv", "cannot be read: File name too long"),
        ("german:A_a=-1,A_v=1", "must be 0 or more"),
        ("fra:A=1,W_c=0", "must be more than 0"),
        (7, "is no track"),
    ],
)
def test_what_is_no_track(track, message):
    with pytest.raises(yd.ProblemError, match=message):
        as_track(track)


def test_all_names_are_tracks():
    for name in NAMES:
        if "..." not in name:
            assert as_track(name).name == name


def test_negative_density():
    own = yd.Spectrum("mine", {"alignment": lambda W: 1e-6 * (1 - W)})
    with pytest.raises(yd.ProblemError, match=r"must be 0 or more everywhere: -\d"):
        yd.simulate(yd.table1(), own)
    with pytest.raises(yd.ProblemError, match="must be 0 or more"):
        german(-1e-7, 1e-7)


@pytest.mark.parametrize("band", [(1, "2 1/m"), (2, 1), (0, 1), ("1 m/s", "2 m/s"), "0.3", (1, 2, 3)])
def test_what_is_no_band(band):
    with pytest.raises(yd.ProblemError, match="band"):
        yd.simulate(yd.table1(), band=band)


def test_what_is_no_harmonic():
    with pytest.raises(yd.ProblemError) as error:
        yd.Harmonic(wavelength="0 m", amplitude="1 kg", input="gauge")
    assert all(name in str(error.value) for name in ("wavelength", "amplitude", "input"))
    with pytest.raises(yd.ProblemError, match="omega"):
        yd.Sinusoid(omega=-1)

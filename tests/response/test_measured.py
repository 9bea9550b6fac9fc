"""Measured tracks and spectra in files: what is read, and every mistake with its place."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.system import system_at

HEAD = "distance [m], alignment [mm], cross_level [mm], gauge [mm]"


def written(tmp_path, text, name="track.csv"):
    file = tmp_path / name
    file.write_text(text)
    return file


def rows(n=2000, spacing=0.25, gauge=1435.0):
    x = spacing * np.arange(n)
    y, z = 5 * np.sin(2 * np.pi * x / 25), 4 * np.cos(2 * np.pi * x / 40)
    return [f"{a:.4f}, {b:.6f}, {c:.6f}, {gauge}" for a, b, c in zip(x, y, z, strict=True)]


def test_measured_track(tmp_path):
    track = yd.read_track(written(tmp_path, "\n".join(["# a comment", HEAD, *rows()])))
    assert track.spacing == pytest.approx(0.25)
    assert np.max(np.abs(track.alignment)) == pytest.approx(5e-3, rel=1e-3)
    assert "1435.0 to 1435.0 mm" in track.notes[1]
    assert "does not use it" in track.notes[1]
    system = system_at(yd.table1(), 50.0)
    history = yd.simulate(yd.table1(), track, speed=50).histories[0]
    where = history.distance
    assert where[-1] == pytest.approx(1999 * 0.25 - 2.5)
    assert history["alignment_2"] == pytest.approx(5e-3 * np.sin(2 * np.pi * where / 25), abs=1e-5)
    assert history["alignment_1"] == pytest.approx(5e-3 * np.sin(2 * np.pi * (where + 2.5) / 25), abs=1e-5)
    angle = 4e-3 / (2 * system.p["b"])
    assert history["cross_level_2"] == pytest.approx(angle * np.cos(2 * np.pi * where / 40), abs=1e-5)


def test_units_and_columns_that_may_be_left_out(tmp_path):
    text = "distance [km]; alignment [m]; cross_level [mrad]\n" + "\n".join(
        f"{k / 2000}; {1e-3 * (k % 2)}; 2" for k in range(50)
    )
    track = yd.read_track(written(tmp_path, text))
    assert track.spacing == pytest.approx(0.5)
    assert track.alignment[1] == pytest.approx(1e-3)
    assert track.is_angle
    assert track.cross_level[0] == pytest.approx(2e-3)
    assert len(track.notes) == 1
    alone = yd.read_track(written(tmp_path, "distance [m], alignment [mm]\n0, 1\n0.5, 2\n1, 3\n"))
    assert not alone.cross_level.any()


def test_a_run_starts_settled_on_the_first_values(tmp_path):
    text = "distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, 3" for k in range(400))
    history = yd.simulate(yd.table1(), written(tmp_path, text)).histories[0]
    assert np.ptp(history["y_b"]) < 1e-9
    assert 0 < history["y_b"][0] < 3e-3


def test_a_sampled_wave_is_answered_like_a_harmonic_track(tmp_path):
    text = "\n".join([HEAD, *(f"{k / 5}, {10 * np.cos(2 * np.pi * k / 100)}, 0, 1435" for k in range(6000))])
    problem = yd.table1()
    history = yd.simulate(problem, written(tmp_path, text), speed="200 km/h").histories[0]
    expected = yd.frequency_response(problem, 20, speed="200 km/h")
    late = history["y_b"][len(history.time) // 2 :]
    assert np.max(np.abs(late)) == pytest.approx(10e-3 * abs(expected.y_b), rel=2e-3)


def mistakes(tmp_path, text, read=yd.read_track):
    with pytest.raises(yd.ProblemError) as error:
        read(written(tmp_path, text))
    return str(error.value).replace(str(tmp_path), "")


def test_all_mistakes_with_their_places(tmp_path):
    lines = rows(50)
    lines[3] = "0.75, , 0, 1435"
    lines[5] = "1.25, 1, x, 1435"
    lines[7] = "1.75, 1, 2"
    text = mistakes(tmp_path, "\n".join([HEAD, *lines]))
    assert "/track.csv:5:7: error: alignment: the value is missing" in text
    assert "/track.csv:7:10: error: cross_level: 'x' is not a number" in text
    assert "/track.csv:9:1: error: there are 3 values, expected 4" in text


def test_distance_that_is_not_even(tmp_path):
    lines = rows(100)
    gap = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], *lines[34:]]))
    assert "track.csv:32:1: error: distance: 8.5 m is a gap of 1.25 m behind 7.25 m" in gap
    swapped = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], lines[31], lines[30], *lines[32:]]))
    assert "is not behind" in swapped
    assert swapped.count("error") == 3
    near = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], "7.35, 0, 0, 1435", *lines[30:]]))
    assert "7.35 m is too near to 7.25 m" in near
    assert "too large" in mistakes(tmp_path, "\n".join([HEAD, *rows(50, spacing=5)]))
    assert "equal steps" in mistakes(tmp_path, "\n".join([HEAD, *["1, 1, 1, 1435"] * 5]))


def test_wrong_units(tmp_path):
    body = "\n".join(rows(10))
    for head, message in (
        ("distance [s], alignment [mm], cross_level [mm], gauge [mm]", "s is a time, expected m"),
        ("distance, alignment [mm], cross_level [mm], gauge [mm]", r"has no unit: write distance [m]"),
        ("distance [m], alignement [mm], cross_level [mm], gauge [mm]", "did you mean alignment"),
        ("distance [m], alignment [mm], alignment [mm], gauge [mm]", "stands twice"),
        ("distance [m], alignment [m], cross_level [mm], gauge [mm]", "is more than 0.5 m: is the unit right?"),
        ("distance [m], alignment [mm], cross_level [mm], gauge [m]", "is neither a gauge"),
        ("distance [m], cross_level [mm], gauge [mm], alinment [mm]", "there is no column alignment [mm]"),
        ("distance [foot], alignment [mm], cross_level [mm], gauge [mm]", "foot"),
    ):
        assert message in mistakes(tmp_path, f"{head}\n{body}")


def test_many_mistakes_are_not_all_listed(tmp_path):
    text = mistakes(tmp_path, "\n".join([HEAD, *["x, 1, 1, 1435"] * 100]))
    assert text.count("is not a number") == 20
    assert "and 80 more" in text


def test_files_that_are_none(tmp_path):
    assert "empty" in mistakes(tmp_path, "\n# nothing\n")
    assert "fewer than three" in mistakes(tmp_path, f"{HEAD}\n0,0,0,1435\n")
    with pytest.raises(yd.ProblemError, match="cannot be read"):
        yd.read_track(tmp_path / "missing.csv")
    file = tmp_path / "latin.csv"
    file.write_bytes("distance [m], alignment [µm]".encode("latin-1"))
    with pytest.raises(yd.ProblemError, match="UTF-8"):
        yd.read_track(file)


def test_a_run_longer_than_the_track(tmp_path):
    file = written(tmp_path, "\n".join([HEAD, *rows(400)]))
    with pytest.raises(yd.ProblemError, match="the measured track ends after"):
        yd.simulate(yd.table1(), file, length="200 m")
    assert yd.simulate(yd.table1(), file, length="50 m").runs[0].duration == pytest.approx(50 * 3.6 / 300)


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
    text = mistakes(tmp_path, f"{head}\n0.1, 1e-6\n0.2, -1e-6\n0.15, 1e-7\n", yd.read_spectrum)
    assert "track.csv:3:6: error: alignment: the density -1e-06 is negative" in text
    assert "track.csv:4:1: error: wavenumber: 0.15 must be more than 0 and more than the one before" in text
    wrong = mistakes(tmp_path, "wavenumber [rad/m], alignment [m^2]\n0.1, 1e-6\n0.2, 1e-6\n", yd.read_spectrum)
    assert "alignment" in wrong
    assert "fewer than two" in mistakes(tmp_path, f"{head}\n0.1, 1e-6\n", yd.read_spectrum)

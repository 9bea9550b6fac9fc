"""Nothing is begun that cannot end: files without an end, and numbers of points, are refused before the work."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.modes import followed_modes
from yawdesign.response.run import frequency, simulate
from yawdesign.response.track import text_sheets
from yawdesign.response.track.lines import MOST_STEPS

PROBLEM = yd.table1().replace(C_s=1e6)


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/tty"])
def test_a_device_is_no_track(name):
    for read in (yd.read_track, yd.read_spectrum, lambda x: yd.simulate(PROBLEM, x)):
        with pytest.raises(yd.ProblemError, match=f"{name}.*a device or a pipe"):
            read(name)


def test_a_file_that_is_too_large(tmp_path, monkeypatch):
    file = tmp_path / "track.csv"
    file.write_text("distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, {k % 7}" for k in range(100)))
    assert len(yd.read_track(file).distance) == 100
    monkeypatch.setattr(text_sheets, "MOST_BYTES", 100)
    with pytest.raises(yd.ProblemError, match="larger than"):
        yd.read_track(file)


def test_too_many_values_to_follow_modes_over(monkeypatch):
    monkeypatch.setattr(followed_modes, "folded_matrix", None)  # no work begins
    with pytest.raises(yd.ProblemError, match="v: 10001 values are too many: at most 10000"):
        yd.follow_modes(PROBLEM, v=np.linspace(20, 80, 10_001))


def test_too_many_wavelengths(monkeypatch):
    monkeypatch.setattr(frequency, "WAVELENGTH", None)  # no value is looked at
    with pytest.raises(yd.ProblemError, match="wavelength: 100001 values are too many"):
        yd.frequency_response(PROBLEM, np.linspace(1, 100, 100_001))


def test_a_sample_that_is_too_long():
    with pytest.raises(yd.ProblemError, match=f"length: .* at most {MOST_STEPS}"):
        yd.spectrum_check(length=1e12)


def test_runs_that_are_too_many_together(monkeypatch):
    monkeypatch.setattr(simulate, "run", None)
    with pytest.raises(yd.ProblemError, match="speed: 200 runs have 12000000 steps together"):
        yd.simulate(PROBLEM, speed=np.linspace(60, 70, 200))
    monkeypatch.undo()
    monkeypatch.setattr(simulate, "MOST_TOGETHER", 4000)
    assert len(yd.simulate(PROBLEM, speed=[60, 70], duration=2).runs) == 2


def test_names_of_responses_are_those_of_a_run():
    run = yd.simulate(PROBLEM, duration=2)
    assert simulate.response_names(PROBLEM) == tuple(run.histories[0].values)

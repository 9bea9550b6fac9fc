"""Broken track and spectrum files: each is read rightly or refused with its place, and none takes long."""

import re
import time

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.track.measured import MeasuredTrack
from yawdesign.response.track.tracks import as_track

X = 0.25 * np.arange(12)
HEAD = "distance [m], alignment [mm], cross_level [mrad], gauge [mm]"
PER_RADIAN, PER_CYCLE = "wavenumber [rad/m], alignment [m^2/(rad/m)]", "spatial_frequency [1/m]; alignment [m^2/(1/m)]"
GOOD = (
    "\n".join([HEAD, *(f"{x}, {5 * np.sin(x):.4f}, 1, 1435" for x in X)]),
    "\n".join(["distance;alignment;twist", "km+m;mm;", *(f"12+0{99 - k},5;{k % 3},25;-" for k in range(12))]),
    "\n".join(["distance [m]\talignment [mm]", *(f"{x}\t{5 * np.sin(x):.3e}".replace(".", ",") for x in X)]),
    "\n".join([PER_RADIAN, *(f"{0.1 * x + 0.1}, {1e-6 / (x + 1):.3e}" for x in X)]),
    "\n".join([PER_CYCLE, *(f"{0.1 * x + 0.1}; {1e-6 / (x + 1):.3e}" for x in X)]),
)
WITHOUT_PLACE = ("the file is empty", "fewer than", "is not UTF-8 text")


def outcome(path):
    """Return the track, or the text of the refusal."""
    try:
        return as_track(path)
    except yd.ProblemError as error:
        return str(error)


def survives(path):
    """Return whether a file was read; a reading is finite and complete, a refusal names the file and the place."""
    start = time.perf_counter()
    found = outcome(path)
    assert time.perf_counter() - start < 2
    if isinstance(found, str):
        first = found.splitlines()[0]
        anywhere = any(text in first for text in WITHOUT_PLACE)
        assert re.match(rf"{re.escape(str(path))}{'' if anywhere else r':[0-9]+:[0-9]+'}: error: ", first), first
        assert max(map(len, found.splitlines())) < 1500
        return False
    if isinstance(found, MeasuredTrack):
        assert np.all(np.diff(found.distance) > 0)
        assert np.isfinite([found.distance, found.alignment, found.cross_level]).all()
        assert np.abs([found.alignment, found.cross_level]).max() <= 0.5
    else:
        S = found.spectrum.density("alignment", np.geomspace(0.01, 10, 50))
        assert np.isfinite(S).all()
        assert (S >= 0).all()
    return True


def campaign(path, mutated, seeds):
    read = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        path.write_bytes(mutated(GOOD[seed % len(GOOD)], rng).encode("utf-8", "surrogatepass"))
        read += survives(path)
    return read


def test_mutated_files(tmp_path, mutated):
    assert 20 < campaign(tmp_path / "track.csv", mutated, range(500)) < 480


@pytest.mark.slow
def test_thousands_of_mutated_files(tmp_path, mutated):
    assert campaign(tmp_path / "track.csv", mutated, range(1000, 7000)) > 200


def test_the_files_themselves_are_read(tmp_path):
    for k, text in enumerate(GOOD):
        path = tmp_path / f"{k}.csv"
        path.write_text(text, encoding="utf-8")
        assert survives(path)

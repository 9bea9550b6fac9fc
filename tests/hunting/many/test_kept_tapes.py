"""Large tapes are made once on a machine; what is kept never keeps a tape from being right."""

import os
import subprocess
import sys

import casadi as ca
import numpy as np
import pytest

from yawdesign.hunting.many import counts, kept_tapes, library_cache
from yawdesign.hunting.many.recording import packed, record, unpacked
from yawdesign.vehicle.vehicle import Model

SIZE = 31  # coefficients: the smallest tapes that are kept


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """Keep what is made in a folder of the test's own, and forget what was made before."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    counts.counts.cache_clear()
    yield library_cache.cache_folder()
    counts.counts.cache_clear()


@pytest.fixture
def made(monkeypatch):
    """Return a list that grows with each tape that is made."""
    calls, make = [], counts.record
    monkeypatch.setattr(counts, "record", lambda function: calls.append(function) or make(function))
    return calls


def counted():
    """Return what the tape gives of a polynomial, made or read anew."""
    counts.counts.cache_clear()
    p = np.poly([*(-1.0 - np.arange(SIZE - 3)), 0.5, 0.7])[::-1]
    return counts.counts(SIZE)({f"a{k}": a for k, a in enumerate(p / 10.0 ** np.arange(SIZE))})[0].tolist()


def tapes(folder):
    return sorted(folder.glob("*.tape"))


def test_made_once(folder, made):
    assert counted() == counted() == [2]
    assert len(made) == len(tapes(folder)) == 1


def test_the_same_operations_come_back():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    outputs = [x + y, x / y, -x, ca.fabs(x - y), 1 / x, x * x, (x < y) * 0.1, ca.SX(-0.0), ca.SX(0.0), y]
    recording = record(ca.Function("f", [x, y], [ca.vertcat(*outputs)], ["x", "y"], ["out"]))
    again = unpacked(packed(recording))
    assert again == recording
    assert [np.signbit(a) for a in again.constants.values()] == [np.signbit(a) for a in recording.constants.values()]


@pytest.mark.parametrize("content", [b"", b"x" * 100, "half"])
def test_no_recording(content):
    x = ca.SX.sym("x")
    whole = packed(record(ca.Function("f", [x], [x + 1], ["x"], ["out"])))
    with pytest.raises(kept_tapes.NOT_A_TAPE):
        unpacked(whole[: len(whole) // 2] if content == "half" else content)


@pytest.mark.parametrize("kind", ["damaged", "damaged with its own digest", "empty", "a folder", "open to others"])
def test_what_does_not_fit_is_made_again(kind, folder, made):
    counted()
    (path,) = tapes(folder)
    key, content = path.stem.split("-")[0], path.read_bytes()
    path.unlink()
    if kind == "a folder":
        path.mkdir()
    elif kind == "damaged with its own digest":
        library_cache.keep(key, library_cache.TAPE, content[: len(content) // 2])
    else:
        path.write_bytes({"damaged": content[:-9] + b"x" * 9, "empty": b""}.get(kind, content))
        path.chmod(0o666 if kind == "open to others" else 0o600)
    assert counted() == [2]
    assert len(made) == 2


def test_a_place_that_cannot_be_written(monkeypatch, tmp_path, made):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert counted() == counted() == [2]
    assert len(made) == 2


@pytest.mark.parametrize("what", ["the sources", "the version of CasADi"])
def test_a_tape_belongs_to(what, monkeypatch, made):
    counted()
    if what == "the sources":
        monkeypatch.setattr(kept_tapes, "_sources", lambda: "others")
    else:
        monkeypatch.setattr(ca.CasadiMeta, "version", lambda: "0")
    counted()
    assert len(made) == 2


def test_without_sources_nothing_is_kept(monkeypatch, folder, made):
    monkeypatch.setattr(kept_tapes, "ROOMS", ("no such room",))
    kept_tapes._sources.cache_clear()
    assert counted() == counted() == [2]
    assert len(made) == 2
    kept_tapes._sources.cache_clear()


def test_what_is_small_is_not_kept(folder):
    counts.verdicts.__wrapped__(Model())
    counts.counts.__wrapped__(20)
    assert not folder.exists()


KEY = """
from yawdesign.hunting.many.kept_tapes import _key
from yawdesign.vehicle.vehicle import Model
flags, zeros = frozenset({"overturning", "no gravitational stiffness"}), frozenset({"C_t", "C_m", "W"})
print(_key("verdicts", Model(flags=flags), zeros))
"""


def test_the_key_is_the_same_in_every_process():
    keys = {
        subprocess.run(
            [sys.executable, "-c", KEY], env={**os.environ, "PYTHONHASHSEED": seed}, stdout=subprocess.PIPE, check=True
        ).stdout
        for seed in "123"
    }
    assert len(keys) == 1


def test_other_questions_have_other_keys():
    model = Model()
    asked = [("a", model), ("b", model), ("a", Model("trailer")), ("a", model, frozenset({"W"}))]
    asked += [("a", Model(flags=frozenset({"overturning"}))), ("a", 31), ("a", 32), ("a", 31, True)]
    assert len({kept_tapes._key(*x) for x in asked}) == len(asked)

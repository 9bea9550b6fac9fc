"""Files are whole or not there, replace no other unasked, keep their mode, and have names of their own until then."""

import errno
import os
import signal
import threading
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem import whole_files as writing
from yawdesign.problem.stopping import Stopped, held
from yawdesign.problem.whole_files import whole_file, write_whole
from yawdesign.study.store import write_arrays


@pytest.fixture
def file(tmp_path):
    return tmp_path / "x.csv"


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_not_replaced_unasked(file):
    write_whole(file, b"mine")
    with pytest.raises(yd.ProblemError, match=r"x\.csv exists"):
        write_whole(file, b"other")
    assert file.read_bytes() == b"mine"
    write_whole(file, b"new", replace=True)
    assert file.read_bytes() == b"new"


@pytest.mark.parametrize("links", [True, False])
def test_a_file_that_appears_meanwhile_is_not_replaced_either(file, links, monkeypatch):
    def refuses(self, target):
        raise OSError(errno.EPERM, "no links on this disk")

    if not links:
        monkeypatch.setattr(Path, "hardlink_to", refuses)
    with pytest.raises(FileExistsError) as caught, whole_file(file):
        file.write_bytes(b"first")
    assert caught.value.filename == str(file)
    assert file.read_bytes() == b"first"
    assert names(file.parent) == ["x.csv"]
    file.unlink()
    write_whole(file, b"alone")
    assert file.read_bytes() == b"alone"


def test_an_error_leaves_the_old_file_and_nothing_else(file):
    def break_off(error):
        with whole_file(file, replace=True) as out:
            out.write(b"half")
            raise error

    file.write_bytes(b"old")
    for error in (RuntimeError, KeyboardInterrupt):
        with pytest.raises(error):
            break_off(error)
    assert file.read_bytes() == b"old"
    assert names(file.parent) == ["x.csv"]


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o400])
def test_a_file_keeps_its_mode(file, mode):
    file.write_bytes(b"secret")
    file.chmod(mode)
    with whole_file(file, replace=True) as out:
        (beside,) = set(file.parent.iterdir()) - {file}
        assert beside.stat().st_mode & 0o077 == 0  # nobody else reads it meanwhile
        out.write(b"new")
    assert file.stat().st_mode & 0o777 == mode
    assert file.read_bytes() == b"new"


def test_a_new_file_has_the_usual_mode(file):
    before = os.umask(0o027)
    try:
        write_whole(file, b"x")
    finally:
        os.umask(before)
    assert file.stat().st_mode & 0o777 == 0o640


def test_a_link_planted_beside_is_not_followed(file, tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("precious")
    (tmp_path / "x.csv.part").symlink_to(victim)
    write_whole(file, b"x")
    assert victim.read_text() == "precious"
    assert (tmp_path / "x.csv.part").is_symlink()


def test_a_link_that_leads_nowhere_is_not_followed(file, tmp_path):
    file.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(yd.ProblemError, match="exists"):
        write_whole(file, b"x")
    assert names(tmp_path) == ["x.csv"]


def test_what_a_link_leads_to_is_replaced_and_the_link_stays(file, tmp_path):
    (tmp_path / "data").write_text("old")
    file.symlink_to(tmp_path / "data")
    write_whole(file, b"new", replace=True)
    assert file.is_symlink()
    assert (tmp_path / "data").read_bytes() == b"new"


def test_two_writers_do_not_meet(file):
    with whole_file(file, replace=True) as one, whole_file(file, replace=True) as other:
        for k in range(1000):
            one.write(b"one %d\n" % k)
            other.write(b"another %d\n" % k)
    assert file.read_bytes() == b"".join(b"one %d\n" % k for k in range(1000))
    assert names(file.parent) == ["x.csv"]


def test_a_file_is_on_the_disk_before_it_takes_its_place(file, monkeypatch):
    done, replace = [], Path.replace
    monkeypatch.setattr(writing.os, "fsync", lambda number: done.append("on the disk"))
    monkeypatch.setattr(Path, "replace", lambda *names: (done.append("in place"), replace(*names)))
    write_whole(file, b"x", replace=True)
    assert done == ["on the disk", "in place", "on the disk"]


def test_a_disk_that_cannot_synchronise_and_one_that_fails(file, monkeypatch):
    def fsync(number):
        raise OSError(error, os.strerror(error))

    monkeypatch.setattr(writing.os, "fsync", fsync)
    error = errno.EINVAL
    write_whole(file, b"x")
    error = errno.EIO
    with pytest.raises(OSError, match=r"x\.csv"):
        write_whole(file, b"y", replace=True)
    assert file.read_bytes() == b"x"


def test_the_error_names_the_file_that_was_meant(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        write_whole(tmp_path / "none" / "x.csv", b"x")
    assert caught.value.filename == str(tmp_path / "none" / "x.csv")


def test_a_long_name(tmp_path):
    write_whole(tmp_path / ("é" * 120 + ".csv"), b"x")
    assert len(names(tmp_path)) == 1


def test_devices_and_pipes_are_written_to(tmp_path):
    write_arrays(Path(os.devnull), {"x": np.arange(9)})
    assert Path(os.devnull).is_char_device()
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write_arrays(pipe, {"x": np.arange(100_000)})
    reader.join()
    (tmp_path / "copy.npz").write_bytes(read[0])
    with np.load(tmp_path / "copy.npz") as arrays:
        assert arrays["x"].tolist() == list(range(100_000))
    assert pipe.is_fifo()


def test_a_pipe_that_nobody_reads_can_be_left(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    threading.Timer(0.2, signal.pthread_kill, (threading.main_thread().ident, signal.SIGINT)).start()
    with held(), pytest.raises(Stopped):
        write_whole(tmp_path / "pipe", b"x")


def test_a_request_to_stop_waits_until_an_archive_is_whole(file, monkeypatch):
    save = np.savez_compressed

    def stopped(out, **arrays):
        signal.raise_signal(signal.SIGINT)
        save(out, **arrays)

    monkeypatch.setattr(np, "savez_compressed", stopped)
    with pytest.raises(Stopped):
        write_arrays(file, {"x": np.arange(3)})
    with np.load(file) as arrays:
        assert arrays["x"].tolist() == [0, 1, 2]

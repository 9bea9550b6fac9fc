"""Executors, broken workers, full disks, interruptions, and going on from a file."""

import errno
import os
import signal
from concurrent.futures import Future, ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest
from distributed import Client, KilledWorker, LocalCluster

import yawdesign as yd
from yawdesign.study import executors
from yawdesign.study import sweep as sweeps
from yawdesign.study.executors import workers

PRINTED = yd.table1(equations="as-printed")
GRID = {"of": "critical", "v": np.linspace(70, 100, 30)}


@pytest.fixture(scope="module")
def expected():
    return yd.sweep(PRINTED, **GRID)


def same(result, expected):
    assert result.main == pytest.approx(expected.main, rel=1e-12, nan_ok=True)
    return bool(result.known.all())


class Counted:
    """Count the points that are computed, and break after some executors."""

    def __init__(self, monkeypatch, after=10**9, error=KeyboardInterrupt):
        self.points, self.calls, self.after, self.error = 0, 0, after, error
        self.answer = executors.answer
        monkeypatch.setattr(executors, "answer", self)

    def __call__(self, task, point, *more):
        self.calls += 1
        if self.calls > self.after:
            raise self.error
        found = self.answer(task, point, *more)
        self.points += found.unverified.size
        return found


@pytest.mark.parametrize("chunk", [1, 7, 30, 1000])
def test_the_chunk_does_not_matter(expected, chunk):
    assert same(yd.sweep(PRINTED, chunk=chunk, **GRID), expected)


def test_threads(expected):
    with ThreadPoolExecutor(2) as executor:
        assert same(yd.sweep(PRINTED, executor=executor, chunk=4, **GRID), expected)


def test_dask_client(expected):
    with (
        LocalCluster(processes=False, n_workers=1, threads_per_worker=2, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        assert same(yd.sweep(PRINTED, executor=client, chunk=4, **GRID), expected)


def test_progress(expected):
    seen = []
    yd.sweep(PRINTED, chunk=10, progress=lambda text, part: seen.append((text, part)), **GRID)
    assert seen[0] == ("10 of 30 points", pytest.approx(1 / 3))
    assert seen[-1] == ("30 of 30 points", 1.0)


@pytest.mark.slow
def test_a_killed_worker_loses_nothing_that_was_finished(expected, tmp_path):
    file = tmp_path / "kept.npz"
    grid = {"of": "critical", "v": np.linspace(70, 100, 600)}
    with workers(2) as executor:
        killed = []

        def kill(text, part):
            if not killed:
                killed.append(next(iter(executor._processes)))
                os.kill(killed[0], signal.SIGKILL)

        with pytest.raises(yd.IncompleteSweepError, match="does the rest") as caught:
            yd.sweep(PRINTED, executor=executor, chunk=2, resume=file, progress=kill, **grid)
    partial = caught.value.result
    finished = int(partial.finished.sum())
    assert 0 < finished < 600
    assert f"{finished} of 600 points" in str(caught.value)
    whole = yd.sweep(PRINTED, resume=file, **grid)
    assert whole.known.all()
    assert whole.main[partial.finished] == pytest.approx(partial.main[partial.finished], nan_ok=True)


def test_resuming_computes_only_what_is_missing(monkeypatch, expected, tmp_path):
    file = tmp_path / "kept.npz"
    Counted(monkeypatch, after=3)
    with pytest.raises(yd.IncompleteSweepError) as caught:
        yd.sweep(PRINTED, chunk=4, resume=file, **GRID)
    assert caught.value.interrupted
    assert caught.value.result.finished.sum() == 12
    monkeypatch.undo()
    rest = Counted(monkeypatch)
    assert same(yd.sweep(PRINTED, chunk=5, resume=file, **GRID), expected)
    assert rest.points == 18
    assert same(yd.sweep(PRINTED, resume=file, **GRID), expected)
    assert rest.points == 18


def test_an_interrupted_executor_keeps_what_is_finished(monkeypatch, expected):
    def stop(text, part):
        raise KeyboardInterrupt

    with ThreadPoolExecutor(1) as executor, pytest.raises(yd.IncompleteSweepError) as caught:
        yd.sweep(PRINTED, executor=executor, chunk=3, progress=stop, **GRID)
    result = caught.value.result
    assert caught.value.interrupted
    assert 0 < result.finished.sum() < 30
    assert result.main[result.finished] == pytest.approx(expected.main[result.finished], nan_ok=True)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("threads", [False, True])
def test_a_signal_keeps_what_is_finished(expected, tmp_path, number, threads):
    """It waits while an answer is stored or a file is written, and ends the sweep where points are computed."""
    with ThreadPoolExecutor(1) as executor, pytest.raises(yd.IncompleteSweepError) as caught:
        yd.sweep(
            PRINTED,
            executor=executor if threads else None,
            chunk=3,
            resume=tmp_path / "kept.npz",
            progress=lambda text, part: signal.raise_signal(number),
            **GRID,
        )
    assert caught.value.interrupted
    assert caught.value.__cause__.number == number
    assert f"it was stopped ({number.name})" in str(caught.value)
    finished = caught.value.result.finished
    assert 0 < finished.sum() < 30
    store = yd.sweep(PRINTED, resume=tmp_path / "kept.npz", **GRID)
    assert same(store, expected)


def test_a_signal_after_the_last_point_keeps_the_whole(monkeypatch, expected):
    """Python has no other place for the result than the error."""
    monkeypatch.setattr(sweeps, "_boundary", lambda *arguments: (signal.raise_signal(signal.SIGTERM), None))
    with pytest.raises(yd.IncompleteSweepError, match="30 of 30 points") as caught:
        yd.sweep(PRINTED, **GRID)
    assert same(caught.value.result, expected)
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL


def test_a_signal_in_the_computation_of_the_lines_keeps_the_whole(monkeypatch):
    answered = sweeps.answered

    def asked(request, **options):
        if request.of == "critical":
            monkeypatch.setattr(executors, "answer", lambda *_: signal.raise_signal(signal.SIGTERM))
        return answered(request, **options)

    monkeypatch.setattr(sweeps, "answered", asked)
    with pytest.raises(yd.IncompleteSweepError, match="3 of 3 points") as caught:
        yd.sweep(PRINTED, of="C_sl", v=[70.0, 80.0, 90.0])
    assert caught.value.result.known.all()


@pytest.mark.parametrize("error", [SystemExit, ValueError])
def test_what_is_raised_by_a_callback_or_an_own_handler_keeps_what_is_finished(error, expected, tmp_path):
    def stop(text, part):
        raise error

    with pytest.raises((SystemExit, yd.IncompleteSweepError)):
        yd.sweep(PRINTED, chunk=3, resume=tmp_path / "kept.npz", progress=stop, **GRID)
    with np.load(tmp_path / "kept.npz") as kept:
        assert kept["finished"].sum() == 3
    assert same(yd.sweep(PRINTED, resume=tmp_path / "kept.npz", **GRID), expected)


def test_nothing_finished_is_not_kept(monkeypatch, tmp_path):
    Counted(monkeypatch, after=0)
    with pytest.raises(yd.IncompleteSweepError, match=r"0 of 30 points.*nothing to keep") as caught:
        yd.sweep(PRINTED, resume=tmp_path / "kept.npz", **GRID)
    caught.value.result.keep(tmp_path / "kept.npz")
    assert list(tmp_path.iterdir()) == []


def test_a_partial_result_can_be_kept_and_gone_on_from(monkeypatch, expected, tmp_path):
    Counted(monkeypatch, after=2)
    with pytest.raises(yd.IncompleteSweepError, match="keep") as caught:
        yd.sweep(PRINTED, chunk=4, **GRID)
    partial = caught.value.result
    assert partial.to_dict()["values"][8:] == [None] * 22
    assert "unfinished" in repr(partial)
    partial.keep(tmp_path / "kept.npz")
    monkeypatch.undo()
    assert same(yd.sweep(PRINTED, resume=tmp_path / "kept.npz", **GRID), expected)


class Failing(ThreadPoolExecutor):
    """An executor of which some tasks fail."""

    def __init__(self, error, every):
        super().__init__(1)
        self.error, self.every, self.count = error, every, 0

    def submit(self, *arguments):
        self.count += 1
        if self.count % self.every:
            return super().submit(*arguments)
        failed = Future()
        failed.set_exception(self.error)
        return failed


@pytest.mark.parametrize(
    "error",
    [KilledWorker("task", SimpleNamespace(address="tcp://there"), 3), MemoryError("no room"), ValueError("odd")],
)
def test_a_chunk_that_fails_does_not_take_the_others_with_it(error, expected):
    with Failing(error, 5) as executor, pytest.raises(yd.IncompleteSweepError, match=type(error).__name__) as caught:
        yd.sweep(PRINTED, executor=executor, chunk=1, **GRID)
    result = caught.value.result
    assert result.finished.sum() == 24
    assert not caught.value.interrupted
    assert result.main[result.finished] == pytest.approx(expected.main[result.finished], nan_ok=True)


def test_a_chunk_that_fails_in_this_process(monkeypatch):
    Counted(monkeypatch, after=5, error=MemoryError)
    with pytest.raises(yd.IncompleteSweepError, match="MemoryError") as caught:
        yd.sweep(PRINTED, chunk=3, **GRID)
    assert caught.value.result.finished.sum() == 15


def test_an_executor_that_was_shut_down():
    executor = ThreadPoolExecutor(1)
    executor.shutdown()
    with pytest.raises(yd.IncompleteSweepError, match="0 of 30"):
        yd.sweep(PRINTED, executor=executor, **GRID)


def test_a_full_disk_does_not_end_the_sweep(monkeypatch, expected, tmp_path):
    file = tmp_path / "kept.npz"
    monkeypatch.setattr(sweeps, "SAVE_EVERY", 0.0)
    whole_file, calls = np.savez_compressed, []

    def full(path, **arrays):
        calls.append(1)
        if 2 <= len(calls) <= 4:
            path.write(b"half")
            raise OSError(errno.ENOSPC, "No space left on device")
        whole_file(path, **arrays)

    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.warns(RuntimeWarning, match="No space left on device.*make room"):
        result = yd.sweep(PRINTED, chunk=6, resume=file, **GRID)
    assert same(result, expected)
    assert [path.name for path in tmp_path.iterdir()] == ["kept.npz"]
    assert same(yd.sweep(PRINTED, resume=file, **GRID), expected)


def test_a_disk_that_stays_full_leaves_the_last_whole_file(monkeypatch, tmp_path):
    file = tmp_path / "kept.npz"
    Counted(monkeypatch, after=1)
    with pytest.raises(yd.IncompleteSweepError):
        yd.sweep(PRINTED, chunk=6, resume=file, **GRID)
    before = file.read_bytes()
    monkeypatch.undo()

    def full(path, **arrays):
        raise OSError(errno.ENOSPC, "No space left on device")

    Counted(monkeypatch, after=2)
    monkeypatch.setattr(np, "savez_compressed", full)
    with (
        pytest.warns(RuntimeWarning, match="could not be written"),
        pytest.raises(yd.IncompleteSweepError, match="Nothing finished is lost") as caught,
    ):
        yd.sweep(PRINTED, chunk=6, resume=file, **GRID)
    assert caught.value.result.finished.sum() == 18
    assert file.read_bytes() == before


def test_a_file_of_another_sweep_is_refused(tmp_path):
    file = tmp_path / "kept.npz"
    yd.sweep(PRINTED, resume=file, **GRID)
    other = {
        "the problem's bogie": (PRINTED.replace(M_b=7000), GRID),
        "the problem's equations": (yd.table1(), GRID),
        "axis v": (PRINTED, {**GRID, "v": np.linspace(70, 101, 30)}),
        "of": (PRINTED, {**GRID, "of": "stable"}),
        "hold": (PRINTED, {**GRID, "hold": "xi_m"}),
    }
    for what, (problem, grid) in other.items():
        with pytest.raises(yd.ProblemError, match=f"belongs to another sweep: .*{what}"):
            yd.sweep(problem, resume=file, **grid)
    assert yd.sweep(PRINTED.replace(title="another title"), resume=file, **GRID).known.all()


def test_a_file_of_another_version_is_refused(monkeypatch, tmp_path):
    file = tmp_path / "kept.npz"
    yd.sweep(PRINTED, resume=file, **GRID)
    monkeypatch.setattr("yawdesign.study.kept_file.__version__", "9.9")
    with pytest.raises(yd.ProblemError, match="version"):
        yd.sweep(PRINTED, resume=file, **GRID)


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x03\x04 broken", b"\x93NUMPY"])
def test_a_file_that_is_no_sweep_is_refused(tmp_path, content):
    file = tmp_path / "kept.npz"
    file.write_bytes(content)
    with pytest.raises(yd.ProblemError, match="is no unfinished sweep"):
        yd.sweep(PRINTED, resume=file, **GRID)
    assert file.read_bytes() == content


def test_arguments_of_the_work_are_checked(tmp_path):
    with pytest.raises(yd.ProblemError, match="neither"):
        yd.sweep(PRINTED, executor=4, **GRID)
    for chunk in (0, -1, 2.5, True):
        with pytest.raises(yd.ProblemError, match="whole number"):
            yd.sweep(PRINTED, chunk=chunk, **GRID)
    with pytest.raises(yd.ProblemError, match="no folder"):
        yd.sweep(PRINTED, resume=tmp_path / "none" / "x.npz", **GRID)

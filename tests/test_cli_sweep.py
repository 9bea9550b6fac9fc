"""The command sweep: answers by the contract, files, exit codes, and what it keeps when something breaks."""

import errno
import functools
import importlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.problem.stopping import Stopped
from yawdesign.study import executors as chunks

PROBLEM = Path(__file__).parents[1] / "problems" / "table1.yaml"
RUN = CliRunner()
CURVE = ("--of", "critical", "--over", "f_m=2:4:5")


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def run(*arguments, code=0):
    result = RUN.invoke(app, ["sweep", str(PROBLEM), *map(str, arguments)])
    assert code in (None, result.exit_code), result.output + str(result.exception)
    return result


def answer(*arguments, code=0):
    return json.loads(run(*arguments, "--json", code=code).stdout)


def test_json_by_the_contract():
    data = answer("--of", "C_sl", "--over", "f_m=0.5:8:4", "--over", "v=150 km/h:450 km/h:3")
    assert data["of"] == "C_sl"
    assert [(axis["name"], axis["unit"]) for axis in data["axes"]] == [("f_m", "Hz"), ("v", "m/s")]
    assert data["axes"][1]["values"] == pytest.approx([150 / 3.6, 300 / 3.6, 450 / 3.6])
    assert [len(data["values"]), len(data["values"][0])] == [4, 3]
    single = yd.load(PROBLEM).replace(speed="450 km/h", K_m=1765 * (2 * np.pi * 8) ** 2)
    assert data["values"][3][2] == pytest.approx(yd.design(single).C_sl, rel=1e-8)


def test_C_sl_is_the_default():
    assert answer("--over", "v=280 km/h:300 km/h:2")["values"][1] == pytest.approx(90702.8897786979, rel=1e-9)


def test_hold():
    both = [answer(*CURVE, *hold)["values"] for hold in ((), ("--hold", "C_m"), ("--hold", "xi_m"))]
    assert both[0] == both[1] != both[2]


def test_a_logarithmic_range():
    axis = answer("--of", "stable", "--over", "C_s=1e4:1e6:3:log")["axes"][0]
    assert axis["values"] == pytest.approx([1e4, 1e5, 1e6])


def test_table():
    text = run(*CURVE).stdout
    for part in ("Sweep of critical", "2 Hz ... 4 Hz, 5 values", "280.662 kN·s/m", "stable for some C_s"):
        assert part in text
    text = run("--of", "stable", "--over", "C_s=1e4:1e6:9:log", "--over", "v=250 km/h:350 km/h:3").stdout
    assert "27" in text


def test_files(tmp_path):
    done = run(*CURVE, "--csv", "x.csv", "--npz", "x.npz", "--plot", "x.png")
    assert "Sweep of critical" in done.stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.csv", "x.npz", "x.png"]
    assert Path("x.csv").read_text().count("\n") == 2 + 1 + 5
    assert np.load("x.npz")["axis_f_m"].tolist() == [2, 2.5, 3, 3.5, 4]
    assert Path("x.png").read_bytes().startswith(b"\x89PNG")


def test_exit_code_1_where_nothing_is_stable():
    assert answer("--of", "stable", "--over", "C_s=1e4:2e4:3", code=1)["values"] == [False] * 3


def test_exit_code_3_where_a_point_is_not_verified(monkeypatch):
    evaluate = chunks.evaluate

    def doubtful(*arguments, **options):
        found = evaluate(*arguments, **options)
        found.unverified[1] = True
        return found

    monkeypatch.setattr(chunks, "evaluate", doubtful)
    assert answer(*CURVE, code=3)["values"][1] is None
    assert "NO at 1 points" in run(*CURVE, code=3).stdout


@pytest.mark.parametrize(
    ("arguments", "texts"),
    [
        (("--over", "fm=1:2:3"), ["did you mean f_m?"]),
        (("--over", "f_m"), ["f_m", "no range"]),
        (("--over", "f_m=3:2:9", "--over", "K_m=1:2:3", "--of", "all"), ["f_m.max", "contradicts", "of: all"]),
        (("--over", "v=70:80:3", "--over", "v=70:80:3"), ["given twice"]),
        (("--over", "f_m=1:2:3", "--hold", "both"), ["hold"]),
        (("--over", "f_m=1:2:3", "--csv", "none/x.csv", "--plot", "x.bmp"), ["no folder none", "x.bmp"]),
        (("--over", "f_m=1:2:3", "--plot", "x.png", "--over", "v=1:2:3", "--over", "a=1:2:3"), ["one or two axes"]),
        (("--over", "v=80", "--plot", "x.png"), ["a single point has no picture"]),
        (("--over", "v=70:80:1"), ["v: one value cannot be both 70 and 80"]),
        (("--over", "v=70:80:2", "--csv", ".", "--npz", ".."), ["--csv: . is a folder", "--npz: .. is a folder"]),
        (("--over", "f_m=1:2:3", "--jobs", "2", "--dask", "tcp://127.0.0.1:1"), ["choose one"]),
        (("--over", "v=1:99:100000", "--over", "a=1:2:100000", "--over", "b=0.7:0.8:100000"), ["1e+15 points"]),
        (("--of", "stable"), ["Missing option"]),
    ],
)
def test_bad_input_is_exit_code_2(arguments, texts):
    done = run(*arguments, code=2)
    assert done.stdout == ""
    for text in texts:
        assert text in done.stderr


def test_no_scheduler(monkeypatch):
    monkeypatch.setattr(chunks, "CONNECT", 0.3)
    done = run(*CURVE, "--dask", "tcp://127.0.0.1:1", code=2)
    assert "no scheduler answers at tcp://127.0.0.1:1" in done.stderr


@pytest.mark.slow
def test_jobs_and_dask(tmp_path):
    from distributed import LocalCluster

    expected = answer(*CURVE)["values"]
    assert answer(*CURVE, "--jobs", 2)["values"] == [pytest.approx(x, rel=1e-12) for x in expected]
    with LocalCluster(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        found = answer(*CURVE, "--dask", cluster.scheduler_address)["values"]
    assert found == [pytest.approx(x, rel=1e-12) for x in expected]


def broken(monkeypatch, error):
    """Break after the first chunk."""
    compute, calls = chunks.answer, []

    def breaks(*arguments):
        calls.append(1)
        if len(calls) > 1:
            raise error
        return compute(*arguments)

    monkeypatch.setattr(chunks, "answer", breaks)
    monkeypatch.setattr(chunks, "HERE", 2)


@pytest.mark.parametrize(("error", "code"), [(KeyboardInterrupt(), 130), (MemoryError("too little"), 3)])
@pytest.mark.parametrize("resume", [(), ("--resume", "mine.npz")])
def test_what_is_finished_is_kept(monkeypatch, error, code, resume):
    expected = answer(*CURVE)
    broken(monkeypatch, error)
    done = run(*CURVE, *resume, code=code)
    name, folder = "mine.npz" if resume else "table1.sweep.npz", Path.cwd()
    assert "2 of 5 points are finished" in done.stderr
    assert f"repeat the command with --resume {name}" in done.stderr
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    assert answer(*CURVE, "--resume", name)["values"] == [pytest.approx(x, rel=1e-12) for x in expected["values"]]


def full_disk(monkeypatch, *names):
    """Let the writing of files fail whose names contain one of `names`."""
    opened = Path.open

    def full(self, mode="r", *more, **options):
        if {*mode} & {*"w+"} and any(name in self.name for name in names):
            raise OSError(errno.ENOSPC, "No space left on device", str(self))
        return opened(self, mode, *more, **options)

    monkeypatch.setattr(Path, "open", full)


def test_a_full_disk_keeps_the_answer_elsewhere(monkeypatch, tmp_path):
    full_disk(monkeypatch, "x.csv")
    done = run(*CURVE, "--csv", "x.csv", "--npz", "x.npz", code=2)
    assert "x.csv could not be written: No space left on device" in done.stderr
    assert "--resume table1.sweep.npz" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["table1.sweep.npz", "x.npz"]
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(chunks, "answer", None)  # nothing is computed again
    run(*CURVE, "--csv", "x.csv", "--resume", "table1.sweep.npz")


def test_matplotlib_that_does_not_start_is_noticed_before_the_work(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    monkeypatch.setattr(chunks, "answer", None)
    assert "Matplotlib does not start" in run(*CURVE, "--plot", "x.png", code=2).stderr


@pytest.mark.parametrize("axis", ["v=300 km/h", "v=300 km/h:300 km/h:1"])
def test_an_axis_of_one_value(axis, tmp_path):
    whole = answer("--of", "critical", "--over", "f_m=2:4:5", "--over", axis)
    assert whole["axes"][1]["values"] == [pytest.approx(300 / 3.6)]
    assert [row[0] for row in whole["values"]] == answer(*CURVE)["values"]
    files = ("--csv", "x.csv", "--npz", "x.npz", "--plot", "x.png")
    done = run("--of", "stable", "--over", axis, "--over", "C_s=1e4:1e6:9:log", *files)
    assert len(list(tmp_path.iterdir())) == 3
    assert "over v" in done.stdout
    done = run("--of", "C_sl", "--over", axis, "--csv", "y.csv", "--npz", "y.npz")
    assert "300 km/h │ 90.7029 kN·s/m" in done.stdout
    assert "..." not in done.stdout
    assert len(Path("y.csv").read_text().splitlines()) == 4


def test_a_disk_without_any_room(monkeypatch, tmp_path):
    full_disk(monkeypatch, ".csv", ".npz")
    done = run(*CURVE, "--csv", "x.csv", code=2)
    assert "make room" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_device_that_is_full():
    if not Path("/dev/full").is_char_device():
        return
    done = run(*CURVE, "--csv", "/dev/full", code=2)
    assert "/dev/full could not be written" in done.stderr
    assert Path("/dev/full").is_char_device()
    command = [sys.executable, "-m", "yawdesign", "sweep", str(PROBLEM), *CURVE, "--json"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert "the answer could not be written" in done.stderr
    assert "--resume table1.sweep.npz" in done.stderr
    assert "Traceback" not in done.stderr


def whole_sweep(name):
    """Return the values that a kept file has for CURVE, of which nothing is computed again."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chunks, "answer", None)
        return answer(*CURVE, "--resume", name)["values"]


@pytest.mark.parametrize(("number", "resume"), [(signal.SIGINT, ()), (signal.SIGTERM, ("--resume", "mine.npz"))])
@pytest.mark.parametrize(
    ("where", "name"),
    [
        ("yawdesign.study.labelled_data", "LabelledData._lines"),
        ("yawdesign.study.store", "write_arrays"),
        ("yawdesign.study.kept_file", "_write"),
        ("yawdesign.study.sweep", "gathered"),
        ("yawdesign.study.sweep", "_boundary"),
        ("yawdesign.output.sweep_files", "draw"),
        ("yawdesign.output.pictures", "write_whole"),
        ("yawdesign.cli.sweeps", "show"),
        ("numpy", "savez_compressed"),
        ("numpy.lib.format", "write_array"),
        ("zipfile", "ZipFile.close"),
    ],
)
def test_a_request_to_stop_loses_no_finished_sweep(monkeypatch, where, name, resume, number, tmp_path):
    """Whatever is being done when it comes, and when people ask again and again."""
    expected = answer(*CURVE)["values"]
    module = importlib.import_module(where)
    *inside, last = name.split(".")
    home = functools.reduce(getattr, inside, module)
    done = getattr(home, last)

    def asked(*arguments, **options):
        signal.raise_signal(number)
        found = done(*arguments, **options)
        signal.raise_signal(number)
        return found

    monkeypatch.setattr(home, last, asked)
    if name == "write_arrays":
        monkeypatch.setattr("yawdesign.study.labelled_data.write_arrays", asked)
    picture = ("--plot", "x.svg") if where.startswith("yawdesign.output") else ()
    result = run(*CURVE, "--csv", "x.csv", "--npz", "x.npz", *picture, *resume, code=None)
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    kept = "mine.npz" if resume else "table1.sweep.npz"
    if name == "_write" and not resume:
        assert result.exit_code == 0  # there is nothing to keep
        return
    assert result.exit_code == 128 + number
    assert f"--resume {kept}" in result.stderr
    assert whole_sweep(kept) == expected
    left = {path.name for path in tmp_path.iterdir()} - {kept, "x.csv", "x.npz", "x.svg"}
    assert not left
    again = ["--force"] if "--force" in result.stderr else []
    run(*CURVE, "--csv", "x.csv", "--npz", "x.npz", "--resume", kept, *again)
    assert len(np.load("x.npz")["values"]) == 5


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_request_to_a_group_of_processes(number, tmp_path):
    """As from a terminal or a batch system; the command ends, though work waits for the other processes."""
    grid = ("--of", "critical", "--over", "f_m=0.5:8:1500", "--over", "v=150 km/h:450 km/h:4000")
    at_once = "from yawdesign.study import sweep; sweep.SAVE_EVERY = 0; from yawdesign.cli import main; main()"
    asked = ("sweep", str(PROBLEM), *grid, "--jobs", "2", "--resume", "k.npz")
    command = [sys.executable, "-c", at_once, *asked]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    latest = time.monotonic() + 120
    while not Path("k.npz").exists() and process.poll() is None and time.monotonic() < latest:
        time.sleep(0.05)  # until both processes are at work and points are finished
    assert Path("k.npz").exists()
    os.killpg(process.pid, number)
    told = process.communicate(timeout=60)[1]
    assert process.returncode == 128 + number
    assert "then it was stopped" in told
    assert "Traceback" not in told


def test_the_terminal_is_closed(monkeypatch):
    broken(monkeypatch, Stopped(signal.SIGHUP))
    done = run(*CURVE, code=129)
    assert "2 of 5 points are finished, then it was stopped (SIGHUP)" in done.stderr


def test_work_kept_of_another_sweep_is_not_overwritten(monkeypatch, tmp_path):
    other = yd.sweep(yd.load(PROBLEM), of="stable", C_s=[1e5, 2e5])
    other.keep("table1.sweep.npz")
    Path("table1.sweep-2.npz").write_text("something else")
    before = Path("table1.sweep.npz").read_bytes()
    for _ in range(2):  # the same sweep adds to its file
        with monkeypatch.context() as patch:
            broken(patch, KeyboardInterrupt())
            assert "--resume table1.sweep-3.npz" in run(*CURVE, code=130).stderr
    assert Path("table1.sweep.npz").read_bytes() == before
    assert Path("table1.sweep-2.npz").read_text() == "something else"


def test_an_error_of_any_kind_while_a_file_is_written_keeps_the_sweep(monkeypatch, tmp_path):
    def fails(result):
        raise RuntimeError("no such font")

    monkeypatch.setattr("yawdesign.output.sweep_files.draw", fails)
    done = RUN.invoke(app, ["sweep", str(PROBLEM), *CURVE, "--plot", "x.png", "--csv", "x.csv"])
    assert done.exit_code == 3
    assert "the results could not be shown: RuntimeError: no such font" in done.stderr
    assert "repeat the command with --resume table1.sweep.npz --force" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["table1.sweep.npz", "x.csv"]
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(chunks, "answer", None)  # nothing is computed again
    run(*CURVE, "--plot", "x.png", "--resume", "table1.sweep.npz")
    assert Path("x.png").exists()


def test_outputs_replace_nothing_unasked(tmp_path):
    problem = tmp_path / "p.yaml"
    problem.write_text(PROBLEM.read_text())
    (tmp_path / "link.yaml").symlink_to(problem)
    for name in ("p.yaml", "link.yaml", "./p.yaml"):
        for force in ((), ("--force",)):
            result = RUN.invoke(app, ["sweep", "p.yaml", *CURVE, "--csv", name, *force])
            assert result.exit_code == 2
            assert "--csv: " in result.stderr
            assert "is what the command reads" in result.stderr
    run(*CURVE, "--csv", "x.csv")
    before = Path("x.csv").read_bytes()
    refused = run(*CURVE, "--csv", "x.csv", code=2)
    assert "x.csv exists: choose another name, or give --force" in refused.stderr
    assert Path("x.csv").read_bytes() == before
    run("--over", "f_m=2:4:3", "--csv", "x.csv", "--force")
    assert Path("x.csv").read_bytes() != before
    assert problem.read_text() == PROBLEM.read_text()


@pytest.mark.parametrize(
    "options",
    [("--csv", "x", "--npz", "x"), ("--npz", "x", "--resume", "./x"), ("--plot", "x.png", "--csv", "x.png")],
)
def test_two_outputs_of_one_name(options, tmp_path):
    done = run(*CURVE, *options, "--force", code=2)
    assert f"is also the file of {options[0] if options[0] != '--plot' else '--csv'}" in done.stderr
    assert list(tmp_path.iterdir()) == []

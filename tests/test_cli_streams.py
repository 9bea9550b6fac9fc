"""Closed and full standard streams, devices as files: a message, the right exit code, never a traceback."""

import logging
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from yawdesign.cli.answering import long_work_told

PROBLEM = Path(__file__).parents[1] / "problems" / "table1.yaml"
YAWDESIGN = f"{sys.executable} -m yawdesign"
SWEEP = f"{YAWDESIGN} sweep {PROBLEM} --of stable --over v=70:80:2"

pytestmark = pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")


def shell(command, folder, **environment):
    given = {**os.environ, **environment}
    return subprocess.run(command, shell=True, cwd=folder, env=given, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("command", "code", "message"),
    [
        (f"{SWEEP} --csv x.csv >&-", 2, "the answer could not be written"),
        (f"{SWEEP} --json --csv x.csv >/dev/full", 2, "the answer could not be written: No space left"),
        (f"{SWEEP} --csv x.csv 2>&-", 0, ""),
        (f"{SWEEP} --csv x.csv <&- 2>/dev/full", 0, ""),
    ],
)
def test_a_sweep_without_its_streams(command, code, message, tmp_path):
    done = shell(command, tmp_path)
    assert done.returncode == code, done.stderr
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "x.csv").read_text().startswith("# sweep of stable")
    kept = [path.name for path in tmp_path.iterdir() if path.name.endswith(".npz")]
    assert kept == (["table1.sweep.npz"] if code else [])


@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("--help >/dev/full", 2),
        ("--help >&-", 2),
        ("--version >/dev/full", 2),
        (f"check {PROBLEM} >/dev/full", 2),
        (f"stability {PROBLEM} >/dev/full", 2),
        (f"stability {PROBLEM} --json >&-", 2),
        ("schema >/dev/full", 2),
        ("schema >/dev/full 2>/dev/full", 2),
        ("stability missing.yaml 2>/dev/full", 2),
        ("stability missing.yaml >&- 2>&-", 2),
        ("stabilty 2>/dev/full", 2),
        (f"stability {PROBLEM} 2>&-", 0),
        (f"stability {PROBLEM} <&-", 0),
        (f"stability {PROBLEM} 2>/dev/full", 0),
    ],
)
def test_exit_codes(command, code, tmp_path):
    done = shell(f"{YAWDESIGN} {command}", tmp_path)
    assert done.returncode == code, done.stderr
    for text in ("Traceback", "Exception ignored"):
        assert text not in done.stderr
    if code and "2>" not in command:
        assert "the answer could not be written" in done.stderr


def test_a_pipe_that_nobody_reads_is_no_unstable_bogie(tmp_path):
    """Exit code 1 would say that there is no stable design."""
    done = shell(f"({YAWDESIGN} stability {PROBLEM}; echo code $? >&2) | true", tmp_path)
    assert "code 2" in done.stderr
    assert "Broken pipe" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("option", ["--csv", "--npz"])
def test_a_device_as_file(option, tmp_path):
    done = shell(f"{SWEEP} {option} /dev/null", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert Path("/dev/null").is_char_device()
    assert list(tmp_path.iterdir()) == []


def test_arrays_through_a_pipe(tmp_path):
    shell(f"mkfifo p; cat p >x.npz & {SWEEP} --npz p; wait", tmp_path)
    with np.load(tmp_path / "x.npz") as file:
        assert file["axis_v"].tolist() == [70, 80]


def test_settings_of_matplotlib_that_are_wrong_or_need_more(tmp_path):
    """A picture needs neither a window nor LaTeX."""
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\ntext.parse_math: False\n")
    done = shell(f"{SWEEP} --plot x.png", tmp_path, MPLBACKEND="nonsense")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


def test_long_work_is_said_on_standard_error(capsys):
    logger = logging.getLogger("yawdesign.hunting.many.compiled")
    with long_work_told():
        logger.info("compiling")
    logger.info("not shown")
    assert capsys.readouterr().err == "compiling\n"

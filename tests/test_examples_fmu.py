"""The example with FMPy and the lines in the manual are run, and the numbers are those of the exact solution."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

import yawdesign as yd

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """The numbers that the example prints."""
    fmu = tmp_path_factory.mktemp("fmpy") / "bogie.fmu"
    yd.write_fmu(yd.load(ROOT / "problems" / "table1.yaml"), fmu)
    script = ROOT / "examples" / "fmpy" / "failing_yaw_damper.py"
    done = subprocess.run([sys.executable, script, fmu], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    words = done.stdout.replace(":", " ").split()
    return [float(word) for word in words if word[0].isdigit()]


@pytest.mark.slow
def test_ride_over_a_sine_and_a_failing_damper(printed):
    problem = yd.load(ROOT / "problems" / "table1.yaml")
    sound, failed = (yd.state_space(problem.replace(C_s=C_s)) for C_s in (problem.bogie.C_s, 10e3))
    omega = 2 * np.pi * sound.speed / 20
    late = np.exp(-2j * omega * problem.bogie.a / sound.speed)
    track = 1e-3 * np.array([1, 0, late, 0])  # times exp(j omega t), of which the imaginary part counts

    steady = np.linalg.solve(1j * omega * np.eye(25) - sound.A, sound.B @ track)
    amplitude, force, stroke = np.abs(sound.C @ steady)[[0, -2, -1]]
    assert printed[:3] == pytest.approx([amplitude / 1e-3, force, stroke * 1e3], rel=2e-3)

    # After the failure at 6 s: the steady motion of the failed bogie, and what is left to die out, or to grow.
    new = np.linalg.solve(1j * omega * np.eye(25) - failed.A, failed.B @ track)
    times = np.arange(2, 3.0005, 1e-3)
    left = np.imag((steady - new) * np.exp(6j * omega))
    left = expm(failed.A * times[0]) @ left
    motion, step = [], expm(failed.A * 1e-3)
    for t in times:
        motion.append(left[0] + np.imag(new[0] * np.exp(1j * omega * (6 + t))))
        left = step @ left
    assert printed[3] == pytest.approx(np.abs(motion).max() / 1e-3, rel=2e-3)
    assert np.linalg.eigvals(failed.A).real.max() > 0.5


def python_of_the_page():
    text = (ROOT / "docs" / "fmu.md").read_text(encoding="utf-8")
    return [part.split("```")[0] for part in text.split("```python")[1:]]


def test_the_lines_on_starting_alike(tmp_path):
    yd.write_fmu(yd.table1(), tmp_path / "bogie.fmu")
    code = python_of_the_page()[1]
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    stroke, run, fmu = map(float, done.stdout.split())
    assert stroke == 0.01
    assert fmu == pytest.approx(run, abs=1e-6)


def test_the_lines_in_the_manual(tmp_path):
    code = python_of_the_page()[0]
    yd.write_fmu(yd.table1(), tmp_path / "bogie.fmu")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    time, y_b, F_s = map(float, done.stdout.splitlines()[-1].split())
    model = yd.state_space(yd.table1().replace(C_s=5e5))
    x = expm(model.A * time)[:, model.states.index("y_w1")] * 3e-3
    wanted, size = model.C @ x, np.abs(model.C @ expm(model.A * 0.1)[:, model.states.index("y_w1")] * 3e-3)
    assert y_b == pytest.approx(wanted[0], abs=1e-4 * size[0])
    assert F_s == pytest.approx(wanted[-2], abs=1e-4 * size[-2])

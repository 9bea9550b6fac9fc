"""A speed without a unit is m/s, and whoever may have meant km/h is told so: in files, commands and Python."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.problem import read
from yawdesign.problem.diagnostics import UnitWarning

TABLE_1 = Path(__file__).parents[1] / "problems" / "table1.yaml"
READ_AS = "90 is read as 90 m/s, which is 324 km/h"


def told(text, tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text("{bogie: {base: table1}, " + text + "}")
    problem, diagnostics = read(path)
    assert problem is not None
    assert {d.severity for d in diagnostics} <= {"warning"}
    return [(d.key, d.message) for d in diagnostics]


CURVE = "curve: {{R: 300 m, L: 19 m, l: 60 m, V_r: {}}}"


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("speed: 90", ["speed"]),
        ("speed: '90'", ["speed"]),
        ("speed: {min: 80, max: 90}", ["speed.min", "speed.max"]),
        ("speed: {min: 200 km/h, max: 90}", ["speed.max"]),
        ("speed: 90 m/s, " + CURVE.format("90"), ["curve.V_r"]),
        ("speed: 9e1, " + CURVE.format("25.0"), ["speed", "curve.V_r"]),
        ("speed: 90 km/h, " + CURVE.format("25 m/s"), []),
    ],
)
def test_in_a_file(text, keys, tmp_path):
    found = told(text, tmp_path)
    assert [key for key, _ in found] == keys
    assert all("is read as" in message and "write " in message for _, message in found)


def test_what_it_was_read_as_stands_in_the_message(tmp_path):
    assert READ_AS in told("speed: 90", tmp_path)[0][1]
    assert "write 90 km/h, or 90 m/s if that is meant" in told("speed: 90", tmp_path)[0][1]
    assert "1 080 km/h; 20 ... 600 km/h is common" in told("speed: 300", tmp_path)[0][1]


PROBLEM = yd.table1()


@pytest.mark.parametrize(
    "use",
    [
        lambda: PROBLEM.replace(speed=90),
        lambda: PROBLEM.replace(speed="90"),
        lambda: PROBLEM.replace(speed=90.0),
        lambda: PROBLEM.replace(speed=np.float64(90)),
        lambda: PROBLEM.replace(speed=300.5),
        lambda: yd.Problem(bogie=PROBLEM.bogie, speed="90"),
        lambda: yd.Problem(bogie=PROBLEM.bogie, speed=300),
        lambda: yd.SpeedRange(min="80", max="300 km/h"),
        lambda: yd.SpeedRange(min=50, max=300),
        lambda: yd.Curve(R=300, L=19, l=60, V_r="90"),
        lambda: yd.Curve(R=300, L=19, l=60, V_r=90),
        lambda: yd.follow_modes(PROBLEM, v=["80", "300 km/h"]),
        lambda: yd.follow_modes(PROBLEM, v=[50, 200]),
        lambda: yd.frequency_response(PROBLEM, 20, speed="80"),
        lambda: yd.frequency_response(PROBLEM, 20, speed=300),
        lambda: yd.stationary_response(PROBLEM, speed="50"),
        lambda: yd.simulate(PROBLEM, speed="50", duration=5),
        lambda: yd.simulate(PROBLEM, speed=["50", "180 km/h"], duration=5),
        lambda: yd.spectrum_check(speed="50"),
        lambda: yd.sweep(PROBLEM, of="stable", v="50:80:2"),
        lambda: yd.sweep(PROBLEM, of="stable", v=["50", "80 m/s"]),
        lambda: yd.sweep(PROBLEM, of="stable", v=[50, 200]),
        lambda: yd.sweep(PROBLEM, of="stable", v=np.array([50.0, 200.0])),
    ],
)
def test_in_python(use):
    with pytest.warns(UnitWarning, match=r"is read as .* m/s, which is .* km/h") as found:
        use()
    assert {Path(warning.filename).name for warning in found} == {Path(__file__).name}


def test_computed_numbers_and_units_pass_in_silence():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        problem = PROBLEM.replace(speed=250 / 3.6).replace(C_s="1 MN s/m", curve=PROBLEM.curve)
        problem = problem.replace(speed="90 m/s").replace(K_m=6e5).replace(speed=yd.SpeedRange(min=50, max=80))
        yd.simulate(PROBLEM, speed=[50, 250 / 3.6], duration=5)
        yd.sweep(PROBLEM, of="stable", v=np.linspace(50, 80, 3))
        yd.Curve(R=300, L=19, l=60, V_r=25)
        yd.Curve(R=5000, L=19, l=60, V_r=90)


@pytest.mark.parametrize(
    ("command", "keys"),
    [
        (["simulate", TABLE_1, "--speed", "90", "--duration", "5 s"], ["speed: 90 "]),
        (["simulate", TABLE_1, "--speed", "90 km/h", "--speed", "60", "--duration", "5 s"], ["speed: 60 "]),
        (["sweep", TABLE_1, "--of", "stable", "--over", "v=50:80:2"], ["v: 50 ", "v: 80 "]),
        (["modes", TABLE_1, "--over", "v=50:80 m/s:2"], ["v: 50 "]),
    ],
)
def test_on_the_command_line(command, keys):
    result = CliRunner().invoke(app, [str(part) for part in command])
    assert result.exit_code in (0, 1), result.stderr
    lines = [line for line in result.stderr.splitlines() if "is read as" in line]
    assert [line.partition("is read as")[0] for line in lines] == [f"warning: {key}" for key in keys]
    assert "is read as" not in result.stdout


@pytest.mark.parametrize("value", ["300", "90"])
def test_an_axis_of_one_bare_speed_says_what_it_was_read_as(value):
    with pytest.warns(UnitWarning, match=rf"{value} is read as {value} m/s"):
        yd.sweep(yd.table1(), of="C_sl", v=value)

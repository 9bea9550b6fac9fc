"""The command `simulate`: exit codes, JSON, files."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.problem.parameters import CarBody

TABLE_1 = Path(__file__).parents[1] / "problems" / "table1.yaml"
RUN = CliRunner()


def run(*arguments):
    return RUN.invoke(app, ["simulate", *(str(a) for a in arguments)])


def test_json():
    result = run(TABLE_1, "--json")
    assert result.exit_code == 0, result.stderr
    data = json.loads(result.stdout)
    assert data["rms"]["y_b"] == pytest.approx(3.9e-3, rel=0.02)
    assert data["peak"]["yaw_damper_force"] > data["rms"]["yaw_damper_force"] > 0
    assert data["settles"] is True
    assert data["damper"]["at_hunting"]["stiffness"] > 0


def test_several_speeds_and_an_unstable_one(tmp_path):
    text = TABLE_1.read_text().replace("C_s: 1 000 kN·s/m", "C_s: 50 kN·s/m   ")
    file = tmp_path / "weak.yaml"
    file.write_text(text)
    result = run(file, "--speed", "250 km/h", "--speed", "300 km/h", "--duration", "20 s")
    assert result.exit_code == 1
    words = " ".join(result.stdout.split())
    assert "250 km/h: amplitudes settle" in words
    assert "300 km/h: UNSTABLE: amplitudes do not settle" in words


def test_files(tmp_path):
    csv, npz, png = (tmp_path / f"run.{ending}" for ending in ("csv", "npz", "png"))
    options = ["--csv", csv, "--npz", npz, "--plot", png, "--response", "phi_b_acceleration"]
    result = run(TABLE_1, "--length", "100 m", "--start", "rest", *options)
    assert result.exit_code == 0, result.stderr
    assert sorted(x.name for x in tmp_path.iterdir()) == ["run.csv", "run.npz", "run.png"]
    head = csv.read_text().split("\n", 1)[0].split(", ")
    assert head[:4] == ["speed [m/s]", "time [s]", "distance [m]", "alignment_1 [m]"]
    assert "cross_level_2 [rad]" in head
    table = np.loadtxt(csv, delimiter=",", skiprows=1)
    with np.load(npz) as arrays:
        assert table[:, head.index("phi_b [rad]")] == pytest.approx(arrays["phi_b"], rel=1e-8, abs=1e-15)
        assert arrays["distance"][-1] == pytest.approx(100)
    assert png.read_bytes().startswith(b"\x89PNG")


def test_measured_and_own_tracks(tmp_path):
    file = tmp_path / "track.csv"
    file.write_text("distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, {k % 7}" for k in range(1000)))
    assert run(TABLE_1, "--track", file).exit_code == 0
    file.write_text("distance [m], alignment [mm]\n0, 1\n0.25, \n0.1, 2\n")
    bad = run(TABLE_1, "--track", file)
    assert bad.exit_code == 2
    assert "track.csv:3:7: error: alignment: the value is missing" in bad.stderr
    assert bad.stdout == ""
    short = ["--duration", "5 s"]
    assert run(TABLE_1, "--track", "harmonic", "--wavelength", "30 m", "--amplitude", "2 mm", *short).exit_code == 0
    assert run(TABLE_1, "--track", "sinusoid", "--amplitude", "2 mm", *short).exit_code == 0
    assert run(TABLE_1, "--track", "fra-5", "--band", "0.024 1/m", "0.333 1/m", *short).exit_code == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--track", "german-lo"], "did you mean german-low"),
        (["--track", "fra-5", "--wavelength", "30 m"], "fra-5 has no wavelength"),
        (["--speed", "300 kmh"], "km/h"),
        (["--step", "0.1 s"], "too coarse"),
        (["--start", "moving"], "is not one of"),
        (["--csv", "x.txt"], "must end in .csv"),
        (["--plot", "/nowhere/x.png"], "there is no folder"),
        (["--response", "yb", "--plot", "x.png", "--duration", "2 s"], "--response: yb is not one of"),
        (["--response", "y_b"], "--response: chooses what --plot draws"),
        (["--track", "/dev/zero"], "/dev/zero: error: cannot be read: it is a device or a pipe"),
        (["--csv", "none/x.csv"], "there is no folder none"),
    ],
)
def test_bad_input(options, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("yawdesign.response.run.simulate.run", None)  # no work begins
    result = run(TABLE_1, *options)
    assert result.exit_code == 2, result.output
    assert message in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_car_body_on_two_bogies(tmp_path, monkeypatch):
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    problem = replace(yd.table1().replace(C_s="1 MN s/m"), car_body=body)
    monkeypatch.setattr("yawdesign.cli.responses.read_problem", lambda file, changes: problem)
    png, csv = tmp_path / "run.png", tmp_path / "run.csv"
    options = ["--plot", png, "--response", "y_b1", "--response", "y_b2", "--csv", csv, "--duration", "3 s"]
    result = run(TABLE_1, "--json", *options)
    assert result.exit_code == 0, result.stderr
    data = json.loads(result.stdout)
    assert [damper["name"] for damper in data["dampers"]] == ["yaw damper 1", "yaw damper 2"]
    assert data["runs"][0]["rms_weighted"]["y_c2_acceleration"] < data["rms"]["y_c2_acceleration"]
    assert "y_c1_acceleration [m/s^2]" in csv.read_text().split("\n", 1)[0]
    assert png.read_bytes().startswith(b"\x89PNG")
    apart = run(TABLE_1, "--plot", tmp_path / "x.png", "--response", "y_b1", "--response", "psi_c", "--duration", "3 s")
    assert apart.exit_code == 2
    assert "psi_c is counted in rad, y_b1 in m: draw them apart" in apart.stderr

"""The commands stability and critical-speed: first lines, JSON, and the exit code where something is missed."""

import json

import matplotlib.pyplot as plt
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app

PLAIN = """
bogie: {base: table1, C_s: 1300 kN s/m}
speed: 300 km/h
"""
LISTS = """
conditions:
  lambda: [0.05, 0.25]
  creep_factor: [1, 0.5]
"""
CASES = """
cases:
  one lost: {C_s: 50 %, K_ds: 50 %}
"""


@pytest.fixture
def run(tmp_path):
    def found(command, text, *options, code):
        path = tmp_path / "problem.yaml"
        path.write_text(text, encoding="utf-8")
        done = CliRunner().invoke(app, [command, str(path), *options])
        assert done.exit_code == code, done.output
        return " ".join(done.stdout.split())

    return found


@pytest.mark.parametrize(
    ("more", "code"),
    [
        ("", 0),
        ("requirements: {damping_ratio: 2 %}", 0),
        ("requirements: {damping_ratio: 3 %}", 1),
        ("requirements: {critical_speed: 350 km/h}", 0),
        ("requirements: {critical_speed: 360 km/h}", 1),
        (f"{CASES}requirements: {{cases: {{damping_ratio: 0 %}}}}", 1),
        (CASES, 0),
    ],
)
def test_a_missed_requirement_is_exit_code_1(run, more, code):
    found = json.loads(run("stability", PLAIN + LISTS + more, "--json", code=code))
    assert found["stable"]
    assert all(each["met"] for each in found["requirements"]) == (code == 0)
    assert found["worst_condition"].keys() == {"speed", "lambda", "creep_factor"}
    for case in found["cases"]:
        assert case.keys() >= {"name", "stable", "decay_rate", "damping_ratio", "worst_condition"}
    for each in found["requirements"]:
        assert each.keys() >= {"name", "wanted", "reached", "met", "worst_condition"}


def test_the_first_line_says_under_which_conditions(run):
    one = run("stability", PLAIN, code=0)
    assert one.startswith("The bogie is stable under one condition only: lambda 0.15, creep as given, 300 km/h.")
    several = run("stability", PLAIN + LISTS, code=0)
    assert several.startswith(
        "The bogie is stable under all 4 conditions (300 km/h; lambda 0.05, 0.25; creep x 1, 0.5)."
    )
    unstable = run("stability", PLAIN.replace("1300", "900") + LISTS, code=1)
    assert unstable.startswith("The bogie is UNSTABLE with lambda 0.25, creep x 0.5, 300 km/h. It was looked at under")
    ranges = PLAIN + "conditions: {lambda: {min: 0.1, max: 0.4}, tolerance: {K_m: 10 %}}"
    searched = run("stability", ranges, code=0)
    assert "under every condition that a search found in lambda 0.1 ... 0.4, K_m -10 ... +10 %" in searched
    assert "(no proof)" in searched


def test_critical_speed(run):
    found = json.loads(run("critical-speed", PLAIN + LISTS, "--json", code=0))
    assert found["critical_speeds"][0].keys() == {"v", "omega", "becomes", "condition"}
    assert found["searched"] == pytest.approx([10 / 3.6, 600 / 3.6])
    assert found["stable_up_to"] == found["worst_condition"]["speed"]
    assert "none up to 600 km/h" in run("critical-speed", PLAIN, code=0)
    told = run("critical-speed", PLAIN + LISTS + "requirements: {critical_speed: 360 km/h}", code=1)
    assert "Critical speed: 351.882 km/h, under all 4 conditions" in told
    assert "330 km/h: reached" in told


def test_a_vehicle_that_is_never_stable_is_exit_code_1(run):
    told = run("critical-speed", PLAIN.replace("}", ", C_mphi: 0}"), code=1)
    assert "UNSTABLE at 10 km/h already" in told


def test_a_missing_damping_is_told():
    bare = yd.Problem(bogie=yd.table1().bogie, speed="300 km/h").replace(C_s=None)
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.critical_speed(bare)


@pytest.mark.parametrize("C_s", ["200 kN s/m", "1300 kN s/m"])
def test_a_picture(C_s):
    ax = yd.plot(yd.critical_speed(yd.table1().replace(C_s=C_s)))
    assert ax.get_xlabel() == "running speed $v$ [km/h]"
    plt.close("all")

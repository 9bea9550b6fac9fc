"""The option --set: a value in place of the file's, for every command that reads a problem."""

import inspect
import json

import pytest
from typer.testing import CliRunner

from yawdesign.cli import COMMANDS, app
from yawdesign.problem import read
from yawdesign.problem.changes import written_value

TABLE_1 = """
bogie: {base: table1}
speed: 300 km/h
curve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90 km/h}
conditions:
  lambda: [0.05, 0.4]
  creep_factor: {min: 0.5, max: 1}
  load: {tare: {W: 120 kN}, laden: {W: 200 kN, M_b: 8 t}}
cases:
  one lost, 50.5 %: {C_s: 50 %, K_ds: 50 %}
"""
VEHICLE = """
bogie: {base: table1, W: 167 kN}
car_body: {base: huo-dai, l_c: 9.5 m}
speed: 200 km/h
cases: {a: {leading.C_s: 50 %}}
"""
CREEP = """
bogie: {base: table1, creep: {kalker_factor: 0.5}}
speed: 200 km/h
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text(TABLE_1, encoding="utf-8")
    return path


@pytest.fixture
def changed(tmp_path):
    """Return what is read with some new values, or the messages."""

    def found(*texts, of=TABLE_1):
        path = tmp_path / "p.yaml"
        path.write_text(of, encoding="utf-8")
        problem, diagnostics = read(path, [written_value(text) for text in texts])
        return problem or [f"{each.key}: {each.message}" for each in diagnostics]

    return found


@pytest.mark.parametrize(
    "command", [x for x in COMMANDS if x.__name__ not in ("new", "schema")], ids=lambda command: command.__name__
)
def test_every_command_that_reads_a_problem_has_it(command):
    parameters = inspect.signature(command).parameters
    assert "changes" in parameters or "file" not in parameters


def test_numbers_and_texts_reach_the_answer(file):
    done = CliRunner().invoke(
        app, ["stability", str(file), "--set", "C_s=50 kN s/m", "--set", "speed=280 km/h", "--json"]
    )
    found = json.loads(done.stdout)
    assert found["C_s"] == 5e4
    assert found["speed"] == 280 / 3.6


def test_all_mistakes_at_once(file):
    options = ("C_S=3", "K_m=3 kg", "x", "lambda=77", "cases.other.C_s=1", "speed.min=3")
    done = CliRunner().invoke(app, ["stability", str(file), *(part for text in options for part in ("--set", text))])
    assert done.exit_code == 2
    assert not done.stdout
    for line in (
        "error: --set C_S=3: is not known here; did you mean C_s?",
        "error: --set K_m=3 kg: 3 kg is a mass, expected a stiffness such as kN/m",
        'error: --set x: expected NAME=VALUE, such as C_s="800 kN s/m"',
        "error: --set lambda=77: 77 is outside 0 ... 10",
        "error: --set cases.other.C_s=1: other is not known under cases; there are one lost, 50.5 %",
        "error: --set speed.min=3: speed is 300 km/h, which has no min: give speed as a whole",
    ):
        assert line in done.stderr.splitlines()


def test_a_doubtful_value_is_told_by_its_option(file):
    done = CliRunner().invoke(app, ["check", str(file), "--set", "speed=90"])
    assert "warning: --set speed=90: 90 is read as 90 m/s, which is 324 km/h" in done.stderr


def test_it_replaces_the_condition_of_its_name_and_the_others_stay(changed):
    written = changed("lambda=0.2").conditions.written
    assert "lambda" not in written
    assert set(written) == {"creep_factor", "load"}
    assert changed("lambda_=0.2").conditions.written == written
    loads = changed("W=150 kN").conditions.written["load"]
    assert loads == {"tare": {}, "laden": {"M_b": 8000.0}}
    assert set(changed("W=150 kN", "M_b=7 t").conditions.written) == {"lambda", "creep_factor"}
    assert set(changed("f_11=9 MN").conditions.written) == {"lambda", "load"}


def test_dotted_names(changed):
    problem = changed(
        "conditions.lambda=[0.1, 0.3]",
        "conditions.load.tare.W=130 kN",
        "cases.one lost, 50.5 %.C_s=40 %",
        "cases.both lost={C_s: 0 %}",
        "requirements.damping_ratio=5 %",
        "requirements.cases.damping_ratio=0 %",
        "design.variables.C_s.max=5 MN s/m",
        "curve.load=wheel",
        "equations=as-printed",
        "title=Run #3: faster",
        "uncertainty.K_m.lognormal=5 %",
    )
    assert dict(problem.conditions.values)["lambda"] == (0.1, 0.3)
    assert dict(problem.conditions.loads[0].changes) == {"W": 130e3}
    assert [(case.name, case.changes[0].value) for case in problem.cases] == [
        ("one lost, 50.5 %", 0.4),
        ("both lost", 0),
    ]
    assert [each.name for each in problem.requirements] == ["damping_ratio", "cases.damping_ratio"]
    assert problem.design.variables["C_s"].max == 5e6
    assert set(problem.design.variables) == {"C_s", "K_m", "C_m"}
    assert (problem.curve.load, problem.equations, problem.title) == ("wheel", "as-printed", "Run #3: faster")
    assert problem.uncertainty[0].written == {"lognormal": "5 %"}


def test_bare_names_are_looked_for_in_their_order(changed):
    assert changed("K_2z=0.3 MN/m", "qqq=1", of=VEHICLE) == [
        "--set qqq=1: is not known here; `yawdesign schema` lists what is"
    ]
    problem = changed("K_2z=0.3 MN/m", "overturning=true", "objective=damping_ratio", of=VEHICLE)
    assert problem.car_body.K_2z == 0.3e6
    assert problem.car_body.overturning
    assert problem.design.objective == "damping_ratio"
    assert changed("cases.a.leading.C_s=30 %", of=VEHICLE).cases[0].changes[0].value == 0.3
    assert changed("limit=0.1", "L=20 m").curve.limit == 0.1
    assert changed("M_c=3 t") == ["--set M_c=3 t: is not part of this vehicle: give its value under car_body first"]


def test_null_removes_a_key_of_a_preset_too(changed):
    assert changed("C_s=null").bogie.C_s is None
    assert changed("conditions=null").conditions.written == {}
    assert changed("curve=null", of=CREEP).curve is None
    assert changed("conditions.lambdaa=null") == [
        "--set conditions.lambdaa=null: is not there to be removed; did you mean lambda?"
    ]


def test_creep_coefficients_take_the_place_of_creep(changed):
    made = changed(of=CREEP).bogie
    one = changed("f_11=9 MN", of=CREEP).bogie
    assert (one.f_11, one.f_22) == (9e6, made.f_22)
    again = changed("bogie.creep.kalker_factor=1", of=CREEP).bogie
    assert again.f_11 == pytest.approx(2 * made.f_11)
    assert changed("W=100 kN", of=CREEP).bogie.f_11 < made.f_11
    assert (
        changed("bogie.creep={kalker_factor: 0.5}", of=CREEP.replace("creep: {kalker_factor: 0.5}", "f_11: 9 MN")).bogie
        == made
    )


def test_a_part_without_what_is_removed_from_it(changed):
    assert changed("bogie.creep=null", of=CREEP).bogie.f_11 == 11511e3
    assert "bogie.M_b: is missing" in " ".join(changed("bogie.base=null", of=CREEP))


def test_a_name_twice(changed):
    assert changed("lambda=0.2", "bogie.lambda=0.3") == ["--set bogie.lambda=0.3: bogie.lambda is given twice"]

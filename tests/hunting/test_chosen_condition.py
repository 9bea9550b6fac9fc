"""One condition of a problem, as written, the worst or given: the same as its values written into the problem."""

import json
import re
import zipfile
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.hunting.chosen_condition import chosen, condition_in_words
from yawdesign.hunting.verdict import stability_at
from yawdesign.vehicle.vehicle import Model

CONDITIONS = {"lambda": [0.05, 0.1, 0.15, 0.25, 0.4], "creep_factor": [1.0, 0.7, 0.5]}
PLAIN = yd.table1().replace(C_s="1.2 MN s/m", speed="300 km/h")
PROBLEM = PLAIN.replace(conditions={**CONDITIONS, "load": {"tare": {"W": "120 kN"}, "laden": {"W": "200 kN"}}})
GIVEN = {"lambda": 0.3, "creep_factor": "50 %", "speed": "280 km/h", "load": "tare", "tolerance.K_m": "-10 %"}
BY_HAND = PLAIN.replace(
    speed="280 km/h",
    W="120 kN",
    lambda_=0.3,
    f_11=PLAIN.bogie.f_11 / 2,
    f_22=PLAIN.bogie.f_22 / 2,
    K_m=0.9 * PLAIN.bogie.K_m,
)


def plain(result):
    return {name: value for name, value in result.to_dict().items() if name != "condition"}


FUNCTIONS = {
    "modes": yd.modes,
    "follow_modes": lambda problem, **more: yd.follow_modes(problem, C_s=[1e6, 1.2e6], **more),
    "frequency_response": yd.frequency_response,
    "stationary_response": yd.stationary_response,
    "simulate": lambda problem, **more: yd.simulate(problem, duration=0.5, **more),
    "state_space": yd.state_space,
    "functions": lambda problem, **more: yd.functions(problem, inputs=["C_s"], only=["state_matrix"], **more),
}


def same(found, expected):
    """Say whether two results are the same plain data, but for rounding."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for name, value in expected.items():
            if name != "condition":
                same(found[name], value)
    elif isinstance(expected, (list, tuple)) and expected and not isinstance(expected[0], str):
        assert len(found) == len(expected)
        for x, y in zip(found, expected, strict=True):
            same(x, y)
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)
    else:
        assert found == expected


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_condition_is_the_problem_with_its_values(name):
    same(plain(FUNCTIONS[name](PROBLEM, condition=GIVEN)), plain(FUNCTIONS[name](BY_HAND)))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_without_a_condition_the_values_are_as_written(name):
    same(plain(FUNCTIONS[name](PROBLEM)), plain(FUNCTIONS[name](PLAIN)))


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "functions"])
def test_a_result_says_its_condition_and_takes_it_again(name):
    worst = {"speed": 300 / 3.6, "lambda": 0.25, "creep_factor": 0.5, "load": "tare"}
    result = FUNCTIONS[name](PROBLEM, condition="worst")
    assert result.condition == pytest.approx({"values": "worst", **worst})
    again = FUNCTIONS[name](PROBLEM, condition=result.condition)
    assert again.condition == {**result.condition, "values": "given"}
    same(plain(again), plain(result))
    assert FUNCTIONS[name](PLAIN).condition == {"values": "as written", "speed": 300 / 3.6}


def test_functions_say_their_condition():
    for inputs, speed in ((["C_s"], {"speed": 300 / 3.6}), (["v"], {"speed": 300 / 3.6})):
        found = yd.functions(PROBLEM, inputs, only=["state_matrix"], condition="worst").to_dict()["state_matrix"]
        assert found["condition"]["values"] == "worst"
        assert found["condition"].items() >= speed.items()
    several = PLAIN.replace(speed=["250 km/h", "300 km/h"])
    assert yd.functions(several, ["v"], only=["state_matrix"]).to_dict()["state_matrix"]["condition"] == {
        "values": "as written"
    }


@pytest.mark.parametrize("objective", ["decay_rate", "damping_ratio"])
@pytest.mark.parametrize("C_s", [4e5, 1.3e6])
def test_the_worst_of_lists_is_that_of_all_of_them(objective, C_s):
    problem = PLAIN.replace(C_s=C_s, objective=objective, conditions=CONDITIONS)
    p, model = PLAIN.parameters() | {"C_s": C_s, "v": 300 / 3.6}, Model.of(problem)
    margins = {}
    for conicity, creep in product(*CONDITIONS.values()):
        changed = {**p, "lambda": conicity, "f_11": creep * p["f_11"], "f_22": creep * p["f_22"]}
        found = stability_at(model.at({name: float(x) for name, x in changed.items()}), problem.design.variables)
        margins[conicity, creep] = (found.stable, getattr(found, objective if found.stable else "decay_rate"))
    assert (C_s < 1e6) == (min(margins.values())[0] is False)
    worst = chosen(problem, "worst").changes
    assert (worst["lambda"], worst["creep_factor"]) == min(margins, key=margins.__getitem__)


def test_the_worst_of_ranges_lies_below_all_of_a_grid():
    ranges = {"lambda": {"min": 0.05, "max": 0.4}, "creep_factor": {"min": 0.5, "max": 1.0}}
    problem = PLAIN.replace(C_s="1.4 MN s/m", speed=yd.SpeedRange(min=60.0, max=90.0), conditions=ranges)
    under = chosen(problem, "worst").problem
    least = -yd.stability(under).spectral_abscissa
    assert not under.conditions
    p, model = problem.parameters(), Model.of(problem)
    places = [np.linspace(low, high, 5) for low, high in ((0.05, 0.4), (0.5, 1.0), (60.0, 90.0))]
    for conicity, creep, v in product(*places):
        vehicle = model.at({**p, "lambda": conicity, "f_11": creep * p["f_11"], "f_22": creep * p["f_22"], "v": v})
        assert least < stability_at(vehicle).decay_rate + 1e-9


def test_speeds_given_beside_the_worst_condition_are_those_it_is_looked_for_in():
    assert yd.frequency_response(PROBLEM, speed="250 km/h", condition="worst").speed == pytest.approx(250 / 3.6)
    several = PLAIN.replace(speed=["200 km/h", "250 km/h", "300 km/h"], conditions=CONDITIONS)
    assert yd.frequency_response(several, condition="worst").speed == pytest.approx(300 / 3.6)
    runs = yd.simulate(several, duration=0.2, condition={"lambda": 0.4})
    assert [3.6 * run.speed for run in runs.runs] == pytest.approx([200, 250, 300])
    assert runs.condition == {"values": "given", "lambda": 0.4}
    one = yd.simulate(several, duration=0.2, speed=["200 km/h", "250 km/h"], condition="worst")
    assert [3.6 * run.speed for run in one.runs] == pytest.approx([250])
    with pytest.raises(yd.ProblemError, match=r"condition.speed: is given beside a speed"):
        yd.simulate(PROBLEM, speed=80.0, condition={"speed": 70.0})
    with pytest.raises(yd.ProblemError, match="speed: is missing: the problem has a range of speeds"):
        yd.stationary_response(several, condition={"lambda": 0.4})


def test_what_no_condition_touches_keeps_its_decimals():
    under = chosen(PROBLEM, {"creep_factor": "0.7", "tolerance.K_m": "-10 %"}).problem
    assert under.bogie.K_1y.exact == PROBLEM.bogie.K_1y.exact
    assert under.bogie.K_m.exact == PROBLEM.bogie.K_m.exact * Fraction(9, 10)
    assert under.bogie.f_11.exact == PROBLEM.bogie.f_11.exact * Fraction(7, 10)
    assert chosen(PLAIN).problem is PLAIN


def test_a_sweep_goes_through_the_condition():
    found = yd.follow_modes(PROBLEM, condition="worst", v=["290 km/h", "300 km/h"])
    assert found.condition == {"values": "worst", "lambda": 0.25, "creep_factor": 0.5, "load": "tare"}
    assert {mode.name for mode in yd.modes(PROBLEM, condition="worst").modes} >= set(found.names)


def test_mistakes_are_told_all_at_once():
    wrong = {"lamda": 0.1, "creep_factor": "x", "load": "ladden", "speed": "3 m", "tolerance.K_m": -1, "W": -5}
    with pytest.raises(yd.ProblemError) as caught:
        yd.modes(PROBLEM, condition=wrong)
    told = str(caught.value).splitlines()
    assert [line.split(": ")[1] for line in told] == [f"condition.{name}" for name in wrong]
    assert "did you mean lambda?" in told[0]
    assert "did you mean laden?" in told[2]
    with pytest.raises(yd.ProblemError, match=r"condition: worse is neither .* did you mean worst"):
        yd.modes(PROBLEM, condition="worse")
    with pytest.raises(yd.ProblemError, match=r"condition.load: tare is not known: the problem has no loads"):
        yd.modes(PLAIN, condition={"load": "tare"})
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.modes(PROBLEM.replace(C_s=None), condition="worst")
    with pytest.raises(yd.ProblemError, match=r"condition\..*W: .* outside"):
        yd.modes(PLAIN, condition={"W": 0.9e9, "tolerance.W": 0.9})


def test_pictures_say_a_condition_that_is_not_as_written():
    for result in (
        yd.modes(PROBLEM, condition="worst"),
        yd.simulate(PROBLEM, duration=0.2, condition="worst"),
        yd.frequency_response(PROBLEM, [10, 20], condition="worst"),
        yd.follow_modes(PROBLEM, v=[80, 85], condition="worst"),
    ):
        ax = yd.plot(result)
        title = ax.get_title("left") or ax.get_title()
        assert title.splitlines()[-1] == condition_in_words(result.condition)
        assert "lambda 0.25, creep x 0.5, load tare" in title


@pytest.fixture
def file(tmp_path):
    """Return a file of a problem with fifteen conditions."""
    data = {"bogie": {"base": "table1", "C_s": 1.2e6}, "speed": "300 km/h", "conditions": CONDITIONS}
    path = tmp_path / "problem.yaml"
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


COMMANDS = {
    "modes": [],
    "simulate": ["--duration", "0.5 s"],
    "export": ["--only", "dynamic_stiffness", "--formats", "casadi,mat"],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_under_a_condition(command, file, tmp_path):
    def run(*options):
        to = ["--to", str(tmp_path / f"{len([*tmp_path.iterdir()])}")] if command == "export" else []
        return CliRunner().invoke(app, [command, str(file), *COMMANDS[command], *to, *options, "--json"])

    written, same_as_written, worst = run(), run("--condition", "as-written"), run("--condition", "worst")
    given = run("--condition", "lambda=0.25", "--condition", "creep_factor=50 %", "--condition", "speed=300 km/h")
    line = "values as written, at 300 km/h; the problem has 15 conditions: --condition worst"
    assert [line in done.stderr for done in (written, same_as_written, worst, given)] == [True, True, False, False]
    found = [json.loads(done.stdout) for done in (written, same_as_written, worst, given)]
    assert [x.pop("condition")["values"] for x in found] == ["as written", "as written", "worst", "given"]
    for x in found:
        x.pop("folder", None)
    assert found[0] == found[1]
    assert found[2] == found[3]
    assert command == "export" or found[0] != found[2]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["wrost"], "wrost: is none of as-written, worst, NAME=VALUE; did you mean worst?"),
        (["worst", "lambda=0.1"], "worst: stands alone"),
        (["lambda=0.1", "lambda=0.2"], "lambda is given twice"),
        (["lamda=0.1"], "condition.lamda: is not known here; did you mean lambda?"),
    ],
)
def test_mistakes_on_the_command_line(options, text, file):
    done = CliRunner().invoke(app, ["modes", str(file), *(x for each in options for x in ("--condition", each))])
    assert done.exit_code == 2
    assert text in done.stderr


def test_an_export_says_its_condition(tmp_path):
    yd.export(PROBLEM, tmp_path / "out", only=["state_matrix"], inputs=["C_s"], formats=["c"], condition="worst")
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text(encoding="utf-8"))
    assert manifest["condition"]["values"] == "worst"
    assert manifest["functions"]["state_matrix"]["baked"]["lambda"] == 0.25
    said = "worst condition: 300 km/h, lambda 0.25, creep x 0.5, load tare"
    assert said in (tmp_path / "out" / "yawdesign.h").read_text(encoding="utf-8")


def test_an_fmu_begins_with_the_values_of_its_condition(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "none")  # no library is needed here
    texts = []
    for name, problem, condition in (("a", PROBLEM, GIVEN), ("b", BY_HAND, "as written")):
        fmu = yd.write_fmu(problem, tmp_path / f"{name}.fmu", condition=condition)
        assert fmu.condition["speed"] == pytest.approx(280 / 3.6)
        with zipfile.ZipFile(fmu.path) as archive:
            texts.append([archive.read(file).decode() for file in ("sources/model.h", "modelDescription.xml")])
    (header, description), (by_hand, _) = texts
    starts = [re.search(r"start_values\[\] = {(.*)}", text)[1].split(", ") for text in (header, by_hand)]
    assert [float(x) for x in starts[0]] == pytest.approx([float(x) for x in starts[1]], rel=1e-12)
    assert "condition: 280 km/h, lambda 0.3, creep x 0.5, K_m -10 %, load tare" in description

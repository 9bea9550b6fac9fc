"""Problems made in Python."""

import dataclasses
import json
import math
import pickle
from fractions import Fraction

import pytest

from yawdesign.problem import Curve, Design, Problem, ProblemError, SpeedRange, Variable, Written, exact, table1

CURVE = {"R": "300 m", "L": 19, "l": 60, "V_r": "90 km/h"}


def error(function, *args, **kwargs):
    with pytest.raises(ProblemError) as caught:
        function(*args, **kwargs)
    return str(caught.value)


def test_table_1_is_the_papers_example():
    problem = table1()
    assert problem.equations == "reciprocal"
    assert problem.speeds == (300 / 3.6,)
    assert problem.curve == Curve(R=300, L=19, l=60, V_r=25, limit=0.08, load="axle")
    assert problem.bogie.C_s == 1e6
    assert table1(equations="as-printed").equations == "as-printed"


def test_table_1_without_motors():
    problem = table1("trailer")
    assert problem.bogie.K_m is None
    assert list(problem.design.variables) == ["C_s"]


def test_table_1_refuses_other_kinds():
    text = error(table1, "frieght", equations="asprinted")
    assert "frieght is not one of: power, trailer" in text
    assert "did you mean as-printed?" in text


def test_default_bounds():
    bounds = {key: (v.min, v.max) for key, v in table1().design.variables.items()}
    assert bounds == {"C_s": (1e4, 1e7), "K_m": (62648.0, 6264800.0), "C_m": (1995.0, 199500.0)}


def test_a_speed_range_hits_its_ends_and_is_exact():
    problem = table1().replace(speed=SpeedRange(min="200 km/h", max="300 km/h", steps=4))
    assert len(problem.speeds) == 4
    assert [exact(v) for v in problem.speeds] == [Fraction(kmh) * 5 / 18 for kmh in (200, "700/3", "800/3", 300)]
    assert problem.speeds[0] == 200 / 3.6
    assert problem.speeds[-1] == 300 / 3.6
    assert all(type(v) is Written for v in problem.speeds)
    assert len(SpeedRange(min=50, max=80).values) == 11


@pytest.mark.parametrize(
    ("arguments", "fragment"),
    [
        ({"min": 50, "max": 50}, "empty range"),
        ({"min": "300 km/h", "max": "200 km/h"}, "speed.max: 200 km/h is less than min, which is 300 km/h"),
        ({"min": 0, "max": 50}, "speed.min: 0 is outside"),
        ({"min": 40, "max": 50, "steps": 1}, "speed.steps: 1 is not a whole number from 2 to 1001"),
        ({"min": 40, "max": 50, "steps": 2.5}, "not a whole number"),
        ({"min": 40, "max": 50, "steps": True}, "not a number"),
    ],
)
def test_wrong_speed_ranges(arguments, fragment):
    assert fragment in error(SpeedRange, **arguments)


def test_wrong_curves_list_all_mistakes():
    text = error(Curve, R="300 kg", L=0, l=math.inf, V_r="90 km/h", load="axel")
    for fragment in ("curve.R: 300 kg is a mass", "curve.L: 0 is outside", "curve.l: inf is not", "did you mean axle?"):
        assert fragment in text


def test_design_variables_are_converted_by_their_name():
    design = Design(variables={"lambda_": Variable(min=0.1, max="40 %"), "K_ds": Variable(min="1 MN/m", max="2 MN/m")})
    assert design.variables["lambda"].max == 0.4
    assert design.variables["K_ds"].min == 1e6


@pytest.mark.parametrize(
    ("key", "bounds", "fragment"),
    [
        ("C_s", ("1 kg", "2 kN s/m"), "design.variables.C_s.min: 1 kg is a mass"),
        ("C_s", (2, 1), "C_s.max: 1 is less than min"),
        ("C_s", (2, 2), "empty range"),
        ("C_q", (1, 2), "design.variables.C_q: is not known here; did you mean C_"),
        ("K_ds", (0, 2), "K_ds.min: 0 is outside"),
    ],
)
def test_wrong_design_variables(key, bounds, fragment):
    assert fragment in error(Design, variables={key: Variable(min=bounds[0], max=bounds[1])})


def test_design_variables_must_be_variables():
    assert "is not a Variable" in error(Design, variables={"C_s": (1, 2)})
    assert "did you mean decay_rate?" in error(Design, objective="decayrate")


def test_motor_variables_need_motors():
    design = Design(variables={"K_m": Variable(min=1, max=2)})
    assert "K_m: belongs to the motors" in error(Problem, bogie=table1("trailer").bogie, speed=80, design=design)


def test_a_wrong_problem_lists_all_mistakes():
    text = error(Problem, bogie=3, speed="3 kg", curve={}, design=None, equations="printed", title=4)
    for name in ("title", "equations", "bogie", "speed", "curve", "design"):
        assert f"error: {name}: " in text


@pytest.mark.parametrize(
    "char", ["\0", "\t", "\n", "\r", "\x1b", "\x7f", "\x85", "\u2028", "\ud800", "\ufffe", "\ufdd0"]
)
def test_titles_have_one_line_and_no_control_characters(char):
    text = error(table1().replace, title=f"a{char}b")
    assert "title: holds" in text
    assert f"U+{ord(char):04X}" in text


def test_replace_changes_the_problem_or_the_bogie():
    problem = table1().replace(C_s="2 MN s/m", lambda_=0.3, speed="250 km/h", curve=None, title="new")
    assert (problem.bogie.C_s, problem.bogie.lambda_, problem.title) == (2e6, 0.3, "new")
    assert problem.curve is None
    assert problem.replace(**{"lambda": 0.2}).bogie.lambda_ == 0.2
    assert problem.replace(C_s=None).bogie.C_s is None
    assert problem.replace(bogie=table1().bogie, C_s=5e5).bogie.C_s == 5e5


@pytest.mark.parametrize(
    ("changes", "fragment"),
    [
        ({"K1x": 1}, "K1x: is not known here; did you mean K_1x?"),
        ({"v": 1}, "did you mean speed?"),
        ({"conicity": 1}, "did you mean lambda?"),
        ({"C_s": "1 kg"}, "bogie.C_s: 1 kg is a mass"),
        ({"zzzz": 1}, "zzzz: is not known here"),
    ],
)
def test_replace_refuses_what_it_does_not_know(changes, fragment):
    assert fragment in error(table1().replace, **changes)


def test_replace_in_a_trailer_refuses_motors():
    assert "belongs to the motors" in error(table1("trailer").replace, K_m=1)


def test_to_dict_is_plain_json():
    data = table1().replace(speed=SpeedRange(min=50, max=80)).to_dict()
    assert json.loads(json.dumps(data)) == data
    assert data["speed"] == {"min": 50.0, "max": 80.0, "steps": 11}
    assert data["bogie"]["lambda"] == 0.15
    assert data["design"]["variables"]["C_s"] == {"min": 1e4, "max": 1e7}
    assert type(data["bogie"]["M_b"]) is float
    assert table1("trailer").replace(curve=None).to_dict()["curve"] is None


def test_problems_are_frozen_hashable_and_travel():
    problem = table1()
    assert pickle.loads(pickle.dumps(problem)) == problem
    assert hash(pickle.loads(pickle.dumps(problem))) == hash(problem)
    with pytest.raises(dataclasses.FrozenInstanceError):
        problem.speed = 3
    with pytest.raises(TypeError):
        problem.design.variables["C_s"] = None


def test_curve_limit_and_load_have_the_papers_defaults():
    assert (Curve(**CURVE).limit, Curve(**CURVE).load) == (0.08, "axle")

"""Axes: how they are written, what they do to the parameters, and every way to get them wrong."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.problem.condition import Condition
from yawdesign.study.axes import ROWS, applied, block, damping_ratio, read_axis, read_values
from yawdesign.study.request import request


def asked(of="critical", hold=None, problem=None, **axes):
    return request(problem or yd.table1(), of, axes.items(), hold)


def mistakes(**arguments):
    """Return what is wrong with a request, by key."""
    with pytest.raises(yd.ProblemError) as caught:
        asked(**arguments)
    return {d.key: d.message for d in caught.value.diagnostics}


def test_a_range_in_units():
    assert read_values("150 km/h:450 km/h:4", ROWS["v"]) * 3.6 == pytest.approx([150, 250, 350, 450], rel=1e-14)
    assert read_values("0.5:8:3", ROWS["f_m"]) == pytest.approx([0.5, 4.25, 8], rel=1e-14)
    assert read_values("10 kN s/m : 1 MN s/m : 3 : log", ROWS["C_s"]) == pytest.approx([1e4, 1e5, 1e6], rel=1e-14)


@given(st.floats(1.0, 1e6), st.floats(1.01, 100.0), st.integers(2, 50), st.booleans())
def test_a_range_has_its_ends_and_its_number(low, ratio, n, log):
    x = read_values(f"{low!r}:{low * ratio!r}:{n}{':log' * log}", ROWS["C_s"])
    assert (x[0], x[-1], x.size) == (low, low * ratio, n)
    steps = np.diff(np.log(x) if log else x)
    assert steps == pytest.approx(steps.mean(), rel=1e-6)


@pytest.mark.parametrize(
    "values", [80.0, 80, "288 km/h", [80.0], ["288 km/h"], "80 m/s:80 m/s:1", np.float64(80), np.array(80)]
)
def test_one_value(values):
    assert read_axis("v", values).values.tolist() == [80.0]


def test_values_in_any_container():
    expected = [1e5, 1e6]
    for values in (
        [1e5, 1e6],
        (100_000, 1_000_000),
        np.array(expected),
        ["100 kN s/m", "1 MN s/m"],
        ["100 kN s/m", 1e6],
    ):
        assert read_axis("C_s", values).values.tolist() == expected
    assert read_axis("lambda", [0.1, 0.2]).unit == "-"
    assert [read_axis(name, [1, 2]).unit for name in ("v", "f_m", "K_m")] == ["m/s", "Hz", "N/m"]


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ([], "has no values"),
        ("", "no range"),
        ("300 km/h:", "no range"),
        ("300 kmh", "km/h"),
        ("1:2:3:linear", "no range"),
        ("80:80:3", "empty range"),
        ("100:80:3", "less than min"),
        ("1:2:0", "whole number from 1"),
        ("1:2:1", "one value cannot be both 1 and 2: write 1"),
        ("1:2:2.5", "whole number"),
        ("1:2:1e12", "whole number"),
        ("1 kg:2 m/s:3", "mass"),
        ([80, 70], "252 km/h comes after 288 km/h"),
        ([70, 70], "must rise"),
        ([70, math.nan], "not a finite number"),
        ([70, math.inf], "not a finite number"),
        ([70, -1.0], "outside"),
        ("0.001:80:3", "outside"),
        ("80:1e9:3", "outside"),
        ([70, None], "no value|has no value"),
        ([True, False], "not a number"),
        ([[70, 80], [90, 100]], "dimensions"),
        ([[70, 80], [90]], "list of lists"),
        ({70: 80}, "not a number"),
        (None, "has no value"),
        (math.nan, "outside|finite"),
    ],
)
def test_wrong_values(values, text):
    with pytest.raises(yd.ProblemError, match=text):
        read_values(values, ROWS["v"])


def test_a_logarithmic_range_begins_above_zero():
    with pytest.raises(yd.ProblemError, match="not above zero"):
        read_values("0:1e6:5:log", ROWS["C_s"])


def test_points_are_counted_with_the_last_axis_fastest():
    axes = asked(v=[70, 80], lambda_=[0.1, 0.2, 0.3]).axes
    point = block(axes, 1, 5)
    assert point["v"].tolist() == [70, 70, 80, 80]
    assert point["lambda"].tolist() == [0.2, 0.3, 0.1, 0.2]


def test_motor_frequency_and_damping_ratio_of_equation_12():
    p = {name: float(x) for name, x in yd.table1().bogie.parameters().items()}
    both = applied(p, {"f_m": 3.0, "xi_m": 0.3})
    # The paper computes with pi = 3.14.
    assert both["K_m"] * (3.14 / math.pi) ** 2 == pytest.approx(626_478.98, abs=0.01)
    assert both["C_m"] * 3.14 / math.pi == pytest.approx(19_951.56, abs=0.01)
    held = applied(p, {"f_m": 6.0}, "xi_m")
    assert damping_ratio(held) == pytest.approx(damping_ratio(p), rel=1e-14)
    assert applied(p, {"f_m": 6.0})["C_m"] == p["C_m"]
    only = applied(p, {"xi_m": 0.6})
    assert (only["K_m"], damping_ratio(only)) == (p["K_m"], pytest.approx(0.6, rel=1e-14))


def test_the_damping_ratio_is_held_also_when_mass_or_stiffness_change():
    p = {name: float(x) for name, x in yd.table1().bogie.parameters().items()}
    for point in ({"M_m": 3000.0}, {"K_m": 1e6}, {"M_m": 3000.0, "f_m": 5.0}):
        assert damping_ratio(applied(p, point, "xi_m")) == pytest.approx(damping_ratio(p), rel=1e-14)
    moved = applied(p, {"M_m": 3000.0, "f_m": 5.0})
    assert math.sqrt(moved["K_m"] / 3000.0) == pytest.approx(10 * math.pi, rel=1e-14)


def test_the_creep_factor_multiplies_both():
    p = {"f_11": 2e6, "f_22": 3e6}
    assert applied(p, {"creep_factor": 0.5}) == {"f_11": 1e6, "f_22": 1.5e6}


def test_names():
    assert "did you mean f_m?" in mistakes(fm=[1, 2])["fm"]
    assert "did you mean lambda?" in mistakes(conicity=[0.1, 0.2])["conicity"]
    assert "did you mean v?" in mistakes(speed=[70, 80])["speed"]
    assert "did you mean critical?" in mistakes(of="critcal", v=[70, 80])["of"]
    trailer = yd.table1(kind="trailer")
    found = mistakes(problem=trailer, f_m=[1, 2], C_m=[1, 2], v=[70, 80])
    assert {key: "trailer bogie has none" in text for key, text in found.items()} == {"f_m": True, "C_m": True}
    assert asked(problem=trailer, v=[70, 80]).size == 2


def test_all_mistakes_at_once():
    found = mistakes(of="all", v=[], f_m="3:2:9", fm=[1, 2], K_m=[-1, 2], hold="K_m")
    assert set(found) == {"of", "axes", "v", "f_m.max", "fm", "K_m", "f_m", "hold"}


def test_number_of_axes():
    assert "none" in mistakes()["axes"]
    assert "at most 3" in mistakes(a=[1, 2], b=[0.7, 0.8], b_1=[1, 2], b_2=[1, 2])["axes"]
    with pytest.raises(yd.ProblemError, match="v: is given twice"):
        request(yd.table1(), "critical", [("v", "70 m/s:80 m/s:3"), ("v", "70 m/s:80 m/s:4")], None)
    with pytest.raises(yd.ProblemError, match="lambda: is given twice"):
        asked(**{"lambda": [0.1, 0.2], "lambda_": [0.1, 0.2]})


@pytest.mark.parametrize(
    ("axes", "hold", "key"),
    [
        ({"f_m": [1, 2], "K_m": [1e5, 1e6]}, None, "f_m"),
        ({"xi_m": [0.1, 0.2], "C_m": [1e4, 2e4]}, None, "xi_m"),
        ({"creep_factor": [0.5, 1], "f_22": [1e6, 2e6]}, None, "creep_factor"),
        ({"f_m": [1, 2], "C_m": [1e4, 2e4]}, "xi_m", "hold"),
        ({"f_m": [1, 2], "xi_m": [0.1, 0.2]}, "xi_m", "hold"),
        ({"f_m": [1, 2], "xi_m": [0.1, 0.2]}, "C_m", "hold"),
        ({"C_s": [1e5, 1e6]}, None, "C_s"),
    ],
)
def test_contradictions(axes, hold, key):
    assert key in mistakes(hold=hold, **axes)


def test_what_a_question_needs():
    without = yd.table1().replace(C_s=None)
    for of in ("stable", "decay_rate", "damping_ratio", "margin", "critical_speed"):
        axes = {"lambda_": [0.1, 0.2]}
        assert "is missing" in mistakes(of=of, problem=without, **axes)["C_s"]
        assert asked(of=of, problem=without, C_s=[1e5, 1e6], **axes).size == 4
    for of in ("critical", "C_sl", "design"):
        assert "no axis" in mistakes(of=of, C_s=[1e5, 1e6])["C_s"]
    assert "no axis" in mistakes(of="critical_speed", v=[70, 80])["v"]
    between = yd.table1().replace(speed=yd.SpeedRange(min=60, max=90))
    assert "differ in v" in mistakes(problem=between, lambda_=[0.1, 0.2])["speed"]
    assert asked(problem=between, v=[70, 80]).size == 2


def conditions(**arguments):
    """Return the conditions of a question as mappings."""
    return [dict(x.changes) for x in asked(**arguments).task.question.conditions]


def test_an_axis_replaces_the_condition_of_its_name():
    between = yd.table1().replace(speed=yd.SpeedRange(min=60, max=90))
    assert conditions(of="C_sl", problem=between, lambda_=[0.1, 0.2]) == [{"v": v} for v in between.speeds]
    assert conditions(of="C_sl", problem=between, v=[70, 80]) == [{}]
    assert conditions(of="critical_speed", problem=between, lambda_=[0.1, 0.2]) == [{}]
    question = asked(of="stable", problem=between, C_s=[1e5, 1e6]).about("critical_speed", ()).task.question
    assert question.conditions == (Condition(()),)


def test_the_other_conditions_stay():
    several = yd.table1().replace(speed=["70 m/s", "80 m/s"], conditions={"lambda": [0.1, 0.2]})
    assert conditions(of="C_sl", problem=several, v=[70, 80]) == [{"lambda": 0.1}, {"lambda": 0.2}]
    assert conditions(of="C_sl", problem=several, lambda_=[0.3, 0.4]) == [{"v": 70.0}, {"v": 80.0}]
    assert len(conditions(of="C_sl", problem=several, f_m=[1, 2])) == 4


def test_an_axis_replaces_all_that_is_said_of_what_it_sets():
    load = {"tare": {"W": 1e5, "M_b": 5e3}}
    several = {"K_m": [6e5, 7e5], "f_11": [1e6, 2e6], "tolerance": {"K_m": 0.1}, "load": load}
    problem = yd.table1().replace(
        design=yd.Design(variables={"C_s": yd.Variable(min=1e4, max=1e7)}), conditions=several
    )
    found = asked(of="C_sl", problem=problem, f_m=[1, 2]).task.question.conditions
    assert {name for x in found for name in x.described} == {"speed", "f_11", "load"}
    found = asked(of="C_sl", problem=problem, creep_factor=[0.5, 1], M_b=[5e3, 6e3]).task.question.conditions
    assert {name for x in found for name in x.described} == {"speed", "K_m", "tolerance.K_m", "load"}
    assert {x.load.changes for x in found} == {(("W", 1e5),)}


def test_ranges_are_looked_at_at_some_values():
    ranges = {"lambda": {"min": 0.1, "max": 0.3}, "tolerance": {"K_m": 0.1, "C_m": 0.1, "C_t": 0.1}}
    one = conditions(of="C_sl", problem=yd.table1().replace(conditions={"lambda": ranges["lambda"]}), f_m=[1, 2])
    assert [x["lambda"] for x in one] == pytest.approx(np.linspace(0.1, 0.3, 9))
    several = conditions(of="C_sl", problem=yd.table1().replace(conditions=ranges), f_m=[1, 2])
    assert 500 < len(several) <= 1000
    assert {x["tolerance.C_t"] for x in several} >= {-0.1, 0.1}


def test_what_has_values_of_one_condition_is_refused_for_several():
    several = yd.table1().replace(conditions={"lambda": [0.1, 0.2]})
    for of in ("critical", "critical_speed"):
        assert "differ in lambda" in mistakes(of=of, problem=several, f_m=[1, 2])["conditions"]
        assert asked(of=of, problem=several, lambda_=[0.1, 0.2]).size == 2


def test_axes_of_the_curve():
    assert "does not depend" in mistakes(of="stable", R=[200, 300])["R"]
    assert (
        "there is none" in mistakes(of="design", problem=yd.table1().replace(curve=None), limit=[0.05, 0.08])["limit"]
    )
    axis = asked(of="design", V_r=["80 km/h", "90 km/h"]).axes[0]
    assert (axis.unit, axis.values.tolist()) == ("m/s", pytest.approx([80 / 3.6, 25.0]))


def test_the_range_of_critical_speeds():
    question = asked(of="critical_speed", lambda_=[0.1, 0.2]).task.question
    assert question.searched == pytest.approx([10 / 3.6, 600 / 3.6])
    between = yd.table1().replace(speed=yd.SpeedRange(min=60, max=90))
    assert asked(of="critical_speed", problem=between, lambda_=[0.1, 0.2]).task.question.searched == (60, 90)


def test_computed_parameters_stay_in_their_range():
    assert set(mistakes(creep_factor=[1e-6, 1e6], problem=yd.table1().replace(f_11=1e14, f_22=1e3))) == {"f_11", "f_22"}
    assert "K_m" in mistakes(f_m=[1.0, 1e6], M_m=[1.0, 1e17])


def test_a_grid_that_is_too_large_is_refused_with_its_size(monkeypatch):
    found = mistakes(of="stable", C_s="1:1e6:10000", v="1 m/s:100 m/s:10000", lambda_="0:1:1000")
    assert "10000 C_s × 10000 v × 1000 lambda = 1e+11 points" in found[""]
    assert "1.6e+03 GB" in found[""]
    assert "in parts" in found[""]
    monkeypatch.setattr("yawdesign.study.request.memory", lambda: 1000 * 16)
    assert asked(of="stable", C_s="1:1e6:100", v="1 m/s:100 m/s:10").size == 1000
    assert "parts of at most 99 values" in mistakes(of="stable", C_s="1:1e6:101", v="1 m/s:100 m/s:10")[""].replace(
        "100", "99"
    )


def test_margin_is_the_objective_of_the_problem():
    for objective in ("decay_rate", "damping_ratio"):
        problem = yd.table1().replace(design=yd.Design(objective=objective))
        assert asked(of="margin", problem=problem, v=[70, 80]).task.question.of == objective

"""Distributions of parameters in a problem: what they mean, and what is refused with its place."""

import math

import pytest

import yawdesign as yd
from yawdesign.problem.distributions import CUT, as_distributions
from yawdesign.problem.reader import read_text

HEAD = "bogie: {base: table1, C_s: 1 MN s/m}\nspeed: 300 km/h\n"


def problem(**distributions):
    return yd.table1().replace(C_s="1 MN s/m", uncertainty=distributions)


def only(value):
    (one,) = as_distributions(value)
    return one


def test_percentages_are_shares_of_the_value_as_designed():
    assert only({"K_m": {"uniform": ["90 %", "120 %"]}}).ends(600.0) == pytest.approx((540, 720))
    assert only({"lambda": {"uniform": [0.05, 0.4]}}).ends(0.15) == (0.05, 0.4)
    assert only({"K_m": {"uniform": ["600 kN/m", 7e5]}}).ends(1.0) == (6e5, 7e5)


def test_normal_and_lognormal_end_at_five_standard_deviations():
    assert only({"K_m": {"normal": "20 %"}}).ends(100.0) == pytest.approx((0, 200))
    low, high = only({"K_m": {"lognormal": "10 %"}}).ends(100.0)
    s = math.sqrt(math.log(1.01))
    assert (low, high) == pytest.approx([100 * math.exp(-s * s / 2 + sign * CUT * s) for sign in (-1, 1)])


def test_standard_deviations():
    assert only({"K_m": {"uniform": [0, 12]}}).deviation(1.0) == pytest.approx(math.sqrt(12))
    assert only({"K_m": {"lognormal": "10 %"}}).deviation(50.0) == pytest.approx(5)


def test_a_problem_goes_to_plain_data_and_back():
    written = {"lambda": {"uniform": [0.05, 0.4]}, "speed": {"uniform": ["90 %", "110 %"]}, "C_s": {"normal": "5 %"}}
    one = yd.table1().replace(C_s=1e6, uncertainty=written)
    assert one.to_dict()["uncertainty"] == written
    assert one.replace(uncertainty=one.uncertainty) == one
    text = HEAD + "uncertainty:\n  lambda_: {uniform: [0.05, 0.4]}\n  creep_factor: {normal: 10 %}\n"
    assert [each.name for each in yd.loads(text).uncertainty] == ["lambda", "creep_factor"]


WRONG = {
    "lambda: {uniform: [0.40, 0.05]}": "0.05 is less than 0.40",
    "lambda: {uniform: [0.40, 0.4]}": "makes it empty",
    "K_m: {lognormel: 10 %}": "did you mean lognormal?",
    "K_m: {normal: -10 %}": "-10 % is no standard deviation",
    "K_m: {lognormal: 0 %}": "0 % is no standard deviation",
    "K_m: {normal: 30 %}": "would reach below zero, write lognormal",
    "K_m: {lognormal: 150 %}": "more than 100 %",
    "K_m: {normal: 10 kN}": "is a force",
    "K_m: {uniform: [1 kN, 3 MN/m]}": "is a force, expected a stiffness",
    "K_3x: {normal: 3 %}": "is not a parameter; did you mean K_2x?",
    "b: {uniform: [90 %, 1 m]}": "write both alike",
    "b: {uniform: 3}": "is not [low, high]",
    "b: 3 %": "expected a distribution",
    "b: {}": "needs one distribution",
    "b: {normal: 3 %, lognormal: 3 %}": "needs one distribution",
    "W: {uniform: [-200 %, 100 %]}": "reaches -400 000 N, outside",
    "K_2z: {normal: 3 %}": "is not part of this vehicle",
}


@pytest.mark.parametrize("line", WRONG)
def test_mistakes_have_a_place(line):
    _, found = read_text(f"{HEAD}uncertainty:\n  r: {{normal: 1 %}}\n  {line}\n")
    (one,) = [each for each in found if each.severity == "error"]
    assert WRONG[line] in one.message
    assert one.line == 5
    assert one.key.startswith(f"uncertainty.{line.partition(':')[0]}")


def test_all_mistakes_are_told_at_once():
    _, found = read_text(f"{HEAD}uncertainty:\n" + "".join(f"  {line}\n" for line in [*WRONG][2:5:2]) + "speed_: 3\n")
    assert len(found) == 3


def test_what_does_not_fit_together():
    with pytest.raises(yd.ProblemError, match="give one of the two"):
        problem(creep_factor={"normal": "10 %"}, f_11={"normal": "10 %"})
    with pytest.raises(yd.ProblemError, match="multiplies f_22, which stands under conditions"):
        problem(creep_factor={"normal": "10 %"}).replace(conditions={"f_22": [9e6, 1e7]})
    with pytest.raises(yd.ProblemError, match="there are several"):
        problem(speed={"normal": "10 %"}).replace(speed=("200 km/h", "300 km/h"))
    with pytest.raises(yd.ProblemError, match="has no width"):
        problem(**{"lambda": {"normal": "10 %"}}).replace(lambda_=0.0)
    with pytest.raises(yd.ProblemError, match=r"give bogie\.C_s"):
        yd.table1().replace(C_s=None, uncertainty={"C_s": {"normal": "10 %"}})

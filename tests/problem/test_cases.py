"""Faults: as a problem file has them, checked, and applied to numbers."""

import json
import pickle
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yawdesign.problem import CarBody, ProblemError, loads, table1
from yawdesign.problem.cases import ONE_BOGIE, Case, Change, as_cases
from yawdesign.problem.parameters import BOGIE, CAR_BODY, parameter_keys
from yawdesign.problem.reader import read_text

LOST = {"one yaw damper lost": {"C_s": "50 %", "K_ds": "50 %"}}
BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)


def problem(**changes):
    return replace(table1(), car_body=BODY, **changes)


def error(cases, made=problem):
    with pytest.raises(ProblemError) as caught:
        made(cases=cases)
    return str(caught.value)


def test_the_contracts_example():
    one = loads("{bogie: {base: table1}, speed: 80 m/s, cases: {one yaw damper lost: {C_s: 50 %, K_ds: 50 %}}}")
    changes = (Change("C_s", 0.5, share=True), Change("K_ds", 0.5, share=True))
    assert one.cases == (Case("one yaw damper lost", changes),)
    p = one.cases[0].applied(one.parameters())
    assert (p["C_s"], p["K_ds"]) == (0.5e6, 20e6)
    assert table1().cases == ()


def test_values_are_shares_or_absolute():
    changes = {"lambda": "200 %", "C_t": "30 kN s/m", "K_1y": 5e6, "trailing.lambda_": "0.3", "leading.C_t": "0 %"}
    cases = as_cases({"a": {key: changes[key] for key in ("lambda", "C_t", "K_1y")}})
    assert [(c.value, c.share) for c in cases[0].changes] == [(2.0, True), (30e3, False), (5e6, False)]
    (case,) = as_cases({"a": {key: changes[key] for key in ("trailing.lambda_", "leading.C_t")}})
    assert case.applied({"lambda": 0.1, "C_t": 6e4}) == {
        **{"lambda": 0.1, "C_t": 6e4},
        **{"trailing.lambda": 0.3, "leading.C_t": 0.0},
    }


def test_cases_go_to_plain_data_and_back():
    one = problem(cases={"a. b": {"leading.C_s": "33.3 %", "K_2z": "0.3 MN/m", "trailing.lambda": "0.1"}})
    data = one.to_dict()["cases"]
    assert data == {"a. b": {"leading.C_s": "33.3 %", "K_2z": 3e5, "trailing.lambda": 0.1}}
    assert json.loads(json.dumps(data)) == data
    assert problem(cases=data) == one
    assert pickle.loads(pickle.dumps(one)) == one
    assert hash(one) == hash(problem(cases=one.cases))
    assert one.replace(cases=()).cases == ()


@given(st.fractions(min_value=0, max_value=10, max_denominator=10**6))
def test_shares_keep_what_was_written(share):
    case = Case("a", (Change("lambda", float(share), share=True),))
    written = case.changes[0].written
    assert as_cases({"a": {"lambda": written}})[0].changes[0].value == pytest.approx(float(share), rel=1e-14)


@given(st.sampled_from([*BOGIE, *CAR_BODY, *ONE_BOGIE]), st.integers(1, 99))
def test_every_key_of_the_vehicle_may_change_and_no_other(key, percent):
    name = key.rpartition(".")[2]
    cases = {"a": {key: f"{percent} %"}}
    if name in parameter_keys("power") or name in CAR_BODY:
        (change,) = problem(cases=cases).cases[0].changes
        assert (change.key, change.parameter, change.value) == (key, name, percent / 100)
        assert change.result(200.0) == pytest.approx(2 * percent)
    else:
        assert f"cases.a.{key}: is not part of this vehicle" in error(cases)


@pytest.mark.parametrize(
    ("cases", "fragment"),
    [
        (
            {"a": {"K_ds": "0 %"}},
            "cases.a.K_ds: 0 % of the value as designed is 0 MN/m, outside 1e-06 ... 1e+12 MN/m; a d",
        ),
        ({"a": {"leading.K_dt": "0 %"}}, "leading.K_dt: 0 % of the value as designed is 0 MN/m, outside"),
        ({"a": {"lambda": "10000 %"}}, "cases.a.lambda: 10 000 % of the value as designed is 15, outside 0 ... 10"),
        ({"a": {"K_ds": "0 MN/m"}}, "cases.a.K_ds: 0 MN/m is outside"),
        ({"a": {"C_s": "-5 %"}}, "cases.a.C_s: -5 % is no share of the value as designed: it is less than nothing"),
        ({"a": {"C_s": "5 kg"}}, "cases.a.C_s: 5 kg is a mass"),
        ({"a": {"K_ds": "rigid"}}, "cases.a.K_ds: 'rigid' is not a number"),
        ({"a": {"K_dsx": "5 %"}}, "cases.a.K_dsx: is not a parameter; did you mean K_ds?"),
        ({"a": {"leading.Cs": "5 %"}}, "cases.a.leading.Cs: is not a parameter; did you mean leading.C_s?"),
        ({"a": {"front.C_s": "5 %"}}, "such as {leading.C_s: 50 %}"),
        ({"a": {"other.C_s": "5 %"}}, "cases.a.other.C_s: is not a parameter"),
        ({"a": {"leading.M_c": "5 %"}}, "belongs to the car body, of which there is one: write M_c"),
        ({"a": {"leading.C_s": "5 %", "C_s": "7 %"}}, "leading.C_s: stands beside C_s, which means both bogies"),
        ({"a": {"C_1x": "5 %"}}, "cases.a.C_1x: is not part of this vehicle: give its value under bogie first"),
        ({"a": {}}, "cases.a: names no change"),
        ({"a": "lost"}, "cases.a: names no change"),
        ({" ": {"C_s": "5 %"}}, "a fault needs a name"),
        ({"a\nb": {"C_s": "5 %"}}, "holds a line end"),
        ({3: {"C_s": "5 %"}}, "cases.3: 3 is not a text"),
        ("lost", "cases: lost is not what stands here, expected faults by name, such as one yaw damper lost"),
        (None, "cases: has no value"),
        ((Case("a", (Change("C_s", 1.0),)),) * 2, "cases: a stands twice"),
        ((Case("a", (Change("C_s", -1.0),)),), "cases.a.C_s: -1.0 is outside"),
    ],
)
def test_wrong_cases(cases, fragment):
    assert fragment in error(cases)


def test_faults_of_one_bogie_need_a_car_body():
    text = error({"a": {"leading.C_s": "50 %"}}, table1().replace)
    assert "there is one bogie where the car body stands still: give a car_body, or write C_s" in text
    assert "belongs to the motors" in error({"a": {"K_m": "50 %"}}, table1("trailer").replace)


def test_a_damper_is_removed_by_its_damping_and_a_rigid_joint_has_no_share():
    assert problem(cases={"a": {"C_s": "0 %", "C_t": 0}}).cases[0].changes[0].value == 0
    rigid = problem().replace(K_ds="rigid")
    assert "cases.a.K_ds: is rigid here" in error({"a": {"K_ds": "50 %"}}, rigid.replace)


def test_the_damping_as_designed_need_not_be_known():
    assert table1().replace(C_s=None, cases=LOST).cases == as_cases(LOST)


def test_mistakes_in_a_file_have_their_places():
    text = (
        "bogie: {base: table1}\nspeed: 80 m/s\ncases:\n  no. 1: {C_s: 50 kg}\n  no. 2: {leading.C_t: 0 %, K_ds: 0 %}\n"
    )
    found = [(d.line, d.column, d.key) for d in read_text(text)[1]]
    assert found == [(4, 16, "cases.no. 1.C_s"), (5, 11, "cases.no. 2.leading.C_t"), (5, 35, "cases.no. 2.K_ds")]

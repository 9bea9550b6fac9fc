"""The table of parameters and the bogie made from it."""

import dataclasses
import pickle
from fractions import Fraction

import numpy as np
import pytest

from yawdesign.problem import PARAMETERS, Bogie, CarBody, ProblemError, exact, parse_quantity, table1
from yawdesign.problem.parameters import ADDED, BOGIE, CAR_BODY, MOTOR_KEYS, parameter_keys
from yawdesign.problem.table import field_name
from yawdesign.problem.units import parse_unit

# Table I of the paper, typed in once more: the tests must not read what they check.
TABLE_I = """M_b kg 7186; J_b kg·m² 9751; M_w kg 3085; J_w kg·m² 2024; M_m kg 1765; J_m kg·m² 1019; W N 200000;
K_1x MN/m 40; K_1y MN/m 6; K_2x MN/m 0.8; K_2y MN/m 0.8; K_m kN/m 626.48; K_mphi kN·m/rad 361.69; K_ds MN/m 40;
K_dt MN/m 40; K_dm MN/m 40; C_t kN·s/m 60; C_s kN·s/m 1000; C_mphi kN·s·m/rad 11.52; C_m kN·s/m 19.95; a m 1.25;
b m 0.7465; a_0 m 0.75; b_0 m 0.3; b_1 m 1.1; b_2 m 1.1; b_3 m 1.2; r m 0.625; lambda - 0.15; f_11 kN 11511;
f_22 kN 11511"""
ROWS = [tuple(row.split()) for row in TABLE_I.split(";")]


def values(**changes):
    power = table1().bogie
    return {f.name: getattr(power, f.name) for f in dataclasses.fields(Bogie)} | changes


def messages(**changes):
    with pytest.raises(ProblemError) as caught:
        Bogie(**values(**changes))
    return [diagnostic.render() for diagnostic in caught.value.diagnostics]


def test_the_table_has_the_order_the_units_and_the_values_of_table_1():
    assert [(key, BOGIE[key].unit) for key in parameter_keys("power")] == [(key, unit) for key, unit, _ in ROWS]
    for key, unit, value in ROWS:
        assert PARAMETERS[key].source.replace(" ", "") == value
        assert exact(table1().bogie.parameters()[key]) == Fraction(value) * parse_unit(unit).factor


def test_fields_are_the_rows_and_lambda_gets_an_underscore():
    names = [f.name for f in dataclasses.fields(Bogie)]
    assert names == ["kind", *(field_name(key) for key in BOGIE), "gravitational_stiffness"]
    assert [f.name for f in dataclasses.fields(CarBody)] == [*CAR_BODY, "overturning"]
    assert "lambda_" in names


def test_the_motors_rows():
    assert set(MOTOR_KEYS) == {"M_m", "J_m", "K_m", "K_mphi", "K_dm", "C_mphi", "C_m", "a_0"}
    assert not set(MOTOR_KEYS) & set(parameter_keys("trailer"))


ALL_ROWS = pytest.mark.parametrize("row", [*BOGIE.values(), *CAR_BODY.values()], ids=lambda row: row.meaning)


@ALL_ROWS
def test_every_row_is_consistent(row):
    low, high = row.hard
    assert low <= row.usual[0] < row.usual[1] <= high
    assert row.doubt(row.example) is None
    assert row.check(low) == low
    assert row.check(high) == high
    assert row.meaning
    assert row.symbol
    assert parse_unit(row.si).factor == 1
    assert parse_unit(row.si).dimension == parse_unit(row.unit).dimension


@ALL_ROWS
def test_values_outside_the_hard_range_are_refused(row):
    low, high = row.hard
    for value in (low - max(1e-9, abs(low) * 0.01), high * 1.01):
        with pytest.raises(ProblemError, match="is outside"):
            row.check(value)


def test_unusual_values_are_doubted_in_the_unit_that_was_written():
    assert PARAMETERS["M_b"].doubt("7.186 kg") == (
        "7.186 kg is unusual, 1 000 ... 20 000 kg is common: are value and unit right?"
    )
    assert "MN/m" in PARAMETERS["K_1x"].doubt("0.04 MN/m")


def test_texts_and_numbers_make_the_same_bogie():
    texts = {field_name(key): f"{value} {unit}" for key, unit, value in ROWS}
    assert Bogie(**texts) == table1().bogie
    assert Bogie(**values(M_b=7186)).M_b == 7186.0
    assert Bogie(**values(M_b=np.float32(7186))).M_b == 7186.0
    assert exact(Bogie(**values(M_b=np.int64(7186))).M_b) == 7186


def test_parameters_leave_out_what_is_not_there():
    trailer = table1("trailer").bogie
    assert list(trailer.parameters()) == list(parameter_keys("trailer"))
    assert "C_s" not in Bogie(**values(C_s=None)).parameters()
    assert "kind" not in table1().bogie.parameters()


def test_all_mistakes_are_listed():
    found = messages(M_b="7 186 m", K_ds="-40 MN/m", lambda_=float("nan"), W=True, r="long", J_b=[1])
    assert found == [
        "error: bogie.M_b: 7 186 m is a length, expected a mass such as kg",
        "error: bogie.J_b: [1] is not a number: several that are met stand under conditions, bounds of a choice under "
        "design.variables",
        "error: bogie.W: true is not a number, expected a force in N",
        "error: bogie.K_ds: -40 MN/m is outside 1e-06 ... 1e+12 MN/m",
        "error: bogie.r: 'long' is not a number with a unit, such as 626.48 kN/m",
        "error: bogie.lambda: nan is not a finite number",
    ]


def test_motors_belong_to_power_bogies_only():
    assert messages(kind="trailer")[0].startswith("error: bogie.M_m: belongs to the motors")
    assert len(messages(kind="trailer")) == len(MOTOR_KEYS)
    assert messages(K_m=None) == ["error: bogie.K_m: is missing: a power bogie needs it"]
    assert messages(kind="pwoer") == ["error: bogie.kind: pwoer is not one of: power, trailer; did you mean power?"]
    assert "has no value" in messages(M_b=None)[0]


def test_bogies_are_frozen_equal_by_value_and_travel():
    bogie = table1().bogie
    with pytest.raises(dataclasses.FrozenInstanceError):
        bogie.M_b = 1.0
    again = pickle.loads(pickle.dumps(bogie))
    assert again == bogie
    assert hash(again) == hash(bogie)
    assert exact(again.K_m) == Fraction(626480)


def test_the_docstring_is_made_from_the_table():
    assert "lambda_ : float\n        equivalent conicity of the wheelsets [-]." in Bogie.__doc__


def test_quantities_in_the_preset_are_written_with_the_units_of_table_1():
    for key, value in table1().bogie.parameters().items():
        assert parse_quantity(BOGIE[key].example, BOGIE[key].unit) == value


# What Table I does not have, and the car body, typed in once more: Huo and Dai, and the heights.
ROLL = {"I_b": 3e3, "K_1z": 1.2e6, "C_1z": 10e3, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.1}
CAR = {"M_c": 34500, "J_c": 1.521e6, "I_c": 124304, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97, "K_2z": 610e3, "C_2z": 9800}


def test_the_car_bodys_rows_have_its_values_as_examples():
    assert {key: row.check(row.example) for key, row in CAR_BODY.items()} == CAR
    assert CarBody(**CAR).parameters() == CAR
    assert CarBody(**CAR | {"l_c": None}).l_c is None


def test_wrong_car_bodies_list_all_mistakes():
    with pytest.raises(ProblemError) as caught:
        CarBody(**CAR | {"J_c": -1, "I_c": "3 kg", "h_s": 852, "M_c": None, "overturning": "no"})
    assert [d.render() for d in caught.value.diagnostics] == [
        "error: car_body.M_c: has no value, expected a number in kg or a text with a unit",
        "error: car_body.J_c: -1 is outside 0.001 ... 1e+18 kg·m²",
        "error: car_body.I_c: 3 kg is a mass, expected a moment of inertia such as t·m²",
        "error: car_body.h_s: 852 is outside -10 ... 10 m",
        "error: car_body.overturning: no is neither true nor false",
    ]


def test_optional_keys_may_be_left_out_alone_or_only_together():
    assert set(ADDED) == {"J_wy", "C_1x", "C_1y", "K_d1x", "K_d1y", *ROLL, "K_2z", "C_2z"}
    assert Bogie(**values(J_wy=180)).parameters()["J_wy"] == 180
    assert Bogie(**values(**ROLL)).I_b == 3000
    assert messages(K_d1y=1e7) == ["error: bogie.K_d1y: needs the damper: C_1y is missing"]
    assert messages(h_1=0.1) == ["error: bogie.h_1: belongs to roll: I_b is missing"]
    assert [text.partition(":")[2] for text in messages(I_b=3e3)] == [
        f" bogie.{key}: is missing: roll of the frame (I_b) needs it" for key in ROLL if key != "I_b"
    ]


@pytest.mark.parametrize("key", [key for key, row in BOGIE.items() if row.rigid])
def test_a_joint_may_be_rigid_and_has_then_no_number(key):
    damper = {"K_d1x": {"C_1x": 2e4}, "K_d1y": {"C_1y": 2e4}}.get(key, {})
    bogie = Bogie(**values(**damper, **{key: "rigid"}))
    assert getattr(bogie, key) == float("inf")
    assert key not in bogie.parameters()
    assert BOGIE[key].doubt("rigid") is None


def test_only_joints_are_rigid():
    assert {key for key, row in BOGIE.items() if row.rigid} == {"K_ds", "K_dt", "K_dm", "K_d1x", "K_d1y"}
    assert "is not a number" in messages(K_1x="rigid")[0]
    with pytest.raises(ProblemError, match="is not a number"):
        BOGIE["K_ds"].finite.check("rigid")

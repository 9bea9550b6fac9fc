"""The table of parameters and the bogie made from it."""

import dataclasses
import pickle
from fractions import Fraction

import numpy as np
import pytest

from yawdesign.problem import PARAMETERS, Bogie, ProblemError, exact, parse_quantity, table1
from yawdesign.problem.parameters import MOTOR_KEYS, parameter_keys
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
    assert [(row.key, row.unit) for row in PARAMETERS.values()] == [(key, unit) for key, unit, _ in ROWS]
    for key, unit, value in ROWS:
        assert PARAMETERS[key].source.replace(" ", "") == value
        assert exact(table1().bogie.parameters()[key]) == Fraction(value) * parse_unit(unit).factor


def test_fields_are_the_rows_and_lambda_gets_an_underscore():
    names = [f.name for f in dataclasses.fields(Bogie)]
    assert names == ["kind", *(field_name(key) for key in PARAMETERS)]
    assert "lambda_" in names


def test_the_motors_rows():
    assert set(MOTOR_KEYS) == {"M_m", "J_m", "K_m", "K_mphi", "K_dm", "C_mphi", "C_m", "a_0"}
    assert not set(MOTOR_KEYS) & set(parameter_keys("trailer"))


@pytest.mark.parametrize("row", PARAMETERS.values(), ids=lambda row: row.key)
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


@pytest.mark.parametrize("row", PARAMETERS.values(), ids=lambda row: row.key)
def test_values_outside_the_hard_range_are_refused(row):
    low, high = row.hard
    for value in (-1e-9 if low == 0 else low * 0.99, high * 1.01):
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
        "error: bogie.J_b: [1] is not a number, expected a moment of inertia in kg·m²",
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
    for row in PARAMETERS.values():
        assert parse_quantity(row.example, row.unit) == table1().bogie.parameters()[row.key]

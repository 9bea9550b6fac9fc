"""Units, numbers and quantities against values worked out by hand."""

import contextlib
import copy
import math
import pickle
import time
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.problem import ProblemError, Written, exact, format_quantity, parse_quantity, to_unit
from yawdesign.problem.table import as_quantity
from yawdesign.problem.units import parse_unit, si_unit

F = Fraction


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("626.48 kN/m", F(626480)),
        ("300 km/h", F(250, 3)),
        ("1 046 770 N s/m", F(1046770)),
        ("1_046_770 N*s/m", F(1046770)),
        ("1\u2009046\u202f770\u00a0N·s/m", F(1046770)),
        ("40 MN/m", F(40_000_000)),
        ("40MN/m", F(40_000_000)),
        ("361.69 kN·m/rad", F(361690)),
        ("11.52 kN*s*m/rad", F(11520)),
        ("7 186 kg", F(7186)),
        ("7.186 t", F(7186)),
        ("0.746 5 m", F(7465, 10000)),
        ("746.5 mm", F(7465, 10000)),
        ("9 751 kg·m²", F(9751)),
        ("9 751 kg m^2", F(9751)),
        ("9 751 kg*m**2", F(9751)),
        ("0.5 1/s", F(1, 2)),
        ("0.125 1/s", F(1, 8)),
        ("2 s⁻¹", F(2)),
        ("2 s^-1", F(2)),
        ("3 N/(m/s)", F(3)),
        ("3 kN/(m/s)", F(3000)),
        ("6 kg m/s/s", F(6)),
        ("3 Hz", F(3)),
        ("1e6 N/m", F(10**6)),
        ("1.5e-3 m", F(3, 2000)),
        ("-40 MN/m", F(-40_000_000)),
        ("\u221240 MN/m", F(-40_000_000)),
        ("+.5 m", F(1, 2)),
        ("8 %", F(2, 25)),
        ("0.15 -", F(3, 20)),
        ("0.15", F(3, 20)),
        ("60 mph", F(44704 * 60, 100000)),
        ("2 mrad", F(1, 500)),
        ("5 µm", F(5, 10**6)),
        ("5 \u03bcm", F(5, 10**6)),
        ("3 min", F(180)),
        ("2 h", F(7200)),
        ("2 kJ", F(2000)),
        ("2 kPa m", F(2000)),
        ("2 kN.s/m", F(2000)),
        ("1.5 kN s/m", F(1500)),
        ("1.5 kN.s/m", F(1500)),
        ("5.kN", F(5000)),
        ("9.751 t.m2", F(9751)),
        ("9 751 kg.m2", F(9751)),
        ("3 kg m2/s2", F(3)),
        ("3 m2.kg", F(3)),
        ("3 s-1", F(3)),
        ("3 kN.(s/m)", F(3000)),
        ("6×10⁶ N/m", F(6_000_000)),
        ("6 × 10^6 N/m", F(6_000_000)),
        ("6·10**6 N/m", F(6_000_000)),
        ("6*10^+6 N/m", F(6_000_000)),
        ("6.5x10⁻³ m", F(65, 10000)),
        ("6×10⁻³ m", F(6, 1000)),
        ("6×10^\u22123 m", F(6, 1000)),
        ("1.5×10⁻¹", F(3, 20)),
        ("2 kgf/mm", F("19613.3")),
        ("2 lbf/in", 2 * F("4.4482216152605") / F("0.0254")),
        ("2 lb", F("0.90718474")),
        ("3 ft", F("0.9144")),
    ],
)
def test_texts_become_exact_si_numbers(text, value):
    written = parse_quantity(text)
    assert written.exact == value
    assert written == float(value)


def test_degrees_are_the_double_of_pi():
    assert parse_quantity("180°") == math.pi
    assert parse_quantity("180 deg") == math.pi


@pytest.mark.parametrize(
    ("text", "fragment"),
    [
        ("626,48 kN/m", "comma"),
        ("1,000 kg", "comma"),
        ("heavy", "not a number"),
        ("", "not a number"),
        ("kN", "not a number"),
        ("30 0 km/h", "grouped in threes"),
        ("1 04 770 kg", "grouped in threes"),
        ("1.2.3 m", "grouped in threes"),
        ("1 000 0 kg", "grouped in threes"),
        ("3 kNn", "did you mean kN"),
        ("3 KN", "did you mean kN"),
        ("300 kmh", "did you mean km/h"),
        ("3 furlong", "not a known unit"),
        ("3 N/m s", "two ways"),
        ("3 N/(m", "closing bracket"),
        ("3 N)", "bracket too many"),
        ("3 m^", "power"),
        ("3 m^99", "power"),
        ("3 m^2^3", "not a known unit"),
        ("3 /s", "not a known unit"),
        ("3 N//m", "not a known unit"),
        ("3 N#m", "not part of a unit"),
        ("1e999999999 N", "too large"),
        ("1e-999999999 N", "too small"),
        ("1e400 N", "too large"),
        ("1e308 GN", "too large"),
        ("1e-330 kg", "too small"),
        ("9" * 10_000 + " kg", "too long"),
        ("1" + "(" * 10_000, "too long"),
        ("1 " + "(" * 150, "more than 9 brackets"),
        ("3 " + "(" * 10 + "km" + "^9)" * 10, "more than 9 brackets"),
        ("3 " + "(" * 9 + "km^9" + ")^9" * 9, "too large or too small"),
        ("3 " + "(" * 9 + "mm^-9" + ")^9" * 9, "too large or too small"),
        ("3 " + "(" * 9 + "%^9" + ")^9" * 9, "too large or too small"),
        ("3 " + "(" * 9 + "m^9" + ")^9" * 9, "too large or too small"),
        ("3 " + "(" * 9 + "rad^9" + ")^9" * 9, "too large or too small"),
        ("3 " + "km^9 " * 36, "too large or too small"),
        ("3 kNs/m", "did you mean kN s?"),
        ("3 kgm2", "did you mean kg m?"),
        ("3 Nmm", "did you mean N mm?"),
        ("3 kgg", "did you mean kg?"),
        ("3 kp/mm", "did you mean kgf?"),
        ("3 .kN", "not one number"),
        ("3 kN. s", "not part of a unit"),
        ("3 kN.", "not part of a unit"),
        ("3 kN..s", "not part of a unit"),
        ("3 N/m.s", "two ways"),
        ("3 m.2", "not part of a unit"),
        ("10^6 N/m", "a power of ten is written 1e6 or 1×10^6"),
        ("10⁶ N/m", "a power of ten is written 1e6 or 1×10^6"),
        ("6×10 N/m", "not a known unit"),
        ("6×10⁹⁹⁹⁹⁹⁹⁹ N/m", "too large"),
        ("6×10^-999999 N/m", "too small"),
        ("6e6×10^6 N/m", "not a known unit"),
        ("1'000 kg", "group digits with blanks"),
    ],
)
def test_wrong_texts_are_quick_errors(text, fragment):
    start = time.perf_counter()
    with pytest.raises(ProblemError, match="error: ") as caught:
        parse_quantity(text)
    assert fragment in str(caught.value)
    assert len(str(caught.value)) < 300
    assert time.perf_counter() - start < 0.5


def test_a_wrong_dimension_says_what_it_is_and_what_is_expected():
    with pytest.raises(ProblemError, match="300 km/h is a speed, expected a stiffness such as MN/m"):
        parse_quantity("300 km/h", "MN/m")
    with pytest.raises(ProblemError, match="5 kg is a mass, expected a plain number"):
        parse_quantity("5 kg", "-")
    with pytest.raises(ProblemError, match="measured in"):
        parse_quantity("5 kg m^3", "kg")


@pytest.mark.parametrize(
    "text", ["km^9 " * 100, "(" * 10 + "km^9" + ")^9" * 10, "x" * 10_000, "m" * 90, "((km^9)^9)^9", "m^" + "9" * 10_000]
)
def test_units_without_bounds_are_quick_errors(text):
    start = time.perf_counter()
    with pytest.raises(ProblemError) as caught:
        parse_unit(text)
    assert len(str(caught.value)) < 300
    assert time.perf_counter() - start < 0.5


HUGE = {"int": 10**400, "longer": 10**5000, "near 1": F(10**5000 + 1, 10**5000), "tiny": F(1, 10**5000)}


@pytest.mark.parametrize("value", HUGE.values(), ids=HUGE)
def test_numbers_without_bounds_are_quick_errors(value):
    start = time.perf_counter()
    with pytest.raises(ProblemError) as caught:
        as_quantity(value, "kg")
    assert len(str(caught.value)) < 300
    assert time.perf_counter() - start < 0.5


def test_units_count_their_radians():
    units = {"m": 0, "rad": 1, "rad/m": 1, "m^2/(rad/m)": -1, "mrad^2/(rad/m)": 1, "deg/m": 1, "1/m": 0, "m^3": 0}
    assert {unit: parse_unit(unit).angle for unit in units} == units


def test_radians_do_not_count_as_a_dimension():
    assert parse_quantity("361.69 kN m", "kN·m/rad") == 361690
    assert parse_quantity("0.15 rad", "-") == 0.15


def test_a_number_without_a_unit_is_si():
    assert parse_quantity("40", "MN/m") == 40


def test_a_unit_of_one_is_not_taken_for_a_digit_group():
    assert parse_quantity("0.125 1/s").exact == F(1, 8)
    assert parse_quantity("100 1/s").exact == 100


def test_written_numbers_remember_their_decimal():
    number = Written("626.48")
    assert isinstance(number, float)
    assert repr(number) == "626.48"
    assert number == 626.48
    assert hash(number) == hash(626.48)
    for other in (pickle.loads(pickle.dumps(number)), copy.deepcopy(number), copy.copy(number)):
        assert type(other) is Written
        assert other.exact == F(62648, 100)


def test_exact_takes_the_shortest_decimal_of_a_plain_float():
    assert exact(626.48) == F(62648, 100)
    assert exact(3) == 3
    assert exact(F(1, 3)) == F(1, 3)
    assert exact(Written(F(1, 3))) == F(1, 3)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (626480.0, "kN/m", "626.48 kN/m"),
        (300 / 3.6, "km/h", "300 km/h"),
        (7186.0, "kg", "7 186 kg"),
        (1046770.0, "N·s/m", "1 046 770 N·s/m"),
        (90702.8897786979, "N·s/m", "90 702.9 N·s/m"),
        (0.15, "-", "0.15"),
        (0.15, "", "0.15"),
        (0.08, "%", "8 %"),
        (0.0, "m", "0 m"),
        (-1.25, "m", "-1.25 m"),
        (1e18, "N/m", "1e+18 N/m"),
        (1.0, "MN/m", "1e-06 MN/m"),
        (999999.7, "N", "1 000 000 N"),
        (math.inf, "N", "inf N"),
    ],
)
def test_formatting(value, unit, text):
    assert format_quantity(value, unit) == text


def test_to_unit_divides_exactly():
    assert to_unit(626480.0, "kN/m") == 626.48
    assert to_unit(Written(F(250, 3)), "km/h") == 300.0


def test_si_units_have_names():
    assert si_unit("MN/m") == "N/m"
    assert si_unit("kN·s·m/rad") == "N·s·m/rad"
    assert parse_unit(si_unit("kg m^3")).dimension == (1, 3, 0)


@given(st.floats(min_value=1e-3, max_value=1e8), st.sampled_from(["kN/m", "MN·s/m", "km/h", "-", "kg·m²"]))
@settings(deadline=None)
def test_formatting_and_parsing_are_inverse_to_the_digits_shown(value, unit):
    again = parse_quantity(format_quantity(value, unit, digits=12), unit)
    assert again == pytest.approx(value, rel=1e-11)


@given(st.text(max_size=60))
@settings(deadline=None)
def test_any_text_is_a_number_or_an_error(text):
    with contextlib.suppress(ProblemError):
        assert math.isfinite(parse_quantity(text))

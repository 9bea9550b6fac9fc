"""Creep coefficients from the axle load, against published tables."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yawdesign.problem import ProblemError, creep_coefficients, loads, table1
from yawdesign.problem.creep import contact_ellipse
from yawdesign.problem.reader import read_text

# Hertz's table of the semi-axes, as in Timoshenko and Goodier, Theory of Elasticity, section 145: angle, m, n.
HERTZ = [(30, 2.731, 0.493), (45, 1.926, 0.604), (60, 1.486, 0.717), (75, 1.202, 0.846), (90, 1.0, 1.0)]
# Kalker's coefficients, a Poisson's ratio of 1/4: a/b, C_11, C_22.
KALKER = [
    (0.2, 3.37, 2.63),
    (0.5, 3.62, 3.01),
    (0.7, 3.81, 3.28),
    (1.0, 4.12, 3.67),
    (2.0, 5.10, 4.90),
    (5, 7.78, 8.14),
]


@pytest.mark.parametrize(("angle", "m", "n"), HERTZ)
def test_the_ellipse_is_that_of_hertz(angle, m, n):
    """a = m c, b = n c, c^3 = 3 N (1 - nu^2) / (2 E (A + B)), cos(angle) = (B - A) / (A + B)."""
    A, B = (1 - math.cos(math.radians(angle))) / 2, (1 + math.cos(math.radians(angle))) / 2
    N, E, nu = 1e5, 210e9, 0.3
    c = math.cbrt(3 * N * (1 - nu**2) / (2 * E * (A + B)))
    along = contact_ellipse(N, 1 / (2 * A), 1 / (2 * B), E / (2 + 2 * nu), nu)
    assert along == pytest.approx((m * c, n * c), rel=2e-3)
    assert contact_ellipse(N, 1 / (2 * B), 1 / (2 * A), E / (2 + 2 * nu), nu) == pytest.approx(along[::-1])


def test_equal_radii_make_the_circle_of_two_spheres():
    """a^3 = 3 N R / (4 E*), 1/E* = 2 (1 - nu^2) / E = (1 - nu) / G."""
    a, b = contact_ellipse(8e4, 0.5, 0.5, 80e9, 0.25)
    assert a == pytest.approx(math.cbrt(3 * 8e4 * 0.5 * 0.75 / (4 * 80e9)), rel=1e-12)
    assert b == pytest.approx(a, rel=1e-7)


def radius_of_rail(ratio):
    """Return the radius of the rail under a wheel of 0.5 m with which the ellipse has a given ratio of its axes."""
    low, high = 1e-3, 1e3
    for _ in range(200):
        middle = math.sqrt(low * high)
        a, b = contact_ellipse(1e5, 0.5, middle, 80e9, 0.25)
        low, high = (low, middle) if a / b < ratio else (middle, high)
    return middle


@pytest.mark.parametrize(("ratio", "C_11", "C_22"), KALKER)
def test_the_coefficients_are_those_of_kalker(ratio, C_11, C_22):
    R = radius_of_rail(ratio)
    a, b = contact_ellipse(1e5, 0.5, R, 80e9, 0.25)
    f = creep_coefficients("200 kN", 0.5, rail_radius=R, G="80 GPa", nu=0.25, kalker_factor="50 %")
    assert f["f_22"] == pytest.approx(0.5 * C_11 * 80e9 * a * b, rel=1e-6)
    assert f["f_11"] == pytest.approx(0.5 * C_22 * 80e9 * a * b, rel=1e-6)


@pytest.mark.parametrize(("nu", "C_11", "C_22"), [(0.0, 3.40, 3.40), (0.5, 5.20, 3.98)])
def test_poissons_ratio(nu, C_11, C_22):
    f = creep_coefficients(2e5, 0.5, rail_radius=0.5, nu=nu)
    a, b = contact_ellipse(1e5, 0.5, 0.5, 80.8e9, nu)
    assert f == pytest.approx({"f_11": C_22 * 80.8e9 * a * b, "f_22": C_11 * 80.8e9 * a * b}, rel=1e-6)


@given(st.floats(2e4, 4e5), st.floats(0.3, 0.7), st.floats(0.1, 1.0), st.floats(0.2, 0.35))
def test_they_grow_with_two_thirds_of_the_load_and_the_longitudinal_one_is_larger_for_usual_rails(W, r, R, nu):
    one, eight = (creep_coefficients(times * W, r, rail_radius=R, nu=nu) for times in (1, 8))
    assert eight == pytest.approx({key: 4 * f for key, f in one.items()}, rel=1e-9)
    assert one["f_11"] < 1.15 * one["f_22"]


def test_table_1_has_seven_tenths_of_kalkers_coefficients():
    f = creep_coefficients("200 kN", "0.625 m")
    assert table1().bogie.f_11 / math.sqrt(f["f_11"] * f["f_22"]) == pytest.approx(0.71, abs=0.005)


def test_a_file_may_have_them_from_the_axle_load():
    text = "{bogie: {base: table1, W: 167 kN, creep: {kalker_factor: 0.6, rail_radius: 280 mm}}, speed: 80 m/s}"
    problem, diagnostics = read_text(text)
    assert diagnostics == ()
    f = creep_coefficients(167e3, 0.625, kalker_factor=0.6, rail_radius=0.28)
    assert (problem.bogie.f_11, problem.bogie.f_22) == (f["f_11"], f["f_22"])
    assert problem.replace(**f) == problem
    assert (
        loads("{bogie: {base: table1, creep: {}}, speed: 80 m/s}").bogie.f_22 == creep_coefficients(2e5, 0.625)["f_22"]
    )


@pytest.mark.parametrize(
    ("bogie", "fragment"),
    [
        ("creep: {}, f_11: 3 MN", "bogie.f_11: follows from creep: remove one of the two"),
        ("creep: {nu: 0.6}", "bogie.creep.nu: 0.6 is outside 0 ... 0.5"),
        ("creep: {factor: 1}", "bogie.creep.factor: is not a known key; did you mean kalker_factor?"),
        ("creep: 0.6", "bogie.creep: is not what stands here, expected keys and values: kalker_factor, rail_radius"),
        ("creep: {rail_radius: 300}", "bogie.creep: the contact ellipse"),
        ("creep: {rail_radius: 3 m}", "bogie.creep.rail_radius: 3 m is unusual"),
        ("creep: {}, W: 0", "bogie.creep: W is too small for a contact"),
    ],
)
def test_mistakes_and_doubts(bogie, fragment):
    _, diagnostics = read_text(f"{{bogie: {{base: table1, {bogie}}}, speed: 80 m/s}}", "problem.yaml")
    assert fragment in "\n".join(d.render() for d in diagnostics)


def test_wrong_arguments_are_named_all_at_once():
    with pytest.raises(ProblemError) as caught:
        creep_coefficients("2 t", -1, nu="1 m", G=0)
    assert [d.key for d in caught.value.diagnostics] == ["W", "r", "G", "nu"]

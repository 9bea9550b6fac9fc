"""Exact answers: eq. (11) with all its digits, and what it does and does not say."""

import builtins
import math
from fractions import Fraction

import flint
import pytest

from yawdesign.hunting import certificate
from yawdesign.hunting.boundary import hurwitz_minors, parameter_names
from yawdesign.hunting.certificate import (
    certify,
    critical_values,
    hurwitz_polynomial,
    positive_roots,
    unstable_roots,
)
from yawdesign.problem import ProblemError, Written
from yawdesign.vehicle.motions import COUPLED, Motion
from yawdesign.vehicle.polynomials import product
from yawdesign.vehicle.vehicle import Model, Vehicle

PRINTED, RECIPROCAL, TRAILER = Model(equations="as-printed"), Model(), Model("trailer")


@pytest.fixture
def bogie(table1):
    return {**table1, "v": Fraction(250, 3)}


def test_reference_bogies(case, vehicle_of_case):
    found = certify(vehicle_of_case(case, exact=True))
    assert [x.C_s for x in found.critical] == pytest.approx(case["critical_C_s"], rel=1e-12)
    assert [x.omega for x in found.critical] == pytest.approx(case["crossing_omega"], rel=1e-12)
    assert list(found.unstable_roots) == case["unstable_roots_per_interval"]


def test_degree_of_equation_11(bogie, vehicle_model):
    coefficients = hurwitz_polynomial(vehicle_model.at(bogie))
    assert len(coefficients) - 1 == (49 if vehicle_model.kind == "power" else 29)
    assert coefficients[0] != 0
    assert all(isinstance(x, Fraction) for x in coefficients)


def test_equation_11_is_the_minor(bogie, vehicle_model):
    C_s = Fraction(123_456, 7)
    written = {**bogie, "v": "250/3", "C_s": "123456/7"}
    exactly = {n: flint.fmpq(*Fraction(str(x)).as_integer_ratio()) for n, x in written.items()}
    chi = vehicle_model.at(exactly).paper_coefficients()
    n = len(chi) - 1
    rows = [[chi[2 * k - i] if 0 <= 2 * k - i <= n else 0 for k in range(1, n + 1)] for i in range(1, n + 1)]
    value = Fraction(0)
    for coefficient in hurwitz_polynomial(vehicle_model.at(bogie)):
        value = value * C_s + coefficient
    before = flint.fmpq_mat([row[:-1] for row in rows[:-1]]).det()
    assert flint.fmpq(value.numerator, value.denominator) == before
    # Delta_26 = chi_26 Delta_25, and chi_26 holds no C_s: setting either to zero is the same equation.
    assert flint.fmpq_mat(rows).det() == chi[-1] * before


@pytest.mark.parametrize("name", ["fm3.28_Cm_fixed", "xi0.07", "Kds_1e12", "rand01_2-0"])
def test_equation_11_contains_the_critical_values(vehicle_named, name):
    vehicle = vehicle_named(name)
    roots = positive_roots(hurwitz_polynomial(vehicle))
    for x in critical_values(vehicle):
        assert any(math.isclose(x.C_s, root, rel_tol=1e-13) for root in roots)


def test_a_smallest_root_that_is_no_boundary(vehicle_named):
    # At f_m = 3.4 Hz the bogie is stable below the smallest positive root of (11): there stability is lost.
    vehicle = vehicle_named("fm3.4_Cm_fixed")
    assert positive_roots(hurwitz_polynomial(vehicle)) == pytest.approx([68401.0250268635, 504467.103663713])
    assert certify(vehicle).unstable_roots == (0, 2, 0)


@pytest.mark.parametrize(
    ("hertz", "values"),
    [(1, [365e3]), (2, [281e3]), (2.5, [202e3]), (3, [90e3]), (4, [674e3]), (5, [705e3]), (8, [677e3]), (10, [667e3])],
)
def test_figure_3_over_the_motor_frequency(bogie, hertz, values):
    vehicle = PRINTED.at(bogie, K_m=bogie["M_m"] * (2 * math.pi * hertz) ** 2)
    assert [x.C_s for x in critical_values(vehicle)] == pytest.approx(values, rel=0.01)
    if hertz in (2.5, 8):
        assert positive_roots(hurwitz_polynomial(vehicle)) == pytest.approx(values, rel=0.01)


def test_spurious_roots_of_equation_11():
    # (s - 1)(s + 1)(s + 2): a pair s, -s off the imaginary axis makes the minor zero, and no critical value is near.
    p = product([(-1, 1), (1, 1), (2, 1)])
    assert flint.fmpq_mat(certificate._hurwitz_matrix(p[::-1])).det() == 0


def test_counts_without_critical_values(bogie):
    found = certify(PRINTED.at(bogie, v=Fraction(625, 9)))
    assert found.critical == ()
    assert found.unstable_roots == (0,)


@pytest.mark.parametrize(("C_s", "expected"), [(1, 2), (90_702, 2), (90_703, 0), (10**9, 0)])
def test_unstable_roots(bogie, C_s, expected):
    assert unstable_roots(PRINTED.at(bogie), C_s) == expected


def test_unstable_roots_are_those_of_the_roots(random_vehicles, rational_vehicle, exact_roots):
    for vehicle in random_vehicles(30, spread=10, seed=31):
        coupled = rational_vehicle(vehicle).coupled.polynomial(flint.fmpq(100_000))
        exactly = vehicle.model.at({name: Fraction(value) for name, value in vehicle.p.items()})
        assert unstable_roots(exactly, 100_000) == sum(exact_roots(coupled).real > 0)


def test_positive_roots():
    # (x - 1)^2 (x - 3) (x + 2) (x^2 + 1): each once, real and positive only, in order
    assert positive_roots(product([(1, -2, 1), (-3, 1), (2, 1), (1, 0, 1)])[::-1]) == (1.0, 3.0)
    assert positive_roots([1, 0, 1]) == ()
    assert positive_roots([1.5, -0.3, 0]) == (0.2,)
    assert positive_roots([1, -(2 + Fraction(1, 10**30)), 1 + Fraction(1, 10**30)]) == (1.0, 1.0)


def test_a_count_at_a_critical_value_is_refused(bogie, monkeypatch):
    # (s^2 + 1)(s + 1) + 0 C_s: roots on the axis for certain
    axis = Motion(COUPLED, frozenset(), ((1, 1, 1, 1), (0, 0, 0, 0)))
    monkeypatch.setattr(Vehicle, "motions", (axis,))
    with pytest.raises(ArithmeticError, match="exactly critical"):
        unstable_roots(RECIPROCAL.at(bogie), 1)


def test_a_number_is_what_was_written(bogie):
    written, exactly, nearly = (TRAILER.at(bogie, v=v) for v in (Written(Fraction(250, 3)), Fraction(250, 3), 250 / 3))
    assert hurwitz_polynomial(written) == hurwitz_polynomial(exactly)
    assert hurwitz_polynomial(nearly) != hurwitz_polynomial(exactly)


def test_the_precision_of_flint_is_left_as_it_was(bogie):
    before = flint.ctx.prec
    critical_values(RECIPROCAL.at(bogie))
    assert flint.ctx.prec == before


def test_without_flint_the_remedy_is_named(bogie, monkeypatch):
    real = builtins.__import__

    def without_flint(name, *arguments, **options):
        if name == "flint":
            raise ImportError(name)
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without_flint)
    with pytest.raises(ImportError, match=r'pip install "yawdesign\[certify\]"'):
        critical_values(RECIPROCAL.at(bogie))


@pytest.mark.parametrize("ask", [hurwitz_polynomial, lambda x: hurwitz_minors(x.model, parameter_names(x.p))])
def test_the_papers_polynomial_is_refused_for_other_vehicles(reference_vehicle, ask):
    with pytest.raises(ProblemError, match="one bogie"):
        ask(reference_vehicle("trailer"))
    with pytest.raises(ProblemError, match="joints"):
        ask(reference_vehicle("trailer", K_ds=math.inf).bogie)

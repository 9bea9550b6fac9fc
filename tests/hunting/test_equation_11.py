"""Eq. (11) in Python's own rational numbers: the polynomial of the determinants, and its positive roots."""

from fractions import Fraction

import pytest

from yawdesign.hunting.certificate import hurwitz_polynomial
from yawdesign.hunting.certificate import positive_roots as certified_roots
from yawdesign.hunting.equation_11 import interpolated, minor_polynomial, positive_roots
from yawdesign.vehicle.polynomials import product
from yawdesign.vehicle.vehicle import Model


@pytest.mark.parametrize(
    ("own", "degree"),
    [(Model("trailer"), 29), pytest.param(Model(equations="as-printed"), 49, marks=pytest.mark.slow)],
)
def test_it_is_the_polynomial_of_the_determinants(table1, own, degree):
    vehicle = own.at({**table1, "v": Fraction(250, 3)})
    found = minor_polynomial(vehicle)
    assert len(found) == degree + 1
    assert found == hurwitz_polynomial(vehicle)[::-1]
    assert positive_roots(found) == pytest.approx(certified_roots(found[::-1]), rel=1e-15)


def test_positive_roots_each_once():
    twice = product([(-2, 1), (-2, 1), (-3, 1), (5, 1), (1, 0, 1), (0, 1)])
    assert positive_roots(twice) == (2.0, 3.0)
    assert positive_roots((1, 0, 1)) == positive_roots((7,)) == positive_roots(()) == ()
    far = product([(-Fraction(1, 10**9), 1), (-(10**9), 1)])
    assert positive_roots(far) == pytest.approx((1e-9, 1e9), rel=1e-15)


def test_interpolation():
    p = (Fraction(3), Fraction(-1), Fraction(0), Fraction(2))
    places = [Fraction(k) for k in range(1, 5)]
    values = [p[0] + p[1] * x + p[3] * x**3 for x in places]
    assert interpolated(places, values) == p

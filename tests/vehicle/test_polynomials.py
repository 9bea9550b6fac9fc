"""Polynomials of any number type, and determinants of sparse matrices of them."""

from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.vehicle import polynomials as poly
from yawdesign.vehicle.determinant import Determinant

rationals = st.fractions(-100, 100, max_denominator=50)
polynomials = st.lists(rationals, max_size=6).map(tuple)


@pytest.mark.slow
@given(polynomials, polynomials, polynomials, rationals)
def test_ring(p, q, r, s):
    def value(x):
        return poly.evaluate(x, s)

    assert value(poly.add(p, q)) == value(p) + value(q)
    assert value(poly.multiply(p, q)) == value(p) * value(q)
    assert value(poly.product([p, q, r])) == value(p) * value(q) * value(r)
    assert value(poly.scale(p, s)) == s * value(p)


@given(polynomials, rationals, rationals)
def test_change_of_variable(p, unit, s):
    assert poly.evaluate(poly.scale_variable(p, unit), s) == poly.evaluate(p, unit * s)
    assert poly.evaluate(poly.shift(p, unit), s) == poly.evaluate(p, unit + s)


@given(polynomials)
def test_trim_keeps_the_polynomial(p):
    trimmed = poly.trim(p)
    assert not trimmed or trimmed[-1] != 0
    assert p == trimmed + (0,) * (len(p) - len(trimmed))


def test_empty_polynomial_is_zero():
    assert poly.multiply(poly.ZERO, (1, 2)) == poly.ZERO
    assert poly.evaluate(poly.ZERO, 3) == 0
    assert poly.product([]) == poly.ONE


class Counted:
    """A number that counts what is done to it."""

    operations = 0

    def __mul__(self, other):
        Counted.operations += 1
        return self

    __rmul__ = __add__ = __radd__ = __mul__


def test_structural_zeros_and_ones_cost_nothing():
    x = Counted()
    before = Counted.operations
    assert poly.plus(0, x) is x
    assert poly.plus(x, 0) is x
    assert poly.times(1, x) is x
    assert poly.times(x, 1) is x
    assert poly.times(x, 0) == 0
    assert poly.multiply((0, 1), (0, x)) == (0, 0, x)
    assert Counted.operations == before


def leibniz(matrix):
    """Return the determinant by its definition."""
    n, total = len(matrix), poly.ZERO
    for order in permutations(range(n)):
        sign = (-1) ** sum(order[i] > order[j] for i in range(n) for j in range(i + 1, n))
        total = poly.add(total, poly.scale(poly.product([matrix[i][order[i]] for i in range(n)]), sign))
    return total


entries = st.one_of(st.just(poly.ZERO), st.lists(rationals, min_size=1, max_size=3).map(tuple))
matrices = st.integers(1, 5).flatmap(
    lambda n: st.lists(st.lists(entries, min_size=n, max_size=n), min_size=n, max_size=n)
)


def same(p, q):
    return poly.trim(p) == poly.trim(q)


def sparse(matrix):
    """Return a matrix as the entries that are there, the diagonal always."""
    n = len(matrix)
    return {(i, j): matrix[i][j] for i in range(n) for j in range(n) if matrix[i][j] or i == j}


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(matrices)
def test_determinant_is_that_of_leibniz(matrix):
    determinant = Determinant(sparse(matrix))
    assert same(determinant.of(determinant.nodes), leibniz(matrix))


@settings(max_examples=60, deadline=None)
@given(matrices)
def test_factors_multiply_to_the_determinant(matrix):
    determinant = Determinant(sparse(matrix))
    pieces = determinant.factors(determinant.nodes)
    assert frozenset().union(*pieces) == determinant.nodes
    assert sum(map(len, pieces)) == len(determinant.nodes)
    assert same(poly.product(determinant.of(piece) for piece in pieces), leibniz(matrix))


def test_rooted_replaces_one_diagonal_entry():
    matrix = {(i, j): (Fraction(1 + 3 * i + j * j),) for i in range(3) for j in range(3)}
    other = {**matrix, (1, 1): (Fraction(7), Fraction(1))}
    determinant = Determinant(matrix)
    found = determinant.rooted(1, determinant.nodes, other[1, 1])
    assert same(found, leibniz([[other[i, j] for j in range(3)] for i in range(3)]))


@pytest.mark.parametrize("number", [2.0, np.array([1.0, 2.0]), 1 + 2j, Fraction(2, 3)])
def test_any_number(number):
    p = poly.multiply((1, number), (number, 1))
    assert np.all(poly.evaluate(p, 2) == (1 + 2 * number) * (number + 2))

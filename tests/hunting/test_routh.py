"""Routh's scheme against roots."""

from fractions import Fraction
from itertools import pairwise
from unittest.mock import patch

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.hunting import routh
from yawdesign.hunting.routh import count_unstable, damped_more, decays_faster, is_stable, routh_column, sector_column
from yawdesign.vehicle.polynomials import multiply, product

real_roots = st.floats(-300, 300).filter(lambda x: abs(x) > 1)
pairs = st.tuples(real_roots, st.floats(1, 300))
root_sets = st.tuples(st.lists(real_roots, max_size=4), st.lists(pairs, max_size=3)).filter(lambda r: r[0] or r[1])


def polynomial(root_set):
    """Return the monic polynomial with these real roots and conjugate pairs."""
    single, conjugate = root_set
    return product([*((-x, 1.0) for x in single), *((x * x + y * y, -2 * x, 1.0) for x, y in conjugate)])


def all_roots(root_set):
    return [complex(x) for x in root_set[0]] + [complex(x, y) for x, y in root_set[1]]


@settings(max_examples=200, deadline=None)
@given(root_sets)
def test_verdict_is_that_of_the_roots(root_set):
    s = np.array(all_roots(root_set))
    assert decays_faster(polynomial(root_set), 0.0) == bool(np.all(s.real < 0))


@settings(max_examples=200, deadline=None)
@given(root_sets, st.floats(-200, 200))
def test_decay_rate(root_set, sigma):
    slowest = -max(s.real for s in all_roots(root_set))
    if abs(slowest - sigma) > 0.1:
        assert decays_faster(polynomial(root_set), sigma) == (slowest > sigma)


@settings(max_examples=200, deadline=None)
@given(root_sets, st.floats(0, 0.95))
def test_damping_ratio(root_set, zeta):
    least = min(-s.real / abs(s) for s in all_roots(root_set))
    if abs(least - zeta) > 1e-3:
        assert damped_more(polynomial(root_set), zeta) == (least > zeta)


def changes(column):
    return sum(a * b < 0 for a, b in pairwise(column))


@settings(max_examples=200, deadline=None)
@given(root_sets)
def test_changes_of_sign_count_the_unstable_roots(root_set):
    column = [float(x) for x in routh_column(polynomial(root_set))]
    if all(np.isfinite(column)) and min(map(abs, column)) > 1e-6 * max(1, *map(abs, column)) ** 0.1:
        unstable = sum(s.real > 0 for s in all_roots(root_set) for _ in range(1 + (s.imag != 0)))
        assert changes(column) == unstable


# (polynomial, highest power first; first column as textbooks print it up to positive factors; unstable roots)
TEXTBOOK = [
    ((1, 2, 3, 4, 5), (1, 2, 1, -6, 5), 2),  # Ogata, Modern Control Engineering, example on Routh's criterion
    ((1, 10, 31, 1030), (1, 10, -72, 1030), 2),  # Nise, Control Systems Engineering, example 6.1
    ((1, 6, 11, 6), (1, 6, 10, 6), 0),
    ((2, 1, 3, 5, 10), (2, 1, -7, 45 / 7, 10), 2),  # Kuo, Automatic Control Systems
]


@pytest.mark.parametrize(("down", "column", "unstable"), TEXTBOOK)
def test_textbook_examples(down, column, unstable):
    found = routh_column(tuple(map(float, down[::-1])))
    assert found == pytest.approx(column, rel=1e-12)
    assert changes(found) == unstable
    assert bool(is_stable(found)) == (unstable == 0)


@pytest.mark.parametrize("number", [float, np.float64, Fraction])
@pytest.mark.parametrize("down", [(1, 1, 1, 1), (1, 1, 1, 1, 1), (1, 0, 1), (1, 0, 2, 1)])
def test_a_zero_in_the_column_is_not_a_verdict(number, down):
    p = tuple(map(number, down[::-1]))
    assert not decays_faster(p, 0)
    with np.errstate(all="ignore"):
        assert not is_stable(routh_column(p))


def test_arrays_are_many_polynomials_at_once():
    damping = np.linspace(-1, 1, 21) + 0.01
    p = multiply((4.0, damping, 1.0), (3.0, 1.0))
    assert np.array_equal(is_stable(routh_column(p)), damping > 0)
    zeta = np.broadcast_to(damping / 4, (3, 21))
    assert np.array_equal(damped_more(tuple(np.broadcast_to(a, (3, 21)) for a in p), 0.1), zeta > 0.1)
    assert np.array_equal(decays_faster(p, np.full(21, 0.2)), damping / 2 > 0.2)


def test_graph_equals_numbers():
    p = (6.0, 11.0, 7.0, 3.0, 1.0)
    x = ca.SX.sym("x", len(p))
    for chain in (routh_column, lambda q: sector_column(q, 0.3)):
        graph = ca.Function("f", [x], [ca.vertcat(*chain(tuple(x[k] for k in range(len(p)))))])
        assert np.array(graph(p)).ravel() == pytest.approx(chain(p), rel=1e-14)


def test_sector_of_no_damping_is_the_half_plane():
    p = (6.0, 11.0, 7.0, 3.0, 1.0)
    assert is_stable(sector_column(p, 0.0)) == is_stable(routh_column(p))


# (polynomial, highest power first; roots not in the left half-plane), each with a row of zeros
ZERO_ROWS = [
    ((1, 2, 24, 48, -25, -50), 3),  # Ogata, section 5.6: 1, -1, 5j, -5j, -2
    ((1, 7, 6, 42, 8, 56), 4),  # Nise, example 6.4: the factor s^4 + 6 s^2 + 8
    ((1, 1, 12, 22, 39, 59, 48, 38, 20), 6),  # Nise, example 6.5: the factor s^4 + 3 s^2 + 2, and two more on the right
    ((1, 0, 4), 2),
    ((1, 0, -4), 1),
    ((1, 0, 6, 0, 25), 2),  # 1 + 2j, 1 - 2j and their mirror images
    ((1, 3, 4, 12, 0), 3),
    ((1, 0), 1),
    ((1, 0, 0), 2),
]


@pytest.mark.parametrize(("down", "unstable"), ZERO_ROWS)
def test_counts_after_a_row_of_zeros(down, unstable):
    assert count_unstable(tuple(map(float, down[::-1]))) == unstable


small = st.integers(1, 9)
axis_pairs = st.lists(small, max_size=2).map(lambda sizes: [(w * w, 0, 1) for w in sizes])
mirrored = st.lists(small, max_size=2).map(lambda sizes: [(-a * a, 0, 1) for a in sizes])
mirrored_pairs = st.lists(st.tuples(small, small), max_size=1).map(
    lambda pairs: [f for a, b in pairs for f in ((a * a + b * b, -2 * a, 1), (a * a + b * b, 2 * a, 1))]
)
at_zero = st.integers(0, 2).map(lambda n: [(0, 1)] * n)
stable_ones = st.lists(st.tuples(small, st.integers(0, 9)), max_size=3).map(
    lambda found: [(a * a + b * b, 2 * a, 1) if b else (a, 1) for a, b in found]
)
unstable_ones = st.lists(st.tuples(small, st.integers(0, 9)), max_size=2).map(
    lambda found: [(a * a + b * b, -2 * a, 1) if b else (-a, 1) for a, b in found]
)


def exactly_counted(p):
    """Return what is counted in exact rationals: in a unit of time of 1 no number is rounded."""
    with patch.object(routh, "TIME_UNIT", 1):
        return count_unstable(tuple(map(Fraction, p)))


def roots_on_the_right(*factors):
    return sum((len(f) - 1) * (f[-2] < 0) for f in factors)


@settings(max_examples=400, deadline=None)
@given(axis_pairs, mirrored, mirrored_pairs, at_zero, stable_ones, unstable_ones)
def test_counts_of_products_of_known_factors(axis, real, pairs, zero, left, right):
    undamped = 2 * len(axis) + len(zero)
    beyond = len(real) + roots_on_the_right(*pairs, *right)
    p = product([*axis, *real, *pairs, *zero, *left, *right])
    # The scheme may break down, and says so; in exact numbers it is never wrong.
    assert exactly_counted(p) in (-1, beyond + undamped)
    # A row that is zero but for rounding is not taken for zero: then roots on the axis may fall to either side.
    found = count_unstable(tuple(map(float, p)))
    assert found == -1 or beyond + len(zero) <= found <= beyond + undamped


@settings(max_examples=200, deadline=None)
@given(st.sets(small, max_size=3), at_zero, stable_ones)
def test_different_pairs_on_the_axis_are_all_counted(sizes, zero, left):
    # The array is that of the rest times a factor: every row before the one of zeros has a first entry.
    p = product([*((w * w, 0, 1) for w in sizes), *zero, *left])
    assert exactly_counted(p) == 2 * len(sizes) + len(zero)


@settings(max_examples=200, deadline=None)
@given(mirrored, mirrored_pairs, stable_ones, unstable_ones)
def test_mirrored_roots_off_the_axis_are_counted_in_spite_of_rounding(real, pairs, left, right):
    found = count_unstable(tuple(map(float, product([*real, *pairs, *left, *right]))))
    assert found in (-1, len(real) + roots_on_the_right(*pairs, *right))


@pytest.mark.parametrize(
    "factors",
    [
        [(4, 0, 1), (4, 0, 1), (1, 1)],  # 2j twice: another row of zeros
        [(4, 0, 0, 0, 1)],  # 1 + j and its three images: a first entry that is zero
        [(1, 1, 1, 1, 1)],
    ],
)
def test_where_the_scheme_breaks_down_it_says_so(factors):
    assert count_unstable(tuple(map(float, product(factors)))) == -1

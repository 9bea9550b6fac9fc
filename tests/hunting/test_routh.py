"""Routh's scheme against roots."""

from fractions import Fraction
from itertools import pairwise

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.hunting.routh import damped_more, decays_faster, is_stable, routh_column, sector_column
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

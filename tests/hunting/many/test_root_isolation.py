"""Isolation of all positive roots, against roots that are known."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from yawdesign.hunting.many.root_isolation import BLOCK, CELLS, RANGE, isolate

ROUNDING = 1e-9  # a root on the edge of two intervals may be told to either


def polynomial(real=(), pairs=(), factor=1.0):
    """Return coefficients, lowest power first, from real roots and complex pairs."""
    return np.atleast_1d(np.poly([*real, *pairs, *np.conj(pairs)])).real[::-1] * factor


class Magnitudes:
    """The sizes of polynomials that are given by their coefficients."""

    def __init__(self, F):
        self.F = np.abs(F)

    def at(self, owner, x):
        return np.sum(self.F[:, owner] * x ** np.arange(len(self.F))[:, None], axis=0)

    def table(self, some, x):
        return np.vander(x, len(self.F), increasing=True) @ self.F[:, some]


def intervals(coefficients):
    F = np.asarray(coefficients, dtype=float).reshape(-1, 1)
    found = isolate(F, Magnitudes(F))
    order = np.argsort(found.low)
    return found.low[order], found.high[order], found.undecided


def assert_isolated(roots, coefficients):
    low, high, undecided = intervals(coefficients)
    roots = np.sort(np.asarray(roots))
    assert not undecided.any()
    assert len(low) == len(roots)
    assert np.all((low <= roots * (1 + ROUNDING)) & (roots <= high * (1 + ROUNDING)))
    assert np.all(high[:-1] <= low[1:])


# Logarithms of roots, none of them on the edge of a cell.
EDGES = np.linspace(*np.log10(RANGE), CELLS + 1)
OFF_THE_EDGES = st.floats(-3, 3).filter(lambda x: np.min(np.abs(EDGES - x)) > 1e-6)


@settings(max_examples=100, deadline=None)
@given(
    st.lists(OFF_THE_EDGES, max_size=5, unique_by=lambda x: round(x, 1)),
    st.lists(st.floats(-3, 3), max_size=3),
    st.lists(st.tuples(st.floats(-1, 1), st.floats(0.1, 3)), max_size=2),
    st.sampled_from([1.0, -1e12, 1e-200]),
)
def test_every_positive_root_has_its_interval(positive, negative, pairs, factor):
    assume(positive or negative or pairs)
    positive, negative = [10.0**x for x in positive], [-(10.0**x) for x in negative]
    pairs = [10.0**size * np.exp(1j * angle) for size, angle in pairs]
    assert_isolated(positive, polynomial([*positive, *negative], pairs, factor))


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-4])
def test_close_roots(gap):
    assert_isolated([2.0, 2.0 + gap, 5.0], polynomial([2.0, 2.0 + gap, 5.0, -1.0]))


@pytest.mark.parametrize("height", [1e-1, 1e-3, 1e-4])
def test_a_pair_that_just_misses_the_axis_is_no_root(height):
    assert_isolated([5.0], polynomial([5.0], [2.0 + 1j * height]))


def test_a_root_on_the_edge_of_two_cells_counts_once_or_is_undecided():
    for edge in _edges():
        for F in (polynomial([edge, -3.0, -0.1]), polynomial([edge], [2j, 0.3j + 0.1])):
            low, _, undecided = intervals(F)
            assert undecided.all() or len(low) == 1
            beside = edge * (1 + 1e-6)
        assert_isolated([beside], polynomial([beside, -3.0, -0.1]))


def _edges():
    return np.geomspace(*RANGE, CELLS + 1)[:: CELLS // 8]


@pytest.mark.parametrize("close", [[2.0, 2.0], [2.0, 2.0 + 1e-8], [2.0 + 1e-8j, 2.0 - 1e-8j]])
def test_what_rounding_cannot_tell_from_a_double_root_is_undecided(close):
    _, _, undecided = intervals(polynomial([*close, 5.0]))
    assert undecided.all()


def test_a_polynomial_lost_in_rounding_is_given_up():
    # Eight roots at one place: no sign is certain in a wide range, and the open intervals would double without end.
    _, _, undecided = intervals(polynomial([2.0] * 8))
    assert undecided.all()


def test_roots_far_out_and_far_in():
    assert_isolated([1e-7, 3e8], polynomial([1e-7, 3e8]))


def test_many_polynomials_keep_apart():
    n = BLOCK + 7
    places = np.linspace(0.501, 3.0, n)  # not on the edge of a cell
    F = np.stack([polynomial([x, -1.0]) for x in places], axis=1)
    found = isolate(F, Magnitudes(F))
    order = np.argsort(found.owner)
    assert np.array_equal(found.owner[order], np.arange(n))
    assert np.all((found.low[order] <= places) & (places <= found.high[order]))

"""Hurwitz minors as sign and logarithm against exact determinants."""

import math

import flint
import numpy as np
import pytest

from yawdesign.hunting import boundary as graphs
from yawdesign.hunting.hurwitz import hurwitz_minors
from yawdesign.vehicle.vehicle import Model


def exact_minors(chi):
    """Return sign and log10 of Delta_1 ... Delta_n, each as the determinant that the paper writes down."""
    n = len(chi) - 1
    rows = [[chi[2 * k - i] if 0 <= 2 * k - i <= n else 0 for k in range(1, n + 1)] for i in range(1, n + 1)]
    minors = [flint.fmpq_mat([row[:k] for row in rows[:k]]).det() for k in range(1, n + 1)]
    logarithms = [flint.arb(abs(m)).log() / flint.arb(10).log() for m in minors]
    return [1 if m > 0 else -1 for m in minors], [float(x) for x in logarithms]


@pytest.mark.parametrize("C_s", [3e4, 1e6])
def test_every_minor_of_table_1(table1, vehicle_model, rational_vehicle, C_s):
    vehicle = vehicle_model.at(table1, C_s=C_s)
    signs, logarithms = hurwitz_minors(vehicle.paper_coefficients(unit=100.0))
    expected = exact_minors(rational_vehicle(vehicle).paper_coefficients())
    assert signs == expected[0]
    assert logarithms == pytest.approx(expected[1], abs=1e-10)
    assert all(s > 0 for s in signs) == (C_s == 1e6)


def test_the_minors_the_paper_could_not_form(table1):
    _, logarithms = hurwitz_minors(Model(equations="as-printed").at(table1, C_s=1e6).paper_coefficients(unit=100.0))
    assert len(logarithms) == 26
    assert max(logarithms) > 308  # larger than any double


@pytest.mark.parametrize("unit", [1.0, 30.0, 100.0, 1000.0])
def test_the_unit_of_time_does_not_matter(table1, unit):
    vehicle = Model().at(table1, C_s=1e6)
    one = hurwitz_minors(vehicle.paper_coefficients(unit), unit=unit)
    other = hurwitz_minors(vehicle.paper_coefficients(unit=100.0))
    assert one[0] == other[0]
    assert one[1] == pytest.approx(other[1], abs=1e-5)


def test_the_last_minor_is_the_one_before_times_the_last_coefficient(table1):
    chi = Model().at(table1, C_s=1e6).paper_coefficients()
    _, logarithms = hurwitz_minors(chi, unit=1.0)
    assert logarithms[-1] - logarithms[-2] == pytest.approx(math.log10(chi[-1]), abs=1e-6)


def test_graph_equals_numbers(table1, vehicle_model):
    sign, log10 = graphs.hurwitz_minors(vehicle_model, tuple(table1))(list(table1.values()), 1e6)
    signs, logarithms = hurwitz_minors(vehicle_model.at(table1, C_s=1e6).paper_coefficients(unit=100.0))
    assert np.array(sign).ravel() == pytest.approx(signs)
    assert np.array(log10).ravel() == pytest.approx(logarithms, abs=1e-9)


@pytest.mark.parametrize("number", [float, np.float64])
def test_a_minor_that_is_zero(number):
    signs, logarithms = hurwitz_minors(tuple(map(number, (1, 1, 1, 1, 1))), unit=1.0)
    assert (signs[1], logarithms[1]) == (0.0, -math.inf)
    assert not any(s > 0 for s in signs[1:])  # no verdict on those after it


def test_arrays():
    chi = (np.array([1.0, 1.0]), np.array([6.0, 1.0]), np.array([11.0, 1.0]), np.array([6.0, 3.0]))
    signs, _ = hurwitz_minors(chi, unit=1.0)
    assert [list(s) for s in signs] == [[1, 1], [1, -1], [1, -1]]


def test_positive_coefficients_and_a_positive_last_minor_do_not_suffice():
    # What the paper states after (10): here are four roots on the right, and neither of the two signs sees them.
    roots = np.array([0.08 + 2.32j, 0.07 + 2.84j])
    chi = np.real(np.poly([*roots, *roots.conj(), -2.45, -0.0082]))
    signs, _ = hurwitz_minors(tuple(chi), unit=1.0)
    assert np.all(chi > 0)
    assert signs[-1] > 0
    assert min(signs) < 0

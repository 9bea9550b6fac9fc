"""Eigenvalues against the reference bogies and against exact roots."""

import numpy as np
import pytest

from yawdesign.hunting.eigenvalues import (
    backward_error,
    damping_ratio,
    decay_rate,
    eigenvalues,
    in_order,
    motion_eigenvalues,
    motion_matrix,
    polished,
    roots,
    state_matrix,
)
from yawdesign.vehicle.vehicle import Model

PRINTED = Model(equations="as-printed")


def test_spectral_abscissa_of_the_reference_bogies(case, vehicle_of_case):
    vehicle = vehicle_of_case(case)
    s = eigenvalues(vehicle)
    assert len(s) == vehicle.state_space.size
    assert s[0].real == pytest.approx(case["spectral_abscissa"], abs=1e-8)
    assert decay_rate(s) == -s[0].real


def distances(found, expected):
    """Return how far each of two lists is from its nearest neighbour in the other, relative to its size."""
    apart = np.abs(found[:, None] - expected[None, :])
    return apart.min(axis=1) / (1 + np.abs(found)), apart.min(axis=0) / (1 + np.abs(expected))


def test_the_motions_have_the_eigenvalues_of_the_state_matrix(random_vehicles):
    for drawn in random_vehicles(60, seed=4):
        vehicle = drawn.replace(C_s=2e5)
        whole = np.linalg.eigvals(state_matrix(vehicle))
        coupled, *others = vehicle.motions
        rest = np.concatenate(
            [motion_eigenvalues(vehicle, coupled), *(np.roots(motion.polynomial(2e5)[::-1]) for motion in others)]
        )
        for found in (rest, eigenvalues(vehicle)):
            assert len(found) == len(whole)
            # The double root of the model as printed is known to half the digits only.
            assert max(map(np.max, distances(whole, found))) < 1e-5


def test_the_matrix_of_a_motion_has_the_roots_of_its_polynomial(random_vehicles, rational_vehicle, exact_roots):
    for drawn in random_vehicles(40, seed=6):
        vehicle = drawn.replace(C_s=2e5)
        for motion, exact in zip(vehicle.motions, rational_vehicle(vehicle).motions, strict=True):
            found, expected = motion_eigenvalues(vehicle, motion), exact_roots(exact.polynomial(200_000))
            assert len(found) == len(expected)
            assert max(map(np.max, distances(found, expected))) < 1e-7


def test_eigenvalues_have_small_backward_errors(case, vehicle_of_case):
    vehicle = vehicle_of_case(case)
    for motion in vehicle.motions:
        s = motion_eigenvalues(vehicle, motion)
        assert np.max(backward_error(motion.polynomial(vehicle.C_s), s)) < 1e-11


def test_matrices_of_many_bogies(table1, vehicle_model):
    C_s, v = np.array([1e5, 1e6, 2e6])[:, None], np.array([50.0, 80.0])
    many = vehicle_model.at(table1, v=v, C_s=C_s)
    stack, coupled = state_matrix(many), motion_matrix(many, many.coupled)
    assert stack.shape[:2] == coupled.shape[:2] == (3, 2)
    for i in range(3):
        for j in range(2):
            one = vehicle_model.at(table1, v=v[j], C_s=C_s[i, 0])
            assert np.array_equal(stack[i, j], state_matrix(one))
            assert np.array_equal(coupled[i, j], motion_matrix(one, one.coupled))


def test_order_of_eigenvalues():
    assert list(in_order(np.array([-3.0, -1.0, -2.0]))) == [-1, -2, -3]
    assert list(in_order(np.array([-1 - 2j, -3, -1 + 2j, -1]))) == [-1, -1 + 2j, -1 - 2j, -3]


def test_margins():
    s = np.array([-1 + 1j, -1 - 1j, -5])
    assert decay_rate(s) == 1
    assert damping_ratio(s) == pytest.approx(0.5**0.5)
    assert damping_ratio(np.array([-2.0 + 0j])) == 1
    assert damping_ratio(np.array([2.0 + 0j])) == -1
    assert damping_ratio(np.array([0j, -1])) == 0
    assert decay_rate(np.array([s, s - 1])) == pytest.approx([1, 2])


def test_roots_of_a_polynomial():
    assert sorted(roots((6.0, 11.0, 6.0, 1.0)).real) == pytest.approx([-3, -2, -1])
    assert sorted(roots((6.0, 11.0, 6.0, 1.0, 0.0)).real) == pytest.approx([-3, -2, -1])


def test_backward_error_is_zero_at_a_root_only():
    assert backward_error((-6.0, 1.0), np.array(6.0)) == 0
    assert backward_error((-6.0, 1.0), np.array(6.06)) == pytest.approx(0.06 / 12.06)


def test_polished_eigenvalues_are_roots_and_none_is_lost(table1):
    vehicle = PRINTED.at(table1, C_m=1e-3, C_s=1e6)
    polynomial = vehicle.coupled.polynomial(vehicle.C_s)
    rough = motion_eigenvalues(vehicle, vehicle.coupled)
    fine = polished(polynomial, rough)
    assert backward_error(polynomial, rough).max() > 1e-9
    assert backward_error(polynomial, fine).max() < 1e-14
    assert len(np.unique(fine)) == len(fine)
    scale = np.abs(rough).max()
    assert np.abs(fine - rough).max() < 1e-9 * scale


def test_eigenvalues_that_are_roots_already_stay(table1):
    vehicle = PRINTED.at(table1, C_s=1e6)
    polynomial, s = vehicle.coupled.polynomial(1e6), motion_eigenvalues(vehicle, vehicle.coupled)
    assert polished(polynomial, s) == pytest.approx(s, rel=1e-9)

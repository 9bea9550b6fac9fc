"""Eigenvalues against the reference bogies and against exact roots."""

import flint
import numpy as np
import pytest

from yawdesign.hunting.eigenvalues import backward_error, damping_ratio, decay_rate, eigenvalues, polished, roots
from yawdesign.hunting.old import core_eigenvalues, core_matrix, state_matrix
from yawdesign.vehicle.old import characteristic

PRINTED = {"kind": "power", "equations": "as-printed"}


def test_spectral_abscissa_of_the_reference_bogies(case, of_case):
    p, model = of_case(case)
    s = eigenvalues(state_matrix(p, case["C_s"], **model))
    assert s[0].real == pytest.approx(case["spectral_abscissa"], abs=1e-8)
    assert decay_rate(s) == -s[0].real


def distances(found, expected):
    """Return how far each of two lists is from its nearest neighbour in the other, relative to its size."""
    apart = np.abs(found[:, None] - expected[None, :])
    return apart.min(axis=1) / (1 + np.abs(found)), apart.min(axis=0) / (1 + np.abs(expected))


def test_core_matrix_is_the_state_matrix_without_the_decoupled_motions(random_bogies):
    for p, model in random_bogies(60, seed=4):
        whole = np.linalg.eigvals(state_matrix(p, 2e5, **model))
        core = np.linalg.eigvals(core_matrix(p, 2e5, **model))
        factors = characteristic(p, **model).factors.values()
        rest = np.concatenate([core, *(np.roots(f[::-1]) for f in factors)])
        assert len(rest) == len(whole)
        # The double root of the model as printed is known to half the digits only.
        assert max(map(np.max, distances(whole, rest))) < 1e-5


def test_core_matrix_has_the_roots_of_the_core_polynomial(random_bogies, rational, exact_roots):
    for p, model in random_bogies(40, seed=6):
        found = np.linalg.eigvals(core_matrix(p, 2e5, **model))
        expected = exact_roots(characteristic(rational(p), **model).core(flint.fmpq(200_000)))
        assert len(found) == len(expected)
        assert max(map(np.max, distances(found, expected))) < 1e-7


def test_eigenvalues_have_small_backward_errors(case, of_case):
    p, model = of_case(case)
    s = np.linalg.eigvals(core_matrix(p, case["C_s"], **model))
    assert np.max(backward_error(characteristic(p, **model).core(case["C_s"]), s)) < 1e-11


def test_matrices_of_many_bogies(table1, model):
    C_s, v = np.array([1e5, 1e6, 2e6])[:, None], np.array([50.0, 80.0])
    stack = state_matrix({**table1, "v": v}, C_s, **model)
    assert stack.shape[:2] == (3, 2)
    for i in range(3):
        for j in range(2):
            assert np.array_equal(stack[i, j], state_matrix({**table1, "v": v[j]}, C_s[i, 0], **model))


def test_order_of_eigenvalues():
    s = eigenvalues(np.diag([-3.0, -1.0, -2.0]))
    assert list(s) == [-1, -2, -3]


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
    p = {**table1, "C_m": 1e-3}
    polynomial = characteristic(p, **PRINTED).core(1e6)
    rough = core_eigenvalues(p, 1e6, **PRINTED)
    fine = polished(polynomial, rough)
    assert backward_error(polynomial, rough).max() > 1e-9
    assert backward_error(polynomial, fine).max() < 1e-14
    assert len(np.unique(fine)) == len(fine)
    scale = np.abs(rough).max()
    assert np.abs(fine - rough).max() < 1e-9 * scale


def test_eigenvalues_that_are_roots_already_stay(table1):
    polynomial, s = characteristic(table1, **PRINTED).core(1e6), core_eigenvalues(table1, 1e6, **PRINTED)
    assert polished(polynomial, s) == pytest.approx(s, rel=1e-9)

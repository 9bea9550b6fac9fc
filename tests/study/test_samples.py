"""Samples: moments of the distributions, weights, Student's interval, Sobol indices of functions with known ones."""

import numpy as np
import pytest
from scipy.stats import qmc

from yawdesign.problem.distributions import as_distributions
from yawdesign.study.samples import TOGETHER, Draw, Estimate, Uncertain, sobol_indices

DISTRIBUTIONS = as_distributions(
    {
        "K_m": {"uniform": [2, 6]},
        "C_m": {"normal": "20 %"},
        "C_t": {"lognormal": "50 %"},
        "creep_factor": {"uniform": ["50 %", "100 %"]},
    }
)
UNCERTAIN = Uncertain({"K_m": 3.0, "C_m": 10.0, "C_t": 4.0, "f_11": 100.0, "f_22": 200.0}, DISTRIBUTIONS)


def points(size=2**15, seed=(0,), **more):
    return np.concatenate(list(Draw(4, size, seed, **more).parts()))


def test_moments_of_the_distributions():
    p = UNCERTAIN.at(points())
    assert {name: x.mean() for name, x in p.items()} == pytest.approx(
        {"K_m": 4, "C_m": 10, "C_t": 4, "f_11": 75, "f_22": 150}, rel=1e-3
    )
    deviations = [p[name].std() for name in ("K_m", "C_m", "C_t", "f_22")]
    assert deviations == pytest.approx([4 / 12**0.5, 2, 2, 100 / 12**0.5], rel=3e-3)
    assert (p["f_11"] * 2 == p["f_22"]).all()


def test_samples_stay_between_the_ends_also_where_they_are_widened():
    u = np.array([[2.0**-32] * 4, [1 - 2.0**-32] * 4])
    for widened in (1.0, 1.6):
        p = UNCERTAIN.at(u, widened)
        for one in DISTRIBUTIONS[:3]:
            low, high = one.ends(UNCERTAIN.designed(one))
            assert ((p[one.key] >= low) & (p[one.key] <= high)).all()


def test_weights_make_up_for_widened_distributions():
    u = points(2**16)
    p, w = UNCERTAIN.at(u, 1.6), UNCERTAIN.weights(u, 1.6)
    assert w.mean() == pytest.approx(1, rel=2e-3)
    assert (w * p["C_m"]).mean() == pytest.approx(10, rel=2e-3)
    assert (w * (p["C_m"] > 16)).mean() == pytest.approx(1.3499e-3, rel=2e-2)  # three standard deviations
    assert UNCERTAIN.weights(u[:4], 1.0) == pytest.approx(np.ones(4))


def test_draws_depend_on_their_seed_alone():
    assert (points(64, (3, 1)) == points(64, (3, 1))).all()
    assert not (points(64, (3, 1)) == points(64, (3, 2))).any()
    assert not (points(64) == points(64, independent=True)).any()
    assert qmc.discrepancy(points(256)) < 0.3 * qmc.discrepancy(points(256, independent=True))


def test_large_draws_come_in_parts():
    parts = list(Draw(1, 2 * TOGETHER, (0,)).parts())
    assert [len(u) for u in parts] == [TOGETHER, TOGETHER]
    assert np.sort(np.floor(np.concatenate(parts)[:, 0] * 2 * TOGETHER)).tolist() == list(range(2 * TOGETHER))


def test_the_interval_is_student_s():
    found = Estimate.of([1.0, 2.0, 3.0, 4.0])
    assert (found.value, found.half_width) == pytest.approx((2.5, 3.182446305 * np.sqrt(5 / 3) / 2))


def ishigami(u):
    x = np.pi * (2 * u - 1)
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_sobol_indices_of_a_function_with_known_ones():
    found = [sobol_indices(ishigami, 3, 2**8, (0, k)) for k in range(16)]
    for k, known in enumerate([0.3139, 0.4424, 0.0]):
        one = Estimate.of([x.first[k] for x in found])
        assert abs(one.value - known) < max(1.5 * one.half_width, 0.01) < 0.06
    for k, known in enumerate([0.5576, 0.4424, 0.2437]):
        one = Estimate.of([x.total[k] for x in found])
        assert abs(one.value - known) < max(1.5 * one.half_width, 0.01) < 0.06

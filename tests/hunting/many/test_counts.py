"""Counts and verdicts of the tapes are those of the scalar code, and what they cannot tell they doubt."""

import numpy as np
import pytest

from yawdesign.hunting.many import counts
from yawdesign.hunting.routh import count_unstable
from yawdesign.vehicle.vehicle import Model

PRINTED = Model(equations="as-printed")


def test_counts_are_those_of_the_scalar_code(random_vehicles):
    for vehicle in random_vehicles(60, seed=4):
        count, doubts, _ = counts.unstable_roots(vehicle.model)({**vehicle.p, "C_s": 1e5})
        assert count[0] == count_unstable(vehicle.coupled.polynomial(1e5))
        assert doubts[0] == 0


def test_what_lies_on_the_boundary_is_doubted(table1):
    # s^2 + 1 = 0 twice, and a row that vanishes.
    values = {f"a{k}": float(a) for k, a in enumerate((1, 0, 2, 0, 1))}
    assert counts.counts(5)(values)[1] > 0
    critical = {**table1, "C_s": 90702.8897786979}
    assert counts.verdicts(PRINTED)(critical)[1] == 0
    assert counts.verdicts(PRINTED)({**critical, "C_s": critical["C_s"] * 1.001})[1] == 1


@pytest.mark.parametrize("equations", ["as-printed", "reciprocal"])
@pytest.mark.parametrize("name", ["C_mphi", "K_mphi"])
@pytest.mark.parametrize("tape", [counts.verdicts, counts.others_stable])
def test_undamped_motors_are_surely_not_stable(table1, equations, name, tape):
    p, model = {**table1, "C_s": 1e6}, Model(equations=equations)
    assert tape(model, frozenset({name}))({**p, name: 0.0}).tolist() == [[0], [1]]
    found = tape(model)({**p, name: np.array([0.0, 1e4, 0.0])})
    assert found.tolist() == [[0, 1, 0], [1, 1, 1]]


def test_a_zero_that_lowers_the_degree_is_doubted_where_it_is_not_known_before(table1):
    p = {**table1, "C_s": 1e6, "C_t": 0.0}
    assert counts.verdicts(PRINTED)(p)[1] == 0
    assert counts.verdicts(PRINTED, frozenset({"C_t"}))(p).tolist() == [[1], [1]]


def test_a_trailer_has_no_motion_that_no_yaw_damper_reaches():
    assert counts.others_stable(Model("trailer")) is None


POLYNOMIALS = [
    ([-0.3 + 2j, -0.3 - 2j, -0.1 + 5j, -0.1 - 5j, -3.0], 0.05, [0, 0, 2, 2]),
    ([0.2 + 1j, 0.2 - 1j, -0.5, -0.1 + 5j, -0.1 - 5j], 0.05, [2, 2, 4, 4]),
]


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize(("roots", "step", "expected"), POLYNOMIALS)
def test_roots_right_of_a_line(roots, step, expected, backwards):
    p = np.poly(roots).real[::-1]
    tape = counts.beyond("decay_rate", len(p), backwards)
    levels = np.array([0.0, 0.1 - step, 0.1 + step, 0.2])
    count, doubts, _ = tape({f"a{k}": a for k, a in enumerate(p)} | {"level": levels})
    assert count.tolist() == expected
    assert not doubts.any()


@pytest.mark.parametrize("backwards", [False, True])
def test_roots_beyond_a_ray(backwards):
    ratios, sizes = np.array([0.02, 0.1, 0.3]), np.array([5.0, 0.2, 1.0])
    upper = sizes * (-ratios + 1j * np.sqrt(1 - ratios**2))
    p = np.poly([*upper, *upper.conj(), -0.5]).real[::-1]
    tape = counts.beyond("damping_ratio", len(p), backwards)
    zeta = np.array([0.01, 0.05, 0.2, 0.4])
    count, doubts, _ = tape({f"a{k}": a for k, a in enumerate(p)} | {"cosine": -zeta, "sine": np.sqrt(1 - zeta**2)})
    assert count.tolist() == [0, 1, 2, 3]
    assert not doubts.any()


@pytest.mark.parametrize("backwards", [False, True])
def test_a_line_through_a_root_tells_where(backwards):
    p = np.poly([-0.3 + 2j, -0.3 - 2j, -1 + 5j, -1 - 5j, -3.0]).real[::-1]
    a = {f"a{k}": x for k, x in enumerate(p)}
    crossing = counts.beyond("decay_rate", len(p), backwards)({**a, "level": 0.3 + 1e-9})[2]
    assert crossing == pytest.approx(4.0, rel=1e-6)
    zeta = 0.3 / np.hypot(0.3, 2) + 1e-9
    line = {"cosine": -zeta, "sine": np.sqrt(1 - zeta**2)}
    crossing = counts.beyond("damping_ratio", len(p), backwards)({**a, **line})[2]
    assert crossing == pytest.approx(np.hypot(0.3, 2), rel=1e-6)

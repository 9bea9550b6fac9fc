"""Critical speeds, against the eigenvalue problem that has all of them."""

import numpy as np
import pytest
import scipy.linalg

from yawdesign.hunting.eigenvalues import motion_eigenvalues, motion_matrix
from yawdesign.hunting.many.critical_speeds import critical_speeds
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.vehicle.vehicle import Model

SEARCHED = (10 / 3.6, 600 / 3.6)
PRINTED = Model(equations="as-printed")


def eigenvalues(vehicle, v):
    running = vehicle.replace(v=v)
    return motion_eigenvalues(running, running.coupled)


def all_critical_speeds(vehicle):
    """Return every speed at which the sum of two eigenvalues is zero and they lie on the imaginary axis.

    The state matrix is A0 + A1/v, and its Kronecker sum with itself is singular exactly at such speeds.
    """
    slow, fast = (motion_matrix(x, x.coupled) for x in (vehicle.replace(v=1.0), vehicle.replace(v=2.0)))
    A1 = 2 * (slow - fast)
    A0 = slow - A1
    one = np.eye(len(A0))
    sums = [np.kron(A, one) + np.kron(one, A) for A in (A0, A1)]
    with np.errstate(all="ignore"):
        inverse = scipy.linalg.eigvals(sums[0], -sums[1])
        candidates = 1 / inverse.real[np.isfinite(inverse) & (np.abs(inverse.imag) < 1e-6 * np.abs(inverse))]
    inside = np.sort(candidates[(candidates > SEARCHED[0]) & (candidates < SEARCHED[1])])
    s = [eigenvalues(vehicle, v) for v in inside]
    on_axis = [np.min(np.abs(x.real) / np.maximum(1, np.abs(x))) < 1e-5 for x in s]
    speeds = inside[np.array(on_axis, dtype=bool)]
    return speeds[np.concatenate([[True], np.diff(speeds) > 1e-5 * speeds[1:]])] if len(speeds) else speeds


def found(vehicle, searched=SEARCHED):
    field = critical_speeds(ParameterSets(vehicle.model, vehicle.p, 1), searched)
    assert not field.unverified.any()
    speeds = field.critical[0]
    return speeds[~np.isnan(speeds)], field


def test_trailers_have_all_their_critical_speeds(random_bogies):
    several = 0
    for k, (p, _) in enumerate(random_bogies(12, seed=8, spread=2.0)):
        vehicle = Model("trailer").at(p, C_s=10 ** (4 + k / 4))
        speeds, _ = found(vehicle)
        assert speeds == pytest.approx(all_critical_speeds(vehicle), rel=1e-6)
        several += len(speeds)
    assert several > 5


def test_a_power_bogie(table1):
    vehicle = PRINTED.at(table1, C_s=1e5)
    speeds, field = found(vehicle)
    assert speeds == pytest.approx(all_critical_speeds(vehicle), rel=1e-6)
    assert field.unstable_roots[0].tolist() == [0, 2]


def test_the_critical_speed_at_the_critical_damping_is_the_speed(table1):
    speeds, field = found(PRINTED.at(table1, C_s=90702.8897786979))
    assert speeds == pytest.approx([300 / 3.6], rel=1e-8)
    assert field.omega[0] == pytest.approx([23.15473658], rel=1e-7)


def test_a_range_is_searched(table1):
    sets = ParameterSets(PRINTED, {**table1, "C_s": np.array([1e4, 90702.0])}, 2)
    assert critical_speeds(sets, (200 / 3.6, 290 / 3.6)).count.tolist() == [1, 0]


def test_two_changes_that_undo_each_other(narrow_bogie):
    speeds, field = found(Model().at(narrow_bogie))
    assert speeds[:2] * 3.6 == pytest.approx([219.724254, 221.119203], abs=1e-6)
    assert field.unstable_roots[0][:3].tolist() == [0, 2, 0]


@pytest.mark.parametrize("more", [0.0, 10.0, 20.0, 24.0, 30.0, 100.0])
@pytest.mark.slow
def test_ever_narrower_intervals(narrow_bogie, more):
    # With more damping the unstable interval shrinks; the largest real part between its ends tells whether it is there.
    vehicle = Model().at(narrow_bogie, C_s=narrow_bogie["C_s"] + more)
    v = np.linspace(219, 222, 6001) / 3.6
    unstable = eigenvalues(vehicle, v).real.max(axis=1) > 0
    speeds, _ = found(vehicle)
    within = speeds[(speeds > v[0]) & (speeds < v[-1])]
    if unstable.any():
        expected = [v[unstable][0], v[unstable][-1]]
        assert within == pytest.approx(expected, abs=2e-4)
    else:
        assert not len(within)


@pytest.mark.slow
def test_no_change_is_missed_between_the_speeds(random_vehicles):
    several, v = 0, np.linspace(*SEARCHED, 4001)
    rng = np.random.default_rng(6)
    for vehicle in random_vehicles(60, seed=9):
        damped = vehicle.replace(C_s=10 ** rng.uniform(4, 7))
        speeds, _ = found(damped)
        counts = np.sum(eigenvalues(damped, v).real > 0, axis=1)
        changes = np.flatnonzero(np.diff(counts))
        # Whatever the dense look sees was found; what was found and not seen must be a pair between two of its speeds.
        for k in changes:
            assert np.any((speeds >= v[k]) & (speeds <= v[k + 1]))
        places = np.searchsorted(v, speeds)
        assert all(k - 1 in changes or np.sum(places == k) % 2 == 0 for k in places)
        several += len(speeds)
    assert several > 40


@pytest.mark.slow
def test_several_changes_in_one_cell(random_bogies, monkeypatch):
    found_two = 0
    for p, _ in random_bogies(25, seed=5, spread=2.0):
        vehicle = PRINTED.at(p, C_s=1e5)
        many, field = found(vehicle)
        counts = field.unstable_roots[0]
        if counts[~np.isnan(counts)].tolist() == [0, 2, 4]:
            with monkeypatch.context() as coarse:
                coarse.setattr("yawdesign.hunting.many.critical_speeds.SPEEDS", 1)
                few, _ = found(vehicle)
            assert few == pytest.approx(many, rel=1e-8)
            found_two += 1
    assert found_two > 1


@pytest.mark.parametrize(("kind", "changes"), [("trailer", {"lambda": 0.25}), ("power", {"lambda": 0.15, "C_s": 3e5})])
def test_a_vehicle_with_a_car_body(reference_vehicle, kind, changes):
    vehicle = reference_vehicle(kind, **{"C_s": 1e6, **changes})
    speeds, field = found(vehicle)
    v = np.linspace(*SEARCHED, 400)
    counts = np.sum(eigenvalues(vehicle, v).real > 0, axis=-1)
    above = np.searchsorted(speeds, v)
    assert counts.tolist() == field.unstable_roots[0][above].tolist()
    assert len(speeds) >= 2


def test_sway_of_a_car_body_bounds_the_speed_too(reference_vehicle):
    vehicle = reference_vehicle("power", **{"lambda": 0.05, "C_s": 1.047e6})
    (speed,), field = found(vehicle)
    assert field.omega[0, 0] < 12  # hunting has more
    assert np.max(eigenvalues(vehicle, speed * 0.99).real) < 0 < np.max(eigenvalues(vehicle, speed * 1.01).real)

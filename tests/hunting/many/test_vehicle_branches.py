"""Critical values of many vehicles at once, against those of each by itself, which come from its state matrix."""

import numpy as np
import pytest

from yawdesign.hunting.critical_damping import critical_damping as of_one
from yawdesign.hunting.many import vehicle_branches
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.vehicle_branches import followed_branches


def drawn(vehicle, n, spread, seed):
    rng = np.random.default_rng(seed)
    values = {name: x * spread ** rng.uniform(-1, 1, n) for name, x in vehicle.p.items()}
    return ParameterSets(vehicle.model, {**values, "v": rng.uniform(150, 450, n) / 3.6}, n)


def agree(field, k, vehicle):
    one = of_one(vehicle)
    assert field.values_at(k)[0] == pytest.approx([x.C_s for x in one.critical], rel=1e-9)
    assert field.values_at(k)[1] == pytest.approx([x.omega for x in one.critical], rel=1e-9)
    assert field.counts_at(k) == one.unstable_roots
    return len(one.critical)


@pytest.mark.parametrize("kind", ["trailer", "power"])
def test_random_vehicles(reference_vehicle, kind):
    sets = drawn(reference_vehicle(kind), 40, 2.0, 7)
    field = critical_field(sets)
    assert not field.unverified.any()
    assert sum(agree(field, k, sets.vehicle_at(k)) for k in range(40)) > 30


def test_hardly_any_is_left_to_the_slow_way(reference_vehicle):
    _, passed = followed_branches(drawn(reference_vehicle("trailer"), 300, 2.0, 8))
    assert np.mean(passed) > 0.98


def test_values_at_a_lightly_damped_root_are_seen(reference_vehicle):
    # Two values lie within one hundredth of a frequency at which the vehicle without yaw dampers is hardly damped.
    vehicle = reference_vehicle("power", **{"lambda": 0.15, "C_mphi": 20.0, "C_m": 50.0})
    sets = ParameterSets(vehicle.model, vehicle.p, 1)
    agree(critical_field(sets), 0, vehicle)


@pytest.mark.parametrize("mass", [1e9, 1e11, 1e13])
def test_slow_motions_of_a_heavy_car_body_are_seen(reference_vehicle, mass):
    vehicle = reference_vehicle("power", **{"lambda": 0.15, **dict.fromkeys(("M_c", "J_c", "I_c"), mass)})
    field = critical_field(ParameterSets(vehicle.model, vehicle.p, 1))
    assert agree(field, 0, vehicle) == 6


def test_a_very_heavy_car_body_and_a_rigid_joint(reference_vehicle):
    for changes in ({"M_c": 1e15, "J_c": 1e15, "I_c": 1e15}, {"K_ds": np.inf}, {"C_t": 0.0}, {"lambda": 0.0}):
        vehicle = reference_vehicle("power", **{"lambda": 0.15, **changes})
        field = critical_field(ParameterSets(vehicle.model, vehicle.p, 1))
        assert not field.unverified.any()
        agree(field, 0, vehicle)


def test_counts_towards_zero_and_infinity_must_agree_where_no_value_is_found(reference_vehicle, monkeypatch):
    sets = drawn(reference_vehicle("trailer"), 20, 1.2, 9)
    counts = [of_one(sets.vehicle_at(k)).unstable_roots for k in range(20)]
    monkeypatch.setattr(vehicle_branches, "RANGE", (50.0, 60.0, 100.0))  # where no value lies
    _, passed = followed_branches(sets)
    assert passed.tolist() == [count[0] == count[-1] for count in counts]
    assert not passed.all()

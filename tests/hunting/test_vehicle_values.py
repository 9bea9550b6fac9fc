"""Critical values of a vehicle with a car body, against the reference vehicles and against scans of eigenvalues."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from yawdesign.hunting.certificate import certify
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import count_undamped, motion_eigenvalues
from yawdesign.hunting.exact import exact_critical_values
from yawdesign.hunting.vehicle_values import in_double_precision
from yawdesign.problem.cases import Case, Change
from yawdesign.vehicle.vehicle import Model

REFERENCE = json.loads((Path(__file__).parents[1] / "data" / "vehicle.json").read_text(encoding="utf-8"))["cases"]


def vehicle_of(reference, **changes):
    """Return the vehicle of a reference case with other numbers; what is rigid has none."""
    p = {**reference["bogie"], **reference["car_body"], "v": reference["speed_kmh"] / 3.6, **changes}
    p = {name: x for name, x in p.items() if x != math.inf}
    return Model(reference["kind"], "reciprocal", (*p, "C_s")).at(p)


def counted(vehicle, C_s):
    return int(count_undamped(motion_eigenvalues(vehicle.replace(C_s=C_s), vehicle.coupled)))


@pytest.mark.parametrize("reference", REFERENCE, ids=lambda c: c["name"])
def test_reference_vehicles(reference):
    vehicle = vehicle_of(reference)
    assert in_double_precision(vehicle).decided
    found = critical_damping(vehicle)
    assert [x.C_s for x in found.critical] == pytest.approx(reference["critical_C_s"], rel=1e-10)
    assert [x.omega for x in found.critical] == pytest.approx(reference["omega"], rel=1e-10)
    assert list(found.unstable_roots) == reference["unstable_roots_per_interval"]
    assert found.checked


@pytest.mark.parametrize("reference", REFERENCE[4:8], ids=lambda c: c["name"])
@pytest.mark.parametrize("route", [certify, exact_critical_values], ids=["flint", "decimals"])
def test_exact_answers(reference, route):
    vehicle = vehicle_of(reference)
    fast, proved = critical_damping(vehicle), route(vehicle)
    values = [float(x.C_s if route is certify else x[0]) for x in proved.critical]
    assert [x.C_s for x in fast.critical] == pytest.approx(values, rel=1e-11)
    assert fast.unstable_roots == proved.unstable_roots


def random_vehicles(n, spread, seed):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        reference = REFERENCE[rng.choice([4, 6])]
        p = {**reference["bogie"], **reference["car_body"]}
        yield vehicle_of(
            {**reference, "speed_kmh": rng.uniform(150, 450)},
            **{name: value * spread ** rng.uniform(-1, 1) for name, value in p.items()},
        )


@pytest.mark.slow
@pytest.mark.parametrize(("n", "spread", "seed"), [(8, 1.5, 1), (8, 3, 2), (4, 10, 3)])
def test_random_vehicles_against_certificates(n, spread, seed):
    values = 0
    for vehicle in random_vehicles(n, spread, seed):
        found, proved = critical_damping(vehicle), certify(vehicle)
        assert found.unstable_roots == proved.unstable_roots
        assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-9)
        assert [x.omega for x in found.critical] == pytest.approx([x.omega for x in proved.critical], rel=1e-9)
        assert found.checked
        values += len(found.critical)
    assert values >= n / 2


def test_no_yaw_damper_at_all():
    none = Case("none", tuple(Change(f"{bogie}.C_s", 0.0, True) for bogie in ("leading", "trailing")))
    found = critical_damping(table_1().with_fault(none))
    assert found.critical == ()
    assert found.unstable_roots == critical_damping(table_1()).unstable_roots[:1]


def table_1(**changes):
    return vehicle_of(REFERENCE[0], **{"lambda": 0.15, **changes})


def test_a_very_heavy_car_body_stands_still():
    found = critical_damping(table_1(M_c=1e15, J_c=1e15, I_c=1e15))
    assert found.checked
    assert [x.C_s for x in found.critical[:2]] == pytest.approx([63607.4140611465] * 2, rel=5e-9)
    assert found.unstable_roots[:3] == (4, 2, 0)
    assert found.critical[2].C_s > 1e7  # motions of the car body, of 1e-5 rad/s


@pytest.mark.slow
@pytest.mark.parametrize("mass", [1e17, 1e19])
def test_what_is_lost_in_rounding_is_left_to_exact_numbers(mass):
    # Double precision finds the first two values, whose counts fit, and none of the car body's own.
    vehicle = table_1(M_c=mass, J_c=mass, I_c=mass)
    assert not in_double_precision(vehicle).decided
    found = critical_damping(vehicle)
    assert found.checked
    assert [x.C_s for x in found.critical[:2]] == pytest.approx([63607.4140611465] * 2, rel=1e-9)
    assert found.unstable_roots == (4, 2, 0, 2, 4, 2, 0)


@pytest.mark.parametrize("joint", ["K_ds", "K_dt", "K_dm"])
def test_a_rigid_joint_is_the_limit_of_a_stiff_one(joint):
    rigid, stiff = (critical_damping(table_1(**{joint: K})) for K in (math.inf, 1e15))
    assert rigid.checked
    assert [x.C_s for x in rigid.critical] == pytest.approx([x.C_s for x in stiff.critical], rel=1e-6)
    assert rigid.unstable_roots == stiff.unstable_roots


def test_without_conicity_the_whole_vehicle_shifts_and_yaws_freely():
    found = critical_damping(table_1(**{"lambda": 0.0}))
    assert found.checked
    assert (found.critical, found.unstable_roots) == ((), (2,))


@pytest.mark.slow
@pytest.mark.parametrize("bogie", ["leading", "trailing"])
def test_one_damper_out(bogie):
    case = Case("one out", (Change(f"{bogie}.C_s", 0.5, True), Change(f"{bogie}.K_ds", 0.5, True)))
    vehicle = table_1().with_fault(case)
    found = critical_damping(vehicle)
    assert found.checked
    for (low, high), count in zip(found.intervals, found.unstable_roots, strict=True):
        assert counted(vehicle, math.sqrt(max(low, 1.0) * min(high, 1e9))) == count


@pytest.mark.parametrize("changes", [{}, {"C_t": 0.0}, {"C_m": 0.0}, {"W": 0.0}, {"K_ds": math.inf}])
def test_counts_agree_with_a_scan_of_eigenvalues(changes):
    vehicle = table_1(**changes)
    found = critical_damping(vehicle)
    assert found.checked
    ends = [x.C_s for x in found.critical]
    for C_s in np.geomspace(1e2, 1e9, 150):
        assert counted(vehicle, C_s) == found.unstable_roots[np.searchsorted(ends, C_s)]


@pytest.mark.slow
@pytest.mark.parametrize("apart", [1e-4, 1e-7, 1e-10])
def test_both_sides_of_a_fold(apart):
    # Over f_11 the two upper values of Table I at conicity 0.15 meet and vanish.
    f_11 = table_1().p["f_11"]
    few, many = f_11 * 0.98, f_11
    few, many = (few, many) if len(critical_damping(table_1(f_11=few)).critical) == 1 else (f_11 * 1.02, f_11)
    assert len(critical_damping(table_1(f_11=few)).critical) == 1
    for _ in range(45):
        middle = (few + many) / 2
        few, many = (middle, many) if len(in_double_precision(table_1(f_11=middle)).critical) < 2 else (few, middle)
    for side in (1 - apart, 1 + apart):
        vehicle = table_1(f_11=many * side)
        found, proved = critical_damping(vehicle), certify(vehicle)
        assert found.unstable_roots == proved.unstable_roots
        assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)
        assert found.checked

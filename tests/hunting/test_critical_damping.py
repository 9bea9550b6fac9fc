"""Critical values of the yaw damping against the reference bogies and against certified answers."""

import math
from fractions import Fraction

import numpy as np
import pytest

from yawdesign.hunting.certificate import certify
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import motion_eigenvalues
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.routh import count_unstable
from yawdesign.vehicle.vehicle import Model

PRINTED, RECIPROCAL = Model(equations="as-printed"), Model()


def test_reference_bogies(case, vehicle_of_case):
    found = critical_damping(vehicle_of_case(case))
    assert [x.C_s for x in found.critical] == pytest.approx(case["critical_C_s"], rel=1e-8)
    assert [x.omega for x in found.critical] == pytest.approx(case["crossing_omega"], rel=1e-8)
    assert list(found.unstable_roots) == case["unstable_roots_per_interval"]
    assert found.checked


@pytest.mark.parametrize(
    ("kind", "equations", "kmh", "C_s", "omega"),
    [
        ("power", "as-printed", 300, 90702.8897786979, 23.15473658),
        ("power", "reciprocal", 300, 63607.4140611465, 22.73440508),
        ("trailer", "reciprocal", 300, 440662.044792519, 21.30593741),
        ("power", "as-printed", 350, 255130.515707959, 22.17432531),
        ("power", "reciprocal", 350, 266059.018759661, 21.22615502),
    ],
)
def test_table_1(table1, kind, equations, kmh, C_s, omega):
    found = critical_damping(Model(kind, equations).at(table1, v=kmh / 3.6))
    (value,) = found.critical
    assert value.C_s == pytest.approx(C_s, rel=1e-9)
    assert value.omega == pytest.approx(omega, rel=1e-9)
    assert value.becomes == "stable"
    assert value.residual < 1e-13
    assert found.stable_intervals == ((value.C_s, math.inf),)
    assert found.checked


@pytest.mark.parametrize("equations", ["as-printed", "reciprocal"])
def test_table_1_is_always_stable_at_250(table1, equations):
    found = critical_damping(Model(equations=equations).at(table1, v=250 / 3.6))
    assert found.critical == ()
    assert found.unstable_roots == (0,)
    assert found.stable_intervals == ((0.0, math.inf),)


def test_unrounded_motor_suspension(table1):
    # The paper's K_m and C_m are 3 Hz and 30 % with pi = 3.14, and then rounded: with these its printed 90 730 appears.
    omega = 2 * 3.14 * 3
    K_m = table1["M_m"] * omega**2
    p = {**table1, "K_m": K_m, "C_m": 2 * 0.3 * math.sqrt(K_m * table1["M_m"])}
    (value,) = critical_damping(PRINTED.at(p)).critical
    assert (p["K_m"], p["C_m"]) == pytest.approx((626478.98, 19951.56), abs=0.005)
    assert value.C_s == pytest.approx(90727.8396, rel=1e-9)


def exactly(vehicle):
    return vehicle.model.at({name: Fraction(value) for name, value in vehicle.p.items()})


@pytest.mark.slow
@pytest.mark.parametrize(("n", "spread", "seed"), [(200, 3, 21), (60, 10, 22)])
def test_random_bogies_against_certificates(random_vehicles, n, spread, seed):
    values = 0
    for vehicle in random_vehicles(n, spread=spread, seed=seed):
        found, proved = critical_damping(vehicle), certify(exactly(vehicle))
        assert found.unstable_roots == proved.unstable_roots
        assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)
        assert [x.omega for x in found.critical] == pytest.approx([x.omega for x in proved.critical], rel=1e-8)
        assert found.checked
        values += len(found.critical)
    assert values >= n / 5  # a test of bogies without critical values would be none


# Nearly undamped motions put two crossings close together in frequency and decades apart in C_s.
HIDDEN = {
    "one below and one above the rest": (
        PRINTED,
        {"C_m": 0.011, "a_0": 0.51, "lambda": 0.22},
        [180563.4206, 450238.0009, 1560285.5941, 19362812.1937],
        (6, 4, 2, 0, 2),
    ),
    "a stable island": (
        RECIPROCAL,
        {"K_1y": 3.1e6, "K_m": 3.3e5, "K_dm": 97e6, "C_m": 0.39, "a": 1.6, "b_3": 0.56, "r": 0.26, "lambda": 0.052}
        | {"f_11": 21e6, "f_22": 4.8e6},
        [1672392.968, 4769439.348],
        (2, 0, 2),
    ),
}


def asked_both_ways(vehicle):
    """Return critical values and counts of the single question and of a sweep's, which must say they are checked."""
    one = critical_damping(vehicle)
    assert one.checked
    field = critical_field(ParameterSets(vehicle.model, vehicle.p, 1))
    assert not field.unverified.any()
    return [([x.C_s for x in one.critical], one.unstable_roots), (field.values_at(0)[0], field.counts_at(0))]


@pytest.mark.parametrize("name", HIDDEN)
def test_no_critical_value_is_missed(table1, name):
    model, changes, values, counts = HIDDEN[name]
    for found, unstable in asked_both_ways(model.at({**table1, **changes})):
        assert found == pytest.approx(values, rel=1e-9)
        assert unstable == counts


def test_the_counts_hold_towards_zero_and_infinity(table1):
    model, changes, _, counts = HIDDEN["one below and one above the rest"]
    coupled = model.at({**table1, **changes}).coupled
    assert count_unstable(coupled.polynomial(1e-30)) == counts[0]
    assert count_unstable(coupled.polynomial(5e7)) == count_unstable(coupled.polynomial(1e40)) == counts[-1]


def test_a_fold(table1):
    # Two of the three values are 5.6e-6 of themselves apart.
    vehicle = PRINTED.at(table1, K_m=737832.4535008409)
    proved = certify(vehicle)
    for found, unstable in asked_both_ways(vehicle):
        assert len(found) == 3
        assert found[2] / found[1] - 1 == pytest.approx(5.83e-6, rel=1e-2)
        assert found == pytest.approx([x.C_s for x in proved.critical], rel=1e-9)
        assert unstable == proved.unstable_roots == (2, 0, 2, 0)


@pytest.mark.parametrize("apart", [1e-3, 1e-6, 1e-9, 1e-12])
def test_both_sides_of_a_fold(table1, apart):
    # The fold over K_m lies where the two values above meet; on the one side are three values, on the other one.
    fold = 737832.4535000349
    for K_m in (fold * (1 - apart), fold * (1 + apart)):
        vehicle = PRINTED.at(table1, K_m=K_m)
        proved = certify(vehicle)
        for found, unstable in asked_both_ways(vehicle):
            assert found == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)
            assert unstable == proved.unstable_roots


@pytest.mark.parametrize(
    ("name", "which", "end"),
    [("a", 18, 0), ("K_m", 44, 0), ("lambda", 37, 0), ("a", 19, -1), ("lambda", 7, -1), ("lambda", 21, -1)],
)
@pytest.mark.slow
def test_values_far_outside_what_is_allowed(random_vehicles, name, which, end):
    # Where the count towards 0 or infinity changes over a parameter, a critical value runs off to there.
    vehicle = list(random_vehicles(which + 1, seed=90))[which]
    low, high = vehicle.p[name], 1.5 * vehicle.p[name]
    below = critical_damping(vehicle).unstable_roots[end]
    for _ in range(24):
        middle = (low + high) / 2
        found = critical_damping(vehicle.replace(**{name: middle}))
        low, high = (middle, high) if found.unstable_roots[end] == below else (low, middle)
    proved = certify(vehicle.replace(**{name: middle}))
    assert found.checked
    assert found.unstable_roots == proved.unstable_roots
    assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)
    assert any(x.C_s > 1e13 or x.C_s < 1 for x in found.critical)


def test_intervals_and_what_a_value_makes_of_the_bogie(random_vehicles):
    seen = set()
    for vehicle in random_vehicles(150, seed=23):
        found = critical_damping(vehicle)
        ends = [end for interval in found.intervals for end in interval]
        assert ends == sorted(ends)
        for value, before, after in zip(found.critical, found.unstable_roots, found.unstable_roots[1:], strict=False):
            expected = "stable" if after == 0 else "unstable" if before == 0 else "neither"
            assert value.becomes == expected
            seen.add(expected)
        assert set(found.stable_intervals) == {
            i for i, n in zip(found.intervals, found.unstable_roots, strict=True) if n == 0
        }
    assert seen == {"stable", "unstable", "neither"}


def test_stable_intervals_agree_with_eigenvalues(random_vehicles):
    rng = np.random.default_rng(24)
    for drawn in random_vehicles(60, seed=24):
        found = critical_damping(drawn)
        for C_s in 10 ** rng.uniform(2, 8, size=5):
            if any(abs(C_s / x.C_s - 1) < 1e-6 for x in found.critical):
                continue
            vehicle = drawn.replace(C_s=C_s)
            unstable = int(np.sum(motion_eigenvalues(vehicle, vehicle.coupled).real > 0))
            (count,) = (n for (lo, hi), n in zip(found.intervals, found.unstable_roots, strict=True) if lo < C_s < hi)
            assert count == unstable == count_unstable(vehicle.coupled.polynomial(C_s))
            assert any(lo < C_s < hi for lo, hi in found.stable_intervals) == (unstable == 0)


@pytest.mark.parametrize("k", [1e-6, 1e6])
def test_far_from_si_sizes(table1, k):
    # A model bogie of a thousandth of the mass, or a bogie in grams: no fixed scale may be built in.
    (expected,) = critical_damping(RECIPROCAL.at(table1)).critical
    found = critical_damping(RECIPROCAL.at(force_scaled(table1, k)))
    assert [x.C_s for x in found.critical] == pytest.approx([k * expected.C_s], rel=1e-8)
    assert found.checked


def force_scaled(p, k):
    forces = ("M_", "J_", "W", "K_", "C_", "f_")
    return {name: value * k if name.startswith(forces) else value for name, value in p.items()}


def test_no_warnings_at_high_frequencies(table1):
    # In SI units the polynomials overflow there; warnings are errors in these tests.
    stiff = {name: value * 30 if name.startswith(("K_", "M_", "J_")) else value for name, value in table1.items()}
    assert critical_damping(RECIPROCAL.at(stiff)).checked


def test_a_damper_without_damping_is_no_obstacle(table1):
    vehicle = RECIPROCAL.at(table1, C_m=0.0, C_t=0.0)
    found, proved = critical_damping(vehicle), certify(exactly(vehicle))
    assert found.unstable_roots == proved.unstable_roots
    assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)


@pytest.mark.parametrize("seed", [111, 7, 19])
def test_a_root_that_is_a_candidate_itself(random_vehicles, seed):
    # An array and a single number differ in the last bit, and at the root itself that decides the sign.
    for vehicle, k in zip(random_vehicles(40, seed=seed), np.geomspace(1e-3, 1e3, 40), strict=True):
        found = critical_damping(RECIPROCAL.at(force_scaled(vehicle.p, k)))
        assert found.checked

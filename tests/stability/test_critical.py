"""Critical values of the yaw damping against the reference bogies and against certified answers."""

import math
from fractions import Fraction

import numpy as np
import pytest

from yawdesign.bogie.characteristic import characteristic
from yawdesign.stability.certificate import certify
from yawdesign.stability.critical import count_unstable, critical_damping
from yawdesign.stability.modes import core_matrix


def test_reference_bogies(case, of_case):
    p, model = of_case(case)
    found = critical_damping(p, **model)
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
    found = critical_damping({**table1, "v": kmh / 3.6}, kind=kind, equations=equations)
    (value,) = found.critical
    assert value.C_s == pytest.approx(C_s, rel=1e-9)
    assert value.omega == pytest.approx(omega, rel=1e-9)
    assert value.becomes == "stable"
    assert value.residual < 1e-13
    assert found.stable_intervals == ((value.C_s, math.inf),)
    assert found.checked


@pytest.mark.parametrize("equations", ["as-printed", "reciprocal"])
def test_table_1_is_always_stable_at_250(table1, equations):
    found = critical_damping({**table1, "v": 250 / 3.6}, equations=equations)
    assert found.critical == ()
    assert found.unstable_roots == (0,)
    assert found.stable_intervals == ((0.0, math.inf),)


def test_unrounded_motor_suspension(table1):
    # The paper's K_m and C_m are 3 Hz and 30 % with pi = 3.14, and then rounded: with these its printed 90 730 appears.
    omega = 2 * 3.14 * 3
    K_m = table1["M_m"] * omega**2
    p = {**table1, "K_m": K_m, "C_m": 2 * 0.3 * math.sqrt(K_m * table1["M_m"])}
    (value,) = critical_damping(p, equations="as-printed").critical
    assert (p["K_m"], p["C_m"]) == pytest.approx((626478.98, 19951.56), abs=0.005)
    assert value.C_s == pytest.approx(90727.8396, rel=1e-9)


def exactly(p):
    return {name: Fraction(value) for name, value in p.items()}


@pytest.mark.parametrize(("n", "spread", "seed"), [(200, 3, 21), (60, 10, 22)])
def test_random_bogies_against_certificates(random_bogies, n, spread, seed):
    values = 0
    for p, model in random_bogies(n, spread=spread, seed=seed):
        found, proved = critical_damping(p, **model), certify(exactly(p), **model)
        assert found.unstable_roots == proved.unstable_roots
        assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)
        assert [x.omega for x in found.critical] == pytest.approx([x.omega for x in proved.critical], rel=1e-8)
        assert found.checked
        values += len(found.critical)
    assert values >= n / 5  # a test of bogies without critical values would be none


def test_intervals_and_what_a_value_makes_of_the_bogie(random_bogies):
    seen = set()
    for p, model in random_bogies(150, seed=23):
        found = critical_damping(p, **model)
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


def test_stable_intervals_agree_with_eigenvalues(random_bogies):
    rng = np.random.default_rng(24)
    for p, model in random_bogies(60, seed=24):
        found = critical_damping(p, **model)
        for C_s in 10 ** rng.uniform(2, 8, size=5):
            if any(abs(C_s / x.C_s - 1) < 1e-6 for x in found.critical):
                continue
            unstable = int(np.sum(np.linalg.eigvals(core_matrix(p, C_s, **model)).real > 0))
            (count,) = (n for (lo, hi), n in zip(found.intervals, found.unstable_roots, strict=True) if lo < C_s < hi)
            assert count == unstable == count_unstable(characteristic(p, **model).core(C_s))
            assert any(lo < C_s < hi for lo, hi in found.stable_intervals) == (unstable == 0)


@pytest.mark.parametrize("k", [1e-6, 1e6])
def test_far_from_si_sizes(table1, k):
    # A model bogie of a thousandth of the mass, or a bogie in grams: no fixed scale may be built in.
    (expected,) = critical_damping(table1).critical
    found = critical_damping(force_scaled(table1, k))
    assert [x.C_s for x in found.critical] == pytest.approx([k * expected.C_s], rel=1e-8)
    assert found.checked


def force_scaled(p, k):
    forces = ("M_", "J_", "W", "K_", "C_", "f_")
    return {name: value * k if name.startswith(forces) else value for name, value in p.items()}


def test_no_warnings_at_high_frequencies(table1):
    # In SI units the polynomials overflow there; warnings are errors in these tests.
    stiff = {name: value * 30 if name.startswith(("K_", "M_", "J_")) else value for name, value in table1.items()}
    assert critical_damping(stiff).checked


def test_a_damper_without_damping_is_no_obstacle(table1, of_case):
    p = {**table1, "C_m": 0.0, "C_t": 0.0}
    found, proved = critical_damping(p), certify(exactly(p))
    assert found.unstable_roots == proved.unstable_roots
    assert [x.C_s for x in found.critical] == pytest.approx([x.C_s for x in proved.critical], rel=1e-8)


@pytest.mark.parametrize("seed", [111, 7, 19])
def test_a_root_that_is_a_candidate_itself(random_bogies, seed):
    # An array and a single number differ in the last bit, and at the root itself that decides the sign.
    for (p, _), k in zip(random_bogies(40, seed=seed), np.geomspace(1e-3, 1e3, 40), strict=True):
        found = critical_damping(force_scaled(p, k))
        assert found.checked

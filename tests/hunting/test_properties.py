"""Laws that hold for every bogie: units, mirrors, and what cannot matter."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import motion_eigenvalues, state_matrix
from yawdesign.vehicle.vehicle import Model

MODELS = st.sampled_from([Model("power", "as-printed"), Model("power", "reciprocal"), Model("trailer", "reciprocal")])
few = settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
sizes = st.floats(-4, 4).map(lambda x: 10**x)
seeds = st.integers(0, 10**6)
FORCES = ("M_", "J_", "W", "K_", "C_", "f_")


def bogie(random_vehicles, seed):
    (drawn,) = random_vehicles(1, seed=seed)
    return drawn.p


def scaled(p, powers):
    """Return parameters times factors, found by the beginning of their names; the longest beginning counts."""

    def factor(name):
        return next((f for start, f in sorted(powers.items(), key=lambda x: -len(x[0])) if name.startswith(start)), 1.0)

    return {name: value * factor(name) for name, value in p.items()}


def same_answer(one, other, C_s=1.0, omega=1.0, rel=1e-7):
    assert one.unstable_roots == other.unstable_roots
    assert [x.C_s * C_s for x in one.critical] == pytest.approx([x.C_s for x in other.critical], rel=rel)
    assert [x.omega * omega for x in one.critical] == pytest.approx([x.omega for x in other.critical], rel=rel)
    assert [x.becomes for x in one.critical] == [x.becomes for x in other.critical]


@few
@given(seeds, MODELS, sizes)
def test_forces_and_masses_times_k(random_vehicles, seed, model, k):
    p = bogie(random_vehicles, seed)
    heavy = scaled(p, dict.fromkeys(FORCES, k))
    same_answer(critical_damping(model.at(p)), critical_damping(model.at(heavy)), C_s=k)


@few
@given(seeds, MODELS, st.floats(-1, 1).map(lambda x: 10**x))
def test_another_unit_of_length(random_vehicles, seed, model, k):
    # Lengths times k: moments of inertia and yaw stiffness and damping times k^2, speed and forces times k.
    p = bogie(random_vehicles, seed)
    lengths = dict.fromkeys(("a", "b", "a_0", "b_0", "b_1", "b_2", "b_3", "r", "v"), k)
    long = {n: x * k if n in lengths else x for n, x in p.items()}
    long |= {n: p[n] * k**2 for n in ("J_b", "J_w", "J_m", "K_mphi", "C_mphi")}
    long |= {n: p[n] * k for n in ("W", "f_11", "f_22")}
    same_answer(critical_damping(model.at(p)), critical_damping(model.at(long)))


@few
@given(seeds, MODELS, st.floats(-1, 1).map(lambda x: 10**x))
def test_another_unit_of_time(random_vehicles, seed, model, k):
    # Time times 1/k: stiffness and forces times k^2, damping and speed times k.
    p = bogie(random_vehicles, seed)
    fast = scaled(p, {"K_": k**2, "C_": k, "W": k**2, "f_": k**2, "v": k})
    same_answer(critical_damping(model.at(p)), critical_damping(model.at(fast)), C_s=k, omega=k)


@few
@given(seeds, MODELS, st.floats(1, 8).map(lambda x: 10**x))
def test_running_the_mirrored_bogie_changes_nothing(random_vehicles, seed, model, C_s):
    # Front and rear exchanged, and the sense of yaw with them: negative levers in the same elements.
    p = bogie(random_vehicles, seed)
    mirrored = {**p, **{name: -p[name] for name in ("a", "a_0", "b_0", "b_3")}}
    one, other = (model.at(x).coupled.polynomial(C_s) for x in (p, mirrored))
    assert one == pytest.approx(other, rel=1e-13)


@few
@given(seeds, MODELS)
def test_only_the_square_of_the_damper_arm_counts(random_vehicles, seed, model):
    # Half the arm with four times stiffness and damping is the same yaw damper.
    p = bogie(random_vehicles, seed)
    near = {**p, "b_3": p["b_3"] / 2, "K_ds": p["K_ds"] * 4}
    same_answer(critical_damping(model.at(p)), critical_damping(model.at(near)), C_s=4)


@few
@given(seeds, st.floats(2, 8).map(lambda x: 10**x))
def test_a_massless_motor_is_no_motor(random_vehicles, seed, C_s):
    p = bogie(random_vehicles, seed)
    light = {**p, **{name: p[name] * 1e-9 for name in ("M_m", "J_m", "K_m", "K_mphi", "C_m", "C_mphi", "K_dm")}}
    vehicle = Model().at(light, C_s=C_s)
    s = motion_eigenvalues(vehicle, vehicle.coupled)
    trailer = np.linalg.eigvals(state_matrix(Model("trailer").at(p, C_s=C_s)))
    apart = np.abs(trailer[:, None] - s[None, :]).min(axis=1)
    assert np.all(apart < 1e-3 * (1 + np.abs(trailer)))


@few
@given(seeds, MODELS, st.lists(st.floats(2, 8).map(lambda x: 10**x), min_size=1, max_size=4))
def test_stable_intervals_are_those_of_the_eigenvalues(random_vehicles, seed, model, dampings):
    p = bogie(random_vehicles, seed)
    found = critical_damping(model.at(p))
    for C_s in dampings:
        if all(abs(C_s / x.C_s - 1) > 1e-6 for x in found.critical):
            stable = np.all(np.linalg.eigvals(state_matrix(model.at(p, C_s=C_s))).real < 0)
            assert any(lo < C_s < hi for lo, hi in found.stable_intervals) == stable

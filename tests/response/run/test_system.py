"""The bogie as a linear system: forces balance, and the rear wheelset is a front one later."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting.eigenvalues import dense
from yawdesign.response.run.system import system_at
from yawdesign.vehicle.vehicle import Model


@pytest.fixture(params=["power", "trailer"])
def system(request):
    return system_at(yd.table1(request.param).replace(C_s="1 MN s/m"), 80.0)


@pytest.fixture
def motion(system):
    """Return outputs by name for random states and inputs, with the states and inputs."""
    rng = np.random.default_rng(1)
    x, u = rng.normal(size=len(system.A)), rng.normal(size=4)
    y = system.C @ x + system.D @ u
    return {name: y[k] for name, k in system.outputs.items()}, x, u


def test_mass_times_acceleration_is_rail_and_spring(system, motion):
    y, _, _ = motion
    p = system.vehicle.p
    for i, sign in (("1", 1), ("2", -1)):
        spring = p["K_1y"] * (y["y_b"] + sign * p["a"] * y["phi_b"] - y[f"y_w{i}"])
        assert p["M_w"] * y[f"y_w{i}_acceleration"] == pytest.approx(y[f"lateral_force_{i}"] + spring, rel=1e-9)


def test_rail_force_by_hand(system, motion):
    y, _, u = motion
    p = system.vehicle.p
    gravity = p["W"] * p["lambda"] / p["b"] * (y["y_w1"] - u[0]) - p["W"] * u[1]
    creep = 2 * p["f_11"] * (y["y_w1_velocity"] / system.v - y["phi_w1"])
    assert y["lateral_force_1"] == pytest.approx(-gravity - creep, rel=1e-12)


def test_yaw_moment_of_the_track_by_hand(system):
    p = system.vehicle.p
    row = len(system.coordinates) + system.coordinates.index("phi_w1")
    expected = 2 * p["f_22"] * p["b"] * p["lambda"] / p["r"] / p["J_w"]
    assert system.B[row] == pytest.approx([expected, 0, 0, 0])


def test_each_yaw_damper_has_half_the_force_of_the_pair(system, motion):
    y, x, _ = motion
    rate = (system.A @ x)[np.argmax(system.C[system.outputs["yaw_damper_stroke"]])]
    assert y["yaw_damper_force"] == pytest.approx(system.C_s / 2 * rate, rel=1e-9)


def test_half_sums_of_inputs_move_half_sums():
    """The folded elements answer half the sum of the inputs with half the sum of the wheelsets' motions."""
    vehicle = Model().at(yd.table1().bogie.parameters(), v=80.0, C_s=1e6)
    whole, halves = vehicle.state_space, vehicle.folded_state_space
    assert whole.inputs == ("alignment_1", "cross_level_1", "alignment_2", "cross_level_2")
    assert halves.inputs == ("alignment_+", "cross_level_+", "alignment_-", "cross_level_-")

    def answer(space, u, names):
        A, B = dense(space.A, space.size), dense(space.B, space.size, len(space.inputs))
        x = np.linalg.solve(20j * np.eye(space.size) - A, B @ u)
        return [x[space.coordinates.index(name)] for name in names]

    one = answer(whole, [0.3, 0.1, -0.2, 0.05], ["y_b", "phi_b", "y_w1", "y_w2"])
    two = answer(halves, [0.05, 0.075, 0.25, 0.025], ["y_b", "phi_b", "y_w+", "y_w-"])
    assert one[:2] == pytest.approx(two[:2], rel=1e-9)
    assert [one[2] + one[3], one[2] - one[3]] == pytest.approx([2 * two[2], 2 * two[3]], rel=1e-9)


def test_units():
    history = yd.simulate(yd.table1(), duration=1).histories[0]
    assert {x: history.unit(x) for x in ("alignment_1", "y_b", "phi_w1_velocity", "y_m1_acceleration")} == {
        "alignment_1": "m",
        "y_b": "m",
        "phi_w1_velocity": "rad/s",
        "y_m1_acceleration": "m/s^2",
    }
    assert [history.unit(x) for x in ("lateral_force_1", "yaw_damper_stroke", "cross_level_2")] == ["N", "m", "rad"]
    assert list(history.values) == list(history.units)


def test_the_rear_wheelset_comes_a_wheelbase_later(system):
    p = system.vehicle.p
    assert system.wheelsets.lags == pytest.approx((0, 2 * p["a"] / 80))
    assert system.wheelsets.width == pytest.approx(2 * p["b"])


@pytest.mark.parametrize("C_mphi", [0, 1e-3, 11520.0])
def test_what_is_exactly_undamped_is_judged_as_stability_does(C_mphi):
    problem = yd.table1().replace(C_mphi=C_mphi)
    assert system_at(problem, problem.speeds[0]).stable is yd.stability(problem).stable is (C_mphi > 0)


def test_a_damper_without_damping_is_not_there():
    assert "yaw_damper_force" not in system_at(yd.table1().replace(C_s=0), 80.0).outputs

"""The bogie as a linear system: forces balance, and the rear wheelset is a front one later."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.run.system import system_at
from yawdesign.vehicle.old import StateSpace, bogie, folded, physical, unit_of


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
    p = system.p
    for i, sign in (("1", 1), ("2", -1)):
        spring = p["K_1y"] * (y["y_b"] + sign * p["a"] * y["phi_b"] - y[f"y_w{i}"])
        assert p["M_w"] * y[f"y_w{i}_acceleration"] == pytest.approx(y[f"lateral_force_{i}"] + spring, rel=1e-9)


def test_rail_force_by_hand(system, motion):
    y, _, u = motion
    p = system.p
    gravity = p["W"] * p["lambda"] / p["b"] * (y["y_w1"] - u[0]) - p["W"] * u[1]
    creep = 2 * p["f_11"] * (y["y_w1_velocity"] / system.v - y["phi_w1"])
    assert y["lateral_force_1"] == pytest.approx(-gravity - creep, rel=1e-12)


def test_yaw_moment_of_the_track_by_hand(system):
    p = system.p
    row = len(system.coordinates) + system.coordinates.index("phi_w1")
    expected = 2 * p["f_22"] * p["b"] * p["lambda"] / p["r"] / p["J_w"]
    assert system.B[row] == pytest.approx([expected, 0, 0, 0])


def test_each_yaw_damper_has_half_the_force_of_the_pair(system, motion):
    y, x, _ = motion
    rate = (system.A @ x)[np.argmax(system.C[system.outputs["yaw_damper_stroke"]])]
    assert y["yaw_damper_force"] == pytest.approx(system.C_s / 2 * rate, rel=1e-9)


def test_half_sums_of_inputs_move_half_sums():
    """The folded elements answer half the sum of the inputs with half the sum of the wheelsets' motions."""
    p = {**yd.table1().bogie.parameters(), "v": 80.0, "C_s": 1e6}
    whole, halves = StateSpace(physical(bogie(p))), StateSpace(folded(bogie(p)))
    assert whole.input_names == ("alignment_1", "cross_level_1", "alignment_2", "cross_level_2")
    assert halves.input_names == ("alignment_+", "cross_level_+", "alignment_-", "cross_level_-")

    def answer(space, u, names):
        A = space.fill(np.zeros((space.size, space.size)))
        force = np.zeros(space.size)
        for (row, column), value in space.inputs.items():
            force[row] += value * u[column]
        x = np.linalg.solve(20j * np.eye(space.size) - A, force)
        return [x[space.coordinates.index(name)] for name in names]

    one = answer(whole, [0.3, 0.1, -0.2, 0.05], ["y_b", "phi_b", "y_w1", "y_w2"])
    two = answer(halves, [0.05, 0.075, 0.25, 0.025], ["y_b", "phi_b", "y_w+", "y_w-"])
    assert one[:2] == pytest.approx(two[:2], rel=1e-9)
    assert [one[2] + one[3], one[2] - one[3]] == pytest.approx([2 * two[2], 2 * two[3]], rel=1e-9)


def test_units():
    assert [unit_of(x) for x in ("y_b", "phi_w1_velocity", "y_m1_acceleration", "lateral_force_1")] == [
        "m",
        "rad/s",
        "m/s^2",
        "N",
    ]
    assert unit_of("yaw_damper_stroke") == "m"


def test_a_damper_without_damping_is_not_there():
    assert "yaw_damper_force" not in system_at(yd.table1().replace(C_s=0), 80.0).outputs

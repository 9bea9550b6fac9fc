"""Modes of a car body on two bogies: names, shapes in the coordinates of each end, and the hunting."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.problem.cases import Case, Change
from yawdesign.problem.parameters import MOTOR_KEYS, CarBody
from yawdesign.problem.table import field_name
from yawdesign.response.modes.eigenvectors import unfold
from yawdesign.response.modes.named_modes import hunting_mode, modes_at
from yawdesign.response.modes.participation import owners
from yawdesign.vehicle.vehicle import Vehicle

REFERENCE = json.loads((Path(__file__).parents[2] / "data" / "vehicle.json").read_text(encoding="utf-8"))["cases"]
BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
NAMED = {"lower sway", "upper sway", "car body yaw", "leading bogie hunting", "trailing bogie hunting"}


def vehicle_problem(kind="power", **changes):
    bogie = yd.table1().bogie
    if kind == "trailer":
        bogie = replace(bogie, kind="trailer", **dict.fromkeys(MOTOR_KEYS))
    return yd.Problem(bogie=bogie, speed="300 km/h", car_body=BODY).replace(**changes)


def vehicle_of(problem):
    return Vehicle.of(problem)[0]


def one_out(bogie):
    return Case("one yaw damper lost", tuple(Change(f"{bogie}.{key}", 0.5, share=True) for key in ("C_s", "K_ds")))


def assert_all_roots_and_shapes(vehicle):
    """Every root has one name, and its shape and participation are those of the matrix in the ends' coordinates."""
    modes, matrix = modes_at(vehicle), state_matrix(vehicle)
    s, right = np.linalg.eig(matrix)
    states = [owner.name for owner in owners(vehicle.state_space)]
    n = len(vehicle.state_space.coordinates)
    found = np.array([mode.eigenvalue for mode in modes])
    both = np.concatenate([found, found[found.imag > 0].conj()])
    assert len(both) == len(s)
    assert np.abs(both[:, None] - s).min(axis=1).max() < 1e-6 * np.abs(s).max()
    assert len({mode.name for mode in modes}) == len(modes)
    left = np.linalg.inv(right).T
    for mode in modes:
        assert mode.shape.keys() == {*states[:n]}
        assert mode.residual < 1e-9
        near = np.sort(np.abs(s - mode.eigenvalue))
        if near[1] < 1e-3 * near[-1] ** 0.5:  # roots that are all but one: eigenvectors of rounding
            continue
        k = int(np.argmin(np.abs(s - mode.eigenvalue)))
        shape = np.array([mode.shape[x] for x in states[:n]])
        expected = right[:n, k] * (shape @ right[:n, k].conj()) / (right[:n, k] @ right[:n, k].conj())
        assert shape == pytest.approx(expected, abs=1e-6 * np.abs(shape).max())
        share = {x: abs(sum(left[i, k] * right[i, k] for i, y in enumerate(states) if y == x)) for x in set(states)}
        assert mode.participation == pytest.approx({x: v / sum(share.values()) for x, v in share.items()}, abs=1e-6)
    return modes


@pytest.mark.parametrize("kind", ["power", "trailer"])
@pytest.mark.parametrize("bogie", [None, "leading", "trailing"])
def test_names_shapes_and_participation(kind, bogie):
    vehicle = vehicle_of(vehicle_problem(kind))
    modes = assert_all_roots_and_shapes(vehicle if bogie is None else vehicle.with_fault(one_out(bogie)))
    assert {mode.name for mode in modes} >= NAMED


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None)
def test_random_vehicles_have_unique_names(seed):
    rng = np.random.default_rng(seed)
    names = ("M_c", "J_c", "I_c", "l_c", "h_s", "K_2z", "K_1x", "C_t", "J_w", "lambda_", "f_11", "a")
    problem = vehicle_problem()
    given_values = problem.parameters()
    changes = {x: float(given_values[x.rstrip("_")] * rng.uniform(0.6, 1.6)) for x in names}
    modes = modes_at(vehicle_of(problem.replace(C_s=float(10 ** rng.uniform(4, 6.7)), **changes)))
    assert len({mode.name for mode in modes}) == len(modes)
    assert sum(2 if mode.frequency else 1 for mode in modes) == 56
    for mode in modes:
        assert sum(mode.participation.values()) == pytest.approx(1)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=10, deadline=None)
def test_a_small_change_of_numbers_changes_no_name(seed):
    rng, problem = np.random.default_rng(seed), vehicle_problem()
    changes = {
        x: problem.parameters()[x] * (1 + 1e-3 * float(rng.uniform(-1, 1))) for x in ("M_c", "K_1y", "C_m", "I_c")
    }
    before, after = ({m.name: m.eigenvalue for m in yd.modes(p).modes} for p in (problem, problem.replace(**changes)))
    assert before.keys() == after.keys()
    for name in NAMED:
        assert after[name] == pytest.approx(before[name], rel=2e-2)


TABLE_I = [one for one in REFERENCE if one["name"].startswith("power conicity")]


@pytest.mark.parametrize("known", TABLE_I, ids=lambda known: known["name"])
def test_the_least_damped_modes_of_the_reference(known):
    p = {**known["bogie"], **known["car_body"], "C_s": known["C_s"], "speed": known["speed_kmh"] / 3.6}
    result = yd.modes(vehicle_problem().replace(**{field_name(key): value for key, value in p.items()}))
    waves = [mode for mode in result.modes if mode.frequency > 0]
    for mode, parts in zip(waves[:4], known["least_damped"][:4], strict=True):
        assert mode.eigenvalue == pytest.approx(complex(*parts), rel=1e-8)


def test_a_damper_out_and_where_the_hunting_is():
    vehicle = vehicle_of(vehicle_problem(C_s=1.047e6))
    trailing = {mode.name: mode for mode in modes_at(vehicle.with_fault(one_out("trailing")))}
    assert trailing["lower sway"].damping_ratio == pytest.approx(0.0403, abs=5e-5)
    assert trailing["trailing bogie hunting"].damping_ratio == pytest.approx(0.0431, abs=5e-5)
    least = hunting_mode(modes_at(vehicle.with_fault(one_out("leading"))))
    assert least.damping_ratio == pytest.approx(0.0186, abs=5e-5)
    sizes = [sum(abs(least.shape[f"y_w{bogie}{k}"]) for k in "12") for bogie in "12"]
    assert (least.name, sizes[1] > 1.5 * sizes[0]) == ("trailing bogie hunting", True)


def test_low_conicity_sway_is_said_to_be_so():
    grows = yd.modes(vehicle_problem(C_s=1.047e6, lambda_=0.05)).modes[0]
    assert grows.damping_ratio == pytest.approx(-0.030, abs=5e-4)
    assert grows.car_body > 1
    assert grows.hunting
    hunts = yd.modes(vehicle_problem(C_s=1.047e6))
    assert next(mode.car_body for mode in hunts.modes if mode.hunting) < 1
    assert hunts.hunting == "leading bogie hunting"
    assert not hunts.modes[0].hunting  # the sway is less damped, and no hunting


def test_shapes_are_scaled_by_real_displacements():
    arms = {"psi_c": 9.5, "th_c": 0.852}
    for mode in yd.modes(vehicle_problem()).modes:
        size = {x: abs(z) * arms.get(x, 1.25 if x.startswith("phi") else 1) for x, z in mode.shape.items()}
        assert max(size.values()) == pytest.approx(1)


def test_unfold_twice_and_of_one_pair():
    values = np.array([1.0, 2.0, 4.0, 8.0])
    both = unfold(("y_w++", "y_w+-", "y_w-+", "y_w--"), values)
    assert both == {"y_w11": 15, "y_w12": -5, "y_w21": -9, "y_w22": 3}
    force = unfold(("y_w++", "y_w+-", "y_w-+", "y_w--"), values, forces=True)
    assert force == {x: z / 4 for x, z in both.items()}
    assert unfold(("y_w1+", "y_w1-", "y_b1"), np.array([1.0, 2.0, 5.0])) == {"y_w11": 3, "y_w12": -1, "y_b1": 5}


def test_roots_of_a_vehicle_are_followed_without_swaps():
    problem = vehicle_problem()
    for axis in ({"v": np.array([60, 300, 450]) / 3.6}, {"lambda": np.array([0.02, 0.15, 0.4])}, {"h_s": [0.3, 1.5]}):
        ((name, values),) = axis.items()
        paths = yd.follow_modes(problem, **axis)
        assert paths.checked
        assert np.nanmin(paths.certainty) > 0.75
        steps = np.linspace(values[0], values[-1], 4001)
        field = "lambda_" if name == "lambda" else name
        s = np.linalg.eigvals(state_matrix(vehicle_of(problem).replace(**{field: steps})))
        for mode in NAMED:
            at, last = paths.eigenvalues[[0, -1], paths.names.index(mode)]
            for roots in s:
                at = roots[np.argmin(np.abs(roots - at))]
            assert at == pytest.approx(last, rel=1e-6)


def test_motor_pairs_that_coincide_are_followed_apart():
    values = np.geomspace(500, 2000, 4)
    paths = yd.follow_modes(vehicle_problem(), J_m=values)
    ends = ("both bogies alike", "one bogie against the other")
    one, two = (paths.eigenvalues[:, paths.names.index(f"motor yaw, against each other, {end}")] for end in ends)
    decay = 11520 / (2 * values)
    assert one == pytest.approx(-decay + 1j * np.sqrt(361690 / values - decay**2))
    assert two == pytest.approx(one)
    assert paths.checked


def test_a_path_of_a_vehicle_backwards_is_the_same_path():
    values = np.linspace(200, 420, 5) / 3.6
    there, back = (yd.follow_modes(vehicle_problem(), v=order) for order in (values, values[::-1]))
    assert there.names == back.names
    assert there.eigenvalues == pytest.approx(back.eigenvalues[::-1], rel=1e-6, abs=1e-6, nan_ok=True)


def test_names_on_an_axis_are_the_vehicles():
    with pytest.raises(yd.ProblemError, match="M_c: is not known here"):
        yd.follow_modes(yd.table1(), M_c=[1e4, 2e4])
    assert "lower sway" in yd.follow_modes(vehicle_problem(), M_c=[3e4, 4e4]).names


def test_what_moves_the_car_body_most_is_no_hunting():
    result = yd.modes(vehicle_problem(C_s=3e6, lambda_=0.1))
    modes = {mode.name: mode for mode in result.modes}
    hunting, yaw = modes[result.hunting], modes["car body yaw"]
    assert yaw.conicity > 0.3  # it is fed by the wheels too, and less damped
    assert yaw.decay_rate < hunting.decay_rate
    assert result.hunting in ("leading bogie hunting", "trailing bogie hunting")

"""Modes: their names, shapes and participation against an eigenvalue problem in other coordinates."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.response.modes.named_modes import modes_at
from yawdesign.response.modes.participation import owners
from yawdesign.response.run.system import System
from yawdesign.vehicle.catalogue import CATALOGUE, trailer_bogie
from yawdesign.vehicle.elements import Link, Maxwell, Pair
from yawdesign.vehicle.vehicle import Model


def roots_of(modes):
    s = np.array([mode.eigenvalue for mode in modes])
    return np.concatenate([s, s[s.imag > 0].conj()])


def distance(found, expected):
    apart = np.abs(found[:, None] - expected) / (1 + np.abs(expected))
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_names_cover_every_root_once(random_bogies, seed):
    for p, model in random_bogies(1, seed=seed):
        vehicle = Model(**model).at(p, C_s=3e5)
        modes = modes_at(vehicle)
        expected = np.linalg.eigvals(state_matrix(vehicle))
        names = [mode.name for mode in modes]
        assert len(set(names)) == len(names)
        assert len(roots_of(modes)) == len(expected)
        assert distance(roots_of(modes), expected) < 1e-5  # the double root as printed is known to half the digits
        assert all(mode.eigenvalue.imag >= 0 for mode in modes)
        assert max(mode.residual for mode in modes) < 1e-10
        for mode in modes:
            assert sum(mode.participation.values()) == pytest.approx(1)
            assert all(share >= 0 for share in mode.participation.values())


def physical_eigenvectors(vehicle):
    """Return eigenvalues, right and left eigenvectors in the coordinates of each end, and whose the states are."""
    s, right = np.linalg.eig(state_matrix(vehicle))
    return s, right, np.linalg.inv(right).T, [owner.name for owner in owners(vehicle.state_space)]


def test_shapes_and_participation_in_the_coordinates_of_each_end(table1, model):
    vehicle = Model(**model).at(table1, C_s=1e6)
    s, right, left, states = physical_eigenvectors(vehicle)
    n = states.index("y_b", 1)
    for mode in modes_at(vehicle):
        if "motor yaw, " in mode.name and model["equations"] == "as-printed":
            continue  # a double root: its eigenvectors may be mixed at will
        k = int(np.argmin(np.abs(s - mode.eigenvalue)))
        shape = np.array([mode.shape[x] for x in states[:n]])
        expected = right[:n, k] * (shape @ right[:n, k].conj()) / (right[:n, k] @ right[:n, k].conj())
        assert shape == pytest.approx(expected, abs=1e-7 * np.abs(shape).max())
        product = left[:, k] * right[:, k]
        share = {x: abs(sum(product[i] for i, y in enumerate(states) if y == x)) for x in set(states)}
        assert mode.participation == pytest.approx({x: v / sum(share.values()) for x, v in share.items()}, abs=1e-6)


def test_shapes_are_scaled_to_one(table1, model):
    for mode in modes_at(Model(**model).at(table1, C_s=1e6)):
        size = {x: abs(z) * (table1["a"] if x.startswith("phi") else 1) for x, z in mode.shape.items()}
        assert max(size.values()) == pytest.approx(1)


@pytest.mark.parametrize(("equations", "apart"), [("reciprocal", 1), ("as-printed", 2)])
def test_decoupled_motors_are_named_after_how_they_move(equations, apart):
    modes = {mode.name: mode for mode in yd.modes(yd.table1(equations=equations)).modes}
    against = modes["motor yaw, against each other"]
    assert against.shape["phi_m1"] == pytest.approx(-against.shape["phi_m2"])
    assert against.participation["phi_m1"] == pytest.approx(0.5)
    assert sum(name.startswith("motor yaw, ") for name in modes) == apart
    if apart == 2:
        alike = modes["motor yaw, both alike"]
        assert alike.shape["phi_m1"] == pytest.approx(alike.shape["phi_m2"])


def test_slow_running_is_the_rolling_of_two_coupled_wheelsets(table1):
    # A bogie whose frame is rigid hunts with the wavelength of its two wheelsets, 21.6124 m with Table I.
    p = {**table1, "v": 5 / 3.6, "K_1x": 1e10, "K_1y": 1e10, "K_2x": 1.0, "K_2y": 1.0, "C_t": 1.0, "W": 1.0}
    p |= {"K_m": 1e9, "K_mphi": 1e9, "C_s": 1.0}
    modes = [mode for mode in modes_at(Model().at(p)) if mode.frequency > 0]
    hunting = min(modes, key=lambda mode: abs(mode.eigenvalue))
    assert hunting.name.startswith("wheelset hunting")
    assert hunting.frequency == pytest.approx(p["v"] / 21.61240, rel=1e-3)


def test_a_trailer_has_no_motor_modes(table1):
    modes = modes_at(Model("trailer").at(table1, C_s=1e6))
    assert sum(2 if mode.frequency else 1 for mode in modes) == 15
    assert not any("motor" in mode.name for mode in modes)


def test_modes_of_a_problem():
    problem = yd.table1()
    result, verdict = yd.modes(problem), yd.stability(problem)
    assert result.checked
    assert result.stable is verdict.stable
    assert result.modes[0].eigenvalue == pytest.approx(verdict.eigenvalues[0])
    assert result.modes == tuple(sorted(result.modes, key=lambda mode: mode.decay_rate))
    assert result.to_dict()["modes"][0]["name"] == "wheelset hunting 1"
    with pytest.raises(yd.ProblemError, match=r"bogie\.C_s is missing"):
        yd.modes(problem.replace(C_s=None))


def test_the_worst_of_a_range_of_speeds():
    problem = yd.table1().replace(speed=yd.SpeedRange(min="200 km/h", max="300 km/h"))
    assert yd.modes(problem).speed == pytest.approx(300 / 3.6)


def with_primary_dampers(p, equations, flags):
    *others, wheelsets = trailer_bogie(p, equations, flags)
    damper = Link((Maxwell(1e7, 2e4),), {"y_b": 1, "y_w": -1}, lever={"phi_b": p["a"]}, name="primary damper")
    return [*others, Pair((*wheelsets.elements, damper), own=wheelsets.own)]


def test_a_damper_that_is_new_in_the_catalogue_has_its_modes_and_outputs(monkeypatch, table1):
    monkeypatch.setitem(CATALOGUE, "with primary dampers", with_primary_dampers)
    vehicle = Model("with primary dampers").at(table1, C_s=1e6)
    modes = modes_at(vehicle)
    assert sum(2 if mode.frequency else 1 for mode in modes) == 17
    own = {mode.name for mode in modes if "primary" in mode.name}
    assert own == {"primary damper relaxation 1", "primary damper relaxation 2"}
    assert {"primary damper 1", "primary damper 2"} <= modes[0].participation.keys()
    system = System(vehicle)
    assert {"primary_damper_force_1", "primary_damper_stroke_2"} <= system.outputs.keys()
    assert system.C.shape == (len(system.outputs), 17)

"""Sweeps of a vehicle whose car body moves: numbers of an independent state matrix, axes, and what is kept."""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem.parameters import CarBody
from yawdesign.study.request import request

# The critical values of a vehicle are computed by another route, which says so itself where it is missing.
pytestmark = pytest.mark.filterwarnings("ignore:the critical lines for a picture are missing:RuntimeWarning")


@pytest.fixture(scope="module")
def vehicles(car_body):
    """Return a problem with a car body of either kind."""
    body = CarBody(**car_body)
    return {kind: replace(yd.table1(kind=kind), car_body=body).replace(C_s=1e6) for kind in ("power", "trailer")}


def spectrum(independent, problem, **changes):
    p = {**{k: float(x) for k, x in problem.parameters().items()}, "v": float(problem.speed), **changes}
    return np.linalg.eigvals(np.array(independent.equations(problem.bogie.kind, p).state_matrix(), dtype=float))


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_stable_and_decay_rate(independent, vehicles, kind):
    problem, axes = vehicles[kind], {"M_c": [20e3, 34.5e3, 60e3], "C_s": [2e4, 3e5, 2e6]}
    stable = yd.sweep(problem, of="stable", **axes)
    rate = yd.sweep(problem, of="decay_rate", **axes)
    assert stable.known.all()
    assert rate.known.all()
    for i, M_c in enumerate(axes["M_c"]):
        for j, C_s in enumerate(axes["C_s"]):
            s = spectrum(independent, problem, M_c=M_c, C_s=C_s)
            assert stable.values[i, j] == (s.real.max() < 0)
            # A decoupled motor never is the slowest here.
            assert rate.values[i, j] == pytest.approx(-s.real.max(), rel=1e-7)


def test_creep_factor_and_motors(independent, vehicles):
    problem, p = vehicles["power"], vehicles["power"].parameters()
    found = yd.sweep(problem, of="damping_ratio", creep_factor=[0.5, 1.0], f_m=[2.0, 3.0], hold="xi_m")
    ratio = p["C_m"] / (2 * np.sqrt(p["K_m"] * p["M_m"]))
    for i, factor in enumerate((0.5, 1.0)):
        for j, f_m in enumerate((2.0, 3.0)):
            K_m = p["M_m"] * (2 * np.pi * f_m) ** 2
            own = {"K_m": K_m, "C_m": 2 * ratio * np.sqrt(K_m * p["M_m"])}
            creep = {name: p[name] * factor for name in ("f_11", "f_22")}
            s = spectrum(independent, problem, **own, **creep)
            assert found.values[i, j] == pytest.approx(np.min(-s.real / np.abs(s)), rel=1e-7)


def test_critical_speed(independent, vehicles):
    """Just beside each of the speeds found, roots are on both sides of the axis."""
    problem = vehicles["trailer"]
    (speeds,) = yd.sweep(problem, of="critical_speed", h_s=[0.852]).values
    assert len(speeds) > 0
    for v in speeds:
        below, above = (spectrum(independent, problem, v=v * (1 + e)).real for e in (-1e-5, 1e-5))
        assert (below > 0).sum() != (above > 0).sum()


def test_the_car_body_matters(vehicles):
    """At conicity 0.05 the printed yaw damping is not enough under a car body that moves."""
    moving = vehicles["power"].replace(lambda_=0.05, C_s=1046770.0)
    standing = replace(moving, car_body=None)
    found = [bool(yd.sweep(x, of="stable", b_3=[1.2]).values[0]) for x in (moving, standing)]
    assert found == [False, True]


def test_two_speeds_are_one_answer(vehicles):
    several = vehicles["trailer"].replace(speed=yd.SpeedRange(min=200 / 3.6, max=300 / 3.6, steps=2))
    each = yd.sweep(vehicles["trailer"], of="decay_rate", K_2z=[5e5, 7e5], v=[200 / 3.6, 300 / 3.6]).values
    assert yd.sweep(several, of="decay_rate", K_2z=[5e5, 7e5]).values == pytest.approx(each.min(axis=1), rel=1e-12)


def test_workers_and_kept_files(vehicles, tmp_path):
    problem, axes = vehicles["trailer"], {"l_c": [8.0, 9.0, 10.0], "C_s": [1e5, 1e6]}
    here = yd.sweep(problem, of="decay_rate", **axes, resume=tmp_path / "kept.npz")
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = yd.sweep(problem, of="decay_rate", **axes, executor=pool, chunk=3)
    assert there.values == pytest.approx(here.values, rel=1e-9)  # other points are neighbours
    again = yd.sweep(problem, of="decay_rate", **axes, resume=tmp_path / "kept.npz")
    assert np.array_equal(here.values, again.values)
    for other in (replace(problem, car_body=None), problem.replace(overturning=True)):
        own = {"C_s": axes["C_s"]} if other.car_body is None else axes
        with pytest.raises(yd.ProblemError, match="belongs to another sweep"):
            yd.sweep(other, of="decay_rate", **own, resume=tmp_path / "kept.npz")


def refused(problem, name):
    with pytest.raises(yd.ProblemError) as caught:
        request(problem, "decay_rate", [(name, [1.0, 2.0])], None)
    return str(caught.value)


def test_axes_that_a_vehicle_has_not(vehicles):
    moving = vehicles["power"]
    standing = replace(moving, car_body=None)
    assert "M_c: is not part of this vehicle: give its value under car_body first" in refused(standing, "M_c")
    assert "K_2z: is not part of this vehicle: give its value under bogie first" in refused(standing, "K_2z")
    assert "C_1y: is not part of this vehicle: give its value under bogie first" in refused(moving, "C_1y")
    assert "K_ds: is rigid in the problem: give it a stiffness first" in refused(moving.replace(K_ds="rigid"), "K_ds")


@pytest.mark.parametrize("name", ["C_1x", "K_d1x", "J_wy", "I_b", "h_2t"])
def test_optional_parts_are_axes(vehicles, name):
    roll = {"I_b": 3e3, "K_1z": 1.2e6, "C_1z": 10e3, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.1}
    rest = {"C_1x": 2e4, "K_d1x": 1e7, "J_wy": 180.0}
    problem = vehicles["trailer"].replace(**(roll if name in roll else rest))
    values = [0.5 * problem.parameters()[name], problem.parameters()[name]]
    found = yd.sweep(problem, of="decay_rate", **{name: values})
    alone = [yd.stability(problem.replace(**{name: x})).decay_rate for x in values]
    assert found.values == pytest.approx(alone, rel=1e-7)
    assert found.values[0] != found.values[1]


def test_rigid_yaw_dampers(independent, vehicles):
    problem = vehicles["trailer"].replace(K_ds="rigid")
    found = yd.sweep(problem, of="decay_rate", C_s=[1e5, 1e6])
    expected = [-spectrum(independent, problem, C_s=C_s).real.max() for C_s in (1e5, 1e6)]
    assert found.values == pytest.approx(expected, rel=1e-7)

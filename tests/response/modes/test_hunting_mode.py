"""Which mode is the hunting: the one that comes from the conicity and loses its stability first."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem.table import field_name
from yawdesign.response.modes.named_modes import hunting_mode, modes_at
from yawdesign.response.run.run import hunting
from yawdesign.vehicle.vehicle import Model


def problem_of(vehicle):
    model = vehicle.model
    given = {field_name(name): vehicle.p[name] for name in model.parameters if name != "v"}
    return yd.Problem(bogie=yd.Bogie(kind=model.kind, **given), speed=vehicle.v, equations=model.equations)


@pytest.fixture(scope="module")
def vehicles(random_bogies):
    """Return random vehicles with a yaw damping, and their modes."""
    rng = np.random.default_rng(11)
    drawn = [Model(**model).at(p, C_s=float(10 ** rng.uniform(4, 6.7))) for p, model in random_bogies(150, seed=21)]
    return [(vehicle, modes_at(vehicle)) for vehicle in drawn]


def test_klingels_motion_goes_with_half_the_conicity(table1):
    rigid = {"K_1x": 1e10, "K_1y": 1e10, "K_2x": 1.0, "K_2y": 1.0, "C_t": 1.0, "W": 1.0}
    p = {**table1, "v": 5 / 3.6} | rigid
    mode = hunting_mode(modes_at(Model("trailer").at(p, C_s=1.0)))
    assert mode.conicity == pytest.approx(0.5, abs=1e-3)
    assert mode.name == "wheelset hunting 1"


def test_dependence_on_the_conicity_against_a_difference(table1, model):
    step = 1e-5
    vehicle = Model(**model).at(table1, C_s=1e6)
    near = [modes_at(vehicle.replace(lambda_=table1["lambda"] * (1 + d))) for d in (-step, step)]
    for mode in modes_at(vehicle):
        low, high = (min(modes, key=lambda m: abs(m.eigenvalue - mode.eigenvalue)) for modes in near)
        slope = abs(high.eigenvalue - low.eigenvalue) / (2 * step) / abs(mode.eigenvalue)
        assert mode.conicity == pytest.approx(slope, rel=1e-4, abs=1e-6)


def test_an_oscillation_that_grows_is_named_hunting(vehicles):
    unstable = 0
    for _, modes in vehicles:
        if modes[0].decay_rate < 0 and modes[0].frequency > 0:
            unstable += 1
            assert hunting_mode(modes) is modes[0]
            assert modes[0].name.startswith("wheelset hunting")
    assert unstable > 50


def test_hunting_is_number_one_of_its_kind(vehicles):
    for _, modes in vehicles:
        if (mode := hunting_mode(modes)) is not None:
            assert mode.name in ("wheelset hunting", "wheelset hunting 1")
            largest = max(m.conicity for m in modes if m.frequency > 0)
            assert mode.conicity >= 0.1 * largest or mode.decay_rate < 0


def test_the_run_and_the_modes_agree_on_the_hunting(vehicles):
    otherwise = 0
    for vehicle, modes in vehicles[:60]:
        problem, mode = problem_of(vehicle), hunting_mode(modes)
        assert hunting(vehicle) == pytest.approx((mode.frequency, mode.damping_ratio), rel=1e-6)
        assert yd.modes(problem).hunting == mode.name
        least = min((m for m in modes if m.frequency > 0), key=lambda m: m.damping_ratio)
        otherwise += least.frequency > 20 > mode.frequency
    assert otherwise >= 3  # the least damping ratio is often that of a fast mode that has nothing to do with hunting


def test_the_damper_is_read_where_the_bogie_hunts():
    # The frame yaws at 29.6 Hz with the least damping ratio; the motion that the conicity brings has 2.39 Hz.
    problem = yd.table1().replace(C_s="2 MN s/m")
    modes = yd.modes(problem)
    least = min((m for m in modes.modes if m.frequency > 0), key=lambda m: m.damping_ratio)
    assert (least.name, round(least.frequency, 1)) == ("frame yaw", 29.6)
    hunting = next(mode for mode in modes.modes if mode.name == modes.hunting)
    assert hunting is modes.modes[0]
    result = yd.simulate(problem, duration=2)
    assert result.runs[0].damping_ratio == pytest.approx(hunting.damping_ratio)
    assert result.damper.hunting_frequency == pytest.approx(hunting.frequency)
    assert result.damper.at_hunting.frequency == pytest.approx(2.39, abs=0.01)


def test_wheels_without_conicity_do_not_hunt():
    problem = yd.table1().replace(lambda_=0)
    assert yd.modes(problem).hunting is None
    result = yd.simulate(problem, duration=2)
    assert result.runs[0].frequency is None
    assert result.damper.at_hunting is None

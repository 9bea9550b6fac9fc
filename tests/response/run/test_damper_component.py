"""The yaw damper as a component."""

import cmath
import math

import pytest

import yawdesign as yd
from yawdesign.hunting.eigenvalues import motion_eigenvalues
from yawdesign.response.run.damper_component import dynamic_stiffness
from yawdesign.vehicle.elements import Maxwell
from yawdesign.vehicle.vehicle import Vehicle

PROBLEM = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")


def test_dynamic_stiffness_by_hand():
    K, c, f = 40e6, 1_046_770.0, 2.5
    Z = 1 / (1 / K + 1 / (c * 2j * math.pi * f))
    found = dynamic_stiffness(Maxwell(K, c), f)
    assert found.stiffness == pytest.approx(abs(Z))
    assert found.phase == pytest.approx(cmath.phase(Z))
    assert found.loss_factor == pytest.approx(Z.imag / Z.real)
    assert found.loss_factor == pytest.approx(K / (2 * math.pi * f * c))
    assert found.damping == pytest.approx(Z.imag / (2 * math.pi * f))


def test_at_the_corner_both_give_way_alike():
    damper = yd.damper_component(PROBLEM, duration=5)
    at = dynamic_stiffness(Maxwell(damper.K_ds, damper.C_s), damper.corner_frequency)
    assert at.phase == pytest.approx(math.pi / 4)
    assert at.stiffness == pytest.approx(damper.K_ds / math.sqrt(2))


def test_what_to_order():
    result = yd.simulate(PROBLEM, duration=10)
    damper = result.damper
    assert damper.checked
    assert damper.C_each == pytest.approx(523_385)
    assert damper.force_at_rated_velocity == pytest.approx(52_338.5)
    hunting = yd.stability(PROBLEM).modes[0]
    assert damper.hunting_frequency == pytest.approx(hunting.frequency)
    assert damper.at_hunting.frequency == damper.hunting_frequency
    assert [z.frequency for z in damper.over_frequency][:: len(damper.over_frequency) - 1] == [0.5, 10]
    assert damper.force_peak == result.peak["yaw_damper_force"]
    assert damper.velocity_rms == pytest.approx(damper.force_rms / damper.C_each)
    assert damper.stroke_peak == result.peak["yaw_damper_stroke"]
    assert yd.damper_component(PROBLEM, duration=10) == damper


def test_velocity_is_the_rate_of_the_stroke():
    result = yd.simulate(PROBLEM, duration=10)
    history = result.histories[0]
    rate = (history["yaw_damper_stroke"][2:] - history["yaw_damper_stroke"][:-2]) / (2 * result.runs[0].step)
    assert abs(rate).max() == pytest.approx(result.damper.velocity_peak, rel=0.01)


def test_soft_joints_decide():
    damper = yd.damper_component(PROBLEM, duration=5)
    assert damper.decay_rate == pytest.approx(1.3697336, rel=1e-6)
    rigid = Vehicle.of(PROBLEM)[0].replace(K_ds=1e15)
    assert damper.decay_rate_rigid == pytest.approx(-motion_eigenvalues(rigid, rigid.coupled).real.max(), rel=1e-3)


def test_no_damper():
    with pytest.raises(yd.ProblemError, match="no yaw damper"):
        yd.damper_component(yd.table1().replace(C_s=0, speed="100 km/h"), duration=5)

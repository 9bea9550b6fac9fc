"""Figure 3 of the paper by sweeps: both readings of part (a), part (b), and where there are several values.

The numbers are those of exact arithmetic for the model as printed at 300 km/h, in kN s/m; the curves are the figure's.
"""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.vehicle.vehicle import Vehicle

PRINTED = yd.table1(equations="as-printed")
# Of Table I's K_m and M_m; C_m is proportional to it while xi_m is held.
PAPER_FREQUENCY = np.sqrt(626_480 / 1765) / (2 * np.pi)


def curve(**arguments):
    result = yd.sweep(PRINTED, of="critical", **arguments)
    assert result.known.all()
    return [[x / 1e3 for x in values] for values in result.values]


def test_part_a_with_the_damping_held():
    found = curve(f_m=[1, 2, 2.5, 3, 4, 5, 8, 10, 1000])
    assert [x for (x,) in found] == pytest.approx([365, 281, 202, 90, 674, 705, 677, 667, 648], rel=0.01)


def test_part_a_has_several_values_where_the_motors_meet_the_hunting():
    f = np.linspace(3.2, 3.6, 81)
    several = np.array([len(values) > 1 for values in curve(f_m=f)])
    assert f[several][[0, -1]] == pytest.approx([3.26, 3.54], abs=0.0051)
    assert several[(f > 3.262) & (f < 3.538)].all()


def test_part_a_with_the_damping_ratio_held():
    f = np.geomspace(1, 300, 600)
    values = curve(f_m=f, hold="xi_m")
    assert all(len(x) == 1 for x, at in zip(values, f, strict=True) if not 3.225 < at < 3.232)
    height = np.array([x[0] for x in values])
    assert (height.min(), height.max(), height[-1]) == pytest.approx((74.7, 678, 648), rel=0.01)
    assert f[[height.argmin(), height.argmax()]] == pytest.approx([3.16, 5.5], rel=0.01)


def test_part_a_with_the_damping_ratio_held_folds_back_in_a_narrow_notch():
    f = np.linspace(3.224, 3.234, 41)
    count = np.array([len(x) for x in curve(f_m=f, hold="xi_m")])
    assert set(count[(f > 3.2259) & (f < 3.2301)]) == {3}
    assert set(count[(f < 3.225) | (f > 3.232)]) == {1}
    found = curve(f_m=[3.229, 3.3], hold="xi_m")[0]
    (vehicle,) = Vehicle.of(PRINTED)
    K_m, C_m = vehicle.p["M_m"] * (2 * np.pi * 3.229) ** 2, vehicle.p["C_m"] * 3.229 / PAPER_FREQUENCY
    single = critical_damping(vehicle.replace(v=300 / 3.6, K_m=K_m, C_m=C_m))
    assert found == pytest.approx([x.C_s / 1e3 for x in single.critical], rel=1e-9)
    assert found[::2] == pytest.approx([106, 267], rel=0.01)


def test_part_b():
    found = curve(xi_m=[0.2, 0.3, 0.4, 0.5, 1.0])
    assert [x for (x,) in found] == pytest.approx([58.9, 90.7, 274, 380, 526], rel=0.01)


def test_part_b_has_several_values_at_low_damping():
    xi = np.linspace(0.05, 0.2, 151)
    several = np.array([len(values) > 1 for values in curve(xi_m=xi)])
    assert several[xi < 0.1179].all()
    assert not several[xi > 0.1191].any()


def test_the_smallest_value_is_not_the_boundary_where_there_are_several():
    """Eq. (11) with its minimum positive root would take 12 for 358 kN s/m at 3.27 Hz."""
    design = yd.sweep(PRINTED, of="C_sl", f_m=[3.2, 3.27])
    lowest = [values[0] for values in design.boundary.values]
    assert design.values[0] == pytest.approx(lowest[0], rel=1e-9)
    assert (lowest[1] / 1e3, design.values[1] / 1e3) == pytest.approx((12.3, 357.9), rel=0.01)

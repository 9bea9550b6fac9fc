"""What Yu, Wang, Song and Zhao print: Table III and Figure 3, within what their rounding allows (docs/errata.md)."""

import math

import numpy as np
import pytest

from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.vehicle.vehicle import Model

PRINTED = Model(equations="as-printed")


def values(p):
    """Return the critical values in kN s/m."""
    return [x.C_s / 1e3 for x in critical_damping(PRINTED.at(p)).critical]


def test_table_3(table1):
    (C_sl,) = (1e3 * x for x in values(table1))
    assert C_sl == pytest.approx(90_730, rel=5e-4)
    # (14), with R = 300 m, L = 19 m, l = 60 m, V_r = 25 m/s and the axle load for Q
    p, R, L, l, V_r = table1, 300, 19, 60, 25  # noqa: E741
    resistance = 0.64 * p["W"] * p["a"] * R * l - p["C_t"] * p["b_0"] ** 2 * L * V_r - p["K_2x"] * p["b_2"] ** 2 * L * l
    C_su = resistance / (p["b_3"] ** 2 * L * V_r)
    assert C_su == pytest.approx(2_593_440, rel=2e-6)
    assert 0.382 * C_su + 0.618 * C_sl == pytest.approx(1_046_770, rel=5e-4)


def test_the_reaction_that_is_not_printed_changes_table_3(table1):
    (whole,) = critical_damping(Model().at(table1)).critical
    assert whole.C_s == pytest.approx(63_607.41, abs=0.01)


@pytest.mark.parametrize("kmh", [250, 300])
def test_the_design_value_is_stable(table1, kmh):
    intervals = critical_damping(PRINTED.at(table1, v=kmh / 3.6)).stable_intervals
    assert any(low < 1_046_770 < high for low, high in intervals)


def with_frequency(p, hertz):
    return {**p, "K_m": p["M_m"] * (2 * math.pi * hertz) ** 2}


def with_damping_ratio(p, xi):
    return {**p, "C_m": 2 * xi * math.sqrt(p["K_m"] * p["M_m"])}


@pytest.mark.parametrize(
    ("hertz", "expected"),
    [(1, 365), (2, 281), (2.5, 202), (3, 90), (4, 674), (5, 705), (8, 677), (10, 667), (1000, 648)],
)
def test_figure_3a_with_the_damping_held(table1, hertz, expected):
    assert values(with_frequency(table1, hertz)) == pytest.approx([expected], rel=0.01)


@pytest.mark.parametrize(("hertz", "several"), [(3.25, False), (3.27, True), (3.4, True), (3.53, True), (3.55, False)])
def test_figure_3a_has_a_range_with_several_values(table1, hertz, several):
    assert (len(values(with_frequency(table1, hertz))) > 1) == several


def test_figure_3a_with_the_damping_ratio_held(table1):
    frequencies = np.geomspace(1, 300, 200)
    curve = [values(with_damping_ratio(with_frequency(table1, f), 0.3)) for f in frequencies]
    # One value but in a notch a hundredth of a hertz wide, where the curve is so steep that it folds back.
    assert all(3.225 < f < 3.232 for f, c in zip(frequencies, curve, strict=True) if len(c) != 1)
    height = np.array([c[0] for c in curve])
    assert (height.min(), height.max(), height[-1]) == pytest.approx((74.7, 678, 648), rel=0.01)
    assert frequencies[[height.argmin(), height.argmax()]] == pytest.approx([3.16, 5.5], rel=0.02)


@pytest.mark.parametrize(("hertz", "several"), [(3.22, False), (3.228, True), (3.235, False)])
def test_figure_3a_with_the_damping_ratio_held_folds_back(table1, hertz, several):
    assert (len(values(with_damping_ratio(with_frequency(table1, hertz), 0.3))) > 1) == several


@pytest.mark.parametrize(("xi", "expected"), [(0.2, 58.9), (0.3, 90.7), (0.4, 274), (0.5, 380), (1.0, 526)])
def test_figure_3b(table1, xi, expected):
    assert values(with_damping_ratio(table1, xi)) == pytest.approx([expected], rel=0.01)


@pytest.mark.parametrize(("xi", "several"), [(0.12, False), (0.118, True), (0.07, True)])
def test_figure_3b_has_several_values_at_low_damping(table1, xi, several):
    assert (len(values(with_damping_ratio(table1, xi))) > 1) == several

"""The axes of a design review's maps rise and stay above zero, whatever is zero in the problem or beside its bounds."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.study import review_axes

NONE = {"C_s": 0}
TINY = {"variables": {"K_m": yd.Variable(min=5e6, max=6e6), "C_m": yd.Variable(min=100, max=200)}}


@pytest.mark.parametrize(
    "changes", [{}, {"C_m": 0}, {"K_m": 0}, NONE, {"C_m": 0, "K_m": 0}, {"design": yd.Design(**TINY)}]
)
def test_axes_of_maps_rise(changes):
    problem = yd.table1().replace(**changes)
    axes = [review_axes.dampings(problem, [], 20), *review_axes.mounts(problem, 20).values()]
    for values in axes:
        assert values[0] > 0
        assert (np.diff(values) > 0).all()


def test_a_motor_without_a_spring_has_no_damping_ratio():
    assert review_axes.mount(yd.table1().replace(K_m=0)) == (0, np.inf)


def test_the_marks_are_on_the_axis():
    values = review_axes.dampings(yd.table1(), [10.0, 5e9], 20)
    assert values[0] <= 10
    assert values[-1] >= 5e9

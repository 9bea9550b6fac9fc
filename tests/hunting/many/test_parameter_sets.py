"""Sets of parameters: in parts, under conditions, one by one."""

import numpy as np
import pytest

from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.vehicle import Model

VALUES = {"W": 2.0, "f_11": 1e7, "f_22": 2e7, "K_m": np.array([1.0, 2.0, 3.0]), "C_m": 0.0}


@pytest.fixture
def sets():
    return ParameterSets(Model(), VALUES, 3)


def test_one_of_them_is_a_vehicle_of_floats(sets):
    vehicle = sets.vehicle_at(1)
    assert vehicle.model == Model()
    assert vehicle.p == {**VALUES, "K_m": 2.0}


def test_parts(sets):
    assert sets.zeros == {"C_m"}
    part = sets.part(np.array([True, False, True]))
    assert (part.size, part.values["K_m"].tolist(), part.values["W"]) == (2, [1.0, 3.0], 2.0)
    assert [x.size for x in ParameterSets.split(Model(), VALUES, 2)] == [2, 1]
    assert sets.whole("W").tolist() == [2.0, 2.0, 2.0]


def test_what_is_alike_in_a_part_is_a_number():
    first, second = ParameterSets.split(Model(), {"K_m": np.array([1.0, 2.0, 0.0, 0.0]), "W": [5.0]}, 2)
    assert first.values["W"] == second.values["W"] == 5.0
    assert first.zeros == frozenset()
    assert second.zeros == {"K_m"}


def test_under_a_condition(sets):
    changed = sets.under(Condition((("v", 80.0), ("creep_factor", 0.5), ("W", 3.0))))
    assert {name: changed.values[name] for name in ("v", "f_11", "f_22", "W")} == {
        "v": 80.0,
        "f_11": 5e6,
        "f_22": 1e7,
        "W": 3.0,
    }
    assert changed.size == 3
    assert sets.replace(W=4.0).values["W"] == 4.0
    assert sets.values["W"] == 2.0


def test_all_at_once_are_a_vehicle_of_arrays(table1):
    K_m = table1["K_m"] * np.array([0.5, 1.0])
    sets = ParameterSets(Model(), {**table1, "K_m": K_m, "C_s": 1e5}, 2)
    whole = sets.vehicle.coupled.polynomial(1e5)
    for k in range(2):
        own = sets.vehicle_at(k).coupled.polynomial(1e5)
        assert [np.broadcast_to(a, 2)[k] for a in whole] == pytest.approx(own, rel=1e-14)

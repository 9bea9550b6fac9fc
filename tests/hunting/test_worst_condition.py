"""The worst of all conditions, against every point of dense grids of matrices that are written a second time."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.worst_condition import exceeds_everywhere, worst_conditions
from yawdesign.problem.conditions import condition_set
from yawdesign.vehicle.vehicle import Model

BOTH = ("decay_rate", "damping_ratio")
RANGES = {"lambda": {"min": 0.05, "max": 0.40}, "creep_factor": {"min": 0.5, "max": 1.0}}


def asked(problem, objective="decay_rate", **measure):
    p = {name: float(x) for name, x in problem.parameters().items()}
    variables = tuple(problem.design.variables)
    return Model.of(problem), p, condition_set(problem), Measure(objective, variables, **measure)


def grid_margins(independent, p, objective, speeds, conicities, creep, **more):
    """Return the margins of every combination, all modes counted."""
    names = ("v", "lambda", "creep_factor", *more)
    x = np.array(list(product(speeds, conicities, creep, *more.values()))).T
    values = dict(zip(names, x, strict=True))
    q = {**p, **values} | {name: values["creep_factor"] * p[name] for name in ("f_11", "f_22")}
    s = independent.eigenvalues("power", q)
    return (-s.real / abs(s)).min(axis=1) if objective == "damping_ratio" else -s.real.max(axis=1)


@given(
    st.floats(0.02, 0.3),
    st.floats(0.03, 0.3),
    st.floats(0.3, 0.9),
    st.floats(4.5, 6.4),
    st.floats(-0.5, 0.5),
    st.sampled_from(BOTH),
)
@settings(max_examples=5, deadline=None)
def test_nothing_of_a_grid_is_worse(independent, low, width, creep, damping, motors, objective):
    """Of any box of conditions and any design; what is found is there, and within the box."""
    problem = yd.table1().replace(
        conditions={"lambda": {"min": low, "max": low + width}, "creep_factor": {"min": creep, "max": 1.0}},
        C_s=10**damping,
        K_m=626480 * 10**motors,
    )
    model, p, conditions, measure = asked(problem, objective)
    found = worst_conditions(model, p, conditions, measure)
    worst = found[0].margin
    grid = grid_margins(
        independent, p, objective, [300 / 3.6], np.linspace(low, low + width, 16), np.linspace(creep, 1, 16)
    )
    assert grid.min() >= worst - 1e-3 * abs(worst)
    assert [one.margin for one in found] == sorted(one.margin for one in found)
    for one in found:
        v, conicity, share = (float(one.condition.described[name]) for name in ("speed", "lambda", "creep_factor"))
        assert low <= conicity <= low + width * (1 + 1e-12)
        assert creep <= share <= 1
        there = grid_margins(independent, p, objective, [v], [conicity], [share])[0]
        assert one.margin == pytest.approx(there, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("objective", BOTH)
def test_lists_are_looked_at_one_by_one(independent, objective):
    lists = {"lambda": [0.05, 0.2, 0.4], "creep_factor": [1, 0.6]}
    problem = replace(yd.table1(), speed=(200 / 3.6, 300 / 3.6)).replace(conditions=lists, C_s=1.5e6)
    model, p, conditions, measure = asked(problem, objective)
    found = worst_conditions(model, p, conditions, measure)
    every = grid_margins(independent, p, objective, (200 / 3.6, 300 / 3.6), *lists.values())
    combinations = list(product((200 / 3.6, 300 / 3.6), *lists.values()))
    assert found[0].margin == pytest.approx(every.min(), rel=1e-6)
    assert tuple(found[0].condition.described.values()) == pytest.approx(combinations[every.argmin()])


def test_a_worst_speed_narrower_than_two_points_of_any_coarse_grid(narrow_bogie, independent):
    """Unstable within 1.4 km/h of 350 that are looked at."""
    problem = yd.table1().replace(**narrow_bogie)
    problem = problem.replace(speed=yd.SpeedRange(min="50 km/h", max="400 km/h", steps=2))
    model, p, conditions, measure = asked(problem)
    narrow = replace(conditions, ranges=(("v", (210 / 3.6, 235 / 3.6)),))
    found = worst_conditions(model, p, narrow, measure)[0]
    assert found.margin < 0
    assert 219.72 < 3.6 * found.condition.speed < 221.12
    every = grid_margins(independent, p, "decay_rate", np.linspace(219, 222, 301) / 3.6, [p["lambda"]], [1.0])
    assert found.margin == pytest.approx(every.min(), abs=1e-5)
    assert found.margin <= every.min() + 1e-9
    # The verdicts on the grid alone say no more than the points that they are of.
    assert not exceeds_everywhere(model, p, conditions, measure, 0.5)
    assert exceeds_everywhere(model, p, conditions, measure, -5.0)


def test_a_worst_condition_inside_both_ranges(independent):
    """Where the worst creep lies between the ends, the descent from the grid reaches it to many digits."""
    problem = yd.table1().replace(conditions=RANGES, C_s=2_593_442.98, K_m=6_264_800.0, C_m=25_223.0)
    model, p, conditions, measure = asked(problem)
    found = worst_conditions(model, p, conditions, measure)[0]
    assert found.condition.described["lambda"] == pytest.approx(0.05)
    creep = found.condition.described["creep_factor"]
    assert creep == pytest.approx(0.528, abs=1e-3)
    near = grid_margins(independent, p, "decay_rate", [300 / 3.6], [0.05], creep + np.linspace(-0.01, 0.01, 201))
    assert found.margin == pytest.approx(near.min(), rel=1e-7)


def test_a_fault_and_modes_left_out():
    problem = yd.table1().replace(conditions=RANGES, cases={"lost": {"C_s": "50 %"}}, C_s=2e6)
    model, p, conditions, measure = asked(problem, case=problem.cases[0])
    weaker = asked(problem.replace(C_s=1e6, cases=()))[1]
    healthy = Measure("decay_rate", measure.variables)
    half = worst_conditions(model, weaker, conditions, healthy)[0].margin
    assert worst_conditions(model, p, conditions, measure)[0].margin == pytest.approx(half, rel=1e-9)
    behind = Measure("decay_rate", measure.variables, pairs=1)
    assert worst_conditions(model, p, conditions, behind)[0].margin > 0
    assert worst_conditions(model, p, conditions, behind)[0].margin > half


class OneLowCorner:
    """A margin that is nearly the same everywhere, and less at one corner of four ranges."""

    by_eigenvalues = False

    def __init__(self, **corner):
        self.corner = corner

    def of(self, sets):
        there = np.all([np.isclose(sets.whole(name), end) for name, end in self.corner.items()], axis=0)
        return np.where(there, 0.8, 1 + 0.0005 * sets.whole("v"))

    def exceeds(self, sets, level):
        return self.of(sets) > level, np.ones(sets.size, dtype=bool)


@pytest.mark.parametrize("conicity", [0.1, 0.2])
@pytest.mark.parametrize("v", [40.0, 80.0])
def test_a_corner_is_found_though_thousands_of_conditions_are_nearly_as_low(v, conicity):
    ranges = {"lambda": {"min": 0.1, "max": 0.2}, "K_1x": {"min": 3e7, "max": 5e7}, "K_1y": {"min": 5e6, "max": 7e6}}
    problem = yd.table1().replace(conditions=ranges, speed={"min": "40 m/s", "max": "80 m/s"})
    model, p, conditions, _ = asked(problem)
    corner = {"lambda": conicity, "K_1x": 3e7, "K_1y": 7e6}
    found = worst_conditions(model, p | {"C_s": 1e6}, conditions, OneLowCorner(v=v, **corner))[0]
    assert found.margin == 0.8
    assert found.condition.described == pytest.approx({"speed": v, **corner})

"""Critical speeds under all conditions, against dense looks by eigenvalues and by the field of critical speeds."""

from dataclasses import replace

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting import stable_speeds as module
from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.many.critical_speeds import critical_speeds
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.stable_speeds import stable_speeds
from yawdesign.problem.cases import as_cases

KMH = 1 / 3.6
LISTS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1.0, 0.7, 0.5]}
RANGES = {"lambda": {"min": 0.05, "max": 0.40}, "creep_factor": {"min": 0.5, "max": 1.0}}


def problem(C_s, **more):
    return replace(yd.table1(), **more).replace(C_s=C_s)


def judged(given, case=None):
    return Judged(given, {name: float(value) for name, value in given.parameters().items()}, case)


def test_the_critical_speed_at_the_critical_damping_is_the_speed():
    printed = yd.table1(equations="as-printed").replace(C_s=90702.8897786979)
    found = yd.critical_speed(printed)
    assert found.stable_up_to == pytest.approx(300 * KMH, rel=1e-8)
    (one,) = found.critical_speeds
    assert (one.v, one.becomes, one.condition) == (found.stable_up_to, "unstable", {})
    assert one.omega == pytest.approx(23.15473658, rel=1e-7)
    assert found.worst_condition == {"speed": found.stable_up_to}
    assert found.speed_wanted == pytest.approx(330 * KMH)
    assert not found.reaches
    assert found.checked


def test_all_speeds_of_one_condition(narrow_bogie):
    given = yd.table1().replace(**narrow_bogie)
    found = yd.critical_speed(given)
    assert [x.becomes for x in found.critical_speeds] == ["unstable", "stable", "unstable"]
    assert [3.6 * x.v for x in found.critical_speeds[:2]] == pytest.approx([219.724254, 221.119203], abs=1e-5)
    assert found.stable_up_to == found.critical_speeds[0].v
    assert found.checked


def dense(given, steps=601):
    """Return speeds, and where all listed conditions are stable at them by eigenvalues."""
    one = judged(given)
    v = np.linspace(10, 600, steps) * KMH
    ways = [(x.with_values({"v": v}), len(v)) for x in one.conditions.without({"v"}).corners]
    margin = Measure("decay_rate", one.model.parameters).of(under_conditions(one.model, one.p, ways))
    return v, (margin.reshape(len(ways), -1) > 0).all(axis=0)


@pytest.mark.parametrize("C_s", [2e5, 1.3e6, 4e6])
def test_what_bounds_the_stable_speeds_under_listed_conditions(C_s):
    given = problem(C_s, conditions=LISTS)
    found = yd.critical_speed(given)
    v, stable = dense(given)
    changes = np.flatnonzero(np.diff(stable))
    assert len(changes) == len(found.critical_speeds)
    for k, x in zip(changes, found.critical_speeds, strict=True):
        assert v[k] <= x.v <= v[k + 1]
        assert x.becomes == ("stable" if stable[k + 1] else "unstable")
        one = judged(given)
        at = one.at(
            next(c for c in one.conditions.lists if c.described.items() >= x.condition.items()).with_values({"v": x.v})
        )
        assert np.min(np.abs(np.array(at.eigenvalues) - 1j * x.omega)) < 1e-6 * x.omega
    assert found.stable_up_to == (0 if not stable[0] else found.critical_speeds[0].v if len(changes) else None)
    assert found.checked


def test_a_gap_that_another_condition_fills():
    """What one condition makes stable again does not count while another is unstable."""
    given = problem(1.3e6, conditions={"lambda": [0.10], "creep_factor": [0.5]})
    fast = yd.critical_speed(given)
    both = yd.critical_speed(replace(given, conditions=LISTS))
    assert len(both.critical_speeds) <= 2
    assert fast.stable_up_to is None or both.stable_up_to <= fast.stable_up_to


def test_ranges_are_searched_inside():
    given = problem(1.3e6, conditions=RANGES)
    found = yd.critical_speed(given)
    one, rng, n = judged(given), np.random.default_rng(1), 400
    (condition,) = one.conditions.without({"v"}).lists
    values = {
        "lambda": rng.uniform(0.15, 0.4, n),
        "creep_factor": np.where(np.arange(n) % 2, 0.5, rng.uniform(0.5, 0.6, n)),
    }
    sets = under_conditions(one.model, {**one.p, "v": 1.0}, [(condition.with_values(values), n)])
    least = np.nanmin(critical_speeds(sets, (10 * KMH, 600 * KMH)).critical)
    corners = yd.critical_speed(replace(given, conditions=LISTS)).stable_up_to
    assert found.stable_up_to <= least * (1 + 1e-9)
    assert found.stable_up_to == pytest.approx(least, rel=1e-3)
    assert found.stable_up_to < corners
    assert found.worst_condition == pytest.approx(
        {"lambda": 0.24608, "creep_factor": 0.5, "speed": 351.81034 * KMH}, rel=1e-4
    )
    assert [x.v for x in found.critical_speeds] == [found.stable_up_to]
    assert found.checked
    assert "no proof" in found.conditions


@pytest.mark.slow
def test_many_listed_conditions_are_those_of_few(monkeypatch):
    given = problem(1.3e6, conditions=LISTS)
    few = yd.critical_speed(given)
    monkeypatch.setattr(module, "FEW_CORNERS", 1)
    many = yd.critical_speed(given)
    assert many.stable_up_to == pytest.approx(few.stable_up_to, rel=1e-9)
    assert [x.v for x in many.critical_speeds] == [many.stable_up_to]


def test_none_up_to_the_highest_speed():
    found = yd.critical_speed(problem(1.3e6))
    assert (found.stable_up_to, found.critical_speeds, found.reaches) == (None, (), True)
    assert found.to_dict()["stable_up_to"] is None
    assert found.searched == pytest.approx((10 * KMH, 600 * KMH))
    least = min(found.decay_rates)
    margin = -yd.stability(problem(1.3e6, speed=found.worst_condition["speed"])).spectral_abscissa
    assert margin <= least * (1 + 1e-6)


def test_more_is_searched_where_more_is_required():
    given = problem(1.3e6, requirements={"critical_speed": "350 km/h"})
    found = yd.critical_speed(given)
    assert 3.6 * found.searched[1] == pytest.approx(700)
    assert found.requirements[0].met


def test_unstable_at_the_lowest_speed():
    """Motors that nothing damps are unstable, or at the boundary, at any speed."""
    found = yd.critical_speed(problem(1.3e6).replace(C_mphi=0, K_mphi=1e6))
    assert found.stable_up_to == 0
    assert not found.reaches
    assert found.worst_condition["speed"] == pytest.approx(10 * KMH)


def test_requirements_with_faults():
    cases = {"one lost": {"C_s": "50 %", "K_ds": "50 %"}, "all lost": {"C_s": "0 %"}}
    required = {"critical_speed": "300 km/h", "cases": {"critical_speed": "200 km/h"}}
    given = problem(1.3e6, conditions=LISTS, cases=cases, requirements=required)
    own, of_cases = yd.critical_speed(given).requirements
    assert (own.reached, own.met, own.case) == (yd.critical_speed(given).stable_up_to, True, None)
    p = given.bogie
    each = {
        name: yd.critical_speed(replace(given, cases=(), requirements=()).replace(**changes)).stable_up_to
        for name, changes in {"one lost": {"C_s": p.C_s / 2, "K_ds": p.K_ds / 2}, "all lost": {"C_s": 0.0}}.items()
    }
    worst = min(each, key=lambda name: each[name])
    assert of_cases.case == worst
    assert of_cases.reached == pytest.approx(each[worst], rel=1e-9)
    assert of_cases.met == (each[worst] >= 200 * KMH)


def test_speeds_that_are_off_are_not_verified(monkeypatch):
    given, asked = problem(2e5), critical_speeds
    assert stable_speeds(judged(given)).checked

    def too_low(sets, searched):
        field = asked(sets, searched)
        return replace(field, critical=0.99 * field.critical)

    monkeypatch.setattr(module, "critical_speeds", too_low)
    assert not stable_speeds(judged(given)).checked


def test_a_condition_that_is_no_limit_need_not_be_sure():
    """Where conditions are ranges, a corner of which the speed far above the limit is not sure spoils no answer."""
    conditions = {
        "lambda": {"min": 0.05, "max": 0.40},
        "creep_factor": [0.6, 1.0],
        "tolerance": {"C_s": 0.15},
        "load": {"tare": {"W": 180e3}, "laden": {"W": 200e3}},
    }
    found = yd.critical_speed(problem(1.2e6, conditions=conditions).replace(K_ds=28e6))
    assert found.stable_up_to == pytest.approx(98.86195, rel=1e-6)
    assert found.worst_condition["lambda"] == pytest.approx(0.173, abs=1e-3)
    assert found.checked


@pytest.mark.slow
def test_under_a_car_body_with_a_fault_in_ranges(car_body):
    given = problem(1.3e6, conditions=RANGES, car_body=yd.CarBody(**car_body))
    (case,) = as_cases({"one lost": {"C_s": "50 %", "K_ds": "50 %"}})
    for fault in (None, case):
        one = judged(given, fault)
        found = stable_speeds(one)
        assert found.checked
        rng = np.random.default_rng(0)
        v = rng.uniform(found.searched[0], found.up_to * (1 - 1e-6), 4000)
        values = {"v": v, "lambda": rng.uniform(0.05, 0.4, 4000), "creep_factor": rng.uniform(0.5, 1, 4000)}
        sets = under_conditions(one.model, one.p, [(one.conditions.lists[0].with_values(values), 4000)])
        assert one.every_mode.of(sets).min() > -1e-6

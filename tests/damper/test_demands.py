"""Requirements as levels: verdicts, shortfalls and merits say the same, for designs that meet, miss or are unstable."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.damper.demands import Demanded, demands
from yawdesign.damper.design_space import MISSED, UNSTABLE, Space
from yawdesign.vehicle.vehicle import Model

CONDITIONS = {"lambda": [0.05, 0.4], "creep_factor": [1, 0.5]}
FAULTS = {"one lost": {"C_s": "50 %", "K_ds": "50 %"}, "all lost": {"C_s": "0 %"}}
WANTED = {
    "decay_rate": 0.5,
    "damping_ratio": "4 %",
    "critical_speed": "310 km/h",
    "cases": {"damping_ratio": "1 %", "decay_rate": 0},
}
SOME = [WANTED, {"cases": {"decay_rate": 1}}, {"critical_speed": "150 km/h"}, {}]
PROBLEM = yd.table1().replace(cases=FAULTS, conditions=CONDITIONS)


def space_of(wanted, objective="decay_rate", **more):
    design = yd.Design(objective=objective, variables=PROBLEM.design.variables)
    return Space(PROBLEM.replace(requirements=wanted, design=design, **more))


def drawn(space, n, seed):
    """Return random designs of a space: C_s over all decades, so that many are unstable and some lie at the limit."""
    x = np.random.default_rng(seed).random((len(space.names), n))
    values = space.values(x)
    return values, space._sets(values)[0]


def roots(independent, values, n, condition, **fault):
    p = {name: np.broadcast_to(x, n) for name, x in values.items()}
    q = {name: float(x[0]) if np.ptp(x) == 0 else x for name, x in p.items()}
    q |= {name: share * q[name] for name, share in fault.items()}
    q |= {name: condition["creep_factor"] * q[name] for name in ("f_11", "f_22")}
    q |= {"lambda": condition["lambda"], "v": condition["v"]}
    return independent.eigenvalues("power", q)


def every_condition(speeds=(300 / 3.6,)):
    pairs = [(a, b) for a in CONDITIONS["lambda"] for b in CONDITIONS["creep_factor"]]
    return [{"lambda": a, "creep_factor": b, "v": v} for a, b in pairs for v in speeds]


@pytest.mark.parametrize(("name", "wanted"), [("decay_rate", 0.5), ("damping_ratio", 0.04)])
def test_shortfalls_by_hand(name, wanted, independent):
    """What is missed, in units of what is wanted; an unstable design misses by the rate at which it grows."""
    space = space_of({"cases": {name: wanted}})
    values, sets = drawn(space, 60, seed=2)
    for one, fault in zip(space.demanded, ({"C_s": 0.5, "K_ds": 0.5}, {"C_s": 1e-9}), strict=True):
        s = [roots(independent, values, 60, condition, **fault) for condition in every_condition()]
        rate = np.min([-x.real.max(axis=1) for x in s], axis=0)
        ratio = np.min([(-x.real / abs(x)).min(axis=1) for x in s], axis=0)
        reached = rate if name == "decay_rate" else np.where(ratio < 0, wanted * rate, ratio)
        assert one.shortfall(sets) == pytest.approx((wanted - reached) / wanted, rel=1e-4, abs=1e-4)
        assert np.any(rate < 0)


def test_a_critical_speed_is_looked_at_from_the_lowest_speed_on():
    (one,) = demands(PROBLEM.replace(requirements={"critical_speed": "310 km/h"}), Model())
    assert dict(one.conditions.ranges)["v"] == pytest.approx((10 / 3.6, 310 / 3.6))
    assert one.measure.variables == Model().parameters  # of all motions
    assert 0 < one.level < 1e-4


def test_each_fault_is_a_demand_of_its_own():
    found = demands(PROBLEM.replace(requirements=WANTED), Model())
    assert [(one.requirement.name, one.measure.case and one.measure.case.name) for one in found] == [
        ("decay_rate", None),
        ("damping_ratio", None),
        ("critical_speed", None),
        *((f"cases.{name}", case) for name in ("damping_ratio", "decay_rate") for case in FAULTS),
    ]
    assert [one.level for one in found[:2]] == [0.5, 0.04]
    assert found[-1].level > 0  # no more than stability is wanted: a little more is asked, so that it surely holds


@given(st.integers(0, 10**6), st.floats(-1, 8))
@settings(max_examples=6, deadline=None)
def test_verdicts_are_those_of_the_shortfall(seed, short):
    space = space_of(WANTED)
    _, sets = drawn(space, 40, seed)
    for one in space.demanded:
        missed = one.shortfall(sets)
        levels = np.where(np.arange(40) % 2, short, missed * 1.01 + np.where(np.arange(40) % 4, 0.01, -0.02))
        levels = np.maximum(levels, 0.0)
        sure = abs(missed - levels) > 1e-5
        assert np.array_equal(one.met_within(sets, levels)[sure], (missed < levels)[sure])


@given(
    st.sampled_from([WANTED, {"cases": {"decay_rate": 1}}, {"critical_speed": "150 km/h"}, {}]), st.integers(0, 10**6)
)
@settings(max_examples=8, deadline=None)
def test_a_design_beats_a_level_if_its_merit_does(wanted, seed):
    space = space_of(wanted, ("decay_rate", "damping_ratio")[seed % 2])
    values, _ = drawn(space, 60, seed)
    merit = space.margins(values)
    rng = np.random.default_rng(seed)
    near = merit + abs(merit) * 10.0 ** rng.uniform(-4, 0, 60) * rng.choice([-1, 1], 60)
    levels = [near, rng.permutation(near), -MISSED * (1 + rng.uniform(0, 1.2 * UNSTABLE, 60))]
    for level in levels:
        sure = abs(merit - level) > 1e-5 * abs(merit)
        if wanted:
            sure &= (level > 0) | (level < -MISSED)  # no merit lies between
        elif space.objective == "damping_ratio":
            sure &= level > 0  # a ratio below zero counts as zero
        assert np.array_equal(space.beats(values, level)[sure], (merit > level)[sure])


def test_a_stable_design_is_worth_more_than_an_unstable_one():
    """Whatever is missed; and any that meets everything is worth more than any that misses something."""
    space = space_of({"damping_ratio": "5.5 %", "cases": {"damping_ratio": "3 %"}})
    values, sets = drawn(space, 500, seed=5)
    merit, stable = space.margins(values), space.steady.of(sets) > 0
    met = np.all([one.shortfall(sets) <= 0 for one in space.demanded], axis=0)
    missed = stable & ~met
    assert np.all(merit[missed] < -MISSED)
    assert merit[~stable].max() < merit[missed].min()
    assert missed.any()
    assert (~stable).any()
    assert np.array_equal(merit > -MISSED, met & stable)


def test_what_has_to_be_reached_by_no_condition_is_no_demand():
    space = space_of({})
    assert space.demanded == ()
    assert Space(PROBLEM.replace(requirements=WANTED), demanding=False).demanded == ()


def test_one_condition_is_enough_to_miss():
    demand = demands(PROBLEM.replace(requirements={"decay_rate": 0.5}), Model())[0]
    space = space_of({})
    _, sets = drawn(space, 50, seed=9)
    each = [Demanded(demand, [condition]).shortfall(sets) for condition in space.conditions]
    together = Demanded(demand, space.conditions)
    assert together.shortfall(sets) == pytest.approx(np.max(each, axis=0), rel=1e-9)
    assert np.array_equal(together.met_within(sets, np.zeros(50)), np.all(np.array(each) < 0, axis=0))

"""Worst margins of many designs, by measures and without early ends, against loops over designs and conditions."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.hunting.many import worst_margin
from yawdesign.hunting.many.measure import Measure, parts_by_zeros
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin, under_conditions
from yawdesign.problem.cases import as_cases
from yawdesign.problem.condition import Condition, Load
from yawdesign.vehicle.vehicle import Model

VARIABLES = ("C_s", "K_m", "C_m")
BOTH = ("decay_rate", "damping_ratio")
HEAVY = Load("heavy", (("W", 150e3), ("M_b", 9000.0)))
CONDITIONS = [
    Condition((("v", v), ("lambda", conicity), ("creep_factor", creep)), load)
    for v, conicity, creep, load in product((200 / 3.6, 300 / 3.6), (0.05, 0.4), (1.0, 0.5), (None, HEAVY))
]
LOST = as_cases({"lost": {"C_s": "50 %", "K_ds": "50 %"}})[0]


@pytest.fixture
def drawn(table1):
    """Return random designs: numbers, and the sets that hold them."""

    def draw(n, seed=0):
        rng, p = np.random.default_rng(seed), {name: x for name, x in table1.items() if name != "v"}
        p["C_s"] = 10 ** rng.uniform(4, 6.5, n)
        p["K_m"] = 626480 * 10 ** rng.uniform(-1, 1, n)
        return p, ParameterSets(Model(), p, n)

    return draw


def by_hand(independent, p, k, condition, objective, fault):
    q = {name: float(x[k]) if np.ndim(x) else x for name, x in p.items()}
    q |= dict(condition.load.changes) if condition.load else {}
    given = dict(condition.changes)
    q |= {"v": given["v"], "lambda": given["lambda"]}
    q |= {name: given["creep_factor"] * q[name] for name in ("f_11", "f_22")}
    q |= {name: 0.5 * q[name] for name in (("C_s", "K_ds") if fault else ())}
    s = independent.eigenvalues("power", q)[0]
    return (-s.real / abs(s)).min() if objective == "damping_ratio" else -s.real.max()


@pytest.mark.parametrize("objective", BOTH)
@pytest.mark.parametrize("fault", [None, LOST], ids=["whole", "one lost"])
def test_the_worst_of_a_loop(independent, drawn, objective, fault):
    p, sets = drawn(6)
    worst = WorstMargin(CONDITIONS, Measure(objective, VARIABLES, fault))
    table = [[by_hand(independent, p, k, one, objective, fault) for k in range(6)] for one in CONDITIONS]
    assert worst.under_each(sets) == pytest.approx(np.array(table), rel=1e-6, abs=1e-7)
    margin, which = worst.worst(sets)
    assert margin == pytest.approx(np.min(table, axis=0), rel=1e-6, abs=1e-7)
    assert np.array_equal(which, np.argmin(table, axis=0))
    assert np.array_equal(worst.of(sets), margin)  # in the order of what was learnt as well


@given(st.sampled_from(BOTH), st.booleans(), st.integers(1, 3), st.integers(0, 10**6))
@settings(max_examples=10, deadline=None)
def test_a_level_is_exceeded_where_the_worst_margin_exceeds_it(drawn_sets, objective, fault, together, seed):
    sets = drawn_sets(50, seed)
    rng = np.random.default_rng(seed)
    worst = WorstMargin(CONDITIONS, Measure(objective, VARIABLES, LOST if fault else None))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worst_margin, "TOGETHER", (1, 200, 8192)[together - 1])
        margin = worst.of(sets)
        level = margin + np.abs(margin) * 10.0 ** rng.uniform(-5, 1, 50) * rng.choice([-1, 1], 50)
        exceeds = worst.exceeds(sets, level)
    wanted = margin > (np.maximum(level, 0) if objective == "damping_ratio" else level)
    assert np.array_equal(exceeds, wanted)


@pytest.fixture(scope="module")
def drawn_sets():
    from yawdesign import table1

    numbers = {name: float(x) for name, x in table1().bogie.parameters().items()}

    def draw(n, seed):
        rng = np.random.default_rng(seed)
        p = {**numbers, "C_s": 10 ** rng.uniform(4, 6.5, n), "K_m": 626480 * 10 ** rng.uniform(-1, 1, n)}
        return ParameterSets(Model(), p, n)

    return draw


def test_conditions_follow_each_other(table1):
    ways = [
        (Condition((("v", 50.0),)), 2),
        (Condition((("v", np.array([60.0, 70.0, 80.0])), ("tolerance.K_m", 0.1))), 3),
    ]
    sets = under_conditions(Model(), table1, ways)
    assert sets.size == 5
    assert sets.values["v"].tolist() == [50, 50, 60, 70, 80]
    assert sets.values["K_m"] == pytest.approx(table1["K_m"] * np.array([1, 1, 1.1, 1.1, 1.1]))
    assert sets.values["C_m"] == table1["C_m"]  # one number for all stays one


@pytest.mark.parametrize("objective", BOTH)
def test_a_floor_rules_out(drawn, objective):
    """Where the margin of all roots is below it, that of the others counts as minus infinity, and exceeds nothing."""
    _, sets = drawn(80)
    here = sets.under(CONDITIONS[5])
    every = Measure(objective, VARIABLES).of(here)
    floor = float(np.median(every[every > 0]))
    measure = Measure(objective, VARIABLES, pairs=1, floor=floor)
    margin, behind = measure.of(here), Measure(objective, VARIABLES, pairs=1).of(here)
    assert np.array_equal(margin, np.where(every < floor, -np.inf, behind))
    kept, near = np.isfinite(margin), abs(every - floor) < 1e-6
    for share, wanted in ((-1e-4, kept), (1e-4, np.zeros(80, dtype=bool))):
        level = np.where(kept, behind + share * abs(behind), 0.0)
        assert np.array_equal(measure.exceeds(here, level)[0][~near], wanted[~near])


def test_designs_without_a_damper_are_taken_apart(drawn):
    p, _ = drawn(6)
    p["C_m"] = np.array([0.0, 2e4, 0.0, 2e4, 1e4, 0.0])
    p["v"] = 300 / 3.6
    parts = [
        (place.tolist(), np.ndim(part.values["C_m"])) for place, part in parts_by_zeros(ParameterSets(Model(), p, 6))
    ]
    assert sorted(parts) == [([0, 2, 5], 0), ([1, 3, 4], 1)]
    measure, together = Measure("decay_rate", VARIABLES), ParameterSets(Model(), p, 6)
    alone = [measure.of(together.part(np.array([k])))[0] for k in range(6)]
    assert measure.of(together) == pytest.approx(alone, rel=1e-9)
    yes, _ = measure.exceeds(together, np.array(alone) - 1e-4)
    no, _ = measure.exceeds(together, np.array(alone) + 1e-4)
    assert yes.all()
    assert not no.any()


def test_doubtful_verdicts_are_left_to_the_eigenvalues(drawn, monkeypatch):
    """Where no verdict is sure, the worst margin is the same."""
    _, sets = drawn(20)
    worst = WorstMargin(CONDITIONS, Measure("decay_rate", VARIABLES)).of(sets)
    unsure = np.array([[True], [False]])
    monkeypatch.setattr(Measure, "exceeds", lambda own, here, level: unsure & np.ones(here.size, dtype=bool))
    assert WorstMargin(CONDITIONS, Measure("decay_rate", VARIABLES)).of(sets) == pytest.approx(worst, rel=1e-12)

"""Verdicts under all conditions, against plain loops over state matrices that are written a second time."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting import all_conditions
from yawdesign.hunting.all_conditions import Judged, case_verdicts, worst_verdict
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.requirements import requirement_verdicts
from yawdesign.problem.condition import Condition

CONICITIES, CREEP = (0.05, 0.15, 0.40), (1.0, 0.5)
LOADS = {"tare": {"W": 120e3}, "laden": {"W": 200e3, "M_b": 9000.0}}
CASES = {"one lost": {"C_s": "50 %", "K_ds": "50 %"}, "all lost": {"C_s": "0 %"}}
LISTS = {"lambda": list(CONICITIES), "creep_factor": list(CREEP), "load": LOADS}
RANGES = {"lambda": {"min": 0.05, "max": 0.40}, "creep_factor": {"min": 0.5, "max": 1.0}}
SPEEDS = (200 / 3.6, 300 / 3.6)
BODY = {"J_c": 1.521e6, "I_c": 124304, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97, "K_2z": 610e3, "C_2z": 9800}


def problem(**more):
    return replace(yd.table1(), **more).replace(C_s=1.3e6)


def numbers(given):
    return {name: float(value) for name, value in given.parameters().items()}


def brute_force(independent, p, fault=()):
    """Return decay rate and damping ratio under every combination, from one state matrix each."""
    found = {}
    for v, conicity, creep, load in product(SPEEDS, CONICITIES, CREEP, LOADS):
        q = {**p, **LOADS[load], "lambda": conicity, "v": v}
        q |= {name: creep * q[name] for name in ("f_11", "f_22")}
        q |= {name: share * q[name] for name, share in fault}
        s = np.linalg.eigvals(np.array(independent.equations("power", q).state_matrix(), dtype=float))
        found[v, conicity, creep, load] = -s.real.max(), (-s.real / np.abs(s)).min()
    return found


@pytest.mark.parametrize("few", [all_conditions.FEW, 1], ids=["every one looked at", "searched in arrays"])
def test_every_combination_with_faults(independent, monkeypatch, few):
    monkeypatch.setattr(all_conditions, "FEW", few)
    given = problem(conditions=LISTS, cases=CASES, speed=SPEEDS)
    result = yd.stability(given)
    for found, fault in zip((result, *result.cases), ((), (("C_s", 0.5), ("K_ds", 0.5)), (("C_s", 0.0),)), strict=True):
        expected = brute_force(independent, numbers(given), fault)
        rates, ratios = ({key: x[k] for key, x in expected.items()} for k in (0, 1))
        worst = min(rates, key=rates.get)
        assert found.decay_rate == pytest.approx(rates[worst], rel=1e-6)
        assert found.damping_ratio == pytest.approx(min(ratios.values()), rel=1e-6)
        assert found.stable == (rates[worst] > 0)
        named = dict(zip(("speed", "lambda", "creep_factor", "load"), worst, strict=True))
        assert found.worst_condition == pytest.approx(named) or found.worst_condition == named
        assert found.checked
    assert result.searched.startswith("all 24 conditions")
    assert result.spectral_abscissa == pytest.approx(-result.decay_rate, rel=1e-9)
    assert result.speed == result.worst_condition["speed"]
    assert -max(s.real for s in result.eigenvalues) == pytest.approx(result.decay_rate, rel=1e-9)


def test_under_a_car_body_with_a_fault_of_one_bogie(independent):
    lists = {"lambda": [0.1, 0.4], "creep_factor": [1.0, 0.5]}
    given = problem(
        conditions=lists,
        cases={"leading lost": {"leading.C_s": "50 %", "leading.K_ds": "50 %"}},
        car_body=yd.CarBody(M_c=34500, **BODY),
    )
    result, rates = yd.stability(given), {}
    for conicity, creep in product(*lists.values()):
        q = {**numbers(given), "lambda": conicity, "v": 300 / 3.6}
        q |= {name: creep * q[name] for name in ("f_11", "f_22")}
        s = np.linalg.eigvals(np.array(independent.equations("power", q).state_matrix(), dtype=float))
        rates[conicity, creep] = -s.real.max()
    assert result.decay_rate == pytest.approx(min(rates.values()), rel=1e-6)
    assert result.cases[0].decay_rate < result.decay_rate
    assert result.checked
    assert result.cases[0].checked


def drawn(given, n, seed=0):
    """Return sets of parameters under random conditions within the ranges."""
    judged, rng = Judged(given, numbers(given)), np.random.default_rng(seed)
    values = {name: rng.uniform(*ends, n) for name, ends in judged.conditions.ranges}
    condition = judged.conditions.lists[0].with_values(values)
    return judged, under_conditions(judged.model, judged.p, [(condition, n)])


TOLERANCES = {"tolerance": {"K_m": "10 %", "C_s": "15 %"}}
RANGE_OF_SPEEDS = yd.SpeedRange(min="50 km/h", max="330 km/h", steps=3)


@pytest.mark.parametrize(
    "more",
    [
        {"conditions": RANGES},
        pytest.param({"conditions": RANGES, "speed": RANGE_OF_SPEEDS}, marks=pytest.mark.slow),
        pytest.param({"conditions": RANGES | TOLERANCES, "speed": RANGE_OF_SPEEDS}, marks=pytest.mark.slow),
    ],
    ids=["two", "with speeds", "with tolerances"],
)
def test_no_random_condition_is_worse_than_the_worst_found(more):
    given = problem(**more)
    result = yd.stability(given)
    judged, sets = drawn(given, 10_000)
    for name in ("decay_rate", "damping_ratio"):
        least = Measure(name, tuple(given.design.variables)).of(sets).min()
        worst = getattr(result, name)
        assert least >= worst - 1e-3 * abs(worst)
        assert any(getattr(found, name) == worst for found in judged.looked.values())  # no bound that holds far away
    assert result.checked
    assert "no proof" in result.searched


def test_the_worst_of_two_ranges_lies_inside():
    result = yd.stability(problem(conditions=RANGES))
    assert result.worst_condition == pytest.approx(
        {"speed": 300 / 3.6, "lambda": 0.27529, "creep_factor": 0.5}, rel=1e-4
    )
    assert result.decay_rate == pytest.approx(0.284943, abs=1e-5)


def test_unstable_only_between_the_speeds_that_are_looked_at_first(narrow_bogie):
    """Stable at 210, 225 and 240 km/h, and not from 219.72 to 221.12 km/h."""
    given = replace(
        yd.table1().replace(**narrow_bogie),
        speed=yd.SpeedRange(min="210 km/h", max="240 km/h", steps=3),
        requirements={"decay_rate": 0, "critical_speed": "250 km/h"},
    )
    at_first = [yd.stability(given.replace(speed=v)) for v in given.speeds]
    assert all(one.stable for one in at_first)
    result = yd.stability(given)
    assert not result.stable
    assert 219.72 < 3.6 * result.worst_condition["speed"] < 221.12
    assert [each.met for each in result.requirements] == [False, False]
    assert 3.6 * result.requirements[1].reached == pytest.approx(219.724254, abs=1e-5)
    assert result.checked


REQUIREMENTS = {
    "decay_rate": 0.2,
    "damping_ratio": "3 %",
    "cases": {"decay_rate": 0, "damping_ratio": "0 %"},
}


def test_requirements_against_plain_loops(independent):
    given = problem(conditions=LISTS, speed=SPEEDS, cases=CASES, requirements=REQUIREMENTS)
    p = numbers(given)
    faults = {"one lost": (("C_s", 0.5), ("K_ds", 0.5)), "all lost": (("C_s", 0.0),)}
    found = {name: brute_force(independent, p, fault) for name, fault in {None: (), **faults}.items()}
    for each in requirement_verdicts(given, p):
        k = ("decay_rate", "damping_ratio").index(each.name.removeprefix("cases."))
        names = faults if each.name.startswith("cases.") else [None]
        worst = min((x[k], name) for name in names for x in found[name].values())
        assert each.reached == pytest.approx(worst[0], rel=1e-6)
        assert each.case == worst[1]
        assert each.met == (worst[0] >= each.wanted)
        assert each.checked
    by_name = {each.name: each for each in requirement_verdicts(given, p)}
    assert not by_name["cases.decay_rate"].met


def test_other_numbers_than_those_of_the_problem():
    """What is looked for hands its own design over."""
    given = problem(conditions=RANGES, cases=CASES, requirements={"damping_ratio": "1 %"})
    p = {**numbers(given), "K_m": 2e6, "C_s": 1.5e6}
    designed = yd.stability(given.replace(K_m=2e6, C_s=1.5e6))
    assert worst_verdict(given, p).decay_rate == designed.decay_rate
    assert case_verdicts(given, p) == designed.cases
    assert requirement_verdicts(given, p) == designed.requirements


def test_what_is_exactly_reached_is_met():
    given = problem()
    reached = yd.stability(given).damping_ratio
    for factor, met in ((1.0, True), (1 + 1e-10, True), (1 + 1e-8, False)):
        (each,) = requirement_verdicts(replace(given, requirements={"damping_ratio": factor * reached}), numbers(given))
        assert each.met is met


def test_verdicts_that_differ_from_eigenvalues_are_no_verdicts(monkeypatch):
    given = problem(conditions={"lambda": list(np.linspace(0.05, 0.4, 40))})
    assert yd.stability(given).checked
    asked = Measure.exceeds

    def flipped(measure, sets, level):
        yes, sure = asked(measure, sets, level)
        return (~yes, sure) if np.ndim(level) == 0 and level == 0 else (yes, sure)

    monkeypatch.setattr(Measure, "exceeds", flipped)
    assert not yd.stability(given).checked


def test_one_condition_is_told_as_one():
    assert yd.stability(problem()).searched == "one condition only: lambda 0.15, creep as given, 300 km/h"


@pytest.mark.slow
def test_thousands_of_listed_conditions():
    values = {"lambda": list(np.linspace(0.05, 0.4, 90)), "creep_factor": list(np.linspace(0.5, 1, 50))}
    given = problem(conditions=values).replace(C_s=1.0e6)
    result, p = yd.stability(given), numbers(given)
    judged = Judged(given, p)
    grid = [Condition((("v", 300 / 3.6), ("lambda", a), ("creep_factor", b))) for a, b in product(*values.values())]
    sets = under_conditions(judged.model, p, [(condition, 1) for condition in grid])
    for name in ("decay_rate", "damping_ratio"):
        margins = Measure(name, tuple(given.design.variables)).of(sets)
        assert getattr(result, name) == pytest.approx(margins.min(), rel=1e-9)
    assert result.checked

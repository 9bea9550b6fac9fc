"""Answers at many points are those of one problem at a time, whatever way they were found."""

from fractions import Fraction

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting.certificate import certify
from yawdesign.hunting.many import critical_values
from yawdesign.problem.condition import Condition
from yawdesign.study.answers import evaluate
from yawdesign.study.request import Question
from yawdesign.vehicle.vehicle import Model

SPEEDS = yd.SpeedRange(min="200 km/h", max="300 km/h", steps=3)


PRINTED = Model(equations="as-printed")


def at_speeds(speeds):
    return tuple(Condition((("v", float(v)),)) for v in speeds)


def drawn(random_bogies, model, n, seed):
    """Return n random bogies of one model as arrays, with speeds and dampings."""
    rows = [p for p, _ in random_bogies(n, seed=seed, spread=2.0)]
    damping = 10 ** np.random.default_rng(seed).uniform(4, 7, n)
    motor = ("M_m", "J_m", "K_m", "C_m", "K_mphi", "C_mphi", "K_dm", "a_0")
    names = [name for name in rows[0] if model.kind == "power" or name not in motor]
    return {name: np.array([p[name] for p in rows]) for name in names} | {"C_s": damping}


def row(columns, name, k):
    values = columns[name][k]
    return values[~np.isnan(values)]


def problems(p, model, **more):
    n = len(p["W"])
    base = yd.table1(equations=model.equations)
    if model.kind == "trailer":
        base = yd.table1(kind="trailer")
    for k in range(n):
        values = {name: float(x[k]) for name, x in p.items()}
        yield base.replace(**{"speed": values.pop("v"), **more}, **values)


@pytest.mark.parametrize("of", ["stable", "decay_rate", "damping_ratio"])
def test_verdicts_and_margins(random_bogies, vehicle_model, of):
    model = vehicle_model
    p = drawn(random_bogies, model, 25, seed=2)
    variables = () if model.kind == "trailer" else ("C_s", "C_mphi")
    answers = evaluate(Question(of, model, variables=variables), p)
    assert not answers.unverified.any()
    for problem, value in zip(problems(p, model), answers.columns[of], strict=True):
        names = {name: yd.Variable(min=1.0, max=1e9) for name in variables}
        problem = problem.replace(design=yd.Design(variables=names)) if names else problem
        expected = getattr(yd.stability(problem), of)
        assert float(value) == pytest.approx(float(expected), rel=1e-7, abs=1e-8)


@pytest.mark.parametrize("speed", [None, SPEEDS], ids=["one speed", "three speeds"])
@pytest.mark.slow
def test_designs(random_bogies, vehicle_model, speed):
    model = vehicle_model
    p = drawn(random_bogies, model, 25, seed=3)
    p.pop("C_s")
    curve = yd.table1().curve
    conditions = at_speeds(speed.values) if speed else (Condition(()),)
    asked = Question("design", model, conditions, curve=curve)
    answers = evaluate(asked, {name: x for name, x in p.items() if not (speed and name == "v")})
    short = evaluate(Question("C_sl", model, conditions, curve=curve), {
        name: x for name, x in p.items() if not (speed and name == "v")
    })  # fmt: skip
    assert np.array_equal(short.columns["C_sl"], answers.columns["C_sl"], equal_nan=True)
    for k, problem in enumerate(problems(p, model, **({"speed": speed.values} if speed else {}))):
        expected = yd.design(problem)
        assert answers.columns["status"][k] == expected.status
        assert answers.columns["stable"][k] == expected.stable
        for name in ("C_sl", "C_s", "C_su", "rotational_resistance"):
            value = getattr(expected, name)
            assert answers.columns[name][k] == pytest.approx(np.nan if value is None else value, rel=1e-8, nan_ok=True)


def test_critical_values_of_the_reference_bogies(case, vehicle_of_case):
    vehicle = vehicle_of_case(case)
    answers = evaluate(Question("critical", vehicle.model), vehicle.p)
    assert row(answers.columns, "critical", 0) == pytest.approx(case["critical_C_s"], rel=1e-8)
    assert row(answers.columns, "omega", 0) == pytest.approx(case["crossing_omega"], rel=1e-8)
    assert row(answers.columns, "unstable_roots", 0).tolist() == case["unstable_roots_per_interval"]
    assert not answers.unverified[0]


@pytest.mark.slow
def test_critical_values_are_certified(random_vehicles):
    recomputed = 0
    for vehicle in random_vehicles(40, seed=11):
        answers = evaluate(Question("critical", vehicle.model), vehicle.p)
        expected = certify(vehicle.model.at({name: Fraction(value) for name, value in vehicle.p.items()}))
        assert row(answers.columns, "critical", 0) == pytest.approx([x.C_s for x in expected.critical], rel=1e-9)
        assert tuple(row(answers.columns, "unstable_roots", 0)) == expected.unstable_roots
        assert not answers.unverified[0]
        recomputed += answers.recomputed[0]
    assert recomputed <= 2


def test_what_fails_its_check_is_computed_with_many_digits(table1, monkeypatch):
    p = table1 | {"f_11": table1["f_11"] * np.array([1.0, 0.7])}
    expected = evaluate(Question("critical", PRINTED), p)
    monkeypatch.setattr(critical_values, "ACCURATE", 0.0)
    mended = evaluate(Question("critical", PRINTED), p)
    assert mended.recomputed.all()
    assert not mended.unverified.any()
    assert not expected.recomputed.any()
    for name, column in expected.columns.items():
        assert mended.columns[name] == pytest.approx(column, rel=1e-9, nan_ok=True)


def test_a_verdict_on_the_boundary_is_not_trusted(table1):
    C_s = 90702.8897786979 * np.array([0.999, 1.0, 1.001])
    answers = evaluate(Question("stable", PRINTED), table1 | {"C_s": C_s})
    assert answers.recomputed.tolist() == [False, True, False]
    assert answers.columns["stable"][[0, 2]].tolist() == [False, True]


@pytest.mark.parametrize("name", ["C_m", "C_t", "C_s"])
def test_a_damper_without_damping(table1, name):
    for value in (0.0, np.array([0.0, 1e4])):
        p = table1 | {"C_s": 1e5, name: value}
        for of in ("stable", "decay_rate"):
            answers = evaluate(Question(of, Model()), p)
            problem = yd.table1().replace(**{"C_s": 1e5, name: 0.0, "speed": table1["v"]})
            expected = getattr(yd.stability(problem), of)
            assert float(answers.columns[of][0]) == pytest.approx(float(expected), rel=1e-8)
            assert not answers.unverified.any()


def test_undamped_motors(table1):
    p = table1 | {"C_mphi": np.array([0.0, 1e4]), "C_s": 1e6}
    assert evaluate(Question("stable", Model()), p).columns["stable"].tolist() == [False, True]
    answers = evaluate(Question("design", Model(), curve=yd.table1().curve), p)
    assert answers.columns["status"].tolist() == ["motor yaw undamped", "ok"]


def test_blocks_and_threads_do_not_matter(table1, monkeypatch):
    p = table1 | {"K_m": np.linspace(4e5, 2e6, 50)}
    whole = evaluate(Question("critical", PRINTED), p)
    monkeypatch.setattr("yawdesign.study.answers.LENGTH", 7)
    for threads in (1, 3):
        parts = evaluate(Question("critical", PRINTED), p, threads=threads)
        for name, column in whole.columns.items():
            assert parts.columns[name] == pytest.approx(column, rel=1e-10, nan_ok=True)


def test_an_answer_holds_under_every_condition(table1):
    p = {name: x for name, x in table1.items() if name != "v"} | {"C_s": np.geomspace(1e5, 3e6, 20)}
    conditions = tuple(
        Condition((("v", v), ("lambda", conicity), ("creep_factor", factor)))
        for v, conicity, factor in ((70.0, 0.05, 1.0), (83.0, 0.25, 0.7), (90.0, 0.15, 0.5))
    )
    for of in ("stable", "decay_rate", "damping_ratio"):
        whole = evaluate(Question(of, Model(), conditions, variables=("C_s",)), p)
        parts = [
            evaluate(Question(of, Model(), variables=("C_s",)), condition.applied(p)).columns[of]
            for condition in conditions
        ]
        assert np.array_equal(whole.columns[of], np.min(parts, axis=0))
    design = evaluate(Question("design", Model(), conditions, curve=yd.table1().curve), {**p, "C_s": 0.0})
    chosen = {**p, "C_s": design.columns["C_s"][0]}
    assert design.columns["status"].tolist() == ["ok"]
    assert all(evaluate(Question("stable", Model()), c.applied(chosen)).columns["stable"].all() for c in conditions)
    below = {**chosen, "C_s": 0.999 * design.columns["C_sl"][0]}
    assert not evaluate(Question("stable", Model(), conditions), below).columns["stable"].any()

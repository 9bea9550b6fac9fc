"""What to change where there is no answer: each change is enough, and one hundredth less of it is not."""

from dataclasses import replace

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.changed_problem import ways, with_value
from yawdesign.damper.curving import curving_limit, enough, excess, rotational_resistance
from yawdesign.damper.design_space import MISSED, Space
from yawdesign.damper.relaxations import SLACK, conflict, relaxations, relaxed
from yawdesign.damper.relaxed_space import RelaxedSpace

DAMPER_ONLY = yd.Design(variables={"C_s": yd.Variable(min=1e4, max=1e7)})
TABLE1 = yd.table1().replace(design=DAMPER_ONLY)
WHEEL = TABLE1.replace(load="wheel", requirements={"damping_ratio": "5 %"})
FIFTEEN = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.7, 0.5]}


@pytest.fixture(scope="module")
def of_wheel():
    return {one.name: one for one in relaxations(WHEEL)}


def has_design(problem):
    """Return whether any of 20 001 dampings is stable and meets all requirements."""
    space = Space(problem)
    return space.beats_at(np.linspace(0, 1, 20_001)[None, :], np.zeros(20_001)).any()


def short_of(relaxation):
    return replace(relaxation, value=relaxation.now + 0.99 * (relaxation.value - relaxation.now))


def assert_enough_and_needed(problem, relaxation):
    other = relaxed(problem, relaxation)
    values = {**problem.parameters(), **relaxation.design}
    if relaxation.kind == "parameter":
        values[relaxation.name.rpartition(".")[2]] = relaxation.value
    space = Space(other)
    assert relaxation.met
    assert float(np.squeeze(space.margins(values))) == pytest.approx(relaxation.margin, rel=1e-9)
    for name, variable in other.design.variables.items():
        assert variable.min <= relaxation.design[name] <= variable.max
    assert has_design(other)
    assert not has_design(relaxed(problem, short_of(relaxation)))


def test_the_wheel_load_and_five_per_cent_exclude_each_other():
    assert conflict(WHEEL) == ("requirements.damping_ratio", "curve.limit")


def test_each_number_alone(of_wheel):
    enough_alone = {"speed", "curve.limit", "bogie.K_2x", "requirements.damping_ratio", "bogie.C_t"}
    assert {name for name, one in of_wheel.items() if one.met} == enough_alone
    changes = [abs(one.change) for one in of_wheel.values() if one.met]
    assert changes == sorted(changes)
    for name in ("design.variables.C_s.max", "design.variables.C_s.min"):
        assert (of_wheel[name].value, of_wheel[name].design, of_wheel[name].margin) == (None, {}, None)
        with pytest.raises(yd.ProblemError, match="no change of it alone is enough"):
            relaxed(WHEEL, of_wheel[name])


def test_each_change_is_enough_and_needed(of_wheel):
    for one in of_wheel.values():
        if one.met:
            assert_enough_and_needed(WHEEL, one)


def test_the_limit_that_the_least_damping_needs(of_wheel):
    """What eq. (13) gives at the lowest damping with 5 %, found by halving: C_s alone moves the limit."""
    low, high = 4e5, 2e6
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if damping_ratio(middle) > 0.05 else (middle, high)
    needed = rotational_resistance(WHEEL.parameters(), high, WHEEL.curve)
    share = np.log(needed / 0.08) * (1 + SLACK)
    assert of_wheel["curve.limit"].value == pytest.approx(0.08 * np.exp(share), rel=1e-6)


def damping_ratio(C_s):
    return yd.stability(WHEEL.replace(C_s=C_s)).damping_ratio


def test_the_ratio_that_is_left(of_wheel):
    """The most that the curve allows is what is reached at C_su, where the ratio still rises."""
    most = damping_ratio(float(curving_limit(WHEEL.parameters(), WHEEL.curve)))
    reached = 0.05 - (0.05 - most) * (1 + SLACK)
    assert of_wheel["requirements.damping_ratio"].value == pytest.approx(reached, rel=1e-6)


@pytest.mark.slow
def test_the_optimum_says_it(of_wheel):
    result = yd.optimise(WHEEL)
    assert result.status == "infeasible"
    assert result.conflict == ("requirements.damping_ratio", "curve.limit")
    assert result.relaxations[0].value == pytest.approx(of_wheel["speed"].value, rel=1e-4)


@pytest.mark.slow
def test_followed_the_optimum_meets_it(of_wheel):
    for one in of_wheel.values():
        if one.name in ("curve.limit", "requirements.damping_ratio"):
            result = yd.optimise(relaxed(WHEEL, one))
            assert (result.status, result.conflict, result.relaxations) == ("optimal", (), ())


def test_where_even_no_damper_keeps_the_limit():
    """Limit and K_2x are those of eq. (13) at the lower bound of C_s where that is stable."""
    problem = TABLE1.replace(limit=0.02, **{"lambda": 0.02})
    found = {one.name: one for one in relaxations(problem)}
    closed = enough(problem.parameters(), 1e4, problem.curve, ("limit", "K_2x"))
    assert found["curve.limit"].value == pytest.approx(closed["limit"], rel=2e-3)
    assert found["bogie.K_2x"].value == pytest.approx(closed["K_2x"], rel=2e-3)
    assert not found["speed"].met
    assert conflict(problem) == ("curve.limit",)


def test_what_is_enough_in_the_curve_is_at_the_limit():
    problem = TABLE1.replace(limit=0.02)
    p = problem.parameters()
    for name, value in enough(p, 0.0, problem.curve, ("limit", "R", "K_2x")).items():
        other = problem.replace(**{name: value})
        resistance = rotational_resistance(other.parameters(), 0.0, other.curve)
        assert resistance == pytest.approx(other.curve.limit, rel=1e-12)
    assert "C_t" not in enough(p, 0.0, problem.curve, ("C_t",))
    text = excess([{**p, "C_s": 0.0}], ("C_s",), problem.curve)
    assert "is 0.0307246, and the limit is 0.02; it is kept with limit = 0.0307246 or R = 460.869 m" in text
    assert text in yd.design(problem).message


@pytest.mark.slow
def test_faults_and_critical_speeds_may_be_what_is_missed():
    faults = {"one lost": {"C_s": "50 %", "K_ds": "50 %"}}
    wanted = {"critical_speed": "300 km/h", "cases": {"damping_ratio": "4 %"}}
    problem = TABLE1.replace(load="wheel", cases=faults, requirements=wanted)
    assert conflict(problem) == ("requirements.cases.damping_ratio", "curve.limit")
    found = [one for one in relaxations(problem) if one.met]
    assert "requirements.cases.damping_ratio" in {one.name for one in found}
    for one in found:
        assert_enough_and_needed(problem, one)


def test_with_a_design_there_is_nothing_to_change():
    assert relaxations(TABLE1) == ()
    assert conflict(TABLE1) == ()


@pytest.mark.slow
def test_ranges():
    problem = TABLE1.replace(
        conditions={"lambda": {"min": 0.05, "max": 0.4}, "creep_factor": {"min": 0.5, "max": 1}},
        requirements={"damping_ratio": "7 %"},
    )
    found = {one.name: one for one in relaxations(problem) if one.met}
    ratio = found["requirements.damping_ratio"]
    assert ratio.value == pytest.approx(0.067885, rel=1e-4)
    assert conflict(problem) == ("requirements.damping_ratio",)
    # At the corners alone more is reached: the worst lies inside, and is found.
    assert has_design(problem.replace(requirements={"damping_ratio": 0.06795}))


def test_the_verdict_at_a_share_is_that_of_the_changed_problem():
    """One verdict on arrays, of every kind of change, against the problem written anew at each share."""
    problem = yd.table1().replace(
        load="wheel",
        requirements={"damping_ratio": "3 %", "critical_speed": "320 km/h"},
        conditions={"lambda": [0.1, 0.4]},
    )
    rng = np.random.default_rng(3)
    for way in ways(problem):
        space = RelaxedSpace(problem, way=way)
        x, shares = rng.random((3, 8)), rng.random(8)
        got = space.met(x, shares)
        values = space.values_at(x, shares)
        for k in range(8):
            other = Space(with_value(problem, way, float(way.at(shares[k]))))
            chosen = {name: float(values[name][k]) for name in other.names}
            merit = float(np.squeeze(other.margins({**other.fixed, **chosen})))
            assert got[k] == (merit > -MISSED), (way.name, merit)


@pytest.fixture(scope="module")
def vehicle():
    problem = yd.load("problems/vehicle.yaml").replace(W="200 kN", conditions=FIFTEEN, cases=())
    return problem.replace(design=DAMPER_ONLY)


@pytest.mark.slow
def test_the_vehicle(vehicle):
    """Which needs 9 011 kN s/m where the curve allows 2 593."""
    assert conflict(vehicle) == ("stability", "curve.limit")
    found = {one.name: one for one in relaxations(vehicle)}
    assert {name for name, one in found.items() if one.met} == {"speed", "curve.limit"}
    limit = found["curve.limit"]
    assert limit.design["C_s"] == pytest.approx(9_011e3, rel=2e-3)
    assert limit.value == pytest.approx(rotational_resistance(vehicle.parameters(), 9_011e3, vehicle.curve), rel=2e-3)
    for one in (limit, found["speed"]):
        assert_enough_and_needed(vehicle, one)

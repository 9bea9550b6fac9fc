"""An optimum lies within the bounds as written, whatever they are, and is never worse than the design as written."""

import math
from importlib import import_module

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.damper import best_design, nlp, search
from yawdesign.damper.design_space import Space, between, fraction, scale
from yawdesign.hunting.many.measure import FASTEST
from yawdesign.problem import PARAMETERS
from yawdesign.problem.parameters import parameter_keys
from yawdesign.vehicle.vehicle import Model

WRITTEN = {name: float(value) for name, value in yd.table1().bogie.parameters().items()}


def problem_of(bounds, *, kind="power", objective="decay_rate", **changes):
    variables = {name: yd.Variable(min=low, max=high) for name, (low, high) in bounds.items()}
    return yd.table1(kind).replace(design=yd.Design(objective=objective, variables=variables), **changes)


@pytest.fixture
def quick(monkeypatch):
    """Look at few designs: what must hold for every answer needs no good one."""
    optimise = import_module("yawdesign.damper.optimise")
    for name in ("conflict", "relaxations"):
        monkeypatch.setattr(optimise, name, lambda *_, **__: ())
    monkeypatch.setattr(search, "_blocks", lambda space, rng: [rng.random((len(space.names), 500))])
    monkeypatch.setattr(search, "STARTS", 4)
    monkeypatch.setattr(nlp, "PUSHES", nlp.PUSHES[:1])
    monkeypatch.setattr(best_design, "TURNS", ((1, 1e-3),))
    monkeypatch.setattr(best_design, "MOST_SEARCHES", 1)


def assert_within(problem, result):
    for name, variable in problem.design.variables.items():
        low, high = float(variable.min), float(variable.max)
        if result.status == "infeasible":
            assert result.optimum[name] is None
            continue
        bound = result.bounds[name]
        assert (bound.min, bound.max) == (low, high)
        assert low <= result.optimum[name] <= high
        assert bound.value == result.optimum[name]
        assert 0 <= bound.position <= 1
    if result.status != "infeasible":
        assert result.rotational_resistance is None or result.rotational_resistance <= problem.curve.limit * (1 + 1e-9)


@pytest.mark.parametrize("objective", ["decay_rate", "damping_ratio"])
def test_bounds_of_a_damper_below_one_newton_second_per_metre(objective, quick):
    problem = problem_of({"C_s": (1e4, 1e7), "C_m": (0, 0.5)}, objective=objective)
    result = yd.optimise(problem)
    assert result.status == "optimal"
    assert_within(problem, result)
    # A motor damper helps: the most that is allowed of it is the best, by so little that a part of it is as good;
    # the shortened search of this test comes as near as this.
    best = yd.optimise(problem_of({"C_s": (1e4, 1e7)}, C_m=0.5, objective=objective))
    assert result.margin == pytest.approx(best.margin, rel=1e-3)


@pytest.mark.parametrize("name", ["C_t", "C_m", "C_s"])
def test_no_damping_is_a_point_like_others(name):
    """Beside others in one array, 0 has the margin of the bogie without that damper, and of next to no damping."""
    space = Space(problem_of({name: (0, 1e3)}))
    at_zero, above = space.margins_at(np.array([[0.0, 1e-9]]))
    exact = Space(problem_of({"K_2x": (1e4, 1e6)}, **{name: 0})).margins({**WRITTEN, name: 0.0})
    assert at_zero == pytest.approx(exact, abs=1e-9)
    assert above == pytest.approx(at_zero, abs=1e-6)
    levels = np.array([at_zero - 1e-6, at_zero + 1e-6, at_zero - 1e-6])
    values = space.values(np.array([[0.0, 0.0, 1e-9]]))
    assert space.beats(values, levels).tolist() == [True, False, True]


def test_zero_is_an_answer(quick):
    """Where the curve allows no damping at all beside the springs, the only answer is C_s = 0."""
    tight = problem_of({"C_s": (0, 1e7)}, C_t=0).replace(C_s=None)
    p, curve = tight.bogie.parameters(), tight.curve
    least = p["K_2x"] * p["b_2"] ** 2 * curve.L / (2 * curve.R) / (4 * p["W"] * p["a"])
    result = yd.optimise(tight.replace(curve=yd.Curve(R=300, L=19, l=60, V_r=25, limit=float(least))))
    assert result.optimum["C_s"] <= 1e-6
    assert result.bounds["C_s"].min == 0


@pytest.mark.slow
@pytest.mark.parametrize("name", parameter_keys("power"))
def test_every_parameter_over_its_whole_range(name, quick):
    problem = problem_of({name: PARAMETERS[name].hard})
    result = yd.optimise(problem)
    assert result.status in ("optimal", "unverified")
    assert_within(problem, result)
    assert result.margin >= result.margin_before - 2e-5


@pytest.mark.slow
def test_a_wider_box_does_not_lose():
    """The scale of a bound must not hide the designs near the nominal one."""
    narrow = yd.optimise(problem_of({"C_s": (1e4, 1e7), "C_m": (1e3, 1e6)}))
    wide = yd.optimise(problem_of({"C_s": (0, 1e12), "C_m": (0, 1e12)}))
    assert wide.margin >= narrow.margin * (1 - 1e-6)


@pytest.mark.slow
def test_all_parameters_at_once(quick):
    problem = problem_of({name: (0.9 * value, 1.1 * value) for name, value in WRITTEN.items()})
    result = yd.optimise(problem)
    assert_within(problem, result)
    assert result.margin > result.margin_before


def test_a_small_feasible_corner_is_found(quick):
    """Of this box the curve allows less than a millionth."""
    problem = problem_of({"C_s": (2e6, 1e7), "K_2x": (0, 1e18), "b_2": (0, 100), "W": (1e5, 2.1e5)})
    result = yd.optimise(problem)
    assert result.status in ("optimal", "unstable")
    assert_within(problem, result)


def test_infeasible_says_why():
    result = yd.optimise(problem_of({"C_s": (5e6, 1e7), "K_2x": (1e5, 1e6), "W": (1e4, 1e5)}))
    assert result.status == "infeasible"
    p = {**WRITTEN, "C_s": 5e6, "K_2x": 1e5, "W": 1e5}
    moment = (p["C_s"] * 1.2**2 + p["C_t"] * 0.3**2) * 19 * 25 / (2 * 300 * 60) + 1e5 * 1.1**2 * 19 / 600
    assert f"is {moment / (4 * 1e5 * 1.25):.6g}, and the limit is 0.08" in result.message
    assert "C_s = 5 000 kN·s/m" in result.message
    assert "W = 100 000 N" in result.message


def test_infeasible_without_a_variable_says_why():
    result = yd.optimise(problem_of({"K_m": (1e5, 1e6)}, C_s=5e6))
    assert result.status == "infeasible"
    assert "no design variable changes" in result.message
    assert "W = 0" in yd.optimise(problem_of({"C_s": (1e5, 1e6)}, W=0)).message


@st.composite
def boxes(draw):
    kind = draw(st.sampled_from(["power", "trailer"]))
    names = draw(st.lists(st.sampled_from(parameter_keys(kind)), min_size=1, max_size=4, unique=True))
    return kind, {name: draw(bounds_of(name)) for name in names}


@st.composite
def bounds_of(draw, name):
    """Bounds of any size anywhere in what is accepted, half of them around the value of Table I."""
    least, most = PARAMETERS[name].hard
    places = st.floats(least, most) | st.floats(-3, 3).map(lambda x: WRITTEN[name] * 10**x)
    low = min(draw(st.just(least) | places), most)
    size = draw(st.floats(-12, 6))
    high = draw(st.just(most) | places | st.just(max(low, 1e-9) * (1 + 10**size)))
    low, high = sorted((max(low, least), min(max(high, least), most)))
    return (low, high) if low < high else (least, most)


@given(boxes(), st.lists(st.floats(0, 1), min_size=4, max_size=4))
@example(("trailer", {"M_b": (0.001, 1e18), "W": (0.0, 5e-324)}), [0.0, 1.0, 0.0, 0.0])
@example(("power", {"W": (0.0, 1e-317), "C_s": (1e5, 1e5 + 2e-11)}), [0.3, 0.5, 0.0, 0.0])
@settings(max_examples=100, deadline=None)
def test_every_point_of_the_cube_lies_within_the_bounds(box, x):
    kind, bounds = box
    space = Space(problem_of(bounds, kind=kind))
    values = space.values(np.array(x[: len(bounds)]))
    for name, (low, high) in bounds.items():
        assert low <= values[name] <= high
    again = space.values(space.coordinates({name: float(values[name]) for name in bounds}))
    for name, (low, high) in bounds.items():
        assert math.isclose(again[name], values[name], rel_tol=1e-9, abs_tol=1e-9 * min(scale(name), high - low))


@pytest.mark.slow
@given(boxes(), st.sampled_from(["decay_rate", "damping_ratio"]), st.integers(0, 99))
@example(("trailer", {"K_2x": (0.0, 1e18), "M_b": (0.001, 1e18), "lambda": (0.0, 10.0)}), "decay_rate", 0)
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_an_optimum_of_any_box(quick, box, objective, seed):
    kind, bounds = box
    problem = problem_of(bounds, kind=kind, objective=objective)
    result = yd.optimise(problem, seed=seed)
    assert_within(problem, result)
    inside = all(low <= WRITTEN[name] <= high for name, (low, high) in bounds.items())
    if inside:
        assert result.status != "infeasible"
        assert result.margin >= result.margin_before - 2e-5


@given(st.floats(1e-6, 1e12), st.floats(0, 1e12), st.floats(0, 1))
@settings(max_examples=100, deadline=None)
def test_fractions_are_the_inverse_of_values(width, low, x):
    value = between(low, low + width, x, 1e4)
    assert low <= value <= low + width
    if width > 1e-6 * low:
        assert fraction(low, low + width, float(value), 1e4) == pytest.approx(x, abs=1e-7)


def test_a_rigid_joint_is_what_a_fast_one_tends_to():
    """On either side of the limit the margins are the same, by eigenvalues and by Routh's array."""
    for damper, joint in Model().joints.items():
        space = Space(problem_of({damper: (0, 1e7)}))
        edge = WRITTEN[joint] / FASTEST
        margins = [float(space.margins({**WRITTEN, damper: x * edge})) for x in (0.999, 1.001)]
        assert margins[0] == pytest.approx(margins[1], abs=1e-5)
        assert space.beats({**WRITTEN, damper: 0.999 * edge}, margins[0] - 1e-5)
        assert not space.beats({**WRITTEN, damper: 0.999 * edge}, margins[0] + 1e-5)

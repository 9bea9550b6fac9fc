"""The optimum: known best values, any seed, other variables, and the answers that are no optimum."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.design_space import Space
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.vehicle.vehicle import Model

# The best known margins over C_s in [1e3, C_su], K_m and C_m in [0.1, 10] times Table I, at 300 km/h.
BEST = {
    ("decay_rate", "as-printed"): 7.195086,
    ("decay_rate", "reciprocal"): 5.783142,
    ("damping_ratio", "as-printed"): 0.138626,
    ("damping_ratio", "reciprocal"): 0.141313,
}


def problem_of(objective, equations, **variables):
    chosen = {
        "C_s": yd.Variable(min=1e3, max=1e7),
        "K_m": yd.Variable(min=62648.0, max=6264800.0),
        "C_m": yd.Variable(min=1995.0, max=199500.0),
    }
    return yd.table1(equations=equations).replace(design=yd.Design(objective=objective, variables=variables or chosen))


def recomputed(problem, result):
    """Return the margin at the optimum from the 25-state matrix, without the modes that nothing moves."""
    p = {**problem.bogie.parameters(), **result.optimum, "v": problem.speeds[0]}
    s = np.linalg.eigvals(state_matrix(Model.of(problem).at(p)))
    for name, roots in result.fixed_modes.items():
        if name.startswith("motors"):
            for root in roots:
                s = np.delete(s, np.argmin(abs(s - root)))
    return -s.real.max() if result.objective == "decay_rate" else (-s.real / abs(s)).min()


@pytest.mark.slow
@pytest.mark.parametrize(("objective", "equations"), BEST)
def test_best_known_optima(objective, equations):
    problem = problem_of(objective, equations)
    result = yd.optimise(problem)
    assert result.status == "optimal"
    assert result.margin >= 0.9999 * BEST[objective, equations]
    assert result.margin == pytest.approx(recomputed(problem, result), rel=1e-6)
    assert result.margin == pytest.approx(result.margin_polynomial, rel=1e-6)
    assert result.hurwitz_positive
    assert result.rotational_resistance <= 0.08 * (1 + 1e-9)
    assert result.C_s == result.optimum["C_s"]
    assert result.margin_before == pytest.approx(yd.stability(problem).to_dict()[objective], rel=1e-9)
    # The as-printed optimum and the reciprocal one of the decay rate lie at the curve's limit, the others inside.
    assert ("rotational_resistance" in result.active) == (objective == "decay_rate")


@pytest.mark.slow
@pytest.mark.parametrize(("objective", "equations"), BEST)
def test_any_seed_gives_one_answer(objective, equations):
    seeds = range(10 if (objective, equations) == ("decay_rate", "as-printed") else 4)
    results = [yd.optimise(problem_of(objective, equations), seed=seed) for seed in seeds]
    margins = [r.margin for r in results]
    assert min(margins) >= (1 - 1e-6) * max(margins)
    assert max(margins) == pytest.approx(BEST[objective, equations], abs=1e-6)
    for name in ("C_s", "K_m", "C_m"):
        values = [r.optimum[name] for r in results]
        assert max(values) <= 1.001 * min(values)


def test_one_variable_against_a_scan():
    problem = problem_of("damping_ratio", "reciprocal", C_s=yd.Variable(min=1e4, max=1e7))
    result = yd.optimise(problem)
    space = Space(problem)
    scan = space.margins_at(np.linspace(0, 1, 2001)[None, :])
    assert result.margin >= scan.max()
    assert result.margin == pytest.approx(scan.max(), rel=1e-3)
    assert result.optimum["K_m"] == pytest.approx(626480)  # not a variable: stays as given


@pytest.mark.slow
def test_other_parameters_may_vary():
    problem = problem_of(
        "decay_rate", "reciprocal", C_s=yd.Variable(min=1e4, max=1e7), K_mphi=yd.Variable(min=1e5, max=1e6)
    )
    result = yd.optimise(problem)
    assert "motors yawing against each other" not in result.fixed_modes  # K_mphi moves it, so it counts
    assert result.margin >= result.margin_before
    assert result.margin == pytest.approx(min(m.decay_rate for m in result.modes), rel=1e-6)


@pytest.mark.slow
def test_four_variables_do_not_lose_to_three():
    three = problem_of("decay_rate", "as-printed")
    four = yd.Design(variables={**three.design.variables, "K_2y": yd.Variable(min=0.4e6, max=1.6e6)})
    assert yd.optimise(three.replace(design=four)).margin >= 0.9999 * BEST["decay_rate", "as-printed"]


def test_trailer():
    result = yd.optimise(yd.table1("trailer"))
    assert result.optimum["K_m"] is None
    assert result.C_s == result.optimum["C_s"] != result.forward.C_s
    assert result.forward.C_sl < result.C_s <= result.C_su
    assert result.margin > result.margin_before


def test_infeasible_box_is_said():
    problem = problem_of("decay_rate", "reciprocal", C_s=yd.Variable(min=5e6, max=1e7))
    result = yd.optimise(problem)
    assert (result.status, result.margin) == ("infeasible", None)
    assert result.active == ("rotational_resistance",)


@pytest.mark.parametrize("objective", ["decay_rate", "damping_ratio"])
def test_unstable_box_is_said(objective):
    problem = problem_of(objective, "reciprocal", C_s=yd.Variable(min=1e3, max=5e4)).replace(speed="420 km/h")
    result = yd.optimise(problem)
    assert result.status == "unstable"
    assert result.margin < 0
    assert not result.stable


@pytest.mark.slow
def test_user_options_win():
    """An iteration limit of the user reaches IPOPT: the NLP then stays where it starts, and the answer still stands."""
    problem = problem_of("decay_rate", "as-printed", C_s=yd.Variable(min=1e4, max=1e7))
    limited = yd.optimise(problem, options={"ipopt.max_iter": 0})
    assert limited.margin == pytest.approx(yd.optimise(problem).margin, rel=1e-5)
    with pytest.raises(RuntimeError):
        yd.optimise(problem, options={"ipopt.no_such_option": 1})


@pytest.mark.slow
def test_damping_may_start_at_zero():
    variables = {"C_s": yd.Variable(min=0, max=1e7), "K_2x": yd.Variable(min=1e5, max=1e7)}
    assert yd.optimise(problem_of("decay_rate", "reciprocal", **variables)).status == "optimal"
    tight = yd.table1().replace(curve=yd.Curve(R=300, L=19, l=60, V_r=25, limit=0.001))
    result = yd.optimise(tight.replace(design=yd.Design(variables=variables)))
    assert result.margin is None or result.rotational_resistance <= 0.001


def test_undamped_motor_is_named():
    result = yd.optimise(problem_of("decay_rate", "reciprocal", C_s=yd.Variable(min=1e4, max=1e7)).replace(C_mphi=0))
    assert result.status == "unstable"
    assert "C_mphi" in result.message


def test_missing_damping_is_an_error():
    problem = problem_of("decay_rate", "reciprocal", K_m=yd.Variable(min=1e5, max=1e6)).replace(C_s=None)
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.optimise(problem)


def test_a_motor_without_damper_lowers_the_degree():
    problem = problem_of("decay_rate", "reciprocal", C_s=yd.Variable(min=1e4, max=1e7)).replace(C_m=0)
    result = yd.optimise(problem)
    assert result.status == "optimal"
    assert result.hurwitz_positive
    assert result.checked


def test_a_range_of_speeds_has_its_worst():
    """The optimum over a range is the best under its worst condition, and no better than at that speed alone."""
    problem = problem_of("decay_rate", "as-printed")
    several = problem.replace(speed=yd.SpeedRange(min="200 km/h", max="300 km/h", steps=3))
    result = yd.optimise(several)
    assert result.status == "optimal"
    assert result.worst_condition["speed"] in several.speeds
    alone = [yd.stability(several.replace(speed=v, **result.optimum)).decay_rate for v in several.speeds]
    assert result.margin == pytest.approx(min(alone), rel=1e-9)
    worst = problem.replace(speed=result.worst_condition["speed"])
    assert result.margin <= yd.optimise(worst).margin * (1 + 1e-6)


def damper_alone(objective, **changes):
    return problem_of(objective, "reciprocal", C_s=yd.Variable(min=1e4, max=1e7)).replace(**changes)


def test_a_requirement_that_decides_is_met_inside_ranges():
    """Conditions that are hardly worse than those known do not make the optimum miss what it can have."""
    ranges = {"lambda": {"min": 0.05, "max": 0.4}, "creep_factor": {"min": 0.5, "max": 1.0}}
    problem = damper_alone("damping_ratio", conditions=ranges, requirements={"decay_rate": 1.7})
    result = yd.optimise(problem)
    assert result.status == "optimal"
    assert result.requirements[0].met
    assert result.requirements[0].reached == pytest.approx(1.7, rel=1e-4)
    assert result.margin == pytest.approx(0.066868, abs=2e-6)
    assert result.margin == pytest.approx(yd.stability(problem.replace(C_s=result.C_s)).damping_ratio, rel=1e-9)
    assert result.active == ("requirements.decay_rate",)


def test_a_requirement_of_nothing_but_stability_may_be_active():
    """The best design stands where it becomes stable with its fault."""
    cases = {"three of four yaw dampers lost": {"C_s": "25 %", "K_ds": "25 %"}}
    conditions = {"lambda": [0.05, 0.4], "creep_factor": [0.5, 1.0]}
    problem = damper_alone("damping_ratio", conditions=conditions, cases=cases)
    free = yd.optimise(problem)
    assert free.active == ()
    assert not free.cases[0].stable
    result = yd.optimise(problem.replace(requirements={"cases": {"damping_ratio": 0}}))
    assert result.status == "optimal"
    assert result.cases[0].stable
    assert "requirements.cases.damping_ratio" in result.active

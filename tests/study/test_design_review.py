"""Everything that a design review asks of a problem is what the functions answer that are asked alone."""

from dataclasses import replace

import pytest

import yawdesign as yd
from yawdesign.problem.damper_catalogue import CatalogueDamper
from yawdesign.study import design_review as design_reviews
from yawdesign.study.design_review import design_review, designed, each_condition
from yawdesign.study.review_axes import conicities, creep_factors, dampings, mount, mounts, speeds
from yawdesign.study.sweep import IncompleteSweepError

VARIABLES = {"C_s": yd.Variable(min="100 kN s/m", max="3 MN s/m")}


@pytest.fixture(scope="module")
def problem():
    plain = yd.table1(kind="trailer").replace(curve=None, design=yd.Design(variables=VARIABLES))
    return plain.replace(C_s="1 MN s/m", conditions={"lambda": [0.1, 0.2], "creep_factor": [0.7, 1]})


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def review(problem, told):
    return design_review(problem, progress=lambda text, part: told.append((text, part)))


def test_the_design_is_the_optimum(problem, review):
    alone = yd.optimise(problem)
    assert review.optimum.to_dict() == alone.to_dict()
    assert review.design.bogie.C_s == pytest.approx(alone.C_s)
    assert review.design.bogie.K_1x == problem.bogie.K_1x
    assert review.forward is review.optimum.forward


def test_before_and_after_are_those_of_both_designs(problem, review):
    assert review.before.decay_rate == yd.stability(problem).decay_rate
    assert review.after.decay_rate == pytest.approx(review.optimum.margin, rel=1e-9)
    assert review.after.decay_rate > review.before.decay_rate


def test_the_worst_condition_comes_first(review):
    rows = review.each_condition
    assert len(rows) == 4
    assert rows[0].decay_rate == pytest.approx(review.after.decay_rate, rel=1e-9)
    assert rows[0].condition == review.after.worst_condition
    assert [row.decay_rate for row in rows] == sorted(row.decay_rate for row in rows)
    assert min(row.damping_ratio for row in rows) == pytest.approx(review.after.damping_ratio, rel=1e-9)


def test_conditions_inside_ranges_are_there_too(problem):
    ranged = problem.replace(conditions={"lambda": {"min": 0.1, "max": 0.2}})
    rows = each_condition(ranged)
    assert {row.condition["lambda"] for row in rows} >= {0.1, 0.2}
    assert rows[0].decay_rate <= yd.stability(ranged).decay_rate * (1 + 1e-9)


def test_modes_and_run_are_under_the_worst_condition(review):
    worst = review.after.worst_condition
    for result in (review.paths, review.modes, review.run):
        assert {key: result.condition.get(key, worst[key]) for key in worst} == worst
        assert "lambda" in result.condition
    assert review.run.C_s == pytest.approx(review.optimum.C_s)
    assert review.paths.values[0] < worst["speed"] < review.paths.values[-1]


def test_what_has_no_input_is_none(review):
    absent = ("front", "choice", "uncertainty", "mounts", "with_body", "without_body")
    assert [getattr(review, name) for name in absent] == [None] * len(absent)


def test_progress_never_goes_back_and_ends(review, told):
    parts = [part for _, part in told]
    assert parts == sorted(parts)
    assert (parts[0], parts[-1]) == (0.0, 1.0)
    assert any("the best design" in text for text, _ in told)
    assert set(review.seconds) <= {text.split(":")[0] for text, _ in told}


def test_without_a_design_it_is_the_one_as_written(problem, review):
    nothing = replace(review.optimum, margin=None, optimum={"C_s": None}, C_s=None, bounds={})
    assert designed(problem, nothing) is problem
    assert designed(problem.replace(C_s=None), nothing) is None


def test_a_damper_of_the_catalogue_is_put_in(problem, review):
    row = CatalogueDamper(name="D", damping=4e5, stiffness=2e7)
    catalogued = problem.replace(design=yd.Design(variables=VARIABLES, catalogue=(row,)))
    found = designed(catalogued, replace(review.optimum, damper="D", bounds={}))
    assert (found.bogie.C_s, found.bogie.K_ds) == (row.C_s, row.K_ds)


def test_no_damping_at_all_is_refused_before_work(problem):
    design = yd.Design(variables={"K_1x": yd.Variable(min=1e7, max=1e8)})
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        design_review(problem.replace(C_s=None, design=design))


def test_a_request_to_stop_ends_it_as_one(problem, monkeypatch):
    def stopped(*_, **__):
        raise IncompleteSweepError("stopped", "", None, True) from KeyboardInterrupt()

    monkeypatch.setattr(design_reviews, "swept", stopped)
    with pytest.raises(KeyboardInterrupt):
        design_review(problem)


def test_axes_hold_what_matters():
    problem = yd.table1().replace(conditions={"lambda": [0.01, 0.7], "creep_factor": {"min": 0.3, "max": 1.2}})
    assert conicities(problem, 5)[[0, -1]].tolist() == [0.01, 0.7]
    assert creep_factors(problem, 5)[[0, -1]].tolist() == [0.3, 1.2]
    assert speeds(problem.replace(requirements={"critical_speed": "400 km/h"}), 5)[-1] == pytest.approx(600 / 3.6)
    C_s = dampings(problem, [2e7], 5)
    assert C_s[0] <= problem.design.variables["C_s"].min
    assert C_s[-1] > 2e7
    f_m, xi_m = mount(problem)
    assert (f_m, xi_m) == (pytest.approx(2.9985, abs=1e-4), pytest.approx(0.29999, abs=1e-4))
    axes = mounts(problem, 5)
    assert axes["f_m"][0] < f_m < axes["f_m"][-1]
    assert axes["xi_m"][0] < xi_m < axes["xi_m"][-1]

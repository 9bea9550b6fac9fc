"""The probability of instability: known cases, rare events, conditions, executors, and what is refused."""

import json
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.study.answers import evaluate
from yawdesign.study.probability import percentiles, probability_unstable
from yawdesign.study.replicates import workers_of
from yawdesign.study.request import Question
from yawdesign.study.uncertainty import judged_vehicle

CONICITY = {"lambda": {"uniform": [0.05, 0.4]}}
MAP = CONICITY | {"creep_factor": {"uniform": [0.5, 1.0]}}
THREE = MAP | {"K_m": {"lognormal": "10 %"}}
RARE = {
    "lambda": {"lognormal": "20 %"},
    "K_m": {"lognormal": "16 %"},
    "C_m": {"normal": "15 %"},
    "C_s": {"normal": "12 %"},
}


def problem(distributions, C_s=1046770.0, **more):
    return yd.table1().replace(C_s=C_s, uncertainty=distributions, **more)


def probability(one, samples, seed=0):
    with workers_of(None, lambda text, part: None) as workers:
        return probability_unstable(workers, judged_vehicle(one), samples, seed)


@pytest.fixture(scope="module")
def result():
    return yd.uncertainty(problem(THREE), samples=2**11)


@pytest.mark.parametrize("C_s", [3e5, 4e5])
def test_one_parameter_against_a_dense_row_of_its_values(C_s):
    one, n = problem(CONICITY, C_s), 2**16
    row = one.parameters() | {"lambda": 0.05 + 0.35 * (np.arange(n) + 0.5) / n}
    share = 1 - evaluate(Question.about(one, "stable"), row).columns["stable"].mean()
    found = probability(one, 2**16)
    assert found.status == "estimated"
    assert found.value == pytest.approx(share, abs=1e-4)
    assert found.interval[0] <= found.value <= found.interval[1]


def test_a_map_of_conicity_and_creep():
    found = probability(problem(MAP), 2**16)
    assert found.value == pytest.approx(0.048661, abs=3e-4)  # of 2**24 samples
    assert found.interval[1] - found.interval[0] < 2e-3
    assert found.unverified == 0


@pytest.mark.slow
def test_the_interval_holds_the_probability_for_most_seeds():
    found = [probability(problem(MAP), 2**12, seed) for seed in range(100)]
    assert 88 <= sum(low < 0.048661 < high for low, high in (x.interval for x in found)) < 100


@pytest.mark.slow
def test_rare_failures_against_many_plain_samples():
    many = probability(problem(RARE), 2**23)
    few = probability(problem(RARE), 2**17)
    assert (many.status, few.status) == ("estimated", "rare")
    assert few.interval[0] < many.value < few.interval[1]
    assert few.value == pytest.approx(many.value, rel=0.3)
    assert "importance sampling" in few.method


def test_what_the_samples_cannot_tell_is_refused():
    found = probability(problem({"K_m": {"uniform": ["90 %", "110 %"]}}), 2**12)
    assert (found.value, found.status, found.failures) == (None, "too few failures", 0)
    assert found.interval == pytest.approx((0, 3.689 / 2**12), rel=1e-3)  # no failure: 1 - 0.025^(1/n)
    certain = probability(problem({"K_m": {"uniform": ["90 %", "110 %"]}}, C_s=1e4), 2**12)
    assert certain.value is None
    assert certain.interval == pytest.approx((1 - 3.689 / 2**12, 1), rel=1e-3)


def test_a_distribution_replaces_the_condition_of_its_name_and_the_others_stay():
    conditions = {"lambda": [0.05, 0.4], "creep_factor": [1.0, 0.5], "tolerance": {"K_m": "10 %", "C_m": "10 %"}}
    one = judged_vehicle(problem(CONICITY | {"K_m": {"normal": "5 %"}}, conditions=conditions))
    names = {name for condition in one.question.conditions for name, _ in condition.changes}
    assert names == {"v", "creep_factor", "tolerance.C_m"}
    assert len(one.question.conditions) == 2 * 9  # a range that stays is looked at inside too
    worst = probability(problem(CONICITY, C_s=7e5, conditions={"creep_factor": [1.0, 0.6]}), 2**12)
    alone = probability(problem(CONICITY | {"creep_factor": {"uniform": ["60 %", "60.0001 %"]}}, C_s=7e5), 2**12)
    assert worst.value == pytest.approx(alone.value, abs=2e-3)


def test_speed_and_car_body(car_body):
    body = yd.CarBody(**(car_body | {"l_c": 9.5}))
    distributions = {"speed": {"uniform": ["250 km/h", "350 km/h"]}, "M_c": {"normal": "10 %"}}
    found = probability(problem(distributions, speed=("200 km/h", "300 km/h"), car_body=body), 2**10)
    assert 0 <= found.interval[0] <= found.interval[1] <= 1


def test_a_result(result):
    plain = result.to_dict()
    assert {"probability_unstable", "interval", "samples", "percentiles", "sobol"} <= set(plain)
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert result.stable
    assert result.checked
    assert (result.compared, result.differences) == (2048, 0)
    assert result.percentiles["margin"]["1"] < result.percentiles["margin"]["99"]
    assert result.margin == pytest.approx(yd.stability(yd.table1().replace(C_s=1046770.0)).decay_rate)
    for index in result.sobol.values():
        assert index.first <= index.total + index.first_error + index.total_error
    assert sum(index.first for index in result.sobol.values()) < 1


def test_the_derivatives_are_those_of_the_margin(result):
    base, margins = yd.table1().replace(C_s=1046770.0), []
    for sign in (-1, 1):
        margins.append(yd.stability(base.replace(K_m=float(base.bogie.K_m) * (1 + 1e-4 * sign))).decay_rate)
    slope = (margins[1] - margins[0]) / 2e-4
    assert result.effects["K_m"].margin == pytest.approx(0.1 * slope, rel=1e-4)
    factors = (yd.stability(base.replace(f_11=f * 11511e3, f_22=f * 11511e3)).decay_rate for f in (1 - 1e-4, 1 + 1e-4))
    low, high = factors
    assert result.effects["creep_factor"].margin == pytest.approx((high - low) / 2e-4 * 0.5 / 12**0.5, rel=1e-4)
    assert result.effects["K_m"].sensitivity == pytest.approx(yd.design(base).sensitivity["K_m"], rel=1e-5)


def test_percentiles_of_what_does_not_exist():
    assert percentiles(np.array([3.0, np.nan, 1.0, 2.0]), (0, 50, 99)) == (1.0, 3.0, None)


@pytest.mark.slow
def test_the_numbers_do_not_depend_on_who_computes(result):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        other = yd.uncertainty(problem(THREE), samples=2**11, executor=executor)
    assert other.to_dict() == result.to_dict()


def test_refusals():
    with pytest.raises(yd.ProblemError, match="uncertainty is missing"):
        yd.uncertainty(yd.table1().replace(C_s=1e6))
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.uncertainty(yd.table1().replace(C_s=None, uncertainty=CONICITY))
    with pytest.raises(yd.ProblemError, match="samples: 10 is not a whole number from"):
        yd.uncertainty(problem(CONICITY), samples=10)


@pytest.fixture
def file(tmp_path):
    def written(text):
        path = tmp_path / "problem.yaml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return written


TEXT = "bogie: {{base: table1, C_s: {}}}\nspeed: 300 km/h\nuncertainty:\n  lambda: {{uniform: [0.05, 0.40]}}\n"


def test_the_command(file, tmp_path):
    picture = tmp_path / "tornado.svg"
    options = ["--samples", "1024", "--seed", "2", "--plot", str(picture)]
    done = CliRunner().invoke(app, ["uncertainty", file(TEXT.format(4e5)), *options])
    assert done.exit_code == 0, done.output
    assert "The probability that it is unstable is 0.34" in done.stdout
    assert picture.stat().st_size > 1000
    done = CliRunner().invoke(app, ["uncertainty", file(TEXT.format(1e4)), "--samples", "1024", "--json"])
    assert done.exit_code == 1  # unstable as designed
    assert json.loads(done.stdout)["stable"] is False
    done = CliRunner().invoke(app, ["uncertainty", file("bogie: {base: table1}\nspeed: 300 km/h\n")])
    assert done.exit_code == 2
    done = CliRunner().invoke(app, ["uncertainty", file(TEXT.format(1e6)), "--of", "tornadoes"])
    assert done.exit_code == 2
    assert "did you mean tornado?" in done.stderr


@pytest.mark.parametrize("of", ["tornado", "margin", "C_sl"])
def test_pictures(result, of):
    axes = yd.plot(result, of=of)
    assert axes.get_title(loc="left").startswith("Probability of instability: 0.0")

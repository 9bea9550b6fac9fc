"""The front between margin and rotational resistance: every point an optimum, none beaten, and what it refuses."""

import csv
import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import differential_evolution
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.damper import trade_off as module
from yawdesign.damper.design_space import Space
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.problem.conditions import conditions
from yawdesign.problem.parameters import CarBody
from yawdesign.vehicle.vehicle import Model

DAMPER = {"C_s": yd.Variable(min=1e4, max=1e7)}
CURVE = yd.table1().curve
FILE = """
bogie: {base: table1}
speed: 300 km/h
curve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90 km/h, limit: 0.08}
design: {variables: {C_s: {min: 10 kN s/m, max: 10 MN s/m}}}
"""
TWO = {"lambda": [0.10, 0.40], "creep_factor": [0.5]}


def with_variables(problem, variables=None, objective="decay_rate"):
    return problem.replace(design=yd.Design(objective=objective, variables=variables or DAMPER))


def independent_margin(problem, point):
    """Return the worst decay rate of the whole state matrix under all conditions, without the motors' own modes."""
    design = {name: point[name] for name in ("C_s", "K_m", "C_m") if point[name] is not None}
    worst = np.inf
    for condition in conditions(problem):
        p = condition.applied({**problem.parameters(), **design})
        s = np.linalg.eigvals(state_matrix(Model.of(problem).at(p)))
        for root in np.roots([float(p[name]) for name in ("J_m", "C_mphi", "K_mphi")]) if "J_m" in p else ():
            for _ in range(2):
                s = np.delete(s, np.argmin(abs(s - root)))
        worst = min(worst, -s.real.max())
    return worst


def check(result):
    """Check what holds for every front."""
    for before, after in pairwise(result.front):
        assert after["rotational_resistance"] > before["rotational_resistance"]
        assert after["margin"] > before["margin"]
    assert all(point["stable"] and point["checked"] for point in result.front)
    assert all(each.met for point in result.front for each in point["requirements"])
    assert all(point["rotational_resistance"] <= 2 * result.limit * (1 + 1e-9) for point in result.front)


@pytest.fixture(scope="module")
def damper_alone():
    problem = with_variables(yd.table1().replace(conditions=TWO))
    return problem, yd.trade_off(problem, points=4)


@pytest.fixture
def quick(monkeypatch):
    """Let the best design be the one with the most damping, so that a front takes no time; return how often."""
    calls = []

    def most_damping(problem, known, near, seed, progress=None):
        calls.append(problem.curve.limit)
        space = Space(problem, known=known)
        return known, {name: float(x) for name, x in space.values(np.ones(1)).items()}

    monkeypatch.setattr(module, "_solved", most_damping)
    return calls


def test_of_one_damper_the_front_is_its_margin_over_C_s(damper_alone):
    problem, result = damper_alone
    check(result)
    assert result.status == "ok"
    assert {point["K_m"] for point in result.front} == {626480.0}
    for point in result.front:
        assert point["margin"] == pytest.approx(independent_margin(problem, point), abs=1e-6)
        assert set(point["worst_condition"]) == {"speed", "lambda", "creep_factor"}


def test_a_point_is_the_optimum_with_its_resistance(damper_alone):
    problem, result = damper_alone
    point = result.front[1]
    best = yd.optimise(problem.replace(limit=point["rotational_resistance"]))
    assert best.margin == pytest.approx(point["margin"], rel=1e-6)
    assert result.limit in [pytest.approx(point["rotational_resistance"]) for point in result.front]


def test_it_begins_where_a_design_becomes_stable(damper_alone):
    problem, result = damper_alone
    first = result.front[0]
    assert 0 < first["margin"] < 0.01
    assert first["C_s"] == pytest.approx(yd.design(problem).C_sl, rel=1e-3)


def test_golden_section_and_design_as_written_stand_beside_it(damper_alone):
    problem, result = damper_alone
    design = yd.design(problem)
    assert result.golden["C_s"] == design.C_s
    assert result.golden["rotational_resistance"] == pytest.approx(design.rotational_resistance)
    assert result.golden["margin"] == pytest.approx(independent_margin(problem, result.golden), abs=1e-6)
    assert result.written["C_s"] == 1e6
    assert result.written["rotational_resistance"] < result.golden["rotational_resistance"]


def test_json_and_table(damper_alone, tmp_path):
    _, result = damper_alone
    data = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert {"rotational_resistance", "margin", "C_s", "K_m", "C_m"} <= set(data["front"][0])
    assert data["golden"]["margin"] > 0
    result.to_csv(tmp_path / "front.csv")
    lines = [line for line in (tmp_path / "front.csv").read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    assert [float(row["margin"]) for row in rows] == [point["margin"] for point in result.front]
    assert "worst_lambda" in rows[0]
    with pytest.raises(yd.ProblemError, match="exists"):
        result.to_csv(tmp_path / "front.csv")


def test_picture(damper_alone):
    _, result = damper_alone
    ax = yd.plot(result)
    labels = {line.get_label() for line in ax.lines}
    assert {"largest margin with this resistance", "limit of the curve, 0.08"} <= labels
    below = ax.get_figure().axes[1:]
    assert [panel.get_ylabel().split("\n")[0] for panel in below] == [
        r"$C_\mathrm{s}$",
        r"$K_\mathrm{m}$",
        r"$C_\mathrm{m}$",
    ]
    assert all(panel.get_shared_x_axes().joined(panel, ax) for panel in below)


@pytest.mark.slow
def test_two_points_are_the_ends(damper_alone):
    problem, result = damper_alone
    ends = yd.trade_off(problem, points=2).front
    assert len(ends) == 2
    for one, other in zip(ends, (result.front[0], result.front[-1]), strict=True):
        assert one["margin"] == pytest.approx(other["margin"], rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("points", [1, 0, 2.5, "many"])
def test_fewer_points_than_two_are_refused(points):
    with pytest.raises(yd.ProblemError, match="points"):
        yd.trade_off(yd.table1(), points=points)


def test_without_a_curve_there_is_nothing_to_trade():
    with pytest.raises(yd.ProblemError, match="curve is missing"):
        yd.trade_off(replace(yd.table1(), curve=None))


def test_a_limit_that_no_damper_keeps_says_what_to_do():
    result = yd.trade_off(with_variables(yd.table1().replace(limit=0.01)))
    assert (result.status, result.front) == ("infeasible", ())
    assert "0.0309" in result.message
    with pytest.raises(yd.ProblemError, match="nothing to draw"):
        yd.plot(result)


def test_requirements_that_no_design_meets():
    problem = with_variables(yd.table1().replace(requirements={"damping_ratio": 0.5}))
    result = yd.trade_off(problem, points=2)
    assert (result.status, result.front) == ("infeasible", ())
    assert "requirements" in result.message


@pytest.mark.slow
def test_requirements_are_met_from_the_first_point_on():
    problem = with_variables(yd.table1().replace(requirements={"damping_ratio": 0.03}))
    free = yd.trade_off(problem.replace(requirements={}), points=3)
    result = yd.trade_off(problem, points=3)
    check(result)
    assert result.front[0]["rotational_resistance"] > free.front[0]["rotational_resistance"]
    assert result.front[0]["requirements"][0].reached == pytest.approx(0.03, abs=1e-4)


@pytest.mark.slow
def test_a_trailer_bogie_has_no_motors():
    result = yd.trade_off(with_variables(replace(yd.table1("trailer"), curve=CURVE)), points=3)
    check(result)
    assert result.variables == ("C_s",)


@pytest.mark.slow
def test_it_stops_where_more_resistance_leaves_no_more_margin():
    problem = with_variables(yd.table1(), objective="damping_ratio")
    result = yd.trade_off(problem, points=4)
    check(result)
    assert result.ends_at < 2 * result.limit
    assert "ends at" in result.message
    assert result.front[-1]["rotational_resistance"] == pytest.approx(result.ends_at)


def test_an_executor_computes_the_points(quick):
    problem = with_variables(yd.table1())
    alone = yd.trade_off(problem, points=6)
    count = len(quick)
    with ThreadPoolExecutor(2) as executor:
        other = yd.trade_off(problem, points=6, executor=executor)
    assert other == alone
    assert len(quick) == 2 * count


def test_what_is_finished_is_kept(quick, monkeypatch):
    solved = module._solved

    def stopped(*task, **more):
        if len(quick) == 3:
            raise KeyboardInterrupt
        return solved(*task, **more)

    monkeypatch.setattr(module, "_solved", stopped)
    with pytest.raises(yd.IncompleteTradeOffError, match="stopped") as caught:
        yd.trade_off(with_variables(yd.table1()), points=6)
    assert caught.value.result.front
    assert caught.value.result.status == "incomplete"


@pytest.fixture
def file(tmp_path, quick):
    path = tmp_path / "problem.yaml"
    path.write_text(FILE, encoding="utf-8")
    return path


def run(*arguments):
    return CliRunner().invoke(app, ["trade-off", *map(str, arguments)])


def test_command(file, tmp_path):
    outputs = ["--csv", tmp_path / "a.csv", "--plot", tmp_path / "a.png"]
    done = run(file, "--points", 3, *outputs, "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["front"]
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    again = run(file, *outputs)
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert run(file, "--points", 1).exit_code == 2
    table = run(file, "--points", 2, *outputs, "--force")
    assert table.exit_code == 0
    assert "golden" in table.stdout


def test_command_stopped(file, tmp_path, monkeypatch):
    result = yd.trade_off(with_variables(yd.table1()), points=2)

    def stop(problem, **options):
        raise yd.IncompleteTradeOffError("it was stopped", result) from KeyboardInterrupt()

    monkeypatch.setattr(module, "trade_off", stop)
    done = run(file, "--csv", tmp_path / "a.csv")
    assert done.exit_code == 130
    assert (tmp_path / "a.csv").is_file()


@pytest.mark.slow
def test_three_variables_move_and_differential_evolution_beats_no_point():
    problem = yd.table1().replace(conditions={"lambda": [0.05, 0.15, 0.40], "creep_factor": [1, 0.5]})
    result = yd.trade_off(problem, points=4)
    check(result)
    for name in ("K_m", "C_m"):
        values = [point[name] for point in result.front]
        assert max(values) > 1.5 * min(values)
    names = ("C_s", "K_m", "C_m")

    def negative(x):
        return -independent_margin(problem, dict(zip(names, np.exp(x), strict=True)))

    for seed, point in enumerate(result.front[1:]):
        assert point["margin"] == pytest.approx(independent_margin(problem, point), abs=1e-6)
        high = [point["C_s"], 6264800.0, 199500.0]
        bounds = list(zip(np.log([1e4, 62648.0, 1995.0]), np.log(high), strict=True))
        found = differential_evolution(negative, bounds, maxiter=20, popsize=8, polish=False, rng=seed)
        assert -found.fun <= point["margin"] * (1 + 1e-6)


@pytest.mark.slow
def test_ranges_of_conditions():
    problem = yd.table1().replace(conditions={"lambda": {"min": 0.05, "max": 0.40}, "creep_factor": 0.5})
    result = yd.trade_off(with_variables(problem), points=3)
    check(result)
    inside = np.linspace(0.05, 0.40, 60)
    for point in result.front[1:]:
        fine = problem.replace(conditions={"lambda": list(inside), "creep_factor": 0.5})
        assert point["margin"] == pytest.approx(independent_margin(fine, point), rel=2e-3)


@pytest.mark.slow
def test_a_vehicle_with_a_car_body():
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    result = yd.trade_off(with_variables(replace(yd.table1(), car_body=body)), points=2)
    check(result)
    assert result.front

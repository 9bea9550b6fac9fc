"""Forward design under lists, ranges, tolerances and loads: against single conditions, and against dense grids."""

from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.decision import decide, together
from yawdesign.damper.single_bogie import of_bogie
from yawdesign.damper.stable_intervals import MOST_ALONE
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.output.tables import design_tables, rendered
from yawdesign.problem.conditions import condition_set
from yawdesign.vehicle.vehicle import Model

PROBLEMS = Path(__file__).parents[2] / "problems"
TABLE1 = yd.table1().replace(speed="300 km/h")
LISTS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1.0, 0.7, 0.5]}
RANGES = {"lambda": {"min": 0.05, "max": 0.40}, "creep_factor": {"min": 0.5, "max": 1.0}}


def numbers(problem):
    return {name: float(x) for name, x in problem.parameters().items() if name != "C_s"}


def on_a_grid(problem, counts):
    """Return the stable intervals under every condition of a grid in the ranges, which are named as its changes are."""
    (condition,), p = condition_set(problem).lists, numbers(problem)
    axes = [np.linspace(*ends, n) for (_, ends), n in zip(condition_set(problem).ranges, counts, strict=True)]
    points = [x.ravel() for x in np.meshgrid(*axes, indexing="ij")]
    names = [name for name, _ in condition_set(problem).ranges]
    values = condition.with_values(dict(zip(names, points, strict=True))).applied(p)
    field = critical_field(ParameterSets(Model.of(problem), values, points[0].size))
    none = np.array([np.inf]), np.array([True])
    return decide([together(field.critical, field.unstable_roots)], *none).stable_intervals(0)


def test_every_combination_of_lists():
    result = yd.design(TABLE1.replace(conditions=LISTS))
    assert result.C_sl == pytest.approx(1_149_469.974, abs=0.01)
    assert (result.stable, result.checked, len(result.critical)) == (True, True, 15)
    assert result.worst_condition == {"speed": pytest.approx(300 / 3.6), "lambda": 0.25, "creep_factor": 0.5}
    alone = yd.design(yd.table1().replace(speed="300 km/h", lambda_=0.25, f_11=TABLE1.bogie.f_11 / 2,
                                          f_22=TABLE1.bogie.f_22 / 2))  # fmt: skip
    assert alone.C_sl == pytest.approx(result.C_sl, rel=1e-12)
    assert result.sensitivity == pytest.approx(alone.sensitivity)
    assert "all 15 conditions" in result.searched


def test_every_value_of_ranges():
    result = yd.design(TABLE1.replace(conditions=RANGES))
    assert result.C_sl == pytest.approx(1_153_065.48, rel=1e-6)  # by a grid of 401 x 21 around the worst condition
    assert result.worst_condition["lambda"] == pytest.approx(0.2692, abs=1e-3)
    assert result.worst_condition["creep_factor"] == 0.5
    assert "no proof" in result.searched
    assert len(result.critical) == 5  # those of the corners, and the one that sets C_sl


def test_every_speed_of_a_range():
    result = yd.design(TABLE1.replace(conditions=RANGES, speed=yd.SpeedRange(min="50 km/h", max="330 km/h", steps=2)))
    assert result.C_sl == pytest.approx(1_241_241.05, rel=1e-6)
    assert result.worst_condition["speed"] == pytest.approx(330 / 3.6)


def test_many_listed_conditions_are_looked_at_together():
    values = [*np.linspace(0.05, 0.4, 27), 0.25]
    lists = {"lambda": sorted(set(values)), "creep_factor": [1.0, 0.7, 0.5]}
    result = yd.design(TABLE1.replace(conditions=lists))
    assert len(lists["lambda"]) * 3 > MOST_ALONE
    each = yd.sweep(TABLE1.replace(conditions={"creep_factor": [1.0, 0.7, 0.5]}), of="C_sl", lambda_=lists["lambda"])
    assert result.C_sl == pytest.approx(max(each.values), rel=1e-8)
    assert result.stable
    assert result.sensitivity
    assert len(result.critical) < 10


def test_what_is_stable_under_many_conditions_together():
    rng = np.random.default_rng(5)
    for _ in range(200):
        n, m = rng.integers(1, 6), rng.integers(0, 4)
        critical = np.sort(rng.integers(1, 12, (n, m)).astype(float), axis=1)
        counts = rng.integers(0, 2, (n, m + 1)).astype(float)
        for row in range(n):  # rows of several lengths
            left = rng.integers(0, m + 1)
            critical[row, left:], counts[row, left + 1 :] = np.nan, np.nan
        everything = np.array([np.inf]), np.array([True])
        one_by_one = [(critical[k : k + 1], counts[k : k + 1]) for k in range(n)]
        middles = [(a + b) / 2 for a, b in zip(range(12), range(1, 13), strict=True)]
        found = [decide(x, *everything).stable_intervals(0) for x in ([together(critical, counts)], one_by_one)]
        inside = [[any(a < x < b for a, b in intervals) for x in middles] for intervals in found]
        assert inside[0] == inside[1]


def test_a_tolerance_of_the_damping():
    exact = yd.design(TABLE1)
    result = yd.design(TABLE1.replace(conditions={"tolerance": {"C_s": 0.15}}))
    assert result.C_sl == pytest.approx(exact.C_sl / 0.85, rel=1e-9)
    assert result.C_su == pytest.approx(exact.C_su / 1.15, rel=1e-12)
    assert result.C_s == pytest.approx(0.382 * result.C_su + 0.618 * result.C_sl, rel=1e-12)
    assert result.worst_condition["tolerance.C_s"] == -0.15
    p, curve = TABLE1.bogie.parameters(), TABLE1.curve
    assert result.rotational_resistance == pytest.approx(rotational_resistance(p, 1.15 * result.C_s, curve), rel=1e-12)
    assert result.sensitivity == pytest.approx(exact.sensitivity, rel=1e-6)
    upper = yd.design(TABLE1.replace(speed="330 km/h", conditions=LISTS)).stable_intervals[-1]
    shifted = yd.design(TABLE1.replace(speed="330 km/h", conditions=LISTS | {"tolerance": {"C_s": 0.15}}))
    assert shifted.stable_intervals[-1] == pytest.approx((upper[0] / 0.85, upper[1] / 1.15), rel=1e-5)


def test_loads_and_tolerances_act_on_the_curve():
    load = {"tare": {"W": "120 kN"}, "laden": {"W": "200 kN", "M_b": "8 t"}}
    result = yd.design(TABLE1.replace(conditions={"load": load, "tolerance": {"K_2x": 0.1}}))
    p = {**numbers(TABLE1), "W": 120e3, "K_2x": 1.1 * TABLE1.bogie.K_2x}
    assert result.C_su == pytest.approx(curving_limit(p, TABLE1.curve), rel=1e-12)
    assert result.rotational_resistance == pytest.approx(rotational_resistance(p, result.C_s, TABLE1.curve), rel=1e-12)
    assert {x.condition["load"] for x in result.critical} == {"tare", "laden"}


@pytest.mark.parametrize("seed", range(3))
def test_no_grid_finds_what_the_search_has_not(seed):
    rng = np.random.default_rng(seed)
    p = numbers(TABLE1)
    changed = {name: p[name] * np.exp(rng.normal(0, 0.15)) for name in ("K_1x", "K_1y", "K_2x", "K_2y", "C_t", "K_ds")}
    problem = TABLE1.replace(**changed, conditions=RANGES, speed="270 km/h")
    result = yd.design(problem)
    brute = on_a_grid(problem, (71, 41))
    assert result.checked
    assert len(result.stable_intervals) == len(brute)
    for found, grid in zip(result.stable_intervals, brute, strict=True):
        assert found[0] >= grid[0] * (1 - 2e-4)
        assert found[1] <= grid[1] * (1 + 2e-4)
        assert found == pytest.approx(grid, rel=0.01)  # a grid misses little


def agrees(problem, points):
    """Return the design, after comparing its intervals with those of a grid of its only range."""
    result, brute = yd.design(problem), on_a_grid(problem, (points,))
    assert result.checked
    assert len(result.stable_intervals) == len(brute)
    for found, grid in zip(result.stable_intervals, brute, strict=True):
        assert found == pytest.approx(grid, rel=2e-4)
        assert found[0] >= grid[0] * (1 - 2e-5)
        assert found[1] <= grid[1] * (1 + 2e-5)
    return result


def test_both_ends_of_a_range_are_stable_for_every_damping_and_what_lies_between_is_not():
    problem = yd.table1(equations="as-printed").replace(conditions={"lambda": {"min": 0.03, "max": 0.12}})
    ends = yd.design(problem.replace(conditions={"lambda": [0.03, 0.12]}))
    assert ends.status == "stable for every C_s"
    assert agrees(problem, 2001).C_sl > 3.6e5


def test_an_inner_unstable_band_over_a_range():
    """Of the motors' stiffness around 3.3 Hz: several critical values, which fold within the range."""
    printed = yd.table1(equations="as-printed")
    low, high = (printed.bogie.M_m * (2 * np.pi * f) ** 2 for f in (3.2, 3.4))
    variables = {"C_s": yd.Variable(min=1e4, max=1e7)}
    problem = printed.replace(design=yd.Design(variables=variables), conditions={"K_m": {"min": low, "max": high}})
    assert len(agrees(problem, 4001).stable_intervals) == 2


def test_requirements_and_faults_of_the_golden_section():
    case = {"one yaw damper lost": {"C_s": "50 %", "K_ds": "50 %"}}
    problem = TABLE1.replace(conditions=LISTS, cases=case, requirements={"damping_ratio": 0.05, "decay_rate": 0.1})
    result = yd.design(problem)
    damping, decay = result.requirements
    chosen = yd.stability(problem.replace(C_s=result.C_s))
    assert damping.reached == pytest.approx(chosen.damping_ratio, rel=1e-9)
    assert (damping.met, decay.met) == (chosen.damping_ratio >= 0.05, chosen.decay_rate >= 0.1)
    assert [x.name for x in result.cases] == [*case]
    nothing = yd.design(yd.table1().replace(curve=None))
    assert (nothing.requirements, nothing.cases) == ((), ())


@pytest.mark.slow
def test_a_vehicle_with_its_car_body():
    problem = yd.load(PROBLEMS / "vehicle.yaml").replace(conditions=RANGES)
    result = yd.design(problem)
    assert result.C_sl == pytest.approx(9_324_860, rel=1e-4)
    assert result.single_bogie.C_sl < result.C_sl
    worst = {name: x for name, x in result.worst_condition.items() if name != "speed"}
    alone = yd.design(problem.replace(conditions={name: [x] for name, x in worst.items()}))
    assert alone.C_sl == pytest.approx(result.C_sl, rel=1e-9)


def test_a_single_bogie_has_no_conditions_of_its_car_body():
    problem = yd.load(PROBLEMS / "vehicle.yaml")
    mass = {"load": {"tare": {"M_c": 30e3}, "laden": {"M_c": 45e3}}, "tolerance": {"M_c": 0.05, "K_1x": 0.1}}
    conditions = condition_set(problem.replace(conditions=mass))
    left = of_bogie(conditions, Model.of(problem))
    assert [name for name, _ in left.ranges] == ["tolerance.K_1x"]
    assert {x.load.changes for x in left.lists} == {()}


def test_tables_and_picture_name_the_conditions():
    result = yd.design(TABLE1.replace(conditions=LISTS))
    text = rendered(design_tables(result))
    assert "under all 15 conditions" in text.splitlines()[0]
    assert "Critical values: 12 of 15" in text
    assert "lambda 0.25, creep x 0.5, 300 km/h" in text
    axes = yd.plot(result)
    assert "all 15 conditions" in axes.get_title("left")
    assert any("creep x 0.5" in each.get_text() for each in axes.get_yticklabels())

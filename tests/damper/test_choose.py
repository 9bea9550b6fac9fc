"""Choosing a damper from a catalogue: every row as if it stood in the problem, and the best first."""

import json
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.damper import choose as choosing
from yawdesign.damper.catalogue_optimum import best_of_catalogue
from yawdesign.damper.curving import largest_resistance
from yawdesign.damper.scored_rows import with_damper
from yawdesign.output.choice_tables import choice_tables
from yawdesign.output.tables import rendered
from yawdesign.problem.conditions import conditions

LISTS = {"lambda": [0.05, 0.15, 0.4], "creep_factor": [0.5, 1.0]}
LOST = {"one yaw damper lost": {"C_s": "50 %", "K_ds": "50 %"}}
BOUNDS = {"C_s": yd.Variable(min=100e3, max=3e6), "K_m": yd.Variable(min=100e3, max=2e6)}


def rows(number, seed=0, rigid=()):
    """Return so many dampers, from weak ones to what no curve allows."""
    rng = np.random.default_rng(seed)
    stiffness = rng.uniform(4e6, 40e6, number).tolist()
    for k in rigid:
        stiffness[k] = "rigid"
    damping = np.geomspace(40e3, 1.6e6, number).tolist()
    return [{"name": f"D{k}", "damping": damping[k], "stiffness": stiffness[k]} for k in range(number)]


def problem(catalogue, variables=BOUNDS, **more):
    return replace(yd.table1(), design=yd.Design(catalogue=catalogue, variables=variables), **more)


MORE = [
    {},
    {"conditions": LISTS},
    pytest.param({"conditions": {**LISTS, "tolerance": {"C_s": "15 %"}}, "cases": LOST}, marks=pytest.mark.slow),
    {
        "conditions": {"load": {"tare": {"W": "120 kN"}, "laden": {"W": "200 kN"}}},
        "cases": LOST,
        "requirements": {"damping_ratio": "7 %", "cases": {"damping_ratio": "1 %"}},
    },
    {"speed": (60.0, 80.0), "requirements": {"decay_rate": 1.5}},
]


@pytest.mark.parametrize("more", MORE)
def test_every_row_is_what_it_is_in_the_problem(more, monkeypatch):
    """The others are scored on arrays, the first three one by one; both against eigenvalues of each row alone."""
    monkeypatch.setattr(choosing, "CLOSER", 3)
    asked = problem(rows(10, rigid=(5, 8)), **more)
    found = yd.choose(asked)
    dampers = {each.name: each for each in asked.design.catalogue}
    assert {each.name for each in found.candidates} == set(dampers)
    for each in found.candidates:
        alone = with_damper(asked, dampers[each.name])
        verdict = yd.stability(alone)
        p = alone.parameters()
        resistance = largest_resistance(p, each.C_s, conditions(alone), asked.curve)
        assert each.rotational_resistance == pytest.approx(resistance)
        assert each.status == expected(each, verdict, resistance)
        assert not each.searched or each.status in ("ok", "unverified") or each.reason
        if not asked.conditions.tolerance:
            assert each.margin == pytest.approx(verdict.decay_rate, rel=1e-7)
            assert [x.stable for x in each.cases] == [x.stable for x in verdict.cases]
            assert [x.met for x in each.requirements] == [x.met for x in verdict.requirements]
    good = [each.margin for each in found.candidates if each.status == "ok"]
    assert good == sorted(good, reverse=True)
    assert all(each.status == "ok" for each in found.candidates[: len(good)])


def expected(candidate, verdict, resistance):
    """Return the status of a damper by the verdict on it alone."""
    if not 100e3 <= candidate.C_s <= 3e6:
        return "outside the bounds"
    if resistance > 0.08:
        return "exceeds the curve's limit"
    if not verdict.stable:
        return "unstable"
    return "ok" if all(x.met for x in verdict.requirements) else "misses a requirement"


@pytest.mark.slow
def test_inside_ranges_the_worst_condition_is_searched():
    asked = problem(
        rows(30),
        conditions={"lambda": {"min": 0.05, "max": 0.4}, "creep_factor": {"min": 0.5, "max": 1}},
        requirements={"critical_speed": "310 km/h"},
    )
    found = yd.choose(asked, executor=ThreadPoolExecutor(2))
    first = [each for each in found.candidates if each.status == "ok"][:10]
    assert first
    assert all(each.searched for each in first)
    for each in first[:2]:
        alone = with_damper(asked, next(x for x in asked.design.catalogue if x.name == each.name))
        verdict = yd.stability(alone)
        assert each.margin == pytest.approx(verdict.decay_rate, rel=1e-9)
        assert verdict.requirements == each.requirements
        rng = np.random.default_rng(1)
        for conicity, creep in rng.uniform((0.05, 0.5), (0.4, 1.0), (20, 2)):
            there = replace(alone, conditions={"lambda": [conicity], "creep_factor": [creep]}, requirements=())
            assert yd.stability(there).decay_rate > each.margin * (1 - 1e-3)


def test_reasons_have_numbers():
    limits = yd.Design(
        catalogue=rows(8),
        variables={"C_s": yd.Variable(min=100e3, max=8e6), "K_ds": yd.Variable(min=12e6, max=90e6)},
    )
    found = yd.choose(replace(yd.table1(), design=limits, requirements={"decay_rate": 2.5}))
    reasons = {each.status: each.reason for each in found.candidates}
    assert reasons["outside the bounds"].startswith("C_s = 80 kN·s/m is below its bound of 100 kN·s/m")
    assert (
        "T/(4 Q a) is 0.09152, and the limit is 0.08: at most 2 593.44 kN·s/m" in reasons["exceeds the curve's limit"]
    )
    assert reasons["misses a requirement"].startswith("decay_rate reaches ")


def test_a_rigid_joint_stays_rigid_in_a_fault():
    both = {"lost": {"C_s": "50 %", "K_ds": "50 %"}, "none": {"C_s": "0 %", "K_ds": "0.5 MN/m"}}
    rigid = yd.CatalogueDamper(name="A", damping=400e3, stiffness="rigid")
    changed = with_damper(problem([rigid], cases=LOST), rigid)
    assert [change.key for change in changed.cases[0].changes] == ["C_s"]
    with pytest.raises(yd.ProblemError, match=r"cases.none.K_ds: is rigid here"):
        yd.choose(problem([rigid], cases=both))


def test_what_is_refused():
    with pytest.raises(yd.ProblemError, match=r"design.catalogue is missing"):
        yd.choose(yd.table1())
    with pytest.raises(yd.ProblemError, match=r"conditions.K_ds: the rows of the catalogue have it"):
        yd.choose(problem(rows(2), conditions={"K_ds": [20e6]}))
    with pytest.raises(yd.ProblemError, match=r"no damper of it lies within the bounds: C_s 1 ... 2 N·s/m"):
        yd.optimise(problem(rows(2), {"C_s": yd.Variable(min=1, max=2)}))


def test_tables_and_picture():
    catalogue = [{**each, "blow_off": 12e3} for each in rows(40)]
    found = yd.choose(problem(catalogue, conditions={"lambda": [0.1, 0.2]}, cases=LOST, requirements={"decay_rate": 1}))
    text = " ".join(rendered(choice_tables(found)).split())
    assert f"The best damper is {found.best.name}" in text
    assert "2 conditions" in text
    assert "and 10 dampers more" in text
    assert "blow_off and damping_after" in text
    axes = yd.plot(found)
    shown = [label.get_text() for label in axes.get_legend().get_texts()]
    counts = Counter(each.status for each in found.candidates)
    assert sorted(shown) == sorted(f"{status} ({number})" for status, number in counts.items())
    nothing = yd.choose(problem(rows(1)))
    assert nothing.best is None
    assert "No damper" in yd.plot(nothing).get_title("left")
    assert "No damper of the catalogue keeps all limits" in rendered(choice_tables(nothing))


def run(*arguments):
    done = CliRunner().invoke(app, [*map(str, arguments)])
    assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
    return done


def test_the_command(tmp_path):
    (tmp_path / "d.csv").write_text("name,damping [kN s/m],stiffness [MN/m]\nweak,20,20\ngood,400,20\n")
    file = tmp_path / "p.yaml"
    file.write_text("bogie: {base: table1}\nspeed: 300 km/h\ndesign: {catalogue: d.csv}\n")
    done = run("choose", file, "--json")
    first, second = json.loads(done.stdout)["candidates"]
    assert done.exit_code == 0
    assert (first["name"], first["C_s"], first["K_ds"], first["status"]) == ("good", 800e3, 40e6, "ok")
    assert (second["name"], second["status"]) == ("weak", "unstable")
    assert first["requirements"] == first["cases"] == []
    assert first["rotational_resistance"] is None
    (tmp_path / "d.csv").write_text("name,damping [kN s/m],stiffness [MN/m]\nweak,20,20\n")
    assert run("choose", file).exit_code == 1
    (tmp_path / "d.csv").write_text("name,damping [kN s/m]\nweak,20\n")
    done = run("choose", file)
    assert done.exit_code == 2
    assert "d.csv:1:1: error: the column stiffness is missing" in done.stderr


def test_shipped_catalogue():
    shipped = yd.load(Path(__file__).parents[2] / "problems" / "table1-catalogue.yaml")
    assert yd.choose(shipped).best.name == "Y-1200"


class _Found:
    status, margin = "optimal", None

    def __init__(self, problem):
        self.problem = problem
        self.margin = yd.stability(problem).decay_rate


def test_of_a_catalogue_the_most_promising_are_optimised():
    asked = problem(rows(12), {"K_m": BOUNDS["K_m"]})
    seen = []

    def optimised(alone):
        seen.append(alone)
        return _Found(alone)

    damper, found = best_of_catalogue(asked, optimised)
    assert list(found.problem.design.variables) == ["K_m"]
    assert not found.problem.design.catalogue
    assert 3 <= len(seen) < 12
    assert found.margin == max(yd.stability(alone).decay_rate for alone in seen)
    assert found.problem.bogie.C_s == damper.C_s
    assert found.problem.bogie.K_ds == damper.K_ds


def test_without_other_variables_the_best_is_that_of_choose():
    asked = problem(rows(12), {"C_s": yd.Variable(min=10e3, max=10e6)})
    best, damper = yd.choose(asked).best, best_of_catalogue(asked, _Found)[0]
    assert damper.name == best.name


@pytest.mark.slow
def test_optimise_moves_the_other_variables():
    asked = problem(rows(8), {"C_s": BOUNDS["C_s"], "K_m": BOUNDS["K_m"]})
    found = yd.optimise(asked)
    damper = next(each for each in asked.design.catalogue if each.name == found.damper)
    assert found.status == "optimal"
    assert found.C_s == damper.C_s
    chosen = with_damper(asked, damper).replace(K_m=found.optimum["K_m"])
    assert yd.stability(chosen).decay_rate == pytest.approx(found.margin, rel=1e-6)
    every = []
    for each in asked.design.catalogue:
        alone = with_damper(asked, each)
        alone = replace(alone, design=replace(alone.design, variables={"K_m": BOUNDS["K_m"]}))
        if each.C_s <= 2593442:
            grid = [yd.stability(alone.replace(K_m=K_m)).decay_rate for K_m in np.geomspace(100e3, 2e6, 60)]
            every.append(max(grid))
    assert found.margin > max(every) * (1 - 1e-6)


def test_an_optimum_of_a_catalogue_without_an_answer_says_where_the_reasons_are():
    found = yd.optimise(problem(rows(2), {"C_m": yd.Variable(min=5e3, max=1e5)}, requirements={"damping_ratio": 0.3}))
    assert (found.status, found.relaxations) == ("infeasible", ())
    assert found.message.endswith("`choose` tells what each damper of the catalogue lacks")

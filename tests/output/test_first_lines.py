"""What stands above an answer: under which conditions it holds, and what it depends on most."""

from types import SimpleNamespace

import pytest

import yawdesign as yd
from yawdesign.output.optimum_tables import optimum_tables
from yawdesign.output.pictures import new_axes, set_title
from yawdesign.output.tables import design_tables, rendered
from yawdesign.output.trade_off_tables import trade_off_tables

EVERYWHERE = {"lambda": [0.1, 0.25], "creep_factor": [1, 0.5]}


@pytest.fixture(autouse=True)
def narrow(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")


def first_sentence(tables):
    return " ".join(rendered(tables).split()).split(". ")[0]


def test_design_under_one_condition_says_so_beside_the_large_sensitivities():
    assert first_sentence(design_tables(yd.design(yd.table1(equations="as-printed")))) == (
        "Forward design: ok, under one condition only: lambda 0.15, creep as given, 300 km/h; "
        "1 % more of a changes C_sl by -20.6 %, of v by +13.7 %, of f_11 by -7.9 %"
    )


def test_design_under_several_conditions_names_them_alone():
    told = first_sentence(design_tables(yd.design(yd.table1().replace(conditions=EVERYWHERE))))
    assert told == "Forward design: ok, under all 4 conditions (300 km/h; lambda 0.1, 0.25; creep x 1, 0.5)"


def test_an_optimum_tells_its_conditions_once_and_its_forward_design_does_not_advise_to_optimise():
    curve = yd.Curve(R="300 m", L="19 m", l="60 m", V_r="90 km/h", limit=0.04)
    design = yd.Design(variables={"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")})
    problem = yd.table1().replace(curve=curve, design=design, conditions={"lambda": 0.1, "creep_factor": 0.5})
    result = yd.optimise(problem)
    told = " ".join(rendered(optimum_tables(result)).split())
    assert result.status != "optimal"
    assert told.startswith(f"{result.status}, under one condition only: ")
    assert told.count("one condition only") == 1
    assert "Best found" in told
    assert "optimise K_m" not in told


def test_a_table_of_80_signs_cuts_no_number_of_a_trade_off_and_names_each_condition_once():
    point = {"rotational_resistance": 0.05, "margin": -0.317031, "C_s": 1e6, "K_m": 62648e2, "C_m": 25799.4}
    point |= {"stable": False, "checked": True}
    worst = [{"speed": 250 / 3, "lambda": x, "creep_factor": 0.5} for x in (0.05, 0.25, 0.05)]
    points = [{**point, "worst_condition": each} for each in worst]
    shown = {"status": "ok", "message": "found", "searched": "all 15 conditions", "objective": "decay_rate"}
    shown |= {"front": points[:2], "golden": points[2], "written": None, "variables": ("C_s", "K_m", "C_m")}
    text = rendered(trade_off_tables(SimpleNamespace(**shown)))
    assert text.startswith("ok, under all 15 conditions.\nFound.\n")
    assert "…" not in text
    assert text.count("-0.31703") == 3
    assert "1, golden" in text


def test_a_title_has_its_conditions_in_lines_that_fit():
    ax = new_axes(None)
    set_title(ax, "Critical speed: 259 km/h", "all 2 conditions (load $5; " + "creep x 1, 0.5, " * 6 + ")")
    title = ax.get_title(loc="left")
    assert title.startswith("Critical speed: 259 km/h, under all 2 conditions (load \\$5;")
    assert max(map(len, title.splitlines())) <= 80


def test_names_of_dampers_cover_no_other_name():
    dampers = [yd.CatalogueDamper(name=f"damper number {k}", damping=4e5 + k * 1e3, stiffness=2e7) for k in range(9)]
    problem = yd.table1().replace(design=yd.Design(catalogue=dampers))
    ax = yd.plot(yd.choose(problem))
    boxes = [text.get_window_extent() for text in ax.texts]
    assert 1 <= len(boxes) < 9
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert "under one condition only" in " ".join(ax.get_title(loc="left").split())

"""The paper reproduced: every row as docs/errata.md says, and rows that follow what they depend on."""

import json
import math
import signal
from dataclasses import replace

import numpy as np
import openpyxl
import pytest

import yawdesign as yd
from yawdesign.output import reproduction_folder
from yawdesign.problem.stopping import Stopped
from yawdesign.study import reproduction as study
from yawdesign.study.paper_bogie import paper_bogie
from yawdesign.study.reproduced_table_2 import readings
from yawdesign.study.reproduced_tables import equations_13_14, table_1, table_3

PRINTED, RECIPROCAL = "as-printed", "reciprocal"


@pytest.fixture(scope="module")
def reproduced():
    return study.reproduction()


def value(result, where, what, equations=None):
    """Return what was computed in the only row that begins so."""
    rows = [x for x in result.rows if x.where == where and x.what.startswith(what)]
    rows = [x for x in rows if equations is None or x.equations == equations]
    assert len(rows) == 1, [x.what for x in rows]
    return rows[0].computed


def test_a_request_to_stop_is_no_sweep_that_is_not_finished(monkeypatch):
    for name in ("figure_2", "table_2", "equations_9_11"):
        monkeypatch.setattr(study, name, lambda *given: ())
    monkeypatch.setattr("yawdesign.study.sweep.fill", lambda *given: Stopped(signal.SIGTERM))
    with pytest.raises(Stopped):
        study.reproduction()


def test_all_rows_agree_and_are_checked(reproduced):
    assert reproduced.agrees
    assert reproduced.checked
    assert not reproduced.changed
    assert all(row.checked and row.check for row in reproduced.rows)


def test_a_row_that_is_not_compared_says_why(reproduced):
    for row in reproduced.rows:
        assert row.reason, row
        assert (row.tolerance is None) or row.agrees is not None


def test_deviations_are_those_of_the_numbers(reproduced):
    told = [row for row in reproduced.rows if row.deviation is not None]
    assert len(told) > 50
    for row in told:
        assert row.deviation == pytest.approx(100 * (row.computed - row.printed) / row.printed, abs=1e-9)


@pytest.mark.parametrize(
    ("what", "equations", "expected", "printed"),
    [
        ("C_sl, ", PRINTED, 90702.8897786979, 90_730),
        ("C_sl, ", RECIPROCAL, 63607.4140611465, 90_730),
        ("C_sl with", PRINTED, 90_727.84, 90_730),
        ("C_su, ", "", 2593442.98245614, 2_593_440),
        ("C_s, golden section", RECIPROCAL, 1_030_005, 1_046_770),
        ("C_s, golden section, with", PRINTED, 1_046_765, 1_046_770),
    ],
)
def test_table_3(reproduced, what, equations, expected, printed):
    assert value(reproduced, "Table III", what, equations) == pytest.approx(expected, rel=1e-6)
    rows = [x for x in reproduced.rows if x.where == "Table III" and x.equations == equations]
    (row,) = [x for x in rows if x.what.startswith(what)]
    assert row.printed == printed
    if equations != RECIPROCAL:
        assert abs(row.deviation) < 0.05
        assert row.agrees
    else:
        assert row.agrees is None
        assert row.misprint == 1


@pytest.mark.parametrize(("equations", "root"), [(PRINTED, 90702.8897786979), (RECIPROCAL, 63607.4140611465)])
def test_equation_11(reproduced, equations, root):
    assert value(reproduced, "(11)", "degree", equations) == 49
    assert value(reproduced, "(11)", "smallest", equations) == pytest.approx(root, rel=1e-12)


@pytest.mark.parametrize(
    ("f_m", "expected"),
    [(1, 365), (2, 281), (2.5, 202), (3, 90), (4, 674), (5, 705), (8, 677), (10, 667), (1000, 648)],
)
def test_figure_3a(reproduced, f_m, expected):
    found = value(reproduced, "Fig. 3a", f"critical C_s, f_m = {f_m:g} Hz, C_m held")
    assert found / 1e3 == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(("xi_m", "expected"), [(0.2, 58.9), (0.3, 90.7), (0.4, 274), (0.5, 380), (1.0, 526)])
def test_figure_3b(reproduced, xi_m, expected):
    assert value(reproduced, "Fig. 3b", f"critical C_s, xi_m = {xi_m:g}") / 1e3 == pytest.approx(expected, rel=0.01)


def test_where_figure_3_has_several_values(reproduced):
    low, high = map(float, value(reproduced, "Fig. 3a", "f_m with several critical values, C_m").split(" ... "))
    assert (low, high) == pytest.approx((3.26, 3.54), abs=0.011)
    assert "0.118" in value(reproduced, "Fig. 3b", "xi_m with several")


@pytest.mark.parametrize(
    ("figure", "kmh", "equations", "abscissa"),
    [
        *(("Fig. 4", 250, PRINTED, -1.6831884), ("Fig. 4", 250, RECIPROCAL, -1.546)),
        *(("Fig. 5", 300, PRINTED, -1.3697336), ("Fig. 5", 300, RECIPROCAL, -1.2207)),
    ],
)
def test_figures_4_and_5(reproduced, figure, kmh, equations, abscissa):
    assert value(reproduced, figure, "spectral abscissa", equations) == pytest.approx(abscissa, rel=2e-4)
    assert value(reproduced, figure, "displacements", equations) == "settle"
    if equations == PRINTED:
        assert value(reproduced, figure, "growth rate") == pytest.approx(abscissa, rel=0.01)


def test_figures_4_and_5_have_sizes(reproduced):
    sizes = [value(reproduced, f"Fig. {n}", x) for n in (4, 5) for x in ("lateral displacement", "yaw displacement")]
    assert [1e3 * x for x in sizes] == pytest.approx([3.41, 0.511, 3.85, 0.571], abs=0.005)


def test_table_2(reproduced):
    ratio = "ratio of lateral to yaw acceleration, "
    assert value(reproduced, "Table II", f"{ratio}the front wheelset", PRINTED) == pytest.approx(9.90, abs=0.005)
    assert value(reproduced, "Table II", f"{ratio}the rail", PRINTED) == pytest.approx(10.8, abs=0.02)
    rms = [row for row in reproduced.rows if row.where == "Table II" and "RMS" in row.what]
    assert [row.agrees for row in rows_printed(rms)] == [None, None]
    assert all(row.misprint == 13 for row in rms)


def rows_printed(rows):
    return [row for row in rows if row.printed is not None]


def test_both_readings_are_checked_by_another_route(monkeypatch):
    bogie = paper_bogie(yd.table1(equations=PRINTED))
    assert all(reading.checked for reading in readings(bogie.vehicles[PRINTED]))
    monkeypatch.setattr("yawdesign.study.reproduced_table_2.DISTURBANCE", 6.5)
    assert readings(bogie.vehicles[PRINTED])[0].ratio != pytest.approx(9.90, abs=0.005)


def changed_rows(before, after):
    """Return what is computed otherwise."""
    pairs = zip(before, after, strict=True)
    return {x.what for x, y in pairs if x.computed != y.computed}


def quick_rows(problem):
    bogie = paper_bogie(problem)
    return [*table_1(bogie), *equations_13_14(bogie), *table_3(bogie)]


def test_rows_follow_what_they_depend_on():
    """The mass of the frame sets the hunting; the curve does not know it."""
    table1 = yd.table1(equations=PRINTED)
    before, after = quick_rows(table1), quick_rows(table1.replace(M_b="7 300 kg"))
    changed = changed_rows(before, after)
    assert sum(x.startswith("C_sl") for x in changed) == 2  # with rounded motor values, and without
    assert "C_s, golden section" in changed
    assert not any(x.startswith(("C_su", "T/(4 Q a)", "K_", "C_m")) for x in changed)
    (frame,) = [x for x in after if x.what.startswith("M_b")]
    assert frame.agrees is False
    assert frame.deviation == pytest.approx(100 * (7300 / 7186 - 1))
    assert [x.agrees for x in after if x.what.startswith("C_sl, ") and x.equations == PRINTED] == [False]


def test_the_axle_load_changes_the_curving_limit():
    table1 = yd.table1(equations=PRINTED)
    changed = changed_rows(quick_rows(table1), quick_rows(table1.replace(W="190 kN")))
    assert {x[:4] for x in changed} >= {"C_su", "T/(4", "C_sl"}


@pytest.mark.slow
def test_one_value_of_table_1_changes_every_dependent_row(reproduced):
    problem = yd.table1(equations=PRINTED).replace(M_b="7 300 kg")
    other = yd.reproduce(problem)
    assert other.changed == {"M_b": (7186.0, 7300.0)}
    assert other.checked
    assert not other.agrees
    same = {x.what for x, y in zip(reproduced.rows, other.rows, strict=True) if x.computed == y.computed}
    dependent = ("C_sl", "ratio of lateral to yaw acceleration, the", "smallest", "critical C_s", "spectral", "growth")
    assert not [x for x in same if x.startswith(dependent)]
    kept = {x.what for x in reproduced.rows if x.where == "Table I" and not x.what.startswith("M_b")}
    assert kept <= same
    assert {"degree of Delta_25 and Delta_26 in C_s", "chi_0 ... chi_26"} <= same


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda p: yd.table1("trailer"), "has motors"),
        (lambda p: replace(p, curve=None), "no curve"),
        (lambda p: p.replace(speed=["250 km/h", "300 km/h"]), "several speeds"),
        (lambda p: p.replace(C_s=None), "C_s"),
        (lambda p: p.replace(K_ds="rigid"), "joints"),
        (lambda p: p.replace(gravitational_stiffness=False), "no gravitational stiffness"),
    ],
)
def test_what_the_paper_has_no_equations_for_is_refused(change, message):
    with pytest.raises(yd.ProblemError, match=message):
        paper_bogie(change(yd.table1()))


def test_files(reproduced, tmp_path, monkeypatch):
    monkeypatch.setattr(reproduction_folder, "reproduction", lambda *_: reproduced)
    folder = tmp_path / "out"
    assert yd.reproduce(to=folder) is reproduced
    names = {path.name for path in folder.iterdir()}
    figures = {f"fig{k}{suffix}" for k in (2, 3, 4, 5) for suffix in (".png", ".svg")}
    assert names == figures | {"manifest.json", *(f"reproduction.{x}" for x in ("html", "csv", "json"))}
    page = (folder / "reproduction.html").read_text(encoding="utf-8")
    with pytest.raises(yd.ProblemError, match="not empty"):
        yd.reproduce(to=folder)
    monkeypatch.setattr(reproduction_folder, "drawing_of", lambda _: {})
    (folder / "mine.txt").write_text("mine", encoding="utf-8")
    yd.reproduce(to=folder, force=True)
    assert (folder / "mine.txt").read_text(encoding="utf-8") == "mine"
    entries = json.loads((folder / "reproduction.json").read_text(encoding="utf-8"))
    assert len(entries["rows"]) == len(reproduced.rows)
    assert "drawn" not in entries
    lines = (folder / "reproduction.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + len(reproduced.rows)
    assert page.count("<svg") == 4
    assert "http" not in page.replace("http://www.w3.org/", "")
    assert all(f">{row.where}<" in page or f"Eq. {row.where}" in page for row in reproduced.rows)


def test_a_folder_of_an_export_is_not_replaced(tmp_path, reproduced, monkeypatch):
    monkeypatch.setattr(reproduction_folder, "reproduction", lambda *_: reproduced)
    monkeypatch.setattr(reproduction_folder, "drawing_of", lambda _: {})
    folder = tmp_path / "export"
    folder.mkdir()
    files = ["reproduction.csv", "manifest.json"]
    (folder / "manifest.json").write_text(json.dumps({"generator": "yawdesign export", "files": files}))
    (folder / "reproduction.csv").write_bytes(b"mine")
    with pytest.raises(yd.ProblemError, match=r"reproduction\.csv"):
        yd.reproduce(to=folder, force=True)
    assert (folder / "reproduction.csv").read_bytes() == b"mine"


def test_plain_data(reproduced):
    text = json.dumps(reproduced.to_dict(), allow_nan=False)
    assert "drawn" not in json.loads(text)
    assert repr(reproduced).startswith("Reproduction: ")


def test_the_printed_ratio_is_that_of_the_printed_values(reproduced):
    rows = [row for row in reproduced.rows if row.what.startswith("ratio") and row.equations == PRINTED]
    assert {round(row.printed, 2) for row in rows} == {10.27, 9.99}
    assert all(math.isfinite(row.printed) for row in rows)
    assert np.isclose(2.895 / 0.282, 10.27, atol=0.005)


def test_rows_as_a_workbook(reproduced, tmp_path):
    reproduced.to_excel(tmp_path / "paper.xlsx")
    book = openpyxl.load_workbook(tmp_path / "paper.xlsx")
    assert book.sheetnames == ["summary", "rows", "provenance"]
    assert book["rows"].max_row == 1 + len(reproduced.rows)
    assert [row[0] for row in book["summary"].iter_rows(values_only=True)] == ["what", "agrees", "checked", "version"]

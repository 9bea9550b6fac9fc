"""Workbooks: a problem goes there and comes back the same, and every mistake has its cell."""

import builtins
import datetime
import io
import json
import re
import zipfile
from pathlib import Path

import openpyxl
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.problem import read, workbook
from yawdesign.problem.problem_sheet import SHEET, path_of
from yawdesign.problem.workbook_writing import SheetRows, cell_text, write_workbook

PROBLEMS = Path(__file__).parents[2] / "problems"


def save(book, path):
    book.save(path)
    return path


@pytest.fixture
def table1(tmp_path):
    path = tmp_path / "table1.xlsx"
    yd.table1().to_excel(path)
    return path


@pytest.fixture
def changed(table1):
    """Return a function that changes cells of Table I as a workbook, by key, and returns what reading it says."""

    def change(**cells):
        book = openpyxl.load_workbook(table1)
        sheet = book[SHEET]
        for row in sheet.iter_rows(min_row=2):
            for column, value in cells.get(row[0].value.replace(".", "_"), {}).items():
                row[["key", "value", "unit", "meaning"].index(column)].value = value
        save(book, table1)
        problem, diagnostics = read(table1)
        return problem, [diagnostic.render() for diagnostic in diagnostics]

    return change


@pytest.mark.parametrize("path", sorted(PROBLEMS.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_problem_comes_back_the_same(path, tmp_path):
    problem, there = yd.load(path), tmp_path / "problem.xlsx"
    problem.to_excel(there)
    assert yd.load(there) == problem


def test_numbers_keep_their_decimals(tmp_path):
    decimals = {
        "K_m": "626.480000000000000001 kN/m",
        "C_m": "0.1 kN s/m",
        "K_2x": 0.1 + 0.2,
        "K_2y": 812345.67890123456,
    }
    problem = yd.table1().replace(**decimals, speed=[50.0, "300.1 km/h"])
    problem.to_excel(tmp_path / "problem.xlsx")
    again = yd.load(tmp_path / "problem.xlsx")
    assert again == problem
    assert again.bogie.K_m.exact == problem.bogie.K_m.exact
    assert again.bogie.C_m.exact == 100


NAMES = ["=1+1", "+x", "-x", "@x", "<b>&amp;</b>", "שלום עולם", "_x0041_", "a.b", "x.leading", "true", "[1, 2]", "# a"]


@pytest.mark.parametrize("name", NAMES)
def test_titles_and_names_are_texts_whatever_they_hold(name, tmp_path):
    faults = {name: {"C_s": "50 %", "K_ds": "50 %"}, "other": {"C_t": "0 %"}}
    problem = yd.table1().replace(title=name, cases=faults, conditions={"load": {name: {"W": "190 kN"}}})
    path = tmp_path / "problem.xlsx"
    problem.to_excel(path)
    assert yd.load(path) == problem
    cells = [cell for row in openpyxl.load_workbook(path)[SHEET].iter_rows() for cell in row]
    assert not [cell for cell in cells if cell.data_type == "f"]


def test_names_that_look_like_keys(tmp_path):
    names = ["a.leading", "b.C_s", "c. d.trailing"]
    problem = yd.load(PROBLEMS / "vehicle.yaml").replace(cases={x: {"leading.C_s": "50 %"} for x in names})
    problem.to_excel(tmp_path / "problem.xlsx")
    assert yd.load(tmp_path / "problem.xlsx") == problem


def test_dotted_keys():
    assert path_of("cases.one lost.leading.C_s", whole=False) == ("cases", "one lost", "leading.C_s")
    assert path_of("cases.a.b.C_s", whole=False) == ("cases", "a.b", "C_s")
    assert path_of("cases.a.b", whole=True) == ("cases", "a.b")
    assert path_of("conditions.load.tare.W", whole=False) == ("conditions", "load", "tare", "W")
    assert path_of("conditions.lambda.min", whole=False) == ("conditions", "lambda", "min")


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ({"bogie_K_ds": {"value": -40}}, "problem!B18: error: bogie.K_ds: -40 MN/m is outside"),
        ({"bogie_M_b": {"key": "bogie.M_q"}}, "problem!A5: error: bogie.M_q: is not a known key; did you mean M_w?"),
        ({"bogie_r": {"key": "bogie.b"}}, "problem!A32: error: bogie.b: stands twice, first in problem!A26"),
        ({"speed": {"value": "=299+1"}}, "problem!B36: error: speed: holds a formula without a value"),
        ({"curve_R": {"unit": "kg"}}, "problem!B37: error: curve.R: 300 kg is a mass, expected a length"),
        ({"curve_L": {"value": "19 m"}}, "problem!B38: error: curve.L: 19 m has a unit, and another one"),
        ({"curve_l": {"value": "#DIV/0!"}}, "problem!B39: error: curve.l: holds the error #DIV/0!"),
        ({"curve_R": {"key": None}}, "problem!B37: error: has no key in front of it"),
        ({"bogie_M_b": {"key": "speed.min"}}, "problem!A36: error: speed: stands twice, first in problem!A5"),
        ({"bogie_lambda": {"value": "[0.1"}}, "problem!B33: error: bogie.lambda: "),
    ],
)
def test_mistakes_have_their_cells(changed, cells, message):
    problem, told = changed(**cells)
    assert problem is None
    assert any(message in line for line in told), told
    assert all(line.count("\n") == 0 for line in told)


@pytest.mark.parametrize(
    "cells",
    [
        {"bogie_M_b": {"value": "=1+1"}},
        {"bogie_M_b": {"value": datetime.date(2024, 5, 1)}},
        {"bogie_M_b": {"unit": "#N/A"}},
        {"bogie_M_b": {"value": "5 m", "unit": "kg"}},
        {"speed": {"value": "[200 km/h"}},
        {"speed": {"value": "#REF!"}},
        {"curve_R": {"value": "=A1"}},
        {"bogie_kind": {"value": "=A1"}},
        {"design_variables_C_s_max": {"value": "=A1"}},
    ],
)
def test_one_mistake_is_told_once(changed, cells):
    problem, told = changed(**cells)
    assert problem is None
    assert len(told) == 1, told


def test_all_mistakes_come_at_once(changed):
    _, told = changed(bogie_K_ds={"value": -1}, bogie_K_dt={"value": -1}, bogie_a={"unit": "kg"})
    assert len(told) == 3


def test_what_people_write_in_excel(changed):
    problem, told = changed(
        bogie_K_ds={"value": "rigid", "unit": None},
        bogie_C_m={"value": 19950, "unit": None},
        speed={"value": "[250 km/h, 300 km/h]", "unit": None},
        bogie_C_t={"value": "60 kN s/m", "unit": None},
    )
    assert not told
    assert problem.parameters().get("K_ds", "rigid") == "rigid"
    assert problem.bogie.C_m == 19950
    assert problem.speeds == pytest.approx((250 / 3.6, 300 / 3.6))


def test_lists_and_shares(tmp_path):
    rows = [
        *(("bogie.base", "table1", None), ("speed.min", 200, "km/h"), ("speed.max", 300, "km/h")),
        *(("conditions.W", "[150, 190]", "kN"), ("cases.lost.C_s", 0.5, None), ("#", "a remark", None)),
    ]
    path = tmp_path / "problem.xlsx"
    write_workbook(path, {SHEET: SheetRows(("key", "value", "unit"), rows), "notes": SheetRows(("x",), [])})
    book = openpyxl.load_workbook(path)
    book[SHEET]["B6"].number_format = "0 %"
    save(book, path)
    head = "bogie: {base: table1}, speed: {min: 200 km/h, max: 300 km/h}"
    more = "conditions: {W: [150 kN, 190 kN]}, cases: {lost: {C_s: 50 %}}"
    assert yd.load(path) == yd.loads(f"{{{head}, {more}}}")


def test_values_that_formulas_had_are_read(table1):
    """As a program that computes writes them: the formula and its last value."""
    book = openpyxl.load_workbook(table1)
    book[SHEET]["B36"].value = "=4"
    save(book, table1)
    content = io.BytesIO()
    with zipfile.ZipFile(table1) as old, zipfile.ZipFile(content, "w") as new:
        for part in old.infolist():
            data = re.sub(rb"<f>4</f><v ?/?>(</v>)?", b"<f>4</f><v>280</v>", old.read(part))
            new.writestr(part, data)
    table1.write_bytes(content.getvalue())
    assert yd.load(table1).speeds == pytest.approx((280 / 3.6,))


def test_no_workbooks(tmp_path):
    path = tmp_path / "problem.xlsx"
    path.write_text("hello", encoding="utf-8")
    with pytest.raises(yd.ProblemError, match="is no workbook"):
        yd.load(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("x.xml", "<x/>")
    with pytest.raises(yd.ProblemError, match="is no workbook"):
        yd.load(path)
    write_workbook(tmp_path / "other.xlsx", {"values": SheetRows(("key", "value"), [])})
    with pytest.raises(yd.ProblemError, match="has no sheet problem; it has values"):
        yd.load(tmp_path / "other.xlsx")
    with pytest.raises(yd.ProblemError, match="No such file"):
        yd.load(tmp_path / "none.xlsx")
    write_workbook(tmp_path / "headless.xlsx", {"problem": SheetRows(("a", "b"), [("x", 1)])})
    with pytest.raises(yd.ProblemError, match="the column key and the column value is missing"):
        yd.load(tmp_path / "headless.xlsx")


def test_sizes_are_bounded_before_the_work(table1, tmp_path, monkeypatch):
    with zipfile.ZipFile(tmp_path / "bomb.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * 61_000_000)
    with pytest.raises(yd.ProblemError, match="unpacks to more than 60 MB"):
        yd.load(tmp_path / "bomb.xlsx")
    with zipfile.ZipFile(tmp_path / "entities.xlsx", "w") as archive:
        archive.writestr("xl/workbook.xml", b'<!DOCTYPE x [<!ENTITY a "b">]><x>&a;</x>')
    with pytest.raises(yd.ProblemError, match="document type"):
        yd.load(tmp_path / "entities.xlsx")
    write_workbook(tmp_path / "long.xlsx", {"problem": SheetRows(("key", "value"), [("title", "x")] * 2_001)})
    with pytest.raises(yd.ProblemError, match="more than 2000 rows"):
        yd.load(tmp_path / "long.xlsx")
    monkeypatch.setattr(workbook, "MOST_BYTES", 1_000)
    with pytest.raises(yd.ProblemError, match="is larger than"):
        yd.load(table1)


def test_without_openpyxl_one_message_says_what_to_install(table1, tmp_path, monkeypatch):
    original = builtins.__import__

    def without(name, *arguments, **more):
        if name.partition(".")[0] == "openpyxl":
            raise ImportError(name)
        return original(name, *arguments, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    for command in (
        ["check", str(table1)],
        ["stability", str(PROBLEMS / "table1.yaml"), "--xlsx", str(tmp_path / "a.xlsx")],
        ["new", str(tmp_path / "b.xlsx")],
    ):
        done = CliRunner().invoke(app, command)
        assert done.exit_code == 2, done.output
        assert (
            done.stderr.strip().splitlines()[-1].endswith('Excel files need openpyxl: pip install "yawdesign[excel]"')
        )
    assert [path.name for path in tmp_path.iterdir()] == ["table1.xlsx"]


def test_a_catalogue_as_workbook(tmp_path):
    dampers = yd.read_catalogue(PROBLEMS / "dampers.csv")
    problem = yd.load(PROBLEMS / "table1-catalogue.yaml")
    problem.to_excel(tmp_path / "whole.xlsx")
    assert yd.read_catalogue(tmp_path / "whole.xlsx") == dampers
    text = (PROBLEMS / "table1-catalogue.yaml").read_text(encoding="utf-8").replace("dampers.csv", "whole.xlsx")
    (tmp_path / "problem.yaml").write_text(text, encoding="utf-8")
    assert yd.load(tmp_path / "problem.yaml") == problem


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([("a", 10, 8), ("a", 11, 8)], "x.xlsx:dampers!A3: error: name: a stands twice"),
        ([("a", -10, 8)], "x.xlsx:dampers!B2: error: damping: -10 kN s/m is outside"),
        ([("a", None, 8)], "error: damping: has no value"),
        ([("a", "=1+1", 8, 5)], "x.xlsx:dampers!D2: error: stands in no column"),
        ([], "has no damper in it"),
    ],
)
def test_mistakes_in_a_catalogue_have_their_cells(rows, message, tmp_path):
    path = tmp_path / "x.xlsx"
    heads = ("name", "damping [kN s/m]", "stiffness [MN/m]")
    write_workbook(path, {"dampers": SheetRows(heads, rows), "notes": SheetRows(("a",), [])})
    with pytest.raises(yd.ProblemError) as error:
        yd.read_catalogue(path)
    assert message in str(error.value)


@pytest.mark.parametrize("options", [(), ("--kind", "trailer"), ("--car-body",)])
def test_new_writes_a_workbook_to_start_from(options, tmp_path):
    path = tmp_path / "problem.xlsx"
    done = CliRunner().invoke(app, ["new", str(path), *options])
    assert done.exit_code == 0, done.output
    assert [x.name for x in tmp_path.iterdir()] == ["problem.xlsx"]
    plain = tmp_path / "problem.yaml"
    assert CliRunner().invoke(app, ["new", str(plain), *options]).exit_code == 0
    assert yd.load(path) == yd.load(plain)
    keys = [row[0] for row in openpyxl.load_workbook(path)[SHEET].iter_rows(values_only=True)]
    assert "bogie.C_1y" in keys
    assert CliRunner().invoke(app, ["new", str(path)]).exit_code == 2
    assert CliRunner().invoke(app, ["check", str(path)]).exit_code == 0


def test_files_are_not_replaced_unasked(table1, tmp_path):
    with pytest.raises(yd.ProblemError, match="exists"):
        yd.table1().to_excel(table1)
    yd.table1().to_excel(table1, replace=True)
    with pytest.raises(yd.ProblemError, match=r"must end in \.xlsx"):
        yd.table1().to_excel(tmp_path / "problem.xls")


def test_mistakes_as_json_have_their_cells(changed, table1):
    changed(bogie_K_ds={"value": -1})
    done = CliRunner().invoke(app, ["check", str(table1), "--json"])
    assert done.exit_code == 2
    (mistake,) = json.loads(done.stdout)["errors"]
    assert (mistake["cell"], mistake["key"]) == ("problem!B18", "bogie.K_ds")
    assert "line" not in mistake


def test_a_change_is_told_by_its_option(table1):
    done = CliRunner().invoke(app, ["check", str(table1), "--set", "C_s=-1"])
    assert done.exit_code == 2
    assert "--set" in done.stderr


def values(path, sheet):
    return [*openpyxl.load_workbook(path)[sheet].iter_rows(values_only=True)]


def test_results(tmp_path):
    problem = yd.table1().replace(C_s="1 046 770 N s/m", cases={"=1+1": {"C_s": "50 %"}})
    result = yd.stability(problem)
    result.to_excel(tmp_path / "stability.xlsx")
    summary = {row[0]: row[1:] for row in values(tmp_path / "stability.xlsx", "summary")}
    assert summary["C_s"] == (1046770, "N·s/m")
    assert summary["spectral_abscissa"] == (pytest.approx(result.spectral_abscissa, rel=1e-15), "1/s")
    heads, first, *_ = values(tmp_path / "stability.xlsx", "modes")
    assert heads == ("frequency [Hz]", "damping_ratio", "decay_rate [1/s]")
    mode = result.modes[0]
    assert first == pytest.approx((mode.frequency, mode.damping_ratio, mode.decay_rate), rel=1e-15)
    roots = values(tmp_path / "stability.xlsx", "eigenvalues")
    assert roots[0] == ("real [1/s]", "imaginary [1/s]")
    assert complex(*roots[1]) == pytest.approx(result.eigenvalues[0], rel=1e-15)
    cell = openpyxl.load_workbook(tmp_path / "stability.xlsx")["cases"]["A2"]
    assert (cell.value, cell.data_type) == ("=1+1", "s")
    provenance = dict(values(tmp_path / "stability.xlsx", "provenance"))
    assert provenance["yawdesign"] == yd.__version__


def test_a_design_and_a_sweep(tmp_path):
    yd.design(yd.table1()).to_excel(tmp_path / "design.xlsx")
    assert values(tmp_path / "design.xlsx", "stable_intervals")[0] == ("from [N·s/m]", "to [N·s/m]")
    result = yd.sweep(yd.table1(), of="C_sl", f_m=[2.0, 3.0])
    result.to_excel(tmp_path / "sweep.xlsx")
    rows = values(tmp_path / "sweep.xlsx", "points")
    assert rows[0][:2] == ("f_m [Hz]", "C_sl [N·s/m]")
    assert [row[1] for row in rows[1:]] == pytest.approx(result.values.tolist(), rel=1e-15)


def test_commands_write_workbooks(table1, tmp_path):
    out = tmp_path / "out.xlsx"
    done = CliRunner().invoke(app, ["stability", str(table1), "--xlsx", str(out), "--json"])
    assert done.exit_code == 0, done.output
    assert f"wrote {out}" in done.stderr
    assert CliRunner().invoke(app, ["stability", str(table1), "--xlsx", str(out)]).exit_code == 2
    assert CliRunner().invoke(app, ["stability", str(table1), "--xlsx", str(table1), "--force"]).exit_code == 2
    commands = ("stability", "critical-speed", "design", "optimise", "choose", "trade-off", "sweep", "uncertainty")
    for command in commands:
        assert "--xlsx" in CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "200"}).stdout


def test_texts_of_cells():
    assert cell_text("a\x00b\ud800c") == "a\ufffdb\ufffdc"
    assert cell_text("_x0041_") == "_x005F_x0041_"
    assert len(cell_text("x" * 40_000)) < 32_767

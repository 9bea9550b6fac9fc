"""Problem files: right ones, thirty and more kinds of broken ones, and random ones."""

import contextlib
import errno
import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from yawdesign.problem import PARAMETERS, ProblemError, SpeedRange, exact, load, loads, read, starter, table1
from yawdesign.problem.parameters import parameter_keys
from yawdesign.problem.reader import read_text

PUBLISHED = {"cooperrider-bogie", "cooperrider-vehicle", "high-speed-vehicle"}
UNDER_CONDITIONS = {"table1-conditions", "vehicle-conditions"}
PROBLEMS = sorted((Path(__file__).parents[2] / "problems").glob("*.yaml"))
GOOD = """\
title: a bogie
equations: as-printed
bogie:
  kind: power
  base: table1
  M_b: 7186 kg
  K_ds: 40 MN/m
speed: 300 km/h
curve:
  R: 300 m
  L: 19 m
  l: 60 m
  V_r: 90 km/h
design:
  objective: decay_rate
  variables:
    C_s: {min: 10 kN s/m, max: 10 MN s/m}
"""
# Each anchor is as deep as what it names and 17 levels more: few values, but hundreds of levels.
DEEP_ALIASES = "a: &a [x]\n" + "".join(
    f"b{k}: &b{k} {'[' * 17}*{'a' if k == 0 else f'b{k - 1}'}{']' * 17}\n" for k in range(22)
)
BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{new}: &{new} [{','.join([f'*{old}'] * 9)}]\n" for old, new in zip("abcdefgh", "bcdefghi", strict=True)
)


def changed(line, text):
    """Return the good file with one line replaced (counted from 1)."""
    lines = GOOD.splitlines()
    lines[line - 1] = text
    return "\n".join(lines) + "\n"


def found(text):
    problem, diagnostics = read_text(text, "problem.yaml")
    assert (problem is None) == any(d.severity == "error" for d in diagnostics)
    return diagnostics


# ---------------------------------------------------------------- right files


def test_the_good_file_is_good():
    problem = loads(GOOD)
    assert found(GOOD) == ()
    assert (problem.title, problem.equations, problem.speeds) == ("a bogie", "as-printed", (300 / 3.6,))
    assert problem.curve.V_r == 25
    assert dict(problem.design.variables)["C_s"].max == 1e7


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda path: path.stem)
def test_the_shipped_problems_read_without_a_word(path):
    problem, diagnostics = read(path)
    # The bogie of 1972 has next to no yaw damper.
    unusual = ["bogie.C_s", "design.variables.C_s.min"] if path.stem == "cooperrider-bogie" else []
    assert [d.key for d in diagnostics] == unusual
    assert problem == load(path)
    if path.stem not in PUBLISHED:
        own = {"W": "167 kN", "C_s": problem.bogie.C_s} if problem.car_body else {}
        assert problem.bogie == table1(problem.bogie.kind).replace(**own).bogie


def test_there_are_shipped_problems():
    own = {"table1", "table1-catalogue", "power-bogie", "trailer-bogie", "vehicle"}
    assert {path.stem for path in PROBLEMS} == own | UNDER_CONDITIONS | PUBLISHED


def test_table1_writes_all_values_out_as_printed():
    text = next(path for path in PROBLEMS if path.stem == "table1").read_text(encoding="utf-8")
    keys = re.findall(r"^  (\w+): ", text, flags=re.MULTILINE)
    assert [key for key in keys if key in PARAMETERS] == list(parameter_keys("power"))
    assert loads(text).equations == "as-printed"


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_the_starter_reads_without_a_word_and_explains_every_parameter(kind):
    text = starter(kind)
    problem, diagnostics = read_text(text)
    assert diagnostics == ()
    assert problem.bogie == table1(kind).bogie
    assert problem.curve == table1(kind).curve
    assert problem.design == table1(kind).design
    for key in parameter_keys(kind):
        row = PARAMETERS[key]
        assert re.search(rf"^  {key}: {re.escape(row.example)} +# {re.escape(row.meaning)}$", text, re.MULTILINE)
    assert max(map(len, text.splitlines())) <= 120


def test_the_starter_knows_two_kinds():
    with pytest.raises(ProblemError, match="did you mean trailer"):
        starter("trialer")


def test_a_preset_without_motors_drops_their_values():
    bogie = loads("{bogie: {base: table1, kind: trailer}, speed: 80}").bogie
    assert bogie == table1("trailer").bogie


def test_keys_replace_the_values_of_a_preset():
    bogie = loads("{bogie: {base: table1, lambda: 0.3}, speed: 80}").bogie
    assert (bogie.lambda_, bogie.M_b) == (0.3, 7186)


def test_numbers_keep_their_decimals():
    text = "{bogie: {base: table1, K_m: 626480.1, b: 0.7465, M_b: 7e3, W: 2.0e+5}, speed: 83.3}"
    bogie = loads(text).bogie
    assert exact(bogie.K_m) * 10 == 6264801
    assert exact(bogie.b) * 10000 == 7465
    assert (bogie.M_b, bogie.W) == (7000, 200000)


def test_c_s_may_be_left_out():
    text = starter().replace("  C_s: 1 000 kN·s/m", "  #")
    assert loads(text).bogie.C_s is None


def test_a_speed_range():
    assert loads(changed(8, "speed: {min: 200 km/h, max: 300 km/h}")).speed == SpeedRange(
        min="200 km/h", max="300 km/h"
    )
    assert len(loads(changed(8, "speed: {min: 60, max: 70, steps: 3}")).speeds) == 3


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n"),
        "---\n" + GOOD + "...\n",
        "%YAML 1.1\n---\n" + GOOD,
        GOOD.replace("40 MN/m", '"40 MN/m"'),
        GOOD.replace("R: 300 m", "R: &r 300 m").replace("L: 19 m", "L: 19 m # *r"),
        GOOD.replace("K_ds: 40 MN/m", "K_ds: &k 40 MN/m\n  K_dt: *k"),
        "? title\n: x\n" + GOOD.split("\n", 1)[1],
        GOOD.replace("300 km/h", "300 km/h\t# fast").replace("40 MN/m", "40 MN/m \t \t# stiff"),
        GOOD.replace("speed: ", "speed:\t")
        .replace("M_b: 7186", "M_b: \t 7186")
        .replace("bogie:", "bogie:\t# the bogie"),
        GOOD.replace("speed:", "speed\t:").replace("40 MN/m", "'40 MN/m'\t# stiff"),
        GOOD.replace("\n", "\t\n").replace("bogie:", "\t# a comment\n\t\nbogie:"),
        GOOD.replace("{min: 10", "{\tmin:\t10").replace(", max", "\t,\n\t max").replace("s/m}", "s/m\t}\t# bounds"),
        GOOD.replace("R: 300 m", "R: &r\t300 m"),
    ],
    ids=[
        "bom",
        "crlf",
        "document marks",
        "directive",
        "quotes",
        "anchor",
        "alias",
        "complex key syntax",
        "tabs before comments",
        "tabs after colons",
        "tabs before colons",
        "tabs at ends of lines",
        "tabs in braces",
        "tabs after marks",
    ],
)
def test_ways_to_write_the_same(text):
    problem, diagnostics = read_text(text)
    assert diagnostics == ()
    assert problem == replace(loads(GOOD), title=problem.title)


def test_a_title_in_a_block_ends_without_a_line_end():
    assert loads(changed(1, "title: |\n  a bogie")).title == "a bogie"
    assert loads(changed(1, "title: >\n  a\n  bogie\n")).title == "a bogie"
    assert loads(changed(1, 'title: "drehgestell 轉向架 \\u00e9 😀"')).title == "drehgestell 轉向架 é 😀"


# --------------------------------------------------------------- broken files

BROKEN = {
    "syntax": (changed(10, "  R: [300 m"), [10], "is not YAML: the bracket that opens here"),
    "syntax, no blank after the colon": (changed(8, "speed:300 km/h"), [8], "is followed by a colon and a blank"),
    "syntax, quote left open": (changed(1, 'title: "a bogie'), [1], "the quote that opens here is not closed"),
    "tab as indent": (changed(6, "\tM_b: 7186 kg"), [6], "no tab"),
    "tab and blanks as indent": (changed(6, "  \tM_b: 7186 kg"), [6], "no tab"),
    "tab in a value": (changed(6, "  M_b: 7186\tkg"), [6], "no tab may stand inside a value"),
    "tab after a dash": (changed(17, "    -\tC_s: 3"), [17], "a tab does not indent"),
    "tab after the sign of a block": (changed(1, "title: >-\t# x\n  a bogie"), [1], "put a blank in place of this tab"),
    "tab in a quoted value": (changed(6, '  M_b: "7186\\tkg"'), [6], "bogie.M_b: holds the control character U+0009"),
    "lone surrogate": (changed(1, 'title: "\\ud800"'), [1], "title: holds U+D800"),
    "half a surrogate pair": (changed(1, 'title: "\\udc00\\ud800"'), [1], "title: holds U+DC00"),
    "escape sequence": (changed(1, 'title: "\\e[31mred"'), [1], "holds the control character U+001B"),
    "nul": (changed(1, 'title: "\\0"'), [1], "holds the control character U+0000"),
    "delete": (changed(1, 'title: "\\x7f"'), [1], "holds the control character U+007F"),
    "title of two lines": (changed(1, 'title: "a\\nb"'), [1], "holds a line end"),
    "title of two lines in a block": (changed(1, "title: |\n  a\n  b"), [1], "holds a line end"),
    "line separator": (changed(1, 'title: "a\\Lb"'), [1], "holds a line end, U+2028"),
    "no character": (changed(1, 'title: "\\uffff"'), [1], "holds U+FFFF"),
    "control character in a key": (GOOD + '"a\\a": 3\n', [18, 18], "holds the control character U+0007"),
    "control character in a choice": (changed(2, 'equations: "as-printed\\x02"'), [2], "the control character U+0002"),
    "surrogate in a number": (changed(6, '  M_b: "7186 kg\\ud800"'), [6], "bogie.M_b: holds U+D800"),
    "long title": (changed(1, "title: " + "a" * 1001), [1], "is longer than 1000 characters"),
    "aliases deeper than the stack": (DEEP_ALIASES, [3], "nested deeper than 20 levels"),
    "doubled key": (changed(7, "  M_b: 7 t"), [7], "bogie.M_b: stands twice, first on line 6"),
    "doubled section": (GOOD + "speed: 80\n", [18], "stands twice"),
    "unknown key": (changed(7, "  K_dsx: 40 MN/m"), [7], "bogie.K_dsx: is not a known key; did you mean K_ds?"),
    "unknown key without underscore": (changed(7, "  K1x: 40 MN/m"), [7], "did you mean K_1x?"),
    "unknown key by another name": (changed(7, "  conicity: 0.1"), [7], "did you mean lambda?"),
    "unknown section": (changed(8, "v: 300 km/h"), [8], "did you mean speed?"),
    "unknown key in the curve": (changed(13, "  Vr: 90 km/h"), [13], "curve.Vr: is not a known key; did you mean V_r?"),
    "parameter at the top": (GOOD + "f_22: 3\n", [18], "it belongs under bogie"),
    "missing parameter": (changed(5, "  K_m: 3"), [3] * 27, "bogie.M_w: is missing: mass of each wheelset"),
    "missing section": (GOOD.replace("speed: 300 km/h\n", ""), [1], "speed: is missing"),
    "missing curve key": (GOOD.replace("  L: 19 m\n", ""), [9], "curve.L: is missing: distance"),
    "missing bound": (changed(17, "    C_s: {min: 10 kN s/m}"), [17], "design.variables.C_s.max: is missing"),
    "wrong dimension": (changed(7, "  K_ds: 40 kg"), [7], "40 kg is a mass, expected a stiffness such as MN/m"),
    "wrong dimension of a bound": (changed(17, "    C_s: {min: 1 kN/m, max: 2 kN s/m}"), [17], "C_s.min: 1 kN/m is a"),
    "unknown unit": (changed(8, "speed: 300 kmh"), [8], "'kmh' is not a known unit; did you mean km/h?"),
    "text for a number": (changed(6, "  M_b: heavy"), [6], "'heavy' is not a number with a unit"),
    "not a number": (changed(6, "  M_b: .nan"), [6], "nan is not a finite number"),
    "infinity": (changed(6, "  M_b: -.inf"), [6], "-inf is not a finite number"),
    "overflow": (changed(6, "  M_b: 1e999"), [6], "too large"),
    "huge exponent": (changed(6, "  M_b: 1e999999999 kg"), [6], "too large"),
    "many digits": (changed(6, "  M_b: " + "9" * 9999), [6], "too long"),
    "zero mass": (changed(6, "  M_b: 0 kg"), [6], "0 kg is outside 0.001 ... 1e+18 kg"),
    "negative stiffness": (changed(7, "  K_ds: -40 MN/m"), [7], "-40 MN/m is outside 1e-06 ... 1e+12 MN/m"),
    "negative plain number": (changed(7, "  K_ds: -40"), [7], "-40 is outside 1 ... 1e+18 N/m"),
    "speed of zero": (changed(8, "speed: 0 km/h"), [8], "speed: 0 km/h is outside"),
    "empty range": (changed(8, "speed: {min: 300 km/h, max: 300 km/h}"), [8], "empty range"),
    "exchanged bounds": (
        changed(8, "speed: {min: 83, max: 200 km/h}"),
        [8],
        "200 km/h is less than min, which is 298.8",
    ),
    "exchanged design bounds": (changed(17, "    C_s: {min: 2 MN s/m, max: 1 kN s/m}"), [17], "is less than min"),
    "one speed is no range": (changed(8, "speed: {min: 60, max: 70, steps: 1}"), [8], "whole number from 2 to 1001"),
    "half a step": (changed(8, "speed: {min: 60, max: 70, steps: 2.5}"), [8], "not a whole number"),
    "billion laughs": (BOMB, [4], "more than 5000 values"),
    "alias inside its own anchor": ("a: &a [*a]\n", [1], "names nothing that is complete"),
    "unknown alias": (changed(8, "speed: *v"), [8], "names nothing"),
    "deep nesting": ("[" * 10_000, [1], "nested deeper"),
    "deep nesting of mappings": ("{a: " * 10_000, [1], "nested deeper"),
    "deep block nesting": ("- " * 5_000 + "x", [1], "nested deeper"),
    "many values": ("title: [" + "1," * 20_000 + "1]", [1], "more than 5000 values"),
    "long text": ("#" * 300_000, [1], "longer than 256 KiB"),
    "empty": ("", [1], "the file is empty"),
    "comments only": ("# nothing\n# at all\n", [1], "the file is empty"),
    "a list": ("- bogie\n- speed\n", [1], "'key: value' lines"),
    "a text": ("bogie", [1], "'key: value' lines"),
    "control characters": (changed(1, "title: \x07"), [1], "must not hold"),
    "boolean for a number": (changed(6, "  M_b: true"), [6], "true is not a number"),
    "null for a number": (changed(6, "  M_b:"), [6], "bogie.M_b: has no value"),
    "value and keys": (changed(14, "design: ~"), [15], "is not YAML: no second ': ' may stand here"),
    "null for a section": ("bogie: {base: table1}\nspeed: 80\ndesign: ~\n", [3], "design: has no value"),
    "wrong indentation": (changed(7, "   K_ds: 40 MN/m"), [7], "look at the indentation"),
    "wrong outdentation": (changed(7, " K_ds: 40 MN/m"), [7], "look at the indentation"),
    "at sign": (changed(1, "title: @home"), [1], "put the value in quotes"),
    "null for the curve": ("bogie: {base: table1}\nspeed: 80\ncurve:\n", [3], "curve: has no value"),
    "list for a mapping": (changed(17, "    C_s: [1, 2]"), [17], "expected keys and values: min, max"),
    "text for a section": ("bogie: table1\nspeed: 80\n", [1], "expected keys and values: kind, base"),
    "mapping for a number": (changed(6, "  M_b: {a: 1}"), [6], "bogie.M_b: {'a': '1'} is not a number"),
    "list for a number": (changed(6, "  M_b: [80, 90]"), [6], "bogie.M_b: ['80', '90'] is not a number"),
    "list of no speeds": (changed(8, "speed: []"), [8], "speed: is an empty list: give the speeds, or a range"),
    "list with a mass": (changed(8, "speed: [80, 90 kg, 80]"), [8, 8], "speed.1: 90 kg is a mass, expected a speed"),
    "decimal comma": (changed(7, "  K_ds: 40,5 MN/m"), [7], "has a comma"),
    "wrong equations": (changed(2, "equations: printed"), [2], "printed is not one of: reciprocal, as-printed"),
    "wrong kind": (changed(4, "  kind: pwoer"), [4], "did you mean power?"),
    "wrong objective": (changed(15, "  objective: damping"), [15], "did you mean damping_ratio?"),
    "wrong load": (changed(12, "  l: 60 m\n  load: axel"), [13], "did you mean axle?"),
    "motors in a trailer": (changed(4, "  kind: trailer\n  K_m: 3 kN/m"), [5], "a trailer bogie has none"),
    "motor variable in a trailer": (
        changed(4, "  kind: trailer").replace("C_s: {min: 10 kN", "C_m: {min: 10 kN"),
        [17],
        "design.variables.C_m: belongs to the motors",
    ),
    "unknown preset": (changed(5, "  base: table2"), [5], "table2 is not one of: table1; did you mean table1?"),
    "preset of a wrong type": (changed(5, "  base: [table1]"), [5], "['table1'] is not one of"),
    "two documents": (GOOD + "---\n" + GOOD, [18], "a second document"),
    "variables of an unknown parameter": (changed(17, "    C_x: {min: 1, max: 2}"), [17], "C_x: is not a known key"),
    "no variables": (
        changed(16, "  variables: {}").replace("    C_s: {min: 10 kN s/m, max: 10 MN s/m}\n", ""),
        [16],
        "names no parameter",
    ),
    "robust": (GOOD + "robust: {lambda: [0.1]}\n", [18], "what must hold stands under conditions"),
    "tag": (changed(6, "  M_b: !!float 7186"), [6], "tags such as"),
    "python tag": (changed(1, "title: !!python/object/apply:os.system [ls]"), [1, 1], "tags such as"),
    "merge key": (changed(6, "  <<: {M_b: 3}"), [6], "merge keys"),
    "key that is a list": (changed(6, "  ? [a, b]\n  : 3"), [6], "is not a key"),
    "number as key": (GOOD + "7: 3\n", [18], "7: is not a known key"),
    "octal": (changed(6, "  M_b: 0o17"), [6], "not a known unit"),
    "hexadecimal": (changed(6, "  M_b: 0x1F"), [6], "not a known unit"),
    "title that is a list": (changed(1, "title: [a]"), [1], "['a'] is not a text"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_broken_files(kind):
    text, lines, fragment = BROKEN[kind]
    diagnostics = found(text)
    assert [d.line for d in diagnostics] == list(lines)
    shown = "\n".join(d.render() for d in diagnostics)
    assert fragment in shown
    assert "Traceback" not in shown
    assert "pydantic" not in shown
    assert all(d.severity == "error" for d in diagnostics)
    assert max(map(len, shown.splitlines())) < 500
    with pytest.raises(ProblemError):
        loads(text)


def test_the_contracts_example():
    line = "K_ds: -40 MN/m"
    diagnostic = found(changed(7, f"  {line}"))[0]
    assert diagnostic.render() == (
        "problem.yaml:7:9: error: bogie.K_ds: -40 MN/m is outside 1e-06 ... 1e+12 MN/m\n"
        "     7 |   K_ds: -40 MN/m\n"
        "       |         ^^^^^^^^"
    )


def test_all_mistakes_are_reported_at_once_in_the_order_of_the_lines():
    text = (
        GOOD.replace("M_b: 7186 kg", "M_b: 7186 m")
        .replace("K_ds: 40 MN/m", "K_ds: -40 MN/m\n  K_ds: 3\n  K1x: 4")
        .replace("decay_rate", "decay-rate")
        .replace("max: 10 MN", "max: 1 N")
        .replace("speed: 300", "sped: 300")
    )
    assert [(d.line, d.key) for d in found(text)] == [
        (6, "bogie.M_b"),
        (7, "bogie.K_ds"),
        (8, "bogie.K_ds"),
        (9, "bogie.K1x"),
        (10, "sped"),
        (17, "design.objective"),
        (19, "design.variables.C_s.max"),
    ]


def test_a_misspelt_key_is_not_also_missing():
    text = starter().replace("  M_b: ", "  Mb: ").replace("lambda: ", "conicity: ")
    assert [d.key for d in found(text)] == ["bogie.Mb", "bogie.conicity"]


def test_an_unknown_preset_does_not_make_all_keys_missing():
    assert len(found("{bogie: {base: tabel1}, speed: 80}")) == 1


def test_columns_count_characters_from_one():
    diagnostic = found(changed(17, "    C_s: {min: 1 kN·s/m, max: 2 kg}"))[0]
    assert (diagnostic.line, diagnostic.column, diagnostic.length) == (17, 31, 4)
    assert diagnostic.source_line[30:34] == "2 kg"


def test_unusual_values_are_warnings_and_the_problem_is_read():
    text = changed(6, "  M_b: 7.186 kg").replace("max: 10 MN", "max: 1000 MN").replace("speed: 300 km/h", "speed: 300")
    problem, diagnostics = read_text(text, "p.yaml")
    assert problem.bogie.M_b == 7.186
    assert [(d.severity, d.line, d.key) for d in diagnostics] == [
        ("warning", 6, "bogie.M_b"),
        ("warning", 8, "speed"),
        ("warning", 17, "design.variables.C_s.max"),
    ]
    assert "p.yaml:6:8: warning: bogie.M_b: 7.186 kg is unusual" in diagnostics[0].render()
    assert loads(text) == problem


def test_each_bare_speed_of_a_list_is_doubted():
    diagnostics = found(changed(8, "speed: [80, 250 km/h, 300]"))
    assert [(d.severity, d.key, d.column) for d in diagnostics] == [
        ("warning", "speed.0", 9),
        ("warning", "speed.2", 23),
    ]
    assert loads(changed(8, "speed: [300 km/h, 200 km/h]")).speeds == (200 / 3.6, 300 / 3.6)


def test_an_unusual_curve_and_speed_range():
    diagnostics = found(changed(10, "  R: 3 m").replace("300 km/h", "{min: 1 km/h, max: 300 km/h}"))
    assert [d.key for d in diagnostics] == ["speed.min", "curve.R"]


# ----------------------------------------------------------------------- files


@pytest.mark.parametrize(
    ("content", "line", "fragment"),
    [
        (b"title: \xff\xfe\n", 1, "is not UTF-8"),
        (b"title: a\nspeed: \xe9\n", 2, "is not UTF-8"),
        (bytes(range(256)) * 4, 2, "is not UTF-8"),
        (b"\x00\x01\x02", 1, "must not hold"),
        ("title: ü".encode("utf-16"), 1, "is not UTF-8"),
        (b"#" * 400_000, None, "larger than 256 KiB"),
        (b"", 1, "the file is empty"),
    ],
    ids=["bytes", "latin-1", "all bytes", "nul", "utf-16", "large", "empty"],
)
def test_files_that_are_no_texts(tmp_path, content, line, fragment):
    path = tmp_path / "problem.yaml"
    path.write_bytes(content)
    problem, diagnostics = read(path)
    assert problem is None
    assert [d.line for d in diagnostics] == [line]
    assert fragment in diagnostics[0].message
    assert diagnostics[0].render().startswith(str(path))
    with pytest.raises(ProblemError):
        load(path)


@pytest.mark.parametrize("name", ["missing.yaml", ".", "", "a\0b", "x" * 5000, "no/such/folder.yaml"])
def test_files_that_cannot_be_read(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ProblemError, match="cannot be read: "):
        load(name)


def test_a_file_without_permission(tmp_path, monkeypatch):
    path = tmp_path / "problem.yaml"
    path.write_text(GOOD, encoding="utf-8")

    def refuse(name, *_):  # a mode of 000 does not keep the superuser out
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(name))

    monkeypatch.setattr("builtins.open", refuse)
    with pytest.raises(ProblemError, match="cannot be read: Permission denied"):
        load(path)


def test_load_reads_what_loads_reads(tmp_path):
    path = tmp_path / "pröblem.yaml"
    path.write_text(GOOD, encoding="utf-8")
    assert load(path) == load(str(path)) == loads(GOOD)


# ---------------------------------------------------------------- random files

QUICK = settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.too_slow])


def survives(text):
    problem, diagnostics = read_text(text, "random.yaml")
    assert (problem is None) == any(d.severity == "error" for d in diagnostics)
    assert all(d.line >= 1 and d.column >= 1 and d.render() for d in diagnostics)
    assert problem is None or problem.speeds
    with contextlib.suppress(ProblemError):
        loads(text)


@given(st.binary(max_size=300))
@QUICK
def test_random_bytes(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "random.yaml"
    path.write_bytes(content)
    problem, diagnostics = read(path)
    assert problem is None
    assert diagnostics


@given(st.text(alphabet=st.sampled_from(list("ab:-?,[]{}#&*!|>'\"%@` \n\t0.~<=\u2028\x85é")), max_size=60))
@QUICK
@example("? ? a\n")
@example("? |\n a\n: b\n")
@example("!<a> b: c")
@example("a: |9\n b")
@example("%TAG ! x\n---\n!a b")
def test_random_yaml_like_texts(text):
    survives(text)
    survives(GOOD.replace("a bogie", text))


LINES = tuple(GOOD.splitlines())
PIECES = st.sampled_from(
    ["", " ", ":", "- ", "[", "}", "&a ", "*a", "!t ", "#", "\t", "'", "~", "1e999", ".nan", "é", "\x00"]
)


@st.composite
def edited(draw):
    """Return the good file after a few random edits of lines and characters."""
    lines = list(LINES)
    for _ in range(draw(st.integers(1, 4))):
        index = draw(st.integers(0, len(lines) - 1)) if lines else 0
        match draw(st.sampled_from(["delete", "double", "swap", "insert", "cut", "indent"])):
            case "delete":
                del lines[index : index + 1]
            case "double":
                lines[index:index] = lines[index : index + 1]
            case "swap":
                lines[index : index + 2] = lines[index : index + 2][::-1]
            case "insert" | "cut" as edit:
                line = lines[index] if lines else ""
                at = draw(st.integers(0, len(line)))
                lines[index : index + 1] = [line[:at] + draw(PIECES) + line[at + (edit == "cut") :]]
            case _:
                lines[index : index + 1] = [" " + line for line in lines[index : index + 1]]
    return "\n".join(lines)


@pytest.mark.slow
@given(edited())
@settings(QUICK, max_examples=300)
def test_random_edits(text):
    survives(text)


@pytest.mark.slow
@given(st.text(max_size=40), st.sampled_from(["title", "equations", "speed", "M_b", "R", "C_s"]))
@QUICK
def test_random_values_in_quotes(text, key):
    quoted = '"' + "".join(f"\\U{ord(char):08x}" for char in text) + '"'
    survives(re.sub(rf"(\b{key}): .*", lambda match: f"{match[1]}: {quoted}", GOOD, count=1))


# ------------------------------------------------------------------ the room


def test_this_room_needs_no_mathematics():
    code = (
        "import sys, yawdesign.problem as p; p.load(sys.argv[1]); p.schema();"
        "print([m for m in ('casadi', 'numpy', 'scipy', 'matplotlib') if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code, str(PROBLEMS[0])], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def test_this_room_imports_no_other():
    source = Path(sys.modules["yawdesign.problem"].__file__).parent
    for path in source.glob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"^\s*(from|import) (\.\.|yawdesign)", text, re.MULTILINE), path.name


def test_escapes_of_json_are_characters():
    data = {"title": "\U0001f684 1", "bogie": {"base": "table1"}, "speed": 80, "cases": {"\U0001f527": {"C_t": "0 %"}}}
    problem = loads(json.dumps(data))
    assert problem.title == data["title"]
    assert [case.name for case in problem.cases] == list(data["cases"])
    with pytest.raises(ProblemError, match="U\\+D83D, which is no character"):
        loads(json.dumps(data).replace("\\ude84", ""))

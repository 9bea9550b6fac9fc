"""The JSON Schema that editors use, and the documentation that people read."""

import json
import re
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from yawdesign.problem import PARAMETERS, read, schema, starter
from yawdesign.problem.running import CURVE, SPEED

ROOT = Path(__file__).parents[2]
PROBLEMS = sorted((ROOT / "problems").glob("*.yaml"))
VALIDATOR = Draft202012Validator(schema())


def errors(text):
    return [error.message for error in VALIDATOR.iter_errors(YAML(typ="safe", pure=True).load(text))]


def test_the_schema_is_one():
    Draft202012Validator.check_schema(schema())
    assert schema()["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_the_schema_beside_the_problems_is_the_schema():
    shipped = json.loads((ROOT / "problems" / "problem.schema.json").read_text(encoding="utf-8"))
    assert shipped == schema(), "write it anew with: yawdesign schema > problems/problem.schema.json"


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda path: path.stem)
def test_shipped_problems_name_the_schema_and_fit_it(path):
    text = path.read_text(encoding="utf-8")
    modeline = re.match(r"# yaml-language-server: \$schema=(\S+)\n", text)
    assert (path.parent / modeline[1]).is_file()
    assert errors(text) == []


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_the_starter_fits_the_schema(kind):
    assert errors(starter(kind)) == []


@pytest.mark.parametrize(
    "text",
    [
        "{bogie: {base: table1}, speed: 80}",
        "{bogie: {base: table1, K_m: 6.3e5, b: 0.746 5 m, lambda: 15 %}, speed: {min: 200 km/h, max: 83, steps: 5}}",
        "{bogie: {base: table1, K_m: 6×10⁵ N/m, C_t: 60 kN.s/m, J_b: 9.7 t.m2, lambda: 1.5×10^-1}, speed: 80 m/s}",
        "{bogie: {base: table1, kind: trailer}, speed: 0.5 km/h, design: {variables: {C_s: {min: 1, max: 2 N s/m}}}}",
    ],
)
def test_right_problems_fit(text):
    assert errors(text) == []


@pytest.mark.parametrize(
    "text",
    [
        "{}",
        "{bogie: {base: table1}}",
        "{bogie: {}, speed: 80}",
        "{bogie: {kind: trailer}, speed: 80}",
        "{bogie: {base: table2}, speed: 80}",
        "{bogie: {base: table1, kind: pwoer}, speed: 80}",
        "{bogie: {base: table1, K1x: 3}, speed: 80}",
        "{bogie: {base: table1, K_1x: -3}, speed: 80}",
        "{bogie: {base: table1, K_1x: heavy}, speed: 80}",
        "{bogie: {base: table1, K_1x: '40,5 MN/m'}, speed: 80}",
        "{bogie: {base: table1, K_1x: true}, speed: 80}",
        "{bogie: {base: table1, K_1x: [1]}, speed: 80}",
        "{bogie: {base: table1, lambda: 3 m}, speed: 80}",
        "{bogie: {base: table1, kind: trailer, K_m: 3}, speed: 80}",
        "{bogie: {base: table1, kind: trailer}, speed: 80, design: {variables: {K_m: {min: 1, max: 2}}}}",
        "{bogie: {base: table1}, speed: {min: 80}}",
        "{bogie: {base: table1}, speed: {min: 80, max: 90, steps: 1}}",
        "{bogie: {base: table1}, speed: 80, robust: {}}",
        "{bogie: {base: table1}, speed: 80, curve: {R: 300}}",
        "{bogie: {base: table1}, speed: 80, curve: null}",
        "{bogie: {base: table1}, speed: 80, design: {objective: best}}",
        "{bogie: {base: table1}, speed: 80, equations: printed}",
        "{bogie: {base: table1}, speed: 80, title: [a]}",
    ],
)
def test_broken_problems_do_not_fit(text):
    assert errors(text)


def test_starters_without_one_parameter_do_not_fit():
    for key, row in PARAMETERS.items():
        without = re.sub(rf"^  {key}: .*\n", "", starter(), flags=re.MULTILINE)
        assert bool(errors(without)) is not row.optional


def test_every_parameter_has_a_hover_text_and_an_example():
    properties = schema()["$defs"]["Bogie"]["properties"]
    for key, row in PARAMETERS.items():
        hover = properties[key]["description"]
        assert row.meaning[1:] in hover
        assert row.symbol in hover
        assert f"[{row.unit}]" in hover
        assert row.range_text(row.hard) in hover
        assert properties[key]["examples"] == [row.example]


def test_the_schema_has_no_nulls_and_no_made_up_titles():
    text = json.dumps(schema())
    assert "null" not in text
    assert text.count('"title": "') == 1


# --------------------------------------------------------------- documentation

PAGE = (ROOT / "docs" / "problem-file.md").read_text(encoding="utf-8")


def row_of_the_page(row):
    cells = (f"`{row.key}`", f"${row.symbol}$", row.meaning, row.unit, row.range_text(row.hard, row.unit))
    return "| " + " | ".join((*cells, row.range_text(row.usual, row.unit), row.example)) + " |"


@pytest.mark.parametrize("row", [*PARAMETERS.values(), *CURVE.values(), SPEED], ids=lambda row: row.key)
def test_the_page_has_the_row_of_every_parameter(row):
    assert row_of_the_page(row) in PAGE


def test_the_page_names_every_other_key():
    for part in [schema(), *schema()["$defs"].values()]:
        for key in part["properties"]:
            assert f"`{key}`" in PAGE
    for choice in re.findall(r'"enum": \[([^]]*)\]', json.dumps(schema())):
        for name in json.loads(f"[{choice}]"):
            assert f"`{name}`" in PAGE


def test_the_examples_of_the_page_are_right_and_its_messages_are_those_of_the_reader(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    examples = re.findall(r"```yaml\n(.*?)```\n(?:\n```text\n(.*?)```)?", PAGE, flags=re.DOTALL)
    assert examples
    for text, messages in examples:
        Path("problem.yaml").write_text(text, encoding="utf-8")
        shown = "".join(f"{d.render()}\n" for d in read("problem.yaml")[1])
        assert shown == messages

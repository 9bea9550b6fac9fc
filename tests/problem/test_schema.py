"""The JSON Schema that editors use, and the documentation that people read."""

import contextlib
import json
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from yawdesign.problem import PARAMETERS, ProblemError, parse_quantity, read, schema, starter
from yawdesign.problem.condition import CREEP_FACTOR
from yawdesign.problem.parameters import BOGIE, CAR_BODY, parameter_keys
from yawdesign.problem.requirements import MEASURES
from yawdesign.problem.running import CURVE, SPEED
from yawdesign.problem.units import unit_names

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


@pytest.mark.parametrize("car_body", [False, True])
@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_the_starter_fits_the_schema(kind, car_body):
    assert errors(starter(kind, car_body=car_body)) == []


ROLL = "I_b: 3000, K_1z: 1.2 MN/m, C_1z: 10 kN s/m, h_1: 0.1 m, h_2: 0.2 m, h_2t: 0.1 m"
SPRUNG = "K_2z: 0.6 MN/m, C_2z: 9.8 kN s/m"


@pytest.mark.parametrize(
    "text",
    [
        "{bogie: {base: table1}, speed: 80}",
        "{bogie: {base: table1, K_m: 6.3e5, b: 0.746 5 m, lambda: 15 %}, speed: {min: 200 km/h, max: 83, steps: 5}}",
        "{bogie: {base: table1, K_m: 6×10⁵ N/m, C_t: 60 kN.s/m, J_b: 9.7 t.m2, lambda: 1.5×10^-1}, speed: 80 m/s}",
        "{bogie: {base: table1, kind: trailer}, speed: 0.5 km/h, design: {variables: {C_s: {min: 1, max: 2 N s/m}}}}",
        "{bogie: {base: table1, K_ds: rigid, C_1y: 3 kN s/m, K_d1y: rigid, J_wy: 180}, speed: 80}",
        f"{{bogie: {{base: table1, {ROLL}, {SPRUNG}, gravitational_stiffness: false}}, speed: 80}}",
        f"{{bogie: {{base: table1, {ROLL}}}, car_body: {{base: huo-dai, l_c: 9 m, overturning: true}}, speed: 80}}",
        "{bogie: {base: table1, creep: {kalker_factor: 60 %, rail_radius: 0.3, nu: 0.28}}, speed: 80}",
        "{bogie: {base: table1}, speed: 80, cases: {a b: {C_s: 50 %, K_ds: 20 MN/m}, c: {lambda: 0.3}}}",
        "{bogie: {base: table1}, car_body: {base: huo-dai}, speed: 80, cases: {a: {leading.C_s: 0 %, K_2z: 3}}}",
        "{bogie: {base: table1}, speed: 80, design: {variables: {C_1x: {min: 1, max: 2}, M_c: {min: 3, max: 4 t}}}}",
        "{bogie: {base: table1}, speed: [200 km/h, 83.3]}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: [0.05, 40 %], creep_factor: {min: 0.5, max: 1}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: 0.3, K_2x: {min: 1 MN/m, max: 2e6}, creep_factor: 1}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: 10 %, C_s: 0.2, K_2x: 99.5 %, C_t: '0.5'}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {load: {a b: {W: 120 kN}, c: {W: 2e5, M_c: 40 t}}}}",
        "{bogie: {base: table1}, speed: 80, requirements: {damping_ratio: 5 %, decay_rate: 1, critical_speed: 90}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {C_s: 0 %}}, requirements: {cases: {decay_rate: 0.5 1/s}}}",
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
        "{bogie: {base: table1, K_1x: rigid}, speed: 80}",
        "{bogie: {base: table1, K_d1x: 3}, speed: 80}",
        "{bogie: {base: table1, creep: {}, f_11: 3 MN}, speed: 80}",
        "{bogie: {base: table1, creep: {nu: 0.6}}, speed: 80}",
        "{bogie: {base: table1, I_b: 3}, speed: 80}",
        "{bogie: {base: table1, K_2z: 3}, speed: 80}",
        f"{{bogie: {{base: table1, {ROLL}}}, speed: 80}}",
        f"{{bogie: {{base: table1, {ROLL}, {SPRUNG}}}, car_body: {{base: huo-dai}}, speed: 80}}",
        "{bogie: {base: table1, gravitational_stiffness: 1}, speed: 80}",
        "{bogie: {base: table1, M_c: 3 t}, speed: 80}",
        "{bogie: {base: table1}, car_body: {base: table1}, speed: 80}",
        "{bogie: {base: table1}, car_body: {M_c: 30 t}, speed: 80}",
        "{bogie: {base: table1}, car_body: {base: huo-dai, J_c: -1}, speed: 80}",
        "{bogie: {base: table1}, car_body: {base: huo-dai, f_11: 3}, speed: 80}",
        "{bogie: {base: table1}, car_body: {base: huo-dai}, equations: as-printed, speed: 80}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {}}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: 50 %}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {K_dsx: 50 %}}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {C_s: -50 %}}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {C_s: 50 kg}}}",
        "{bogie: {base: table1}, speed: 80, design: {variables: {K_ds: {min: 1, max: rigid}}}}",
        "{bogie: {base: table1}, speed: []}",
        "{bogie: {base: table1}, speed: [80, 3 kg]}",
        "{bogie: {base: table1}, speed: 80, conditions: [0.1]}",
        "{bogie: {base: table1}, speed: 80, conditions: {conicity: [0.1]}}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: []}}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: [0.1, 20]}}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: [0.1, 3 km]}}",
        "{bogie: {base: table1}, speed: 80, conditions: {lambda: {min: 0.1}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {creep_factor: {min: 0.1}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {creep_factor: {min: 0.1, max: 1, step: 3}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {creep_factor: [0]}}",
        "{bogie: {base: table1}, speed: 80, conditions: {K_ds: [rigid]}}",
        "{bogie: {base: table1}, speed: 80, conditions: {C_s: [1 MN s/m]}}",
        "{bogie: {base: table1, kind: trailer}, speed: 80, conditions: {K_m: [1 MN/m]}}",
        "{bogie: {base: table1, kind: trailer}, speed: 80, conditions: {tolerance: {K_m: 10 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: 150 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: 100 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: 0 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: -5 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_m: 5 kN}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {tolerance: {K_mm: 5 %}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {load: {a: {}}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {load: {a: {C_s: 3}}}}",
        "{bogie: {base: table1}, speed: 80, conditions: {load: {a: {W: 120 kg}}}}",
        "{bogie: {base: table1}, speed: 80, requirements: {damping_ratio: 5 km/h}}",
        "{bogie: {base: table1}, speed: 80, requirements: {critical_speed: 5 %}}",
        "{bogie: {base: table1}, speed: 80, requirements: {damping: 5 %}}",
        "{bogie: {base: table1}, speed: 80, requirements: {cases: {decay_rate: 0}}}",
        "{bogie: {base: table1}, speed: 80, cases: {a: {C_s: 0 %}}, requirements: {cases: {decay_rate: 3 kg}}}",
    ],
)
def test_broken_problems_do_not_fit(text):
    assert errors(text)


UNITS_OF = {
    "M_b": ("7186", "7.2 t", "15842 kg", "1e6 g", "70 N*s**2/m", "3 (kg)", "3 kg·m/m", "7 186 kg "),
    "J_b": ("9 t m²", "9e3 kg·m^2", "9 m^2 t", "4 N m s²", "4 J s^2"),
    "W": ("120 kN", "5 kg m/s²", "4 J/m", "4 Pa m^2"),
    "K_1x": ("40 MN/m", "40 N/mm", "3 N m^-1", "3 kg/s^2", "3 kg s⁻²", "3 N·m/m^2", "5 N m/m^2"),
    "K_mphi": ("361.69 kN·m/rad", "3 kN m", "3 m kN / rad", "4 kJ", "4 kJ/rad", "3 N m/deg"),
    "C_s": ("1 000 kN·s/m", "1 s kN/m", "3 N/(m/s)", "3 kg/s", "2 J s/m^2", "2 N/(mm s^-1)", "2 N s m^-1"),
    "C_mphi": ("11.52 kN·s·m/rad", "3 m s kN/rad", "3 J s", "3 N·m/(rad/s)", "3 N m s"),
    "a": ("1250 mm", "1.25 m", "125 cm", "1 mph min", "0.5 m s/s"),
    "lambda": ("0.15", "15 %", "0.15 -", "0.1 rad", "3 deg", "150 mm/m"),
}
WRONG_UNITS = (
    *("parsec", "kmh", "Kg", "kNm", "zz", "kg parsec", "m/parsec", "kN·s/m)parsec", "-"),
    *("kg", "mm", "s", "kN", "Pa", "W", "Hz", "m/s", "mph", "kN/m", "N m", "kN·m/rad", "m kN", "kN s / m", "s·N/m"),
    *("N/(m/s)", "kg·m²", "m**2 kg", "N m s/rad", "N·m·s", "rad", "%", "kg/s", "kg/s^2"),
)


@pytest.mark.parametrize("key", UNITS_OF)
def test_units_are_those_that_the_reader_takes(key):
    """What is right fits; names that are no unit, and usual units of other quantities, do not."""
    row, right = PARAMETERS[key], UNITS_OF[key]
    for written in [*right, *(f"1 {unit}" for unit in WRONG_UNITS)]:
        try:
            parse_quantity(written, row.unit)
        except ProblemError:
            assert written not in right
            assert errors(f"{{bogie: {{base: table1, {key}: '{written}'}}, speed: 80}}"), written
        else:
            assert not errors(f"{{bogie: {{base: table1, {key}: '{written}'}}, speed: 80}}"), written


names = st.sampled_from(unit_names())
factors = st.builds(str.__add__, names, st.sampled_from(["", "", "^2", "²", "**3", "^-1", "⁻¹", " ^ 2"]))
brackets = st.builds("({})".format, st.builds("{}/{}".format, factors, factors))
products = st.lists(factors | brackets, min_size=1, max_size=4).flatmap(
    lambda parts: st.lists(st.sampled_from([" ", "·", "*", "/", " / "]), min_size=3, max_size=3).map(
        lambda signs: "".join(map(str.__add__, parts, [*signs[: len(parts) - 1], ""]))
    )
)


def patterns():
    """Yield a parameter for each unit of the table, with the pattern of its texts in the schema."""
    everything = VALIDATOR.schema
    properties = {
        **everything["$defs"]["Bogie"]["properties"],
        **everything["$defs"]["CarBody"]["properties"],
        SPEED.key: everything["properties"]["speed"]["oneOf"][0],
    }
    for row in {row.unit: row for row in [*PARAMETERS.values(), SPEED]}.values():
        name = properties[row.key]["anyOf"][1]["$ref"].removeprefix("#/$defs/")
        yield pytest.param(row, re.compile(everything["$defs"][name]["pattern"]), id=name)


@pytest.mark.parametrize(("row", "pattern"), list(patterns()))
@given(unit=products, number=st.sampled_from(["1", "-4.5", "1 000.25", "3e3", ".5"]))
def test_no_right_unit_is_refused(row, pattern, unit, number):
    with contextlib.suppress(ProblemError):
        parse_quantity(f"{number} {unit}", row.unit)
        assert pattern.search(f"{number} {unit}")


def test_starters_without_one_parameter_do_not_fit():
    text = starter(car_body=True)
    for key in (*parameter_keys("power"), *CAR_BODY):
        without = re.sub(rf"^  {key}: .*\n", "", text, flags=re.MULTILINE)
        assert without != text
        assert bool(errors(without)) is not PARAMETERS[key].optional


@pytest.mark.parametrize(("part", "rows"), [("Bogie", BOGIE), ("CarBody", CAR_BODY)])
def test_every_parameter_has_a_hover_text_and_an_example(part, rows):
    properties = schema()["$defs"][part]["properties"]
    for key, row in rows.items():
        hover = properties[key]["description"]
        assert row.meaning[1:] in hover
        assert row.symbol in hover
        assert f"[{row.unit}]" in hover
        assert row.range_text(row.hard) in hover
        assert properties[key]["examples"] == [row.example]
        assert ({"const": "rigid"} in properties[key]["anyOf"]) is row.rigid


def test_the_schema_has_no_nulls_and_no_made_up_titles():
    text = json.dumps(schema())
    assert "null" not in text
    assert text.count('"title": "') == 1


# --------------------------------------------------------------- documentation

PAGE = (ROOT / "docs" / "problem-file.md").read_text(encoding="utf-8")


def row_of_the_page(row):
    cells = (f"`{row.key}`", f"${row.symbol}$", row.meaning, row.unit, row.range_text(row.hard, row.unit))
    return "| " + " | ".join((*cells, row.range_text(row.usual, row.unit), row.example)) + " |"


@pytest.mark.parametrize(
    "row",
    [*BOGIE.values(), *CAR_BODY.values(), *CURVE.values(), SPEED, CREEP_FACTOR, *MEASURES.values()],
    ids=lambda row: row.meaning,
)
def test_the_page_has_the_row_of_every_parameter(row):
    assert row_of_the_page(row) in PAGE


def test_the_page_names_every_other_key():
    for part in [schema(), *schema()["$defs"].values()]:
        for key in part.get("properties", ()):
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

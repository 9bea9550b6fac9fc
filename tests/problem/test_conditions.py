"""Conditions, requirements and several speeds: as a problem file has them, checked, and back."""

import json
import pickle
import warnings
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yawdesign.problem import CarBody, ProblemError, SpeedRange, loads, table1
from yawdesign.problem.condition import MOST_LISTED, Conditions, Load
from yawdesign.problem.conditions import condition_set
from yawdesign.problem.diagnostics import UnitWarning
from yawdesign.problem.parameters import BOGIE, CAR_BODY, PARAMETERS
from yawdesign.problem.reader import read_text
from yawdesign.problem.requirements import MEASURES, Requirement
from yawdesign.problem.written_conditions import as_conditions

BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
CONTRACT = """\
bogie: {base: table1}
speed: [300 km/h, 200 km/h]
conditions:
  lambda: [0.05, 0.10, 0.15, 0.25, 0.40]
  creep_factor: {min: 0.5, max: 1.0}
  tolerance: {K_m: 10 %, C_m: 20 %, C_s: 15 %}
  load: {tare: {W: 120 kN}, laden: {W: 200 kN}}
cases:
  one yaw damper lost: {C_s: 50 %, K_ds: 50 %}
requirements:
  damping_ratio: 5 %
  critical_speed: 330 km/h
  cases: {damping_ratio: 0 %}
"""


def error(**changes):
    with pytest.raises(ProblemError) as caught:
        replace(table1(), **changes)
    return str(caught.value)


def found(text):
    return [(d.line, d.column, d.key) for d in read_text(text)[1]]


def test_the_contracts_example():
    problem, diagnostics = read_text(CONTRACT)
    assert diagnostics == ()
    assert problem.speed == (200 / 3.6, 300 / 3.6)
    assert problem.conditions == Conditions(
        values=(("lambda", (0.05, 0.10, 0.15, 0.25, 0.40)),),
        ranges=(("creep_factor", (0.5, 1.0)),),
        tolerance=(("K_m", 0.1), ("C_m", 0.2), ("C_s", 0.15)),
        loads=(Load("tare", (("W", 120e3),)), Load("laden", (("W", 200e3),))),
    )
    assert [(each.name, each.wanted) for each in problem.requirements] == [
        ("damping_ratio", 0.05),
        ("critical_speed", 330 / 3.6),
        ("cases.damping_ratio", 0.0),
    ]
    assert len(condition_set(problem).corners) == 2 * problem.conditions.combinations == 2 * 5 * 2 * 2**4


def test_a_problem_goes_to_plain_data_and_back():
    problem = loads(CONTRACT)
    data = problem.to_dict()
    assert json.loads(json.dumps(data)) == data
    assert data["conditions"]["tolerance"] == {"K_m": "10 %", "C_m": "20 %", "C_s": "15 %"}
    assert data["requirements"] == {"damping_ratio": 0.05, "critical_speed": 330 / 3.6, "cases": {"damping_ratio": 0.0}}
    keys = ("bogie", "speed", "conditions", "cases", "requirements")
    with warnings.catch_warnings(action="ignore"):
        assert loads(json.dumps({key: data[key] for key in keys})) == problem
    assert pickle.loads(pickle.dumps(problem)) == problem
    assert hash(problem) == hash(loads(CONTRACT))


def test_replace_takes_what_a_file_takes():
    problem = loads(CONTRACT)
    plain = table1().replace(title="", curve=None, cases=problem.cases)
    made = plain.replace(
        speed=["200 km/h", "300 km/h"],
        conditions={
            "lambda_": [0.05, "10 %", 0.15, 0.25, 0.4],
            "creep_factor": {"min": 0.5, "max": 1},
            "tolerance": {"K_m": 0.1, "C_m": "20 %", "C_s": "15 %"},
            "load": {"tare": {"W": "120 kN"}, "laden": {"W": 200e3}},
        },
        requirements={"damping_ratio": 0.05, "critical_speed": "330 km/h", "cases": {"damping_ratio": 0}},
    )
    assert made == problem
    assert made.replace(conditions={}, requirements={}).conditions == Conditions()
    assert made.replace(requirements=made.requirements, conditions=made.conditions) == made
    assert made.replace(speed={"min": "200 km/h", "max": "300 km/h"}).speed == SpeedRange(min=500 / 9, max=250 / 3)
    assert made.replace(speed=["80 m/s"]).speed == 80


def test_what_a_bogie_has_is_kept_of_a_vehicle():
    load = {"tare": {"M_c": "30 t"}, "laden": {"M_c": "42 t", "W": "186 kN"}, "full": {"J_c": 2e6, "W": "186 kN"}}
    vehicle = table1().replace(
        car_body=BODY,
        conditions={"M_c": [3e4, 4e4], "lambda": [0.1, 0.2], "tolerance": {"C_s": 0.1, "K_2z": 0.1}},
        cases={"a": {"leading.C_s": "50 %"}, "b": {"C_s": "50 %", "K_ds": "50 %"}, "c": {"M_c": "50 %"}},
        requirements={"cases": {"damping_ratio": 0}},
    )
    bogie = vehicle.of_one_bogie
    assert bogie.conditions.written == {"lambda": [0.1, 0.2], "tolerance": {"C_s": "10 %"}}
    assert [case.name for case in bogie.cases] == ["b"]
    assert bogie.requirements == vehicle.requirements
    assert vehicle.replace(cases={"a": {"leading.C_s": "50 %"}}).of_one_bogie.requirements == ()
    loaded = vehicle.replace(conditions={"load": load}).of_one_bogie.conditions
    assert loaded.loads == (Load("tare", ()), Load("laden", (("W", 186e3),)))
    alone = vehicle.replace(conditions={"load": {"tare": {"M_c": 3e4}}}).of_one_bogie
    assert alone.conditions == Conditions()


# ------------------------------------------------------------------- mistakes

WRONG = {
    "values in a list": ({"lambda": [0.05, "3 km", 20]}, "conditions.lambda.1: 3 km is a length, expected a plain num"),
    "values outside": ({"lambda": [0.05, "3 km", 20]}, "conditions.lambda.2: 20 is outside 0 ... 10"),
    "a value outside": ({"K_1x": "-3 MN/m"}, "conditions.K_1x: -3 MN/m is outside 0 ... 1e+12 MN/m"),
    "twice": ({"lambda": [0.1, "10 %"]}, "conditions.lambda.1: 10 % stands twice"),
    "empty list": ({"lambda": []}, "conditions.lambda: is an empty list"),
    "empty range": ({"lambda": {"min": 0.1, "max": "10 %"}}, "conditions.lambda.max: 10 % makes an empty range"),
    "exchanged": ({"creep_factor": {"min": 1, "max": 0.5}}, "creep_factor.max: 0.5 is less than min, which is 1"),
    "range without an end": ({"lambda": {"min": 0.1}}, "conditions.lambda.max: is missing: a range is {min: ..., max:"),
    "range with another key": ({"lambda": {"min": 0.1, "mx": 1}}, "lambda.mx: is not known here; did you mean max?"),
    "range outside": ({"lambda": {"min": 0.1, "max": 11}}, "conditions.lambda.max: 11 is outside 0 ... 10"),
    "no number": ({"lambda": None}, "conditions.lambda: has no value"),
    "rigid": ({"K_ds": ["rigid"]}, "conditions.K_ds.0: 'rigid' is not a number"),
    "unknown": ({"conicity": [0.1]}, "conditions.conicity: is not a parameter; did you mean lambda?"),
    "unknown factor": ({"creep-factor": [0.1]}, "is not a parameter; did you mean creep_factor?"),
    "two names": ({"lambda": [0.1], "lambda_": [0.2]}, "conditions.lambda_: stands twice: lambda is the same"),
    "speed": ({"speed": ["200 km/h"]}, "conditions.speed: stands beside conditions, not in it"),
    "damping": ({"C_s": [1e6]}, "conditions.C_s: is what is designed: a deviation of it is a tolerance"),
    "design variable": ({"K_m": [1e6]}, "conditions.K_m: is a design variable: a deviation of it is a tolerance"),
    "no such parameter": ({"M_c": [1e4]}, "conditions.M_c: is not part of this vehicle: give its value under car_body"),
    "factor and creep": ({"f_11": [1e7], "creep_factor": [0.5, 1]}, "f_11: stands beside creep_factor, which multi"),
    "creep outside": ({"creep_factor": [1e-6, 1], "f_22": [2.0, 1e7]}, "conditions.f_22: stands beside"),
    "factor leads outside": (
        {"creep_factor": [1, 1e6], "load": {"a": {"f_11": 1e14}}},
        "makes f_11 1e+11 ... 1e+17 kN",
    ),
    "tolerance of too much": ({"tolerance": {"K_m": "150 %"}}, "tolerance.K_m: 150 % is no tolerance: more than 0 %"),
    "tolerance of all": ({"tolerance": {"K_m": 1}}, "conditions.tolerance.K_m: 1 is no tolerance"),
    "tolerance of nothing": ({"tolerance": {"K_m": "0 %"}}, "conditions.tolerance.K_m: 0 % is no tolerance"),
    "tolerance in a unit": ({"tolerance": {"C_t": "5 kN"}}, "conditions.tolerance.C_t: 5 kN is a force"),
    "tolerance of what is not": ({"tolerance": {"K_dss": 0.1}}, "tolerance.K_dss: is not a parameter; did you mean"),
    "tolerance of no part": ({"tolerance": {"M_c": 0.1}}, "conditions.tolerance.M_c: is not part of this vehicle"),
    "tolerance that leads out": (
        {"lambda": [9, 9.5], "tolerance": {"lambda": "20 %"}},
        "conditions.tolerance.lambda: makes lambda 7.2 ... 11.4, outside 0 ... 10",
    ),
    "tolerance of zero": ({"b_0": [0], "tolerance": {"b_0": "20 %"}}, "tolerance.b_0: changes nothing: b_0 is 0"),
    "tolerance alone": ({"tolerance": "10 %"}, "conditions.tolerance: 10 % is not what stands here"),
    "no tolerance": ({"tolerance": {}}, "conditions.tolerance: {} is not what stands here"),
    "load in a unit": ({"load": {"a": {"W": "120 kg"}}}, "conditions.load.a.W: 120 kg is a mass, expected a force"),
    "load of what is not": ({"load": {"a": {"WW": 1}}}, "conditions.load.a.WW: is not a parameter; did you mean W?"),
    "load of no part": ({"load": {"a": {"M_c": 1e4}}}, "conditions.load.a.M_c: is not part of this vehicle"),
    "load with creep": ({"load": {"a": {"creep_factor": 1}}}, "load.a.creep_factor: is no part of a load"),
    "load with damping": ({"load": {"a": {"C_s": 1}}}, "conditions.load.a.C_s: is what is designed"),
    "load with a variable": ({"load": {"a": {"K_m": 1}}}, "conditions.load.a.K_m: is a design variable"),
    "load that changes nothing": ({"load": {"a": {"W": "200 kN"}}}, "conditions.load.a: changes nothing"),
    "empty loads alone": ({"load": {"a": {}}}, "changes nothing: its values are those as designed"),
    "the same load": ({"load": {"a": {"W": 1e5}, "b": {"W": "100 kN"}}}, "load.b: has the values of a"),
    "load in two places": ({"W": [1e5], "load": {"a": {"W": 2e5}}}, "load.a.W: stands in conditions.W too"),
    "nameless load": ({"load": {" ": {"W": 1e5}}}, "a load needs a name"),
    "load of the same name": ({"load": {"a": {"W": 1e5}, "a ": {"W": 2e5}}}, "a stands twice"),
    "number": (3, "conditions: 3 is not what stands here, expected keys and values, such as lambda: [0.05"),
    "nothing": (None, "conditions: has no value"),
    "too many": (
        {"lambda": [k / 1000 for k in range(200)], "K_1x": [1e6 + k for k in range(60)]},
        "conditions: every combination of lists, loads, ends of ranges and speeds makes 12000: at most 10000",
    ),
    "a long list": ({"lambda": [k / 1e6 for k in range(MOST_LISTED + 1)]}, "conditions.lambda: lists 10001 values"),
    "many ranges": (
        {"tolerance": dict.fromkeys(("K_1x", "K_1y", "K_2x", "K_2y", *"abr", "b_1", "b_2", "b_3", "M_b", "M_w"), 0.1)}
        | {"lambda": {"min": 0.1, "max": 0.2}, "creep_factor": {"min": 0.1, "max": 0.2}},
        "speeds makes 16384: at most 10000",
    ),
}


@pytest.mark.parametrize("kind", WRONG)
def test_wrong_conditions(kind):
    conditions, fragment = WRONG[kind]
    assert fragment in error(conditions=conditions)


@pytest.mark.parametrize("kind", [kind for kind in WRONG if isinstance(WRONG[kind][0], dict) and kind != "a long list"])
def test_files_get_the_same_messages_with_their_places(kind):
    conditions, fragment = WRONG[kind]
    problem, diagnostics = read_text(json.dumps({"bogie": {"base": "table1"}, "speed": "80 m/s"})[:-1] + ",\n" + (
        f'"conditions": {json.dumps(conditions)}}}'
    ))  # fmt: skip
    assert problem is None
    assert any(fragment.removeprefix("conditions") in f"{d.key}: {d.message}" for d in diagnostics)
    assert all(d.line == 2 for d in diagnostics)


def test_speeds_count_among_the_combinations():
    listed = {"lambda": [k / 1000 for k in range(1, 200)]}
    assert "makes 19900" in error(conditions=listed, speed=SpeedRange(min=50, max=80, steps=100))
    assert replace(table1(), conditions=listed, speed=SpeedRange(min=50, max=80, steps=50))


def test_loads_may_be_as_designed_where_another_differs():
    made = table1().replace(conditions={"load": {"tare": {"W": "120 kN"}, "laden": {"W": "200 kN"}}})
    assert [load.name for load in made.conditions.loads] == ["tare", "laden"]


REQUIRED = {
    "a speed for a ratio": (
        {"damping_ratio": "5 km/h"},
        "requirements.damping_ratio: 5 km/h is a speed, expected",
    ),
    "a share for a speed": ({"critical_speed": "5 %"}, "requirements.critical_speed: 5 % is a plain number, expected"),
    "a ratio of more than one": ({"damping_ratio": 5}, "requirements.damping_ratio: 5 is outside 0 ... 0.99"),
    "unknown": ({"damping": "5 %"}, "requirements.damping: is not known here; did you mean damping_ratio?; known here"),
    "of faults": ({"cases": {"dampingratio": 0}}, "cases.dampingratio: is not known here; did you mean damping_ratio?"),
    "in a unit": ({"cases": {"decay_rate": "3 kg"}}, "requirements.cases.decay_rate: 3 kg is a mass, expected a rate"),
    "no faults": ({"cases": {"decay_rate": 0}}, "requirements.cases.decay_rate: there are no faults: give cases"),
    "empty": (
        {"cases": {}},
        "requirements.cases: {} is not what stands here, expected requirements, such as",
    ),
    "no keys": ({"cases": "5 %"}, "requirements.cases: 5 % is not what stands here"),
    "a list": ([3], "requirements: [3] is not what stands here, expected requirements"),
    "nothing": (None, "requirements: has no value"),
    "twice": ((Requirement("decay_rate", 1.0),) * 2, "requirements.decay_rate: stands twice"),
    "made wrong": ((Requirement("rate", 1.0),), "requirements.rate: is not known here; did you mean decay_rate?"),
}


@pytest.mark.parametrize("kind", REQUIRED)
def test_wrong_requirements(kind):
    requirements, fragment = REQUIRED[kind]
    assert fragment in error(requirements=requirements)


def test_all_mistakes_are_told_at_once_with_their_places():
    text = (
        "bogie: {base: table1}\n"
        "speed: [80 m/s, 200 km/h, 80 m/s, 5 kg]\n"
        "conditions:\n"
        "  lambda: [0.05, 3 km, 20]\n"
        "  creep_factor: {min: 1.0, max: 0.5}\n"
        "  conicity: [0.1]\n"
        "  K_2y: {min: 1 MN/m, maxx: 2 MN/m}\n"
        "  K_m: [1e5]\n"
        "  K_1y:\n"
        "    - 6 MN/m\n"
        "    - \n"
        "  tolerance: {K_m: 150 %, K_dss: 10 %}\n"
        "  load: {ta.re: {W: 120 kg, WW: 3}, laden: {M_c: 3 t}}\n"
        "requirements:\n"
        "  damping_ratio: 5 km/h\n"
        "  damping: 3 %\n"
        "  cases: {decay_rate: 3 kg, damping_ratio: 0}\n"
    )
    assert found(text) == [
        (2, 27, "speed.2"),
        (2, 35, "speed.3"),
        (4, 18, "conditions.lambda.1"),
        (4, 24, "conditions.lambda.2"),
        (5, 33, "conditions.creep_factor.max"),
        (6, 3, "conditions.conicity"),
        (7, 23, "conditions.K_2y.maxx"),
        (8, 3, "conditions.K_m"),
        (11, 6, "conditions.K_1y.1"),
        (12, 20, "conditions.tolerance.K_m"),
        (12, 27, "conditions.tolerance.K_dss"),
        (13, 21, "conditions.load.ta.re.W"),
        (13, 29, "conditions.load.ta.re.WW"),
        (13, 45, "conditions.load.laden.M_c"),
        (15, 18, "requirements.damping_ratio"),
        (16, 3, "requirements.damping"),
        (17, 23, "requirements.cases.decay_rate"),
        (17, 29, "requirements.cases.damping_ratio"),
    ]


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("creep_factor: [1, 0.7]", "under conditions"),
        ("tolerance: {K_m: 10 %}", "under conditions"),
        ("damping_ratio: 5 %", "under requirements"),
        ("critical_speed: 300 km/h", "under requirements"),
    ],
)
def test_keys_in_a_wrong_place_are_told_where_they_belong(line, place):
    (diagnostic,) = read_text(f"bogie: {{base: table1}}\nspeed: 80 m/s\n{line}\n")[1]
    assert (diagnostic.line, diagnostic.column) == (3, 1)
    assert f"it belongs {place}" in diagnostic.message


# --------------------------------------------------------------------- doubts


def test_unusual_and_bare_values_are_doubted_at_their_place():
    text = (
        "bogie: {base: table1}\nspeed: [80 m/s, 90]\n"
        "conditions:\n  lambda: [0.15, 3]\n  creep_factor: {min: 0.01, max: 1}\n"
        "  load: {a: {W: 1 kN}, b: {W: 220 kN}}\n"
        "requirements: {damping_ratio: 90 %, critical_speed: 90}\n"
    )
    assert read_text(text)[0] is not None
    assert all(d.severity == "warning" for d in read_text(text)[1])
    assert found(text) == [
        (2, 17, "speed.1"),
        (4, 18, "conditions.lambda.1"),
        (5, 23, "conditions.creep_factor.min"),
        (6, 17, "conditions.load.a.W"),
        (7, 31, "requirements.damping_ratio"),
        (7, 53, "requirements.critical_speed"),
    ]
    assert "90 is read as 90 m/s, which is 324 km/h: write 90 km/h" in read_text(text)[1][-1].message


def test_values_as_designed_outside_the_conditions_are_doubted():
    text = (
        "bogie: {base: table1}\nspeed: 80 m/s\nconditions:\n"
        "  lambda: [0.2, 0.4]\n  K_2x: {min: 1 MN/m, max: 2 MN/m}\n  K_2y: {min: 0.5 MN/m, max: 1 MN/m}\n"
        "  load: {a: {W: 150 kN}, b: {W: 160 kN, C_t: 70 kN s/m}}\n"
    )
    assert found(text) == [(4, 11, "conditions.lambda"), (5, 9, "conditions.K_2x"), (7, 9, "conditions.load")]
    message = read_text(text)[1][0].message
    assert message == "the value as designed, 0.15, is none of these: answers hold for 0.2 ... 0.4"


def test_loads_have_an_axle_load_that_fits_the_car_body():
    text = (
        "bogie: {base: table1, W: 167 kN}\ncar_body: {base: huo-dai, l_c: 9.5 m}\nspeed: 80 m/s\n"
        "conditions:\n  load: {tare: {M_c: 33 t}, laden: {M_c: 50 t}, full: {M_c: 50 t, W: 205 kN}}\n"
    )
    assert found(text) == [(5, 36, "conditions.load.laden")]


def test_numbers_in_python_are_doubted_once():
    with pytest.warns(UnitWarning, match="critical_speed: 300 is read as 300 m/s") as caught:
        table1().replace(requirements={"critical_speed": 300}).replace(title="again")
    assert len(caught) == 1
    with pytest.warns(UnitWarning, match="speed: 300 is read as 300 m/s"):
        table1().replace(speed=[80.5, 300])
    with warnings.catch_warnings(action="error"):
        table1().replace(requirements={"critical_speed": 91.6}, speed=[80, 81.25])
        loads(CONTRACT).replace(speed=loads(CONTRACT).speed)


# --------------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("changes", "refused"),
    [
        ({"C_s": "100 %"}, True),
        ({"C_s": "100 %", "K_ds": "100 %"}, True),
        ({"K_ds": "40 MN/m"}, True),
        ({"K_ds": 40e6, "lambda": 0.15}, True),
        ({"C_s": "100 %", "K_ds": "50 %"}, False),
        ({"C_s": 1e6}, False),  # it is designed
        ({"K_m": "626.48 kN/m"}, False),  # a design variable
        ({"K_ds": 39e6}, False),
    ],
)
def test_faults_that_change_nothing(changes, refused):
    if refused:
        assert "cases.a: changes nothing: its values are those as designed" in error(cases={"a": changes})
    else:
        assert table1().replace(cases={"a": changes}).cases


def test_faults_that_change_a_condition_change_something():
    conditions = {"lambda": [0.15, 0.4]}
    assert table1().replace(conditions=conditions, cases={"new profiles": {"lambda": 0.15}}).cases
    assert "10 is" not in error(conditions=conditions, cases={"a": {"lambda": "3000 %"}})
    assert "cases.a.lambda: 3 000 % of the value as designed is 12, outside" in error(
        conditions=conditions, cases={"a": {"lambda": "3000 %"}}
    )


# --------------------------------------------------------------------- random

shares = st.integers(1, 99).map(lambda percent: f"{percent} %")
names = st.sampled_from([key for key in (*BOGIE, *CAR_BODY, "creep_factor") if key not in ("C_s", "K_m", "C_m")])


def values_of(key):
    """Return a strategy for what may be given of a parameter, in its usual range."""
    low, high = (PARAMETERS[key].usual if key in PARAMETERS else (0.3, 1.0)) if key != "C_2z" else (1.0, 5e5)
    number = st.floats(low, high)
    several = st.lists(number, min_size=1, max_size=3, unique=True)
    ends = st.tuples(number, number).filter(lambda ends: ends[0] != ends[1])
    return number | several | ends.map(lambda ends: {"min": min(ends), "max": max(ends)})


@settings(max_examples=50)
@given(
    st.lists(names, max_size=3, unique=True).flatmap(
        lambda keys: st.fixed_dictionaries({k: values_of(k) for k in keys})
    )
)
def test_conditions_go_to_plain_data_and_back(written):
    conditions = as_conditions(written)
    assert as_conditions(json.loads(json.dumps(conditions.written))) == conditions
    assert set(conditions.keys) == set(written)


@given(st.dictionaries(st.sampled_from([*BOGIE]), shares, max_size=4))
def test_tolerances_go_to_plain_data_and_back(written):
    conditions = as_conditions({"tolerance": written} if written else {})
    assert as_conditions(conditions.written).written == conditions.written
    assert conditions.combinations == 2 ** len(written)


@settings(max_examples=25)
@given(st.dictionaries(st.sampled_from([*MEASURES]), st.floats(0.01, 0.9)), st.booleans())
def test_requirements_go_to_plain_data_and_back(wanted, of_cases):
    problem = table1().replace(
        cases={"a": {"C_s": "50 %"}}, requirements={"cases": wanted} if of_cases and wanted else wanted
    )
    assert problem.replace(requirements=problem.to_dict()["requirements"]) == problem
    assert all(each.of_cases == of_cases for each in problem.requirements)

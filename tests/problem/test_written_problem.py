"""A problem goes to a dictionary and to a file and comes back: the same, with the decimals it was written with."""

import copy
import functools
import random
import warnings
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.problem import Problem, ProblemError, Written, exact, load, loads, presets
from yawdesign.problem.parameters import ADDED, BOGIE, CAR_BODY, MOTOR_KEYS, ROLL_KEYS, VERTICAL, parameter_keys
from yawdesign.problem.quantities import decimal_text
from yawdesign.problem.table import field_name

FILES = sorted((Path(__file__).parents[2] / "problems").glob("*.yaml"))


def numbers(value):
    """Return all exact numbers in a value, in order."""
    if isinstance(value, Written):
        return [value.exact]
    if isinstance(value, dict):
        return [number for each in value.values() for number in numbers(each)]
    return [number for each in value for number in numbers(each)] if isinstance(value, (list, tuple)) else []


def assert_same(problem):
    """Assert that a problem comes back from a dictionary and from a file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of speeds that are rare
        assert Problem.from_dict(problem.to_dict()).to_dict() == problem.to_dict()
        again = loads(problem.to_yaml())
    assert again == problem
    assert again.to_dict() == problem.to_dict()
    return again


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_problem_of_the_package(path):
    problem = load(path)
    again = assert_same(problem)
    made = {"f_11", "f_22"} if "creep:" in path.read_text(encoding="utf-8") else set()  # computed, not written
    for part in ("bogie", "car_body", "curve"):
        before, after = (x._written[part] or {} for x in (problem, again))
        assert numbers({k: x for k, x in before.items() if k not in made}) == numbers(
            {k: x for k, x in after.items() if k not in made}
        )


def test_a_file_is_as_people_write_it(tmp_path):
    problem = yd.table1().replace(title="Yaw: a #1 'test'", requirements={"damping_ratio": "6.5 %"}, lambda_="0.15")
    text = problem.to_yaml(tmp_path / "p.yaml")
    assert (tmp_path / "p.yaml").read_text(encoding="utf-8") == text
    assert text.startswith("# yaml-language-server: $schema=problem.schema.json\n")
    for line in (
        "  K_m: 626.48 kN/m            # lateral stiffness of the suspension of each motor",
        "  lambda: 0.15                # equivalent conicity of the wheelsets",
        "speed: 300 km/h",
        "curve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90 km/h, limit: 0.08, load: axle}",
        "  damping_ratio: 6.5 %",
    ):
        assert line in text.splitlines()
    parts = [line.partition(":")[0] for line in text.splitlines() if line[:1].isalpha()]
    assert parts == ["title", "equations", "bogie", "speed", "curve", "requirements", "design"]


def test_a_file_that_is_there_stays_unless_it_may_be_replaced(tmp_path):
    place = tmp_path / "p.yaml"
    place.write_text("mine")
    with pytest.raises(ProblemError, match="exists"):
        yd.table1().to_yaml(place)
    assert place.read_text() == "mine"
    yd.table1().to_yaml(place, replace=True)
    assert load(place) == yd.table1()


def test_a_catalogue_stands_in_the_file(tmp_path):
    problem = load(FILES[[path.stem for path in FILES].index("table1-catalogue")])
    problem.to_yaml(tmp_path / "p.yaml")
    assert load(tmp_path / "p.yaml").design.catalogue == problem.design.catalogue


def test_a_catalogue_larger_than_a_problem_file(tmp_path):
    rows = [{"name": f"A{k}", "damping": 4e5, "stiffness": "rigid"} for k in range(1500)]
    problem = yd.table1().replace({"design.catalogue": rows})
    with pytest.raises(ProblemError, match="cannot be written as one file"):
        problem.to_yaml(tmp_path / "p.yaml")
    assert not list(tmp_path.iterdir())


def test_a_dictionary_is_read_as_a_file_is():
    data = {"bogie": {"base": "table1", "K_m": "0.7 MN/m", "M_q": 3}, "speed": "300 kg", "curve": {"R": "300 m"}}
    with pytest.raises(ProblemError) as caught:
        Problem.from_dict(data)
    for line in ("bogie.M_q: is not a known key", "speed: 300 kg is a mass", "curve.L: is missing"):
        assert line in str(caught.value)


def test_a_dictionary_names_a_catalogue(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("d.csv").write_text("name,damping [kN s/m],stiffness [MN/m]\nA,400,20\n", encoding="utf-8")
    data = {"bogie": {"base": "table1"}, "speed": "300 km/h", "design": {"catalogue": "d.csv"}}
    assert Problem.from_dict(data).design.catalogue[0].C_s == 8e5
    assert yd.table1().replace({"design.catalogue": "d.csv"}).design.catalogue[0].C_s == 8e5
    with pytest.raises(ProblemError, match="cannot be read"):
        yd.table1().replace({"design.catalogue": "e.csv"})


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (Written("626480"), "kN/m", "626.48"),
        (300 / 3.6, "km/h", "300"),
        (Written("0.1") / 1, "-", "0.1"),
        (Written("1e18"), "N/m", "1e18"),
        (Written("-0.00000012"), "m", "-1.2e-7"),
        (Written("0.012"), "m", "0.012"),
        (Written("1234567.5"), "-", "1 234 567.5"),
        (0.0, "-", "0"),
        (1 / 3, "MN/m", "3.333333333333333e-7"),
    ],
)
def test_decimals(value, unit, text):
    assert decimal_text(value, unit) == text


def decimals(row):
    """Return numbers in the range of a row, as texts in the unit of people or as doubles."""
    low, high = (max(row.hard[0], 1e-9), min(row.hard[1], 1e15)) if row.hard[0] >= 0 else row.hard
    doubles = st.floats(low, high, allow_nan=False)
    return doubles | doubles.map(lambda x: Written(f"{x:.6g}" if low <= float(f"{x:.6g}") <= high else repr(x)))


def some(keys, rows):
    return st.fixed_dictionaries({key: decimals(rows[key]) for key in keys})


TEXTS = st.text(
    st.characters(
        exclude_categories=("Cs", "Cc", "Zl", "Zp"), exclude_characters=[chr(c) for c in range(0xFDD0, 0xFDF0)]
    ),
    max_size=40,
).filter(lambda text: not any(ord(char) & 0xFFFE == 0xFFFE for char in text))
NAMES = TEXTS.filter(lambda text: text.strip() == text and text)
SPEEDS = st.sampled_from(["300 km/h", "83.3 m/s", "100 mph", 250 / 3.6, 80.125])


@st.composite
def problems(draw):
    """Return a problem with any of its parts."""
    kind, has_body = draw(st.sampled_from(["power", "trailer"])), draw(st.booleans())
    bogie = draw(some(parameter_keys(kind), BOGIE)) | {"kind": kind}
    bogie |= dict.fromkeys(draw(st.sets(st.sampled_from(["K_ds", "K_dt"]))), "rigid")
    if draw(st.booleans()):
        bogie |= draw(some(("J_wy", "C_1y", "K_d1y"), BOGIE)) | {"gravitational_stiffness": False}
    if draw(st.booleans()):
        bogie |= draw(some([key for key in ROLL_KEYS if not (has_body and key in VERTICAL)], BOGIE))
    data = {"bogie": bogie, "title": draw(TEXTS)}
    if has_body:
        data["car_body"] = draw(some([key for key in CAR_BODY if key != "l_c"], CAR_BODY))
        data["car_body"] |= {"overturning": draw(st.booleans())}
    else:
        data["equations"] = draw(st.sampled_from(["reciprocal", "as-printed"]))
    if has_body or draw(st.booleans()):
        data["curve"] = {"R": "300 m", "L": draw(st.sampled_from(["19 m", "17.3 m"])), "l": 60, "V_r": draw(SPEEDS)}
        data["curve"] |= {"load": draw(st.sampled_from(["axle", "wheel"]))}
    data["speed"] = draw(
        SPEEDS
        | st.lists(st.floats(1, 150), min_size=1, max_size=4, unique=True)
        | st.just({"min": "200 km/h", "max": "0.1 km/s", "steps": 5})
    )
    low, high = sorted(draw(st.lists(st.floats(0.01, 0.5), min_size=2, max_size=2, unique=True)))
    loads = st.dictionaries(NAMES, st.just({}), min_size=0, max_size=1).map(
        lambda empty: {"full": {"M_b": "9.1 t"}} | empty
    )
    some_conditions = {
        "lambda": st.sampled_from([[low, high], {"min": low, "max": high}]),
        "tolerance": st.just({"K_2y": "12.5 %", "C_s": low}),
        "load": loads,
        "creep_factor": st.just([1, "70 %"]),
    }
    data["conditions"] = draw(st.fixed_dictionaries({}, optional=some_conditions))
    faults = st.sampled_from([{"C_s": "50 %"}, {"C_s": "3 kN s/m", "K_2x": low}, {"C_t": 0}])
    data["cases"] = draw(st.dictionaries(NAMES, faults, max_size=2))
    data["requirements"] = draw(
        st.fixed_dictionaries({}, optional={"damping_ratio": st.just(low), "critical_speed": SPEEDS})
    )
    if data["cases"]:
        data["requirements"] |= {"cases": {"decay_rate": high}}
    data["uncertainty"] = draw(
        st.sampled_from([{}, {"K_2x": {"uniform": [low * 1e6, high * 1e6]}, "r": {"normal": "2 %"}}])
    )
    data["design"] = {
        "objective": draw(st.sampled_from(["decay_rate", "damping_ratio"])),
        "variables": {"C_s": {"min": low, "max": f"{high} MN s/m"}},
    }
    if draw(st.booleans()):
        names = draw(st.lists(NAMES, min_size=1, max_size=3, unique=True))
        data["design"]["catalogue"] = [{"name": x, "damping": low * 1e6, "stiffness": "rigid"} for x in names]
    return data


def test_any_problem():
    right = []

    @settings(max_examples=20, deadline=None, suppress_health_check=list(HealthCheck))
    @given(problems())
    def look(data):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                problem = Problem.from_dict(data)
            except (
                ProblemError
            ) as error:  # parts that do not fit together, such as a tolerance that leads out of a range
                right.append(str(error))
                return
        right.append(True)
        assert_same(problem)

    look()
    assert sum(each is True for each in right) > len(right) / 4, right[:5]


def test_every_parameter_may_stand_in_a_problem():
    values = {field_name(key): BOGIE[key].example for key in (*parameter_keys("power"), *ADDED)}
    problem = yd.Problem(bogie=yd.Bogie(**values), speed="300 km/h")
    again = assert_same(problem)
    assert [exact(x) for x in again.bogie.parameters().values()] == [
        exact(x) for x in problem.bogie.parameters().values()
    ]
    assert set(MOTOR_KEYS) <= set(again.bogie.parameters())


def test_an_optimum_goes_back_into_a_file(tmp_path):
    text = """{bogie: {base: table1, creep: {kalker_factor: 0.5}}, car_body: {base: huo-dai, l_c: 9.5 m},
    speed: 200 km/h, conditions: {lambda: [0.1, 0.2]}, design: {variables: {C_s: {min: 1, max: 1e7},
    f_11: {min: 1e6, max: 1e7}, K_2z: {min: 1e5, max: 1e6}}}}"""
    problem = loads(text)
    optimum = {"C_s": 2593442.98245614, "f_11": 5.5e6, "K_2z": 0.71e6}  # as the attribute of a result
    problem.replace(**optimum).to_yaml(tmp_path / "best.yaml")
    best = load(tmp_path / "best.yaml")
    assert {key: best.parameters()[key] for key in optimum} == optimum
    assert (best.car_body.K_2z, best.bogie.K_2z) == (0.71e6, None)
    assert best.bogie.f_22 == problem.bogie.f_22
    assert best.conditions == problem.conditions


def test_a_parameter_that_the_preset_lacks_is_named(monkeypatch):
    complete = presets.preset_bogie("table1", "power")
    without = {key: value for key, value in complete.items() if key != "M_b"}
    monkeypatch.setattr("yawdesign.problem.paper_example.preset_bogie", lambda name, kind: without)
    with pytest.raises(ProblemError, match=r"bogie\.M_b: is missing: mass of the bogie frame"):
        yd.table1()


WRONG = (None, 3, "", [], {}, {"a": 1}, [1, 2], True, float("nan"), object(), {3: 4}, [None], "rigid", {"min": None})


def test_wrong_data_end_in_a_list_of_mistakes():
    base = table1_conditions().to_dict()
    chance = random.Random(7)

    def places(data, around=()):
        for key, value in data.items() if isinstance(data, dict) else ():
            yield (*around, key)
            yield from places(value, (*around, key))

    every, wrong = sorted(places(base)), 0
    for _ in range(100):
        data = copy.deepcopy(base)
        *around, key = chance.choice(every)
        part = functools.reduce(dict.__getitem__, around, data)
        part[chance.choice([key, key, 3, "axles"])] = chance.choice(WRONG)
        try:
            Problem.from_dict(data)
        except ProblemError as error:
            wrong += bool(str(error))
    assert wrong > 50
    for data in (None, 3, [], "bogie"):
        with pytest.raises(ProblemError, match="a mapping"):
            Problem.from_dict(data)


def table1_conditions():
    return load(next(path for path in FILES if path.stem == "table1-conditions"))

"""Problem files with a car body, and with what a bogie may have beyond Table I."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from yawdesign.cli import app
from yawdesign.problem import CarBody, ProblemError, load, loads, starter, table1
from yawdesign.problem.consistency import fitting_axle_load
from yawdesign.problem.reader import read_text

VEHICLE = """\
bogie: {base: table1, W: 167 kN}
car_body:
  M_c: 34.5 t
  J_c: 1 521 t·m²
  I_c: 124.304 t·m²
  l_c: 9.5 m
  h_s: 0.852 m
  h_t: 0.97 m
  K_2z: 0.61 MN/m
  C_2z: 9.8 kN·s/m
speed: 300 km/h
curve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90 km/h}
"""
BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
ROLL = "I_b: 3000, K_1z: 1.2 MN/m, C_1z: 10 kN s/m, h_1: 100 mm, h_2: 0.2 m, h_2t: 0.1 m"


def found(text):
    problem, diagnostics = read_text(text, "problem.yaml")
    assert (problem is None) == any(d.severity == "error" for d in diagnostics)
    return diagnostics


def told(text):
    return [(d.line, d.column, f"{d.key}: {d.message}") for d in found(text)]


def test_a_car_body_is_read_and_becomes_plain_data():
    problem = loads(VEHICLE)
    assert found(VEHICLE) == ()
    assert problem.car_body == BODY
    assert problem.to_dict()["car_body"] == BODY.parameters()
    assert loads(VEHICLE + "cases: {}\n") == problem


def test_the_preset_of_a_car_body_and_what_replaces_its_values():
    text = re.sub(r"car_body:\n(  .*\n)+", "car_body: {base: huo-dai}\n", VEHICLE)
    assert found(text) == ()
    assert loads(text).car_body == BODY  # l_c is half of curve.L
    assert loads(text.replace("huo-dai", "huo-dai, l_c: 8.75, M_c: 40 t")).car_body.M_c == 40e3
    assert "2015465" in (Path(__file__).parents[2] / "src/yawdesign/problem/presets/huo-dai.yaml").read_text("utf-8")


def test_half_the_distance_of_the_bogie_centres_comes_from_the_curve():
    text = VEHICLE.replace("  l_c: 9.5 m\n", "")
    assert loads(text) == loads(VEHICLE)
    assert loads(text.replace("L: 19 m", "L: 17.5 m")).car_body.l_c == 8.75
    message = "car_body.l_c: is missing: give half the distance of the bogie centres, or a curve with L"
    assert told(re.sub("curve.*\n", "", text)) == [(2, 1, message)]


def test_switches():
    problem = loads(VEHICLE.replace("car_body:\n", "car_body:\n  overturning: true\n"))
    assert problem.flags == ("overturning",)
    assert problem.to_dict()["car_body"]["overturning"] is True
    problem = loads("{bogie: {base: table1, gravitational_stiffness: false}, speed: 80 m/s}")
    assert problem.flags == ("no gravitational stiffness",)
    assert "gravitational_stiffness" not in table1().to_dict()["bogie"]


def test_roll_of_the_frame_has_its_vertical_springs_under_the_bogie_or_under_the_car_body():
    alone = f"{{bogie: {{base: table1, K_2z: 0.61 MN/m, C_2z: 9.8 kN s/m, {ROLL}}}, speed: 80 m/s}}"
    assert loads(alone).bogie.parameters()["K_2z"] == 610e3
    carried = VEHICLE.replace("167 kN}", f"167 kN, {ROLL}}}")
    assert found(carried) == ()
    assert loads(carried).parameters()["h_1"] == 0.1


def test_primary_dampers_and_rigid_joints():
    text = "{bogie: {base: table1, C_1y: 20 kN s/m, K_d1y: rigid, K_ds: rigid, J_wy: 180}, speed: 80 m/s}"
    problem = loads(text)
    assert found(text) == ()
    assert {"C_1y", "J_wy"} < set(problem.keys)
    assert not {"K_ds", "K_d1y"} & set(problem.keys)
    assert problem.to_dict()["bogie"]["K_ds"] == "rigid"


def test_any_parameter_of_the_vehicle_may_be_a_variable():
    more = "design: {variables: {K_2z: {min: 0.1 MN/m, max: 1 MN/m}, M_c: {min: 30 t, max: 40 t}}}\n"
    assert list(loads(VEHICLE + more).design.variables) == ["K_2z", "M_c"]


# ---------------------------------------------------------------- mistakes

BAD = {
    "negative inertia": ("1 521 t·m²", "-1 521 t·m²", 4, "-1 521 t·m² is outside 1e-06 ... 1e+15 t·m²"),
    "height in another quantity": ("0.852 m", "0.852 kg", 7, "0.852 kg is a mass, expected a length such as m"),
    "height in millimetres": ("0.852 m", "852", 7, "852 is outside -10 ... 10 m"),
    "as printed": ("bogie", "equations: as-printed\nbogie", 1, "the printed equations have no car body: write recipro"),
    "bogie key in the car body": ("  M_c", "  f_11: 3\n  M_c", 3, "here; it belongs under bogie"),
    "car body key in the bogie": ("W:", "h_s: 1 m, W:", 1, "here; it belongs under car_body"),
    "car body key at the margin": (
        "bogie:",
        "M_c: 3 t\nbogie:",
        1,
        "is not a known key here; it belongs under car_body",
    ),
    "speed in the bogie": ("W:", "speed: 80, W:", 1, "is not a known key here; it belongs beside bogie, not in it"),
    "vertical spring in the bogie": ("W:", "K_2z: 3, W:", 1, "belongs under car_body, where there is one"),
    "misspelt": ("  K_2z", "  k2z", 9, "is not a known key; did you mean K_2z?"),
    "missing": (
        "  h_t: 0.97 m\n",
        "",
        2,
        "h_t: is missing: centre of mass of the car body above the secondary lateral",
    ),
    "unknown preset": ("  M_c: 34.5 t", "  base: huodai", 3, "huodai is not one of: huo-dai; did you mean huo-dai?"),
    "no car body": (re.search(r"(  .*\n)+", VEHICLE)[0], "", 2, "car_body: has no value, expected keys and values"),
    "no switch": ("  M_c", "  overturning: 1\n  M_c", 3, "1 is neither true nor false"),
    "no switch of the bogie": ("W:", "gravitational_stiffness: off, W:", 1, "off is neither true nor false"),
    "rigid variable": (
        "W:",
        "K_ds: rigid, W:",
        13,
        "design.variables.K_ds: is rigid here: give its stiffness first",
        "design: {variables: {K_ds: {min: 1 MN/m, max: 2 MN/m}}}\n",
    ),
    "absent variable": (
        "",
        "",
        13,
        "design.variables.C_1x: is not part of this vehicle: give its value under bogie first",
        "design: {variables: {C_1x: {min: 1, max: 2}}}\n",
    ),
    "rigid bound": (
        "",
        "",
        13,
        "design.variables.K_ds.max: 'rigid' is not a number",
        "design: {variables: {K_ds: {min: 1 MN/m, max: rigid}}}\n",
    ),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_vehicles(kind):
    old, new, line, fragment, *more = BAD[kind]
    text = VEHICLE.replace(old, new, 1) + "".join(more)
    (diagnostic,) = found(text)
    assert diagnostic.line == line
    assert fragment in diagnostic.render()
    with pytest.raises(ProblemError):
        loads(text)


def test_a_variable_of_the_car_body_without_one():
    text = "{bogie: {base: table1}, speed: 80 m/s, design: {variables: {M_c: {min: 30 t, max: 40 t}}}}"
    assert "give its value under car_body first" in told(text)[0][2]


def test_all_mistakes_are_told_at_once_those_of_parts_that_do_not_fit_among_them():
    text = """\
equations: as-printed
bogie:
  base: table1
  M_c: 3 t
  K_2z: 4
  K_d1x: rigid
  h_1: 0.1 m
car_body:
  base: huo-dai
  I_c: -4
speed: 300 km/h
cases:
  one. lost: {leading.C_s: 50 %, K_ds: 0 %, C_x: 3}
  another: {C_1x: 10 %, K_ds: 0 %}
design: {variables: {C_1y: {min: 1, max: 2}}}
"""
    assert [(line, message.split(": ")[0]) for line, _, message in told(text)] == [
        (1, "equations"),
        (4, "bogie.M_c"),
        (5, "bogie.K_2z"),
        (6, "bogie.K_d1x"),
        (7, "bogie.h_1"),
        (8, "car_body.l_c"),
        (10, "car_body.I_c"),
        (13, "cases.one. lost.C_x"),
        (14, "cases.another.C_1x"),
        (14, "cases.another.K_ds"),
        (15, "design.variables.C_1y"),
    ]


def test_what_a_misspelt_key_was_meant_to_be_is_not_missing_elsewhere():
    text = VEHICLE.replace("W: 167 kN", f"W: 167 kN, {ROLL}".replace("I_b", "Ib"))
    assert [message for *_, message in told(text)] == ["bogie.Ib: is not a known key; did you mean I_b?"]


# ------------------------------------------------------------------ doubts


def test_the_axle_load_that_fits():
    """Car body 34.5, two frames of 7.186, four wheelsets of 3.085 and four motors of 1.765 t."""
    p = loads(VEHICLE).parameters()
    assert fitting_axle_load(p, "power") == pytest.approx((34.5 + 14.372 + 12.34 + 7.06) * 9806.65 / 4)
    assert fitting_axle_load(p, "trailer") == pytest.approx((34.5 + 14.372 + 12.34) * 9806.65 / 4)


@pytest.mark.parametrize(("W", "doubted"), [("151 kN", False), ("150 kN", True), ("184 kN", False), ("185 kN", True)])
def test_an_axle_load_more_than_a_tenth_from_the_weight_is_doubted(W, doubted):
    assert bool(found(VEHICLE.replace("167 kN", W))) is doubted


def test_the_doubt_about_the_axle_load_says_which_would_fit():
    assert told(VEHICLE.replace("167 kN", "200 kN")) == [
        (
            1,
            26,
            "bogie.W: 200 kN on each of four axles is 800 kN, but car body, two bogie frames, four wheelsets and four "
            "motors weigh 669.5 kN: W = 167.4 kN would carry them",
        )
    ]
    ((line, column, message),) = told(VEHICLE.replace(", W: 167 kN", ""))
    assert (line, column, message[:16]) == (3, 3, "car_body: 200 kN")
    assert "motors" not in told(VEHICLE.replace("W: 167", "kind: trailer, W: 200"))[0][2]


def test_bogie_centres_apart_from_those_of_the_curve_are_noted():
    assert told(VEHICLE.replace("9.5 m", "9.45 m")) == [
        (6, 8, "car_body.l_c: 9.45 m is not half of curve.L, 19 m: the curve uses L, the motion of the car body l_c")
    ]


@pytest.mark.parametrize(("f_11", "doubted"), [("11 511", False), ("13 230", False), ("13 300", True)])
def test_creep_coefficients_that_may_be_swapped(f_11, doubted):
    texts = told(f"{{bogie: {{base: table1, f_11: {f_11} kN}}, speed: 80 m/s}}")
    assert bool(texts) is doubted
    assert not doubted or "1.16 times f_22: are the two swapped? Here f_11 is lateral" in texts[0][2]


def test_unusual_values_of_a_car_body_are_doubted_and_rigid_joints_are_not():
    assert "34.5 kg is unusual" in told(VEHICLE.replace("34.5 t", "34.5 kg").replace("167", "80"))[0][2]
    assert found(VEHICLE.replace("W:", "K_dt: rigid, W:")) == ()


# ----------------------------------------------------------------- starters


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_the_starter_with_a_car_body_reads_without_a_word(kind):
    text = starter(kind, car_body=True)
    assert found(text) == ()
    problem = loads(text)
    assert problem.car_body == BODY
    assert problem.bogie == table1(kind).replace(W={"power": "167 kN", "trailer": "150 kN"}[kind]).bogie
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("car_body", [False, True])
@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_what_a_starter_has_as_comments_reads_without_a_word(kind, car_body):
    text = starter(kind, car_body=car_body)
    written = re.sub(r"^  # (?!base|creep|catalogue)([\w]+: )", r"  \1", text, flags=re.MULTILINE)
    written = re.sub(r"^# ((conditions|requirements|cases|uncertainty):|  \w.*)", r"\1", written, flags=re.MULTILINE)
    assert found(written) == ()
    problem = loads(written)
    assert problem.flags == ("no gravitational stiffness",)
    assert {"J_wy", "I_b", "h_2t", "K_d1x", "C_2z"} <= set(problem.keys)
    assert len(problem.cases) == (3 if car_body else 1)
    assert problem.conditions.combinations == 5 * 2 * 2**3
    assert len(problem.requirements) == 3
    for speeds in re.findall(r"^# (speed: .*)", text, flags=re.MULTILINE):
        assert len(loads(text.replace("\nspeed: 300 km/h", f"\n{speeds}")).speeds) in (2, 11)


def test_the_shipped_vehicle_is_the_preset_under_the_curve_and_survives_its_faults():
    problem = load(Path(__file__).parents[2] / "problems" / "vehicle.yaml")
    assert problem.car_body == BODY
    assert [change.key for case in problem.cases for change in case.changes] == [
        *("leading.C_s", "leading.K_ds", "trailing.C_s", "trailing.K_ds")
    ]


def test_the_command_writes_a_file_with_a_car_body(tmp_path):
    path = tmp_path / "vehicle.yaml"
    assert CliRunner().invoke(app, ["new", str(path), "--car-body", "--kind", "trailer"]).exit_code == 0
    assert path.read_text(encoding="utf-8") == starter("trailer", car_body=True)
    result = CliRunner().invoke(app, ["check", str(path)])
    assert (result.exit_code, result.output) == (0, f"{path}: no errors\n")


def test_the_axle_load_is_that_of_the_vehicles_that_are_met():
    loads_that_fit = "conditions: {load: {tare: {W: 167 kN}, laden: {M_c: 40 t, W: 181 kN}}}\n"
    nominal = VEHICLE.replace("W: 167 kN", "W: 100 kN")
    assert any("would carry" in message for _, _, message in told(nominal))
    assert not any("would carry" in message for _, _, message in told(nominal + loads_that_fit))
    wrong = told(nominal + loads_that_fit.replace("181", "120"))
    assert [message.partition(":")[0] for _, _, message in wrong if "would carry" in message] == [
        "conditions.load.laden"
    ]

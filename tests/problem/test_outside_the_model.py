"""Keys of other vehicles are answered with what to do, in one line; those of this one are never taken for them."""

import pytest

import yawdesign as yd
from yawdesign.problem import ProblemError, loads, table1
from yawdesign.problem.condition import CREEP_FACTOR
from yawdesign.problem.creep import CREEP
from yawdesign.problem.faults import TOP
from yawdesign.problem.outside_the_model import answer_to
from yawdesign.problem.parameters import PARAMETERS
from yawdesign.problem.requirements import MEASURES
from yawdesign.problem.running import CURVE

OUTSIDE = {
    "axles": "two wheelsets",
    "number_of_axles": "two wheelsets",
    "third_wheelset": "two wheelsets",
    "nose_suspended": "kind: trailer",
    "axle_hung_motor": "kind: trailer",
    "motor_on_axle": "kind: trailer",
    "motors": "two motors",
    "dampers_per_side": "twice the C_s and K_ds",
    "n_yaw": "twice the C_s and K_ds",
    "yaw_dampers_per_bogie": "twice the C_s and K_ds",
    "blow_off": "below the blow-off",
    "friction": "friction has no part",
    "law": "linear",
    "nonlinear_damper": "linear",
    "flange_clearance": "nothing touches",
    "limits": "nothing touches",
    "anti_roll_bar": "K_2z + k/(2 b_2^2)",
    "inter_bogie_stiffness": "no spring or damper joins the bogies",
    "coupled_cars": "one car",
    "wheel_profile": "conicity lambda",
    "kalker_table": "conicity lambda",
    "bogies": "both bogies, and their ends, are equal",
    "K_1x_front": "both bogies, and their ends, are equal",
    "independently_rotating_wheels": "turn together",
    "radial_steering": "guided by the primary suspension",
    "active_damper": "passive",
    "Co-Co": "two wheelsets",
    "motor_on_car_body": "M_c, J_c and I_c",
    "C_s_per_side": "twice the C_s and K_ds",
    "two_stage_damper": "linear",
    "damper_curve": "linear",
    "rubber_spring": "stiffness and damping at hunting",
    "tractive_effort": "constant speed",
    "gearbox_mass": "the body that carries it",
    "bolster": "between bogie frame and car body",
    "track_stiffness": "the track is rigid",
    "crosswind": "nothing but the track",
    "derailment": "neither derailment nor wear",
    "ride_comfort": "`yawdesign simulate` computes it",
    "n_cars": "one car",
    "C_s_left": "both sides are equal",
    "bending_frequency": "all bodies are rigid",
    "C_2y": "as C_t",
    "yaw_stiffness": "b_2^2: K_2x",
    "primary_stiffness": "K_1x and K_1y",
    "equivalent_conicity": "as lambda",
    "wheel_load": "as W",
    "wheel": "conicity lambda",
    "vehicle": "under bogie and, where",
    "wheelbase": "half of it as a",
    "gauge": "as b",
}
RIGHT = {
    *PARAMETERS,
    *CURVE,
    *CREEP,
    *MEASURES,
    *TOP,
    CREEP_FACTOR.key,
    "kind",
    "base",
    "creep",
    "load",
    "objective",
    "variables",
}
SLIPS = (
    "C_S",
    "K1x",
    "conicity",
    "axle_load",
    "lamda",
    "lambda_",
    "stable",
    "Cs",
    "damping",
    "f_1",
    "M_car",
    "vr",
    "title2",
)


@pytest.mark.parametrize("key", OUTSIDE)
@pytest.mark.parametrize("part", ["", "bogie", "car_body", "curve"])
def test_every_part_of_a_file_answers(key, part):
    around = f", {part}: {{{key}: 3}}" if part not in ("", "bogie") else ""
    inside = f", {key}: 3" if part == "bogie" else ""
    top = f", {key}: 3" if not part else ""
    with pytest.raises(ProblemError) as caught:
        loads(f"{{bogie: {{base: table1{inside}}}, speed: 300 km/h{around}{top}}}")
    (line,) = (each.message for each in caught.value.diagnostics if each.key.split(".")[-1] == key)
    assert OUTSIDE[key] in line
    assert len(line) < 200
    assert "\n" not in line


@pytest.mark.parametrize(
    "where", ["requirements: {%s: 3}", "requirements: {cases: {%s: 3}}", "cases: {x: {%s: 50 %%}}"]
)
def test_requirements_and_faults_answer(where):
    with pytest.raises(
        ProblemError, match=r"derailment: .*outside this model, which computes neither derailment nor wear"
    ):
        loads(f"{{bogie: {{base: table1}}, speed: 300 km/h, {where % 'derailment'}}}")


@pytest.mark.parametrize("key", ["axles", "n_yaw", "wheel_profile"])
def test_replace_and_design_variables_answer(key):
    with pytest.raises(ProblemError, match=OUTSIDE[key]):
        table1().replace({key: 3})
    with pytest.raises(ProblemError, match=OUTSIDE[key]):
        table1().replace({f"design.variables.{key}": {"min": 1, "max": 2}})
    with pytest.raises(ProblemError, match=OUTSIDE[key]):
        table1().replace({"conditions": {key: [1, 2]}})


@pytest.mark.parametrize("key", [*sorted(RIGHT), *SLIPS])
def test_what_belongs_here_is_not_taken_for_another_vehicle(key):
    assert answer_to(key) is None


@pytest.mark.parametrize(
    ("bogie", "fragment"),
    [
        (
            "{base: table1, C_s: {table: [1, 2]}}",
            "bogie.C_s: {'table': ['1', '2']} is not a number: outside this model",
        ),
        ("{base: table1, C_s: {min: 1, max: 2}}", "bounds of a choice under design.variables"),
        ("{base: table1, lambda: [0.1, 0.2]}", "several that are met stand under conditions"),
        ("{base: table1, C_s: {velocity: [0, 1], force: [0, 2]}}", "which is linear"),
        ("{base: table1, lambda: S1002}", "bogie.lambda: S1002 is not a number: wheel and rail are here the conicity"),
        ("{base: table1, lambda: {table: a.csv}}", "which is linear: give the value for small motions"),
        ("{kind: motors, base: table1}", "is not one of: power, trailer; a power bogie has two motors"),
        ("{kind: jacobs, base: table1}", "jacobs is not one of: power, trailer; outside this model, in which one car"),
        ("{kind: trailer bogie, base: table1}", "is not one of: power, trailer; did you mean trailer?"),
        ("[{base: table1}, {base: table1}]", "both bogies, and their ends, are equal"),
        ("{base: table1, zzzzz: 3}", "bogie.zzzzz: is not a known key; `yawdesign schema` lists what is"),
    ],
)
def test_values_of_another_vehicle(bogie, fragment):
    with pytest.raises(ProblemError) as caught:
        loads(f"{{bogie: {bogie}, speed: 300 km/h}}")
    assert fragment in str(caught.value)


def test_axes_and_conditions_answer():
    with pytest.raises(ProblemError, match="axles: outside this model, in which every bogie has two wheelsets"):
        yd.sweep(table1(), of="stable", axles=[2, 3])
    with pytest.raises(ProblemError, match="profile: wheel and rail are here the conicity lambda"):
        yd.modes(table1(), condition={"profile": "worn"})


def test_several_cars():
    with pytest.raises(ProblemError, match="car_body: outside this model, in which one car runs alone"):
        loads("{bogie: {base: table1}, car_body: [{base: huo-dai}, {base: huo-dai}], speed: 300 km/h}")


def test_a_short_list_of_names_is_shown():
    with pytest.raises(ProblemError, match="known here: R, L, l, V_r, limit, load"):
        loads("{bogie: {base: table1}, speed: 300 km/h, curve: {zzzzz: 3}}")

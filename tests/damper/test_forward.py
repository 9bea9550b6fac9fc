"""Forward design: the paper's example, and the bogies for which its formula does not hold."""

import json
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.decision import decide
from yawdesign.damper.status import Status
from yawdesign.output.tables import design_tables, rendered

CASES = json.loads((Path(__file__).parents[1] / "data" / "cases.json").read_text())["cases"]


def problem_of(case):
    bogie = {("lambda_" if k == "lambda" else k): v for k, v in case["bogie"].items()}
    speed = f"{case['speed_kmh']} km/h"
    base = yd.table1(case["kind"])
    return yd.Problem(
        bogie=yd.Bogie(kind=case["kind"], C_s=case["C_s"], **bogie),
        speed=speed,
        equations=case["equations"],
        curve=base.curve,
    )


@pytest.mark.parametrize("entry", CASES, ids=lambda c: f"{c['name']}-{c['equations']}-{c['kind']}")
def test_reference_cases(entry):
    case = entry
    problem = problem_of(case)
    result, verdict = yd.design(problem), yd.stability(problem)
    assert result.checked
    assert verdict.checked
    assert [x.C_s for x in result.critical] == pytest.approx(case["critical_C_s"], rel=1e-8)
    assert [x.omega for x in result.critical] == pytest.approx(case["crossing_omega"], rel=1e-8)
    ends = [0.0, *case["critical_C_s"], np.inf]
    stable = [(ends[k], ends[k + 1]) for k, n in enumerate(case["unstable_roots_per_interval"]) if n == 0]
    assert len(result.stable_intervals) == len(stable)
    for found, expected in zip(result.stable_intervals, stable, strict=True):
        assert found == pytest.approx(expected, rel=1e-8)
    assert verdict.spectral_abscissa == pytest.approx(case["spectral_abscissa"], abs=1e-8)
    assert verdict.stable == (case["spectral_abscissa"] < 0)


@pytest.mark.parametrize(
    ("kind", "equations", "C_sl", "C_s"),
    [
        ("power", "as-printed", 90702.8897786979, 1_046_749),
        ("power", "reciprocal", 63607.4140611465, 1_030_005),
        ("trailer", "reciprocal", 440662.044792519, None),
    ],
)
def test_table_1(kind, equations, C_sl, C_s):
    result = yd.design(yd.table1(kind, equations))
    assert result.C_sl == pytest.approx(C_sl, rel=1e-9)
    assert result.status == "ok"
    assert result.stable
    assert result.C_s == pytest.approx(0.382 * result.C_su + 0.618 * result.C_sl, rel=1e-14)
    if C_s is not None:
        assert result.C_s == pytest.approx(C_s, abs=1)


def test_unrounded_motor_values_of_misprint_12():
    problem = yd.table1(equations="as-printed").replace(K_m=626478.98, C_m=19951.56)
    assert yd.design(problem).C_sl == pytest.approx(90727.8396, rel=1e-6)


def test_shipped_problems_agree_with_the_preset():
    folder = Path(__file__).parents[2] / "problems"
    for name, expected in (("table1", 90702.88978), ("power-bogie", 63607.41406), ("trailer-bogie", 440662.04479)):
        assert yd.design(yd.load(folder / f"{name}.yaml")).C_sl == pytest.approx(expected, rel=1e-9)


def test_stable_for_every_damping():
    result = yd.design(yd.table1().replace(speed="250 km/h"))
    assert result.status == "stable for every C_s"
    assert result.critical == ()
    assert result.stable_intervals == ((0.0, np.inf),)
    assert result.C_sl == 0
    assert result.C_s == pytest.approx(0.382 * result.C_su)
    assert result.to_dict()["stable_intervals"] == [[0.0, None]]


def named(name):
    return problem_of(next(c for c in CASES if c["name"] == name))


def test_stable_for_none():
    result = yd.design(named("rand06_2"))
    assert (result.status, result.C_s, result.C_sl, result.stable) == ("stable for none", None, None, False)
    assert "optimise" in result.message


def test_infeasible():
    result = yd.design(yd.table1().replace(speed="300 km/h", curve=yd.Curve(R=100, L=19, l=20, V_r="90 km/h")))
    assert result.status in {"infeasible", "infeasible in the curve"}
    assert result.C_s is None
    assert not result.stable


def test_golden_section_lies_in_a_stable_interval_when_several():
    result = yd.design(named("fm3.28_Cm_fixed"))
    assert result.status == "partly unstable"
    assert result.C_sl == pytest.approx(378999.312530699, rel=1e-8)
    assert result.stable
    limited = yd.design(named("fm3.28_Cm_fixed").replace(curve=yd.Curve(R=300, L=19, l=60, V_r=25, limit=0.0355)))
    assert limited.C_su < 378999
    assert limited.C_sl == pytest.approx(9080.14177996431, rel=1e-8)
    assert limited.C_sl < limited.C_s < 184043
    assert limited.stable


def test_without_a_curve_there_is_no_choice():
    result = yd.design(yd.table1().replace(curve=None))
    assert (result.status, result.C_s, result.C_su) == ("no upper limit", None, None)
    assert result.C_sl == pytest.approx(63607.4140611465, rel=1e-9)


def test_range_of_speeds_is_stable_at_all():
    base = yd.table1().replace(speed=yd.SpeedRange(min="200 km/h", max="350 km/h", steps=4))
    result = yd.design(base)
    assert result.C_sl == pytest.approx(266059.018759661, rel=1e-9)
    assert {round(x.speed * 3.6) for x in result.critical} == {300, 350}


def test_undamped_motor_yaw_is_stable_for_none():
    for equations in ("reciprocal", "as-printed"):
        problem = yd.table1(equations=equations).replace(C_mphi=0)
        result, verdict = yd.design(problem), yd.stability(problem)
        assert (result.status, result.checked, result.C_s) == ("motor yaw undamped", True, None)
        assert "C_mphi" in result.message
        assert (verdict.stable, verdict.checked) == (False, True)


def test_motor_without_spring_drifts_and_every_command_says_so():
    for key in ("K_m", "K_mphi"):
        problem = yd.table1().replace(**{key: 0})
        result, verdict = yd.design(problem), yd.stability(problem)
        assert result.checked
        assert result.status in {"stable for none", "motor yaw undamped"}
        assert (verdict.stable, verdict.checked) == (False, True)


def test_very_stiff_joint_raises_no_warning():
    assert yd.stability(yd.table1().replace(K_ds=1e18)).stable


def test_sensitivities_against_differences():
    problem = yd.table1(equations="as-printed")
    result = yd.design(problem)
    for name in ("a", "K_m", "lambda", "f_11", "b_3", "C_t"):
        value, h = problem.bogie.parameters()[name], 1e-5
        up, down = (yd.design(problem.replace(**{name: value * (1 + s)})).C_sl for s in (h, -h))
        assert result.sensitivity[name] == pytest.approx(np.log(up / down) / np.log((1 + h) / (1 - h)), rel=1e-5)


def test_what_is_stable_under_every_condition():
    first = np.array([[2.0, 3.0, 9.0]]), np.array([[0, 2, 0, 2]])  # stable in (0, 2) and (3, 9)
    second = np.array([[1.0, 4.0, 5.0, 6.0]]), np.array([[2, 0, 2, 0, 4]])  # in (1, 4) and (5, 6)
    decision = decide([first, second], np.array([np.inf]), np.array([True]))
    assert decision.stable_intervals(0) == ((1, 2), (3, 4), (5, 6))
    touching = np.array([[1.0]]), np.array([[0, 2]])
    nothing = decide([touching, (np.array([[1.0]]), np.array([[2, 0]]))], np.array([9.0]), np.array([True]))
    assert nothing.stable_intervals(0) == ()
    assert nothing.status == [Status.STABLE_FOR_NONE]


def test_every_status_tells_what_to_do():
    """A word leads back to its kind; where there is something to do, the message says so."""
    for status in Status:
        assert Status.named(str(status)) == status
        assert status.message.startswith(status.meaning)
        assert status.message.endswith(status.remedy)
        assert status.told("a reason").startswith(f"{status.meaning}: a reason")
    unequal = {status for status in Status if Status.named(str(status)) is not status}
    assert unequal >= {Status.NO_FEASIBLE_DESIGN, Status.UNVERIFIED_OPTIMUM}  # those of an optimum


@pytest.mark.parametrize("C_m", [1e-6, 1e-4, 1e-3, 2e-3, 1e-2])
def test_a_damper_with_hardly_any_damping_is_no_obstacle(C_m):
    # Its root is a million times faster than all others, and rounds the eigenvalues of the matrix.
    problem = yd.table1(equations="as-printed").replace(C_m=C_m)
    result = yd.design(problem)
    assert (result.status, result.checked) == ("ok", True)
    assert result.C_s == pytest.approx(1689833.0, rel=1e-6)
    verdict = yd.stability(problem.replace(C_s=result.C_s))
    assert verdict.checked
    assert verdict.stable


def test_no_negative_damping_is_printed_where_the_springs_alone_exceed_the_limit():
    found = yd.design(yd.table1().replace(limit=0.01))
    assert found.C_su < 0
    text = " ".join(rendered(design_tables(found)).split())
    assert "none: K_2x and C_t alone exceed" in text

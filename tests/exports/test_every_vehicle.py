"""Every exported function and file of every kind of vehicle against a state matrix that was written by hand."""

import json
import re
import runpy
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path

import casadi as ca
import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.io import loadmat
from scipy.optimize import brentq

import yawdesign as yd
from yawdesign.exports.functions import self_test
from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.hunting.critical_damping import CriticalValue
from yawdesign.problem.parameters import MOTOR_KEYS, CarBody

HERE = Path(__file__).parent
equations = runpy.run_path(str(HERE / "independent_vehicle.py"))["equations"]
Unit = runpy.run_path(str(HERE / "fmu_unit.py"))["Unit"]
units = runpy.run_path(str(HERE / "test_functions_units.py"))

BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
ONE = yd.table1().replace(C_s=1046770, lambda_=0.1)
WITHOUT_MOTORS = replace(ONE.bogie, kind="trailer", **dict.fromkeys(MOTOR_KEYS))
TRAILER = yd.Problem(bogie=WITHOUT_MOTORS, speed=ONE.speed, curve=ONE.curve)
PRIMARY = {"C_1x": 20e3, "C_1y": 25e3, "K_d1x": 10e6, "K_d1y": 11e6, "J_wy": 180.0}
ROLL = {"I_b": 3000.0, "K_1z": 1.2e6, "C_1z": 10e3, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.15}
KINDS = {
    "power vehicle": replace(ONE, car_body=BODY),
    "trailer vehicle": replace(TRAILER, car_body=BODY),
    "overturning": replace(TRAILER, car_body=replace(BODY, overturning=True)),
    "added parts": replace(TRAILER, car_body=BODY, bogie=replace(WITHOUT_MOTORS, **PRIMARY, **ROLL)),
    "bogie with rigid joints": ONE.replace(K_ds="rigid"),
    "bogie without gravitational stiffness": TRAILER.replace(gravitational_stiffness=False),
}


def by_hand(problem, **changes):
    p = {**problem.parameters(), "v": max(problem.speeds), **changes}
    return equations(
        p,
        gravity=problem.bogie.gravitational_stiffness,
        overturning=problem.car_body is not None and problem.car_body.overturning,
    )


@cache
def boundary_by_hand(name):
    """Return (C_s, omega) where the largest real part of the eigenvalues crosses zero."""

    def largest(C_s):
        s = np.linalg.eigvals(by_hand(KINDS[name], C_s=C_s).state_matrix())
        return s[s.real.argmax()]

    places = np.geomspace(1e4, 2e7, 60)
    values = [largest(C_s).real for C_s in places]
    found = [k for k in range(59) if values[k] * values[k + 1] < 0]
    if not found:
        return None
    C_s = brentq(lambda x: largest(x).real, places[found[-1]], places[found[-1] + 1], rtol=1e-13)
    return C_s, abs(largest(C_s).imag)


@pytest.fixture(params=KINDS)
def name(request, monkeypatch):
    """Give the name of a vehicle; its functions start at the boundary that was found by hand."""
    known = boundary_by_hand(request.param)
    critical = () if known is None else (CriticalValue(*known, becomes="stable", residual=0.0),)
    monkeypatch.setattr(ParametricModel, "critical", property(lambda self: critical))
    return request.param


def only(name, function, inputs=None):
    return yd.functions(KINDS[name], inputs, only=function).documented[function]


def evaluated(f, **values):
    given = {port.name: list(port.value) for port in f.inputs} | values
    return {key: np.array(x).squeeze() for key, x in f.function(**{k: ca.DM(x) for k, x in given.items()}).items()}


def roots_by_hand(name, **changes):
    return np.linalg.eigvals(by_hand(KINDS[name], **changes).state_matrix())


def same_roots(found, wanted):
    """Each of the roots of one list has its own among those of the other."""
    left = list(wanted)
    for s in found:
        k = int(np.argmin(np.abs(np.array(left) - s)))
        assert abs(left.pop(k) - s) < 1e-5 * (1 + abs(s))
    return left


def test_state_matrix_and_state_space(name):
    problem = KINDS[name]
    got, hand, model = evaluated(only(name, "state_matrix")), by_hand(problem), yd.state_space(problem)
    for A in (got["A"], model.A):
        assert not same_roots(np.linalg.eigvals(A), np.linalg.eigvals(hand.state_matrix()))
    n = len(hand.names)
    order = [model.states.index(x) for x in hand.names]
    velocities = [model.states.index(f"{x}_velocity") for x in hand.names]
    for place, track in enumerate(model.inputs):
        assert model.B[velocities, place] == pytest.approx(hand.B[track], rel=1e-12)
    # The motion at 2 Hz over one wheelset's alignment, whatever the states are called.
    A = hand.state_matrix()
    for j, track in ((0, model.inputs[0]), (-2, model.inputs[-2])):
        b = np.zeros(len(A))
        b[n : 2 * n] = hand.B[track]
        wanted = np.linalg.solve(4j * np.pi * np.eye(len(A)) - A, b)[:n]
        found = np.linalg.solve(4j * np.pi * np.eye(len(model.A)) - model.A, model.B[:, j])[order]
        assert found == pytest.approx(wanted, rel=1e-8, abs=1e-10 * np.abs(wanted).max())
    assert model.name == ("vehicle" if problem.car_body else "bogie")
    assert len(model.inputs) == (8 if problem.car_body else 4)


def test_characteristic_polynomial(name):
    f = only(name, "characteristic_polynomial")
    got, s = evaluated(f), roots_by_hand(name)
    parts = [got[key] for key in "ABC" if key in got]
    assert len(parts) == (3 if KINDS[name].car_body else 2)
    total = np.zeros(max(map(len, parts)))
    for power, part in enumerate(parts):
        total[: len(part)] += KINDS[name].bogie.C_s ** power * part
    assert got["core"] == pytest.approx(total[: len(got["core"])], rel=1e-11)

    # Each root of the polynomial is an eigenvalue; what is left over are motions that no yaw damper reaches.
    def error(p):
        return abs(np.polyval(p[::-1], s / 100)) / np.polyval(abs(p[::-1]), abs(s) / 100)

    small = np.sort(error(np.trim_zeros(got["core"], "b")))
    degree = len(np.trim_zeros(got["core"], "b")) - 1
    assert small[:degree].max() < 1e-9
    assert len(s) - degree == {"power vehicle": 4, "bogie with rigid joints": 2}.get(name, 0)
    assert "chi_sign" not in got
    powers = np.arange(len(got["whole_sign"]))[::-1]  # in s / (100 rad/s), divided by the largest
    logarithms = got["whole_log10"] + 2 * powers
    whole = np.trim_zeros(got["whole_sign"] * 10.0 ** (logarithms - logarithms.max()), "f")
    assert len(whole) - 1 == len(s)
    assert error(whole[::-1]).max() < 1e-9
    assert "paper" not in f.meaning
    assert all(port.unit and port.meaning for port in f.outputs)


@pytest.mark.parametrize("C_s", [1e5, 1046770.0, 1e7])
def test_signs_tell_stability(name, C_s):
    unstable = int((roots_by_hand(name, C_s=C_s).real > 0).sum())
    column = evaluated(only(name, "routh_column", "C_s"), C_s=C_s)["column"]
    assert int((np.sign(column[1:]) != np.sign(column[:-1])).sum()) == unstable
    minors = evaluated(only(name, "hurwitz_minors", "C_s"), C_s=C_s)["sign"]
    assert np.all(minors == 1) == (unstable == 0)


def test_stability_margin(name):
    s = roots_by_hand(name)
    decay, ratio = -s.real.max(), (-s.real / abs(s)).min()
    f = only(name, "stability_margin", "C_s")
    for by in (-1e-3, 1e-3):
        got = evaluated(f, sigma=decay + by, zeta=max(ratio + by, 0))
        assert np.all(got["decay_column"] > 0) == (by < 0)
        assert np.all(got["ratio_column"] > 0) == (by < 0 and ratio > 0)


def test_margin_equations(name):
    got = evaluated(only(name, "margin_equations", "C_s"), sigma=0.0, zeta=0.0)
    f = only(name, "margin_equations", "C_s")
    values = {port.name: np.array(port.value) for port in f.inputs}
    roots = np.concatenate(
        [np.roots([1, p, q]) for p, q in zip(values["quadratic_p"], values["quadratic_q"], strict=True)]
    )
    assert np.abs(got["residual"]).max() < 1e-6 * np.abs(np.poly(roots)).max()
    same_roots(100 * roots, roots_by_hand(name))


def test_critical_damping(name):
    known, f = boundary_by_hand(name), only(name, "critical_damping", "C_s,K_2y,lambda,v")
    assert known is not None
    got = evaluated(f)
    assert got["residual"] < 1e-10
    assert got["C_sl"] == pytest.approx(known[0], rel=1e-6)
    assert got["omega"] == pytest.approx(known[1], rel=1e-6)
    equation = only(name, "critical_equations", "lambda")
    assert np.abs(evaluated(equation, C_sl=got["C_sl"], omega=got["omega"])["residual"]).max() < 1e-9
    # The boundary moved by a parameter, with the matrix that was written by hand.
    for key, slope in zip(f.outputs[3].rows, got["gradient"], strict=True):
        value = {**KINDS[name].parameters(), "v": KINDS[name].speed}[key]
        ends = []
        for sign in (1, -1):
            moved = {key: value * (1 + sign * 1e-4)}

            def crossing(C_s, moved=moved):
                s = roots_by_hand(name, C_s=C_s, **moved)
                return s[np.argmin(abs(s - 1j * known[1]))].real

            ends.append(brentq(crossing, 0.98 * known[0], 1.02 * known[0], rtol=1e-13))
        assert slope == pytest.approx((ends[0] - ends[1]) / (2e-4 * value), rel=1e-4), key


def test_rotational_resistance_and_dynamic_stiffness(name):
    problem = KINDS[name]
    p, curve = problem.parameters(), problem.curve
    angle = curve.L / (2 * curve.R)
    rate = angle * curve.V_r / curve.l
    T = (p["C_s"] * p["b_3"] ** 2 + p["C_t"] * p["b_0"] ** 2) * rate + p["K_2x"] * p["b_2"] ** 2 * angle
    got = evaluated(only(name, "rotational_resistance"))
    assert got["T"] == pytest.approx(T, rel=1e-12)
    assert got["X"] == pytest.approx(T / (4 * p["W"] * p["a"]), rel=1e-12)
    assert got["C_su"] == pytest.approx(p["C_s"] + (4 * p["W"] * p["a"] * curve.limit - T) / p["b_3"] ** 2 / rate)
    Z = 1 / ((1 / p["K_ds"] if "K_ds" in p else 0) + 1 / (20j * p["C_s"]))
    got = evaluated(only(name, "dynamic_stiffness"))
    assert complex(got["Z_re"], got["Z_im"]) == pytest.approx(Z, rel=1e-12)
    assert got["phase"] == pytest.approx(np.angle(Z), rel=1e-12)


def test_files_say_which_vehicle(name, tmp_path):
    problem = KINDS[name]
    names = "state_matrix,dynamic_stiffness"
    formats = "c,casadi,mat"
    result = yd.export(problem, tmp_path / "out", only=names, formats=formats)
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text(encoding="utf-8"))
    assert not result.notes
    assert manifest["kind"] == problem.bogie.kind
    assert manifest["car_body"] == (problem.car_body is not None)
    assert manifest["flags"] == sorted(problem.flags)
    assert manifest["rigid_joints"] == (["K_ds"] if name == "bogie with rigid joints" else [])
    assert ("roll of the bogie frame" in manifest["parts"]) == (name == "added parts")
    head = (tmp_path / "out" / "yawdesign.h").read_text()
    assert ("car body on two bogies" in head) == manifest["car_body"]
    loaded = ca.Function.load(str(tmp_path / "out" / "dynamic_stiffness.casadi"))
    test = self_test(only(name, "dynamic_stiffness"))
    assert float(loaded.call(list(test["inputs"].values()))[0]) == test["outputs"]["Z_re"][0]
    if "mat" in formats:
        mat = loadmat(tmp_path / "out" / "state_space.mat")
        assert not same_roots(np.linalg.eigvals(mat["A"]), roots_by_hand(name))
        assert set(mat["parameters"].dtype.names) == set(problem.parameters())


def test_the_paper_s_bogie_says_nothing_more(tmp_path):
    yd.export(ONE, tmp_path / "out", only="dynamic_stiffness", formats="casadi")
    assert "car_body" not in json.loads((tmp_path / "out" / "manifest.json").read_text(encoding="utf-8"))


def small_powers(unit):
    """Return a unit with no power above 9, as a problem file has them: (N/m)^11 is (N/m)^9·(N/m)^2."""
    return re.sub(r"(\([^)]+\))\^(1\d)", lambda m: f"{m[1]}^9·{m[1]}^{int(m[2]) - 9}", unit)


@pytest.mark.parametrize("quantity", units["UNITS"])
def test_every_output_has_the_unit_that_it_says(name, quantity):
    if "overturning" in KINDS[name].flags and quantity != "mass":
        pytest.skip("the acceleration of free fall is a number in it")
    change = units["UNITS"][quantity]
    names = ["state_matrix", "characteristic_polynomial", "routh_column", "critical_equations", "dynamic_stiffness"]
    for key, f in yd.functions(KINDS[name], only=names).documented.items():
        if quantity == "time" and key in units["SCALED"]:
            continue
        before, after = units["outputs"](f), units["outputs"](f, change)
        for port, one, other in zip(f.outputs, before, after, strict=True):
            if "log10" not in port.name:
                expected = one * units["recounted"](map(small_powers, units["entries"](port)), change)
                assert other == pytest.approx(expected, rel=1e-6, abs=1e-9 if "equations" in key else 1e-12), key


@pytest.mark.slow
def test_c_code_passes_its_self_test(name, tmp_path):
    yd.export(KINDS[name], tmp_path / "out", formats="c")
    done = subprocess.run(["make", "-s", "-C", tmp_path / "out", "check"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count(" ok\n") == 10


def test_fmu(name, tmp_path, request):
    problem = KINDS[name]
    path = tmp_path / "one.fmu"
    assert yd.write_fmu(problem, path).platform
    assert validate_fmu(str(path)) == []
    variables = {v.name: v for v in fmpy.read_model_description(str(path)).modelVariables}
    assert {k for k, v in variables.items() if v.causality == "parameter"} == {*problem.parameters(), "v"}
    unit = Unit(str(path), tmp_path / "instance")
    request.addfinalizer(unit.fmu.freeInstance)
    hand, n = by_hand(problem), len(by_hand(problem).names)
    A, tracks = hand.state_matrix(), list(hand.B)
    rates = [f"der({x}_velocity)" for x in hand.names]
    # Positions, velocities and tracks in turn; the strokes are checked by the eigenvalues of the whole Jacobian.
    for k, x in enumerate([*hand.names, *(f"{x}_velocity" for x in hand.names)]):
        unit.set({x: 1.0})
        assert unit.get(*rates) == pytest.approx(A[n : 2 * n, k], rel=1e-10, abs=1e-9 * np.abs(A[n : 2 * n]).max())
        unit.set({x: 0.0})
    for track in tracks:
        unit.set({track: 1.0})
        assert unit.get(*rates) == pytest.approx(hand.B[track], rel=1e-12)
        unit.set({track: 0.0})
    J = np.transpose([unit.derivatives(e) for e in np.eye(len(unit.states))])
    assert not same_roots(np.linalg.eigvals(J), np.linalg.eigvals(A))
    for key in problem.parameters():
        if key != "C_s":
            value = problem.parameters()[key]
            unit.set({key: 1.2 * value})
            J = np.transpose([unit.derivatives(e) for e in np.eye(len(unit.states))])
            moved = by_hand(problem, **{key: 1.2 * value}).state_matrix()
            assert np.trace(J @ J) == pytest.approx(np.trace(moved @ moved), rel=1e-10), key
            unit.set({key: float(value)})

"""Sweeps under conditions, and over the numbers of the curve: each point is what the single command answers."""

import csv
import json

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.curving import curving_limit
from yawdesign.problem.running import CURVE

TABLE1 = yd.table1().replace(speed="300 km/h", C_s="1.2 MN s/m")
LISTS = {"lambda": [0.05, 0.4], "creep_factor": [1.0, 0.5], "load": {"tare": {"W": 120e3}, "laden": {"W": 200e3}}}
TOLERANCE = {"tolerance": {"C_s": 0.15}}


def test_designs_under_conditions():
    problem = TABLE1.replace(conditions=LISTS | TOLERANCE)
    result = yd.sweep(problem, of="design", K_2x=[1.2e5, 1.5e5])
    for k, K_2x in enumerate(result.axes[0].values):
        expected = yd.design(problem.replace(K_2x=K_2x))
        for name in ("C_s", "C_sl", "C_su", "rotational_resistance"):
            assert result.columns[name][k] == pytest.approx(getattr(expected, name), rel=1e-8)
        assert result.columns["status"][k] == expected.status
    assert result.boundary is None  # each condition has critical values of its own
    for text in ("lambda 0.05, 0.4", "creep x 1, 0.5", "load tare, laden", "C_s -15 ... +15 % (9 values)"):
        assert text in result.conditions
    assert result.to_dict()["conditions"] == result.conditions


@pytest.mark.parametrize("of", ["stable", "decay_rate", "damping_ratio"])
def test_margins_under_conditions(of):
    problem = TABLE1.replace(conditions=LISTS)
    points = [3e5, 8e5, 1.4e6, 2.5e6]
    result = yd.sweep(problem, of=of, C_s=points)
    exact = [getattr(yd.stability(problem.replace(C_s=C_s)), of) for C_s in points]
    assert result.values == pytest.approx(exact, rel=1e-7)
    assert of != "stable" or set(exact) == {True, False}
    wider = yd.sweep(TABLE1.replace(conditions=LISTS | {"tolerance": {"K_1x": 0.1}}), of=of, C_s=points)
    assert np.all(wider.values <= result.values)


def test_an_axis_of_the_damping_has_no_tolerance_of_it():
    axis = yd.sweep(TABLE1.replace(conditions=TOLERANCE), of="decay_rate", C_s=[5e5, 1e6])
    assert axis.values == pytest.approx(yd.sweep(TABLE1, of="decay_rate", C_s=[5e5, 1e6]).values, rel=1e-12)


@pytest.mark.parametrize("name", CURVE)
def test_every_number_of_the_curve(name):
    value = float(getattr(TABLE1.curve, name))
    points = [0.8 * value, value, 1.1 * value]
    result = yd.sweep(TABLE1, of="design", f_m=[2.0, 3.0], **{name: points})
    for k, x in enumerate(points):
        problem = TABLE1.replace(curve=yd.Curve(**{**vars(TABLE1.curve), name: x}))
        C_su = curving_limit(problem.bogie.parameters(), problem.curve)
        assert result.columns["C_su"][:, k] == pytest.approx(C_su, rel=1e-12)
        C_s = 0.382 * C_su + 0.618 * result.columns["C_sl"][:, k]
        assert result.values[:, k] == pytest.approx(C_s, rel=1e-12)
        resisted = result.columns["rotational_resistance"][:, k]
        p = problem.bogie.parameters()
        moment = (C_s * p["b_3"] ** 2 + p["C_t"] * p["b_0"] ** 2) * problem.curve.V_r / problem.curve.l
        moment = (moment + p["K_2x"] * p["b_2"] ** 2) * problem.curve.L / (2 * problem.curve.R)
        assert resisted == pytest.approx(moment / (4 * p["W"] * p["a"]), rel=1e-12)


def test_a_curve_too_tight_for_any_damper():
    result = yd.sweep(TABLE1, of="design", R="60 m:600 m:4")
    assert result.columns["status"][0] == "infeasible in the curve"
    assert np.isnan(result.values[0])
    assert result.columns["status"][-1] == "ok"


def test_files_and_pictures_of_a_curve_axis(tmp_path):
    result = yd.sweep(TABLE1, of="design", V_r="60 km/h:120 km/h:7")
    result.to_csv(tmp_path / "a.csv")
    head, *rows = csv.reader(x for x in (tmp_path / "a.csv").read_text().splitlines() if x[0] != "#")
    assert head[:2] == ["V_r [m/s]", "C_s [N s/m]"]
    assert [float(row[0]) for row in rows] == pytest.approx(np.linspace(60, 120, 7) / 3.6)
    result.to_npz(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as arrays:
        assert json.loads(str(arrays["units"]))["V_r"] == "m/s"
        assert arrays["axis_V_r"].size == 7
    axes = yd.plot(result)
    assert "[km/h]" in axes.get_xlabel()
    assert result.to_xarray().V_r.attrs["units"] == "m/s"


def test_pictures_say_the_conditions():
    axes = yd.plot(yd.sweep(TABLE1.replace(conditions=LISTS), of="C_sl", f_m=[2.0, 3.0, 4.0]))
    assert "load tare, laden" in axes.get_title("left").replace("\n", " ")

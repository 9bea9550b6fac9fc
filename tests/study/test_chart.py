"""What a picture of a sweep shows beside its values: where a verdict changes, against single verdicts."""

from dataclasses import replace

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.study import chart
from yawdesign.study import sweep as sweeps

PRINTED = yd.table1(equations="as-printed")
GRID = {"C_s": np.geomspace(2e4, 1e6, 9), "v": np.linspace(70, 120, 8)}


def changes(result):
    """Yield the place before, at and after each change of a verdict, as parameters."""
    for k, axis in enumerate(result.axes):
        for place in zip(*np.nonzero(np.isfinite(result.chart.crossings[k])), strict=True):
            after = (*place[:k], place[k] + 1, *place[k + 1 :])
            own = {a.name: float(a.values[i]) for a, i in zip(result.axes, place, strict=True)}
            yield axis.name, place, after, own, float(result.chart.crossings[k][place])


def stable(problem, C_s, v):
    return yd.stability(problem.replace(C_s=C_s, speed=f"{v!r} m/s")).stable


def test_the_verdict_changes_where_it_is_said_to():
    result = yd.sweep(PRINTED, of="stable", **GRID)
    found = list(changes(result))
    assert len(found) > 8
    for name, place, after, own, crossing in found:
        step = 0.005 * crossing
        before, beyond = (stable(PRINTED, **{**own, name: crossing + sign * step}) for sign in (-1, 1))
        assert (before, beyond) == (result.values[place], result.values[after])


def test_it_is_that_under_all_conditions():
    problem = PRINTED.replace(conditions={"lambda": [0.1, 0.15, 0.3]})
    result = yd.sweep(problem, of="stable", **GRID)
    name, place, after, own, crossing = next(changes(result))
    verdicts = [stable(problem, **{**own, name: crossing * part}) for part in (0.995, 1.005)]
    assert verdicts == [result.values[place], result.values[after]]
    assert result.boundary is None


def test_of_a_margin_it_lies_between_the_points():
    result = yd.sweep(PRINTED, of="decay_rate", **GRID)
    for name, place, after, own, crossing in changes(result):
        axis = next(axis for axis in result.axes if axis.name == name)
        k = list(own).index(name)
        assert axis.values[place[k]] < crossing < axis.values[after[k]]
        assert (result.values[place] > 0) != (result.values[after] > 0)


def test_the_limit_of_the_curve_and_what_is_written():
    result = yd.sweep(PRINTED.replace(C_s=5e5), of="stable", C_s=[1e4, 1e5, 1e6], W=[1e5, 2e5])
    single = [yd.design(PRINTED.replace(W=W)).C_su for W in (1e5, 2e5)]
    assert result.chart.C_su == pytest.approx(single, rel=1e-12)
    assert result.chart.as_written == {"C_s": (5e5,), "W": (2e5,), "v": pytest.approx((300 / 3.6,))}
    ratio = yd.sweep(PRINTED, of="C_sl", limit=[0.05, 0.08])
    assert ratio.chart.C_su == pytest.approx([yd.design(PRINTED.replace(limit=x)).C_su for x in (0.05, 0.08)])
    assert yd.sweep(PRINTED.replace(curve=None), of="C_sl", f_m=[2.0, 3.0]).chart.C_su is None


def test_the_number_of_critical_values_changes_between_two_points():
    result = yd.sweep(PRINTED, of="critical", f_m=[3.0, 3.5])
    between = result.chart.between
    assert between["axis"].size == chart.STEPS * 1
    assert np.all((between["axis"] > 3.0) & (between["axis"] < 3.5))
    ends = np.sort(between["axis"])
    gaps = np.diff(ends)
    assert gaps.min() < 0.5 / 2 ** (chart.STEPS - 1)
    assert yd.sweep(PRINTED, of="critical", f_m=[5.0, 5.5]).chart.between is None


def test_a_plane_of_a_sweep_has_its_own():
    whole = yd.sweep(PRINTED, of="stable", **GRID, lambda_=[0.1, 0.15])
    assert whole.chart is None
    alone = yd.sweep(PRINTED.replace(lambda_=0.15), of="stable", **GRID)
    for found, wanted in zip(whole.at(lambda_=0.15).chart.crossings, alone.chart.crossings, strict=True):
        assert found == pytest.approx(wanted, nan_ok=True)
    one = yd.sweep(PRINTED, of="stable", **GRID, lambda_=0.15)
    for found, wanted in zip(one.at(lambda_=0.15).chart.crossings, alone.chart.crossings, strict=True):
        assert found == pytest.approx(wanted, nan_ok=True)


def test_no_fault_costs_the_points(monkeypatch):
    def broken(*arguments):
        raise RuntimeError("no")

    monkeypatch.setattr(sweeps, "charted", broken)
    with pytest.warns(RuntimeWarning, match="critical lines for a picture are missing"):
        result = yd.sweep(PRINTED, of="stable", **GRID)
    assert result.chart is None
    assert result.finished.all()
    assert yd.plot(result).get_legend() is not None


def test_an_unverified_point_is_of_its_own_kind():
    result = yd.sweep(PRINTED, of="stable", **GRID)
    doubted = replace(result, unverified=np.indices(result.finished.shape).sum(axis=0) == 3)
    assert np.array_equal(chart.kinds_of("stable", doubted.columns, doubted.known) == chart.UNKNOWN, doubted.unverified)
    drawn = yd.plot(doubted.at(v=GRID["v"][3]))
    assert "not verified" in [text.get_text() for text in drawn.get_legend().get_texts()]

"""Results as tables of pandas: their rows, their numbers, their units."""

import sys

import numpy as np
import pytest

import yawdesign as yd

FIRST = {
    "Reproduction": "rows",
    "Stability": "modes",
    "CriticalSpeeds": "critical_speeds",
    "ForwardDesign": "critical",
    "Optimum": "bounds",
    "Choice": "candidates",
    "TradeOff": "front",
    "Sweep": "points",
    "Uncertainty": "sobol",
    "Simulation": "histories",
    "DamperComponent": "over_frequency",
    "FrequencyResponse": "amplitudes",
    "StationaryResponse": "rms",
    "SpectrumCheck": "densities",
    "Modes": "modes",
    "FollowedModes": "modes",
}


def test_every_result_has_a_table(kind_of_result, results):
    result = results[kind_of_result]
    if kind_of_result == "Problem":
        return
    frame = result.to_pandas()
    assert frame.attrs["units"].keys() <= set(frame.columns)
    tables = list(result._tables())
    if kind_of_result in FIRST:
        assert tables[0] == FIRST[kind_of_result]
        assert frame.equals(result.to_pandas(tables[0]))
    else:
        assert (tables, len(frame)) == ([], 1)
    for name in tables:
        assert len(result.to_pandas(name).columns) > 1


def test_rows_are_the_entries(results):
    choice = results["Choice"].to_pandas()
    assert list(choice["name"]) == [each.name for each in results["Choice"].candidates]
    assert choice["worst_condition.load"][0] == results["Choice"].best.worst_condition["load"]
    assert choice.attrs["units"]["C_s"] == "N·s/m"
    assert choice.attrs["units"]["worst_condition.speed"] == "m/s"
    cases = results["Stability"].to_pandas("cases")
    assert (len(cases), cases["damping_ratio"][0]) == (1, results["Stability"].cases[0].damping_ratio)
    front = results["TradeOff"].to_pandas()
    assert list(front["worst_condition.lambda"]) == [0.05, 0.25]
    modes = results["Modes"].to_pandas().set_index("name")
    assert modes["frequency"]["lower sway"] == results["Modes"]["lower sway"].frequency
    assert results["CriticalSpeeds"].to_pandas().empty
    assert "omega" in results["CriticalSpeeds"].to_pandas().columns


def test_a_sweep_has_a_row_for_each_point():
    sweep = yd.sweep(yd.table1().replace(C_s=1e6), of="decay_rate", v=[60.0, 70.0], lambda_=[0.1, 0.2, 0.3])
    frame = sweep.to_pandas()
    assert list(frame["v"]) == [60.0] * 3 + [70.0] * 3
    assert frame["decay_rate"][4] == sweep.values[1, 1]
    assert frame.attrs["units"] == {"v": "m/s", "lambda": "-", "decay_rate": "1/s"}


def test_several_values_at_a_point_have_columns_of_their_own(results):
    frame = results["Sweep"].to_pandas()
    assert list(frame["critical_1"].round(-3)) == [round(values[0], -3) for values in results["Sweep"].values]
    assert np.isnan(frame["critical_2"][0])
    assert frame.attrs["units"]["critical_2"] == "N·s/m"


def test_histories_stand_below_each_other():
    run = yd.simulate(yd.table1().replace(C_s=1e6), speed=[60.0, 70.0], duration=0.5)
    frame = run.to_pandas()
    assert len(frame) == sum(len(history.time) for history in run.histories)
    assert frame["y_b"].iloc[-1] == run.histories[1]["y_b"][-1]
    assert frame["speed"].iloc[[0, -1]].tolist() == [60.0, 70.0]
    assert (frame.attrs["units"]["y_b"], frame.attrs["units"]["time"]) == ("m", "s")
    assert list(run.to_pandas("runs")["speed"]) == [60.0, 70.0]


def test_answers_over_the_wavelength(results):
    frame, found = results["FrequencyResponse"].to_pandas(), results["FrequencyResponse"]
    assert list(frame["wavelength"]) == [5.0, 10.0, 20.0]
    assert frame["y_b"][2] == found.y_b[2]


def test_a_table_that_is_not_there_is_told(results):
    with pytest.raises(yd.ProblemError, match=r"case is not known.* did you mean cases\?; .*: modes, .*cases"):
        results["Stability"].to_pandas("case")


def test_pandas_is_asked_for(results, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(yd.ProblemError, match=r"pip install 'yawdesign\[pandas\]'"):
        results["Stability"].to_pandas()

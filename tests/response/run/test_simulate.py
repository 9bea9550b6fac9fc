"""Runs: starts, speeds, what is reported, and all that may be wrong."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import yawdesign as yd
from yawdesign.response.run import time_history as motion
from yawdesign.response.run.run import fitted_rate
from yawdesign.response.run.system import system_at
from yawdesign.response.run.time_steps import first_order_hold

PROBLEM = yd.table1().replace(C_s="1 MN s/m")


def test_one_run_for_each_speed():
    result = yd.simulate(PROBLEM, speed=["200 km/h", 300 / 3.6, "250 km/h"], duration=5)
    assert [round(3.6 * run.speed) for run in result.runs] == [200, 300, 250]
    assert result.speed == pytest.approx(300 / 3.6)
    assert result.rms == result.runs[1].rms
    assert result.damper.speed == result.speed
    ranged = PROBLEM.replace(speed=yd.SpeedRange(min="200 km/h", max="300 km/h", steps=3))
    assert [run.speed for run in yd.simulate(ranged, duration=2).runs] == list(ranged.speeds)


def test_rms_and_peak_are_those_of_the_history():
    result = yd.simulate(PROBLEM, duration=5)
    history = result.histories[0]
    assert set(result.rms) == set(result.peak) == {x for x in history.values if x[:2] not in ("al", "cr")}
    for name, rms in result.rms.items():
        assert rms == pytest.approx(np.sqrt(np.mean(history[name] ** 2)))
        assert result.peak[name] == pytest.approx(np.max(np.abs(history[name])))


def test_result_is_plain_data():
    result = yd.simulate(PROBLEM, duration=2)
    data = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert "histories" not in data
    assert data["rms"]["y_b"] == result.rms["y_b"]
    assert data["runs"][0]["settles"] is True
    assert "amplitudes settle" in repr(result)
    with pytest.raises(yd.ProblemError, match="did you mean y_b"):
        result.histories[0]["yb"]


def test_from_rest_and_from_an_offset():
    rest = yd.simulate(PROBLEM, start="rest", duration=2).histories[0]
    assert rest["y_b"][0] == rest["yaw_damper_stroke"][0] == 0
    moved = yd.simulate(PROBLEM, "smooth", start="offset", offset={"phi_b": "2 mrad", "y_w1": "1 mm"}, duration=10)
    history = moved.histories[0]
    assert [history[x][0] for x in ("phi_b", "y_w1", "y_b")] == pytest.approx([2e-3, 1e-3, 0])
    # The dampers had come to rest before it was let go.
    assert history["yaw_damper_force"][0] == pytest.approx(0, abs=1e-6)
    assert history["yaw_damper_stroke"][0] == pytest.approx(2e-3 * PROBLEM.bogie.b_3)
    assert np.max(np.abs(history["y_b"][-1000:])) < 1e-3 * np.max(np.abs(history["y_b"]))
    together = yd.simulate(PROBLEM, "smooth", start="offset", offset="5 mm", duration=1).histories[0]
    assert [together[x][0] for x in ("y_b", "y_w2", "y_m1", "phi_b")] == pytest.approx([5e-3] * 3 + [0])


def test_a_stationary_run_leads_back_to_its_start():
    history = yd.simulate(PROBLEM, duration=7).histories[0]
    for name, values in history.values.items():
        assert values[-1] == pytest.approx(values[0], abs=1e-9 * np.max(np.abs(values))), name


def test_an_unstable_bogie_is_said_to_be_unstable():
    problem = yd.table1(equations="as-printed").replace(C_s="50 kN s/m")
    result = yd.simulate(problem, speed=["250 km/h", "300 km/h"], duration=20)
    slow, fast = result.runs
    assert slow.settles
    assert not fast.settles
    assert not result.settles
    assert result.checked
    assert fast.verdict.startswith("UNSTABLE: amplitudes do not settle")
    assert fast.start == "rest"
    assert fast.rms_stationary is None
    assert fast.fitted_rate == pytest.approx(fast.spectral_abscissa, rel=0.01)


def test_an_unstable_bogie_usually_runs_until_it_has_grown_a_thousandfold():
    problem = yd.table1(equations="as-printed").replace(C_s="50 kN s/m")
    run = yd.simulate(problem).runs[0]
    assert run.duration * run.spectral_abscissa == pytest.approx(7, rel=1e-3)
    assert run.peak["y_b"] < 100
    assert yd.simulate(problem, duration=30).runs[0].duration == pytest.approx(30)


def test_a_strongly_unstable_run_is_cut_before_it_overflows():
    problem = yd.table1().replace(C_s=0, speed="900 km/h")
    result = yd.simulate(problem, duration="1e4 s", step="2 ms", start="rest")
    assert result.runs[0].duration < 1e4
    assert np.isfinite(list(result.peak.values())).all()
    assert result.damper is None
    assert "damper" in result.to_dict()


@settings(max_examples=20, deadline=None)
@given(st.floats(4, 6.5), st.floats(100, 400), st.sampled_from(["as-printed", "reciprocal"]))
def test_fitted_rate_is_the_eigenvalue(power, kmh, equations):
    problem = yd.table1(equations=equations).replace(C_s=10**power)
    system = system_at(problem, kmh / 3.6)
    hold = first_order_hold(system.A, system.B, 1e-3)
    abscissa = system.eigenvalues.real.max()
    rate, watched = fitted_rate(hold.transition, 1e-3, len(system.coordinates), 1.0)
    assert rate == pytest.approx(abscissa, rel=0.01, abs=2e-3)
    assert watched > 0


def test_a_wrong_step_is_noticed(monkeypatch):
    def wrong(A, B, step):
        return first_order_hold(A * 1.02, B, step)

    monkeypatch.setattr(motion, "first_order_hold", wrong)
    assert not yd.simulate(PROBLEM, duration=10).checked


def test_progress_is_told():
    told = []
    yd.simulate(PROBLEM, speed=[60, 70], duration=1, progress=lambda text, part: told.append((text, part)))
    assert told[0] == ("running at 216 km/h", 0.0)
    assert [call for call in told if call[1] == 0.5] == [("running at 252 km/h", 0.5)]


def test_all_mistakes_at_once():
    with pytest.raises(yd.ProblemError) as error:
        yd.simulate(
            PROBLEM,
            "german-medium",
            speed="300 kg",
            duration="-1 s",
            length=5,
            step="1 m",
            start="resting",
        )
    text = str(error.value)
    for part in ("german-medium", "speed", "duration", "length", "step", "start", "did you mean rest"):
        assert part in text
    with pytest.raises(yd.ProblemError, match="did you mean y_b"):
        yd.simulate(PROBLEM, start="offset", offset={"yb": 1})
    with pytest.raises(yd.ProblemError, match="seed"):
        yd.simulate(PROBLEM, seed=-1)
    with pytest.raises(yd.ProblemError, match="seed: the track smooth takes none"):
        yd.simulate(PROBLEM, "smooth", seed=1)
    with pytest.raises(yd.ProblemError, match="band: the track harmonic takes none"):
        yd.simulate(PROBLEM, yd.Harmonic(), band=(1, 2))
    with pytest.raises(yd.ProblemError, match='offset: is used with the start "offset" alone'):
        yd.simulate(PROBLEM, offset=1)
    with pytest.raises(yd.ProblemError, match="no speed"):
        yd.simulate(PROBLEM, speed=[])
    with pytest.raises(yd.ProblemError, match="too short"):
        yd.simulate(PROBLEM, duration=0.02)


def test_damping_must_be_given():
    text = "{bogie: {base: table1}, speed: 250 km/h}"
    problem = yd.loads(text)
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.simulate(problem.replace(bogie=yd.Bogie(**{**_fields(problem.bogie), "C_s": None})))


def _fields(bogie):
    return {name: getattr(bogie, name) for name in bogie.__dataclass_fields__}

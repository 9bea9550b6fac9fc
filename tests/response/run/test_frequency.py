"""Frequency responses: the reference values, the two ways, and what may be written."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.response.run import frequency
from yawdesign.response.run.system import system_at
from yawdesign.vehicle.vehicle import Model, families

# Exact responses of the Table I bogie, computed outside of this package (rational arithmetic).
CASES = json.loads((Path(__file__).parents[2] / "data" / "frf.json").read_text())["cases"]
NAMES = {"alignment": "alignment", "cross-level angle": "cross_level"}


@pytest.mark.parametrize("exact", CASES, ids=lambda c: f"{c['speed_kmh']}-{c['wavelength_m']}-{c['input'][:5]}")
def test_reference(exact):
    problem = yd.table1(equations=exact["equations"]).replace(C_s=exact["C_s"], speed=f"{exact['speed_kmh']} km/h")
    result = yd.frequency_response(problem, wavelength=exact["wavelength_m"], input=NAMES[exact["input"]])
    for name in ("y_b", "phi_b", "y_w1"):
        assert getattr(result, name) == pytest.approx(complex(*exact[name]), rel=1e-9)
    assert result.checked


def test_texts_and_arrays():
    problem = yd.table1()
    many = yd.frequency_response(problem, ["20 m", 40, np.float64(5)])
    assert many.y_b.shape == (3,)
    assert many.frequency == pytest.approx(problem.speeds[0] / np.array([20, 40, 5]))
    assert yd.frequency_response(problem, "20 m").y_b == pytest.approx(many.y_b[0], rel=1e-12)
    assert yd.frequency_response(problem, "40 m", speed="300 km/h").phi_w2 == pytest.approx(many.phi_w2[1], rel=1e-12)
    one = yd.frequency_response(problem, "20 m", input="cross_level")
    assert one.to_dict()["y_b"] == [one.y_b.real, one.y_b.imag]
    assert one.to_dict()["wavelength"] == 20.0


def test_a_trailer_bogie_has_no_motors():
    result = yd.frequency_response(yd.table1("trailer").replace(C_s="1 MN s/m"))
    assert result.checked
    assert result.y_m1 is None
    assert result.to_dict()["y_m1"] is None
    assert "y_m1" not in result.amplitudes
    with pytest.raises(AttributeError, match="y_m3"):
        result.y_m3  # noqa: B018


def test_amplitudes_are_attributes_and_entries():
    result = yd.frequency_response(yd.table1(), [20, 40])
    assert list(result.amplitudes) == list(Model().coordinates)
    for name, values in result.amplitudes.items():
        assert getattr(result, name) is values
    head = ["wavelength", "frequency", "input", "speed", "C_s", "stable", "checked", "condition"]
    bogies, _ = families()
    assert list(result.to_dict()) == [*head, *bogies]
    assert {name for name in bogies if result.to_dict()[name] is None} == {"th_b"}
    again = pickle.loads(pickle.dumps(result))
    assert again.phi_m2 == pytest.approx(result.phi_m2)
    assert repr(again) == repr(result)


def test_a_very_long_wave_carries_everything_along_but_the_car_body():
    """On a shifted track the bogie stands where the secondary springs and gravity and creep balance."""
    problem = yd.table1()
    slow = yd.frequency_response(problem, "1e7 m")
    system = system_at(problem, problem.speeds[0])
    static = -np.linalg.solve(system.A, system.B @ [1, 0, 1, 0])
    assert slow.y_b == pytest.approx(static[system.coordinates.index("y_b")], rel=1e-4)


def test_a_wrong_state_matrix_is_noticed(monkeypatch):
    right = system_at

    def wrong(problem, v):
        system = right(problem, v)
        system.A[10, 0] *= 1.0001
        return system

    monkeypatch.setattr(frequency, "system_at", wrong)
    assert not yd.frequency_response(yd.table1()).checked


def test_an_unstable_bogie_is_called_so():
    assert not yd.frequency_response(yd.table1().replace(C_s=5e4)).stable


def test_all_mistakes_at_once():
    problem = yd.table1().replace(speed=yd.SpeedRange(min=50, max=80))
    with pytest.raises(yd.ProblemError) as error:
        yd.frequency_response(problem, wavelength="20 s", input="cross-level")
    text = str(error.value)
    assert "wavelength" in text
    assert "did you mean cross_level" in text
    assert "range of speeds" in text
    for wrong in ([], [[1.0]], -3, "nothing"):
        with pytest.raises(yd.ProblemError, match="wavelength"):
            yd.frequency_response(yd.table1(), wrong)

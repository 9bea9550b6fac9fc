"""What the signals of a vehicle are in words: of every vehicle, from what its parts are called."""

import pytest

import yawdesign as yd
from yawdesign.exports.equations_of_motion import equations_of_motion
from yawdesign.exports.fmu.variables import signal_meanings
from yawdesign.vehicle.elements import Link, Mass, Maxwell, Pair, Spring, physical
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Model


@pytest.mark.parametrize("kind", ["power", "trailer"])
@pytest.mark.parametrize("changes", [{}, {"C_s": 0.0}, {"C_t": 0.0}], ids=str)
def test_every_signal_has_a_meaning(kind, changes):
    motion = equations_of_motion(Model(kind).at(yd.table1(kind).bogie.parameters(), v=80.0).replace(**changes))
    system = motion.vehicle.state_space
    meanings = signal_meanings(system)
    assert {*system.inputs, *system.states, *motion.outputs} <= set(meanings)
    assert len(set(meanings.values())) == len(meanings)


def test_another_vehicle_brings_its_own_words():
    wheelset = (
        Mass("y_w", 2.0, body="wheelset"),
        Link((Spring(3.0), Maxwell(5.0, 7.0)), {"y_b": 1, "y_w": -1}, name="primary damper"),
    )
    frame = Mass("y_b", 11.0, body="bogie frame")
    meanings = signal_meanings(StateSpace(physical([frame, Pair(wheelset, own=frozenset({"y_w"}))])))
    assert meanings["y_b_velocity"] == "rate of the lateral displacement of the bogie frame"
    assert meanings["y_w2_acceleration"] == "lateral acceleration of the rear wheelset"
    assert meanings["primary_damper_stroke_1"] == (
        "stroke of the dashpot of the front primary damper, without its joints"
    )
    assert meanings["primary_damper_force_2"] == "force of the rear primary damper"

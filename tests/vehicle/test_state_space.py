"""The one state space of a vehicle: its roots, its motions, its outputs and the units of everything in it."""

from fractions import Fraction

import flint
import numpy as np
import pytest

from yawdesign.problem.parameters import PARAMETERS
from yawdesign.problem.units import parse_unit
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.elements import (
    Dashpot,
    Link,
    Mass,
    Maxwell,
    Pair,
    Point,
    Spring,
    WheelRailContact,
    folded,
    physical,
)
from yawdesign.vehicle.polynomials import evaluate, trim
from yawdesign.vehicle.signals import acceleration, velocity
from yawdesign.vehicle.state_space import StateSpace, fill
from yawdesign.vehicle.vehicle import Model


def characteristic(entries, places):
    """Return the characteristic polynomial of the rows and columns at some places, the highest coefficient 1."""
    at = {place: k for k, place in enumerate(places)}
    rows = [[flint.fmpq(0)] * len(at) for _ in at]
    for (i, j), x in entries.items():
        if i in at and j in at:
            rows[at[i]][at[j]] = flint.fmpq(x)
    return flint.fmpq_mat(rows).charpoly()


def monic(polynomial):
    p = trim(polynomial)
    return flint.fmpq_poly([x / p[-1] for x in p])


@pytest.fixture
def bogies(vehicle_model, table1, random_vehicles, rational_vehicle):
    """Return vehicles of one model, with a yaw damper, in exact rationals."""
    drawn = [vehicle.p for vehicle in random_vehicles(2, spread=10, seed=17)]
    return [rational_vehicle(vehicle_model.at(p, C_s=3e5)) for p in (table1, *drawn)]


def test_the_roots_are_those_of_the_motions_together(bogies):
    for vehicle in bogies:
        expected = monic(vehicle.polynomial)
        for system in (vehicle.state_space, vehicle.folded_state_space):
            assert characteristic(system.A, range(system.size)) == expected


def test_the_states_of_the_motions(bogies):
    for vehicle in bogies:
        system = vehicle.folded_state_space
        states = [system.states_of(motion.coordinates) for motion in vehicle.motions]
        assert sorted(k for places in states for k in places) == list(range(system.size))
        for motion, places in zip(vehicle.motions, states, strict=True):
            assert characteristic(system.A, places) == monic(motion.polynomial(vehicle.C_s))


def test_the_states_of_a_motion_by_name(table1):
    vehicle = Model().at(table1, C_s=1e6)
    system, (coupled, motors) = vehicle.folded_state_space, vehicle.motions
    assert [system.states[k] for k in system.states_of(motors.coordinates)] == ["phi_m-", "phi_m-_velocity"]
    assert len(system.states_of(coupled.coordinates)) == 23
    assert "yaw_damper_stroke" in [system.states[k] for k in system.states_of(coupled.coordinates)]


def dense(system):
    n, m, k = system.size, len(system.inputs), len(system.outputs)
    A, B, C, D = system.A, system.B, system.C, system.D
    return [fill(x, np.zeros(shape)) for x, shape in ((A, (n, n)), (B, (n, m)), (C, (k, n)), (D, (k, m)))]


def transfer(system, s):
    """Return the outputs for a unit of each input."""
    A, B, C, D = dense(system)
    return C @ np.linalg.solve(s * np.eye(len(A)) - A, B) + D


def harmonic(elements, s):
    """Return displacements of all coordinates for a unit of each track input, from the polynomial matrix."""
    entries = polynomial_matrix(elements)
    rows = list(dict.fromkeys(i for i, _ in entries))
    matrix = np.zeros((len(rows), len(rows)), dtype=complex)
    for (i, j), p in entries.items():
        matrix[rows.index(i), rows.index(j)] = evaluate(p, s)
    contacts = [e for e in elements if isinstance(e, WheelRailContact)]
    inputs = [name for e in contacts for name in (e.alignment, e.cross_level)]
    force = np.zeros((len(rows), len(inputs)))
    for contact in contacts:
        for (row, name), value in contact.inputs().items():
            force[rows.index(row), inputs.index(name)] += value
    return dict(zip(rows, np.linalg.solve(matrix, force), strict=True)), inputs


def expected_outputs(elements, s):
    """Return every output for a unit of each input: masses, wheels and dampers one by one."""
    x, inputs = harmonic(elements, s)
    out = {}
    for e in elements:
        if isinstance(e, Mass):
            out[e.coordinate] = x[e.coordinate]
            out[velocity(e.coordinate)] = s * x[e.coordinate]
            out[acceleration(e.coordinate)] = s * s * x[e.coordinate]
        elif isinstance(e, WheelRailContact):
            unit = {name: np.eye(len(inputs))[k] for k, name in enumerate(inputs)}
            gravity = e.W * e.conicity / e.b * (x[e.y] - unit[e.alignment])
            creep = 2 * e.f_11 * (s * x[e.y] / e.v - x[e.phi])
            out[f"lateral_force_{e.y[3:]}"] = e.W * unit[e.cross_level] - gravity - creep
        elif e.maxwell:
            (law,) = e.maxwell
            u = sum(g * x[y] for y, g in e.displacement.items())
            pull = law.K * law.c * s / (law.K + law.c * s) * u
            *words, end = e.name.split() if e.name[-1] in "12+-" else (*e.name.split(), "")
            name = "_".join([*words, "{}", *([end] if end else [])])
            out[name.format("force")] = pull / e.pieces
            out[name.format("stroke")] = u - pull / law.K
            if e.pieces > 1:
                out[name.format("pair_force")] = pull
                out[name.format("displacement")] = u
    return out


def test_outputs_of_a_harmonic_motion(table1, vehicle_model, random_vehicles):
    rng = np.random.default_rng(5)
    for p in (table1, *(vehicle.p for vehicle in random_vehicles(5, seed=5))):
        vehicle = vehicle_model.at(p, C_s=10 ** rng.uniform(4, 7))
        s = complex(0.1 * rng.normal(), 2 * np.pi * 10 ** rng.uniform(-1, 1.5))
        for elements, system in (
            (vehicle.physical, vehicle.state_space),
            (vehicle.folded, vehicle.folded_state_space),
        ):
            found, expected = transfer(system, s), expected_outputs(elements, s)
            assert set(system.outputs) == set(expected)
            assert system.inputs == tuple(harmonic(elements, s)[1])
            for name, row in zip(system.outputs, found, strict=True):
                assert row == pytest.approx(expected[name], rel=1e-7, abs=1e-9 * np.abs(expected[name]).max()), name


def test_outputs_of_a_pair_that_holds_pairs(two_bogies):
    s = 0.3 + 2j
    for elements in (physical(two_bogies(10, float)), folded(two_bogies(10, float))):
        system = StateSpace(elements)
        found, expected = transfer(system, s), expected_outputs(elements, s)
        assert set(system.outputs) == set(expected)
        for name, row in zip(system.outputs, found, strict=True):
            assert row == pytest.approx(expected[name], rel=1e-9, abs=1e-12), name


def test_accelerations_are_the_rates_of_the_velocities(bogies):
    for vehicle in bogies:
        system = vehicle.state_space
        C, D = system.rows_of([acceleration(x) for x in system.coordinates])
        n = len(system.coordinates)
        assert {(i - n, j): x for (i, j), x in system.A.items() if n <= i < 2 * n} == C
        assert {(i - n, j): x for (i, j), x in system.B.items()} == D


def test_rows_of_some_outputs_are_rows_of_all(table1):
    system = Model().at(table1, C_s=1e6).state_space
    chosen = ["yaw_damper_force", "y_b_acceleration", "lateral_force_2", "y_b"]
    rows = [system.outputs.index(name) for name in chosen]
    for some, every in zip(system.rows_of(chosen), (system.C, system.D), strict=True):
        assert some == {(rows.index(i), j): x for (i, j), x in every.items() if i in rows}
    with pytest.raises(KeyError, match="no_such_output"):
        system.rows_of(["no_such_output"])


def test_names_are_there_once_and_old_ones_are_found(table1, vehicle_model):
    system = vehicle_model.at(table1, C_s=1e6).state_space
    for names in (system.states, system.inputs, system.outputs):
        assert len(set(names)) == len(names)
    assert set(system.states) <= set(system.outputs)
    assert system.states[: len(system.coordinates)] == system.coordinates
    assert system.states.index("v_y_b") == system.states.index("y_b_velocity")
    assert system.outputs.index("F_s") == system.outputs.index("yaw_damper_pair_force")
    assert system.inputs == ("alignment_1", "cross_level_1", "alignment_2", "cross_level_2")


SCALES = (Fraction(7), Fraction(11, 3), Fraction(5, 2))  # of kg, m and s


def size(unit):
    """Return how large a unit of the scaled system is."""
    powers = parse_unit(unit).dimension
    found = Fraction(1)
    for scale, power in zip(SCALES, powers, strict=True):
        found *= scale**power
    return flint.fmpq(found.numerator, found.denominator)


def test_units(bogies):
    """In other units of mass, length and time every number changes as its unit says, exactly."""
    units = {**{name: row.unit for name, row in PARAMETERS.items()}, "v": "m/s"}
    for vehicle in bogies:
        one = vehicle.state_space
        other = vehicle.model.at({name: x * size(units[name]) for name, x in vehicle.p.items()}).state_space
        states, inputs, outputs = (
            [size(unit) for unit in every] for every in (one.state_units, one.input_units, one.output_units)
        )
        rates = [size(f"{unit}/s") for unit in one.state_units]
        for a, b, rows, columns in (
            (one.A, other.A, rates, states),
            (one.B, other.B, rates, inputs),
            (one.C, other.C, outputs, states),
            (one.D, other.D, outputs, inputs),
        ):
            assert a.keys() == b.keys()
            assert all(b[i, j] == x * rows[i] / columns[j] for (i, j), x in a.items())


def test_units_by_name(table1, vehicle_model):
    system = vehicle_model.at(table1, C_s=1e6).state_space
    units = dict(zip(system.states, system.state_units, strict=True))
    assert (units["y_b"], units["phi_b"]) == ("m", "rad")
    assert (units["y_w1_velocity"], units["phi_w1_velocity"]) == ("m/s", "rad/s")
    assert units["yaw_damper_stroke"] == "m"
    assert dict(zip(system.inputs, system.input_units, strict=True)) == {
        "alignment_1": "m", "cross_level_1": "rad", "alignment_2": "m", "cross_level_2": "rad",
    }  # fmt: skip
    outputs = dict(zip(system.outputs, system.output_units, strict=True))
    assert all(outputs[name] == system.unit_of(name) for name in system.outputs)
    assert (outputs["y_b_acceleration"], outputs["phi_b_acceleration"]) == ("m/s^2", "rad/s^2")
    assert {outputs[name] for name in outputs if "force" in name} == {"N"}
    assert {outputs[name] for name in outputs if "stroke" in name or "displacement" in name} == {"m"}


def test_a_damper_in_series_without_a_name_is_refused():
    damper = Link((Maxwell(3.0, 2.0),), {"x": 1, "y": -1})
    ends = Pair((Mass("w", 1.0), Link((Maxwell(3.0, 2.0),), {"x": 1, "w": -1})), own=frozenset({"w"}))
    for elements, where in (([damper], "x, y"), (physical([ends]), "x, w1"), (folded([ends]), "x, w[+]")):
        system = StateSpace([Mass("x", 1.0), Mass("y", 2.0), *elements])
        for what in ("states", "outputs", "C", "D"):
            with pytest.raises(ValueError, match=f"no name, at {where}"):
                getattr(system, what)


def test_what_needs_no_name_has_none():
    system = StateSpace([Mass("x", 1.0), Link((Spring(2.0), Dashpot(3.0)), {"x": 1})])
    assert (system.states, system.outputs) == (("x", "x_velocity"), ("x", "x_velocity", "x_acceleration"))
    assert (system.inputs, system.B, system.D) == ((), {}, {})


@pytest.mark.parametrize("law", [Maxwell(3.0, 0), Maxwell(3.0, 0.0), Maxwell(np.inf, 0.0), Dashpot(0.0)])
def test_a_damper_without_damping_has_no_outputs(law):
    system = StateSpace([Mass("x", 1.0), Link((law,), {"x": 1}, name="damper")])
    assert system.states == ("x", "x_velocity")
    assert not any("damper" in name for name in system.outputs)
    assert system.A.get((1, 1), 0) == 0
    # Whoever asks for the force of a damper that is not there gets it.
    assert system.rows_of(["damper_force"]) == ({}, {})
    assert system.unit_of("damper_force") == "N"


@pytest.mark.parametrize("law", [Maxwell(np.inf, 2.0), Dashpot(2.0)])
@pytest.mark.parametrize("pieces", [1, 2])
def test_a_rigid_damper_has_a_force_and_no_stroke(law, pieces):
    system = StateSpace([Mass("x", 4.0), Link((Spring(3.0), law), {"x": 0.5}, name="damper 1", pieces=pieces)])
    assert system.states == ("x", "x_velocity")
    assert system.A[1, 1] == -2.0 * 0.5**2 / 4.0
    expected = {"damper_force_1": {1: 2.0 * 0.5 / pieces}}
    expected |= {"damper_pair_force_1": {1: 1.0}, "damper_displacement_1": {0: 0.5}} if pieces == 2 else {}
    assert {name: {j: x for (_, j), x in system.rows_of([name])[0].items()} for name in system.outputs[3:]} == expected


def test_points_of_a_body():
    body = [
        Mass("y", 2.0),
        Mass("psi", 3.0, unit="rad"),
        Link((Spring(6.0),), {"psi": 1}),
        Link((Spring(8.0),), {"y": 1}),
    ]
    point = Pair((Point("y", {"y": 1}, lever={"psi": 5.0}),))
    system = StateSpace([*body, *physical([point])])
    assert system.outputs[:4] == ("y", "psi", "y1", "y2")
    C, D = system.rows_of(["y1", "y2_velocity", "y1_acceleration", "y2_acceleration"])
    assert C == {
        (0, 0): 1,
        (0, 1): 5.0,
        (1, 2): 1,
        (1, 3): -5.0,
        (2, 0): -4.0,
        (2, 1): -10.0,
        (3, 0): -4.0,
        (3, 1): 10.0,
    }
    assert (D, system.unit_of("y2_acceleration")) == ({}, "m/s^2")
    halves = StateSpace([*body, *folded([point])])
    C, _ = halves.rows_of(["y+", "y-"])
    assert C == {(0, 0): 1, (1, 1): 5.0}


def test_fill_writes_stacks():
    filled = fill({(0, 1): np.array([1.0, 2.0]), (1, 0): 3.0}, np.zeros((2, 2, 2)))
    assert filled.tolist() == [[[0, 1], [3, 0]], [[0, 2], [3, 0]]]
    converted = fill({(0, 0): Fraction(1, 2)}, np.zeros((1, 1)), float)
    assert converted.tolist() == [[0.5]]

"""The FMU in FMPy: it moves as the matrix exponential says, with every parameter and with parameters that change."""

import itertools
import runpy
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import yawdesign as yd
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.vehicle.vehicle import Model

Unit = runpy.run_path(str(Path(__file__).with_name("fmu_unit.py")))["Unit"]
TOLERANCE = 1e-6  # of the largest value; CVode is asked for 1e-9 in every step
INPUTS = ("alignment_1", "cross_level_1", "alignment_2", "cross_level_2")
TABLE_1 = yd.table1()
MOTORS = ("M_m", "J_m", "K_m", "K_mphi", "K_dm", "C_mphi", "C_m", "a_0")
TRAILER = yd.Problem(
    bogie=yd.Bogie(
        kind="trailer",
        **{
            {"lambda": "lambda_"}.get(key, key): value
            for key, value in TABLE_1.bogie.parameters().items()
            if key not in MOTORS
        },
    ),
    speed="250 km/h",
)
PROBLEMS = {
    "power reciprocal": TABLE_1,
    "power as-printed": yd.table1(equations="as-printed"),
    "trailer": TRAILER,
}


@pytest.fixture(scope="module", params=PROBLEMS)
def written(request, tmp_path_factory):
    """A problem and its FMU."""
    problem = PROBLEMS[request.param]
    path = tmp_path_factory.mktemp("fmu") / "bogie.fmu"
    assert yd.write_fmu(problem, path).platform
    return problem, str(path)


@pytest.fixture(scope="module")
def table1_fmu(tmp_path_factory):
    path = tmp_path_factory.mktemp("fmu") / "bogie.fmu"
    yd.write_fmu(TABLE_1, path)
    return str(path)


@pytest.fixture
def opened(request, tmp_path):
    """Return a function that opens an FMU."""
    count = itertools.count()

    def open_it(path, **values):
        unit = Unit(path, tmp_path / f"instance {next(count)}")
        request.addfinalizer(unit.fmu.freeInstance)
        unit.set(values)
        return unit

    return open_it


def matrices(problem, **changes):
    """Return A and B with NumPy; B as the track enters the contact's equations, written out."""
    p = {**problem.bogie.parameters(), "v": max(problem.speeds), **changes}
    vehicle = Model.of(problem).at(p)
    A, names = state_matrix(vehicle), vehicle.state_space.coordinates
    B = np.zeros((len(A), 4))
    for end in (0, 1):
        y, phi = (len(names) + names.index(f"{x}_w{end + 1}") for x in ("y", "phi"))
        B[y, 2 * end] = p["W"] * p["lambda"] / p["b"] / p["M_w"]
        B[y, 2 * end + 1] = p["W"] / p["M_w"]
        B[phi, 2 * end] = 2 * p["f_22"] * p["b"] * p["lambda"] / p["r"] / p["J_w"]
    return A, B, names


def exact(A, x0, times):
    """Return x(t) of x' = A x at equally spaced times."""
    step = expm(A * (times[1] - times[0]))
    motion = [x0]
    for _ in times[1:]:
        motion.append(step @ motion[-1])
    return np.array(motion)


def driven(A, b, omega, times):
    """Return x(t) of x' = A x + b sin(omega t) from rest: the sine's own oscillator is part of the system."""
    n = len(A)
    whole = np.zeros((n + 2, n + 2))
    whole[:n, :n], whole[:n, n] = A, b
    whole[n, n + 1], whole[n + 1, n] = omega, -omega
    return exact(whole, np.eye(n + 2)[n + 1], times)[:, :n]


def simulated(path, names, **options):
    result = fmpy.simulate_fmu(path, output_interval=0.01, relative_tolerance=1e-9, **options)
    return result["time"], np.column_stack([result[name] for name in names])


def assert_close(found, wanted, tolerance=TOLERANCE):
    assert np.abs(found - wanted).max(axis=0) == pytest.approx(0, abs=tolerance * np.abs(wanted).max())
    assert np.abs(wanted).max() > 0


def test_free_motion(written):
    problem, path = written
    A, _, names = matrices(problem)
    x0 = np.zeros(len(A))
    x0[names.index("y_w1")], x0[names.index("phi_b")], x0[len(names)] = 3e-3, -1e-3, 0.02
    start = {"y_w1": 3e-3, "phi_b": -1e-3, "y_b_velocity": 0.02}
    times, found = simulated(path, names, stop_time=2.0, start_values=start)
    assert_close(found, exact(A, x0, times)[:, : len(names)])


def test_motion_on_a_sine_of_the_track(written, opened):
    """Alignment and cross-level at both wheelsets in one, with an integrator that asks for the input at every time."""
    problem, path = written
    A, B, _ = matrices(problem)
    omega, c, unit = 25.0, np.array([3e-3, 1e-3, -2e-3, 4e-3]), opened(path)

    def rate(t, x):
        unit.set(dict(zip(INPUTS, c * np.sin(omega * t), strict=True)))
        return unit.derivatives(x, t)

    times = np.arange(0, 0.5, 0.01)
    x0 = np.zeros(len(A))
    motion = solve_ivp(rate, (0, 0.5), x0, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-12)
    assert_close(motion.y.T, driven(A, B @ c, omega, times), 1e-6)


def test_motion_on_a_sine_in_fmpy(written):
    """FMPy holds an input until the next output: half an interval ahead is right to second order."""
    problem, path = written
    A, B, names = matrices(problem)
    omega, interval, t = 25.0, 1e-3, np.arange(0, 1.0005, 5e-4)
    signal = np.zeros(len(t), dtype=[("time", float), *((name, float) for name in INPUTS)])
    signal["time"], signal["alignment_1"] = t, 5e-3 * np.sin(omega * (t + interval / 2))
    result = fmpy.simulate_fmu(path, stop_time=1.0, input=signal, output_interval=interval, relative_tolerance=1e-7)
    found = np.column_stack([result[name] for name in names])
    assert_close(found, driven(A, B[:, 0] * 5e-3, omega, result["time"])[:, : len(names)], 3e-3)


def test_derivatives_are_those_of_the_matrices(written, opened):
    problem, path = written
    A, B, _ = matrices(problem)
    unit, rng = opened(path), np.random.default_rng(3)
    for _ in range(5):
        assert_derivatives(unit, A, B, rng.normal(size=len(A)), rng.normal(size=4))


def assert_derivatives(unit, A, B, x, u):
    unit.set(dict(zip(INPUTS, u, strict=True)))
    error = unit.derivatives(x) - A @ x - B @ u
    assert np.all(np.abs(error) <= 1e-12 * (np.abs(A) @ np.abs(x) + np.abs(B) @ np.abs(u)))


def test_every_parameter_acts_as_in_a_bogie_that_has_that_value(written, opened):
    problem, path = written
    unit, rng = opened(path), np.random.default_rng(4)
    x, u = rng.normal(size=len(unit.states)), rng.normal(size=4)
    unit.set(dict(zip(INPUTS, u, strict=True)))
    base = unit.derivatives(x)
    for name, value in {**problem.bogie.parameters(), "v": max(problem.speeds)}.items():
        unit.set({name: 1.37 * value})
        A, B, _ = matrices(problem, **{name: 1.37 * value})
        assert_derivatives(unit, A, B, x, u)
        assert np.any(unit.derivatives(x) != base), f"{name} does nothing"
        unit.set({name: float(value)})
    assert np.array_equal(unit.derivatives(x), base)


def test_a_parameter_changed_on_the_way_acts_at_once(table1_fmu, opened, tmp_path):
    """At 1 s C_s and lambda change: from there on the motion is that of an FMU built with these values."""
    changes = {"C_s": 5e4, "lambda": 0.3}
    signal = np.zeros(4, dtype=[("time", float), *((name, float) for name in changes)])
    signal["time"] = [0, 1, 1, 3]
    for name, value in changes.items():
        signal[name] = [TABLE_1.bogie.parameters()[name]] * 2 + [value] * 2
    A, _, names = matrices(TABLE_1)
    states = opened(table1_fmu).states
    start = {"y_w1": 3e-3}
    times, found = simulated(table1_fmu, states, stop_time=2.0, start_values=start, input=signal, output=states)
    before = times < 1 - 1e-9
    x0 = np.zeros(len(A))
    x0[names.index("y_w1")] = 3e-3
    assert_close(found[before], exact(A, x0, times[before]))
    other = tmp_path / "other.fmu"
    yd.write_fmu(TABLE_1.replace(**changes), other)
    at_change = np.flatnonzero(np.isclose(times, 1.0))
    start = dict(zip(states, found[at_change[-1]], strict=True))
    _, continued = simulated(str(other), states, stop_time=1.0, start_values=start, output=states)
    assert_close(found[at_change[-1] :], continued)


def test_force_and_stroke_of_the_yaw_damper(table1_fmu, opened):
    p = TABLE_1.bogie.parameters()
    unit = opened(table1_fmu, phi_b=2e-3, yaw_damper_stroke=5e-4)
    stroke, force, each = unit.get("yaw_damper_displacement", "yaw_damper_pair_force", "yaw_damper_force")
    assert unit.get("u_s", "F_s", "z_1") == [stroke, force, 5e-4]
    assert each == force / 2
    assert stroke == pytest.approx(p["b_3"] * 2e-3, rel=1e-15)
    assert force == pytest.approx(p["K_ds"] * (p["b_3"] * 2e-3 - 5e-4), rel=1e-14)
    # In the equation of the frame's yaw the force acts at b_3, and nothing else knows the dashpot.
    (before,) = unit.get("der(phi_b_velocity)")
    unit.set({"yaw_damper_stroke": 0.0})
    after, more, acceleration = unit.get("der(phi_b_velocity)", "yaw_damper_pair_force", "phi_b_acceleration")
    assert acceleration == after
    assert more - force == pytest.approx(p["K_ds"] * 5e-4, rel=1e-12)
    assert after - before == pytest.approx(-p["b_3"] * (more - force) / p["J_b"], rel=1e-12)


@pytest.mark.parametrize("start", [{"start": "offset"}, {"start": "offset", "offset": {"y_b": 4e-3, "phi_b": 2e-3}}])
def test_a_run_and_the_fmu_started_alike_move_alike(written, start):
    """States have one name: what a run starts with starts the FMU, and all that both give has the same numbers."""
    problem, path = written
    run = yd.simulate(problem, "smooth", speed=max(problem.speeds), duration="2 s", step="1 ms", **start).histories[0]
    states = yd.state_space(problem.replace(speed=max(problem.speeds))).states
    outputs = {v.name for v in fmpy.read_model_description(str(path)).modelVariables if v.causality == "output"}
    names = sorted({*outputs, *states} & set(run.values))
    assert {"y_b_acceleration", "yaw_damper_force", "yaw_damper_pair_force", "lateral_damper_stroke_2"} <= set(names)
    given = {name: run[name][0] for name in states}
    times, found = simulated(path, names, stop_time=2.0, start_values=given, output=names)
    at = [int(np.argmin(np.abs(run.time - t))) for t in times]
    assert run.time[at] == pytest.approx(times, abs=1e-9)
    for k, name in enumerate(names):
        assert np.abs(found[:, k] - run[name][at]).max() <= 1e-5 * np.abs(run[name]).max(), name


def test_strokes_of_dampers_at_rest_are_their_displacements(written):
    problem, _ = written
    p, offset = problem.bogie.parameters(), {"y_b": 4e-3, "phi_b": 2e-3, "y_w1": 1e-3}
    run = yd.simulate(problem, "smooth", start="offset", offset=offset, duration="1 s").histories[0]
    front, rear = 4e-3 + p["b_0"] * 2e-3, 4e-3 - p["b_0"] * 2e-3
    strokes = ("yaw_damper_stroke", "lateral_damper_stroke_1", "lateral_damper_stroke_2")
    assert [run[name][0] for name in strokes] == pytest.approx([p["b_3"] * 2e-3, front, rear])
    assert run["yaw_damper_pair_force"][0] == pytest.approx(0, abs=1e-6)
    if problem.bogie.kind == "power":
        expected = [4e-3 + p["a_0"] * 2e-3, 4e-3 - p["a_0"] * 2e-3]
        assert [run[f"motor_damper_stroke_{k}"][0] for k in (1, 2)] == pytest.approx(expected)


def test_a_damper_without_damping_is_left_out(tmp_path):
    problem = TABLE_1.replace(C_s=0, C_t=0)
    path = tmp_path / "bogie.fmu"
    yd.write_fmu(problem, path)
    A, _, names = matrices(problem)
    assert len(A) == 22
    variables = {v.name: v.description for v in fmpy.read_model_description(str(path)).modelVariables}
    assert not {"C_s", "C_t", "z_3", "yaw_damper_stroke", "lateral_damper_stroke_1"} & set(variables)
    assert "front motor damper" in variables["motor_damper_stroke_1"]
    assert variables["z_2"] == "another name of motor_damper_stroke_2"
    times, found = simulated(str(path), [*names, "yaw_damper_pair_force"], stop_time=0.5, start_values={"y_w1": 1e-3})
    assert_close(found[:, :-1], exact(A, np.eye(22)[names.index("y_w1")] * 1e-3, times)[:, : len(names)])
    assert not found[:, -1].any()
    assert variables["yaw_damper_displacement"] == "displacement of each yaw damper with its joints"


def test_a_state_can_be_kept_and_taken_up_again(table1_fmu, opened):
    unit = opened(table1_fmu, y_b=1e-3, C_s=2e5)
    names = ("y_b", "C_s", "der(y_b_velocity)", "yaw_damper_pair_force")
    before = unit.get(*names)
    kept = unit.fmu.getFMUState()
    as_bytes = unit.fmu.serializeFMUState(kept)
    unit.fmu.reset()
    assert unit.get("y_b", "C_s") == [0.0, 1e6]
    unit.fmu.setFMUState(kept)
    assert unit.get(*names) == before
    unit.fmu.freeFMUState(kept)
    unit.fmu.reset()
    unit.fmu.setFMUState(unit.fmu.deserializeFMUState(as_bytes))
    assert unit.get(*names) == before


def test_two_bogies_in_one_process(table1_fmu, opened, tmp_path):
    path = tmp_path / "trailer.fmu"
    yd.write_fmu(TRAILER, path)
    units = [opened(table1_fmu), opened(str(path)), opened(table1_fmu, C_s=5e4)]
    rng = np.random.default_rng(6)
    for unit, (problem, changes) in zip(units, [(TABLE_1, {}), (TRAILER, {}), (TABLE_1, {"C_s": 5e4})], strict=True):
        A, B, _ = matrices(problem, **changes)
        assert_derivatives(unit, A, B, rng.normal(size=len(A)), rng.normal(size=4))


def test_directional_derivatives_are_exact(written, opened):
    problem, path = written
    A, B, _ = matrices(problem)
    unit = opened(path)
    unknowns = [unit.references[f"der({name})"] for name in unit.states]
    knowns = [unit.references[name] for name in (*unit.states, *INPUTS)]
    jacobian = [unit.fmu.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns]
    np.testing.assert_allclose(np.transpose(jacobian), np.hstack([A, B]), rtol=1e-12)
    # An output that is a state follows that state.
    y_b = unit.references["y_b"]
    assert unit.fmu.getDirectionalDerivative([y_b], [y_b], [2.0]) == [2.0]


@pytest.mark.parametrize("name", ["lambda", "v", "C_s", "K_m"])
def test_directional_derivative_to_a_parameter(table1_fmu, opened, name):
    x, h, unit = np.random.default_rng(5).normal(size=25), 1e-5, opened(table1_fmu)
    unit.derivatives(x)
    value = {**TABLE_1.bogie.parameters(), "v": TABLE_1.speed}[name]
    up, down = (matrices(TABLE_1, **{name: value * (1 + sign * h)})[0] @ x for sign in (1, -1))
    unknowns = [unit.references[f"der({state})"] for state in unit.states]
    found = np.array(unit.fmu.getDirectionalDerivative(unknowns, [unit.references[name]], [value]))
    assert found == pytest.approx((up - down) / (2 * h), rel=1e-6, abs=1e-6 * np.abs(found).max())


@pytest.mark.parametrize(
    ("name", "value"),
    [("C_s", 0.0), ("v", -1.0), ("M_b", 0.0), ("lambda", float("nan")), ("K_m", float("inf")), ("y_b", float("nan"))],
)
def test_values_without_a_meaning_are_refused(table1_fmu, opened, name, value):
    unit = opened(table1_fmu)
    before = unit.get(name, "W")
    with pytest.raises(FMICallException, match="error"):
        unit.set({"W": 1.0, name: value})
    assert unit.get(name, "W") == before


def test_calculated_variables_cannot_be_set(table1_fmu, opened):
    unit = opened(table1_fmu)
    for name in ("yaw_damper_pair_force", "der(y_b)", "time"):
        with pytest.raises(FMICallException, match="error"):
            unit.set({name: 1.0})
    with pytest.raises(FMICallException, match="error"):
        unit.fmu.getFloat64([10_000])

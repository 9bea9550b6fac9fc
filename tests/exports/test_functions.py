"""Functions for other codes: each equals the route in Python, whatever is baked in, and failures can be seen."""

import json
import math
import sys
from functools import cache

import casadi as ca
import numpy as np
import pytest

import yawdesign as yd
from yawdesign.damper.curving import curving_limit, resisting_moment, rotational_resistance
from yawdesign.exports.functions import c_source, functions, self_test
from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.exports.symbolic_function import SymbolicFunction
from yawdesign.hunting import boundary
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import damping_ratio, decay_rate, motion_eigenvalues, state_matrix
from yawdesign.hunting.hurwitz import hurwitz_minors
from yawdesign.hunting.routh import routh_column, sector_column
from yawdesign.vehicle.polynomials import scale_variable, shift
from yawdesign.vehicle.vehicle import Model, Vehicle

NAMES = (
    "state_matrix", "characteristic_polynomial", "routh_column", "hurwitz_minors", "critical_damping",
    "critical_equations", "rotational_resistance", "stability_margin", "margin_equations", "dynamic_stiffness",
)  # fmt: skip
MOTOR_KEYS = {key for key, row in yd.PARAMETERS.items() if row.motor}
TRAILER = Model("trailer")
MODELS = (Model("power", "as-printed"), Model("power"), TRAILER)


@pytest.fixture(params=MODELS, ids=lambda model: f"{model.kind} {model.equations}")
def which(request):
    return request.param


def problem_of(vehicle):
    given = {("lambda_" if k == "lambda" else k): x for k, x in vehicle.p.items() if k in vehicle.model.parameters}
    v, model = given.pop("v"), vehicle.model
    bogie = yd.Bogie(kind=model.kind, **given)
    return yd.Problem(bogie=bogie, speed=v, equations=model.equations, curve=yd.table1().curve)


def coupled_polynomial(vehicle):
    """Return the coupled motion's polynomial in s / (100 rad/s)."""
    return scale_variable(vehicle.coupled.polynomial(vehicle.C_s), 100.0)


def evaluated(f, **values):
    """Return the outputs of a documented function with the problem's values, some of them changed."""
    inputs = {port.name: list(port.value) for port in f.inputs} | values
    found = f.function(**{name: ca.DM(x) for name, x in inputs.items()})
    return {name: np.array(x).squeeze() for name, x in found.items()}


@cache
def written(parameters, model):
    return functions(problem_of(model.at(dict(parameters)))).documented


@pytest.fixture(params=["table 1", "random"])
def setup(request, table1, which, random_bogies):
    """Return the vehicle and its functions: of Table I and of a random bogie, for each model."""
    if request.param == "random":
        table1 = next(p for p, _ in random_bogies(1, seed=31))
    p = {k: x for k, x in {**table1, "C_s": 8e5}.items() if which.kind == "power" or k not in MOTOR_KEYS}
    return which.at(p), written(tuple(p.items()), which)


def close(got, expected, rel=1e-12):
    return got == pytest.approx(np.asarray(expected, dtype=float), rel=rel, abs=rel * np.max(np.abs(expected)))


def test_state_matrix(setup):
    vehicle, f = setup
    got, system = evaluated(f["state_matrix"]), vehicle.state_space
    B = np.zeros((system.size, 4))
    for place, value in system.B.items():
        B[place] = value
    assert got["A"] == pytest.approx(state_matrix(vehicle), rel=1e-12)
    assert got["B"] == pytest.approx(B, rel=1e-12)
    assert len(got["A"]) == (25 if vehicle.model.kind == "power" else 15)
    assert got["C"].shape == (len(got["C"]), len(got["A"]))
    assert not got["D"].any()


def test_characteristic_polynomial(setup, rational):
    vehicle, f = setup
    got = evaluated(f["characteristic_polynomial"])
    assert got["core"] == pytest.approx(coupled_polynomial(vehicle), rel=1e-12)
    assert got["A"] + np.r_[0, got["B"][1:]][: len(got["A"])] * vehicle.C_s == pytest.approx(
        got["core"][: len(got["A"])]
    )
    exact = Vehicle(vehicle.model, {**rational(vehicle.p), "C_s": int(vehicle.C_s)})
    chi = exact.paper_coefficients()
    assert len(chi) == (27 if vehicle.model.kind == "power" else 17)
    assert got["chi_sign"].tolist() == [1.0 if x > 0 else -1.0 for x in chi]
    # Logarithms of integers of any size.
    expected = [(math.log(abs(int(x.p))) - math.log(int(x.q))) / math.log(10) for x in chi]
    assert got["chi_log10"] == pytest.approx(expected, rel=1e-12)


def test_routh_column_and_hurwitz_minors(setup):
    vehicle, f = setup
    expected = routh_column(coupled_polynomial(vehicle))
    assert evaluated(f["routh_column"])["column"] == pytest.approx(expected, rel=1e-12)
    signs, logarithms = hurwitz_minors(vehicle.paper_coefficients(100.0))
    got = evaluated(f["hurwitz_minors"])
    assert got["sign"].tolist() == signs
    assert got["log10"] == pytest.approx(logarithms, rel=1e-12)


def test_critical_damping(setup):
    vehicle, f = setup
    found = critical_damping(vehicle).critical
    if not found:
        assert not evaluated(f["critical_damping"])["residual"] < 1e-10
        return
    got = evaluated(f["critical_damping"])
    assert got["residual"] < 1e-13
    assert got["C_sl"] == pytest.approx(found[0].C_s, rel=1e-11)
    assert got["omega"] == pytest.approx(found[0].omega, rel=1e-11)
    p, names = vehicle.p, boundary.parameter_names(vehicle.p)
    reference = boundary.critical_damping(vehicle.model, names)([p[x] for x in names], found[0].C_s, found[0].omega)
    expected = dict(zip(names, np.array(reference[3]).ravel(), strict=True))
    inputs = [port.name for port in f["critical_damping"].inputs[:-2]]
    assert list(f["critical_damping"].outputs[3].rows) == inputs
    assert close(got["gradient"] * [p[x] for x in inputs], [expected[x] * p[x] for x in inputs], 1e-11)


def test_rotational_resistance(setup):
    vehicle, f = setup
    p, curve = vehicle.p, yd.table1().curve
    got = evaluated(f["rotational_resistance"])
    assert got["X"] == pytest.approx(rotational_resistance(p, vehicle.C_s, curve), rel=1e-12)
    assert got["T"] == pytest.approx(resisting_moment(p, vehicle.C_s, curve), rel=1e-12)
    assert got["C_su"] == pytest.approx(curving_limit(p, curve), rel=1e-12)
    assert evaluated(f["rotational_resistance"], limit=0.1)["C_su"] > got["C_su"]


def test_stability_margin(setup):
    vehicle, f = setup
    core = coupled_polynomial(vehicle)
    got = evaluated(f["stability_margin"], sigma=0.7, zeta=0.02)
    assert got["decay_column"] == pytest.approx(routh_column(shift(core, -0.007)), rel=1e-12)
    assert got["ratio_column"] == pytest.approx(sector_column(core, 0.02), rel=1e-11)
    s = motion_eigenvalues(vehicle, vehicle.coupled)
    for by in (-1e-3, 1e-3):
        got = evaluated(f["stability_margin"], sigma=decay_rate(s) + by, zeta=max(damping_ratio(s) + by, 0))
        assert np.all(got["decay_column"] > 0) == (by < 0)
        assert np.all(got["ratio_column"] > 0) == (by < 0 and damping_ratio(s) > 0)


def test_margin_equations(setup):
    vehicle, f = setup
    got = evaluated(f["margin_equations"], sigma=0.0, zeta=0.05)
    core = coupled_polynomial(vehicle)
    assert np.abs(got["residual"] / np.array(core[:-1]) * core[-1]).max() < 1e-9
    s = motion_eigenvalues(vehicle, vehicle.coupled) / 100
    oscillating = s[s.imag > 0]
    assert got["sector"][: len(oscillating)] == pytest.approx(4 * oscillating.real**2 - 0.01 * abs(oscillating) ** 2)
    moved = evaluated(f["margin_equations"], sigma=1.0)["residual"]
    assert moved[-1] == pytest.approx(-(len(core) - 1) * 0.01, rel=1e-6)


def test_dynamic_stiffness(setup):
    vehicle, f = setup
    Z = 1 / (1 / vehicle.p["K_ds"] + 1 / (vehicle.C_s * 20j))
    got = evaluated(f["dynamic_stiffness"], omega=20.0)
    assert complex(got["Z_re"], got["Z_im"]) == pytest.approx(Z, rel=1e-12)
    assert (got["K_dyn"], got["phase"]) == pytest.approx((abs(Z), np.angle(Z)), rel=1e-12)


def test_baked_parameters_give_the_same_numbers(which):
    task = problem_of(which.at(yd.table1().bogie.parameters(), v=300 / 3.6))
    free = functions(task).documented
    for inputs in ((), ("C_s", "K_ds", "v")):
        fixed = functions(task, inputs).documented
        assert tuple(fixed) == NAMES
        for name, f in fixed.items():
            assert {port.name for port in f.inputs} & set(yd.PARAMETERS) <= set(inputs)
            assert set(f.baked).isdisjoint(inputs)
            expected, got = self_test(free[name])["outputs"], self_test(f)["outputs"]
            for output in got:
                if output not in ("gradient", "residual"):
                    assert close(got[output], expected[output], 1e-11), (name, output)


def test_gradient_of_what_is_left_open():
    free = functions(yd.table1()).documented["critical_damping"]
    few = functions(yd.table1(), "lambda_, speed").documented["critical_damping"]
    everything = dict(zip(free.outputs[3].rows, evaluated(free)["gradient"], strict=True))
    assert few.outputs[3].rows == ("lambda", "v")
    assert evaluated(few)["gradient"] == pytest.approx([everything["lambda"], everything["v"]], rel=1e-11)


def test_a_damper_without_damping_that_is_known_not_to_be_there():
    task = yd.table1().replace(C_m=0.0)
    f = functions(task, inputs=("C_s",)).documented
    column = evaluated(f["routh_column"])["column"]
    vehicle = Model().at(task.bogie.parameters(), v=300 / 3.6, C_s=1e6)
    assert np.all(np.isfinite(column))
    assert np.all(column > 0) == bool(decay_rate(motion_eigenvalues(vehicle, vehicle.coupled)) > 0)
    assert evaluated(f["state_matrix"])["A"].shape == (23, 23)
    assert set(functions(task)) == set(NAMES)  # as an input it begins at next to nothing


STRAY = [(math.nan, 23.0), (1e300, 1e-300), (1e-5, 1e6), (-1.0, 20.0), (1e9, 1.0), (1e3, 200.0)]


@pytest.mark.parametrize(("C_s_start", "omega_start"), STRAY)
def test_a_start_that_leads_nowhere_shows_in_the_residual(C_s_start, omega_start):
    f = functions(yd.table1(), inputs=("v",)).documented["critical_damping"]
    assert not evaluated(f, C_s_start=C_s_start, omega_start=omega_start)["residual"] < 1e-10


def test_a_bogie_without_critical_damping_shows_in_the_residual():
    f = functions(yd.table1(equations="as-printed"), inputs=("v",)).documented["critical_damping"]
    assert not evaluated(f, v=250 / 3.6, C_s_start=9e4, omega_start=23.0)["residual"] < 1e-10
    assert self_test(functions(yd.table1().replace(speed="200 km/h")).documented["critical_damping"]) is None


def test_nested_derivatives():
    v = ca.MX.sym("v")
    f = functions(yd.table1(), inputs=("v",))["critical_damping"]
    slope = ca.Function("slope", [v], [ca.gradient(f(v, 6e4, 22.7)[0], v), f(v, 6e4, 22.7)[3]])
    implicit, given = map(float, slope(300 / 3.6))
    assert implicit == pytest.approx(given, rel=1e-9)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("method", ["newton", "kinsol"])
def test_only_fast_newton_becomes_c(method):
    model, names = Model(), ParametricModel.of(yd.table1(), None).names
    with pytest.raises(RuntimeError, match="cannot write C code"):
        c_source("bad", {"bad": boundary.rootfinder(model, names, method=method)})
    assert "#error" not in c_source("good", {"good": boundary.rootfinder(model, names, method="fast_newton")})


def test_mistakes_are_named():
    task = yd.table1()
    with pytest.raises(yd.ProblemError, match=r"K_1q.*did you mean K_1[xy].*\n.*bb") as error:
        functions(task, inputs=("K_1q", "bb", "C_s"))
    assert len(error.value.diagnostics) == 2
    with pytest.raises(yd.ProblemError, match=r"routh_colum.*did you mean routh_column"):
        functions(task, only=("routh_colum",))
    with pytest.raises(yd.ProblemError, match="there are state_matrix, "):
        functions(task, only=("zzz",))
    with pytest.raises(yd.ProblemError, match=r"C_m"):
        functions(problem_of(TRAILER.at(task.bogie.parameters(), v=80.0)), inputs=("C_m",))


def test_what_has_no_single_value_must_be_an_input():
    task = yd.table1().replace(C_s=None, speed=yd.SpeedRange(min=60, max=80))
    with pytest.raises(yd.ProblemError) as error:
        functions(task, inputs=("K_m",))
    assert [d.key for d in error.value.diagnostics] == ["v", "C_s"]
    assert tuple(functions(task, inputs=("C_s", "v"))) == NAMES
    assert functions(task).documented["routh_column"].inputs[-1].value == (1e6,)
    assert tuple(functions(task, inputs=("v",), only=("critical_damping",))) == ("critical_damping",)


def test_without_a_curve():
    task = yd.Problem(bogie=yd.table1().bogie, speed=80.0)
    assert "rotational_resistance" not in functions(task)
    with pytest.raises(yd.ProblemError, match="needs a curve"):
        functions(task, only="rotational_resistance")


def test_documentation():
    f = yd.functions(yd.table1())
    assert json.dumps(f.to_dict())
    assert "C_sl [N·s/m] critical damping" in repr(f)
    assert f["critical_damping"].name_in(27) == "lambda"
    for name, documented in f.documented.items():
        assert f[name].name_in() == [port.name for port in documented.inputs]
        assert f[name].name_out() == [port.name for port in documented.outputs]
        assert [f[name].size_out(k) for k in range(len(documented.outputs))] == [x.shape for x in documented.outputs]
        assert all(port.unit and port.meaning for port in (*documented.inputs, *documented.outputs))
    with pytest.raises(KeyError):
        _ = f["nothing"]


def test_a_function_says_what_is_missing():
    f = SymbolicFunction(ParametricModel.of(yd.table1().replace(C_s=None), free=()))
    with pytest.raises(yd.ProblemError, match="C_s: has no single value"):
        f.parameters(["C_s"])


def test_state_space(which):
    task = problem_of(which.at(yd.table1().bogie.parameters(), v=300 / 3.6))
    system = yd.state_space(task)
    found, wanted = np.linalg.eigvals(system.A), yd.stability(task).eigenvalues
    by_frequency = [np.array(sorted(values, key=lambda s: (s.imag, s.real))) for values in (found, wanted)]
    assert by_frequency[0] == pytest.approx(by_frequency[1], rel=1e-9)
    # Force over displacement of the yaw damper, whatever moves the bogie, is its dynamic stiffness.
    x = np.linalg.solve(20j * np.eye(len(system.A)) - system.A, system.B[:, 0])
    y = dict(zip(system.outputs, system.C @ x, strict=True))
    p = task.bogie
    assert y["yaw_damper_pair_force"] / y["yaw_damper_displacement"] == pytest.approx(
        1 / (1 / p.K_ds + 1 / (p.C_s * 20j)), rel=1e-9
    )
    assert y["yaw_damper_displacement"] == pytest.approx(p.b_3 * y["phi_b"], rel=1e-12)
    assert y["y_b_velocity"] == pytest.approx(20j * y["y_b"], rel=1e-9)
    assert len(system.state_units) == len(system.states) == len(system.A)
    assert "alignment_1 [m], cross_level_1 [rad]" in repr(system)


def test_old_names_of_states_and_outputs_are_found():
    model = yd.state_space(yd.table1())
    old = {"v_y_b": "y_b_velocity", "v_phi_m2": "phi_m2_velocity", "z_1": "yaw_damper_stroke"}
    old |= {"z_2": "lateral_damper_stroke_1", "z_5": "motor_damper_stroke_2"}
    for before, now in old.items():
        assert model.states[model.states.index(before)] == now
        assert before in model.states
    assert [model.outputs.index(name) for name in ("F_s", "u_s")] == [20, 21]
    assert "F_m" not in model.outputs
    A, _, C, _ = yd.functions(yd.table1()).documented["state_matrix"].outputs
    assert [A.rows.index(name) for name in old] == [model.states.index(name) for name in old]
    assert [C.rows.index(name) for name in ("F_s", "u_s")] == [20, 21]
    assert "v_y_b" in C.columns
    with pytest.raises(ValueError, match="not in tuple"):
        model.states.index("z_6")


def test_one_vocabulary_with_the_runs(which):
    """What the state space calls its states and outputs is what a run gives by these names."""
    problem = yd.table1(which.kind, equations=which.equations)
    space = yd.state_space(problem)
    history = yd.simulate(problem, duration="2 s").histories[0]
    x = np.stack([history[name] for name in space.states], axis=1)
    for k, (name, unit) in enumerate(zip(space.outputs, space.output_units, strict=True)):
        assert history[name] == pytest.approx(x @ space.C[k], rel=1e-9, abs=1e-9 * np.abs(history[name]).max())
        assert history.unit(name) == unit
    assert history["yaw_damper_pair_force"] == pytest.approx(2 * history["yaw_damper_force"])


def test_state_space_to_control():
    model = yd.state_space(yd.table1())
    system = model.to_control()
    assert system.input_labels == list(model.inputs)
    response = system(20j)
    expected = model.C @ np.linalg.solve(20j * np.eye(25) - model.A, model.B)
    assert response == pytest.approx(expected, rel=1e-9, abs=1e-12 * np.abs(expected).max())


def test_state_space_without_python_control(monkeypatch):
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(yd.ProblemError, match=r"pip install 'yawdesign\[control\]'"):
        yd.state_space(yd.table1()).to_control()


def test_state_space_without_damping():
    problem = yd.table1().replace(C_s=0.0)
    system, damped = yd.state_space(problem), yd.state_space(yd.table1())
    assert system.A.shape == (24, 24)
    assert (system.outputs, system.output_units) == (damped.outputs, damped.output_units)
    assert not system.C[system.outputs.index("F_s")].any()
    displacement = dict(zip(system.states, system.C[system.outputs.index("u_s")], strict=True))
    assert {name: x for name, x in displacement.items() if x} == {"phi_b": problem.bogie.b_3}
    with pytest.raises(yd.ProblemError, match="C_s"):
        yd.state_space(yd.table1().replace(C_s=None))


def test_critical_equations_vanish_at_the_critical_damping():
    documented = yd.functions(yd.table1(equations="as-printed")).documented
    f, g = (documented[name].function for name in ("critical_damping", "critical_equations"))
    values = [port.value for port in documented["critical_damping"].inputs]
    C_sl, omega = f.call(values)[:2]
    assert float(C_sl) == pytest.approx(90702.8897786979, rel=1e-9)
    assert g.name_in() == [*f.name_in()[:-2], "C_sl", "omega"]
    assert abs(g(*values[:-2], C_sl, omega).full()).max() < 1e-10
    assert abs(g(*values[:-2], 1.01 * C_sl, omega).full()).max() > 1e-7


def test_only_the_rootfinder_has_a_file_that_changes_its_form():
    """What else is exported is made of operations between numbers, which later versions of CasADi read."""
    for name, f in yd.functions(yd.table1()).items():
        assert f.is_a("SXFunction") == (name != "critical_damping")

"""What is asked of a package in which the bogie has end dampers: test_new_damper.py makes such a package."""

import json
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.hunting.eigenvalues import eigenvalues
from yawdesign.problem.parameters import CarBody
from yawdesign.problem.starter import starter
from yawdesign.vehicle.vehicle import Vehicle

OUTPUTS = {f"end_damper_{what}_{end}" for what in ("force", "stroke") for end in (1, 2)}
WORTH_60 = [20e3, 40e3, 60e3]


@pytest.fixture(scope="module")
def problem():
    return yd.loads(starter()).replace(C_s=1e6, lambda_=0.3)


@pytest.fixture(scope="module")
def vehicle(problem):
    (found,) = Vehicle.of(problem)
    return found


def same_roots(one, other, tolerance):
    one, other = np.asarray(one), np.asarray(other)
    apart = np.abs(one[:, None] - other[None, :]) / np.maximum(1, np.abs(other))
    assert len(one) == len(other)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < tolerance


def test_parameters(problem, vehicle):
    assert (yd.PARAMETERS["C_e"].si, yd.PARAMETERS["K_de"].si) == ("N·s/m", "N/m")
    assert (vehicle.p["C_e"], vehicle.p["K_de"]) == (60e3, 40e6)
    assert problem.replace(C_e="25 kN s/m").bogie.C_e == 25e3
    assert vehicle.model.joints["C_e"] == "K_de"
    assert {"C_e", "K_de"} <= vehicle.model.sources["coupled motion"]


@pytest.mark.parametrize(("kind", "size"), [("power", 27), ("trailer", 17)])
def test_stability(kind, size):
    found = yd.stability(yd.loads(starter(kind)).replace(C_s=1e6))
    assert found.checked
    assert len(found.eigenvalues) == size


def test_under_a_car_body(problem, vehicle):
    """A very heavy one stands still, twice; one that moves is moved by the dampers of both bogies."""
    body = {
        "M_c": 34500,
        "J_c": 1.521e6,
        "I_c": 124304,
        "l_c": 9.5,
        "h_s": 0.852,
        "h_t": 0.97,
        "K_2z": 6e5,
        "C_2z": 1e4,
    }
    heavy = CarBody(**body | dict.fromkeys(("M_c", "J_c", "I_c"), 1e15))
    moving, standing = (Vehicle.of(replace(problem, car_body=x))[0] for x in (CarBody(**body), heavy))
    s = eigenvalues(standing)
    alone = np.repeat(eigenvalues(vehicle), 2)
    assert len(s) == len(alone) + 6
    same_roots(s[np.abs(s) > 1e-3], alone, 1e-6)
    assert {"end_damper_stroke_11", "end_damper_stroke_22"} <= set(moving.state_space.states)
    count = len(moving.state_space.states)
    assert count == len(s)


def test_hardly_any_damping_is_no_damper(vehicle, vehicle_model):
    damped = vehicle_model.at(vehicle.p)
    none, little = eigenvalues(damped.replace(C_e=0.0)), eigenvalues(damped.replace(C_e=1.0))
    assert len(none) == (15 if vehicle_model.kind == "trailer" else 25)
    own = np.abs(little) > 1e6
    assert little[own] == pytest.approx([-vehicle.p["K_de"] / 2] * 2, rel=1e-4)
    same_roots(little[~own], none, 1e-3)


def test_a_damper_that_does_not_move_is_the_spring_of_its_joints(vehicle):
    firm = eigenvalues(vehicle.replace(C_e=1e12))
    p, K = vehicle.p, vehicle.p["K_de"]  # of the two dampers together, half of it each
    springs = {"K_2y": p["K_2y"] + K, "K_2x": p["K_2x"] + K * p["a"] ** 2 / p["b_2"] ** 2}
    spring = eigenvalues(vehicle.replace(C_e=0.0, **springs))
    same_roots(firm[np.abs(firm) > 1e-3], spring, 1e-4)


def test_design(problem):
    found = yd.design(problem)
    assert found.status == "ok"
    up, down = (yd.design(problem.replace(C_e=60e3 * (1 + h))).C_sl for h in (1e-4, -1e-4))
    slope = np.log(up / down) / np.log((1 + 1e-4) / (1 - 1e-4))
    assert found.sensitivity["C_e"] == pytest.approx(slope, rel=1e-4)
    assert found.sensitivity["K_de"] != 0


def test_modes(problem):
    names = [mode.name for mode in yd.modes(problem).modes]
    assert len(set(names)) == len(names)
    assert {"end damper relaxation 1", "end damper relaxation 2"} <= set(names)


def test_followed_modes(problem):
    found = yd.follow_modes(problem, C_e=["20 kN s/m", "40 kN s/m", "60 kN s/m"])
    assert {"end damper relaxation 1", "end damper relaxation 2"} <= set(found.names)
    assert found.checked


@pytest.mark.parametrize(
    ("of", "alone"),
    [
        ("C_sl", lambda problem: yd.design(problem).C_sl),
        ("decay_rate", lambda problem: yd.stability(problem).decay_rate),
        ("stable", lambda problem: yd.stability(problem).stable),
    ],
)
def test_sweeps(problem, of, alone):
    found = yd.sweep(problem, of=of, C_e=WORTH_60)
    expected = [alone(problem.replace(C_e=x)) for x in WORTH_60]
    assert np.asarray(found.values, dtype=float) == pytest.approx(np.array(expected, dtype=float), rel=1e-7)


def test_simulation(problem):
    found = yd.simulate(problem, duration=2.0)
    assert found.checked
    assert set(found.rms) >= OUTPUTS
    assert all(found.rms[name] > 0 for name in OUTPUTS)


def test_frequency_response(problem):
    one, other = (yd.frequency_response(x) for x in (problem, problem.replace(C_e=0.0)))
    assert one.checked
    assert other.checked
    assert one.y_b != other.y_b


def test_state_space(problem):
    found = yd.state_space(problem)
    assert found.A.shape == (27, 27)
    assert {"end_damper_stroke_1", "end_damper_stroke_2"} <= set(found.states)
    same_roots(np.linalg.eigvals(found.A), yd.stability(problem).eigenvalues, 1e-6)


def test_functions(problem):
    found = yd.functions(problem).documented["critical_damping"]
    assert {"C_e", "K_de"} <= {port.name for port in found.inputs}
    C_sl = float(found.function(*(port.value[0] for port in found.inputs))[0])
    assert C_sl == pytest.approx(yd.design(problem).C_sl, rel=1e-9)


@pytest.mark.slow
def test_export(problem, tmp_path):
    yd.export(problem, tmp_path / "exported")
    header, manifest = (
        (tmp_path / "exported" / name).read_text(encoding="utf-8") for name in ("yawdesign.h", "manifest.json")
    )
    assert "critical_damping_in_C_e" in header
    assert '"end_damper_stroke_1"' in manifest


def test_fmu(problem, tmp_path):
    yd.write_fmu(problem, tmp_path / "bogie.fmu")
    with zipfile.ZipFile(tmp_path / "bogie.fmu") as archive:
        text = archive.read("modelDescription.xml").decode()
    assert all(f'name="{name}"' in text for name in ("C_e", "K_de", "end_damper_stroke_1"))


@pytest.mark.slow
def test_optimise(problem):
    variables = {
        "C_s": yd.Variable(min="500 kN s/m", max="1500 kN s/m"),
        "C_e": yd.Variable(min="20 kN s/m", max="2 MN s/m"),
    }
    found = yd.optimise(problem.replace(design=yd.Design(variables=variables)))
    assert {name for name, value in found.optimum.items() if value != problem.bogie.parameters()[name]} <= {*variables}
    assert 20e3 <= found.optimum["C_e"] <= 2e6
    assert found.margin > found.margin_before
    grid = yd.sweep(problem, of="decay_rate", C_s=np.linspace(5e5, 15e5, 41), C_e=np.geomspace(20e3, 2e6, 41))
    assert found.margin >= np.max(grid.values) * (1 - 1e-9)


def test_a_problem_file(tmp_path):
    file = tmp_path / "problem.yaml"
    for command, *options in (
        ("new",),
        ("check",),
        ("stability",),
        ("sweep", "--of", "C_sl", "--over", "C_e=20 kN s/m:60 kN s/m:3"),
    ):
        done = CliRunner().invoke(app, [command, str(file), *options])
        assert done.exit_code == 0, done.output
    text = file.read_text(encoding="utf-8")
    assert "C_e: 60 kN·s/m" in text
    assert "K_de: 40 MN/m" in text
    assert yd.load(file).bogie.C_e == 60e3
    assert "C_e" in json.dumps(yd.schema())
    for wrong in ("60 kN/m", "-1 kN s/m"):
        with pytest.raises(yd.ProblemError, match="C_e"):
            yd.loads(text.replace("C_e: 60 kN·s/m", f"C_e: {wrong}"))


def test_a_preset_without_it_says_so(problem):
    with pytest.raises(yd.ProblemError, match=r"bogie\.C_e: is missing: damping of each end damper"):
        yd.loads("bogie: {base: table1}\nspeed: 300 km/h\n")
    text = "bogie: {base: table1, C_e: 60 kN s/m, K_de: 40 MN/m}\nspeed: 300 km/h\n"
    assert yd.loads(text).replace(lambda_=problem.bogie.lambda_).bogie == problem.bogie


@pytest.mark.slow
def test_pictures(problem):
    for result in (
        yd.modes(problem),
        yd.follow_modes(problem, C_e=WORTH_60),
        yd.sweep(problem, of="C_sl", C_e=WORTH_60),
        yd.simulate(problem, duration=2.0),
    ):
        axes = np.ravel(yd.plot(result))
        axes[0].figure.canvas.draw()

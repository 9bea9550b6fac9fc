"""Every command for every kind of vehicle: its numbers are those of an independent state matrix, or it refuses clearly.

No command refuses any kind. An answer for another vehicle, such as the single bogie in the place of the whole one, does
not have the numbers that are looked for here.
"""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtri
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.problem.parameters import CarBody

CURVE = {"R": "300 m", "L": "19 m", "l": "60 m", "V_r": "90 km/h", "limit": 0.08}
KINDS = ("power", "trailer", "power with car body", "trailer with car body", "rigid yaw dampers")


@pytest.fixture(scope="module")
def problems(car_body):
    """Return a problem of every kind."""
    body = CarBody(**car_body)
    curve = yd.Curve(**CURVE)
    plain = {kind: replace(yd.table1(kind=kind), curve=curve).replace(C_s=1e6) for kind in ("power", "trailer")}
    return {
        **plain,
        **{f"{kind} with car body": replace(problem, car_body=body) for kind, problem in plain.items()},
        "rigid yaw dampers": plain["power"].replace(K_ds="rigid"),
    }


@pytest.fixture(params=KINDS)
def kind(request):
    return request.param


@pytest.fixture
def problem(problems, kind):
    return problems[kind]


@pytest.fixture
def file(problem, tmp_path):
    """Return the file of a problem."""
    data = {name: x for name, x in problem.to_dict().items() if name in ("equations", "bogie", "car_body") and x}
    data |= {"speed": "300 km/h", "curve": CURVE}
    path = tmp_path / "problem.yaml"
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


@pytest.fixture
def answered(file):
    """Return a function that runs a command and returns its JSON, or its text."""

    def run(command, *options, codes=(0,), plain=False):
        done = CliRunner().invoke(app, [command, str(file), *options, *(() if plain else ("--json",))])
        assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
        assert done.exit_code in codes, done.output
        return done.stdout if plain else json.loads(done.stdout)

    return run


@pytest.fixture
def spectrum(independent, problem):
    """Return the eigenvalues at other values of some parameters, by the equations written a second time."""

    def found(**changes):
        p = {**{name: float(x) for name, x in problem.parameters().items()}, "v": 300 / 3.6, **changes}
        return np.linalg.eigvals(np.array(independent.equations(problem.bogie.kind, p).state_matrix(), dtype=float))

    return found


def same(found, expected, tolerance=1e-8):
    """Say whether two spectra are the same, each root having its own."""
    left = list(expected)
    assert len(found) == len(left)
    for x in found:
        nearest = min(range(len(left)), key=lambda k: abs(left[k] - x))
        assert abs(left.pop(nearest) - x) < tolerance * max(1, abs(x))


def test_check(answered):
    assert "no errors" in answered("check", plain=True)


def test_stability(answered, spectrum):
    found = answered("stability", codes=(0, 1))
    s = spectrum()
    same([complex(*x) for x in found["eigenvalues"]], s)
    assert found["stable"] == bool(s.real.max() < 0)
    assert found["spectral_abscissa"] == pytest.approx(s.real.max(), rel=1e-8)


def test_critical_speed(answered, spectrum):
    found = answered("critical-speed", codes=(0, 1))
    critical = found["critical_speeds"]
    for x in critical:
        assert np.min(np.abs(spectrum(v=x["v"]) - 1j * x["omega"])) < 1e-6 * x["omega"]
    v = np.linspace(*found["searched"], 60)
    stable = np.array([spectrum(v=x).real.max() < 0 for x in v])
    up_to = {None: np.inf}.get(found["stable_up_to"], found["stable_up_to"])
    assert stable[v < up_to].all()
    assert np.count_nonzero(np.diff(stable)) <= len(critical)
    assert (up_to == np.inf) == (not critical and bool(stable.all()))


def test_modes(answered, spectrum):
    found = answered("modes", codes=(0, 1))["modes"]
    roots = [complex(*mode["eigenvalue"]) for mode in found]
    roots += [x.conjugate() for x in roots if x.imag]
    same(roots, spectrum(), 1e-7)
    names = [mode["name"] for mode in found]
    assert len(names) == len(set(names))


def test_design(answered, spectrum):
    found = answered("design", codes=(0, 1))
    for value in found["critical"]:
        s = spectrum(C_s=value["C_s"])
        assert np.min(np.abs(s - 1j * value["omega"])) < 1e-6 * value["omega"]
    edges = [x["C_s"] for x in found["critical"]]
    for C_s in np.geomspace(1e3, 1e8, 60):
        if all(abs(np.log(C_s / x)) > 1e-3 for x in edges):
            inside = any(low < C_s < (high or np.inf) for low, high in found["stable_intervals"])
            assert inside == bool(spectrum(C_s=C_s).real.max() < 0), C_s
    if found["C_s"] is not None:
        assert found["stable"] == bool(spectrum(C_s=found["C_s"]).real.max() < 0)


def test_sweep(answered, spectrum):
    found = answered("sweep", "--of", "stable", "--over", "C_s=20 kN s/m:5 MN s/m:7:log", codes=(0, 1))
    for C_s, stable in zip(found["axes"][0]["values"], found["values"], strict=True):
        assert stable == bool(spectrum(C_s=C_s).real.max() < 0)
    rates = answered("sweep", "--of", "decay_rate", "--over", "lambda=0.05:0.25:3", codes=(0, 1))
    for conicity, rate in zip(rates["axes"][0]["values"], rates["values"], strict=True):
        assert rate == pytest.approx(-spectrum(**{"lambda": conicity}).real.max(), rel=1e-7)


@pytest.mark.slow
def test_optimise(answered, spectrum):
    found = answered("optimise", codes=(0, 1))
    if found["optimum"]["C_s"] is not None:
        s = list(spectrum(**{name: x for name, x in found["optimum"].items() if x is not None}))
        fixed = [complex(*x) for name, roots in found["fixed_modes"].items() if "motors" in name for x in roots]
        for x in fixed:  # those that no variable moves do not count
            s.remove(min(s, key=lambda root: abs(root - x)))
        assert found["margin"] == pytest.approx(-max(root.real for root in s), rel=1e-6)


def test_choose(answered, file, spectrum):
    data = json.loads(file.read_text(encoding="utf-8"))
    rows = [{"name": "weak", "damping": 3e5, "stiffness": 8e6}, {"name": "strong", "damping": 6e5, "stiffness": 9e6}]
    data["design"] = {"catalogue": rows, "variables": {"K_1y": {"min": 1e6, "max": 1e8}}}
    file.write_text(json.dumps(data), encoding="utf-8")
    candidates = answered("choose", codes=(0, 1))["candidates"]
    assert {row["name"] for row in candidates} == {"weak", "strong"}
    for row in candidates:
        s = spectrum(C_s=row["C_s"], K_ds=row["K_ds"])
        assert min(abs(s.real + row["margin"])) < 1e-7  # a mode that the variables do not move may be less damped
        assert row["margin"] >= -s.real.max() - 1e-7


@pytest.mark.slow
def test_report(answered, file, tmp_path, spectrum):
    data = json.loads(file.read_text(encoding="utf-8"))
    data |= {"curve": None, "design": {"variables": {"C_s": {"min": 2e5, "max": 4e6}}}}
    file.write_text(json.dumps({key: value for key, value in data.items() if value is not None}), encoding="utf-8")
    best = answered("optimise", codes=(0, 1))
    answered("report", "--to", str(tmp_path / "page.html"), codes=(0, 1), plain=True)
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert f"{best['margin']:.6g} 1/s" in page
    s = spectrum(C_s=best["C_s"])
    assert min(abs(s.real + best["margin"])) < 1e-6


@pytest.mark.slow
def test_trade_off(answered, spectrum):
    front = answered("trade-off", "--points", "2", codes=(0, 1))["front"]
    for point in front:
        s = spectrum(**{name: point[name] for name in ("C_s", "K_m", "C_m") if point.get(name) is not None})
        assert min(abs(s.real + point["margin"])) < 1e-6


@pytest.mark.slow
def test_uncertainty(answered, file, spectrum):
    data = json.loads(file.read_text(encoding="utf-8"))
    data["uncertainty"] = {"lambda": {"uniform": [0.05, 0.4]}, "K_1x": {"normal": "10 %"}}
    file.write_text(json.dumps(data), encoding="utf-8")
    found = answered("uncertainty", "--samples", "1024", codes=(0, 1))
    assert found["margin"] == pytest.approx(-spectrum().real.max(), rel=1e-7)
    K_1x = data["bogie"]["K_1x"]
    low, high = (-spectrum(K_1x=K_1x * x).real.max() for x in (0.9999, 1.0001))
    assert found["effects"]["K_1x"]["margin"] == pytest.approx((high - low) / 2e-4 * 0.1, rel=1e-3)
    u = (np.arange(300) + 0.5)[:, None] * [1 / 300, 0.6180339887498949] % 1  # evenly over the unit square
    samples = zip(0.05 + 0.35 * u[:, 0], K_1x * (1 + 0.1 * ndtri(u[:, 1])), strict=True)
    unstable = np.mean([spectrum(**{"lambda": x, "K_1x": y}).real.max() > 0 for x, y in samples])
    low, high = found["interval"]
    assert low - 0.03 <= unstable <= high + 0.03


def test_simulate(answered, independent, problem, spectrum):
    found = answered("simulate", "--duration", "2 s", codes=(0, 1))
    p = {**problem.parameters(), "v": 300 / 3.6}
    assert set(independent.equations(problem.bogie.kind, p).names) <= set(found["rms"])
    assert found["runs"][0]["spectral_abscissa"] == pytest.approx(spectrum().real.max(), rel=1e-7)


def test_another_condition(answered, problem, spectrum):
    """What shows one vehicle shows it under the condition that is asked for, of every kind."""
    given = ("lambda=0.3", "creep_factor=50 %", "tolerance.K_1y=-10 %", "speed=250 km/h")
    options = [x for each in given for x in ("--condition", each)]
    p = problem.parameters()
    creep = {name: 0.5 * p[name] for name in ("f_11", "f_22")}
    s = spectrum(**{"lambda": 0.3, "K_1y": 0.9 * p["K_1y"], "v": 250 / 3.6}, **creep)
    modes = answered("modes", *options, codes=(0, 1))["modes"]
    roots = [complex(*mode["eigenvalue"]) for mode in modes]
    same(roots + [x.conjugate() for x in roots if x.imag], s, 1e-7)
    run = answered("simulate", "--duration", "1 s", *options, codes=(0, 1))["runs"][0]
    assert run["spectral_abscissa"] == pytest.approx(s.real.max(), rel=1e-7)


@pytest.mark.slow
def test_export(answered, independent, problem, tmp_path):
    answered("export", "--to", str(tmp_path / "exported"))
    manifest = (tmp_path / "exported" / "manifest.json").read_text(encoding="utf-8")
    p = {**problem.parameters(), "v": 300 / 3.6}
    assert all(f'"{name}"' in manifest for name in independent.equations(problem.bogie.kind, p).names)


@pytest.mark.slow
def test_reproduce(independent, tmp_path):
    """It has no problem file: it is about Table I, whose boundary of stability is that of the independent matrix."""
    done = CliRunner().invoke(app, ["reproduce", "--to", str(tmp_path / "paper"), "--json"])
    assert done.exit_code == 0, done.output
    rows = [x for x in json.loads(done.stdout)["rows"] if x["what"].startswith("C_sl, ")]
    (C_sl,) = [x["computed"] for x in rows if x["equations"] == "reciprocal"]
    p = {**{name: float(x) for name, x in yd.table1().parameters().items()}, "v": 300 / 3.6, "C_s": C_sl}
    s = np.linalg.eigvals(np.array(independent.equations("power", p).state_matrix(), dtype=float))
    assert abs(s.real.max()) < 1e-6
    assert (tmp_path / "paper" / "reproduction.html").is_file()
    changed = CliRunner().invoke(app, ["reproduce", "--set", "M_b=7300 kg"])
    assert changed.exit_code == 1, changed.output
    assert "M_b is 7300 here" in changed.stdout


@pytest.mark.parametrize("own", ["power", "trailer"])
def test_new(own, tmp_path):
    path = tmp_path / "problem.yaml"
    assert CliRunner().invoke(app, ["new", str(path), "--kind", own]).exit_code == 0
    assert yd.load(path).bogie.kind == own


def test_all_commands_are_here():
    names = {name.removeprefix("test_") for name in globals()}
    commands = {command.callback.__name__ for command in app.registered_commands} - {"schema"}
    assert commands <= names, commands - names

"""A car body on two bogies in motion: delays, limits, energy, and its equations written out by hand."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.linalg import expm

import yawdesign as yd
from yawdesign.problem.cases import Case, Change
from yawdesign.problem.parameters import CarBody
from yawdesign.response.run.damper_component import components
from yawdesign.response.run.frequency import outputs
from yawdesign.response.run.run import run
from yawdesign.response.run.system import System, system_at
from yawdesign.response.run.time_history import Plan
from yawdesign.response.track.tracks import as_track
from yawdesign.vehicle.vehicle import Vehicle, families, known_coordinates

BODY = {"M_c": 34500, "J_c": 1.521e6, "I_c": 124304, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97, "K_2z": 610e3, "C_2z": 9800}
BOGIES, ENDS = ((1, 1), (2, -1)), ((1, 1), (2, -1))  # number and sign of x
ROLL = {"I_b": 3000, "K_1z": 1.2e6, "C_1z": 10e3, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.05}


def on_bogies(kind="power", **changes):
    return replace(yd.table1(kind), car_body=CarBody(**{**BODY, **changes})).replace(C_s="1 MN s/m")


@pytest.fixture(scope="module")
def problem():
    return on_bogies()


def by_hand(p, kind):
    """Return masses, springs (K, u), dashpots (c, u) and Maxwell elements (K, c, u) of the vehicle."""
    masses = {"y_c": p["M_c"], "psi_c": p["J_c"], "th_c": p["I_c"]}
    springs, dashpots, maxwells = [], [], []
    for i, e in BOGIES:
        y_b, phi_b = f"y_b{i}", f"phi_b{i}"
        masses |= {y_b: p["M_b"], phi_b: p["J_b"]}
        springs += [
            (p["K_2y"], {y_b: 1, "y_c": -1, "psi_c": -e * p["l_c"], "th_c": -p["h_s"]}),
            (p["K_2x"] * p["b_2"] ** 2, {phi_b: 1, "psi_c": -1}),
            (2 * p["K_2z"] * p["b_2"] ** 2, {"th_c": 1}),
        ]
        dashpots.append((2 * p["C_2z"] * p["b_2"] ** 2, {"th_c": 1}))
        maxwells.append((p["K_ds"], p["C_s"], {phi_b: p["b_3"], "psi_c": -p["b_3"]}))
        for k, s in ENDS:
            y_w, phi_w, y_m, phi_m = (f"{x}{i}{k}" for x in ("y_w", "phi_w", "y_m", "phi_m"))
            masses |= {y_w: p["M_w"], phi_w: p["J_w"]}
            lateral = {y_b: 1, phi_b: s * p["b_0"], "y_c": -1, "psi_c": -e * p["l_c"] - s * p["b_0"], "th_c": -p["h_t"]}
            maxwells.append((p["K_dt"] / 2, p["C_t"] / 2, lateral))
            springs += [
                (p["K_1y"], {y_b: 1, phi_b: s * p["a"], y_w: -1}),
                (p["K_1x"] * p["b_1"] ** 2, {phi_b: 1, phi_w: -1}),
            ]
            if kind == "power":
                masses |= {y_m: p["M_m"], phi_m: p["J_m"]}
                hung = {y_b: 1, phi_b: s * p["a_0"], y_m: -1}
                springs += [(p["K_m"], hung), (p["K_mphi"], {phi_b: 1, phi_m: -1})]
                maxwells.append((p["K_dm"] / 2, p["C_m"], hung))
                dashpots.append((p["C_mphi"], {phi_b: 1, phi_m: -1}))
    return masses, springs, dashpots, maxwells


def solved_by_hand(p, kind, omega, which):
    """Return the amplitudes of all coordinates on a track of amplitude 1, wheelset after wheelset."""
    masses, springs, dashpots, maxwells = by_hand(p, kind)
    s, v, place = 1j * omega, p["v"], {x: k for k, x in enumerate(masses)}
    matrix, force = np.diag([m * s**2 for m in masses.values()]), np.zeros(len(masses), dtype=complex)
    laws = [*springs, *((c * s, u) for c, u in dashpots), *((K * c * s / (K + c * s), u) for K, c, u in maxwells)]
    for Z, u in laws:
        row = np.zeros(len(masses))
        row[[place[x] for x in u]] = list(u.values())
        matrix += Z * np.outer(row, row)
    for i, e in BOGIES:
        for k, end in ENDS:
            y, phi = place[f"y_w{i}{k}"], place[f"phi_w{i}{k}"]
            g, cone = p["W"] * p["lambda"], 2 * p["f_22"] * p["b"] * p["lambda"] / p["r"]
            matrix[y, y] += g / p["b"] + 2 * p["f_11"] * s / v
            matrix[y, phi] -= 2 * p["f_11"]
            matrix[phi, y] += cone
            matrix[phi, phi] += 2 * p["f_22"] * p["b"] ** 2 * s / v - g * p["b"]
            behind = (p["l_c"] + p["a"]) - (e * p["l_c"] + end * p["a"])
            late = np.exp(-s * behind / v)
            force[y] += late * (g / p["b"] if which == "alignment" else p["W"])
            force[phi] += late * (cone if which == "alignment" else 0)
    return dict(zip(masses, np.linalg.solve(matrix, force), strict=True))


@pytest.mark.parametrize("which", ["alignment", "cross_level"])
@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_equations_by_hand(kind, which):
    problem = on_bogies(kind)
    lengths = np.array([7.0, 15.0, 33.0, 80.0, 200.0])
    found = yd.frequency_response(problem, lengths, which)
    assert found.checked
    system = system_at(problem, problem.speeds[0])
    omega = 2 * np.pi * found.frequency
    y = outputs(system, omega, system.wheelsets.harmonic(omega, which))
    for k, w in enumerate(omega):
        p = system.vehicle.p
        x = solved_by_hand(p, kind, w, which)
        size = max(map(abs, x.values()))
        assert set(found.amplitudes) == set(x)
        for name in x:
            assert found.amplitudes[name][k] == pytest.approx(x[name], abs=1e-8 * size)
        for end, sign in (("1", 1), ("2", -1)):
            above = -(w**2) * (x["y_c"] + sign * p["l_c"] * x["psi_c"])
            assert y[k, system.outputs[f"y_c{end}_acceleration"]] == pytest.approx(above, rel=1e-7)
            turned = p["b_3"] * (x[f"phi_b{end}"] - x["psi_c"])
            pull = p["K_ds"] * p["C_s"] * 1j * w / (p["K_ds"] + p["C_s"] * 1j * w) * turned
            assert y[k, system.outputs[f"yaw_damper_force_{end}"]] == pytest.approx(pull / 2, rel=1e-6)


def test_four_delays_in_a_harmonic_run(problem):
    history = yd.simulate(problem, yd.Harmonic("25 m", "2 mm"), duration=2).histories[0]
    for end, behind in {"11": 0, "12": 2.5, "21": 19, "22": 21.5}.items():
        expected = 2e-3 * np.cos(2 * np.pi * (history.distance - behind) / 25)
        assert history[f"alignment_{end}"] == pytest.approx(expected, abs=1e-12)
        assert not history[f"cross_level_{end}"].any()


def test_four_delays_on_a_measured_track(problem, tmp_path):
    file, rng = tmp_path / "track.csv", np.random.default_rng(1)
    x, measured = np.arange(2000) / 4, np.round(rng.normal(size=2000), 4)
    rows = [f"{a}, {b}" for a, b in zip(x, measured, strict=True)]
    file.write_text("distance [m], alignment [mm]\n" + "\n".join(rows))
    history = yd.simulate(problem, file, start="rest").histories[0]
    assert history.distance[-1] == pytest.approx(499.75 - 21.5)
    for end, behind in {"11": 0, "12": 2.5, "21": 19, "22": 21.5}.items():
        expected = 1e-3 * np.interp(21.5 + history.distance - behind, x, measured)
        assert history[f"alignment_{end}"] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_under_a_very_heavy_car_body_the_bogies_move_alone(kind):
    heavy, alone = on_bogies(kind, M_c=1e15, J_c=1e15, I_c=1e15), yd.table1(kind).replace(C_s="1 MN s/m")
    lengths = np.geomspace(5, 100, 20)
    for which in ("alignment", "cross_level"):
        whole, one = yd.frequency_response(heavy, lengths, which), yd.frequency_response(alone, lengths, which)
        later = np.exp(-2j * np.pi * 2 * BODY["l_c"] / lengths)
        size = np.max([np.abs(values) for values in one.amplitudes.values()], axis=0)
        for name, values in one.amplitudes.items():
            stem, end = name.rstrip("12"), name[len(name.rstrip("12")) :]
            for bogie, delay in (("1", 1), ("2", later)):
                found = whole.amplitudes[f"{stem}{bogie}{end}"]
                assert np.max(np.abs(found - delay * values) / size) < 1e-8
    (run_heavy,), (run_alone,) = (yd.simulate(x, duration=3, start="rest").histories for x in (heavy, alone))
    difference = run_heavy["yaw_damper_force_1"] - run_alone["yaw_damper_force"]
    assert np.max(np.abs(difference)) < 1e-8 * np.max(np.abs(run_alone["yaw_damper_force"]))


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_energy_of_a_free_run_without_creep(kind):
    """What springs and masses lose is what the dampers take: by the matrices, and along a motion."""
    nothing = {"W": 0.0, "lambda": 0.0, "f_11": 0.0, "f_22": 0.0}
    problem = on_bogies(kind)
    (whole,) = Vehicle.of(problem)
    system = System(whole.model.at({**whole.p, **nothing}))
    masses, springs, dashpots, maxwells = by_hand(system.vehicle.p, kind)
    n = len(masses)
    states = list(system.space.states)

    def row(u, rate=0):
        found = np.zeros(len(states))
        for x, g in u.items():
            found[states.index(x) + rate * n] = g
        return found

    stored = np.diag([0.0] * n + [masses[x] for x in system.coordinates] + [0.0] * (len(states) - 2 * n))
    stored += sum(K * np.outer(row(u), row(u)) for K, u in springs)
    taken = sum(c * np.outer(row(u, 1), row(u, 1)) for c, u in dashpots)
    strokes, at_rest, order = system.space.strokes, [], []
    for K, c, u in maxwells:
        (stroke,) = (k for k, (link, _) in enumerate(strokes) if dict(link.displacement) == pytest.approx(u))
        at_rest.append(row(u)[:n])
        order.append(2 * n + stroke)
        held = row(u) - np.eye(len(states))[2 * n + stroke]
        stored += K * np.outer(held, held)
        taken += K**2 / c * np.outer(held, held)  # c z'^2 with z' = K / c (u - z)
    change = system.A.T @ stored + stored @ system.A
    assert np.max(np.abs(change + 2 * taken)) < 1e-12 * np.max(np.abs(change))
    step, x = 5e-5, np.zeros(len(states))
    x[:n] = 0.01 * np.random.default_rng(3).normal(size=n)
    x[order] = np.array(at_rest) @ x[:n]
    motion = [x]
    transition = expm(system.A * step)
    for _ in range(10000):
        motion.append(transition @ motion[-1])
    motion = np.array(motion)
    energy = np.einsum("ti,ij,tj->t", motion, stored, motion) / 2
    lost = simpson(np.einsum("ti,ij,tj->t", motion, taken, motion), dx=step)
    assert energy[-1] < 0.9 * energy[0]
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-8)


def test_run_and_spectrum_agree(problem):
    one = yd.simulate(problem, duration=60).runs[0]
    found = yd.stationary_response(problem)
    assert one.checked
    for name, rms in found.rms_weighted.items():
        assert one.rms_weighted[name] == pytest.approx(rms, rel=0.01)
        assert one.rms[name] == pytest.approx(found.rms[name], rel=0.01)
        assert one.peak[name] > 2 * one.rms[name]
    assert list(found.rms_weighted) == ["y_c1_acceleration", "y_c2_acceleration"]
    assert (
        yd.stationary_response(yd.table1()).rms_weighted
        == yd.simulate(yd.table1(), duration=2).runs[0].rms_weighted
        == {}
    )


def test_yaw_dampers_of_both_bogies(problem):
    result = yd.simulate(problem, duration=10)
    leading, trailing = result.dampers
    assert (leading.name, trailing.name) == ("yaw damper 1", "yaw damper 2")
    assert leading.force_rms == result.rms["yaw_damper_force_1"]
    assert trailing.stroke_peak == result.peak["yaw_damper_stroke_2"]
    assert leading.checked
    assert trailing.checked
    assert result.damper == max(result.dampers, key=lambda damper: damper.force_rms)
    assert yd.damper_component(problem, "trailing", duration=10) == trailing
    with pytest.raises(yd.ProblemError, match="leading"):
        yd.damper_component(problem, "front", duration=10)
    with pytest.raises(yd.ProblemError, match="none of two"):
        yd.damper_component(yd.table1(), "leading", duration=10)


def test_one_yaw_damper_lost(problem):
    half = tuple(Change(f"leading.{key}", 0.5, share=True) for key in ("C_s", "K_ds"))
    (whole,) = Vehicle.of(problem)
    system = System(whole.with_fault(Case("one yaw damper lost", half)))
    assert system.wheelsets == system_at(problem, problem.speeds[0]).wheelsets
    one, history = run(system, Plan(as_track("german-low"), 20.0, None, None, "stationary", {}))
    leading, trailing = components(system, one)
    assert (leading.C_s, leading.K_ds, trailing.C_s, trailing.K_ds) == (5e5, 20e6, 1e6, 40e6)
    assert leading.checked
    assert trailing.checked
    rate = np.gradient(history["yaw_damper_stroke_1"], history.time)
    assert history["yaw_damper_force_1"] == pytest.approx(5e5 / 2 * rate, abs=0.02 * leading.force_peak)


@pytest.mark.parametrize("whole", [True, False])
def test_rigid_dampers(whole):
    given = {"K_ds": "rigid", "K_dt": "rigid", "C_1y": "30 kN s/m", "C_1x": "20 kN s/m", "C_s": "300 kN s/m"}
    problem = (on_bogies() if whole else yd.table1()).replace(**given)
    result = yd.simulate(problem, duration=4)
    history, (bogie, end) = result.histories[0], ("1", "11") if whole else ("", "1")
    assert result.damper.checked
    assert result.damper.stroke_rms == max(x for name, x in result.rms.items() if "yaw_damper_displacement" in name)
    assert json.loads(json.dumps(result.to_dict(), allow_nan=False))["damper"]["K_ds"] is None
    p = system_at(problem, problem.speeds[0]).vehicle.p
    turned = history[f"phi_b{bogie}_velocity"] - (history["psi_c_velocity"] if whole else 0)
    force = history[f"yaw_damper_force_{bogie}".rstrip("_")]
    assert force == pytest.approx(p["C_s"] / 2 * p["b_3"] * turned, rel=1e-9)
    shifted = (
        history[f"y_b{bogie}_velocity"] + p["a"] * history[f"phi_b{bogie}_velocity"] - history[f"y_w{end}_velocity"]
    )
    assert history[f"primary_lateral_damper_pair_force_{end}"] == pytest.approx(p["C_1y"] * shifted, rel=1e-9)
    pulled = p["b_1"] * (history[f"phi_b{bogie}_velocity"] - history[f"phi_w{end}_velocity"])
    assert history[f"primary_longitudinal_damper_force_{end}"] == pytest.approx(p["C_1x"] / 2 * pulled, rel=1e-9)
    assert not any("stroke" in name for name in result.rms if "motor" not in name)


def test_longitudinal_primary_dampers_have_joints_in_newton_per_metre():
    problem = yd.table1().replace(C_1x="20 kN s/m", K_d1x="8 MN/m")
    history = yd.simulate(problem, duration=3, step="0.2 ms").histories[0]
    rate = np.gradient(history["primary_longitudinal_damper_stroke_2"], history.time)[1:-1]
    force = history["primary_longitudinal_damper_pair_force_2"][1:-1]
    assert force == pytest.approx(20e3 * rate, abs=2e-3 * np.abs(force).max())


def test_roll_of_the_frames():
    problem = on_bogies()
    problem = replace(problem, bogie=replace(problem.bogie, **ROLL))
    result = yd.simulate(problem, duration=3)
    assert result.rms["th_b1"] > 0
    assert result.histories[0].unit("th_b2_acceleration") == "rad/s^2"
    response = yd.frequency_response(problem)
    assert response.checked
    assert response.th_b1 != response.th_b2


def test_coordinates_of_all_vehicles(problem):
    bogies, vehicles = families()
    assert set(bogies) >= {"y_b", "th_b", "y_w1", "phi_m2"}
    assert set(vehicles) >= {"y_c", "psi_c", "th_c", "y_b1", "th_b2", "phi_w12", "y_m21"}
    assert set(known_coordinates()) == {*bogies, *vehicles}
    response = yd.frequency_response(problem)
    assert response.y_b is None
    assert response.y_w21 == response.amplitudes["y_w21"]
    assert response.to_dict()["th_b1"] is None
    assert "y_b" not in response.to_dict()
    assert "y_c" not in yd.frequency_response(yd.table1()).to_dict()
    assert [problem.speeds[0], "psi_c"] == [response.speed, list(response.amplitudes)[1]]


def test_an_unstable_vehicle_is_called_so(problem):
    with pytest.raises(yd.ProblemError, match="the vehicle is unstable at 300 km/h"):
        yd.stationary_response(problem.replace(C_s=2e4, lambda_=0.05))
    assert not yd.frequency_response(problem.replace(lambda_=0.05)).stable
    result = yd.simulate(problem.replace(lambda_=0.05), start="offset", offset={"y_c": "5 mm"}, duration=8)
    assert not result.settles
    assert result.histories[0]["y_c2"][0] == pytest.approx(5e-3)

"""Vehicles with a car body: reference numbers, limits that are known by other means, and faults of one bogie."""

from fractions import Fraction

import numpy as np
import pytest

from yawdesign.hunting.eigenvalues import eigenvalues, state_matrix
from yawdesign.problem.cases import Case, Change
from yawdesign.vehicle.vehicle import Model

MOTOR = ("M_m", "J_m", "K_m", "K_mphi", "K_dm", "C_mphi", "C_m", "a_0")


def parameters(reference):
    p = {name: x for name, x in reference["bogie"].items() if reference["kind"] == "power" or name not in MOTOR}
    return {**p, **reference["car_body"], "v": reference["speed_kmh"] / 3.6, "C_s": reference["C_s"]}


def vehicle_of(p, kind="power"):
    return Model(kind, "reciprocal", tuple(p)).at(p)


@pytest.fixture
def moving(table1, car_body):
    """Table I under the car body of the references, at the given numbers."""

    def make(kind="power", **changes):
        p = {name: x for name, x in table1.items() if kind == "power" or name not in MOTOR}
        return vehicle_of({**p, **car_body, "C_s": 1e6, **changes}, kind)

    return make


def test_spectral_abscissa_and_least_damped(reference_case, independent):
    p = parameters(reference_case)
    vehicle = vehicle_of(p, reference_case["kind"])
    second = np.linalg.eigvals(np.array(independent.equations(reference_case["kind"], p).state_matrix(), dtype=float))
    expected = [complex(*x) for x in reference_case["least_damped"]]
    for s in (eigenvalues(vehicle), second):
        assert s.real.max() == pytest.approx(reference_case["spectral_abscissa"], rel=1e-8)
        # Motors that yaw against each other in each bogie are two equal roots, of which the list may have one.
        found = sorted(s[s.imag >= 0], key=lambda x: -x.real)[: len(expected)]
        assert np.all(np.abs(np.subtract(found, expected)) < 1e-8 * np.abs(expected))


def test_roots_cross_at_the_critical_values(reference_case):
    """At every critical value a pair lies on the axis, and as many roots as stated lie right of it between them."""
    vehicle = vehicle_of(parameters(reference_case), reference_case["kind"])
    values = reference_case["critical_C_s"]
    for C_s, omega in zip(values, reference_case["omega"], strict=True):
        s = np.linalg.eigvals(state_matrix(vehicle.replace(C_s=C_s)))
        assert np.min(np.abs(s - 1j * omega)) < 1e-7 * omega
    between = np.sqrt([a * b for a, b in zip([values[0] / 4, *values], [*values, values[-1] * 4], strict=True)])
    counts = [int(np.sum(eigenvalues(vehicle.replace(C_s=float(x))).real > 0)) for x in between]
    assert counts == reference_case["unstable_roots_per_interval"]


def test_a_car_body_on_bogies_held_fast(moving):
    """Frames of 1e15: three motions of the car body on springs alone, by the stiffness of its suspension."""
    held = moving(M_b=1e15, J_b=1e15, C_t=0.0, C_2z=0.0, C_s=0.0)
    matrix = state_matrix(held)
    found = sorted(s.imag for s in np.linalg.eigvals(matrix) if 2 < s.imag < 12 and abs(s.real) < 1e-3)
    assert found == pytest.approx([4.2291622, 7.8476776, 9.8086894], abs=1e-6)
    p = held.p
    K_y, K_y_roll = 2 * p["K_2y"], 2 * p["K_2y"] * p["h_s"]
    K_roll = 2 * p["K_2y"] * p["h_s"] ** 2 + 4 * p["K_2z"] * p["b_2"] ** 2
    sway = np.linalg.eigvals(np.array([[K_y, K_y_roll], [K_y_roll, K_roll]]) / np.array([[p["M_c"]], [p["I_c"]]]))
    yaw = 2 * (p["K_2y"] * p["l_c"] ** 2 + p["K_2x"] * p["b_2"] ** 2) / p["J_c"]
    assert found == pytest.approx(sorted(np.sqrt([*sway, yaw])), rel=1e-7)


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_shift_and_yaw_of_the_whole_vehicle_meet_no_force(moving, kind):
    """Without conicity, load and creep; roll meets that of its springs alone."""
    p = {**moving(kind).p, "lambda": 0.0, "W": 0.0}
    vehicle = vehicle_of({**p, "f_11": 1e-9, "f_22": 1e-9}, kind)
    matrix, names = state_matrix(vehicle), vehicle.state_space.coordinates
    places = {"2": -p["l_c"], "1": p["l_c"], "": 0.0}
    ahead = {"w": p["a"], "m": p.get("a_0"), "b": 0.0}
    shift, yaw = np.zeros(len(matrix)), np.zeros(len(matrix))
    for i, name in enumerate(names):
        quantity, _, body = name.partition("_")
        letter, ends = body.rstrip("12"), body[len(body.rstrip("12")) :]
        inner = 0.0 if letter in "cb" else ahead[letter] * (1 if ends[-1] == "1" else -1)
        x = 0.0 if letter == "c" else places[ends[:1]] + inner
        shift[i] = quantity == "y"
        yaw[i] = {"y": x, "phi": 1.0, "psi": 1.0, "th": 0.0}[quantity]
    for motion in (shift, yaw):
        # Strokes of the dampers follow: those of dampers that nothing displaces are zero.
        assert np.abs(matrix @ motion).max() < 1e-9 * np.abs(matrix).max()
    weight = np.zeros(len(matrix))
    weight[names.index("th_c")] = 1.0
    assert np.abs(matrix @ weight).max() > 1


def test_a_very_heavy_car_body_leaves_two_bogies(moving):
    vehicle = moving(M_c=1e15, J_c=1e15, I_c=1e15)
    s, alone = eigenvalues(vehicle), eigenvalues(vehicle.bogie)
    assert len(s) == 2 * len(alone) + 6
    body = np.abs(s) < 1e-3
    assert body.sum() == 6
    left = list(s[~body])
    for x in alone:
        for _ in range(2):
            nearest = min(range(len(left)), key=lambda k: abs(left[k] - x))
            assert abs(left.pop(nearest) - x) < 1e-6 * max(1, abs(x))
    assert not left


def without_a_damper(*bogies):
    return Case(
        "a yaw damper lost", tuple(Change(f"{b}.{key}", 0.5, share=True) for b in bogies for key in ("C_s", "K_ds"))
    )


def least_damping(s):
    s = s[np.abs(s.imag) > 1e-6]
    return float(np.min(-s.real / np.abs(s)))


@pytest.mark.parametrize(
    ("conicity", "bogie", "expected"),
    [
        (0.15, None, 0.0336),
        (0.15, "leading", 0.0186),
        (0.15, "trailing", 0.0403),
        (0.10, "leading", -0.022),
        (0.10, "trailing", 0.017),
    ],
)
def test_one_yaw_damper_lost(moving, independent, conicity, bogie, expected):
    vehicle = moving(C_s=1.047e6, **{"lambda": conicity})
    faulty = vehicle.with_fault(without_a_damper(bogie)) if bogie else vehicle
    digits = 5e-5 if conicity == 0.15 else 5e-4
    assert least_damping(eigenvalues(faulty)) == pytest.approx(expected, abs=digits)
    own = {f"{bogie}.{name}": vehicle.p[name] / 2 for name in ("C_s", "K_ds")} if bogie else {}
    second = np.array(independent.equations("power", {**vehicle.p, **own}).state_matrix(), dtype=float)
    assert least_damping(np.linalg.eigvals(second)) == pytest.approx(least_damping(eigenvalues(faulty)), rel=1e-8)


def test_hunting_of_the_trailing_bogie_without_a_damper_is_not_its_sway(moving):
    s = eigenvalues(moving(C_s=1.047e6).with_fault(without_a_damper("trailing")))
    least = sorted(-x.real / abs(x) for x in s if x.imag > 1e-6)[:2]
    assert least == pytest.approx([0.0403, 0.0431], abs=5e-5)


def test_a_damper_lost_at_both_is_a_fault_of_both(moving):
    vehicle = moving(C_s=1.047e6)
    one, other = (vehicle.with_fault(without_a_damper(*x)) for x in (("leading", "trailing"), ()))
    half = vehicle.replace(C_s=vehicle.C_s / 2, K_ds=vehicle.p["K_ds"] / 2)
    assert np.allclose(eigenvalues(one), eigenvalues(half), rtol=1e-8, atol=1e-8)
    assert np.allclose(eigenvalues(other), eigenvalues(vehicle))


def test_coefficients_of_50_vehicles(random_vehicles, rational_vehicle, car_body):
    """Those in double precision beside those in exact rationals, for every motion and power of C_s."""
    rng, worst = np.random.default_rng(7), 0.0
    for drawn in random_vehicles(50, spread=3.0, seed=7):
        kind = drawn.model.kind
        body = {name: x * 2.0 ** rng.uniform(-1, 1) for name, x in car_body.items()}
        own = {name: x for name, x in drawn.p.items() if kind == "power" or name not in MOTOR}
        vehicle = vehicle_of({**own, **body, "C_s": 1e6}, kind)
        exact = rational_vehicle(vehicle)
        assert len(vehicle.coupled.coefficients) == 3
        for one, other in zip(vehicle.motions, exact.motions, strict=True):
            for p, q in zip(one.coefficients, other.coefficients, strict=True):
                assert len(p) == len(q)
                known = [(Fraction(a), Fraction(int(b.p), int(b.q))) for a, b in zip(p, q, strict=True) if b != 0]
                worst = max(worst, *(float(abs(a / b - 1)) for a, b in known))
    assert 0 < worst < 1e-12, worst

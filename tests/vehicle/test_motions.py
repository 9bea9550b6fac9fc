"""The characteristic polynomial against the paper's 22 x 22 matrix (7), exact arithmetic and eigenvalues."""

from dataclasses import replace
from fractions import Fraction

import casadi as ca
import flint
import numpy as np
import pytest

from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.elements import Dashpot, Link, Mass, Maxwell, Spring, folded
from yawdesign.vehicle.motions import COUPLED, motions, polynomials
from yawdesign.vehicle.polynomials import evaluate, product, scale_variable, trim
from yawdesign.vehicle.state_space import fill
from yawdesign.vehicle.vehicle import Model


def paper_matrix(vehicle, s):
    """Return the matrix (7) of the paper, typed from its kappas; without motors, their rows and columns are struck out.

    kappa_11 to kappa_13 are not defined in the paper; and the motors' yaw reaction on the frame, which it lacks, is
    added for the reciprocal equations (docs/errata.md).
    """
    p, model = vehicle.p, vehicle.model
    k = kappas(p, vehicle.C_s, s)
    if model.kind == "trailer":
        k["0"] -= 2 * p["K_dm"] + 2 * p["K_m"]
        k["5"] -= 2 * p["K_dm"] * p["a_0"] ** 2 + 2 * p["K_m"] * p["a_0"] ** 2
    elif model.equations == "reciprocal":
        k["5"] += 2 * (p["K_mphi"] + p["C_mphi"] * s)
        k["motor_yaw"] = k["21"]
    rows = [line.split() for line in PAPER_MATRIX.strip().splitlines()]
    keep = [i for i in range(22) if model.kind == "power" or i not in (*range(6, 10), *range(14, 18))]
    return [[0 if rows[i][j] == "." else k[rows[i][j]] for j in keep] for i in keep]


# y_b phi_b | y_w1 phi_w1 y_w2 phi_w2 | y_m1 phi_m1 y_m2 phi_m2 | x_s1 ... x_s4 | y_e1 ... y_e4 | y_d1 ... y_d4;
# R: the column of the motor's yaw in the row of phi_b, empty in the paper.
PAPER_MATRIX = """
0  .   1  .  1  .   2  .  2  .   .  .  .  .   3  .  3  .   4  .  4  .
.  5   6  7  8  7   9  R  10 R   .  11 .  11  12 .  13 .   14 .  15 .
1  6   16 17 .  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .
.  7   18 19 .  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .
1  8   .  .  16 17  .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .
.  7   .  .  18 19  .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .
2  9   .  .  .  .   20 .  .  .   .  .  .  .   .  3  .  .   .  .  .  .
.  21  .  .  .  .   .  22 .  .   .  .  .  .   .  .  .  .   .  .  .  .
2  10  .  .  .  .   .  .  20 .   .  .  .  .   .  .  .  3   .  .  .  .
.  21  .  .  .  .   .  .  .  22  .  .  .  .   .  .  .  .   .  .  .  .
.  .   .  .  .  .   .  .  .  .   23 24 .  .   .  .  .  .   .  .  .  .
.  11  .  .  .  .   .  .  .  .   24 23 .  .   .  .  .  .   .  .  .  .
.  .   .  .  .  .   .  .  .  .   .  .  23 24  .  .  .  .   .  .  .  .
.  11  .  .  .  .   .  .  .  .   .  .  24 23  .  .  .  .   .  .  .  .
3  12  .  .  .  .   .  .  .  .   .  .  .  .   25 26 .  .   .  .  .  .
.  .   .  .  .  .   3  .  .  .   .  .  .  .   26 25 .  .   .  .  .  .
3  13  .  .  .  .   .  .  .  .   .  .  .  .   .  .  25 26  .  .  .  .
.  .   .  .  .  .   .  .  3  .   .  .  .  .   .  .  26 25  .  .  .  .
.  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .   27 28 .  .
4  14  .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .   28 27 .  .
.  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  27 28
4  15  .  .  .  .   .  .  .  .   .  .  .  .   .  .  .  .   .  .  28 27
""".replace("R", "motor_yaw")


def kappas(p, C_s, s):
    K_1x, K_1y, K_2x, K_2y, K_m, K_mphi = (p[n] for n in ("K_1x", "K_1y", "K_2x", "K_2y", "K_m", "K_mphi"))
    K_ds, K_dt, K_dm, C_t, C_m, C_mphi = (p[n] for n in ("K_ds", "K_dt", "K_dm", "C_t", "C_m", "C_mphi"))
    a, b, a_0, b_0, b_1, b_2, b_3, r = (p[n] for n in ("a", "b", "a_0", "b_0", "b_1", "b_2", "b_3", "r"))
    W, cone, f_11, f_22, v = (p[n] for n in ("W", "lambda", "f_11", "f_22", "v"))
    return {
        "0": p["M_b"] * s**2 + 2 * K_1y + K_2y + 2 * K_dm + 2 * K_dt + 2 * K_m,
        "1": -K_1y,
        "2": -K_m,
        "3": -K_dm,
        "4": -K_dt,
        "5": 2 * K_1y * a**2 + 2 * K_dm * a_0**2 + 2 * K_m * a_0**2 + 2 * K_1x * b_1**2 + K_2x * b_2**2
        + 2 * K_ds * b_3**2 + 2 * K_dt * b_0**2 + p["J_b"] * s**2,
        "6": -K_1y * a,
        "7": -K_1x * b_1**2,
        "8": K_1y * a,
        "9": -K_m * a_0,
        "10": K_m * a_0,
        "11": -K_ds * b_3,
        "12": -K_dm * a_0,
        "13": K_dm * a_0,
        "14": -K_dt * b_0,
        "15": K_dt * b_0,
        "16": p["M_w"] * s**2 + 2 * f_11 * s / v + K_1y + W * cone / b,
        "17": -2 * f_11,
        "18": 2 * b * f_22 * cone / r,
        "19": 2 * f_22 * b**2 * s / v - W * cone * b + K_1x * b_1**2 + p["J_w"] * s**2,
        "20": p["M_m"] * s**2 + K_dm + K_m,
        "21": -K_mphi - C_mphi * s,
        "22": p["J_m"] * s**2 + C_mphi * s + K_mphi,
        "23": K_ds + C_s * s / 2,
        "24": -C_s * s / 2,
        "25": K_dm + C_m * s,
        "26": -C_m * s,
        "27": -C_t * s / 2,
        "28": K_dt + C_t * s / 2,
        "motor_yaw": 0,
    }  # fmt: skip


def test_equals_the_determinant_of_matrix_7(table1, vehicle_model, rational_vehicle, random_vehicles):
    # Two polynomials of degree 26 that agree at 30 points are the same polynomial: no tolerance is needed.
    drawn = (vehicle_model.at(vehicle.p, C_s=3e5) for vehicle in random_vehicles(3, spread=10, seed=7))
    for vehicle in map(rational_vehicle, [vehicle_model.at(table1, C_s=1e6), *drawn]):
        down = vehicle.paper_coefficients()
        for k in range(30):
            s = flint.fmpq(7 * k - 60, 3)
            assert evaluate(down[::-1], s) == flint.fmpq_mat(paper_matrix(vehicle, s)).det()


def test_equals_the_determinant_of_matrix_7_in_floating_point(random_vehicles):
    rng, worst = np.random.default_rng(3), 0.0
    for drawn in random_vehicles(60, seed=11):
        vehicle, s = drawn.replace(C_s=10 ** rng.uniform(4, 7)), complex(*rng.normal(scale=100, size=2))
        value = evaluate(vehicle.paper_coefficients()[::-1], s)
        # Rows are scaled to order one, so that the product of their sizes does not overflow.
        matrix = np.array(paper_matrix(vehicle, s))
        size = np.abs(matrix).max(axis=1)
        ratio = np.linalg.det(matrix / size[:, None]) / (value / np.prod(size))
        worst = max(worst, abs(ratio - 1))
    assert worst < 1e-10


COORDINATES = ("y_b", "phi_b", "y_w1", "phi_w1", "y_w2", "phi_w2", "y_m1", "phi_m1", "y_m2", "phi_m2")


def our_compliance(vehicle, s):
    """Return the displacements that unit forces cause, by the polynomial matrix and by the state matrix."""
    system, entries = vehicle.state_space, polynomial_matrix(vehicle.physical)
    rows = list(dict.fromkeys([*system.coordinates, *(i for i, _ in entries)]))
    matrix = np.zeros((len(rows), len(rows)), dtype=complex)
    for (i, j), polynomial in entries.items():
        matrix[rows.index(i), rows.index(j)] = evaluate(polynomial, s)
    order = [system.coordinates.index(x) for x in COORDINATES if x in system.coordinates]
    masses = {e.coordinate: e.m for e in vehicle.physical if isinstance(e, Mass)}
    n = len(masses)
    push = np.zeros((system.size, n))
    push[n : 2 * n] = np.diag([1 / masses[x] for x in system.coordinates])
    state = np.linalg.solve(s * np.eye(system.size) - fill(system.A, np.zeros((system.size,) * 2)), push)
    pick = np.ix_(order, order)
    return np.linalg.inv(matrix)[pick], state[pick]


def test_displacements_under_forces_are_those_of_matrix_7(table1, vehicle_model, random_vehicles):
    # The determinant does not see the sign of a displacement; responses do.
    rng = np.random.default_rng(13)
    for p in [table1, *(drawn.p for drawn in random_vehicles(10, seed=13))]:
        vehicle = vehicle_model.at(p, C_s=10 ** rng.uniform(4, 7))
        s = complex(*rng.normal(scale=50, size=2))
        n = 10 if vehicle_model.kind == "power" else 6
        expected = np.linalg.inv(np.array(paper_matrix(vehicle, s)))[:n, :n]
        size = np.sqrt(np.abs(np.outer(expected.diagonal(), expected.diagonal())))
        for found in our_compliance(vehicle, s):
            assert np.max(np.abs(found - expected) / size) < 1e-9


def test_without_yaw_damping_there_is_no_yaw_damper(table1):
    assert Model().at(table1).state_space.size == 24


def test_chi_are_27_and_the_last_does_not_know_the_damper(table1, vehicle_model):
    n = 26 if vehicle_model.kind == "power" else 16
    one, two = (vehicle_model.at(table1, C_s=C_s).paper_coefficients() for C_s in (1e5, 1e6))
    assert len(one) == len(two) == n + 1
    assert all(x > 0 for x in one + two)
    assert one[-1] == two[-1]
    assert all(x != y for x, y in zip(one[:-1], two[:-1], strict=True))


def test_chi_in_another_unit_of_time(table1):
    vehicle = Model().at(table1, C_s=1e6)
    plain, scaled = vehicle.paper_coefficients(), vehicle.paper_coefficients(unit=100.0)
    assert scaled == pytest.approx([x * 100.0 ** (26 - k) for k, x in enumerate(plain)], rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "equations", "degree", "names"),
    [
        ("power", "as-printed", 21, {"motors yawing against each other", "motors yawing together"}),
        ("power", "reciprocal", 23, {"motors yawing against each other"}),
        ("trailer", "reciprocal", 15, set()),
    ],
)
def test_degrees_and_factors(table1, kind, equations, degree, names):
    vehicle = Model(kind, equations).at(table1, C_s=1e6)
    coupled, *others = vehicle.motions
    assert coupled is vehicle.coupled
    assert coupled.varied
    assert len(coupled.polynomial(1e6)) - 1 == degree
    A, B = coupled.coefficients
    assert len(A) == degree
    assert len(B) == degree + 1
    assert {motion.name for motion in others} == names
    for motion in others:
        assert not motion.varied
        assert motion.polynomial(1e6) == pytest.approx((table1["K_mphi"], table1["C_mphi"], table1["J_m"]))
    assert len(vehicle.polynomial) - 1 == (15 if kind == "trailer" else 25)


def relative_error(float_polynomial, exact_polynomial):
    worst = 0.0
    for x, y in zip(float_polynomial, exact_polynomial, strict=True):
        if y == 0:
            assert x == 0
        else:
            exact_x = flint.fmpq(*float(x).as_integer_ratio())
            worst = max(worst, abs(float(flint.arb(exact_x / y - 1).mid())))
    return worst


@pytest.mark.slow
def test_every_coefficient_is_right_to_the_last_digits(random_vehicles, rational_vehicle):
    worst = 0.0
    for vehicle in random_vehicles(300, spread=100, seed=5):
        for floats, exact in zip(vehicle.motions, rational_vehicle(vehicle).motions, strict=True):
            assert floats.name == exact.name
            polynomials = zip(floats.coefficients, exact.coefficients, strict=True)
            worst = max(worst, *(relative_error(x, y) for x, y in polynomials))
    # Gravity softens the wheelset's yaw: the only subtraction of the model.
    assert worst < 1e-12


def test_roots_are_the_eigenvalues(random_vehicles, rational_vehicle, exact_roots):
    for drawn in random_vehicles(25, seed=2):
        vehicle = drawn.replace(C_s=3e5)
        expected = exact_roots(rational_vehicle(vehicle).polynomial)
        found = np.linalg.eigvals(state_matrix(vehicle))
        assert len(found) == len(expected)
        # The double root of the model as printed is known to half the digits only.
        distance = np.abs(found[:, None] - expected[None, :])
        assert np.all(distance.min(axis=1) < 1e-5 * (1 + np.abs(found)))
        assert np.all(distance.min(axis=0) < 1e-5 * (1 + np.abs(expected)))


def test_any_number_type(table1, vehicle_model, rational):
    symbols = {name: ca.SX.sym(name) for name in table1}
    stacks = {name: np.array([value, 2 * value]) for name, value in table1.items()}
    fractions = {name: Fraction(value) for name, value in table1.items()}
    kinds = [vehicle_model.at(p).motions for p in (table1, stacks, symbols, rational(table1), fractions)]
    for plain, stacked, graph, exact, fraction in zip(*kinds, strict=True):
        assert {plain.name} == {motion.name for motion in (stacked, graph, exact, fraction)}
        assert {plain.coordinates} == {motion.coordinates for motion in (stacked, graph, exact, fraction)}
        for power, floats in enumerate(plain.coefficients):
            function = ca.Function("f", [*symbols.values()], [ca.vertcat(*map(ca.SX, graph.coefficients[power]))])
            assert np.array(function(*table1.values())).ravel() == pytest.approx(floats, rel=1e-14)
            assert [np.ravel(x)[0] for x in stacked.coefficients[power]] == pytest.approx(floats, rel=1e-14)
            assert [float(flint.arb(x).mid()) for x in exact.coefficients[power]] == pytest.approx(floats, rel=1e-13)
            assert [flint.fmpq(x.numerator, x.denominator) for x in fraction.coefficients[power]] == [
                *map(flint.fmpq, exact.coefficients[power])
            ]


def test_the_graph_stays_small(table1):
    symbols = {name: ca.SX.sym(name) for name in table1}
    core = scale_variable(Model().at(symbols).coupled.polynomial(ca.SX.sym("C_s")), 100.0)
    inputs = [*symbols.values(), *(x for x in ca.symvar(ca.vertcat(*core)) if x.name() == "C_s")]
    assert ca.Function("core", inputs, [ca.vertcat(*core)]).n_nodes() < 2000


def test_matrix_7_is_complete():
    rows = [line.split() for line in PAPER_MATRIX.strip().splitlines()]
    assert [len(row) for row in rows] == [22] * 22
    assert {x for row in rows for x in row if x.isdigit()} == {str(k) for k in range(29)}


def test_two_yaw_dampers_make_a_motion_of_the_second_degree(two_frames, exact_determinant):
    coupled, apart = motions(two_frames(0))
    assert (coupled.name, coupled.coordinates) == (COUPLED, {"front", "rear", "body"})
    assert len(coupled.coefficients) == 3
    assert (apart.name, apart.coordinates, len(apart.coefficients)) == ("apart", {"apart"}, 1)
    # Two polynomials in s of degree 12 that agree at 13 points are the same, and so in C_s at three.
    for C_s in (Fraction(0), Fraction(3, 7), Fraction(1000), Fraction(-1, 50)):
        elements = two_frames(C_s)
        assert motions(elements) == (coupled, apart)  # the damping itself is not looked at
        whole = product([coupled.polynomial(C_s), apart.polynomial(C_s)])
        assert len(whole) <= 13
        for k in range(13):
            s = Fraction(2 * k - 11, 5)
            assert evaluate(whole, s) == exact_determinant(elements, s)


def test_two_yaw_dampers_with_floats(two_frames, rational):
    for exact, floats in zip(motions(two_frames(0)), motions(two_frames(0, float)), strict=True):
        for p, q in zip(exact.coefficients, floats.coefficients, strict=True):
            assert q == pytest.approx([float(x) for x in p], rel=1e-14)


def test_two_bogies_under_one_car_body(two_bogies, exact_determinant):
    (coupled,) = motions(folded(two_bogies(0)))
    assert len(coupled.coefficients) == 3
    for C_s in (0, 5, 10**6):
        elements, p = folded(two_bogies(C_s)), coupled.polynomial(Fraction(C_s))
        assert all(evaluate(p, Fraction(s)) == exact_determinant(elements, Fraction(s)) for s in range(1, len(p) + 1))


def test_degrees_in_the_yaw_damping(table1, vehicle_model):
    coupled, *others = vehicle_model.at(table1).motions
    assert len(coupled.coefficients) == 2
    assert all(len(motion.coefficients) == 1 for motion in others)


def test_the_yaw_damping_of_the_vehicle_does_not_enter_its_motions(table1, vehicle_model, rational_vehicle):
    vehicle = rational_vehicle(vehicle_model.at(table1))
    assert vehicle.motions == vehicle.replace(C_s=flint.fmpq(1_000_000)).motions


@pytest.mark.parametrize("names", [("yaw damper 1", "yaw damper 1"), ("lateral damper", "yaw damper 2")])
def test_two_dampers_of_one_name_are_refused(two_frames, names):
    renamed = dict(zip(("yaw damper 1", "yaw damper 2"), names, strict=True))
    elements = [replace(e, name=renamed.get(e.name, e.name)) if isinstance(e, Link) else e for e in two_frames(1)]
    with pytest.raises(ValueError, match=f"two parts are called {names[0]}"):
        motions(elements)


def test_a_yaw_damper_without_a_name_is_refused(two_frames):
    elements = [replace(e, name="") if isinstance(e, Link) and e.varied else e for e in two_frames(1)]
    with pytest.raises(ValueError, match="no name, at front, body"):
        motions(elements)


@pytest.mark.parametrize("laws", [(Spring(4),), (Maxwell(3, 2), Spring(4)), (Maxwell(3, 2), Maxwell(3, 2))])
def test_a_yaw_damper_is_one_damper_in_series_with_a_spring(two_frames, laws):
    elements = [replace(e, laws=laws) if isinstance(e, Link) and e.varied else e for e in two_frames(1)]
    with pytest.raises(ValueError, match="yaw damper 1 must be one damper"):
        motions(elements)


BODY = {"M_c": 34500.0, "J_c": 1.521e6, "I_c": 124304.0, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97, "K_2z": 610e3}
BODY |= {"C_2z": 9800.0}


def with_car_body(vehicle, rng, spread, C_s):
    """Return a vehicle with a car body on two bogies such as a given one."""
    body = {name: value * spread ** rng.uniform(-1, 1) for name, value in BODY.items()}
    p = {**vehicle.p, **body, "C_s": C_s}
    return Model(vehicle.model.kind, parameters=tuple(p)).at(p)


@pytest.mark.parametrize("number", [3, pytest.param(50, marks=pytest.mark.slow)])
def test_polynomials_at_the_yaw_damping_of_a_vehicle_are_exact(number, random_vehicles, rational_vehicle):
    rng, worst = np.random.default_rng(17), 0.0
    for drawn in random_vehicles(number, spread=3, seed=number):
        vehicle = with_car_body(drawn, rng, 3.0, 10 ** rng.uniform(3, 8))
        exact = rational_vehicle(vehicle)
        assert list(exact.polynomials) == [motion.name for motion in exact.motions]
        for motion in exact.motions:
            assert exact.polynomials[motion.name] == motion.polynomial(exact.C_s)
            worst = max(worst, relative_error(vehicle.polynomials[motion.name], exact.polynomials[motion.name]))
    assert worst < 1e-12


def test_polynomials_at_the_yaw_damping_of_a_bogie_are_exact(random_vehicles, rational_vehicle):
    for drawn in random_vehicles(30, spread=10, seed=18):
        vehicle = drawn.replace(C_s=3e5)
        exact = rational_vehicle(vehicle)
        for motion in exact.motions:
            assert exact.polynomials[motion.name] == motion.polynomial(exact.C_s)
            assert relative_error(vehicle.polynomials[motion.name], exact.polynomials[motion.name]) < 1e-12


@pytest.mark.parametrize(("body", "most"), [({}, 1600), (BODY, 14000)], ids=["bogie", "vehicle"])
def test_the_graph_at_one_yaw_damping_is_smaller_than_that_by_powers(table1, body, most):
    p = {name: ca.SX.sym(name) for name in {**table1, **body, "C_s": 0}}
    vehicle = Model(parameters=tuple(p)).at(p)

    def operations(found):
        return ca.Function("f", [*p.values()], [ca.vertcat(*(ca.SX(a) for q in found for a in q))]).n_instructions()

    own = operations(vehicle.polynomials.values())
    assert own < most
    assert own < operations(motion.polynomial(vehicle.C_s) for motion in vehicle.motions)


def test_no_yaw_damping_is_a_damping_too(table1):
    vehicle = Model().at(table1, C_s=0.0)
    for motion in vehicle.motions:
        at_zero = trim(motion.polynomial(0.0))
        assert trim(vehicle.polynomials[motion.name]) == pytest.approx(at_zero, rel=1e-13)


def test_a_rigidly_mounted_yaw_damper_is_the_limit_of_stiff_joints(two_frames, exact_determinant):
    def mounted(law, C_s):
        return [replace(e, laws=(law,)) if isinstance(e, Link) and e.varied else e for e in two_frames(C_s)]

    C_s = Fraction(5, 3)
    elements = mounted(Dashpot(C_s), C_s)
    for motion in motions(elements):
        assert trim(polynomials(elements)[motion.name]) == trim(motion.polynomial(C_s))
    for k in range(13):
        s = Fraction(2 * k - 11, 5)
        assert evaluate(product(polynomials(elements).values()), s) == exact_determinant(elements, s)
    stiff = polynomials(mounted(Maxwell(Fraction(10) ** 30, C_s), C_s))[COUPLED]
    rigid = polynomials(elements)[COUPLED]
    assert [float(a) for a in stiff[: len(rigid)]] == pytest.approx([float(a) for a in rigid], rel=1e-12)

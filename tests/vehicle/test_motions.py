"""The characteristic polynomial against the paper's 22 x 22 matrix (7), exact arithmetic and eigenvalues."""

import casadi as ca
import flint
import numpy as np
import pytest

from yawdesign.hunting.old import state_matrix
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.elements import Mass
from yawdesign.vehicle.old import StateSpace, bogie, characteristic, paper_coefficients, physical
from yawdesign.vehicle.polynomials import evaluate, scale_variable


def paper_matrix(p, C_s, s, kind, equations):
    """Return the matrix (7) of the paper, typed from its kappas; without motors, their rows and columns are struck out.

    kappa_11 to kappa_13 are not defined in the paper; and the motors' yaw reaction on the frame, which it lacks, is
    added for the reciprocal equations (docs/errata.md).
    """
    k = kappas(p, C_s, s)
    if kind == "trailer":
        k["0"] -= 2 * p["K_dm"] + 2 * p["K_m"]
        k["5"] -= 2 * p["K_dm"] * p["a_0"] ** 2 + 2 * p["K_m"] * p["a_0"] ** 2
    elif equations == "reciprocal":
        k["5"] += 2 * (p["K_mphi"] + p["C_mphi"] * s)
        k["motor_yaw"] = k["21"]
    rows = [line.split() for line in PAPER_MATRIX.strip().splitlines()]
    keep = [i for i in range(22) if kind == "power" or i not in (*range(6, 10), *range(14, 18))]
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


def exact_bogies(rational, random_bogies, table1, model):
    yield rational({**table1, "C_s": 1e6})
    for p, _ in random_bogies(3, spread=10, seed=7):
        yield rational({**p, "C_s": 3e5})


def test_equals_the_determinant_of_matrix_7(table1, model, rational, random_bogies):
    # Two polynomials of degree 26 that agree at 30 points are the same polynomial: no tolerance is needed.
    for p in exact_bogies(rational, random_bogies, table1, model):
        down = paper_coefficients(p, p["C_s"], **model)
        for k in range(30):
            s = flint.fmpq(7 * k - 60, 3)
            expected = flint.fmpq_mat(paper_matrix(p, p["C_s"], s, **model)).det()
            assert evaluate(down[::-1], s) == expected


def test_equals_the_determinant_of_matrix_7_in_floating_point(random_bogies):
    rng, worst = np.random.default_rng(3), 0.0
    for p, model in random_bogies(60, seed=11):
        C_s, s = 10 ** rng.uniform(4, 7), complex(*rng.normal(scale=100, size=2))
        value = evaluate(paper_coefficients(p, C_s, **model)[::-1], s)
        # Rows are scaled to order one, so that the product of their sizes does not overflow.
        matrix = np.array(paper_matrix(p, C_s, s, **model))
        size = np.abs(matrix).max(axis=1)
        ratio = np.linalg.det(matrix / size[:, None]) / (value / np.prod(size))
        worst = max(worst, abs(ratio - 1))
    assert worst < 1e-10


COORDINATES = ("y_b", "phi_b", "y_w1", "phi_w1", "y_w2", "phi_w2", "y_m1", "phi_m1", "y_m2", "phi_m2")


def our_compliance(p, C_s, s, model):
    """Return the displacements that unit forces cause, by the polynomial matrix and by the state matrix."""
    elements = physical(bogie({**p, "C_s": C_s}, **model))
    system, entries = StateSpace(elements), polynomial_matrix(elements)
    rows = list(dict.fromkeys([*system.coordinates, *(i for i, _ in entries)]))
    matrix = np.zeros((len(rows), len(rows)), dtype=complex)
    for (i, j), polynomial in entries.items():
        matrix[rows.index(i), rows.index(j)] = evaluate(polynomial, s)
    order = [system.coordinates.index(x) for x in COORDINATES if x in system.coordinates]
    masses = {e.coordinate: e.m for e in elements if isinstance(e, Mass)}
    n = len(masses)
    push = np.zeros((system.size, n))
    push[n : 2 * n] = np.diag([1 / masses[x] for x in system.coordinates])
    state = np.linalg.solve(s * np.eye(system.size) - system.fill(np.zeros((system.size,) * 2)), push)
    pick = np.ix_(order, order)
    return np.linalg.inv(matrix)[pick], state[pick]


def test_displacements_under_forces_are_those_of_matrix_7(table1, model, random_bogies):
    # The determinant does not see the sign of a displacement; responses do.
    rng = np.random.default_rng(13)
    for p in [table1, *(q for q, _ in random_bogies(10, seed=13))]:
        C_s, s = 10 ** rng.uniform(4, 7), complex(*rng.normal(scale=50, size=2))
        n = 10 if model["kind"] == "power" else 6
        expected = np.linalg.inv(np.array(paper_matrix(p, C_s, s, **model)))[:n, :n]
        size = np.sqrt(np.abs(np.outer(expected.diagonal(), expected.diagonal())))
        for found in our_compliance(p, C_s, s, model):
            assert np.max(np.abs(found - expected) / size) < 1e-9


def test_without_yaw_damping_there_is_no_yaw_damper(table1):
    assert StateSpace(physical(bogie(table1))).size == 24


def test_chi_are_27_and_the_last_does_not_know_the_damper(table1, model):
    n = 26 if model["kind"] == "power" else 16
    one, two = (paper_coefficients(table1, C_s, **model) for C_s in (1e5, 1e6))
    assert len(one) == len(two) == n + 1
    assert all(x > 0 for x in one + two)
    assert one[-1] == two[-1]
    assert all(x != y for x, y in zip(one[:-1], two[:-1], strict=True))


def test_chi_in_another_unit_of_time(table1):
    plain, scaled = paper_coefficients(table1, 1e6), paper_coefficients(table1, 1e6, unit=100.0)
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
    c = characteristic(table1, kind=kind, equations=equations)
    assert len(c.core(1e6)) - 1 == degree
    assert len(c.A) == degree
    assert len(c.B) == degree + 1
    assert set(c.factors) == names
    for factor in c.factors.values():
        assert factor == pytest.approx((table1["K_mphi"], table1["C_mphi"], table1["J_m"]))
    assert len(c.full(1e6)) - 1 == (15 if kind == "trailer" else 25)


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
def test_every_coefficient_is_right_to_the_last_digits(random_bogies, rational):
    worst = 0.0
    for p, model in random_bogies(300, spread=100, seed=5):
        floats, exact = characteristic(p, **model), characteristic(rational(p), **model)
        polynomials = [(floats.A, exact.A), (floats.B, exact.B)]
        polynomials += zip(floats.factors.values(), exact.factors.values(), strict=True)
        worst = max(worst, *(relative_error(x, y) for x, y in polynomials))
    # Gravity softens the wheelset's yaw: the only subtraction of the model.
    assert worst < 1e-12


def test_roots_are_the_eigenvalues(random_bogies, rational, exact_roots):
    for p, model in random_bogies(25, seed=2):
        C_s = 3e5
        expected = exact_roots(characteristic(rational(p), **model).full(flint.fmpq(300_000)))
        found = np.linalg.eigvals(state_matrix(p, C_s, **model))
        assert len(found) == len(expected)
        # The double root of the model as printed is known to half the digits only.
        distance = np.abs(found[:, None] - expected[None, :])
        assert np.all(distance.min(axis=1) < 1e-5 * (1 + np.abs(found)))
        assert np.all(distance.min(axis=0) < 1e-5 * (1 + np.abs(expected)))


def test_any_number_type(table1, model, rational):
    floats = characteristic(table1, **model)
    exact = characteristic(rational(table1), **model)
    stacked = characteristic({name: np.array([value, 2 * value]) for name, value in table1.items()}, **model)
    symbols = {name: ca.SX.sym(name) for name in table1}
    graph = characteristic(symbols, **model)
    for which in ("A", "B"):
        plain = np.array([float(x) for x in getattr(floats, which)])
        function = ca.Function("f", list(symbols.values()), [ca.vertcat(*map(ca.SX, getattr(graph, which)))])
        assert np.array(function(*table1.values())).ravel() == pytest.approx(plain, rel=1e-14)
        assert [np.ravel(x)[0] for x in getattr(stacked, which)] == pytest.approx(plain, rel=1e-14)
        assert [float(flint.arb(x).mid()) for x in getattr(exact, which)] == pytest.approx(plain, rel=1e-13)


def test_the_graph_stays_small(table1):
    symbols = {name: ca.SX.sym(name) for name in table1}
    core = scale_variable(characteristic(symbols).core(ca.SX.sym("C_s")), 100.0)
    inputs = [*symbols.values(), *(x for x in ca.symvar(ca.vertcat(*core)) if x.name() == "C_s")]
    assert ca.Function("core", inputs, [ca.vertcat(*core)]).n_nodes() < 2000


def test_matrix_7_is_complete():
    rows = [line.split() for line in PAPER_MATRIX.strip().splitlines()]
    assert [len(row) for row in rows] == [22] * 22
    assert {x for row in rows for x in row if x.isdigit()} == {str(k) for k in range(29)}

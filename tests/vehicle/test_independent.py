"""The vehicle is that of the equations written a second time (independent.py), by eigenvalues and polynomials."""

import itertools

import flint
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.eigenvalues import dense, state_matrix
from yawdesign.problem.cases import SHARE
from yawdesign.vehicle.elements import WheelRailContact
from yawdesign.vehicle.vehicle import Model

MOTOR = ("M_m", "J_m", "K_m", "K_mphi", "K_dm", "C_mphi", "C_m", "a_0")
# What a vehicle may have beside the paper's bogie, and values like those of real ones.
BODY = {"M_c": 34.5e3, "J_c": 1.521e6, "I_c": 124304.0, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97}
VERTICAL = {"K_2z": 0.61e6, "C_2z": 9.8e3}
ROLL = {"I_b": 3e3, "K_1z": 1.2e6, "C_1z": 10e3, "h_1": 0.1, "h_2": 0.2, "h_2t": -0.15}
PRIMARY = {"C_1x": 20e3, "C_1y": 30e3, "K_d1x": 10e6, "K_d1y": 12e6}
BOTH = ("M_b", "K_1x", "K_2y", "C_t", "a", "f_22", "K_ds", "lambda", "b_3")
FLAGS = ("overturning", "no gravitational stiffness")


def vehicle_parameters(table1, kind, parts):
    """Return the parameters of a vehicle with some parts: ``body``, ``roll``, ``primary``, ``spin``."""
    p = {name: x for name, x in table1.items() if kind == "power" or name not in MOTOR}
    p |= BODY if "body" in parts else {}
    p |= ROLL if "roll" in parts else {}
    p |= VERTICAL if {"body", "roll"} & {*parts} else {}
    p |= PRIMARY if "primary" in parts else {}
    p |= {"J_wy": 180.0} if "spin" in parts else {}
    return {**p, "C_s": 1e6}


def model_of(kind, p, flags):
    return Model(kind, "reciprocal", tuple(p), frozenset(flags))


def difference(found, expected):
    """Return the largest distance of two spectra, one root to one, relative to each root's size."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert len(found) == len(expected)
    apart = np.abs(found[:, None] - expected) / np.maximum(1, np.abs(expected))
    return apart[linear_sum_assignment(apart)].max()


def accurate_roots(A):
    """Return the eigenvalues of a matrix of floats, right to the last digit."""
    flint.ctx.prec, before = 400, flint.ctx.prec
    try:
        matrix = flint.acb_mat([[flint.acb(float(x)) for x in row] for row in A])
        return np.array([complex(x.mid()) for x in matrix.eig(algorithm="approx")])
    finally:
        flint.ctx.prec = before


def exactly(p):
    return {name: flint.fmpq(*float(x).as_integer_ratio()) for name, x in p.items()}


def characteristic_at(A, size, s):
    """Return the determinant of s - A, a rational number."""
    rows = [[-flint.fmpq(A[i][j]) for j in range(size)] for i in range(size)]
    for i in range(size):
        rows[i][i] += s
    return flint.fmpq_mat(rows).det()


def of_package(vehicle, folded):
    system = vehicle.folded_state_space if folded else vehicle.state_space
    rows = [[0] * system.size for _ in range(system.size)]
    for (i, j), x in system.A.items():
        rows[i][j] = x
    return rows


PARTS = ("body", "roll", "primary", "spin")
COMBINATIONS = [c for n in range(len(PARTS) + 1) for c in itertools.combinations(PARTS, n)]


@pytest.mark.parametrize("kind", ["power", "trailer"])
@pytest.mark.parametrize("parts", COMBINATIONS, ids="+".join)
def test_eigenvalues_with_every_part(independent, table1, kind, parts):
    p = vehicle_parameters(table1, kind, parts)
    for flags in ((), FLAGS if "body" in parts else FLAGS[1:]):
        expected = accurate_roots(independent.equations(kind, p, flags).state_matrix())
        vehicle = model_of(kind, p, flags).at(p)
        assert difference(np.linalg.eigvals(state_matrix(vehicle)), expected) < 1e-8
        folded = vehicle.folded_state_space
        assert difference(np.linalg.eigvals(dense(folded.A, folded.size)), expected) < 1e-8


def test_states(independent, table1):
    for kind, coordinates, states in (("power", 23, 56), ("trailer", 15, 36)):
        p = vehicle_parameters(table1, kind, ("body",))
        found = independent.equations(kind, p)
        assert (len(found.names), len(found.state_matrix())) == (coordinates, states)


def test_every_number_counts(independent, table1):
    """A parameter that one of the two did not use, or used elsewhere, would show."""
    p = vehicle_parameters(table1, "power", PARTS)
    before = np.array(independent.equations("power", p, FLAGS[:1]).state_matrix(), dtype=float)
    for name in p:
        changed = {**p, name: p[name] * 1.05}
        expected = np.array(independent.equations("power", changed, FLAGS[:1]).state_matrix(), dtype=float)
        assert not np.array_equal(expected, before), name
        vehicle = model_of("power", p, FLAGS[:1]).at(changed)
        assert difference(np.linalg.eigvals(state_matrix(vehicle)), np.linalg.eigvals(expected)) < 1e-8


@pytest.mark.parametrize("rigid", [("K_ds",), ("K_dt",), ("K_dm",), ("K_d1x", "K_d1y"), ("K_ds", "K_dt", "K_dm")])
def test_rigid_joints(independent, table1, rigid):
    p = {name: x for name, x in vehicle_parameters(table1, "power", PARTS).items() if name not in rigid}
    A = independent.equations("power", p).state_matrix()
    vehicle = model_of("power", p, ()).at(p)
    assert difference(np.linalg.eigvals(state_matrix(vehicle)), accurate_roots(A)) < 1e-8
    # A very stiff joint has hardly another spectrum, but for its own fast root.
    stiff = independent.equations("power", p | dict.fromkeys(rigid, 1e13)).state_matrix()
    slow = [s for s in accurate_roots(stiff) if abs(s) < 1e5]
    assert difference(slow, [s for s in accurate_roots(A) if abs(s) < 1e5]) < 1e-4


def test_the_gyroscopic_moment_is_that_of_a_spinning_axle(independent):
    """By the angular momentum of an axle that is turned by a finite angle, differentiated by differences."""
    inertia, v, r, b, conicity = 180.0, 70.0, 0.6, 0.75, 0.15
    spin = v / r

    def momentum(roll, yaw):
        cr, sr, cy, sy = np.cos(roll), np.sin(roll), np.cos(yaw), np.sin(yaw)
        axle = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
        return axle @ [0, inertia * spin, 0]

    h = 1e-6
    per_roll, per_yaw = ((momentum(*at) - momentum(*(-x for x in at))) / (2 * h) for at in ((h, 0), (0, h)))
    for found, expected in zip(independent.gyroscopic_moments(inertia, spin), (per_roll, per_yaw), strict=True):
        assert np.allclose(found, expected, atol=1e-6)
    contact = WheelRailContact("y", "phi", 0.0, conicity, b, r, 1e7, 1e7, v, spinning=inertia).entries()
    # The change of the angular momentum stands on the left of the equations; M_x works on roll = conicity y / b.
    assert contact["phi", "y"][1] == pytest.approx(per_roll[2] * conicity / b)
    assert contact["y", "phi"][1] == pytest.approx(per_yaw[0] * conicity / b)
    assert contact["phi", "y"][1] > 0


def test_the_gyroscopic_moment_does_no_work(independent, table1):
    p = vehicle_parameters(table1, "trailer", ("spin",))
    with_it, without = (independent.equations("trailer", {**p, "J_wy": x}) for x in (180.0, 0.0))
    change = np.array(with_it.C) - np.array(without.C)
    assert np.any(change)
    assert np.array_equal(change, -change.T)


factor = st.floats(-1, 1).map(lambda x: 30.0**x)


@st.composite
def vehicles(draw):
    """Return kind, parameters and flags of a vehicle; every number within a factor of 30 around a real one's."""
    kind = draw(st.sampled_from(["power", "trailer"]))
    parts = draw(st.sets(st.sampled_from(PARTS)))
    from_paper = draw(st.just(TABLE))
    p = {name: x * draw(factor) for name, x in vehicle_parameters(from_paper, kind, parts).items()}
    for joint in draw(st.sets(st.sampled_from(["K_ds", "K_dt", "K_dm", "K_d1x", "K_d1y"]))):
        p.pop(joint, None)
    if "body" in parts:
        for which in ("leading", "trailing"):
            for name in draw(st.sets(st.sampled_from(BOTH), max_size=3)):
                if name in p:
                    p[f"{which}.{name}"] = p[name] * draw(factor)
        if draw(st.booleans()):
            p[f"trailing.{SHARE}"] = draw(st.floats(0.05, 2))
    allowed = FLAGS if "body" in parts else FLAGS[1:]
    return kind, p, draw(st.sets(st.sampled_from(allowed)))


TABLE = {}


@pytest.fixture(autouse=True)
def _table(table1):
    TABLE.update(table1)


COMMON = settings(deadline=None, suppress_health_check=list(HealthCheck))


@settings(COMMON, max_examples=30)
@given(vehicles())
def test_the_same_polynomial_exactly(independent, drawn):
    """Both state matrices and the product of the motions have one characteristic polynomial, at rational points.

    The motions of a vehicle whose bogies differ are not folded; with every part together they take minutes.
    """
    kind, p, flags = drawn
    vehicle, exact = model_of(kind, p, flags).at(exactly(p)), exactly(p)
    expected = independent.equations(kind, exact, flags).state_matrix()
    size, quick = len(expected), not any("." in name for name in p)
    for s in (flint.fmpq(3, 7), flint.fmpq(-50, 3)):
        wanted = characteristic_at(expected, size, s)
        for folded in (False, True):
            found = of_package(vehicle, folded)
            assert len(found) == size
            assert characteristic_at(found, size, s) == wanted
        if quick:
            polynomial = vehicle.polynomial
            assert sum(a * s**k for k, a in enumerate(polynomial)) / polynomial[-1] == wanted


@pytest.mark.parametrize("kind", [pytest.param("power", marks=pytest.mark.slow), "trailer"])
def test_the_same_polynomial_of_unlike_bogies(independent, table1, kind):
    p = {
        **vehicle_parameters(table1, kind, ("body",)),
        "leading.K_1x": 3e7,
        f"trailing.{SHARE}": 0.5,
        "trailing.K_ds": 2e7,
    }
    exact, s = exactly(p), flint.fmpq(-50, 3)
    vehicle = model_of(kind, p, ()).at(exact)
    A = independent.equations(kind, exact).state_matrix()
    polynomial = vehicle.polynomial
    assert sum(a * s**k for k, a in enumerate(polynomial)) / polynomial[-1] == characteristic_at(A, len(A), s)


@settings(COMMON, max_examples=30)
@given(vehicles())
def test_the_same_eigenvalues(independent, drawn):
    kind, p, flags = drawn
    expected = accurate_roots(independent.equations(kind, p, flags).state_matrix())
    vehicle = model_of(kind, p, flags).at(p)
    found = accurate_roots(of_package(vehicle, folded=False))
    assert difference(found, expected) < 1e-8

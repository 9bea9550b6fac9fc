"""Elements, pairs of them, and what they are assembled to."""

from fractions import Fraction

import numpy as np
import pytest

from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.determinant import Determinant
from yawdesign.vehicle.elements import (
    Dashpot,
    Link,
    Mass,
    Maxwell,
    Pair,
    Spring,
    WheelRailContact,
    folded,
    parallel,
    physical,
)
from yawdesign.vehicle.polynomials import evaluate, scale_variable, trim
from yawdesign.vehicle.state_space import StateSpace, fill
from yawdesign.vehicle.vehicle import Model

INNER = ("11", "12", "21", "22")  # front and rear of the front bogie, then of the rear one


def determinant(elements):
    d = Determinant(polynomial_matrix(elements))
    return d.of(d.nodes)


def matrix(elements):
    system = StateSpace(elements)
    return fill(system.A, np.zeros((system.size, system.size)))


def by_size(values):
    return sorted(values, key=lambda s: (round(abs(s), 6), round(s.imag, 6)))


def oscillator(law, m=2.0, K=50.0):
    return [Mass("x", m), Link((Spring(K), law), {"x": 1})]


@pytest.mark.parametrize("s", [0.3, 1 + 2j, -4j])
def test_laws(s):
    spring, dashpot, maxwell = Spring(3.0), Dashpot(2.0), Maxwell(5.0, 2.0)
    assert evaluate(spring.numerator, s) == 3
    assert evaluate(dashpot.numerator, s) == 2 * s
    z = evaluate(maxwell.numerator, s) / evaluate(maxwell.denominator, s)
    assert z == pytest.approx(1 / (1 / 5 + 1 / (2 * s)), rel=1e-14)
    numerator, denominator = parallel((spring, dashpot, maxwell))
    assert evaluate(numerator, s) / evaluate(denominator, s) == pytest.approx(3 + 2 * s + z, rel=1e-14)


def test_maxwell_with_a_rigid_joint_is_a_dashpot():
    stiff, plain = (trim(determinant(oscillator(law))) for law in (Maxwell(1e18, 7.0), Dashpot(7.0)))
    assert stiff[:3] == pytest.approx(plain, rel=1e-12)
    assert np.linalg.eigvals(matrix(oscillator(Dashpot(7.0)))) == pytest.approx(np.roots(plain[::-1]), rel=1e-12)


def test_maxwell_with_a_rigid_dashpot_is_a_spring():
    values = np.linalg.eigvals(matrix(oscillator(Maxwell(30.0, 1e12))))
    assert max(abs(values)) == pytest.approx(np.sqrt((50 + 30) / 2), rel=1e-9)


def test_maxwell_without_damping_has_no_state():
    assert matrix(oscillator(Maxwell(30.0, 0))).shape == (2, 2)


def test_maxwell_oscillator_by_hand():
    # m s^2 + K + k c s / (k + c s), over the common denominator and divided by k
    m, K, k, c = 2.0, 50.0, 30.0, 7.0
    assert determinant(oscillator(Maxwell(k, c), m, K)) == pytest.approx((K, c + K * c / k, m, m * c / k), rel=1e-15)
    roots = np.roots([m * c / k, m, c + K * c / k, K])
    assert by_size(np.linalg.eigvals(matrix(oscillator(Maxwell(k, c), m, K)))) == pytest.approx(by_size(roots))


def test_two_bodies_push_on_each_other():
    link = Link((Spring(3.0),), {"x": 1, "y": -2})
    entries = polynomial_matrix([Mass("x", 1.0), Mass("y", 1.0), link])
    d = Determinant(entries)
    # stiffness 3 (1, -2)^T (1, -2) and unit masses: s^4 + 15 s^2
    assert trim(d.of(d.nodes)) == (0, 0, 15, 0, 1)
    assert sorted(abs(np.linalg.eigvals(matrix([Mass("x", 1.0), Mass("y", 1.0), link])))) == pytest.approx(
        [0, 0, 15**0.5, 15**0.5], abs=1e-7
    )


def test_a_force_can_be_told_where_to_act():
    link = Link((Spring(3.0),), {"x": 1, "y": -2}, acts_on=frozenset({"y"}))
    assert link.force == {"y": -2}
    a = matrix([Mass("x", 1.0), Mass("y", 1.0), link])
    assert not a[2].any()
    assert list(a[3]) == [6.0, -12.0, 0.0, 0.0]


def test_contact_is_equation_2():
    W, conicity, b, r, f_11, f_22, v = (Fraction(n) for n in (7, 2, 3, 5, 11, 13, 17))
    entries = WheelRailContact("y", "phi", W, conicity, b, r, f_11, f_22, v).entries()
    assert entries["y", "y"] == (W * conicity / b, 2 * f_11 / v)
    assert entries["y", "phi"] == (-2 * f_11,)
    assert entries["phi", "y"] == (2 * f_22 * b * conicity / r,)
    assert entries["phi", "phi"] == (-W * b * conicity, 2 * f_22 * b**2 / v)


def pair():
    return Pair(
        (
            Mass("y", 3.0),
            Mass("phi", 2.0),
            WheelRailContact("y", "phi", 5.0, 0.2, 0.7, 0.5, 8.0, 9.0, 30.0),
            Link((Spring(40.0), Maxwell(90.0, 6.0)), {"Y": 1, "y": -1, "tilt": -0.4}, lever={"P": 1.25}, name="box"),
            Link((Spring(25.0), Dashpot(3.0)), {"P": 1, "phi": -1}),
            Link((Dashpot(2.0),), {"Y": 1}, lever={"P": 0.3}),
            Link((Spring(1.5),), {}, lever={"P": 0.8}),
        ),
        own=frozenset({"y", "phi"}),
    )


def frame():
    return [Mass("Y", 7.0), Mass("P", 9.0), Mass("tilt", 4.0), Link((Spring(11.0),), {"tilt": 1})]


def test_ends_mirror_their_levers():
    front, rear = (
        [e for e in pair().both_ends() if isinstance(e, Link) and e.name == name] for name in ("box 1", "box 2")
    )
    assert front[0].displacement == {"Y": 1, "y1": -1, "tilt": -0.4, "P": 1.25}
    assert rear[0].displacement == {"Y": 1, "y2": -1, "tilt": -0.4, "P": -1.25}


def test_a_link_is_found_by_its_name():
    for arrange, suffixes in ((physical, "12"), (folded, "+-")):
        names = [e.name for e in arrange([pair()]) if isinstance(e, Link) and e.name]
        assert names == [f"box {suffix}" for suffix in suffixes]


def test_a_folded_pair_has_the_physical_determinant_and_eigenvalues():
    elements = [*frame(), pair()]
    whole, halves = trim(determinant(physical(elements))), trim(determinant(folded(elements)))
    unit = 3.0
    assert scale_variable(halves, unit) == pytest.approx(scale_variable(whole, unit), rel=1e-12)
    values = [by_size(np.linalg.eigvals(matrix(f(elements)))) for f in (physical, folded)]
    assert values[0] == pytest.approx(values[1], rel=1e-9)


def test_folding_separates_sums_from_differences():
    d = Determinant(polynomial_matrix(folded([*frame(), pair()])))
    pieces = d.factors(d.nodes - {"Y", "P", "tilt"})
    names = [{x[-1] for x in piece if x in ("y+", "y-", "phi+", "phi-")} for piece in pieces]
    assert sorted(map(sorted, filter(None, names))) == [["+"], ["-"]]


@pytest.mark.parametrize("equations", ["as-printed", "reciprocal"])
def test_the_paper_bogie_folded_is_the_physical_one(table1, equations, rational_vehicle):
    vehicle = rational_vehicle(Model(equations=equations).at(table1, C_s=1e6))
    assert trim(determinant(vehicle.folded)) == trim(determinant(vehicle.physical))


def test_the_printed_equations_lack_one_reaction(table1):
    p = table1
    printed, whole = (Model(equations=e).at(p, C_s=1e6) for e in ("as-printed", "reciprocal"))
    coordinates = printed.state_space.coordinates
    row, columns = 10 + coordinates.index("phi_b"), [coordinates.index(x) for x in ("phi_m1", "phi_m2")]
    difference = matrix(whole.physical) - matrix(printed.physical)
    others = np.delete(difference, row, axis=0)
    assert not others.any()
    expected = np.zeros(25)
    expected[columns] = p["K_mphi"] / p["J_b"]
    expected[10 + np.array(columns)] = p["C_mphi"] / p["J_b"]
    expected[coordinates.index("phi_b")] = -2 * p["K_mphi"] / p["J_b"]
    expected[10 + coordinates.index("phi_b")] = -2 * p["C_mphi"] / p["J_b"]
    assert difference[row] == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_sizes(table1, vehicle_model):
    vehicle = vehicle_model.at(table1, C_s=1e6)
    assert matrix(vehicle.physical).shape == ((25, 25) if vehicle_model.kind == "power" else (15, 15))


def test_a_pair_that_holds_pairs(two_bogies, exact_determinant):
    elements = two_bogies(10)
    ends, halves = physical(elements), folded(elements)
    names = {e.coordinate for e in ends if isinstance(e, Mass)}
    assert names == {"y_c", "phi_c"} | {
        x + end for x, ends in (("y_b", "12"), ("phi_b", "12"), ("y_w", INNER), ("phi_w", INNER)) for end in ends
    }
    whole = determinant(ends)  # of many cycles: once
    assert trim(determinant(halves)) == trim(whole)
    size = StateSpace(ends).size
    assert size == 2 * 14 + 4 + 4 + 2  # box dampers, lateral dampers, yaw dampers
    for k in range(3):
        s = Fraction(k + 1, 3)
        assert evaluate(whole, s) == exact_determinant(ends, s) == exact_determinant(halves, s)


def test_eigenvalues_of_a_pair_that_holds_pairs(two_bogies):
    elements = two_bogies(10, float)
    whole, halves = (np.linalg.eigvals(matrix(f(elements))) for f in (physical, folded))
    apart = np.abs(whole[:, None] - halves[None, :])
    assert max(*apart.min(axis=0), *apart.min(axis=1)) < 1e-9 * np.abs(whole).max()


def test_links_of_a_pair_that_holds_pairs(two_bogies):
    displacements = {e.name: e.displacement for e in physical(two_bogies(1)) if isinstance(e, Link) and e.name}
    l, b_0, a = Fraction(17, 2), Fraction(3, 10), Fraction(5, 4)  # noqa: E741
    assert displacements["lateral damper 11"] == {"y_b1": 1, "phi_b1": b_0, "y_c": -1, "phi_c": -l - b_0}
    assert displacements["lateral damper 12"] == {"y_b1": 1, "phi_b1": -b_0, "y_c": -1, "phi_c": -l + b_0}
    assert displacements["lateral damper 21"] == {"y_b2": 1, "phi_b2": b_0, "y_c": -1, "phi_c": l - b_0}
    assert displacements["lateral damper 22"] == {"y_b2": 1, "phi_b2": -b_0, "y_c": -1, "phi_c": l + b_0}
    assert displacements["box damper 12"] == {"y_b1": 1, "y_w12": -1, "phi_b1": -a}
    contacts = [e for e in physical(two_bogies(1)) if isinstance(e, WheelRailContact)]
    assert [(e.y, e.alignment) for e in contacts] == [(f"y_w{end}", f"alignment_{end}") for end in INNER]

"""Small vehicles built from elements by hand: two frames under a car body, and two bogies under one."""

from fractions import Fraction

import flint
import pytest

from yawdesign.vehicle.elements import Dashpot, Link, Mass, Maxwell, Pair, Spring, WheelRailContact
from yawdesign.vehicle.polynomials import evaluate


@pytest.fixture(scope="session")
def two_frames():
    """Return two unlike frames on springs, each with a yaw damper of its own against the car body between them."""

    def elements(C_s, number=Fraction):
        n = [number(x) for x in (7, 5, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47)]
        C_s = number(C_s)
        return [
            Mass("front", n[0]),
            Mass("rear", n[1]),
            Mass("body", n[2]),
            Link((Spring(n[3]),), {"front": 1}),
            Link((Spring(n[4]), Dashpot(n[5])), {"rear": 1}),
            Link((Spring(n[6]), Maxwell(n[7], n[8])), {"front": 1, "body": -1}, name="lateral damper"),
            Link((Spring(n[9]),), {"rear": 1, "body": -2}),
            Link((Maxwell(n[10], C_s),), {"front": 1, "body": -1}, name="yaw damper 1", varied=True),
            Link((Maxwell(n[11], C_s),), {"rear": 2, "body": -1}, name="yaw damper 2", varied=True),
            Mass("apart", n[12]),
            Link((Spring(n[3]), Dashpot(n[12])), {"apart": 1}),
        ]

    return elements


@pytest.fixture(scope="session")
def two_bogies():
    """Return a car body on two alike bogies of two wheelsets each: a pair that holds pairs."""

    def elements(C_s, number=Fraction):
        def n(x):
            return number(Fraction(x))

        l, b_0, b_3, a = n("1/2") * 17, n("3/10"), n("6/5"), n("5/4")  # noqa: E741
        inner = Pair(
            (
                Mass("y_w", n(3), name="wheelset hunting"),
                Mass("phi_w", n(2), unit="rad", name="wheelset hunting"),
                WheelRailContact("y_w", "phi_w", n(5), n("1/5"), n("7/10"), n("1/2"), n(8), n(9), n(30)),
                Link((Spring(n(40)), Maxwell(n(70), n(4))), {"y_b": 1, "y_w": -1}, {"phi_b": a}, name="box damper"),
                Link((Spring(n(25)),), {"phi_b": 1, "phi_w": -1}),
            ),
            own=frozenset({"y_w", "phi_w"}),
        )
        # Between car body and frame, before and behind the middle of the frame.
        lateral = Link(
            (Maxwell(n(90), n(6)),),
            {"y_b": 1, "y_c": -1},
            lever={"phi_b": b_0, "phi_c": -b_0},
            outer={"phi_c": -l},
            name="lateral damper",
        )
        bogie = (
            Mass("y_b", n(7), name="frame lateral"),
            Mass("phi_b", n(9), unit="rad", name="frame yaw"),
            Link((Spring(n(11)),), {"y_b": 1, "y_c": -1}, lever={"phi_c": -l}),
            Link((Spring(n(13)), Dashpot(n(1))), {"phi_b": 1, "phi_c": -1}),
            Link((Maxwell(n(60), n(C_s)),), {"phi_b": b_3, "phi_c": -b_3}, name="yaw damper", pieces=2, varied=True),
            inner,
            Pair((lateral,)),
        )
        body = [Mass("y_c", n(50), name="car body lateral"), Mass("phi_c", n(400), unit="rad", name="car body yaw")]
        return [*body, Pair(bogie, own=frozenset({"y_b", "phi_b", "y_w", "phi_w"}))]

    return elements


@pytest.fixture(scope="session")
def exact_determinant():
    """Return the determinant of the equations of motion at a rational s, times the denominators of all laws.

    Nothing is taken from the assembly: every law is a number at s, as one would write the matrix down.
    """

    def determinant(elements, s):
        places = {e.coordinate: k for k, e in enumerate(e for e in elements if isinstance(e, Mass))}
        matrix = [[Fraction(0)] * len(places) for _ in places]
        denominators = Fraction(1)
        for e in elements:
            if isinstance(e, Mass):
                matrix[places[e.coordinate]][places[e.coordinate]] += e.m * s * s
            elif isinstance(e, WheelRailContact):
                for (row, column), p in e.entries().items():
                    matrix[places[row]][places[column]] += evaluate(p, s)
            else:
                for law in e.laws:
                    below = evaluate(law.denominator, s)
                    denominators *= below
                    for x, force in e.force.items():
                        for y, g in e.displacement.items():
                            matrix[places[x]][places[y]] += evaluate(law.numerator, s) / below * force * g
        rows = [[flint.fmpq(x.numerator, x.denominator) for x in row] for row in matrix]
        found = flint.fmpq_mat(rows).det()
        return Fraction(int(found.p), int(found.q)) * denominators

    return determinant

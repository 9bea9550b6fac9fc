"""The equations for a page are those of the vehicle at any speed, conicity, creep and yaw damping."""

import base64
import struct
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.exports.javascript import page_equations
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.polynomials import scale_variable
from yawdesign.vehicle.vehicle import Model

POINT = {"v": 37.0, "lambda": 0.31, "creep_factor": 0.45}
C_S = 2.3e5
PROBLEMS = {
    "as printed": yd.table1(equations="as-printed"),
    "reciprocal": yd.table1(),
    "trailer": yd.load(Path(__file__).parents[2] / "problems" / "trailer-bogie.yaml"),
    "no lateral damper": yd.table1().replace(C_t=0),
}


def at(problem):
    model, p = Model.of(problem), {name: float(x) for name, x in problem.parameters().items()}
    return model.at(Condition(tuple(POINT.items())).applied({**p, "C_s": C_S}))


@pytest.fixture(params=PROBLEMS, ids=str)
def problem(request):
    return PROBLEMS[request.param]


def coefficients(motion, equations):
    """Return the polynomial at the point as exact rationals, as its common factor leaves it."""
    letters = [Fraction(POINT["lambda"]), Fraction(POINT["creep_factor"]), 1 / Fraction(POINT["v"])]
    damping = Fraction(C_S) / equations["damping_unit"]
    places = np.frombuffer(base64.b64decode(motion["places"]), dtype=np.uint8).reshape(-1, 3).tolist()
    values = struct.unpack(f"<{2 * len(places)}d", base64.b64decode(motion["values"]))
    found = {}
    for (power, s, monomial), high, low in zip(places, values[::2], values[1::2], strict=True):
        x = (Fraction(high) + Fraction(low)) * damping**power
        for letter, k in zip(letters, motion["monomials"][monomial], strict=True):
            x *= letter**k
        found[s] = found.get(s, 0) + x
    return [found[s] for s in sorted(found)]


def test_polynomials_are_right_to_thirty_digits(problem):
    equations, vehicle = page_equations(problem), at(problem)
    exact = vehicle.model.at({name: Fraction(x) for name, x in vehicle.p.items()} | page_numbers(problem))
    for own, motion in zip(equations["motions"], exact.motions, strict=True):
        expected = [a for a in scale_variable(motion.polynomial(Fraction(C_S)), 100) if a]
        found = coefficients(own, equations)
        factor = expected[0] / found[0]
        assert own["name"] == motion.name
        assert max(abs(a * factor / b - 1) for a, b in zip(found, expected, strict=True)) < 1e-30


def page_numbers(problem):
    """Return the creep coefficients without the rounding of a product."""
    p = problem.parameters()
    return {key: Fraction(float(p[key])) * Fraction(POINT["creep_factor"]) for key in ("f_11", "f_22")}


def test_state_matrices_are_those_of_the_motions(problem):
    vehicle, letters = at(problem), (POINT["lambda"], POINT["creep_factor"], 1 / POINT["v"], C_S)
    for own, motion in zip(page_equations(problem)["motions"], vehicle.model.motions, strict=True):
        matrix = np.zeros((own["size"], own["size"]))
        for row, column, constant, *powers in own["matrix"]:
            matrix[row, column] += constant * np.prod([x**k for x, k in zip(letters, powers, strict=True)])
        assert matrix == pytest.approx(motion_matrix(vehicle, motion), rel=1e-13)


def test_what_a_variable_moves_counts():
    moved = yd.table1().replace(design=yd.Design(variables={"C_mphi": yd.Variable(min=1e3, max=2e3)}))
    assert [x["counts"] for x in page_equations(yd.table1())["motions"]] == [True, False]
    assert [x["counts"] for x in page_equations(moved)["motions"]] == [True, True]

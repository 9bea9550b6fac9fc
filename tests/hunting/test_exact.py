"""Critical values with many digits, against proved ones and against polynomials whose roots are known."""

from decimal import localcontext
from fractions import Fraction

import pytest

from yawdesign.hunting import exact
from yawdesign.hunting.certificate import certify
from yawdesign.hunting.exact import NotDecidedError, exact_critical_values
from yawdesign.vehicle.motions import COUPLED, Motion
from yawdesign.vehicle.polynomials import product
from yawdesign.vehicle.vehicle import Model, Vehicle

PRINTED = Model(equations="as-printed")


def test_random_bogies_have_the_proved_values(random_vehicles):
    values = 0
    for vehicle in random_vehicles(25, spread=10, seed=41):
        found, proved = exact_critical_values(vehicle), certify(vehicle)
        assert found.unstable_roots == proved.unstable_roots
        for x, y in zip(found.critical, proved.critical, strict=True):
            assert tuple(map(float, x)) == pytest.approx((y.C_s, y.omega), rel=1e-15)
        values += len(found.critical)
    assert values > 6


def test_reference_bogies(case, vehicle_of_case):
    found = exact_critical_values(vehicle_of_case(case, exact=True))
    assert [float(C_s) for C_s, _ in found.critical] == pytest.approx(case["critical_C_s"], rel=1e-12)
    assert list(found.unstable_roots) == case["unstable_roots_per_interval"]


def test_roots_closer_than_the_digits_are_refused():
    gap = Fraction(1, 10**40)
    with localcontext(prec=20), pytest.raises(ArithmeticError):
        list(exact.isolated(exact.sturm_chain(exact.decimals(product([(-1, 1), (-1 - gap, 1)])), 20)))
    with localcontext(prec=200):
        assert len(list(exact.isolated(exact.sturm_chain(exact.decimals(product([(-1, 1), (-1 - gap, 1)])), 200)))) == 2


@pytest.mark.parametrize(
    ("roots", "positive"),
    [((1, 2, 3), 3), ((-1, 5), 1), ((-2, -3), 0), ((Fraction(1, 10**9), 10**9), 2), ((7, 7 + Fraction(1, 10**12)), 2)],
)
def test_every_positive_root_is_isolated_once(roots, positive):
    with localcontext(prec=100):
        F = exact.decimals(product([(-Fraction(root), 1) for root in roots]))
        chain = exact.sturm_chain(F, 100)
        found = list(exact.isolated(chain))
        assert len(found) == positive
        refined = sorted(exact._refined(chain[0], low, high, 100) for low, high in found)
    assert [float(x) for x in refined] == pytest.approx(sorted(float(x) for x in roots if x > 0), rel=1e-15)


def test_digits_double_until_two_answers_agree(table1, monkeypatch):
    digits = []
    values = exact._values

    def counted(coefficients, n):
        digits.append(n)
        return values(coefficients, n)

    monkeypatch.setattr(exact, "_values", counted)
    exact_critical_values(PRINTED.at(table1))
    assert digits == [50, 100]


def test_an_answer_that_never_comes_twice_is_none(table1, monkeypatch):
    answers = iter(range(100))
    monkeypatch.setattr(exact, "_values", lambda *_: exact.ExactValues((), (next(answers),)))
    with pytest.raises(NotDecidedError, match="1600 digits"):
        exact_critical_values(PRINTED.at(table1))


def test_values_that_coincide_are_not_decided(table1, monkeypatch):
    # s^2 + 1 divides A and B: a root stays on the axis for every C_s, and no number of digits tells what crosses.
    axis = (1, 0, 1)
    both = Motion(COUPLED, frozenset(), (product([axis, (2, 3, 1)]), (0, *product([axis, (1, 1)]))))
    monkeypatch.setattr(Vehicle, "motions", (both,))
    monkeypatch.setattr(exact, "LAST_DIGITS", 200)
    with pytest.raises(NotDecidedError):
        exact_critical_values(PRINTED.at(table1))


def test_a_step_against_the_crossing_is_refused(table1, monkeypatch):
    monkeypatch.setattr(exact, "_direction", lambda *_: 1)
    monkeypatch.setattr(exact, "LAST_DIGITS", 100)
    with pytest.raises(NotDecidedError):
        exact_critical_values(PRINTED.at(table1))

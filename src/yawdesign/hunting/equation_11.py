"""Eq. (11) as the paper solves it: the Hurwitz minor as a polynomial in C_s, exactly, and its positive roots.

The minor is the product of Routh's column, taken in rational numbers at more places than it has degrees. This needs
nothing but Python; `yawdesign.hunting.certificate` finds the same polynomial by determinants, with python-flint.
"""

import decimal
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from math import prod
from typing import Any

from yawdesign.hunting.exact import Digits, NotDecidedError, decimals, isolated, sign_changes, sturm_chain
from yawdesign.hunting.hurwitz import require_paper_bogie
from yawdesign.hunting.routh import routh_column
from yawdesign.problem import exact
from yawdesign.vehicle.polynomials import Polynomial, add, multiply, trim
from yawdesign.vehicle.vehicle import Vehicle

STEP = 10_000  # [N s/m] between the places where the minor is taken
FIRST_DIGITS, LAST_DIGITS = 200, 1600
NARROW = Decimal("1e-18")  # relative width of an interval that is called a root


def minor_polynomial(vehicle: Vehicle) -> tuple[Fraction, ...]:
    """Return Delta_25 (without motors Delta_15) as a polynomial in C_s, lowest power first.

    The paper sets Delta_26 = 0; as Delta_26 = chi_26 Delta_25, and chi_26 does not depend on C_s, this is the same.

    Parameters
    ----------
    vehicle : Vehicle
        A float stands for its shortest decimal; its own C_s is not looked at.

    Returns
    -------
    tuple of Fraction
        50 coefficients (30 without motors), exact, for s in 1/s and C_s in N s/m.

    Raises
    ------
    ProblemError
        If the vehicle has a car body, or yaw dampers mounted rigidly: (11) is not written for these.
    NotDecidedError
        If an entry of Routh's column is zero.
    """
    require_paper_bogie(vehicle.model)
    numbers = vehicle.model.at({name: exact(x) for name, x in vehicle.p.items()})
    size = len(numbers.replace(C_s=Fraction(1)).paper_coefficients()) - 1
    # Every chi is at most quadratic in C_s, and row by row the minor takes one from each of size - 1.
    places = [Fraction(STEP * k) for k in range(1, 2 * size)]
    return trim(interpolated(places, [_minor(numbers.replace(C_s=C_s)) for C_s in places]))


def _minor(vehicle: Vehicle) -> Fraction:
    try:
        column = routh_column(tuple(reversed(vehicle.paper_coefficients())))
    except ZeroDivisionError:
        raise NotDecidedError("an entry of Routh's column is zero") from None
    return prod(column[1:-1], start=Fraction(1))


def interpolated(places: Sequence[Any], values: Sequence[Any]) -> Polynomial:
    """Return the polynomial through points, by Newton's divided differences, lowest power first."""
    differences = list(values)
    for order in range(1, len(places)):
        for k in range(len(places) - 1, order - 1, -1):
            differences[k] = (differences[k] - differences[k - 1]) / (places[k] - places[k - order])
    found: Polynomial = ()
    for place, difference in zip(reversed(places), reversed(differences), strict=True):
        found = add(multiply(found, (-place, 1)), (difference,))
    return found


def positive_roots(p: Polynomial) -> tuple[float, ...]:
    """Return all positive roots of a polynomial with rational coefficients, in ascending order, each once.

    They come from a Sturm chain in decimals of so many digits that twice as many give the same roots.

    Parameters
    ----------
    p : tuple of Fraction
        Coefficients, lowest power first.

    Raises
    ------
    NotDecidedError
        If even the most digits give no answer that twice as many confirm.

    Examples
    --------
    >>> positive_roots(multiply((-2, 0, 1), multiply((-3, 1), (-3, 1))))
    (1.4142135623730951, 3.0)
    """
    digits, before = FIRST_DIGITS, None
    while digits <= LAST_DIGITS:
        found = _with_digits(trim(p), digits)
        if found is not None and found == before:
            return found
        digits, before = 2 * digits, found
    raise NotDecidedError(f"{LAST_DIGITS} digits do not decide")


def _with_digits(p: Polynomial, digits: int) -> tuple[float, ...] | None:
    with decimal.localcontext(decimal.Context(prec=digits, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN)):
        try:
            F, unit = _centred(decimals(trim(p[::-1])[::-1]))  # without its roots at zero
            chain = sturm_chain(F, digits, multiple=True) if len(F) > 1 else []
            return tuple(sorted(float(unit * _narrowed(chain, low, high)) for low, high in isolated(chain)))
        except ArithmeticError:  # also decimal's own
            return None


def _centred(F: Digits) -> tuple[Digits, Decimal]:
    """Return a polynomial in a variable in which its roots are near 1, and the unit of that."""
    tens = (F[0].adjusted() - F[-1].adjusted()) // max(1, len(F) - 1) if F else 0
    return tuple(a.scaleb(tens * k) for k, a in enumerate(F)), Decimal(1).scaleb(tens)


def _narrowed(chain: Sequence[Digits], low: Decimal, high: Decimal) -> Decimal:
    """Return the only root in an interval, which may be a multiple one: by halving, with the Sturm chain."""
    below = sign_changes(chain, low)
    while high - low > NARROW * high:
        middle = (low * high).sqrt()
        low, high = (middle, high) if sign_changes(chain, middle) == below else (low, middle)
    return high

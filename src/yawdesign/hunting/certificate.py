"""Certified answers in exact rational arithmetic, with python-flint (``pip install "yawdesign[certify]"``).

Numbers are taken as they were written: 626.48 is 15662/25 and not its nearest double. Roots are isolated with proof,
and counts of unstable roots come from Sturm chains without rounding. This is there to check the fast answers, and to
write down the paper's polynomial (11) with all its digits.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from itertools import cycle, pairwise
from typing import Any

from yawdesign.hunting.equation_11 import interpolated
from yawdesign.hunting.exact import resultant
from yawdesign.hunting.hurwitz import require_paper_bogie
from yawdesign.problem import exact
from yawdesign.vehicle.polynomials import Polynomial, evaluate, even_odd, trim
from yawdesign.vehicle.vehicle import Vehicle

# Bits of the first and the last attempt, and how many must be proved of every result. A double has 53.
FIRST_PRECISION, LAST_PRECISION, ENOUGH = 128, 8192, 60


@dataclass(frozen=True)
class CertifiedValue:
    """A critical yaw damping that was proved to be one.

    Parameters
    ----------
    C_s : float
        Damping of the pair of yaw dampers [N s/m], the exact value correctly rounded but for the last bit.
    omega : float
        Angular frequency of the roots on the imaginary axis [rad/s].
    """

    C_s: float
    omega: float


@dataclass(frozen=True)
class Certificate:
    """All critical values of the yaw damping and the stability between them, proved.

    Parameters
    ----------
    critical : tuple of CertifiedValue
        In ascending order of C_s.
    unstable_roots : tuple of int
        Number of roots of the coupled motion in the right half-plane, below the first critical value, between the
        first and the second, ..., above the last.
    """

    critical: tuple[CertifiedValue, ...]
    unstable_roots: tuple[int, ...]


def certify(vehicle: Vehicle) -> Certificate:
    """Return all critical values of the yaw damping and the number of unstable roots between them.

    Parameters
    ----------
    vehicle : Vehicle
        A float stands for its shortest decimal; so a speed of 300 km/h is exactly ``Fraction(250, 3)``. Its own C_s is
        not looked at.
    """
    found = critical_values(vehicle)
    counts = [unstable_roots(vehicle, C_s) for C_s in _between([x.C_s for x in found])]
    return Certificate(found, tuple(counts))


def critical_values(vehicle: Vehicle) -> tuple[CertifiedValue, ...]:
    """Return every C_s > 0 at which a pair of roots lies on the imaginary axis, in ascending order.

    With the parts E_k(x) + j w O_k(x), x = w^2, of the polynomial that C_s^k multiplies, a root on the axis is two real
    equations in C_s. They have a common solution exactly at the roots x of their resultant, and there it is unique:
    ``-E_0/E_1`` where they are linear, ``(E_2 O_0 - E_0 O_2) / (E_1 O_2 - E_2 O_1)`` for a vehicle with a car body.

    Parameters
    ----------
    vehicle
        As in `certify`.

    Examples
    --------
    >>> from yawdesign import table1
    >>> (vehicle,) = Vehicle.of(table1(equations="as-printed"))
    >>> [f"{x.C_s:.6f} at {x.omega:.6f} rad/s" for x in critical_values(vehicle)]
    ['90702.889779 at 23.154737 rad/s']
    """
    coefficients = [trim(p) for p in _exact(vehicle).coupled.coefficients]
    while not coefficients[-1]:  # a yaw damper with a share of nothing
        coefficients.pop()
    F = _flint_polynomial(resultant(coefficients))
    halves = [even_odd(p) for p in coefficients]
    return tuple(sorted(_at_the_precision_needed(_solutions, F, halves), key=lambda x: x.C_s))


def _solutions(F: Any, halves: Sequence[tuple[Polynomial, Polynomial]]) -> list[CertifiedValue]:
    values = []
    for x in _positive_balls(F):
        top, bottom = _fraction([(evaluate(even, x), evaluate(odd, x)) for even, odd in halves])
        C_s = top / bottom
        if _accuracy(C_s) < ENOUGH:
            raise _NotProvedError(f"the sign of a critical damping is not proved with {LAST_PRECISION} bits")
        if C_s > 0:
            values.append(CertifiedValue(_rounded(C_s), _rounded(x.sqrt())))
    return values


def _fraction(values: Sequence[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Return numerator and denominator of the common C_s, given the parts (E, O) for every power of it."""
    if len(values) == 2:
        # E_1 or O_1 may vanish at the root; one that does not is enough.
        top, bottom = max(zip(*values, strict=True), key=lambda half: _accuracy(half[1]))
        return -top, bottom
    (even, odd), (even_1, odd_1), (even_2, odd_2) = values
    return even_2 * odd - even * odd_2, even_1 * odd_2 - even_2 * odd_1


def unstable_roots(vehicle: Vehicle, C_s: Fraction | float) -> int:
    """Return the number of roots of the coupled motion in the right half-plane, by a Sturm chain without rounding.

    Parameters
    ----------
    vehicle
        As in `certify`.
    C_s : Fraction or float
        Damping of the pair of yaw dampers [N s/m].

    Raises
    ------
    ArithmeticError
        If there is a pair of roots s, -s: C_s is exactly a critical value.
    """
    core = _exact(vehicle).coupled.polynomial(_rational(C_s))
    # p(j w) / j^n = U(w) - j V(w): the chain of U and V counts how often the argument turns as w goes along the axis.
    down = [a * sign for a, sign in zip(reversed(trim(core)), cycle((1, 1, -1, -1)), strict=False)]
    upper = _flint_polynomial(tuple(a if k % 2 == 0 else 0 for k, a in enumerate(down))[::-1])
    lower = _flint_polynomial(tuple(a if k % 2 else 0 for k, a in enumerate(down))[::-1])
    chain = [upper, lower]
    while chain[-1] != 0:
        chain.append(-(chain[-2] % chain[-1]))
    if chain[-2].degree() > 0:
        raise ArithmeticError(f"C_s = {float(C_s)!r} is exactly critical: there are roots s and -s")
    return _sturm_index(chain[:-1])


def _sturm_index(chain: Sequence[Any]) -> int:
    """Return the number of roots in the right half-plane from the chain's signs at plus and minus infinity."""
    right = [q.leading_coefficient() > 0 for q in chain]
    left = [sign ^ (q.degree() % 2 == 1) for sign, q in zip(right, chain, strict=True)]
    changes_right, changes_left = (sum(a != b for a, b in pairwise(signs)) for signs in (right, left))
    return int(chain[0].degree() - (changes_left - changes_right)) // 2


def hurwitz_polynomial(vehicle: Vehicle) -> tuple[Fraction, ...]:
    """Return E_0 ... E_49 of eq. (11), the Hurwitz minor Delta_25 as a polynomial in C_s, highest power first.

    The paper sets Delta_26 = 0. As Delta_26 = chi_26 Delta_25, and chi_26 (the matrix at s = 0) does not depend on
    C_s, both minors are the same polynomial up to a constant factor and have degree 49. Without motors Delta_15 and
    Delta_16 have degree 29.

    Parameters
    ----------
    vehicle
        As in `certify`. The motions that no yaw damper reaches are in it, as they are in (7).

    Returns
    -------
    tuple of Fraction
        50 coefficients (30 without motors), exact, for s in 1/s and C_s in N s/m.

    Raises
    ------
    ProblemError
        If the vehicle has a car body, or yaw dampers mounted rigidly: (11) is not written for these.
    """
    require_paper_bogie(vehicle.model)
    from_flint, numbers = _flint(), _exact(vehicle)

    def minor(C_s: Any) -> Any:
        chi = numbers.replace(C_s=C_s).paper_coefficients()
        return from_flint.fmpq_mat(_hurwitz_matrix(chi)).det()

    size = len(numbers.replace(C_s=from_flint.fmpq(1)).paper_coefficients()) - 1
    # Every chi is at most quadratic in C_s (core times joint), and row by row the minor takes one from each of n - 1.
    places = [from_flint.fmpq(10_000 * k) for k in range(1, 2 * size)]
    values = trim(interpolated(places, [minor(C_s) for C_s in places]))
    return tuple(Fraction(int(a.p), int(a.q)) for a in reversed(values))


def _hurwitz_matrix(chi: Sequence[Any]) -> list[list[Any]]:
    """Return the matrix of Delta_(n-1): row i, column k holds chi_(2 k - i), counted from 1."""
    n = len(chi) - 1
    return [[chi[2 * k - i] if 0 <= 2 * k - i <= n else 0 for k in range(1, n)] for i in range(1, n)]


def positive_roots(coefficients: Sequence[Fraction | float]) -> tuple[float, ...]:
    """Return all positive real roots of a polynomial with exact coefficients, in ascending order, each once.

    Applied to `hurwitz_polynomial` this is eq. (11) as the paper solves it. Its roots contain all critical values, but
    may contain more: the minor also vanishes where two roots s and -s exist that are *not* on the imaginary axis. And
    the smallest of them need not be the boundary of stability; `certify` says what is stable.

    Parameters
    ----------
    coefficients : sequence
        Highest power first.

    Examples
    --------
    >>> positive_roots((1, 0, -2))
    (1.4142135623730951,)
    """
    polynomial = _flint_polynomial(tuple(_rational(a) for a in reversed(coefficients)))
    return tuple(sorted(_at_the_precision_needed(lambda q: [_rounded(x) for x in _positive_balls(q)], polynomial)))


class _NotProvedError(ArithmeticError):
    """The precision does not suffice for a proof."""


def _at_the_precision_needed(solve: Any, *arguments: Any) -> Any:
    """Return solve(*arguments), with twice the digits each time that these do not suffice for a proof."""
    bits = FIRST_PRECISION
    while True:
        try:
            with _precision(bits):
                return solve(*arguments)
        except _NotProvedError:
            bits *= 2
            if bits > LAST_PRECISION:
                raise


@contextmanager
def _precision(bits: int) -> Iterator[None]:
    context = _flint().ctx
    before, context.prec = context.prec, bits
    try:
        yield
    finally:
        context.prec = before


def _positive_balls(polynomial: Any) -> list[Any]:
    """Return balls that hold exactly one positive real root each. Flint proves which roots are real."""
    real = [root.real for root, _ in polynomial.complex_roots() if root.imag.is_zero()] if polynomial != 0 else []
    if any(_accuracy(x) < ENOUGH for x in real if not x.is_zero()):
        raise _NotProvedError(f"the sign of a real root is not proved with {LAST_PRECISION} bits")
    return [x for x in real if x > 0]


def _accuracy(ball: Any) -> int:
    """Return the number of bits that are proved; where it is positive, so is the sign."""
    return int(ball.rel_accuracy_bits())


def _rounded(ball: Any) -> float:
    return float(ball.mid())


def _between(values: Sequence[float]) -> list[float]:
    """Return one damping in every interval that the values bound."""
    if not values:
        return [1.0e5]
    return [values[0] / 2, *((a + b) / 2 for a, b in pairwise(values)), 2 * values[-1]]


def _flint_polynomial(p: Polynomial) -> Any:
    return _flint().fmpq_poly(list(p))


def _exact(vehicle: Vehicle) -> Vehicle:
    return vehicle.model.at({name: _rational(value) for name, value in vehicle.p.items()})


def _rational(value: Fraction | float) -> Any:
    number = exact(value)
    return _flint().fmpq(number.numerator, number.denominator)


def _flint() -> Any:
    try:
        import flint
    except ImportError as error:
        raise ImportError('exact arithmetic needs python-flint: pip install "yawdesign[certify]"') from error
    return flint

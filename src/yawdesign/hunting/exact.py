"""Critical values where double precision does not decide: rational coefficients, decimals of many digits.

The coefficients are exact rationals. Their roots come from a Sturm chain and the counts of unstable roots from Routh's
array, both in decimal numbers of so many digits that twice as many give the same answer. This is slow, some hundredths
of a second a bogie and seconds a vehicle with a car body, and shares nothing with the fast way but the polynomial.
"""

import decimal
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import reduce
from itertools import pairwise

from yawdesign.hunting.routh import routh_column
from yawdesign.problem import exact
from yawdesign.vehicle.polynomials import Polynomial, add, derivative, even_odd, multiply, scale, trim
from yawdesign.vehicle.vehicle import Vehicle

FIRST_DIGITS, LAST_DIGITS = 50, 1600
FAR = Decimal("1e60")  # from the least and the largest critical value to where 0 and infinity are looked at
SAME = Decimal("1e-18")  # relative difference of two values that are called the same

Digits = tuple[Decimal, ...]


class NotDecidedError(ArithmeticError):
    """The digits do not suffice for an answer."""


@dataclass(frozen=True)
class ExactValues:
    """Critical values in ascending order, and the unstable roots between them.

    Parameters
    ----------
    critical : tuple of (C_s, omega)
        Damping of the pair of yaw dampers [N s/m] and angular frequency [rad/s].
    unstable_roots : tuple of int
        From C_s -> 0 to C_s -> infinity.
    """

    critical: tuple[tuple[Decimal, Decimal], ...]
    unstable_roots: tuple[int, ...]

    def same(self, other: "ExactValues") -> bool:
        """Return whether two computations agree."""
        return self.unstable_roots == other.unstable_roots and all(
            abs(a - b) <= SAME * abs(b)
            for x, y in zip(self.critical, other.critical, strict=True)
            for a, b in zip(x, y, strict=True)
        )


def exact_critical_values(vehicle: Vehicle) -> ExactValues:
    """Return all critical values of the yaw damping of the coupled motion.

    Parameters
    ----------
    vehicle : Vehicle
        A float stands for its shortest decimal; its own C_s is not looked at.

    Raises
    ------
    NotDecidedError
        If even the most digits give no answer that twice as many confirm, such as for values that coincide.
    """
    coupled = vehicle.model.at({name: exact(x) for name, x in vehicle.p.items()}).coupled
    coefficients = [trim(p) for p in coupled.coefficients]
    while not coefficients[-1]:  # a yaw damper with a share of nothing
        coefficients.pop()
    digits, before = FIRST_DIGITS, None
    while digits <= LAST_DIGITS:
        found = _with_digits(coefficients, digits)
        if found and before and found.same(before):
            return found
        digits, before = 2 * digits, found
    raise NotDecidedError(f"{LAST_DIGITS} digits do not decide")


def _with_digits(coefficients: Sequence[Polynomial], digits: int) -> ExactValues | None:
    """Return the values computed with so many digits, or nothing where these leave a step open."""
    with decimal.localcontext(decimal.Context(prec=digits, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN)):
        try:
            return _values(coefficients, digits)
        except ArithmeticError:  # also decimal's own: 0/0, or what overflows
            return None


def _values(coefficients: Sequence[Polynomial], digits: int) -> ExactValues:
    parts = [decimals(p) for p in coefficients]
    F = resultant(coefficients)
    phase = decimals(trim(F[::-1])[::-1])  # without its roots at zero
    chain = sturm_chain(phase, digits) if len(phase) > 1 else []
    roots = [_refined(chain[0], low, high, digits) for low, high in isolated(chain)]
    critical = sorted((C_s, x.sqrt()) for x in roots if (C_s := _damping(parts, x, digits)) > 0)
    counts = tuple(_unstable(_at(parts, C_s)) for C_s in _places([C_s for C_s, _ in critical]))
    steps = [after - before for before, after in pairwise(counts)]
    if steps != [2 * _direction(parts, *value) for value in critical]:
        raise NotDecidedError("a count does not change the way its root crosses the axis")
    return ExactValues(tuple(critical), counts)


def resultant(coefficients: Sequence[Polynomial]) -> Polynomial:
    """Return a polynomial in x = w^2 that is zero where a root lies on the axis with some C_s.

    With the parts E_k(x) + j w O_k(x) of the coefficient of C_s^k, real and imaginary part have a common root C_s.

    Raises
    ------
    NotDecidedError
        If it is zero everywhere: each root on the axis is there twice, or one stays there.
    """
    halves = [even_odd(p) for p in coefficients]
    F: Polynomial = ()
    if len(halves) == 2:
        F = _minor(halves, 0, 1)
    elif len(halves) == 3:
        outer, first, last = (_minor(halves, *pair) for pair in ((0, 2), (0, 1), (1, 2)))
        F = add(multiply(outer, outer), scale(multiply(first, last), -1))
    F = trim(F)
    if not F and len(halves) > 1:
        raise NotDecidedError("a root lies on the axis at every frequency")
    return F


def _minor(halves: Sequence[tuple[Polynomial, Polynomial]], i: int, k: int) -> Polynomial:
    """Return E_k O_i - E_i O_k."""
    return add(multiply(halves[k][0], halves[i][1]), scale(multiply(halves[i][0], halves[k][1]), -1))


def _at(parts: Sequence[Digits], C_s: Decimal) -> Digits:
    return reduce(lambda value, p: add(p, scale(value, C_s)), reversed(parts))


def decimals(p: Polynomial) -> Digits:
    """Return exact coefficients as decimals, each rounded once."""
    fractions = [Fraction(a) for a in p]
    return tuple(Decimal(a.numerator) / Decimal(a.denominator) for a in fractions)


def isolated(chain: Sequence[Digits]) -> Iterator[tuple[Decimal, Decimal]]:
    """Yield intervals with one positive root of a polynomial each, by the sign changes of its Sturm chain."""
    if not chain:
        return
    F = chain[0]
    # The odd factor keeps the middles off round numbers, where exact roots may lie.
    low, high = 1 / _bound(F[::-1]), Decimal("1.137") * _bound(F)
    open_ = [(low, high, sign_changes(chain, low), sign_changes(chain, high))]
    while open_:
        low, high, left, right = open_.pop()
        if left - right == 1:
            yield low, high
        elif left != right:
            middle = (low * high).sqrt()
            if not low < middle < high:
                raise NotDecidedError("two roots are closer than the digits")
            between = sign_changes(chain, middle)
            open_ += [(low, middle, left, between), (middle, high, between, right)]


def sturm_chain(F: Digits, digits: int, *, multiple: bool = False) -> list[Digits]:
    """Return the Sturm chain of a polynomial.

    Parameters
    ----------
    F : tuple of Decimal
        At least of first degree.
    digits : int
        That are computed with.
    multiple : bool
        Whether there may be multiple roots: then it ends with their polynomial, where the rest is lost in rounding.

    Raises
    ------
    NotDecidedError
        If it ends so and there should be none.
    """
    chain = [_unit(F), _unit(derivative(F))]
    while len(chain[-1]) > 1:
        rest = _remainder(chain[-2], chain[-1])
        if max(map(abs, rest)) < Decimal(1).scaleb(-digits // 2):
            if multiple:
                break
            raise NotDecidedError("a remainder is lost in rounding: there may be a double root")
        chain.append(_unit(rest))
    return chain


def _remainder(upper: Digits, lower: Digits) -> Digits:
    """Return minus the remainder of upper / lower over the quotient's size; both have a largest coefficient of 1."""
    rest = list(upper)
    largest = Decimal(1)
    while len(rest) >= len(lower):
        quotient = rest.pop() / lower[-1]
        place = len(rest) - len(lower) + 1
        for k, a in enumerate(lower[:-1]):
            rest[place + k] -= quotient * a
        largest = max(largest, abs(quotient))
    return tuple(-a / largest for a in rest)


def _unit(p: Sequence[Decimal]) -> Digits:
    """Return p with a largest coefficient of 1; the sign stays."""
    size = max(map(abs, p))
    return tuple(a / size for a in p)


def _bound(F: Digits) -> Decimal:
    """Return more than the magnitude of every root (Fujiwara)."""
    n = len(F) - 1
    # The power of ten above |a|, and the whole one above its root: ten times too far at most.
    powers = [-(-((a / F[-1]).adjusted() + 1) // (n - k)) for k, a in enumerate(F[:-1]) if a]
    return 2 * Decimal(1).scaleb(max(powers, default=0))


def _value(p: Digits, x: Decimal) -> Decimal:
    value = Decimal(0)
    for a in reversed(p):
        value = value * x + a
    return value


def sign_changes(chain: Sequence[Digits], x: Decimal) -> int:
    """Return how often the sign changes along a Sturm chain at a place."""
    values = [_value(p, x) for p in chain]
    if not values[0]:
        raise NotDecidedError("a root lies on the edge of an interval")
    signs = [value > 0 for value in values if value]
    return sum(a != b for a, b in pairwise(signs))


def _refined(F: Digits, low: Decimal, high: Decimal, digits: int) -> Decimal:
    """Return the only root in an interval, by Newton's method kept inside by halving."""
    slope = derivative(F)
    rising = _value(F, low) < 0
    x, enough = (low * high).sqrt(), Decimal(1).scaleb(-digits // 2)
    for _ in range(20 * digits):
        value, steep = _value(F, x), _value(slope, x)
        low, high = (x, high) if (value < 0) == rising else (low, x)
        new = x - value / steep if steep else low
        new = new if low < new < high else (low * high).sqrt()
        if abs(new - x) <= enough * x:
            return new
        x = new
    raise NotDecidedError("a root is not found to half the digits")


def _damping(parts: Sequence[Digits], x: Decimal, digits: int) -> Decimal:
    """Return C_s of the crossing at w^2 = x."""
    halves = [[_value(half, x) for half in even_odd(p)] for p in parts]
    if len(halves) == 2:
        (ea, oa), (eb, ob) = halves
        top, bottom = (-ea * eb, -x * oa * ob), (eb * eb, x * ob * ob)
    else:
        (ea, oa), (eb, ob), (ec, oc) = halves
        top, bottom = (ec * oa, -ea * oc), (eb * oc, -ec * ob)
    for terms in (top, bottom):
        if abs(terms[0] + terms[1]) < (abs(terms[0]) + abs(terms[1])).scaleb(-digits // 4):
            raise NotDecidedError("the sign of a critical damping is open")
    return Decimal((top[0] + top[1]) / (bottom[0] + bottom[1]))


def _places(values: Sequence[Decimal]) -> list[Decimal]:
    """Return one damping in every interval, the first and the last as good as 0 and infinity."""
    ends = values or [Decimal(1)]
    between = [(a * b).sqrt() for a, b in pairwise(values)]
    places = [ends[0] / FAR, *between, ends[-1] * FAR]
    return places if values else places[1:]


def _unstable(core: Digits) -> int:
    """Return the number of roots in the right half-plane by Routh's column."""
    core = trim(core)
    zeros = next(k for k, a in enumerate(core) if a)
    signs = []
    for entry in routh_column(core[zeros:]):
        if not entry or entry != entry:
            raise NotDecidedError("an entry of Routh's column is zero")
        signs.append(bool(entry > 0))
    return int(zeros) + sum(a != b for a, b in pairwise(signs))


def _direction(parts: Sequence[Digits], C_s: Decimal, omega: Decimal) -> int:
    """Return +1 if the root at a critical value moves to the right as C_s grows, else -1."""
    x = omega * omega
    even, odd = even_odd(_at(parts, C_s))
    # p(j w) = E(x) + j w O(x); its derivative with respect to w is slope = 2 w E' + j (O + 2 x O').
    real, imaginary = 2 * omega * _value(derivative(even), x), _value(odd, x) + 2 * x * _value(derivative(odd), x)
    pull = _at([scale(p, k) for k, p in enumerate(parts)][1:], C_s)
    even_pull, odd_pull = (_value(part, x) for part in even_odd(pull))
    # ds/dC_s = j dw/dC_s = -j pull / slope; its real part has the sign of Im(pull conj(slope)).
    turn = omega * odd_pull * real - even_pull * imaginary
    return 1 if turn > 0 else -1

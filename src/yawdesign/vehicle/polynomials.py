"""Polynomials with coefficients of any number type: floats, NumPy arrays, CasADi SX, rationals, complex numbers.

A polynomial is a tuple of coefficients, lowest power first. The Python integer 0 is a *structural* zero: it is known
not to be there, and no operation is spent on it. So a sparse model stays sparse whatever its numbers are.
"""

from collections.abc import Callable, Iterable
from functools import reduce
from typing import Any, Protocol


class Number(Protocol):
    """What a coefficient can be: float, array, SX, rational, complex number; whatever adds and multiplies.

    Operations with numbers of another type give numbers of that type, so their results are not named here.
    """

    def __add__(self, other: Any, /) -> Any: ...
    def __radd__(self, other: Any, /) -> Any: ...
    def __sub__(self, other: Any, /) -> Any: ...
    def __mul__(self, other: Any, /) -> Any: ...
    def __rmul__(self, other: Any, /) -> Any: ...
    def __truediv__(self, other: Any, /) -> Any: ...
    def __rtruediv__(self, other: Any, /) -> Any: ...
    def __neg__(self) -> Any: ...


Polynomial = tuple[Any, ...]  # of Number: mypy takes no tuple of floats for one of a protocol's

ZERO: Polynomial = ()
ONE: Polynomial = (1,)


def plus(x: Number, y: Number) -> Any:
    """Return x + y without an operation where one of them is structurally zero."""
    if type(x) is int and x == 0:
        return y
    return x if type(y) is int and y == 0 else x + y


def times(x: Number, y: Number) -> Any:
    """Return x * y without an operation where one of them is structurally zero or one."""
    if type(x) is int and x in (0, 1):
        return y if x else 0
    if type(y) is int and y in (0, 1):
        return x if y else 0
    return x * y


def add(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p + q."""
    if len(p) < len(q):
        p, q = q, p
    return tuple(plus(a, b) for a, b in zip(p, q, strict=False)) + p[len(q) :]


def scale(p: Polynomial, factor: Number) -> Polynomial:
    """Return factor * p."""
    return tuple(times(a, factor) for a in p)


def multiply(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p * q."""
    if not p or not q:
        return ZERO
    out: list[Any] = [0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] = plus(out[i + j], times(a, b))
    return tuple(out)


def product(factors: Iterable[Polynomial]) -> Polynomial:
    """Return the product of polynomials, shortest first (fewest operations)."""
    return reduce(multiply, sorted(factors, key=len), ONE)


def evaluate(p: Polynomial, s: Number) -> Any:
    """Return p(s) by Horner's rule."""
    return reduce(lambda value, a: plus(times(value, s), a), reversed(p), 0)


def trim(p: Polynomial, is_zero: Callable[[Any], bool] = lambda a: bool(a == 0)) -> Polynomial:
    """Return p without leading coefficients that are zero (a damper with no damping lowers the degree)."""
    end = len(p)
    while end and is_zero(p[end - 1]):
        end -= 1
    return p[:end]


def even_odd(p: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Return the even part E(x) and the odd part O(x) of p(j w) = E(x) + j w O(x), x = w^2."""
    even, odd = (tuple(times((-1) ** k, a) for k, a in enumerate(half)) for half in (p[::2], p[1::2]))
    return even, odd


def derivative(p: Polynomial) -> Polynomial:
    """Return dp/ds."""
    return tuple(times(k, a) for k, a in enumerate(p))[1:]


def scale_variable(p: Polynomial, unit: Number) -> Polynomial:
    """Return p(unit * s): with unit = 100 rad/s the coefficients of a bogie span 1e10 instead of 1e46."""
    out, power = [], 1
    for a in p:
        out.append(times(a, power))
        power = power * unit
    return tuple(out)


def shift(p: Polynomial, sigma: Number) -> Polynomial:
    """Return p(s + sigma) by repeated synthetic division."""
    out = list(p)
    for start in range(len(out) - 1):
        for k in range(len(out) - 2, start - 1, -1):
            out[k] = plus(out[k], times(sigma, out[k + 1]))
    return tuple(out)

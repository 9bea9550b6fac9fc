"""Sums of products of powers: numbers in which a few variables stay letters.

A vehicle of such numbers has coefficients that say exactly how they depend on these variables.
"""

from collections.abc import Mapping
from typing import Any, Self

Powers = tuple[int, ...]

BASE = 64  # of the digits that the powers are in the number of a product: between -31 and 31


class PowerSum:
    """A sum of constants, each times a product of powers of variables.

    Parameters
    ----------
    constants : mapping int -> number
        Floats or decimals, one for every product. The powers of the variables, which may be negative, are the digits of
        the product's number; so the number of a product of two products is the sum of theirs.

    Examples
    --------
    >>> x, y = PowerSum.letters(2)
    >>> ((x + 2) * x / y - x).terms(2)
    {(2, -1): 1.0, (1, -1): 2.0, (1, 0): -1.0}
    """

    __slots__ = ("constants",)

    def __init__(self, constants: Mapping[int, Any]) -> None:
        self.constants = constants

    @classmethod
    def letters(cls, count: int, one: Any = 1.0) -> tuple[Self, ...]:
        """Return some variables, given the number one of the type of the constants."""
        return tuple(cls({BASE**k: one}) for k in range(count))

    def terms(self, count: int) -> dict[Powers, Any]:
        """Return the constants by the powers of as many variables."""
        return {_powers(number, count): x for number, x in self.constants.items()}

    def __add__(self, other: Any) -> "PowerSum":
        out = dict(self.constants)
        for number, x in _constants(other).items():
            out[number] = out[number] + x if number in out else x
        return PowerSum(out)

    __radd__ = __add__

    def __neg__(self) -> "PowerSum":
        return PowerSum({number: -x for number, x in self.constants.items()})

    def __sub__(self, other: Any) -> "PowerSum":
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> "PowerSum":
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> "PowerSum":
        if not isinstance(other, PowerSum):
            return PowerSum({number: x * other for number, x in self.constants.items()})
        out: dict[int, Any] = {}
        get, others = out.get, tuple(other.constants.items())
        for one, x in self.constants.items():
            for two, y in others:
                number = one + two
                out[number] = get(number, 0) + x * y
        return PowerSum(out)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "PowerSum":
        """Return the quotient by a number or by a single product."""
        ((number, x),) = _constants(other).items()
        return PowerSum({own - number: y / x for own, y in self.constants.items()})

    def __rtruediv__(self, other: Any) -> "PowerSum":
        return PowerSum(_constants(other)) / self


def _constants(x: Any) -> Mapping[int, Any]:
    return x.constants if isinstance(x, PowerSum) else {0: x}


def _powers(number: int, count: int) -> Powers:
    half, found = BASE // 2, []
    for _ in range(count):
        found.append((number + half) % BASE - half)
        number = (number - found[-1]) // BASE
    return tuple(found)

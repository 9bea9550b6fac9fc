"""Sums of products of powers: numbers in which a few variables stay letters.

A vehicle of such numbers has coefficients that say exactly how they depend on these variables.
"""

from collections.abc import Mapping
from decimal import Decimal
from typing import Any, Self

Powers = tuple[int, int, int]

BASE = 64  # of the digits that the powers are in the number of a product: between -31 and 31


class PowerSum:
    """A sum of constants, each times a product of powers of three variables.

    Parameters
    ----------
    constants : mapping int -> Decimal
        The constant before every product; the powers of the variables, which may be negative, are the digits of the
        product's number, so that the number of a product of two products is the sum of theirs.

    Examples
    --------
    >>> x, y, z = PowerSum.letters()
    >>> ((x + 2) * x / z - x).terms == {(2, 0, -1): 1, (1, 0, -1): 2, (1, 0, 0): -1}
    True
    """

    __slots__ = ("constants",)

    def __init__(self, constants: Mapping[int, Decimal]) -> None:
        self.constants = constants

    @classmethod
    def letters(cls) -> tuple[Self, Self, Self]:
        """Return the three variables."""
        return cls({1: Decimal(1)}), cls({BASE: Decimal(1)}), cls({BASE * BASE: Decimal(1)})

    @property
    def terms(self) -> dict[Powers, Decimal]:
        """The constants by the powers of the variables."""
        return {_powers(number): x for number, x in self.constants.items()}

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
        out: dict[int, Decimal] = {}
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
        return self * PowerSum({-number: 1 / x})

    def __rtruediv__(self, other: Any) -> "PowerSum":
        return PowerSum(_constants(other)) / self


def _constants(x: Any) -> Mapping[int, Decimal]:
    return x.constants if isinstance(x, PowerSum) else {0: Decimal(x)}


def _powers(number: int) -> Powers:
    half = BASE // 2
    first = (number + half) % BASE - half
    number = (number - first) // BASE
    second = (number + half) % BASE - half
    return first, second, (number - second) // BASE

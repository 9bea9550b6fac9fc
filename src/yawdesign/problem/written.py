"""Floats that remember the exact number that was written.

So exact arithmetic sees 626.48 and not its nearest double.
"""

from __future__ import annotations

from fractions import Fraction
from numbers import Rational


class Written(float):
    """A float that remembers the exact number as it was written.

    Parameters
    ----------
    value : Fraction, int, str or float
        The number; a float stands for its shortest decimal.

    Examples
    --------
    >>> w = Written("626.48")
    >>> w, w.exact, w + 0.5
    (626.48, Fraction(15662, 25), 626.98)
    """

    __slots__ = ("exact",)
    exact: Fraction

    def __new__(cls, value: Fraction | float | str) -> Written:
        """Make the nearest double of `value`."""
        fraction = Fraction(value) if isinstance(value, str) else exact(value)
        self = super().__new__(cls, fraction)
        self.exact = fraction
        return self

    def __reduce__(self) -> tuple[type[Written], tuple[Fraction]]:
        return Written, (self.exact,)


def exact(value: Fraction | float) -> Fraction:
    """Return the exact number that `value` stands for.

    Parameters
    ----------
    value : Written, int, Fraction or float
        A plain float stands for its shortest written decimal.

    Returns
    -------
    Fraction
        The exact number.

    Examples
    --------
    >>> exact(626.48), exact(Written(Fraction(1, 3)))
    (Fraction(15662, 25), Fraction(1, 3))
    """
    if isinstance(value, Written):
        return value.exact
    if isinstance(value, Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    return Fraction(repr(float(value)))

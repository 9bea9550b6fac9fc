"""Routh's scheme: whether all roots of a polynomial in the left half-plane, left of a line, inside a sector.

No determinant is ever formed. The scheme divides only by its own leading entries, so it runs on floats, arrays (many
bogies at once), CasADi SX and rationals. A zero leading entry makes what follows NaN or infinite: not a verdict, and
`is_stable` then answers False; whoever needs certainty near the boundary asks the eigenvalues.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.vehicle.polynomials import Number, Polynomial, plus, scale_variable, shift, times, trim

TIME_UNIT = 100.0  # rad/s; in this unit a bogie's coefficients span ten powers of ten instead of 46


def quotient(upper: Sequence[Any], lower: Sequence[Any]) -> tuple[Any, Any]:
    """Return both coefficients of the linear quotient that cancels the two highest powers (highest first)."""
    alpha = _divide(upper[0], lower[0])
    second = plus(upper[1], times(-1, times(alpha, lower[1] if len(lower) > 1 else 0)))
    return alpha, _divide(second, lower[0])


def _remainder(upper: Sequence[Any], lower: Sequence[Any]) -> list[Any]:
    """Return quotient * lower - upper (highest power first)."""
    alpha, beta = quotient(upper, lower)
    out = []
    for k in range(2, len(upper)):
        linear = times(alpha, lower[k]) if k < len(lower) else 0
        out.append(plus(plus(linear, times(beta, lower[k - 1])), times(-1, upper[k])))
    return out


def _divide(x: Number, y: Number) -> Any:
    if type(x) is int and x == 0:
        return 0
    try:
        return x / y
    except ZeroDivisionError:  # plain floats and rationals raise where arrays give NaN or infinity
        return math.nan


def _rows(upper: list[Any], lower: list[Any]) -> list[list[Any]]:
    """Return the Sturm chain that begins with two polynomials (highest power first)."""
    rows = [upper]
    while lower:
        rows.append(lower)
        upper, lower = lower, _remainder(upper, lower)
    return rows


def routh_column(p: Polynomial) -> list[Any]:
    """Return the first column of Routh's array of a real polynomial.

    Parameters
    ----------
    p : tuple
        Coefficients, lowest power first.

    Returns
    -------
    list
        As many entries as p has. All roots have negative real parts exactly if all entries have the same sign.

    Examples
    --------
    >>> routh_column((6.0, 11.0, 6.0, 1.0))
    [1.0, 6.0, 10.0, 6.0]
    """
    return [row[0] for row in routh_rows(p)]


def routh_rows(p: Polynomial) -> list[list[Any]]:
    """Return Routh's array of a real polynomial, lowest power first, with its zeros.

    Each entry of a row stands above the entries it is multiplied with: the first one of row k + 2 is a multiple of the
    third one of row k + 1, minus the third one of row k.
    """
    down = p[::-1]
    # p(j w) / j^n = U(w) - j V(w); only every second coefficient of U and of V is there.
    signed = [times((1, 1, -1, -1)[k % 4], a) for k, a in enumerate(down)]
    upper = [a if k % 2 == 0 else 0 for k, a in enumerate(signed)]
    lower = [a if k % 2 == 1 else 0 for k, a in enumerate(signed)][1:]
    return _rows(upper, lower)


def sector_column(p: Polynomial, zeta: Number, functions: Any = np) -> list[Any]:
    """Return a chain that is positive exactly if every root of p has a damping ratio above zeta.

    The polynomial is turned by asin(zeta), which brings the sector's edge onto the imaginary axis; since roots come in
    conjugate pairs one edge suffices. The chain is Routh's for complex coefficients.

    Parameters
    ----------
    p : tuple
        Real coefficients, lowest power first, the last one positive.
    zeta : float or array
        Damping ratio, 0 <= zeta < 1 (a sector wider than the half-plane has no edge of this kind).
    functions : module
        Where `sqrt` of zeta is: `numpy`, or `casadi` for SX.
    """
    return [row[0] for row in sector_rows(p, -zeta, functions.sqrt(1 - zeta * zeta))]


def sector_rows(p: Polynomial, cosine: Number, sine: Number) -> list[list[Any]]:
    """Return Routh's array for the complex coefficients of p turned by an angle less 90 degrees, given by its cosine.

    It counts the roots right of a line through zero whose upper half stands at that angle: with the cosine -zeta those
    of an upper half-plane with less damping than zeta, and their conjugates with less than -zeta.
    """
    # Coefficient of z^(n-k) in the turned p, divided by the turn of z^n and by j^k: multiples of the angle.
    upper, lower, cosines, sines = [], [], 1, 0
    for a in p[::-1]:
        upper.append(times(cosines, a))
        lower.append(times(sines, a))
        cosines, sines = (
            plus(times(cosines, cosine), times(-1, times(sines, sine))),
            plus(times(sines, cosine), times(cosines, sine)),
        )
    return _rows(upper, lower[1:])


def is_stable(column: Sequence[Any]) -> NDArray[np.bool_]:
    """Return where all entries of a Routh column of numbers or arrays are positive."""
    verdict = np.asarray(column[0] > 0)
    for entry in column[1:]:
        verdict = verdict & (entry > 0)
    return verdict


def decays_faster(p: Polynomial, sigma: Number) -> NDArray[np.bool_]:
    """Return where all roots of p (numbers or arrays) have a decay rate above sigma [1/s]."""
    with np.errstate(all="ignore"):
        return is_stable(routh_column(shift(_scaled(p), -sigma / TIME_UNIT)))


def damped_more(p: Polynomial, zeta: Number) -> NDArray[np.bool_]:
    """Return where all roots of p (numbers or arrays) have a damping ratio above zeta."""
    with np.errstate(all="ignore"):
        return is_stable(sector_column(_scaled(p), zeta))


def count_unstable(p: Polynomial) -> int:
    """Return the number of roots not in the left half-plane: sign changes of Routh's column, and roots at zero.

    Where a whole row is zero, the row above it is a factor with roots s and -s: it goes on with the derivative of that
    factor, and what this does not count to the right half-plane lies on the axis in pairs. -1 if the scheme breaks
    down.
    """
    zeros = next((k for k, a in enumerate(p) if a != 0), 0)
    with np.errstate(all="ignore"):
        column, axis = _column_without_zero_rows(_scaled(p[zeros:]))
    if not np.all(np.isfinite(column)) or np.any(column == 0):
        return -1
    return zeros + axis + int(np.sum(np.sign(column[:-1]) != np.sign(column[1:])))


def _column_without_zero_rows(p: Polynomial) -> tuple[NDArray[np.float64], int]:
    """Return Routh's column, and how many roots lie on the axis because a row was zero."""
    rows = routh_rows(p)
    zero = next((k for k, row in enumerate(rows) if not np.any(np.asarray(row, dtype=float))), None)
    column = np.array([row[0] for row in rows[:zero]], dtype=float)
    if zero is None:
        return column, 0
    # Entries of a row stand at every second power of w, the first at the highest, which is the number of rows below.
    above = rows[zero - 1]
    if len(above) < 2:  # the last row is the last coefficient: it was lost to underflow
        return np.append(column, 0.0), 0
    degree = len(rows) - zero
    slope = [times(degree - k, a) for k, a in enumerate(above[:-1])]
    below = np.array([row[0] for row in _rows(list(above), slope)], dtype=float)
    changes = int(np.sum(np.sign(below[:-1]) != np.sign(below[1:])))
    return np.concatenate([column, below[1:]]), degree - 2 * changes


def _scaled(p: Polynomial) -> Polynomial:
    """Return p in s / (100 rad/s), without highest coefficients that are zero everywhere."""
    return scale_variable(trim(p, lambda a: bool(np.all(a == 0))), TIME_UNIT)

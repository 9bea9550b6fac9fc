"""Hurwitz minors Delta_1 ... Delta_n as sign and logarithm, from Routh's column.

The minors of the paper's polynomial reach 1e653 and cannot be formed in double precision. Since
``Delta_k = r_1 r_2 ... r_k`` with r the column of Routh's array, their signs and logarithms can.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from yawdesign.hunting.routh import TIME_UNIT, routh_column
from yawdesign.problem import ProblemError
from yawdesign.vehicle.vehicle import Model


def require_paper_bogie(model: Model) -> None:
    """Raise an error if eq. (9) is not written for a model: it is that of one bogie whose yaw dampers have joints."""
    if model.has_car_body or "C_s" not in model.joints:
        raise ProblemError(
            "eq. (9) and its Hurwitz minors are those of one bogie whose yaw dampers have joints: "
            "leave out the car body and give K_ds, or ask Routh's column"
        )


def hurwitz_minors(chi: Sequence[Any], unit: float = TIME_UNIT, functions: Any = np) -> tuple[list[Any], list[Any]]:
    """Return signs and decimal logarithms of the Hurwitz minors.

    Parameters
    ----------
    chi : sequence
        Coefficients chi_0 ... chi_n of eq. (9), highest power of s first, of the polynomial in s / unit, as
        `yawdesign.vehicle.motions.paper_coefficients` gives them. Numbers, arrays, or CasADi SX.
    unit : float
        That time scale [rad/s]; it is taken out of the result.
    functions : module
        Where `sign`, `fabs` and `log10` of these numbers are: `numpy`, or `casadi` for SX.

    Returns
    -------
    signs, logarithms : list
        Of Delta_1 ... Delta_n in SI units. A minor that is zero has sign 0 and logarithm -inf; those after it have
        sign 0 or NaN.

    Examples
    --------
    >>> signs, logarithms = hurwitz_minors((1.0, 6.0, 11.0, 6.0), unit=1.0)
    >>> [round(float(s * 10**e), 6) for s, e in zip(signs, logarithms)]
    [6.0, 60.0, 360.0]
    """
    n = len(chi) - 1
    signs, logarithms, sign, logarithm = [], [], 1.0, 0.0
    with np.errstate(all="ignore"):
        for k, entry in enumerate(routh_column(tuple(reversed(chi)))[1:], start=1):
            sign = sign * functions.sign(entry)
            logarithm = logarithm + functions.log10(functions.fabs(entry))
            signs.append(sign)
            # In s / unit coefficient i carries unit^(n-i); Delta_k is isobaric: weight k (k + 1) / 2, degree k.
            logarithms.append(logarithm - (n * k - k * (k + 1) / 2) * math.log10(unit))
    return signs, logarithms

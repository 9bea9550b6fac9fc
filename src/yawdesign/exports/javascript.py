"""The characteristic polynomials of a vehicle for a script in a page: speed, conicity and creep stay variables.

Every coefficient of every motion is a sum of constants times powers of conicity, creep factor and 1/v, which the code
that serves all numbers gives when it runs on such sums. The roots of a vehicle with a car body lie so close to each
other that coefficients of double precision leave them three digits: a constant comes as two doubles, which add up to
30 digits.
"""

import base64
import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal, localcontext
from typing import Any

from yawdesign.exports.power_sums import Powers, PowerSum
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.problem import Problem
from yawdesign.problem.condition import CREEP
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.polynomials import Polynomial, scale_variable
from yawdesign.vehicle.vehicle import Model

DIGITS = 60  # of the constants while they are computed
DAMPING_UNIT = 1_000_000  # N s/m, in which C_s is counted

Constants = list[tuple[int, int, Powers, Decimal]]  # power of C_s, power of s, powers of the variables, constant


def page_polynomials(problem: Problem) -> dict[str, Any]:
    """Return the polynomials of all motions of a problem's vehicle, ready for JSON.

    All parameters but ``lambda``, ``v``, C_s and a factor of both creep coefficients have the values of the problem.

    Parameters
    ----------
    problem : Problem
        Its conditions are not looked at.

    Returns
    -------
    dict
        ``time_unit`` [rad/s], ``damping_unit`` [N s/m] and ``motions``. Each of these has a ``name``; ``counts``,
        whether it counts in margins; and ``monomials``, powers of [lambda, creep factor, 1/v]. For every constant
        ``places`` has three bytes, the power of C_s, that of s and the number of the monomial, and ``values`` two
        doubles of eight bytes, the lowest first, whose sum is the constant; both are base64. The constants belong to
        s / time_unit and C_s / damping_unit, and a common factor is left out.

    Examples
    --------
    >>> import yawdesign as yd
    >>> coupled, motors = page_polynomials(yd.table1())["motions"]
    >>> coupled["counts"], motors["counts"], motors["name"]
    (True, False, 'motors yawing against each other')
    """
    model = Model.of(problem)
    movable = model.movable(problem.design.variables)
    with localcontext(prec=DIGITS):
        found = [(motion.name, list(_constants(motion))) for motion in model.at(_numbers(problem)).motions]
        motions = [{"name": name, "counts": name in movable, **_packed(constants)} for name, constants in found]
    return {"time_unit": TIME_UNIT, "damping_unit": DAMPING_UNIT, "motions": motions}


def _numbers(problem: Problem) -> dict[str, Any]:
    """Return the numbers of a vehicle whose conicity, creep factor and speed are letters."""
    conicity, creep, slowness = PowerSum.letters()
    p: dict[str, Any] = {name: Decimal(float(x)) for name, x in problem.parameters().items()}
    return p | {name: p[name] * creep for name in CREEP} | {"lambda": conicity, "v": 1 / slowness}


def _constants(motion: Motion) -> Iterator[tuple[int, int, Powers, Decimal]]:
    for power, polynomial in enumerate(motion.coefficients):
        scaled: Polynomial = scale_variable(polynomial, int(TIME_UNIT))
        for k, a in enumerate(scaled):
            terms: Mapping[Powers, Any] = a.terms if isinstance(a, PowerSum) else {(0, 0, 0): a}
            for powers, x in terms.items():
                if x:
                    yield power, k, powers, Decimal(x) * DAMPING_UNIT**power


def _packed(constants: Constants) -> dict[str, Any]:
    monomials = sorted({powers for _, _, powers, _ in constants})
    number = {powers: k for k, powers in enumerate(monomials)}
    unit = max(abs(x) for *_, x in constants)
    return {
        "monomials": monomials,
        "places": _base64("B", (k for power, s, powers, _ in constants for k in (power, s, number[powers]))),
        "values": _base64("d", (half for *_, x in constants for half in _halves(x / unit))),
    }


def _halves(x: Decimal) -> tuple[float, float]:
    """Return two doubles whose sum is a number to 32 digits."""
    high = float(x)
    return high, float(x - Decimal(high))


def _base64(kind: str, numbers: Iterable[float]) -> str:
    listed: Sequence[float] = list(numbers)
    return base64.b64encode(struct.pack(f"<{len(listed)}{kind}", *listed)).decode("ascii")

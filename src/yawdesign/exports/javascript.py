"""The equations of a vehicle for a script in a page: yaw damping, speed, conicity and creep stay variables.

Every coefficient of a characteristic polynomial, and every entry of a state matrix, is a sum of constants times powers
of these variables: the code that serves all numbers gives it when it runs on such sums. The roots of a vehicle with a
car body lie so close to each other that coefficients of double precision leave them three digits, at low speed none;
so a constant of a polynomial comes as two doubles, which add up to 30 digits, and roots come from the matrix.
"""

import base64
import struct
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal, localcontext
from typing import Any

from yawdesign.exports.power_sums import Powers, PowerSum
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.problem import Problem
from yawdesign.problem.condition import CREEP
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.polynomials import Polynomial, scale_variable
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Model

DIGITS = 60  # of the constants while they are computed
DAMPING_UNIT = 1_000_000  # N s/m, in which C_s is counted

Constants = list[tuple[int, int, Powers, Decimal]]  # power of C_s, power of s, powers of the variables, constant


def page_equations(problem: Problem) -> dict[str, Any]:
    """Return polynomial and state matrix of each motion of a problem's vehicle, ready for JSON.

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
        s / time_unit and C_s / damping_unit, and a common factor is left out. ``size`` is that of the state matrix,
        ``matrix`` its entries [row, column, constant, powers of lambda, creep factor, 1/v, C_s], some to be added, SI.

    Examples
    --------
    >>> import yawdesign as yd
    >>> coupled, motors = page_equations(yd.table1())["motions"]
    >>> coupled["counts"], motors["counts"], motors["name"]
    (True, False, 'motors yawing against each other')
    """
    model = Model.of(problem)
    movable = model.movable(problem.design.variables)
    with localcontext(prec=DIGITS):
        motions = model.at(_numbers(problem, Decimal)).motions
        packed = [_packed(list(_constants(motion))) for motion in motions]
    system = model.at(_numbers(problem, float)).folded_state_space
    return {
        "time_unit": TIME_UNIT,
        "damping_unit": DAMPING_UNIT,
        "motions": [
            {"name": motion.name, "counts": motion.name in movable, **polynomial, **_matrix(system, motion)}
            for motion, polynomial in zip(motions, packed, strict=True)
        ],
    }


def _numbers(problem: Problem, number: Callable[[float], Any]) -> dict[str, Any]:
    """Return the numbers of a vehicle, of one type; conicity, creep factor, speed and C_s are letters."""
    conicity, creep, slowness, C_s = PowerSum.letters(4, number(1))
    p = {name: number(float(x)) for name, x in problem.parameters().items()}
    letters = {"lambda": conicity, "v": 1 / slowness, "C_s": C_s}
    return p | {name: p[name] * creep for name in CREEP} | letters


def _terms(x: Any, letters: int) -> Mapping[Powers, Any]:
    return x.terms(letters) if isinstance(x, PowerSum) else {(0,) * letters: x}


def _matrix(system: StateSpace, motion: Motion) -> dict[str, Any]:
    place = {state: k for k, state in enumerate(system.states_of(motion.coordinates))}
    entries = [
        (place[i], place[j], x, *powers)
        for (i, j), entry in system.A.items()
        if i in place and j in place
        for powers, x in _terms(entry, 4).items()
        if x
    ]
    return {"size": len(place), "matrix": entries}


def _constants(motion: Motion) -> Iterator[tuple[int, int, Powers, Decimal]]:
    for power, polynomial in enumerate(motion.coefficients):
        scaled: Polynomial = scale_variable(polynomial, int(TIME_UNIT))
        for k, a in enumerate(scaled):
            for powers, x in _terms(a, 3).items():
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

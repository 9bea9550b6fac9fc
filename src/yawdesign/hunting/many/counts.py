"""The tapes: coefficients, and counts of roots right of a line that know when to be doubted.

All are made from the vehicle's own motions, fed with SX symbols. They belong to a model and to the parameters that are
zero, which lower the degree of the polynomials.
"""

import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache, reduce
from itertools import pairwise
from typing import Any

import casadi as ca

from yawdesign.hunting.many.tape import Tape
from yawdesign.hunting.routh import TIME_UNIT, quotient, routh_rows, sector_rows
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.polynomials import (
    Number,
    Polynomial,
    add,
    even_odd,
    multiply,
    plus,
    scale,
    scale_variable,
    shift,
    times,
    trim,
)
from yawdesign.vehicle.vehicle import Model, Vehicle

# A leading entry of Routh's array that is left over from a subtraction of numbers this much larger is doubted. With 16
# digits, 9 are then left. Of the million random bogies of benchmarks/sweep.py one is doubted, and none is wrong.
LEFT_OVER = 1e-7

Zeros = frozenset[str]
Rows = Sequence[Sequence[Any]]
Names = tuple[str, ...]

NO_ZEROS: Zeros = frozenset()


@lru_cache
def verdicts(model: Model, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape of verdicts.

    Parameters
    ----------
    model : Model
        Which equations.
    zeros : frozenset of str
        Parameters that are zero.

    Returns
    -------
    Tape
        Inputs: parameters, C_s, v. Outputs, 1 for yes and 0 for no: whether all motions are stable, and whether no step
        on the way to that answer is doubtful.
    """
    vehicle = _vehicle(model, zeros)
    return _tape(vehicle.p, _verdict(routh_rows(_scaled(motion, vehicle.C_s)) for motion in vehicle.motions))


@lru_cache
def others_stable(model: Model, zeros: Zeros = NO_ZEROS) -> Tape | None:
    """Return the tape of verdicts on the motions that no yaw damper reaches; None where it reaches all."""
    vehicle = _vehicle(model, zeros)
    others = [motion for motion in vehicle.motions if not motion.varied]
    return _tape(vehicle.p, _verdict(routh_rows(_scaled(motion, 0)) for motion in others)) if others else None


@lru_cache
def exceeding(model: Model, objective: str, names: Names, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape of verdicts whether the margins of some motions exceed a level.

    Inputs: parameters, C_s, v, and those of `beyond`. Outputs as those of `verdicts`.
    """
    vehicle, place = _vehicle(model, zeros), _place(objective)
    chosen = [motion for motion in vehicle.motions if motion.name in names]
    rows = [_beyond(objective, _scaled(motion, vehicle.C_s), place) for motion in chosen]
    return _tape({**vehicle.p, **place}, _verdict(rows))


@lru_cache
def beyond(objective: str, size: int, backwards: bool = False) -> Tape:
    """Return the tape that counts the roots beyond a line, of a polynomial with so many coefficients a0, a1, ...

    Further inputs for ``decay_rate``: ``level``; the roots right of -level are counted. For ``damping_ratio``:
    ``cosine``, ``sine`` of the angle at which the line through zero stands, -zeta and sqrt(1 - zeta^2); the roots right
    of it are counted. Outputs: the count, the number of doubtful steps in it, and where a root is that crosses the
    line: the square of its height above the real axis, or its distance from zero.

    The last rows of the array know the slowest of several roots near the line best. The array of the coefficients in
    the opposite order, whose roots are 1/s, counts the same, and it knows the fastest one.
    """
    a, place = _symbols(f"a{k}" for k in range(size)), _place(objective)
    rows = _beyond(objective, tuple(a.values()), place, backwards)
    # Where a pair of roots lies on the vertical line its factor r w^2 - c is left over, on another line r w - c.
    r, c = (rows[-3][0], rows[-1][0]) if objective == "decay_rate" else (rows[-2][0], -rows[-2][1])
    return _tape({**a, **place}, [*_count(rows), r / c if backwards else c / r])


@lru_cache
def coefficients(model: Model, name: str, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape of the polynomial of a motion in s / (100 rad/s), lowest power first."""
    vehicle = _vehicle(model, zeros)
    (motion,) = (motion for motion in vehicle.motions if motion.name == name)
    return _tape(vehicle.p, _scaled(motion, vehicle.C_s))


@lru_cache
def boundaries(model: Model, zeros: Zeros = NO_ZEROS) -> tuple[Tape, tuple[int, ...]]:
    """Return the tape of the polynomials that give the critical values, and their lengths.

    The outputs are the polynomials that the powers of C_s multiply, in s / (100 rad/s), lowest power first. Where there
    are two, A and B, then comes E_B O_A - E_A O_B in x = w^2.
    """
    vehicle = _vehicle(model, zeros)
    parts = [scale_variable(_without_zeros(q), TIME_UNIT) for q in vehicle.coupled.coefficients]
    if len(parts) == 2:
        (even_a, odd_a), (even_b, odd_b) = map(even_odd, parts)
        parts.append(_without_zeros(add(multiply(even_b, odd_a), scale(multiply(even_a, odd_b), -1))))
    return _tape(vehicle.p, [a for part in parts for a in part]), tuple(map(len, parts))


@lru_cache
def unstable_roots(model: Model, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape that counts the unstable roots of the coupled motion.

    Inputs: parameters, C_s, v. Outputs: the count, the number of doubtful steps in it, and the last entry but one of
    Routh's column: a quotient of Hurwitz minors that changes its sign where a pair of roots crosses the imaginary axis.
    """
    vehicle = _vehicle(model, zeros)
    rows = routh_rows(_scaled(vehicle.coupled, vehicle.C_s))
    return _tape(vehicle.p, [*_count(rows), rows[-2][0]])


@lru_cache
def counts(size: int) -> Tape:
    """Return the tape that counts the unstable roots of a polynomial with so many coefficients a0, a1, ...

    Outputs: the count, and the number of doubtful steps in it.
    """
    a = _symbols(f"a{k}" for k in range(size))
    return _tape(a, _count(routh_rows(tuple(a.values()))))


def _symbols(names: Iterable[str]) -> dict[str, ca.SX]:
    return {name: ca.SX.sym(name) for name in names}


@lru_cache
def _vehicle(model: Model, zeros: Zeros) -> Vehicle:
    """Return the vehicle whose numbers are symbols, but for those that are zero."""
    return model.at(_symbols(model.parameters) | dict.fromkeys(zeros, ca.SX(0)))


def _scaled(motion: Motion, C_s: Number) -> Polynomial:
    """Return the polynomial of a motion in s / (100 rad/s)."""
    return scale_variable(_without_zeros(motion.polynomial(C_s)), TIME_UNIT)


def _without_zeros(p: Polynomial) -> Polynomial:
    return trim(p, lambda a: bool(ca.SX(a).is_zero()))


def _place(objective: str) -> dict[str, ca.SX]:
    return _symbols(("level",) if objective == "decay_rate" else ("cosine", "sine"))


def _beyond(objective: str, p: Polynomial, place: Mapping[str, ca.SX], backwards: bool = False) -> Rows:
    if objective == "decay_rate":
        moved = shift(p, -place["level"])
        return routh_rows(moved[::-1] if backwards else moved)
    return sector_rows(p[::-1] if backwards else p, place["cosine"], place["sine"])


def _verdict(arrays: Iterable[Rows]) -> list[Any]:
    """Return whether all first entries are positive, and whether none is doubtful.

    Zero is doubtful where it lowers the degree or is left over from a difference; elsewhere it is not positive. Where
    the second entry, a coefficient, is not, there is no doubt whatever comes of the division by it.
    """
    positive, sure = [], []
    for rows in arrays:
        own = [ca.SX(row[0]) > 0 for row in rows]
        known = [_sure(rows, k) for k in range(len(rows))]
        positive += own
        sure.append(reduce(times, known) + reduce(times, known[:2]) * (1 - own[1]) > 0)
    return [reduce(times, positive), reduce(times, sure)]


def _sure(rows: Rows, k: int) -> Any:
    size, entry = _left_over_from(rows, k), ca.fabs(ca.SX(rows[k][0]))
    if size is None and k:
        return entry < sys.float_info.max
    return LEFT_OVER * (0 if size is None else size) < entry


def _count(rows: Rows) -> list[Any]:
    """Return the number of sign changes in Routh's column, and the number of doubtful entries; zero is doubtful."""
    negative = [ca.SX(row[0]) < 0 for row in rows]
    changes = [(a - b) ** 2 for a, b in pairwise(negative)]
    sizes = [_left_over_from(rows, k) for k in range(len(rows))]
    sure = [LEFT_OVER * (0 if x is None else x) < ca.fabs(row[0]) for x, row in zip(sizes, rows, strict=True)]
    return [reduce(plus, changes), len(rows) - reduce(plus, sure)]


def _left_over_from(rows: Rows, k: int) -> Any:
    """Return the size of the numbers of which the first entry of a row is the difference; None if it is none."""
    if k < 2:
        return None
    upper, lower = rows[k - 2], rows[k - 1]
    alpha, beta = quotient(upper, lower)
    linear = times(alpha, lower[2] if len(lower) > 2 else 0)
    # Of three numbers that cancel, two are large. The second coefficient of the quotient may be a difference too.
    others = [times(beta, lower[1]), upper[2]]
    if sum(map(_is_there, (linear, *others))) < 2:
        return None
    if _is_there(others[0]):
        others.append(times(upper[1], lower[1]) / lower[0])
    return reduce(plus, [ca.fabs(x) for x in others if _is_there(x)])


def _is_there(x: Any) -> bool:
    """Return whether a number is not structurally zero."""
    return not ca.SX(x).is_zero()


def _tape(inputs: Mapping[str, Any], outputs: Iterable[Any]) -> Tape:
    results = ca.vertcat(*map(ca.SX, outputs))
    used = [name for name, x in inputs.items() if x.is_symbolic() and ca.depends_on(results, x)]
    return Tape(ca.Function("tape", [inputs[name] for name in used], [results], used, ["results"]))

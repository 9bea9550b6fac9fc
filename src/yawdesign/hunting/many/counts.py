"""The tapes: coefficients, and counts of roots right of a line that know when to be doubted.

All are made from the vehicle's own motions, fed with SX symbols. They belong to a model and to the parameters that are
zero, which lower the degree of the polynomials.
"""

import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import lru_cache, reduce
from itertools import pairwise
from typing import Any

import casadi as ca

from yawdesign.hunting.many.kept_tapes import kept
from yawdesign.hunting.many.recording import record
from yawdesign.hunting.many.tape import Tape
from yawdesign.hunting.routh import TIME_UNIT, quotient, routh_rows, sector_rows
from yawdesign.vehicle.motions import COUPLED
from yawdesign.vehicle.polynomials import (
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
# In a longer array, that of a vehicle with car body, errors have more rows to grow in. Of 2 450 levels each a millionth
# of the margin away from it, 2 are then on the wrong side without a doubt; a hundred thousandth away, none.
LEFT_OVER_OF_MANY = 1e-6
MANY_ROWS = 30

Zeros = frozenset[str]
Rows = Sequence[Sequence[Any]]
Names = tuple[str, ...]

NO_ZEROS: Zeros = frozenset()


@lru_cache
@kept
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
    return _tape(vehicle.p, _verdict(routh_rows(p) for p in _polynomials(vehicle)))


@lru_cache
@kept
def others_stable(model: Model, zeros: Zeros = NO_ZEROS) -> Tape | None:
    """Return the tape of verdicts on the motions that no yaw damper reaches; None where it reaches all."""
    vehicle = _vehicle(model, zeros)
    others = [motion.name for motion in model.motions if not motion.varied]
    return _tape(vehicle.p, _verdict(routh_rows(p) for p in _polynomials(vehicle, others))) if others else None


@lru_cache
@kept
def exceeding(model: Model, objective: str, names: Names, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape of verdicts whether the margins of some motions exceed a level.

    Inputs: parameters, C_s, v, and those of `beyond`. Outputs as those of `verdicts`.
    """
    vehicle, place = _vehicle(model, zeros), _place(objective)
    return _tape({**vehicle.p, **place}, _verdict(_beyond(objective, p, place) for p in _polynomials(vehicle, names)))


@lru_cache
@kept
def roots_beyond(model: Model, objective: str, names: Names, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape that counts the roots of some motions beyond a line.

    Inputs: parameters, C_s, v, and those of `beyond`. Outputs: the count over all of these motions, the number of
    doubtful steps in it, and the same two for the right half-plane where the line is another one (``damping_ratio``).
    """
    vehicle, place = _vehicle(model, zeros), _place(objective)
    chosen = _polynomials(vehicle, names)
    found = _counts(_beyond(objective, p, place) for p in chosen)
    unstable = _counts(map(routh_rows, chosen)) if objective == "damping_ratio" else []
    return _tape({**vehicle.p, **place}, [*found, *unstable])


@lru_cache
@kept
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
@kept
def coefficients(model: Model, name: str, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape of the polynomial of a motion in s / (100 rad/s), lowest power first."""
    vehicle = _vehicle(model, zeros)
    (p,) = _polynomials(vehicle, [name])
    return _tape(vehicle.p, p)


@lru_cache
def boundaries(model: Model, zeros: Zeros = NO_ZEROS) -> tuple[Tape, tuple[int, int, int]]:
    """Return the tape of the polynomials that give the critical values, and their lengths.

    The outputs are A, B, both in s / (100 rad/s), and E_B O_A - E_A O_B in x = w^2, lowest power first.
    """
    vehicle = _vehicle(model, zeros)
    A, B = (scale_variable(_without_zeros(q), TIME_UNIT) for q in vehicle.coupled.coefficients)
    (even_a, odd_a), (even_b, odd_b) = even_odd(A), even_odd(B)
    F = _without_zeros(add(multiply(even_b, odd_a), scale(multiply(even_a, odd_b), -1)))
    return _tape(vehicle.p, [*A, *B, *F]), (len(A), len(B), len(F))


@lru_cache
@kept
def unstable_roots(model: Model, zeros: Zeros = NO_ZEROS) -> Tape:
    """Return the tape that counts the unstable roots of the coupled motion.

    Inputs: parameters, C_s, v. Outputs: the count, the number of doubtful steps in it, and the last entry but one of
    Routh's column: a quotient of Hurwitz minors that changes its sign where a pair of roots crosses the imaginary axis.
    """
    vehicle = _vehicle(model, zeros)
    (p,) = _polynomials(vehicle, [COUPLED])
    rows = routh_rows(p)
    return _tape(vehicle.p, [*_count(rows), rows[-2][0]])


@lru_cache
@kept
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


def _polynomials(vehicle: Vehicle, names: Collection[str] | None = None) -> list[Polynomial]:
    """Return the polynomials of motions, of all if none are named, in s / (100 rad/s)."""
    chosen = (p for name, p in vehicle.polynomials.items() if names is None or name in names)
    return [scale_variable(_without_zeros(p), TIME_UNIT) for p in chosen]


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
    return _least(rows) * (0 if size is None else size) < entry


def _least(rows: Rows) -> float:
    """Return which share of the numbers of which an entry is the difference it must have not to be doubted."""
    return LEFT_OVER_OF_MANY if len(rows) > MANY_ROWS else LEFT_OVER


def _count(rows: Rows) -> list[Any]:
    """Return the number of sign changes in Routh's column, and the number of doubtful entries; zero is doubtful."""
    negative = [ca.SX(row[0]) < 0 for row in rows]
    changes = [(a - b) ** 2 for a, b in pairwise(negative)]
    sizes = [_left_over_from(rows, k) for k in range(len(rows))]
    least = _least(rows)
    sure = [least * (0 if x is None else x) < ca.fabs(row[0]) for x, row in zip(sizes, rows, strict=True)]
    return [reduce(plus, changes), len(rows) - reduce(plus, sure)]


def _counts(arrays: Iterable[Rows]) -> list[Any]:
    """Return the sums of `_count` over some arrays."""
    return [reduce(plus, column) for column in zip(*map(_count, arrays), strict=True)]


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
        others.append(times(upper[1], lower[1] / lower[0]))  # a product of two coefficients might overflow
    return reduce(plus, [ca.fabs(x) for x in others if _is_there(x)])


def _is_there(x: Any) -> bool:
    """Return whether a number is not structurally zero."""
    return not ca.SX(x).is_zero()


def _tape(inputs: Mapping[str, Any], outputs: Iterable[Any]) -> Tape:
    results = ca.vertcat(*map(ca.SX, outputs))
    used = [name for name, x in inputs.items() if x.is_symbolic() and ca.depends_on(results, x)]
    return Tape(record(ca.Function("tape", [inputs[name] for name in used], [results], used, ["results"])))

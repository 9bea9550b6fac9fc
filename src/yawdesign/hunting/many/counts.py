"""The graphs from which the tapes are made: coefficients, and counts of unstable roots that know when to be doubted."""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache, reduce
from itertools import pairwise
from typing import Any

import casadi as ca

from yawdesign.hunting.many.tape import Tape
from yawdesign.hunting.routh import TIME_UNIT, routh_rows
from yawdesign.problem.parameters import parameter_keys
from yawdesign.vehicle.old import Characteristic, characteristic
from yawdesign.vehicle.polynomials import (
    Polynomial,
    add,
    even_odd,
    multiply,
    plus,
    scale,
    scale_variable,
    times,
    trim,
)

# A leading entry of Routh's array that is left over from a subtraction of numbers this much larger is doubted. With 16
# digits, 9 are then left. Of the million random bogies of benchmarks/sweep.py one is doubted, and none is wrong.
LEFT_OVER = 1e-7

Zeros = frozenset[str]


@lru_cache
def verdicts(kind: str, equations: str, zeros: Zeros = frozenset()) -> Tape:
    """Return the tape of verdicts.

    Parameters
    ----------
    kind, equations : str
        As in `yawdesign.vehicle.catalogue.bogie`.
    zeros : frozenset of str
        Parameters that are zero: they lower the degree.

    Returns
    -------
    Tape
        Inputs: parameters, C_s, v. Outputs, 1 for yes and 0 for no: whether all modes are stable, and whether no step
        on the way to that answer is doubtful.
    """
    p, c = _bogie(kind, equations, zeros)
    rows = routh_rows(scale_variable(_without_zeros(c.core(p["C_s"])), TIME_UNIT))
    # A motion k + c s + m s^2 of its own is stable if its coefficients are positive.
    alone = [a for factor in c.factors.values() for a in factor]
    stable = reduce(times, [ca.SX(a) > 0 for a in [*alone, *(row[0] for row in rows)]])
    return _tape(p, [stable, reduce(times, _sure(rows))])


@lru_cache
def boundaries(kind: str, equations: str, zeros: Zeros = frozenset()) -> tuple[Tape, tuple[int, int, int]]:
    """Return the tape of the polynomials that give the critical values, and their lengths.

    The outputs are A, B, both in s / (100 rad/s), and E_B O_A - E_A O_B in x = w^2, lowest power first.
    """
    p, c = _bogie(kind, equations, zeros)
    A, B = (scale_variable(_without_zeros(q), TIME_UNIT) for q in (c.A, c.B))
    (even_a, odd_a), (even_b, odd_b) = even_odd(A), even_odd(B)
    F = _without_zeros(add(multiply(even_b, odd_a), scale(multiply(even_a, odd_b), -1)))
    return _tape(p, [*A, *B, *F]), (len(A), len(B), len(F))


@lru_cache
def unstable_roots(kind: str, equations: str, zeros: Zeros = frozenset()) -> Tape:
    """Return the tape that counts the unstable roots of the coupled motion.

    Inputs: parameters, C_s, v. Outputs: the count, the number of doubtful steps in it, and the last entry but one of
    Routh's column: a quotient of Hurwitz minors that changes its sign where a pair of roots crosses the imaginary axis.
    """
    p, c = _bogie(kind, equations, zeros)
    rows = routh_rows(scale_variable(_without_zeros(c.core(p["C_s"])), TIME_UNIT))
    return _tape(p, [*_count(rows), rows[-2][0]])


@lru_cache
def decoupled(kind: str, equations: str, zeros: Zeros = frozenset()) -> tuple[Tape, tuple[str, ...]]:
    """Return the tape of the polynomials k + c s + m s^2 of the decoupled motions, k, c, m of each, and their names."""
    p, c = _bogie(kind, equations, zeros)
    return _tape(p, [a for factor in c.factors.values() for a in factor]), tuple(c.factors)


@lru_cache
def counts(size: int) -> Tape:
    """Return the tape that counts the unstable roots of a polynomial with so many coefficients a0, a1, ...

    Outputs: the count, and the number of doubtful steps in it.
    """
    inputs = {f"a{k}": ca.SX.sym(f"a{k}") for k in range(size)}
    return _tape(inputs, _count(routh_rows(tuple(inputs.values()))))


def _bogie(kind: str, equations: str, zeros: Zeros) -> tuple[dict[str, ca.SX], Characteristic]:
    names = [name for name in (*parameter_keys(kind), "v") if name not in zeros]
    symbols = {name: ca.SX.sym(name) for name in names}
    given = {name: x for name, x in symbols.items() if name != "C_s"} | dict.fromkeys(zeros, ca.SX(0))
    return symbols | {"C_s": symbols.get("C_s", ca.SX(0))}, characteristic(given, kind=kind, equations=equations)


def _without_zeros(p: Polynomial) -> Polynomial:
    return trim(p, lambda a: bool(ca.SX(a).is_zero()))


def _count(rows: Sequence[Sequence[Any]]) -> list[ca.SX]:
    """Return the number of sign changes in Routh's column, and the number of doubtful entries."""
    negative = [ca.SX(row[0]) < 0 for row in rows]
    changes = [(a - b) ** 2 for a, b in pairwise(negative)]
    return [reduce(plus, changes), len(rows) - reduce(plus, _sure(rows))]


def _sure(rows: Sequence[Sequence[Any]]) -> list[ca.SX]:
    """Return for every entry of Routh's column whether it is larger than its doubt; what is no number is not."""
    return [_doubt(rows, k) < ca.fabs(row[0]) for k, row in enumerate(rows)]


def _doubt(rows: Sequence[Sequence[Any]], k: int) -> Any:
    minuend = rows[k - 2][2] if k >= 2 and len(rows[k - 2]) > 2 else 0
    return LEFT_OVER * ca.fabs(minuend)


def _tape(inputs: Mapping[str, ca.SX], outputs: Iterable[Any]) -> Tape:
    results = ca.vertcat(*map(ca.SX, outputs))
    used = [name for name, x in inputs.items() if x.is_symbolic() and ca.depends_on(results, x)]
    return Tape(ca.Function("tape", [inputs[name] for name in used], [results], used, ["results"]))

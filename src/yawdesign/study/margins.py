"""Margins of many points: eigenvalues in stacks, checked by the polynomial."""

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float
from yawdesign.hunting.eigenvalues import MARGINS, backward_error, count_undamped
from yawdesign.hunting.many import counts as kernels
from yawdesign.hunting.many.parameter_sets import Block
from yawdesign.hunting.old import core_matrix, fixed_factors
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.verdict import EXACT
from yawdesign.study.question import Question
from yawdesign.vehicle.polynomials import Polynomial, scale_variable

ROWS = (
    256  # points whose eigenvalues fit a cache, and an allocator that gives larger pieces back to the system each time
)


def margins(question: Question, block: Block) -> tuple[Float, Bools]:
    """Return the worst margin over all speeds at every point, and whether it passed the checks."""
    found = [_margin(question, case) for case in block.cases(question.speeds)]
    return np.min([value for value, _ in found], axis=0), np.all([passed for _, passed in found], axis=0)


def _margin(question: Question, case: Block) -> tuple[Float, Bools]:
    s = eigenvalues(question, case)
    moved = np.concatenate([s, *_moved(question, case)], axis=1)
    return MARGINS[question.of](moved), _agrees(question, case, s)


def eigenvalues(question: Question, case: Block) -> Complex:
    """Return the eigenvalues of the coupled motion, shape (n, number of modes); NaN where a damper has no damping.

    Such a damper has no state of its own: where it is one among others, the point is left to the thorough way.
    """
    with np.errstate(all="ignore"):
        matrix = core_matrix(case.values, case.values["C_s"], **question.model)
    matrix = np.broadcast_to(matrix, (case.size, *matrix.shape[-2:]))
    regular = np.isfinite(matrix).all(axis=(1, 2))
    s = np.full(matrix.shape[:2], np.nan + 0j)
    s[regular] = np.linalg.eigvals(matrix[regular])
    return s


def _agrees(question: Question, case: Block, s: Complex) -> Bools:
    """Return whether every eigenvalue is a root of the polynomial, and Routh's array counts as many unstable ones."""
    core = scale_variable(_core(question, case), 1 / TIME_UNIT)
    parts = [slice(k, k + ROWS) for k in range(0, len(s), ROWS)]
    with np.errstate(all="ignore"):
        errors = [backward_error(tuple(a[part] for a in core), s[part]) for part in parts]
        unstable = count_undamped(s)
    exact = (np.concatenate(errors) < EXACT).all(axis=1)
    count, doubts, _ = kernels.unstable_roots(question.kind, question.equations, case.zeros)(case.values)
    return np.asarray(exact & (doubts == 0) & (count == unstable))


def _core(question: Question, case: Block) -> Polynomial:
    """Return A + C_s B in s / (100 rad/s), with coefficients of shape (n, 1)."""
    tape, (na, nb, _) = kernels.boundaries(question.kind, question.equations, case.zeros - {"C_s"})
    values = tape(case.values)
    core = np.zeros((max(na, nb), values.shape[1]))
    core[:na] += values[:na]
    core[:nb] += case.values["C_s"] * values[na : na + nb]
    return tuple(row[:, None] for row in core[: na if "C_s" in case.zeros else None])


def _moved(question: Question, case: Block) -> list[Complex]:
    """Return the roots of the decoupled motions that some design variable moves."""
    tape, names = kernels.decoupled(question.kind, question.equations, case.zeros)
    if not names:
        return []
    fixed = fixed_factors(case.point(0), question.variables, **question.model)
    coefficients = tape(case.values).reshape(len(names), 3, -1)
    return [_quadratic(abc, case.size) for name, abc in zip(names, coefficients, strict=True) if name not in fixed]


def _quadratic(coefficients: Float, size: int) -> Complex:
    """Return both roots of k + c s + m s^2."""
    k, c, m = coefficients
    turn = np.sqrt((c * c - 4 * k * m).astype(complex))
    larger = -(c + turn) / 2  # no cancellation: c is not negative
    with np.errstate(all="ignore"):
        other = np.where(larger == 0, 0, k / larger)
    return np.broadcast_to(np.stack([larger / m, other], axis=-1), (size, 2))

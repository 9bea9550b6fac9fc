"""Eigenvalues with their right and left eigenvectors, found in each independent part of the motion by itself.

Parts that nothing couples may have roots that cross exactly. So the matrix is first taken apart along its own zeros:
the strongly connected parts of its graph have their own eigenvalues, and no root can be taken for one of another part.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy.linalg as sl

from yawdesign.hunting.arrays import Bools, Complex, Float, Index
from yawdesign.response.modes.doublets import purify
from yawdesign.vehicle.determinant import independent_parts, reached_from
from yawdesign.vehicle.elements import parted

ROUNDING = 1e-13  # relative to the size of the matrix


def parts(pattern: Bools) -> tuple[Index, ...]:
    """Return the states of each independent part of a motion, given where its state matrix is not zero.

    Numbers that are zero, such as a conicity, may take apart what the equations couple.
    """
    found = independent_parts(_edges(pattern | np.eye(len(pattern), dtype=bool)))
    return tuple(np.array(states) for states in sorted(sorted(part) for part in found))


def _edges(pattern: Bools) -> list[tuple[int, int]]:
    rows, columns = np.nonzero(pattern)
    return [*zip(rows.tolist(), columns.tolist(), strict=True)]


@dataclass(frozen=True)
class Eigensystem:
    """Eigenvalues of one part of a motion: the real ones falling, those above the real axis, then their conjugates.

    Parameters
    ----------
    s : ndarray, shape (n,)
        Eigenvalues [1/s].
    right, left : ndarray, shape (n, n)
        Eigenvectors in the columns, ``left[:, k] @ right[:, k] == 1``.
    real : int
        Number of real eigenvalues.
    """

    s: Complex
    right: Complex
    left: Complex
    real: int

    @property
    def twin(self) -> Index:
        """For each eigenvalue the place of its conjugate."""
        pairs = (len(self.s) - self.real) // 2
        above = np.arange(self.real, self.real + pairs)
        return np.concatenate([np.arange(self.real), above + pairs, above])

    def velocity(self, change: Float) -> Complex:
        """Return by how much each eigenvalue moves, to first order, when the matrix changes by `change`."""
        return np.asarray(np.einsum("ik,ij,jk->k", self.left, change, self.right))


def spectrum(matrix: Float) -> Eigensystem:
    """Return the spectrum of a real matrix."""
    s, w, v = cast(tuple[Complex, Complex, Complex], sl.eig(matrix, left=True, right=True))
    _set_zeros(matrix, s, w, v)
    real = np.flatnonzero(s.imag == 0)
    real = real[np.argsort(-s[real].real, kind="stable")]
    above = np.flatnonzero(s.imag > 0)
    above = above[np.lexsort((s[above].real, s[above].imag))]
    s = np.concatenate([s[real], s[above], s[above].conj()])
    v = np.hstack([v[:, real], v[:, above], v[:, above].conj()])
    w = np.hstack([w[:, real], w[:, above], w[:, above].conj()]).conj()
    scale = np.sum(w * v, axis=0)
    # Where two roots coincide the product vanishes; the vectors then say nothing, but they stay finite.
    w = np.asarray(w / np.where(scale == 0, 1, scale), dtype=complex)
    _purify(s, w, v, len(real), rounding(matrix))
    return Eigensystem(s, v, w, len(real))


def _purify(s: Complex, w: Complex, v: Complex, real: int, size: float) -> None:
    """Give roots above the axis that are one within rounding, and their conjugates, pure motions."""
    above = np.arange(real, real + (len(s) - real) // 2)
    left, right = w[:, above], v[:, above]
    if purify(s[above], left, right, size):
        w[:, above], w[:, above + len(above)] = left, left.conj()
        v[:, above], v[:, above + len(above)] = right, right.conj()


def rounding(matrix: Float) -> float:
    """Return the size of the error that an eigenvalue of a matrix must be expected to have [1/s]."""
    return ROUNDING * float(np.linalg.norm(sl.matrix_balance(matrix, permute=False)[0]))


def _set_zeros(matrix: Float, s: Complex, w: Complex, v: Complex) -> None:
    """Make roots that are zero within rounding zero, with eigenvectors that belong together.

    Bodies that no spring holds have such roots at every value of a parameter, and several of them are one to the last
    digit: without this it were chance which is which, and whether they are a pair.
    """
    zero = np.flatnonzero(np.abs(s) <= rounding(matrix))
    if not zero.size:
        return
    s[zero] = 0
    balanced, (scale, _) = sl.matrix_balance(matrix, permute=False, separate=True)
    left, size, right = np.linalg.svd(balanced)
    if zero.size > 1 and size[-zero.size] <= ROUNDING * size[0]:
        right, left = right[-zero.size :].T, left[:, -zero.size :]
        v[:, zero], w[:, zero] = scale[:, None] * right, np.linalg.solve(right.T @ left, (left / scale[:, None]).T).T


def whole_vector(matrix: Float, states: Index, s: complex, vector: Complex) -> Complex:
    """Return the eigenvector of the whole matrix, given that of the part it belongs to.

    A part may drive others that do not act back (the motors' yaw in the model as printed). Where these have the same
    root (a body that nothing holds: twice zero), only the driven part moves.
    """
    out = np.zeros(len(matrix), dtype=complex)
    out[states] = vector
    driven = _driven_by(matrix, states)
    if driven.size:
        force = matrix[np.ix_(driven, states)] @ vector
        free = s * np.eye(driven.size) - matrix[np.ix_(driven, driven)]
        try:
            out[driven] = np.linalg.solve(free, force)
        except np.linalg.LinAlgError:
            out[states], out[driven] = 0, np.linalg.svd(free)[2][-1].conj()
    return out


def _driven_by(matrix: Float, states: Index) -> Index:
    """Return the states outside a part that move because the part moves."""
    others = np.setdiff1d(np.arange(len(matrix)), states)
    if not matrix[np.ix_(others, states)].any():
        return others[:0]
    reached = reached_from(int(states[0]), _edges(matrix.T != 0))
    return np.intersect1d(others, [*reached])


def unfold(names: Sequence[str], values: Complex, *, forces: bool = False) -> dict[str, complex]:
    """Return what belongs to each end, given half the sum (a name ending in +) and half the difference (in -).

    Where pairs stand inside a pair, the outer end comes first: of ``y_w+-`` and the like the ends ``y_w11``, ...,
    ``y_w22``; of ``y_w1+`` and ``y_w1-`` the inner ones.

    Parameters
    ----------
    names : sequence of str
        One for each value.
    values : ndarray
        Displacements.
    forces : bool
        The values are not displacements but what multiplies them (a left eigenvector): half of each then belongs to
        either end.
    """
    half = 0.5 if forces else 1.0
    out = {name: complex(value) for name, value in zip(names, values, strict=True)}
    while any("+" in parted(name)[1] for name in out):
        found, out = out, {}
        for name, value in found.items():
            stem, ends = parted(name)
            outer, sign, inner = _first_sign(ends)
            if sign == "+":
                other = found[f"{stem}{outer}-{inner}"]
                out[f"{stem}{outer}1{inner}"] = half * (value + other)
                out[f"{stem}{outer}2{inner}"] = half * (value - other)
            elif not sign:
                out[name] = value
    return out


def _first_sign(ends: str) -> tuple[str, str, str]:
    """Return the ends before the first sign, that sign, and what stands behind it."""
    outer = ends[: len(ends) - len(ends.lstrip("12"))]
    return outer, ends[len(outer) : len(outer) + 1], ends[len(outer) + 1 :]

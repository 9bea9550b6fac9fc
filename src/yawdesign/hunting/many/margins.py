"""Margins of many vehicles, and whether they exceed a level.

A line in the plane of the roots, vertical or through zero, is moved until exactly one root, or one conjugate pair, lies
beyond it, by counts with Routh's array. That root is found by Newton's method, and it is the one that the margin
belongs to: there is no other. What is not decided this way, such as two pairs with the same decay rate, is left to the
eigenvalues, which are checked by the polynomial and by a count of their own.
"""

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Bools, Complex, Float
from yawdesign.hunting.eigenvalues import EXACT, MARGINS, backward_error, count_undamped, motion_matrix
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.critical_values import value_and_slope
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.tape import Tape
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.vehicle.motions import Motion

# Between which powers of ten the margins are looked for, [rad/s / 100 rad/s] and [-].
POWERS = {"decay_rate": (-6.0, 2.0), "damping_ratio": (-6.0, 0.0)}
# Which trials look for the fastest of several roots near a line, the even or the odd ones; the others for the slowest.
BACKWARDS = {"decay_rate": 1, "damping_ratio": 0}
TRIALS = 3
HALVINGS = 6  # of the range of powers in each trial
STEPS = 6  # of Newton's method
APART = 32  # polynomials of which one is solved as a whole, for a start in the others
ROUNDING = 2e-15  # of the coefficients
ACCURATE = 1e-8  # largest error of a root that rounding may cause, relative to the margin
ROWS = 256  # vehicles whose eigenvalues fit a cache, and an allocator that gives larger pieces back each time


def stable(sets: ParameterSets) -> tuple[Bools, Bools]:
    """Return whether every vehicle is stable, and whether that is sure.

    Parameters
    ----------
    sets : ParameterSets
        With ``C_s`` and ``v``.
    """
    return _asked(counts.verdicts(sets.model, sets.zeros), sets)


def others_stable(sets: ParameterSets) -> tuple[Bools, Bools]:
    """Return whether the motions that no yaw damper reaches are stable, and whether that is sure.

    Parameters
    ----------
    sets : ParameterSets
        Their own ``C_s`` is not looked at.
    """
    tape = counts.others_stable(sets.model, sets.zeros - {"C_s"})
    every = np.ones(sets.size, dtype=bool)
    return _asked(tape, sets) if tape else (every, every)


def exceeds(
    sets: ParameterSets, objective: str, level: Float | float, variables: Collection[str], pairs: int = 0
) -> tuple[Bools, Bools]:
    """Return whether the margin of every vehicle exceeds a level, and whether that is sure.

    Parameters
    ----------
    sets : ParameterSets
        With ``C_s`` and ``v``.
    objective : {"decay_rate", "damping_ratio"}
        Which margin.
    level : float or array, shape (n,)
        Decay rate [1/s] or damping ratio [-]; a ratio below zero counts as zero.
    variables : collection of str
        Design variables; they decide which motions count in the margin.
    pairs : int
        So many pairs of roots, those that are worst, need not exceed the level; see `margins`.
    """
    names, level = sets.model.movable(variables), np.asarray(level, dtype=float)
    decay = objective == "decay_rate"
    line = _line(objective, level / TIME_UNIT if decay else np.clip(level, 0.0, 1.0))
    if pairs:
        tape = counts.roots_beyond(sets.model, objective, names, sets.zeros)
        found = np.broadcast_to(tape({**sets.values, **line}), (tape.size, sets.size))
        yes, sure = _at_most(_rank(objective, pairs), found)
    else:
        yes, sure = _asked(counts.exceeding(sets.model, objective, names, sets.zeros), sets, line)
    return (yes, sure) if decay else (yes & (level < 1), sure | (level >= 1))


def _rank(objective: str, pairs: int) -> int:
    """Return how many roots are left out with so many pairs: for a damping ratio one of each pair is counted."""
    return 2 * pairs if objective == "decay_rate" else pairs


def _at_most(most: int, found: Float) -> tuple[Bools, Bools]:
    """Return whether at most so many roots lie beyond a line, and whether that is sure; see `counts.roots_beyond`."""
    count, doubts, *right = found
    yes, sure = count <= most, doubts == 0
    if right:
        # The line counts the conjugates of unstable roots too, if they lie beyond it: up to twice as many.
        unstable, more_doubts = right
        sure &= yes | (count > 2 * most) | ((unstable == 0) & (more_doubts == 0))
    return yes, sure


def _asked(tape: Tape, sets: ParameterSets, more: Mapping[str, Any] = MappingProxyType({})) -> tuple[Bools, Bools]:
    yes, sure = tape({**sets.values, **more})
    return np.broadcast_to(yes > 0, sets.size), np.broadcast_to(sure > 0, sets.size)


def _line(objective: str, level: Float) -> dict[str, Float]:
    """Return the inputs of the tapes for a line at a level, in the tapes' unit of time."""
    if objective == "decay_rate":
        return {"level": level}
    return {"cosine": -level, "sine": np.sqrt((1 - level) * (1 + level))}


def margins(sets: ParameterSets, objective: str, variables: Collection[str], pairs: int = 0) -> tuple[Float, Bools]:
    """Return the margin of every vehicle, and whether it passed its checks.

    Parameters
    ----------
    sets : ParameterSets
        With ``C_s`` and ``v``.
    objective : {"decay_rate", "damping_ratio"}
        The margin: decay rate [1/s] or damping ratio [-], negative where a motion is unstable.
    variables : collection of str
        Design variables; they decide which motions count in the margin.
    pairs : int
        So many pairs of roots, those that are worst, are left out: of decay rates the least ``2 pairs``, where a real
        root is one; of damping ratios the least ``pairs`` of the upper half-plane, to which a real root belongs.
    """
    movable, rank = sets.model.movable(variables), _rank(objective, pairs)
    chosen = [motion for motion in sets.model.motions if motion.name in movable]
    # The next margin of all motions may be any of the first ones of each.
    ranks = range(rank + 1) if len(chosen) > 1 else [rank]
    found = [_of_motion(sets, objective, motion, k) for motion in chosen for k in ranks]
    value = np.sort([value for value, _ in found], axis=0)[rank if len(chosen) > 1 else 0]
    return value, np.all([passed for _, passed in found], axis=0)


def _of_motion(sets: ParameterSets, objective: str, motion: Motion, rank: int) -> tuple[Float, Bools]:
    """Return the margin of a motion without its so many worst roots, infinite if there are no others."""
    p = counts.coefficients(sets.model, motion.name, sets.zeros)(sets.values)
    p = np.broadcast_to(p, (len(p), sets.size))
    with np.errstate(all="ignore"):
        if len(p) == 3:
            both = _both_roots(p) * TIME_UNIT
            return _ranked(objective, both, rank), np.asarray(np.isfinite(both).all(axis=1))
        s, found = _slowest(p, rank) if objective == "decay_rate" else _least_damped(p, rank)
        value = MARGINS[objective](s[:, None] * TIME_UNIT)
        left = np.flatnonzero(~found)
        if len(left):
            every = eigenvalues(sets.part(left), motion)
            value[left] = _ranked(objective, every, rank)
            found[left] = _agrees(p[:, left], every)
    return value, found


def _each(objective: str, s: Complex) -> Float:
    """Return the margin of every root; of damping ratios infinity for a root of the lower half-plane."""
    value = MARGINS[objective](s[..., None])
    return value if objective == "decay_rate" else np.where(s.imag < 0, np.inf, value)


def _ranked(objective: str, s: Complex, rank: int) -> Float:
    """Return the margin of some roots, the so many worst ones left out: the last axis; NaN if one of them is none."""
    value = np.sort(_each(objective, s), axis=-1)
    last = value[..., rank] if rank < s.shape[-1] else np.full(s.shape[:-1], np.inf)
    return np.where(np.isnan(s).any(axis=-1), np.nan, last)


def _both_roots(p: Float) -> Complex:
    """Return the roots of polynomials of second degree k + c s + m s^2, shape (n, 2)."""
    k, c, m = p
    larger = -(c + np.sqrt((c * c - 4 * k * m).astype(complex))) / 2  # nothing cancels: no damping is negative
    return np.stack([larger / m, np.where(larger == 0, 0, k / larger)], axis=-1)


def _slowest(p: Float, rank: int = 0) -> tuple[Complex, Bools]:
    """Return the root of every polynomial that is farthest to the right, and where it is known to be that.

    With a rank so many roots are farther to the right.
    """
    count, sure, _ = _counted("decay_rate", p, np.zeros(p.shape[1]))
    left = count <= rank
    inside = np.where(left & sure, count, -np.inf) if rank else np.zeros(p.shape[1])
    return _found("decay_rate", p, np.where(left, 1.0, -1.0), rank, inside)


def _least_damped(p: Float, rank: int = 0) -> tuple[Complex, Bools]:
    """Return the root of every polynomial with the least damping ratio, and where it is known to be that.

    With a rank so many roots of the upper half-plane have less damping; then no unstable polynomial's is known.
    """
    count, sure, _ = _counted("decay_rate", p, np.zeros(p.shape[1]))
    s, found = np.zeros(p.shape[1], dtype=complex), np.zeros(p.shape[1], dtype=bool)
    stable, unstable = (np.flatnonzero(sure & chosen) for chosen in (count == 0, (count > 0) & (count <= 2)))
    s[stable], found[stable] = _found("damping_ratio", p[:, stable], np.ones(len(stable)), rank, np.zeros(len(stable)))
    if rank:
        return s, found
    # No line tells unstable roots by their ratio; one pair, or one real root, is also the one farthest to the right.
    alone = np.zeros(len(unstable))
    s[unstable], found[unstable] = _found("decay_rate", p[:, unstable], alone - 1.0, 0, alone)
    return s, found


class _Search(NamedTuple):
    """Polynomials whose root is looked for: it lies beyond an outer line and not beyond an inner one.

    Parameters
    ----------
    owner : array of int, shape (n,)
        Which of all polynomials these are.
    p : array, shape (size, n)
        Coefficients.
    sign, inner, outer : array, shape (n,)
        Sign of the levels at which the lines stand, and the powers of ten of their magnitudes.
    inside, beyond : array, shape (n,)
        How many roots surely lie beyond inner lines, the largest number that was met, and beyond outer ones, the least.
    start : array, shape (n,)
        Where the root may be.
    """

    owner: Any
    p: Any
    sign: Any
    inner: Any
    outer: Any
    inside: Any
    beyond: Any
    start: Any

    def part(self, chosen: Any) -> "_Search":
        return _Search(*(x[..., chosen] for x in self))


def _found(objective: str, p: Float, sign: Float, rank: int, inside: Float) -> tuple[Complex, Bools]:
    """Return the root that the margin belongs to, and where it is known to be that root.

    Parameters
    ----------
    objective, p
        Which margin, of which polynomials.
    sign : array, shape (n,)
        The sign of the margin.
    rank : int
        How many roots are worse.
    inside : array, shape (n,)
        How many roots surely lie beyond the first inner line.
    """
    n, (low, high) = p.shape[1], POWERS[objective]
    s, found = np.full(n, np.nan + 0j), np.zeros(n, dtype=bool)
    inner, outer = np.where(sign > 0, low, high), np.where(sign > 0, high, low)
    search = _Search(np.arange(n), p, sign, inner, outer, inside, np.full(n, np.inf), s)
    for trial in range(TRIALS + 1):
        if trial < TRIALS:
            for _ in range(HALVINGS):
                search = _halved(objective, search, rank, backwards=trial % 2 == BACKWARDS[objective])
        else:
            search = search._replace(start=_neighbours(objective, search.p, rank))
        root, error = _newton(search.p, search.start)
        right = _is_right(objective, search, root, error)
        s[search.owner[right]], found[search.owner[right]] = root[right], True
        search = search.part(~right)
        if not len(search.owner):
            break
    return s, found


def _halved(objective: str, search: _Search, rank: int, *, backwards: bool) -> _Search:
    """Return the search with a line in the middle, and where a root crosses that line."""
    middle = (search.inner + search.outer) / 2
    level = search.sign * 10**middle
    count, sure, crossing = _counted(objective, search.p, level, backwards)
    none = count <= rank
    if objective == "decay_rate":
        start = -level + 1j * np.where(count - search.inside == 1, 0.0, np.sqrt(np.maximum(crossing, 0.0)))
    else:
        line = _line(objective, level)
        start = crossing * (line["cosine"] + 1j * line["sine"])
    return search._replace(
        inner=np.where(none, middle, search.inner),
        outer=np.where(none, search.outer, middle),
        inside=np.where(none & sure, np.maximum(count, search.inside), search.inside) if rank else search.inside,
        beyond=np.where(none | ~sure, search.beyond, np.minimum(count, search.beyond)),
        start=start,
    )


def _is_right(objective: str, search: _Search, s: Complex, error: Float) -> Bools:
    """Return whether a root is accurate and lies between both lines, alone or with its conjugate."""
    margin, between = MARGINS[objective](s[:, None]), search.beyond - search.inside
    if objective == "decay_rate":
        real, pair = s.imag == 0, np.abs(s.imag) > 2 * error
        alone = (real & (between == 1)) | (pair & (between == 2))
    else:
        error, alone = error / np.abs(s), (s.imag > 0) & (between == 1)
    inner, outer = search.sign * 10**search.inner, search.sign * 10**search.outer
    return np.asarray(alone & (inner < margin) & (margin < outer) & (error < ACCURATE * np.abs(margin)))


def _neighbours(objective: str, p: Float, rank: int) -> Complex:
    """Return for each polynomial the root that the margin of one near it belongs to: in a sweep it is similar."""
    chosen = p[:, ::APART]
    companion = np.zeros((chosen.shape[1], len(p) - 1, len(p) - 1))
    companion[:, 1:, :-1] = np.eye(len(p) - 2)
    companion[:, :, -1] = -(chosen[:-1] / chosen[-1]).T
    companion[~np.isfinite(companion)] = 0.0
    roots = np.asarray(np.linalg.eigvals(companion), dtype=complex)
    worst = np.argsort(_each(objective, roots), axis=1)[:, rank]
    near = np.take_along_axis(roots, worst[:, None], axis=1)[:, 0]
    return np.repeat(near.real + 1j * np.abs(near.imag), APART)[: p.shape[1]]


def _counted(objective: str, p: Float, level: Float, backwards: bool = False) -> tuple[Float, Bools, Float]:
    """Return how many roots lie beyond a line, whether that is sure, and where one crosses it; see `counts.beyond`."""
    tape, a = counts.beyond(objective, len(p), backwards), {f"a{k}": row for k, row in enumerate(p)}
    count, doubts, crossing = tape(a | _line(objective, level))
    return count, doubts == 0, crossing


def _newton(p: Float, s: Complex) -> tuple[Complex, Float]:
    """Return the roots near some places, and how far off they may be."""
    for _ in range(STEPS):
        value, slope = value_and_slope(p, s)
        s = s - value / slope
    value, slope = value_and_slope(p, s)
    size, _ = value_and_slope(np.abs(p), np.asarray(np.abs(s)))
    return s, (np.abs(value) + ROUNDING * size) / np.abs(slope)


def eigenvalues(sets: ParameterSets, motion: Motion) -> Complex:
    """Return the eigenvalues of a motion of the model [1/s], shape (n, modes); NaN where a damper has no damping.

    Such a damper has no state of its own: where it is one among others, the vehicle is left to the single route.
    """
    with np.errstate(all="ignore"):
        matrix = motion_matrix(sets.vehicle, motion)
    matrix = np.broadcast_to(matrix, (sets.size, *matrix.shape[-2:]))
    regular = np.isfinite(matrix).all(axis=(1, 2))
    s = np.full(matrix.shape[:2], np.nan + 0j)
    s[regular] = np.linalg.eigvals(matrix[regular])
    return s


def _agrees(p: Float, s: Complex) -> Bools:
    """Return whether every eigenvalue is a root of its polynomial, and Routh's array counts as many unstable ones."""
    in_seconds = p * TIME_UNIT ** -np.arange(len(p))[:, None]
    parts = [slice(k, k + ROWS) for k in range(0, len(s), ROWS)]
    errors = [backward_error(tuple(in_seconds[:, part, None]), s[part]) for part in parts]
    count, sure, _ = _counted("decay_rate", p, np.zeros(p.shape[1]))
    exact = (np.concatenate(errors) < EXACT).all(axis=1)
    return np.asarray(exact & sure & (count == count_undamped(s)))

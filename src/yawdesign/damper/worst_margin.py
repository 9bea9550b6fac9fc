"""The worst margin of many designs under all conditions, and whether it exceeds a level.

Whether a margin exceeds a level is one verdict of Routh's array; the margin itself costs as much as many of them. So a
design that one condition has ruled out is not looked at under the next, and a condition that surely leaves more than
the worst one so far is not looked at closer.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues
from yawdesign.hunting.many.margins import exceeds
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.conditions import Condition

# Where a damper is so weak that its stroke's own root -K/c lies further out than this [1/s], its joint counts as rigid:
# it moves no other root by more than rounding does, and an eigenvalue that large would spoil all others. A damper
# without damping has no such root at all.
FASTEST = 1e10
TOGETHER = 8192  # designs times conditions that are looked at together; with more, one condition after the other


class WorstMargin:
    """The worst margin under some conditions.

    Parameters
    ----------
    conditions : sequence of Condition
        At least one.
    objective : {"decay_rate", "damping_ratio"}
        Which margin: [1/s] or [-].
    variables : sequence of str
        Design variables; they decide which motions count.
    pairs : int, optional
        So many pairs of roots, those of the least margins, are left out under each condition.
    floor : float, optional
        What the margin of all roots must reach; below it the margin of the others counts as minus infinity.
    """

    def __init__(
        self,
        conditions: Sequence[Condition],
        objective: str,
        variables: Sequence[str],
        pairs: int = 0,
        floor: float = -np.inf,
    ) -> None:
        self.conditions = tuple(conditions)
        self.objective = objective
        self.variables = tuple(variables)
        self.pairs = pairs
        self.floor = floor
        self._worst_of = np.zeros(len(self.conditions), dtype=int)  # how many designs have each as their worst

    @property
    def _order(self) -> Index:
        """The conditions, those first that were the worst for most designs."""
        return np.argsort(-self._worst_of, kind="stable")

    def exceeds(self, sets: ParameterSets, level: Float) -> Bools:
        """Return where the margin exceeds a level, by Routh's array; a ratio below zero counts as zero.

        Doubtful verdicts, those within rounding of the level, count as they are: they are no proof.

        Parameters
        ----------
        sets : ParameterSets
            With ``C_s``; the conditions bring ``v``.
        level : array, shape (n,)
            [1/s] or [-].
        """
        out = np.zeros(sets.size, dtype=bool)
        for left, part in _by_zeros(sets):
            rest = self._order
            while len(left) and len(rest):
                together = max(1, min(len(rest), TOGETHER // len(left)))
                some, rest = rest[:together], rest[together:]
                passed, _ = self._verdicts(part, level[left], some)
                part, left = part.part(passed.all(axis=0)), left[passed.all(axis=0)]
            out[left] = True
        return out

    def _verdicts(self, sets: ParameterSets, level: Float, chosen: Sequence[int] | Index) -> tuple[Bools, Bools]:
        """Return where margins exceed a level under some conditions, and where that is sure; shape (conditions, n)."""
        here, shape = _under(sets, [self.conditions[k] for k in chosen]), (len(chosen), sets.size)
        yes, sure = exceeds(here, self.objective, np.tile(level, len(chosen)), self.variables, self.pairs)
        if np.isfinite(self.floor) and yes.any():
            passed, yes, sure = np.flatnonzero(yes), yes.copy(), sure.copy()
            yes[passed], certain = exceeds(here.part(passed), self.objective, self.floor, self.variables)
            sure[passed] &= certain
        return yes.reshape(shape), sure.reshape(shape)

    def _margins(self, sets: ParameterSets) -> Float:
        return eigenvalue_margins(sets, self.objective, self.variables, self.pairs, self.floor)

    def under_each(self, sets: ParameterSets) -> Float:
        """Return the margins under every condition, shape (conditions, n). Parameter as in `exceeds`."""
        here = _under(sets, self.conditions)
        return self._margins(here).reshape(len(self.conditions), sets.size)

    def of(self, sets: ParameterSets) -> Float:
        """Return the margin. Parameter as in `exceeds`."""
        first, *others = self._order
        worst = self._margins(sets.under(self.conditions[first]))
        which = np.full(sets.size, first)
        for place, part in _by_zeros(sets) if others else ():
            value = self._where_less(part, worst[place], others)
            least = value.min(axis=0)
            lower = least < worst[place]
            worst[place[lower]], which[place[lower]] = least[lower], np.array(others)[value.argmin(axis=0)][lower]
        self._worst_of += np.bincount(which, minlength=len(self.conditions))
        return worst

    def _where_less(self, sets: ParameterSets, level: Float, chosen: Sequence[int]) -> Float:
        """Return margins under some conditions, shape (conditions, n); infinite where they surely exceed a level."""
        value = np.full((len(chosen), sets.size), np.inf)
        yes, sure = self._verdicts(sets, level, chosen)
        open_ = np.nonzero(~(yes & sure))
        here = _under(sets, [self.conditions[k] for k in chosen]).part(np.ravel_multi_index(open_, value.shape))
        value[open_] = self._margins(here)
        return value


def _under(sets: ParameterSets, conditions: Sequence[Condition]) -> ParameterSets:
    """Return sets under conditions, all sets under the first one, then all under the second, ..."""
    changed = [condition.applied(sets.values) for condition in conditions]
    values = {name: _end_to_end([p[name] for p in changed], sets.size) for name in changed[0]}
    return ParameterSets(sets.model, values, sets.size * len(conditions))


def _end_to_end(columns: Sequence[Any], size: int) -> Any:
    if all(x is columns[0] for x in columns) and not np.ndim(columns[0]):
        return columns[0]
    return np.concatenate([np.broadcast_to(x, size) for x in columns])


def _by_zeros(sets: ParameterSets) -> Iterator[tuple[Index, ParameterSets]]:
    """Yield which sets, and these, such that a damper in series with joints has no damping in all of them or in none.

    One without damping lowers the degree of the polynomial.
    """
    varied = [name for name in sets.model.joints if np.ndim(sets.values[name])]
    for place, without in _patterns([sets.values[name] == 0 for name in varied], sets.size):
        yield place, sets.part(place).replace(**{varied[k]: 0.0 for k in without})


def _patterns(conditions: Sequence[Bools], size: int) -> Iterator[tuple[Index, list[int]]]:
    """Yield the points at which the same conditions are true, and which ones are."""
    code = sum((2**k * true for k, true in enumerate(conditions)), start=np.zeros(size, dtype=int))
    for value in np.unique(code):
        yield np.flatnonzero(code == value), [k for k in range(len(conditions)) if value >> k & 1]


def eigenvalue_margins(
    sets: ParameterSets, objective: str, variables: Sequence[str], pairs: int = 0, floor: float = -np.inf
) -> Float:
    """Return margins from eigenvalues, those of rigid joints where a damper is next to none.

    Parameters
    ----------
    sets : ParameterSets
        With ``C_s`` and ``v``.
    objective, variables, pairs, floor
        As in `WorstMargin`.
    """
    out, joints = np.empty(sets.size), sets.model.joints
    rigid = [sets.whole(c) * FASTEST < sets.whole(K) for c, K in joints.items()]
    movable = sets.model.movable(variables)
    chosen = [motion for motion in sets.model.motions if motion.name in movable]
    for place, stiff in _patterns(rigid, sets.size):
        vehicle = sets.part(place).replace(**{[*joints.values()][k]: np.inf for k in stiff}).vehicle
        roots = [motion_eigenvalues(vehicle, motion) for motion in chosen]
        every = np.concatenate([np.broadcast_to(s, (len(place), s.shape[-1])) for s in roots], axis=1)
        margins = np.partition(MARGINS[objective](every[..., None]), (0, 2 * pairs), axis=1)
        out[place] = np.where(margins[:, 0] < floor, -np.inf, margins[:, 2 * pairs])
    return out

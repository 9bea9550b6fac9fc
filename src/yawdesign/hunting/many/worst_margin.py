"""The worst margin of many designs under all conditions, and whether it exceeds a level.

Whether a margin exceeds a level is one verdict of Routh's array; the margin itself costs as much as many of them. So a
design that one condition has ruled out is not looked at under the next, and a condition that surely leaves more than
the worst one so far is not looked at closer.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.vehicle import Model

TOGETHER = 8192  # designs times conditions that are looked at together; with more, one condition after the other


class WorstMargin:
    """The worst margin under some conditions.

    Parameters
    ----------
    conditions : sequence of Condition
        At least one.
    measure : Measure
        Which margin.
    """

    def __init__(self, conditions: Sequence[Condition], measure: Measure) -> None:
        self.conditions = tuple(conditions)
        self.measure = measure
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
        left, rest = np.arange(sets.size), self._order
        while len(left) and len(rest):
            together = max(1, min(len(rest), TOGETHER // len(left)))
            some, rest = rest[:together], rest[together:]
            passed, _ = self._verdicts(sets, level[left], some)
            good = passed.all(axis=0)
            if not good.all():
                sets, left = sets.part(good), left[good]
        out = np.zeros(len(level), dtype=bool)
        out[left] = True
        return out

    def _verdicts(self, sets: ParameterSets, level: Float, chosen: Sequence[int] | Index) -> tuple[Bools, Bools]:
        """Return where margins exceed a level under some conditions, and where that is sure; shape (conditions, n)."""
        here, shape = _under(sets, [self.conditions[k] for k in chosen]), (len(chosen), sets.size)
        yes, sure = self.measure.exceeds(here, np.tile(level, len(chosen)))
        return yes.reshape(shape), sure.reshape(shape)

    def under_each(self, sets: ParameterSets) -> Float:
        """Return the margins under every condition, shape (conditions, n). Parameter as in `exceeds`."""
        return self.measure.of(_under(sets, self.conditions)).reshape(len(self.conditions), sets.size)

    def of(self, sets: ParameterSets) -> Float:
        """Return the margin. Parameter as in `exceeds`."""
        return self.worst(sets)[0]

    def worst(self, sets: ParameterSets) -> tuple[Float, Index]:
        """Return the margin, and the number of the condition under which it is that. Parameter as in `exceeds`."""
        first, *others = self._order
        worst = self.measure.of(sets.under(self.conditions[first]))
        which = np.full(sets.size, first)
        if others:
            value = self._where_less(sets, worst, others)
            least = value.min(axis=0)
            lower = least < worst
            worst[lower], which[lower] = least[lower], np.array(others)[value.argmin(axis=0)][lower]
        self._worst_of += np.bincount(which, minlength=len(self.conditions))
        return worst, which

    def _where_less(self, sets: ParameterSets, level: Float, chosen: Sequence[int]) -> Float:
        """Return margins under some conditions, shape (conditions, n); infinite where they surely exceed a level."""
        value = np.full((len(chosen), sets.size), np.inf)
        yes, sure = self._verdicts(sets, level, chosen)
        open_ = np.nonzero(~(yes & sure))
        here = _under(sets, [self.conditions[k] for k in chosen]).part(np.ravel_multi_index(open_, value.shape))
        value[open_] = self.measure.of(here)
        return value


def _under(sets: ParameterSets, conditions: Sequence[Condition]) -> ParameterSets:
    """Return sets under conditions, all sets under the first one, then all under the second, ..."""
    return under_conditions(sets.model, sets.values, [(condition, sets.size) for condition in conditions])


def under_conditions(model: Model, p: Mapping[str, Any], ways: Sequence[tuple[Condition, int]]) -> ParameterSets:
    """Return vehicles under conditions, one after the other.

    Parameters
    ----------
    model : Model
        Which equations.
    p : mapping
        Numbers as designed.
    ways : sequence of (Condition, int)
        Each with the number of its vehicles; values of `p` and of the condition are numbers, or arrays of that length.
    """
    changed = [(condition.applied(p), size) for condition, size in ways]
    values = {name: _end_to_end([(q[name], size) for q, size in changed]) for name in changed[0][0]}
    return ParameterSets(model, values, sum(size for _, size in ways))


def _end_to_end(columns: Sequence[tuple[Any, int]]) -> Any:
    values, sizes = zip(*columns, strict=True)
    if any(isinstance(x, np.ndarray) for x in values):
        return np.concatenate([np.broadcast_to(x, size) for x, size in columns])
    if all(x is values[0] for x in values):
        return values[0]
    return np.repeat(np.array(values, dtype=float), sizes)

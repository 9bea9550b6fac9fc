"""How a margin is measured: which one, of which motions, and with which fault."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues
from yawdesign.hunting.many.margins import exceeds
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.cases import Case

# Where a damper is so weak that its stroke's own root -K/c lies further out than this [1/s], its joint counts as rigid:
# it moves no other root by more than rounding does, and an eigenvalue that large would spoil all others. A damper
# without damping has no such root at all.
FASTEST = 1e10


@dataclass(frozen=True)
class Measure:
    """A margin of many vehicles.

    Parameters
    ----------
    objective : {"decay_rate", "damping_ratio"}
        Which margin: [1/s] or [-].
    variables : tuple of str
        Design variables; they decide which motions count.
    case : Case, optional
        A fault of the vehicles.
    pairs : int, optional
        So many pairs of roots, those of the least margins, are left out.
    floor : float, optional
        What the margin of all roots must reach; below it the margin of the others counts as minus infinity.
    """

    objective: str
    variables: tuple[str, ...]
    case: Case | None = None
    pairs: int = 0
    floor: float = -np.inf

    @property
    def by_eigenvalues(self) -> bool:
        """Whether verdicts are taken from eigenvalues, which takes longer.

        Bogies that differ are not folded: their polynomials would take minutes to record.
        """
        return self.case is not None and self.case.of_one_bogie

    def exceeds(self, sets: ParameterSets, level: Float | float) -> tuple[Bools, Bools]:
        """Return where the margin exceeds a level, by Routh's array, and where that is sure.

        Parameters
        ----------
        sets : ParameterSets
            With ``C_s`` and ``v``.
        level : number or array, shape (n,)
            [1/s] or [-]; a ratio below zero counts as zero.
        """
        level = np.broadcast_to(np.asarray(level, dtype=float), sets.size)
        if self.by_eigenvalues:
            ratio = self.objective == "damping_ratio"
            return self.of(sets) > (np.maximum(level, 0.0) if ratio else level), np.ones(sets.size, dtype=bool)
        yes, sure = np.zeros((2, sets.size), dtype=bool)
        for place, part in parts_by_zeros(self._of_case(sets)):
            yes[place], sure[place] = self._exceeds(part, level[place])
        return yes, sure

    def _exceeds(self, sets: ParameterSets, level: Float) -> tuple[Bools, Bools]:
        yes, sure = exceeds(sets, self.objective, level, self.variables, self.pairs)
        if np.isfinite(self.floor) and yes.any():
            passed, yes, sure = np.flatnonzero(yes), yes.copy(), sure.copy()
            yes[passed], certain = exceeds(sets.part(passed), self.objective, self.floor, self.variables)
            sure[passed] &= certain
        return yes, sure

    def of(self, sets: ParameterSets) -> Float:
        """Return the margins by eigenvalues. Parameter as in `exceeds`."""
        sets = self._of_case(sets)
        return eigenvalue_margins(sets, self.objective, self.variables, self.pairs, self.floor)

    def _of_case(self, sets: ParameterSets) -> ParameterSets:
        return sets.with_fault(self.case) if self.case else sets


def parts_by_zeros(sets: ParameterSets) -> Iterator[tuple[Index, ParameterSets]]:
    """Yield places of sets, and these, such that a damper in series with joints has damping in all of them or in none.

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
        As in `Measure`.
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

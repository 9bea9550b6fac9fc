"""The verdict on a design under all conditions of a problem, maybe with a fault.

Of a short list every condition is looked at by both ways. Of a long one, and inside ranges, the conditions with the
lowest margins are searched by verdicts and eigenvalues in arrays, and then looked at by both ways. Where a fault makes
the bogies of a vehicle differ, eigenvalues alone search, and both ways look at the worst.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.scope import conditions_told
from yawdesign.hunting.verdict import CaseVerdict, Stability, stability_at
from yawdesign.hunting.worst_condition import worst_conditions
from yawdesign.problem import Problem
from yawdesign.problem.cases import Case
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet, condition_set
from yawdesign.vehicle.vehicle import Model

FEW = 32  # conditions of a list that are all looked at by both ways
FEW_SLOW = 2  # the same where bogies differ: Routh's array takes seconds there
COMPARED = 1000  # of more, and of corners of ranges: so many verdicts are compared with eigenvalues


@dataclass(frozen=True)
class Judged:
    """A design under all conditions of a problem.

    Parameters
    ----------
    problem : Problem
        Its own values of the parameters are not looked at.
    p : mapping
        The design: parameters by symbol in SI units, ``C_s`` [N s/m] among them.
    case : Case, optional
        A fault.
    """

    problem: Problem
    p: Mapping[str, float]
    case: Case | None = None

    @cached_property
    def conditions(self) -> ConditionSet:
        """Under which it is judged."""
        return condition_set(self.problem)

    @cached_property
    def model(self) -> Model:
        """Which equations, without the fault."""
        return Model.of(self.problem)

    @cached_property
    def every_mode(self) -> Measure:
        """The decay rate of all modes, whether a variable moves them or not."""
        return Measure("decay_rate", self.model.parameters, self.case)

    @cached_property
    def looked(self) -> Mapping[Condition, Stability]:
        """What was found under the worst conditions, by eigenvalues and Routh's array."""
        return {condition: self.at(condition) for condition in self._worst()}

    def _worst(self) -> Iterable[Condition]:
        if self._are_few:
            return self.conditions.lists
        variables = tuple(self.problem.design.variables)
        margins = [Measure(objective, variables, self.case) for objective in ("decay_rate", "damping_ratio")]
        found = [
            worst_conditions(self.model, dict(self.p), self.conditions, measure)[0].condition
            for measure in (self.every_mode, *margins)
        ]
        return dict.fromkeys(found)

    @property
    def _are_few(self) -> bool:
        few = FEW_SLOW if self.every_mode.by_eigenvalues else FEW
        return not self.conditions.ranges and len(self.conditions.lists) <= few

    def at(self, condition: Condition) -> Stability:
        """Return the stability under one condition."""
        vehicle = self.model.at(condition.applied(self.p))
        return stability_at(vehicle.with_fault(self.case) if self.case else vehicle, self.problem.design.variables)

    def least(self, margin: str) -> tuple[float, Condition]:
        """Return the worst of a margin, and where: ``decay_rate`` [1/s] or ``damping_ratio`` [-]."""
        condition, found = min(self.looked.items(), key=lambda item: getattr(item[1], margin))
        return float(getattr(found, margin)), condition

    @cached_property
    def checked(self) -> bool:
        """Whether both ways agree: under the worst conditions, and under the corners of many."""
        alone = self._are_few or self.every_mode.by_eigenvalues
        return all(found.checked for found in self.looked.values()) and (alone or self._verdicts_agree())

    def _verdicts_agree(self) -> bool:
        corners = self.conditions.corners
        some = corners[:: 1 + len(corners) // COMPARED]
        sets = under_conditions(self.model, self.p, [(condition, 1) for condition in some])
        yes, sure = self.every_mode.exceeds(sets, 0.0)
        return bool(np.all(~sure | (yes == (self.every_mode.of(sets) > 0))))

    @cached_property
    def worst_condition(self) -> Condition:
        """The condition of the least decay rate, of all modes where one is unstable."""
        unstable = {c: found for c, found in self.looked.items() if not found.stable}
        if unstable:
            return max(unstable, key=lambda condition: unstable[condition].spectral_abscissa)
        return self.least("decay_rate")[1]

    @property
    def verdict(self) -> Stability:
        """The stability under the worst condition, with the worst margins under all."""
        found = self.looked.values()
        return replace(
            self.looked[self.worst_condition],
            stable=all(x.stable for x in found),
            spectral_abscissa=max(x.spectral_abscissa for x in found),
            decay_rate=self.least("decay_rate")[0],
            damping_ratio=self.least("damping_ratio")[0],
            C_s=float(self.p["C_s"]),
            checked=self.checked,
            worst_condition=self.worst_condition.described,
            searched=conditions_told(self.conditions, self.p),
        )

    @property
    def case_verdict(self) -> CaseVerdict:
        """The same of a design with a fault, in short."""
        found, name = self.verdict, self.case.name if self.case else ""
        return CaseVerdict(
            name, found.stable, found.decay_rate, found.damping_ratio, found.worst_condition, found.checked
        )


def worst_verdict(problem: Problem, p: Mapping[str, float]) -> Stability:
    """Return the stability of a design under all conditions of a problem. Parameters as of `Judged`."""
    return Judged(problem, p).verdict


def case_verdicts(problem: Problem, p: Mapping[str, float]) -> tuple[CaseVerdict, ...]:
    """Return the stability of a design with each fault, under all conditions. Parameters as of `Judged`."""
    return tuple(Judged(problem, p, case).case_verdict for case in problem.cases)

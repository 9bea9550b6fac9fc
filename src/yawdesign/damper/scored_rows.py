"""Many dampers of a catalogue at once: margins, requirements, faults and the curve on arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from yawdesign.damper.candidates import (
    EXCEEDS,
    MISSES,
    OK,
    OUTSIDE,
    UNSTABLE,
    UNVERIFIED,
    Candidate,
    limits_passed,
    missed,
)
from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.demands import demands
from yawdesign.damper.design_space import Space
from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin
from yawdesign.hunting.requirements import required
from yawdesign.hunting.verdict import CaseVerdict, RequirementVerdict
from yawdesign.problem import PARAMETERS, Problem, ProblemError, Variable, format_quantity
from yawdesign.problem.cases import Case, Change
from yawdesign.problem.condition_texts import change_text
from yawdesign.problem.conditions import condition_set
from yawdesign.problem.damper_catalogue import CatalogueDamper
from yawdesign.problem.table import RIGID
from yawdesign.vehicle.vehicle import Model

OWN = ("C_s", "K_ds")  # what comes from the rows


def with_damper(problem: Problem, damper: CatalogueDamper) -> Problem:
    """Return a problem with a damper of its catalogue in it, and no catalogue; C_s is a design variable.

    A share of a rigid joint is rigid: what changes K_ds by a share is left out for a rigid one.
    """
    design, conditions, cases = problem.design, problem.conditions, problem.cases
    if "K_ds" in conditions.keys:
        raise ProblemError("conditions.K_ds: the rows of the catalogue have it; a deviation of it is a tolerance")
    if damper.K_ds == RIGID:
        conditions = replace(conditions, tolerance=tuple(x for x in conditions.tolerance if x[0] != "K_ds"))
        cases = tuple(_of_rigid(case) for case in cases)
    low, high = PARAMETERS["C_s"].hard
    variables = {name: x for name, x in design.variables.items() if name != "K_ds"}
    variables.setdefault("C_s", Variable(min=low, max=high))
    return replace(
        problem,
        bogie=replace(problem.bogie, C_s=damper.C_s, K_ds=damper.K_ds),
        design=replace(design, variables=variables, catalogue=()),
        conditions=conditions,
        cases=cases,
    )


def _of_rigid(case: Case) -> Case:
    def stays(change: Change) -> bool:
        return not (change.parameter == "K_ds" and change.share and change.value)

    return Case(case.name, tuple(filter(stays, case.changes)))


def bounds_of_rows(problem: Problem) -> dict[str, tuple[float, float]]:
    """Return the bounds of what comes from the rows, by name, where they are design variables [SI]."""
    variables = problem.design.variables
    return {name: (float(variables[name].min), float(variables[name].max)) for name in OWN if name in variables}


@dataclass(frozen=True)
class ScoredRows:
    """Dampers of a catalogue in one vehicle, all rigid or none of them.

    Parameters
    ----------
    problem : Problem
        With the catalogue.
    dampers : tuple of CatalogueDamper
        At least one.
    """

    problem: Problem
    dampers: tuple[CatalogueDamper, ...]

    @cached_property
    def space(self) -> Space:
        """The design space of the vehicle, with the conditions that are looked at."""
        problem = with_damper(self.problem, self.dampers[0])
        given = condition_set(problem).first_look
        asked = (each.conditions.first_look for each in demands(problem, Model.of(problem)))
        return Space(problem, known=(given, *asked))

    @cached_property
    def values(self) -> dict[str, Any]:
        """The numbers of all rows."""
        p = {name: float(value) for name, value in self.space.problem.parameters().items()}
        own = {name: np.array([float(getattr(each, name)) for each in self.dampers]) for name in OWN}
        return {**p, **{name: x for name, x in own.items() if name in p}}

    @cached_property
    def sets(self) -> ParameterSets:
        """The same as parameter sets."""
        return ParameterSets(self.space.model, self.values, len(self.dampers))

    def candidates(self) -> list[Candidate]:
        """Return what each row is worth, as far as arrays tell."""
        margin, which = self.space.worst_margin.worst(self.sets)
        requirements, cases, resistance = self._requirements(), self._cases(), self._resistance()
        everything = Measure("decay_rate", self.space.model.parameters)
        growth, when = WorstMargin(self.space.conditions, everything).worst(self.sets)
        found = []
        for k, damper in enumerate(self.dampers):
            candidate = Candidate(
                name=damper.name,
                C_s=float(damper.C_s),
                K_ds=float(damper.K_ds),
                margin=float(margin[k]),
                worst_condition=self.space.conditions[which[k]].described,
                rotational_resistance=None if resistance is None else float(resistance[k]),
                requirements=tuple(each[k] for each in requirements),
                cases=tuple(each[k] for each in cases),
                status=OK,
                reason="",
                searched=False,
                per_side=damper.per_side,
                blow_off=None if damper.blow_off is None else float(damper.blow_off),
                damping_after=None if damper.damping_after is None else float(damper.damping_after),
            )
            told = self.judged(candidate, float(growth[k]), self.space.conditions[when[k]].described)
            found.append(told)
        return found

    def judged(self, candidate: Candidate, decay: float, at: Mapping[str, Any]) -> Candidate:
        """Return a candidate with its status and the reason.

        Parameters
        ----------
        candidate : Candidate
            What it is worth.
        decay, at : float, mapping
            Least decay rate of all modes [1/s], and the condition of it.
        """
        passed = limits_passed({"C_s": candidate.C_s, "K_ds": candidate.K_ds}, bounds_of_rows(self.problem))
        short = missed(candidate.requirements)
        if passed:
            return replace(candidate, status=OUTSIDE, reason=passed)
        if self._over(candidate):
            return replace(candidate, status=EXCEEDS, reason=self._over(candidate))
        if not decay > 0:
            return replace(candidate, status=UNSTABLE, reason=f"grows by {-decay:.3g} 1/s {_told(at)}")
        if short:
            return replace(candidate, status=MISSES, reason=short)
        return replace(candidate, status=OK, reason=f"worst {_told(candidate.worst_condition)}")

    def _over(self, candidate: Candidate) -> str:
        """Return in words that the curve's limit is exceeded; empty where it is kept."""
        curve, reached = self.space.curve, candidate.rotational_resistance
        if curve is None or reached is None or reached <= curve.limit * (1 + 1e-12):
            return ""
        p = {name: x for name, x in self.values.items() if name not in OWN} | {"C_s": candidate.C_s}
        allowed = min(curving_limit(load.applied(p), curve) / load.damping_factor for load in self.space.loads)
        most = f"at most {format_quantity(allowed, 'kN·s/m')} keeps it" if allowed > 0 else "no damping keeps it"
        return f"T/(4 Q a) is {reached:.4g}, and the limit is {float(curve.limit):.4g}: {most}"

    def _resistance(self) -> Float | None:
        """Return the rotational resistance under the load for which it is largest; None without a curve."""
        curve = self.space.curve
        if curve is None:
            return None
        resistance = np.zeros(self.sets.size)
        for load in self.space.loads:
            p = load.applied(self.values)
            with np.errstate(divide="ignore"):  # without an axle load no bogie turns
                resistance = np.maximum(resistance, rotational_resistance(p, p["C_s"], curve))
        return resistance

    def _requirements(self) -> list[list[RequirementVerdict]]:
        """Return for each requirement and each row what is wanted and reached; of faults the worst one's."""
        found: dict[str, tuple[float, Any, Any]] = {}
        for one in self.space.demanded:
            asked = one.demand.requirement
            speed = asked.measure == "critical_speed"
            reached = np.full(self.sets.size, np.nan) if speed else one.worst_of(self.sets)
            met = one.shortfall(self.sets) <= 0
            _, least, all_met = found.get(asked.name, (0, reached, met))
            found[asked.name] = float(asked.wanted), np.minimum(least, reached), all_met & met
        return [
            [
                RequirementVerdict(name, wanted, None if np.isnan(x) else float(x), bool(yes), {}, None, checked=False)
                for x, yes in zip(reached, met, strict=True)
            ]
            for name, (wanted, reached, met) in found.items()
        ]

    def _cases(self) -> list[list[CaseVerdict]]:
        return [self._case(case) for case in self.space.problem.cases]

    def _case(self, case: Case) -> list[CaseVerdict]:
        """Return for each row what happens with a fault."""
        conditions, names = self.space.conditions, self.space.names
        decay, which = WorstMargin(conditions, Measure("decay_rate", names, case)).worst(self.sets)
        ratio = WorstMargin(conditions, Measure("damping_ratio", names, case)).of(self.sets)
        every = Measure("decay_rate", self.space.model.parameters, case)
        stable = WorstMargin(conditions, every).of(self.sets) > 0
        return [
            CaseVerdict(
                name=case.name,
                stable=bool(stable[k]),
                decay_rate=float(decay[k]),
                damping_ratio=float(ratio[k]),
                worst_condition=conditions[which[k]].described,
                checked=False,
            )
            for k in range(self.sets.size)
        ]


def _told(condition: Mapping[str, Any]) -> str:
    return "at " + ", ".join(change_text(name, value) for name, value in condition.items())


def in_groups(problem: Problem, dampers: Sequence[CatalogueDamper]) -> list[ScoredRows]:
    """Return dampers in groups of one model: rigid ones, and others."""
    groups = [tuple(each for each in dampers if (each.K_ds == RIGID) == rigid) for rigid in (False, True)]
    return [ScoredRows(problem, group) for group in groups if group]


def verified(rows: ScoredRows, candidate: Candidate) -> Candidate:
    """Return what one damper is worth, with the worst conditions searched for and all verdicts taken twice.

    Parameters
    ----------
    rows : ScoredRows
        Of one damper.
    candidate : Candidate
        What arrays told of it.
    """
    problem = rows.space.problem
    p = {name: float(np.squeeze(value)) for name, value in rows.values.items()}
    judged, with_faults = Judged(problem, p), [Judged(problem, p, case) for case in problem.cases]
    margin, worst = judged.least(rows.space.objective)
    requirements, verdict = required(judged, with_faults), judged.verdict
    looked = replace(
        candidate,
        margin=margin,
        worst_condition=worst.described,
        requirements=requirements,
        cases=tuple(each.case_verdict for each in with_faults),
        searched=True,
    )
    found = rows.judged(looked, -verdict.spectral_abscissa, verdict.worst_condition)
    sure = verdict.checked and all(each.checked for each in requirements)
    if not sure and found.status in (OK, MISSES, UNSTABLE):
        text = "eigenvalues and Routh's array differ: too close to the boundary, or too stiff, for double precision"
        return replace(found, status=UNVERIFIED, reason=text)
    return found

"""Whether a design meets the requirements of a problem, under all its conditions and with its faults."""

from collections.abc import Mapping, Sequence

from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.stable_speeds import stable_speeds
from yawdesign.hunting.verdict import RequirementVerdict as RequirementVerdict
from yawdesign.problem import Problem
from yawdesign.problem.requirements import Requirement

ROUNDING = 1e-9  # of what is required


def requirement_verdicts(problem: Problem, p: Mapping[str, float]) -> tuple[RequirementVerdict, ...]:
    """Return whether a design meets each requirement of a problem.

    Parameters
    ----------
    problem : Problem
        With requirements, conditions and faults; its own values of the parameters are not looked at.
    p : mapping
        The design: parameters by symbol in SI units, ``C_s`` [N s/m] among them.
    """
    return required(Judged(problem, p), [Judged(problem, p, case) for case in problem.cases])


def required(judged: Judged, with_faults: Sequence[Judged]) -> tuple[RequirementVerdict, ...]:
    """Return the same of a design that is judged already, and with each fault."""
    verdicts = []
    for each in judged.problem.requirements:
        found = [_verdict(each, one) for one in (with_faults if each.of_cases else [judged])]
        verdicts.append(min(found, key=lambda x: float("inf") if x.reached is None else x.reached))
    return tuple(verdicts)


def _verdict(requirement: Requirement, judged: Judged) -> RequirementVerdict:
    reached: float | None
    if requirement.measure == "critical_speed":
        speeds = stable_speeds(judged)
        reached, worst, checked = speeds.up_to, speeds.worst, speeds.checked
    else:
        reached, worst = judged.least(requirement.measure)
        checked = judged.checked
    wanted = float(requirement.wanted)
    return RequirementVerdict(
        name=requirement.name,
        wanted=wanted,
        reached=reached,
        met=reached is None or reached >= wanted * (1 - ROUNDING),
        worst_condition=worst.described,
        case=judged.case.name if judged.case else None,
        checked=checked,
    )

"""What a catalogue's dampers are worth, one by one: plain data, and the reason for each refusal in a sentence."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yawdesign.hunting.verdict import CaseVerdict, RequirementVerdict
from yawdesign.problem import PARAMETERS, format_quantity
from yawdesign.problem.requirements import MEASURES
from yawdesign.problem.result import Result

# Kinds of answers, the best first.
OK, UNVERIFIED, MISSES, UNSTABLE, EXCEEDS, OUTSIDE = (
    "ok",
    "unverified",
    "misses a requirement",
    "unstable",
    "exceeds the curve's limit",
    "outside the bounds",
)
ORDER = (OK, UNVERIFIED, MISSES, UNSTABLE, EXCEEDS, OUTSIDE)


@dataclass(frozen=True)
class Candidate:
    """A damper of a catalogue and what it is worth.

    Parameters
    ----------
    name : str
        What it is called.
    C_s : float
        Damping of the pair of yaw dampers with it [N s/m].
    K_ds : float
        Stiffness of the pair in series with that [N/m]; infinite if it is rigid.
    margin : float
        Worst margin under all conditions: [1/s] for a decay rate, [-] for a damping ratio.
    worst_condition : mapping
        The condition under which it has that margin: ``speed`` [m/s].
    rotational_resistance : float or None
        T / (4 Q a), the largest of all loads [-]; None without a curve.
    requirements : tuple of RequirementVerdict
        What was required and reached.
    cases : tuple of CaseVerdict
        Stability with each fault.
    status : str
        ``ok``, or why it is refused.
    reason : str
        The same in a sentence, with numbers.
    searched : bool
        Whether the worst condition was searched for inside of ranges and all verdicts were taken twice, by eigenvalues
        and by Routh's array; without it the ends of ranges were looked at, and some speeds between.
    per_side : int
        How many of these dampers each side of a bogie has.
    blow_off, damping_after : float or None
        As the catalogue has them [N], [N s/m]; outside of this linear model.
    """

    name: str
    C_s: float
    K_ds: float
    margin: float
    worst_condition: Mapping[str, Any]
    rotational_resistance: float | None
    requirements: tuple[RequirementVerdict, ...]
    cases: tuple[CaseVerdict, ...]
    status: str
    reason: str
    searched: bool
    per_side: int
    blow_off: float | None
    damping_after: float | None


@dataclass(frozen=True, repr=False)
class Choice(Result):
    """The dampers of a catalogue, the best first.

    Parameters
    ----------
    candidates : tuple of Candidate
        Those that keep all limits by their margin, then those that are refused.
    objective : {"decay_rate", "damping_ratio"}
        Which margin.
    limit : float or None
        Of the rotational resistance [-]; None without a curve.
    searched : str
        Under which conditions this holds, in words.
    notes : tuple of str
        What this answer does not hold.
    """

    candidates: tuple[Candidate, ...]
    objective: str
    limit: float | None
    searched: str
    notes: tuple[str, ...]

    @property
    def best(self) -> Candidate | None:
        """The first that keeps all limits; None if there is none."""
        return next((each for each in self.candidates if each.status == OK), None)

    @property
    def doubtful(self) -> bool:
        """Whether some damper could be neither accepted nor refused."""
        return any(each.status == UNVERIFIED for each in self.candidates)


def rank(candidate: Candidate) -> tuple[int, float]:
    """Return by what candidates are sorted, the best first."""
    return ORDER.index(candidate.status), -candidate.margin


def limits_passed(values: Mapping[str, float], bounds: Mapping[str, tuple[float, float]]) -> str:
    """Return in words which bounds are not kept, by the names of variables; values in SI units."""
    found = []
    for name, (low, high) in bounds.items():
        if not low <= values[name] <= high:
            unit, side = PARAMETERS[name].unit, "below" if values[name] < low else "above"
            end = format_quantity(low if values[name] < low else high, unit)
            found.append(f"{name} = {_shown(values[name], unit)} is {side} its bound of {end}")
    return "; ".join(found)


def _shown(value: float, unit: str) -> str:
    return "rigid" if value == float("inf") else format_quantity(value, unit)


def missed(requirements: Sequence[RequirementVerdict]) -> str:
    """Return in words which requirements are missed, and what is reached of them."""
    found = []
    for each in requirements:
        if not each.met:
            unit = MEASURES[each.name.rpartition(".")[2]].unit
            reached = "less" if each.reached is None else _amount(each.reached, unit)
            found.append(f"{each.name} reaches {reached} of {_amount(each.wanted, unit)}")
    return "; ".join(found)


def _amount(value: float, unit: str) -> str:
    return f"{100 * value:.4g} %" if unit == "-" else format_quantity(value, unit, 4)

"""Answers at many points: the quick way, checked, and the single route where a check fails."""

import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.decision import decide
from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Array, Bools, Float, Index
from yawdesign.hunting.many import margins
from yawdesign.hunting.many.critical_speeds import critical_speeds
from yawdesign.hunting.many.critical_table import CriticalField
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.verdict import stability_at
from yawdesign.problem import Curve
from yawdesign.problem.condition import Condition
from yawdesign.problem.running import CURVE
from yawdesign.study.request import Question

LENGTH = 16384  # points that one thread looks at
SHARED = 256  # points that are worth a thread of their own
VERDICTS = 32768  # the same for verdicts, which need less memory a point


@dataclass(frozen=True)
class Answers:
    """Answers for some points.

    Parameters
    ----------
    columns : mapping name -> array
        The first axis runs over the points. What does not exist is NaN; where there are several values (critical
        values), they are in rising order, filled up with NaN.
    recomputed : array of bool
        Points that failed a check of the quick way and were computed by the single route.
    unverified : array of bool
        Points at which the two counts of the single route differ: their answer is no verdict.
    """

    columns: Mapping[str, Array]
    recomputed: Bools
    unverified: Bools


def evaluate(
    question: Question, p: Mapping[str, Any], *, threads: int | None = None, pool: Executor | None = None
) -> Answers:
    """Return the answers to a question at many points.

    Parameters
    ----------
    question : Question
        What is asked.
    p : mapping
        Symbols of Table I in SI units, ``C_s`` where the question needs it and ``v`` where no condition gives it:
        numbers, or arrays of one common length.
    threads : int, optional
        How many threads share the points; one for every core if not given.
    pool : Executor, optional
        The threads, where there are some: they remember what they have prepared, so that few points are shared too.

    Returns
    -------
    Answers
    """
    workers, most = threads or os.cpu_count() or 1, VERDICTS if question.of == "stable" else LENGTH
    if pool is not None:
        most = min(most, max(SHARED, -(-max(map(np.size, p.values())) // workers)))
    parts = list(ParameterSets.split(question.model, p, most))
    if min(workers, len(parts)) == 1:
        return _joined([_answer(question, part) for part in parts])
    with nullcontext(pool) if pool else ThreadPoolExecutor(min(workers, len(parts))) as own:
        return _joined(list(own.map(lambda part: _answer(question, part), parts)))


def _answer(question: Question, sets: ParameterSets) -> Answers:
    match question.of:
        case "stable":
            return _verdicts(question, sets)
        case "decay_rate" | "damping_ratio":
            return _margins(question, sets)
        case "critical":
            return _critical(question, sets)
        case "critical_speed":
            return _critical_speeds(question, sets)
    return _design(question, sets)


def _cases(question: Question, sets: ParameterSets) -> list[ParameterSets]:
    return [sets.under(condition) for condition in question.conditions]


def _verdicts(question: Question, sets: ParameterSets) -> Answers:
    """Return what is stable under all conditions: what one has ruled out is not looked at under the next."""
    out = _Mended(question, sets, np.ones(sets.size, dtype=bool))
    for condition in question.conditions:
        left = np.flatnonzero(out.values)
        if not len(left):
            break
        yes, sure = margins.stable(sets.part(left).under(condition))
        out.values[left] = yes
        out.mend(left[~sure], condition, "stable")
    return out.answers("stable")


def _margins(question: Question, sets: ParameterSets) -> Answers:
    """Return the least margins: what surely exceeds the least one so far is not looked at closer."""
    out = _Mended(question, sets, np.full(sets.size, np.inf))
    for condition in question.conditions:
        case, left = sets.under(condition), np.arange(sets.size)
        if condition is not question.conditions[0]:
            yes, sure = margins.exceeds(case, question.of, out.values, question.variables)
            left = np.flatnonzero(~(yes & sure))
        if len(left):
            found, passed = margins.margins(case.part(left), question.of, question.variables)
            better = np.where(passed, found, np.inf)
            out.values[left] = np.minimum(out.values[left], better)
            out.mend(left[~passed], condition, question.of)
    return out.answers(question.of)


class _Mended:
    """The least values of many points under several conditions, the doubtful ones by the single route."""

    def __init__(self, question: Question, sets: ParameterSets, values: NDArray[Any]) -> None:
        self.question, self.sets, self.values = question, sets, values
        self.recomputed, self.unverified = np.zeros((2, sets.size), dtype=bool)

    def mend(self, points: Index, condition: Condition, of: str) -> None:
        """Compute some points under a condition by themselves."""
        for k in points:
            found = stability_at(self.sets.vehicle_at(k).under(condition), self.question.variables)
            value = getattr(found, of)
            self.values[k] = value if of == "stable" else min(self.values[k], value)
            self.recomputed[k] = True
            self.unverified[k] |= not found.checked

    def answers(self, of: str) -> Answers:
        return Answers({of: self.values}, self.recomputed, self.unverified)


def _critical(question: Question, sets: ParameterSets) -> Answers:
    (case,) = _cases(question, sets)
    field = critical_field(case)
    columns = {
        "critical": field.critical,
        "omega": field.omega,
        "unstable_roots": field.unstable_roots,
        "count": np.sum(~np.isnan(field.critical), axis=1),
    }
    return Answers(columns, field.recomputed, field.unverified)


def _critical_speeds(question: Question, sets: ParameterSets) -> Answers:
    (case,) = _cases(question, sets)
    field = critical_speeds(case, question.searched)
    columns = {
        "critical_speed": field.critical,
        "omega": field.omega,
        "unstable_roots": field.unstable_roots,
        "count": field.count,
    }
    return Answers(columns, field.recomputed, field.unverified)


def _design(question: Question, sets: ParameterSets) -> Answers:
    curves, sets = _curves(question.curve, sets)
    cases, factors = _cases(question, sets), [condition.damping_factor for condition in question.conditions]
    fields = [_critical_field(case) for case in cases]
    recomputed = np.any([x.recomputed for x in fields], axis=0)
    unverified = np.any([x.unverified for x in fields], axis=0)
    others_stable, sure = _everywhere(margins.others_stable(case) for case in cases)
    unverified |= ~sure
    upper = np.full(sets.size, np.inf)
    if curves is not None:
        limits = [curving_limit(case.values, curves) / factor for case, factor in zip(cases, factors, strict=True)]
        upper = np.min([np.broadcast_to(limit, sets.size) for limit in limits], axis=0)
    crossings = [(x.critical / factor, x.unstable_roots) for x, factor in zip(fields, factors, strict=True)]
    decision = decide(crossings, upper, others_stable)
    status = np.where(unverified, Status.UNVERIFIED, decision.status)
    C_sl = np.where(unverified, np.nan, decision.C_sl)
    if question.of == "C_sl":
        return Answers({"C_sl": C_sl, "status": status}, recomputed, unverified)
    C_s = np.where(unverified, np.nan, decision.C_s)
    columns = {"C_s": C_s, "C_sl": C_sl, "C_su": np.where(np.isinf(upper), np.nan, upper), "status": status}
    if curves is not None:
        with np.errstate(all="ignore"):
            columns["rotational_resistance"] = _largest_resistance(cases, factors, C_s, curves)
    return _confirmed(question, sets, Answers(columns, recomputed, unverified))


def _critical_field(sets: ParameterSets) -> CriticalField:
    """Return the critical values; of one vehicle in many curves they are found once."""
    if any(np.ndim(x) for x in sets.values.values()):
        return critical_field(sets)
    found = critical_field(replace(sets, size=1))
    return CriticalField(**{name: np.repeat(x, sets.size, axis=0) for name, x in vars(found).items()})


def _everywhere(verdicts: Iterable[tuple[Bools, Bools]]) -> tuple[Bools, Bools]:
    """Return whether verdicts and whether their sureness hold under every condition."""
    yes, sure = zip(*verdicts, strict=True)
    return np.all(yes, axis=0), np.all(sure, axis=0)


def _curves(curve: Curve | None, sets: ParameterSets) -> tuple[Any, ParameterSets]:
    """Return the curves, whose numbers may be arrays, and what remains: the numbers of the vehicles."""
    if curve is None:
        return None, sets
    own = {name: sets.values.get(name, getattr(curve, name)) for name in CURVE}
    others = {name: x for name, x in sets.values.items() if name not in CURVE}
    return SimpleNamespace(**own, load=curve.load), replace(sets, values=others)


def _largest_resistance(cases: Sequence[ParameterSets], factors: Sequence[float], C_s: Float, curves: Any) -> Float:
    """Return the largest T / (4 Q a) [-] with dampings as designed under any condition."""
    each = (rotational_resistance(x.values, C_s * factor, curves) for x, factor in zip(cases, factors, strict=True))
    return np.asarray(np.max([np.broadcast_to(x, C_s.shape) for x in each], axis=0))


def _confirmed(question: Question, sets: ParameterSets, answers: Answers) -> Answers:
    """Return a design with the verdicts on its C_s: a design that is not stable by them is no design."""
    C_s = answers.columns["C_s"]
    chosen = ~np.isnan(C_s)
    verdicts = _verdicts(question, sets.replace(C_s=np.where(chosen, C_s, 1.0)))
    confirmed = np.asarray(verdicts.columns["stable"], dtype=bool)
    stable = confirmed & chosen
    unverified = answers.unverified | (chosen & (verdicts.unverified | ~confirmed))
    return Answers({**answers.columns, "stable": stable}, answers.recomputed, unverified)


def _joined(parts: Sequence[Answers]) -> Answers:
    """Return the answers of all blocks, one after the other."""
    columns = {name: joined([part.columns[name] for part in parts]) for name in parts[0].columns}
    flags = [np.concatenate([getattr(part, name) for part in parts]) for name in ("recomputed", "unverified")]
    return Answers(columns, *flags)


def joined(arrays: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Return arrays one after the other; rows of unequal length are filled up with NaN."""
    if arrays[0].ndim == 1:
        return np.concatenate(arrays)
    width = max(x.shape[1] for x in arrays)
    return np.concatenate([np.pad(x, ((0, 0), (0, width - x.shape[1])), constant_values=np.nan) for x in arrays])

"""Answers at many points: the quick way, checked, and the single route where a check fails."""

import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.decision import decide
from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Array, Bools
from yawdesign.hunting.many import margins
from yawdesign.hunting.many.critical_speeds import critical_speeds
from yawdesign.hunting.many.critical_values import critical_field
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.verdict import stability_at
from yawdesign.study.request import Question

LENGTH = 16384  # points that one thread looks at
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


def evaluate(question: Question, p: Mapping[str, Any], *, threads: int | None = None) -> Answers:
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

    Returns
    -------
    Answers
    """
    parts = list(ParameterSets.split(question.model, p, VERDICTS if question.of == "stable" else LENGTH))
    workers = min(threads or os.cpu_count() or 1, len(parts))
    if workers == 1:
        return _joined([_answer(question, part) for part in parts])
    with ThreadPoolExecutor(workers) as pool:
        return _joined(list(pool.map(lambda part: _answer(question, part), parts)))


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
    stable, sure = _everywhere(margins.stable(case) for case in _cases(question, sets))
    return _mended(question, sets, "stable", stable, ~sure)


def _everywhere(verdicts: Iterable[tuple[Bools, Bools]]) -> tuple[Bools, Bools]:
    """Return whether verdicts and whether their sureness hold under every condition."""
    yes, sure = zip(*verdicts, strict=True)
    return np.all(yes, axis=0), np.all(sure, axis=0)


def _margins(question: Question, sets: ParameterSets) -> Answers:
    found = [margins.margins(case, question.of, question.variables) for case in _cases(question, sets)]
    worst, passed = np.min([value for value, _ in found], axis=0), np.all([passed for _, passed in found], axis=0)
    return _mended(question, sets, question.of, worst, ~passed)


def _mended(question: Question, sets: ParameterSets, of: str, values: NDArray[Any], doubtful: Bools) -> Answers:
    """Return the verdicts or margins, the doubtful ones by the single route."""
    unverified = np.zeros_like(doubtful)
    for k in np.flatnonzero(doubtful):
        vehicle = sets.vehicle_at(k)
        found = [stability_at(vehicle.under(condition), question.variables) for condition in question.conditions]
        values[k] = min(getattr(x, of) for x in found)
        unverified[k] = not all(x.checked for x in found)
    return Answers({of: values}, doubtful, unverified)


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
    cases = _cases(question, sets)
    fields = [critical_field(case) for case in cases]
    recomputed = np.any([x.recomputed for x in fields], axis=0)
    unverified = np.any([x.unverified for x in fields], axis=0)
    others_stable, sure = _everywhere(margins.others_stable(case) for case in cases)
    unverified |= ~sure
    curve, upper = question.curve, np.full(sets.size, np.inf)
    if curve is not None:
        upper = np.min([np.full(case.size, curving_limit(case.values, curve)) for case in cases], axis=0)
    decision = decide([(x.critical, x.unstable_roots) for x in fields], upper, others_stable)
    status = np.where(unverified, Status.UNVERIFIED, decision.status)
    C_sl = np.where(unverified, np.nan, decision.C_sl)
    if question.of == "C_sl":
        return Answers({"C_sl": C_sl, "status": status}, recomputed, unverified)
    C_s = np.where(unverified, np.nan, decision.C_s)
    columns = {"C_s": C_s, "C_sl": C_sl, "C_su": np.where(np.isinf(upper), np.nan, upper), "status": status}
    if curve is not None:
        with np.errstate(all="ignore"):
            each = [np.full(case.size, rotational_resistance(case.values, C_s, curve)) for case in cases]
        columns["rotational_resistance"] = np.max(each, axis=0)
    return _confirmed(question, sets, Answers(columns, recomputed, unverified))


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

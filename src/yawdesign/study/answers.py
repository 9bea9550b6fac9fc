"""Answers at many points: the fast way, checked, and the thorough way where a check fails."""

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.hunting.arrays import Bools
from yawdesign.hunting.many import counts as kernels
from yawdesign.hunting.many.critical_values import CriticalField, critical_field
from yawdesign.hunting.many.parameter_sets import Block
from yawdesign.study import thorough
from yawdesign.study.choice import choose
from yawdesign.study.margins import margins
from yawdesign.study.question import Answers, Question
from yawdesign.study.speeds import critical_speeds

LENGTH = 16384  # points that one thread looks at
VERDICTS = 32768  # the same for verdicts, which need less memory a point


def evaluate(question: Question, p: Mapping[str, Any], *, threads: int | None = None) -> Answers:
    """Return the answers to a question at many points.

    Parameters
    ----------
    question : Question
        What is asked.
    p : mapping
        Symbols of Table I in SI units, ``C_s`` where the question needs it and ``v`` where it is an axis: numbers, or
        arrays of one common length.
    threads : int, optional
        How many threads share the points; one for every core if not given.

    Returns
    -------
    Answers
    """
    blocks = list(Block.split(p, VERDICTS if question.of == "stable" else LENGTH))
    workers = min(threads or os.cpu_count() or 1, len(blocks))
    if workers == 1:
        return _joined([_answer(question, block) for block in blocks])
    with ThreadPoolExecutor(workers) as pool:
        return _joined(list(pool.map(lambda block: _answer(question, block), blocks)))


def _answer(question: Question, block: Block) -> Answers:
    match question.of:
        case "stable":
            return _verdicts(question, block)
        case "decay_rate" | "damping_ratio":
            values, passed = margins(question, block)
            return _mended(question, block, values, ~passed)
        case "critical":
            return _critical(question, block)
        case "critical_speed":
            return critical_speeds(question, block)
    return _design(question, block)


def _verdicts(question: Question, block: Block) -> Answers:
    stable, sure = np.ones((2, block.size), dtype=bool)
    for case in block.cases(question.speeds):
        verdict = kernels.verdicts(question.kind, question.equations, case.zeros)(case.values)
        stable &= verdict[0] > 0
        sure &= verdict[1] > 0
    return _mended(question, block, stable, ~sure)


def _mended(question: Question, block: Block, values: NDArray[Any], doubtful: Bools) -> Answers:
    """Return the values, the doubtful ones computed the thorough way."""
    unverified = np.zeros_like(doubtful)
    for k in np.flatnonzero(doubtful):
        values[k], checked = thorough.margin(question, block.point(k))
        unverified[k] = not checked
    return Answers({question.of: values}, doubtful, unverified)


def _field(question: Question, case: Block) -> CriticalField:
    return critical_field(case, kind=question.kind, equations=question.equations)


def _critical(question: Question, block: Block) -> Answers:
    field = _field(question, block.cases(question.speeds)[0])
    columns = {
        "critical": field.critical,
        "omega": field.omega,
        "unstable_roots": field.unstable_roots,
        "count": np.sum(~np.isnan(field.critical), axis=1),
    }
    return Answers(columns, field.recomputed, field.unverified)


def _design(question: Question, block: Block) -> Answers:
    fields = [_field(question, case) for case in block.cases(question.speeds)]
    recomputed = np.any([x.recomputed for x in fields], axis=0)
    unverified = np.any([x.unverified for x in fields], axis=0)
    p, curve = block.values, question.curve
    upper = np.full(block.size, np.inf if curve is None else curving_limit(p, curve))
    choice = choose(fields, upper, _damped(question, block))
    status = np.where(unverified, "unverified", choice.status)
    C_sl = np.where(unverified, np.nan, choice.C_sl)
    if question.of == "C_sl":
        return Answers({"C_sl": C_sl, "status": status}, recomputed, unverified)
    C_s = np.where(unverified, np.nan, choice.C_s)
    columns = {"C_s": C_s, "C_sl": C_sl, "C_su": np.where(np.isinf(upper), np.nan, upper), "status": status}
    if curve is not None:
        with np.errstate(all="ignore"):
            columns["rotational_resistance"] = np.full(block.size, rotational_resistance({**p, "C_s": C_s}, C_s, curve))
    return _confirmed(question, block, Answers(columns, recomputed, unverified))


def _confirmed(question: Question, block: Block, answers: Answers) -> Answers:
    """Return a design with the verdicts on its C_s: a design that is not stable by them is no design."""
    C_s = answers.columns["C_s"]
    chosen = ~np.isnan(C_s)
    asked = Question("stable", question.kind, question.equations, question.speeds)
    verdicts = _verdicts(asked, block.with_values(C_s=np.where(chosen, C_s, 1.0)))
    confirmed = np.asarray(verdicts.columns["stable"], dtype=bool)
    stable = confirmed & chosen
    unverified = answers.unverified | (chosen & (verdicts.unverified | ~confirmed))
    return Answers({**answers.columns, "stable": stable}, answers.recomputed, unverified)


def _damped(question: Question, block: Block) -> Bools:
    """Return whether the motions of their own are damped: their stiffness and their damping positive."""
    tape, names = kernels.decoupled(question.kind, question.equations, block.zeros)
    values = tape({**block.values, "v": 1.0}) if names else np.ones((1, 1))
    return np.broadcast_to((values > 0).all(axis=0), block.size)


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

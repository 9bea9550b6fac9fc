"""Answers for a block of points."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.study import thorough
from yawdesign.study.question import Answers, Question

Values = Mapping[str, Any]


def evaluate(question: Question, p: Values) -> Answers:
    """Return the answers to a question at many points.

    Parameters
    ----------
    question : Question
        What is asked.
    p : mapping
        Symbols of Table I in SI units, ``C_s`` where the question needs it and ``v`` where it is an axis: numbers, or
        arrays of one common length.

    Returns
    -------
    Answers
    """
    points = list(_points(p))
    if question.of == "critical":
        return _critical(question, points)
    found = [[thorough.margin(question, {**x, "v": v}) for v in _speeds(question, x)] for x in points]
    values = np.array([min(value for value, _ in cases) for cases in found])
    checked = np.array([all(checked for _, checked in cases) for cases in found])
    return Answers({question.of: values}, np.ones(len(points), dtype=bool), ~checked)


def _speeds(question: Question, p: Values) -> tuple[float, ...]:
    return (p["v"],) if "v" in p else question.speeds


def _points(p: Values) -> Iterator[dict[str, float]]:
    size = max(np.size(x) for x in p.values())
    whole = {name: np.broadcast_to(np.asarray(x, dtype=float), size) for name, x in p.items()}
    for k in range(size):
        yield {name: float(x[k]) for name, x in whole.items()}


def _critical(question: Question, points: list[dict[str, float]]) -> Answers:
    found = [thorough.critical(question, {**x, "v": _speeds(question, x)[0]}) for x in points]
    columns = {
        "critical": padded([[x.C_s for x in sets.critical] for sets in found]),
        "omega": padded([[x.omega for x in sets.critical] for sets in found]),
        "unstable_roots": padded([sets.unstable_roots for sets in found]),
        "count": np.array([len(sets.critical) for sets in found]),
    }
    return Answers(columns, np.ones(len(found), dtype=bool), np.array([not sets.checked for sets in found]))


def padded(rows: list[Any]) -> NDArray[np.float64]:
    """Return rows of unequal length as one array, filled up with NaN."""
    out = np.full((len(rows), max(map(len, rows), default=0)), np.nan)
    for row, values in zip(out, rows, strict=True):
        row[: len(values)] = values
    return out

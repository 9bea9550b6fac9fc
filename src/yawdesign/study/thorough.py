"""The thorough way: one point at a time, with the functions that answer a single problem."""

from collections.abc import Mapping

from yawdesign.stability.critical import CriticalDamping, critical_damping
from yawdesign.stability.verdict import stability_at
from yawdesign.study.question import Question

Point = Mapping[str, float]


def margin(question: Question, p: Point) -> tuple[float | bool, bool]:
    """Return verdict or margin at one point and one speed, and whether it was confirmed."""
    found = stability_at(p, p["C_s"], question.variables, **question.model)
    return getattr(found, question.of), found.checked


def critical(question: Question, p: Point) -> CriticalDamping:
    """Return all critical values at one point and one speed."""
    return critical_damping({name: x for name, x in p.items() if name != "C_s"}, **question.model)

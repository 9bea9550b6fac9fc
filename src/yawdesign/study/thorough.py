"""The thorough way: one point at a time, with the functions that answer a single problem."""

from collections.abc import Mapping

from yawdesign.hunting.old import stability_at
from yawdesign.study.question import Question

Point = Mapping[str, float]


def margin(question: Question, p: Point) -> tuple[float | bool, bool]:
    """Return the worst verdict or margin of all speeds at one point, and whether it was confirmed."""
    cases = [p["v"]] if "v" in p else question.speeds
    found = [stability_at({**p, "v": v}, p["C_s"], question.variables, **question.model) for v in cases]
    return min(getattr(x, question.of) for x in found), all(x.checked for x in found)

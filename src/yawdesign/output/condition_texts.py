"""A condition of a result in words."""

from collections.abc import Mapping
from typing import Any

from yawdesign.problem.condition import CREEP_FACTOR, TOLERANCE
from yawdesign.problem.condition_texts import change_text


def condition_text(condition: Mapping[str, Any]) -> str:
    """Return a condition in words.

    Parameters
    ----------
    condition : mapping
        Such as the ``worst_condition`` of a result, in SI units.

    Examples
    --------
    >>> condition_text({"speed": 250 / 3, "lambda": 0.05, "creep_factor": 0.5, "tolerance.K_m": -0.1, "load": "tare"})
    'lambda 0.05, creep x 0.5, 300 km/h, load tare, K_m -10 %'
    """
    return ", ".join(change_text(name, condition[name]) for name in sorted(condition, key=_rank))


def _rank(name: str) -> int:
    if name.startswith(TOLERANCE):
        return 4
    return {CREEP_FACTOR.key: 1, "speed": 2, "load": 3}.get(name, 0)

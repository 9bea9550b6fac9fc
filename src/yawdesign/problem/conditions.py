"""The conditions under which a margin is taken: it is always the worst over all of them."""

from dataclasses import dataclass

from yawdesign.problem import Problem
from yawdesign.vehicle.catalogue import Parameters


@dataclass(frozen=True)
class Condition:
    """One running condition.

    Parameters
    ----------
    speed : float
        Running speed [m/s].
    """

    speed: float

    def applied(self, p: Parameters) -> dict[str, float]:
        """Return parameters with this condition in them."""
        return {**p, "v": self.speed}


def conditions(problem: Problem) -> tuple[Condition, ...]:
    """Return the conditions of a problem: its speed, or the speeds of its range."""
    return tuple(Condition(v) for v in problem.speeds)

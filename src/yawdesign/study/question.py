"""What is asked at every point of a sweep, and what comes back for a block of points."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Array
from yawdesign.problem import Curve, Problem

# What can be asked, and the unit of its answer.
QUANTITIES = {
    "stable": "-",
    "decay_rate": "1/s",
    "damping_ratio": "-",
    "critical": "N·s/m",
    "C_sl": "N·s/m",
    "design": "N·s/m",
    "critical_speed": "m/s",
}
# The same for everything that stands in a column of its own.
UNITS = {
    **QUANTITIES,
    **{"C_s": "N·s/m", "C_su": "N·s/m", "omega": "rad/s"},
    **dict.fromkeys(("count", "unstable_roots", "status", "rotational_resistance"), "-"),
}
# What must be known at every point, beside the parameters.
NEEDS_DAMPING = ("stable", "decay_rate", "damping_ratio", "critical_speed")
SEARCHED = (10 / 3.6, 600 / 3.6)  # for critical speeds, where the problem gives no range [m/s]


@dataclass(frozen=True)
class Question:
    """What is asked at every point; plain data, so that it can be sent to other processes.

    Parameters
    ----------
    of : str
        One of `QUANTITIES`.
    kind, equations : str
        As in `yawdesign.vehicle.catalogue.bogie`.
    speeds : tuple of float
        Running speeds [m/s] where ``v`` is no axis; the answer holds for all of them. For the critical speed the
        first and the last are the ends of the range that is searched.
    variables : tuple of str
        Design variables; they decide which decoupled modes count in the margins.
    curve : Curve, optional
        Upper limit of the yaw damping.
    """

    of: str
    kind: str
    equations: str
    speeds: tuple[float, ...]
    variables: tuple[str, ...] = ()
    curve: Curve | None = None

    @classmethod
    def about(cls, problem: Problem, of: str) -> "Question":
        """Return the question that a problem asks."""
        speeds = tuple(map(float, problem.speeds))
        searched = SEARCHED if of == "critical_speed" and len(speeds) == 1 else speeds
        return cls(of, problem.bogie.kind, problem.equations, searched, tuple(problem.design.variables), problem.curve)

    @property
    def model(self) -> dict[str, str]:
        """The keywords that choose the equations."""
        return {"kind": self.kind, "equations": self.equations}


@dataclass(frozen=True)
class Answers:
    """Answers for a block of points.

    Parameters
    ----------
    columns : mapping name -> array
        The first axis runs over the points. What does not exist is NaN; where there are several values (critical
        values), they are in rising order, filled up with NaN.
    recomputed : array of bool
        Points that failed a check of the fast way and were computed the thorough way.
    unverified : array of bool
        Points at which the two counts of the thorough way differ: their answer is no verdict.
    """

    columns: Mapping[str, Array]
    recomputed: NDArray[np.bool_]
    unverified: NDArray[np.bool_]

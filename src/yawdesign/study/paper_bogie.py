"""The bogie of the paper, with both sets of equations, and what several of its tables and figures need."""

from dataclasses import dataclass, replace
from functools import cached_property
from math import sqrt
from typing import Any

from yawdesign.damper.forward import ForwardDesign, design
from yawdesign.hunting.hurwitz import require_paper_bogie
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.consistency import Equations
from yawdesign.study.printed_values import MOTOR_DAMPING_RATIO, MOTOR_FREQUENCY, PI
from yawdesign.study.reproduced_row import PRINTED, RECIPROCAL
from yawdesign.vehicle.vehicle import Model, Vehicle

EQUATIONS: tuple[Equations, ...] = (PRINTED, RECIPROCAL)


@dataclass(frozen=True)
class PaperBogie:
    """A bogie in the place of the one in Table I.

    Parameters
    ----------
    given : Problem
        Whose bogie, speed and curve count; not its equations, nor its conditions.
    """

    given: Problem

    @cached_property
    def problems(self) -> dict[str, Problem]:
        """Its problem with each set of equations."""
        own = Problem(bogie=self.given.bogie, speed=self.given.speed, curve=self.given.curve, title=self.given.title)
        return {equations: replace(own, equations=equations) for equations in EQUATIONS}

    @cached_property
    def vehicles(self) -> dict[str, Vehicle]:
        """Its vehicle at the design speed with each set of equations."""
        return {equations: Vehicle.of(problem)[0] for equations, problem in self.problems.items()}

    @cached_property
    def designs(self) -> dict[str, ForwardDesign]:
        """Its forward design with each set of equations."""
        return {equations: design(problem) for equations, problem in self.problems.items()}

    @cached_property
    def unrounded(self) -> dict[str, float]:
        """K_m, C_m, K_mphi and C_mphi from the frequency and damping ratio that Table I is rounded from, in SI."""
        p, omega = self.p, 2 * PI * MOTOR_FREQUENCY
        found = {}
        for spring, damper, mass in (("K_m", "C_m", "M_m"), ("K_mphi", "C_mphi", "J_m")):
            found[spring] = p[mass] * omega**2
            found[damper] = 2 * MOTOR_DAMPING_RATIO * p[mass] * omega
        return found

    @property
    def p(self) -> dict[str, Any]:
        """Its parameters in SI."""
        return self.given.parameters()

    @property
    def motors(self) -> tuple[float, float]:
        """Natural frequency over 2 pi [Hz] and damping ratio of its motors, eq. (12)."""
        K, M = self.p["K_m"], self.p["M_m"]
        return sqrt(K / M) / (2 * PI), self.p["C_m"] / (2 * sqrt(K * M))


def paper_bogie(problem: Problem) -> PaperBogie:
    """Return the bogie of a problem in the place of the paper's.

    Raises
    ------
    ProblemError
        If the paper's equations are not written for it, or a number is missing that the paper uses.
    """
    if problem.bogie.kind != "power":
        raise ProblemError("problem: bogie.kind is trailer, and the paper's bogie has motors: give a power bogie")
    given_damping(problem)
    require_paper_bogie(Model.of(problem))
    table_1 = Model("power", PRINTED)
    if Model.of(problem).parameters != table_1.parameters or problem.flags:
        missing = [name for name in table_1.parameters if name not in Model.of(problem).parameters]
        more = [name for name in Model.of(problem).parameters if name not in table_1.parameters]
        texts = [f"without {', '.join(missing)}"] * bool(missing) + [f"with {', '.join(more)}"] * bool(more)
        raise ProblemError(f"problem: {' and '.join(texts) or problem.flags[0]} it is no bogie of Table I")
    if problem.curve is None or len(problem.speeds) > 1:
        what = "has no curve" if problem.curve is None else "has several speeds"
        raise ProblemError(f"problem: {what}, and the paper's example has one speed and one curve")
    return PaperBogie(problem)

"""Whether the vehicle of a problem is stable, by what margin, and with which faults, under all conditions."""

from dataclasses import replace

from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.requirements import required
from yawdesign.hunting.scope import scope
from yawdesign.hunting.verdict import Stability, given_damping
from yawdesign.problem import Problem
from yawdesign.vehicle.vehicle import Vehicle


def stability(problem: Problem) -> Stability:
    """Return the stability of a problem's vehicle with the yaw damping written in it, under all conditions.

    Of lists every combination is looked at; inside ranges of conditions and speeds the worst ones are searched, which
    is no proof.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.

    Returns
    -------
    Stability
        Verdict, margins [1/s], [-], modes, requirements and faults.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``.

    Examples
    --------
    >>> import yawdesign as yd
    >>> round(yd.stability(yd.table1(equations="as-printed")).spectral_abscissa, 8)
    -1.29853702
    """
    given_damping(problem)
    p = {name: float(value) for name, value in problem.parameters().items()}
    judged, with_faults = Judged(problem, p), [Judged(problem, p, case) for case in problem.cases]
    return replace(
        judged.verdict,
        cases=tuple(one.case_verdict for one in with_faults),
        requirements=required(judged, with_faults),
        scope=scope(Vehicle.of(problem)),
    )

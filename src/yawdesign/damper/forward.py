"""Forward design of the yaw damper: stable intervals, curving limit, golden section (eqs (11) to (15))."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import reduce

import numpy as np

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.hunting.critical_damping import CriticalDamping, CriticalValue, Interval
from yawdesign.hunting.old import boundary as graphs
from yawdesign.hunting.old import critical_damping, stability_at, undamped_roots
from yawdesign.problem import Problem
from yawdesign.problem.conditions import conditions
from yawdesign.problem.result import Result
from yawdesign.vehicle.old import characteristic

GOLDEN = 0.382

UNDAMPED = "motor yaw undamped"

REMEDIES = {
    "ok": "the design interval (C_sl, C_su) is stable throughout",
    "stable for every C_s": "no yaw damping is needed for stability; the golden section starts at C_sl = 0",
    "partly unstable": "part of the range between the lowest stable damping and C_su is unstable: keep C_s inside the "
    "stable interval it was chosen from",
    "infeasible": "every stable damping is above what the curve allows: allow a larger curve radius or transition, "
    "lower the speeds, or change the suspension (optimise K_m and C_m)",
    "infeasible in the curve": "the curve's limit is exceeded even without a yaw damper: lower K_2x or b_2, or allow a "
    "larger radius or limit",
    "stable for none": "no yaw damping makes the bogie stable: lower the speed or the conicity, or change the "
    "suspension (optimise K_m and C_m)",
    UNDAMPED: "a motion that no yaw damper reaches is undamped: the motors yaw on their own suspension; give "
    "K_mphi and C_mphi values above zero",
    "no upper limit": "stable up to any damping, and no curve is given that limits it: add `curve` to choose C_s",
    "unverified": "two independent ways to the critical values or to the verdict differ: do not use this result; two "
    "critical values coincide, the parameters are too extreme, or a root lies on the boundary for every C_s",
}


@dataclass(frozen=True)
class Critical(CriticalValue):
    """A critical value and the speed [m/s] it belongs to."""

    speed: float


@dataclass(frozen=True, repr=False)
class ForwardDesign(Result):
    """Answer of the forward design.

    Parameters
    ----------
    critical : tuple of Critical
        All critical values, ascending at each speed.
    stable_intervals : tuple of (low, high)
        Open intervals of C_s [N s/m] that are stable at every speed; high is infinite where there is no limit.
    C_sl : float or None
        Lower end of the stable interval the design lies in [N s/m]; without a design that of the lowest interval.
    C_su : float or None
        What the curve allows, eq. (14) [N s/m].
    C_s : float or None
        Golden section 0.382 of the way from C_sl to C_su, or to the end of the stable interval if that is lower.
    status, message : str
        What kind of answer this is, and what to do.
    stable : bool
        Whether that C_s is stable at every speed, by eigenvalues and by Routh's array.
    rotational_resistance : float or None
        T / (4 Q a) with that C_s.
    sensitivity : mapping
        d ln C_sl / d ln p for every parameter p and the speed v.
    load : str or None
        The load that stands for Q in eq. (13): axle or wheel.
    checked : bool
        Whether the stable intervals were confirmed by two ways of counting roots.
    """

    critical: tuple[Critical, ...]
    stable_intervals: tuple[Interval, ...]
    C_sl: float | None
    C_su: float | None
    C_s: float | None
    status: str
    message: str
    stable: bool
    rotational_resistance: float | None
    sensitivity: Mapping[str, float]
    load: str | None
    checked: bool


def design(problem: Problem) -> ForwardDesign:
    """Return the forward design of a problem's yaw damper.

    Parameters
    ----------
    problem : Problem
        ``C_s`` need not be given; without a curve there may be no upper limit and so no choice.

    Examples
    --------
    >>> import yawdesign as yd
    >>> result = yd.design(yd.table1(equations="as-printed"))
    >>> round(result.C_sl, 3), round(result.C_su, 3), round(result.C_s)
    (90702.89, 2593442.982, 1046750)
    """
    p, cases = problem.bogie.parameters(), conditions(problem)
    found = [critical_damping(case.applied(p), **problem.model) for case in cases]
    damped = factors_damped(problem)
    stable = reduce(intersect, [sets.stable_intervals for sets in found]) if damped else ()
    upper = None if problem.curve is None else float(curving_limit(p, problem.curve))
    interval = _chosen(stable, np.inf if upper is None else upper)
    golden = _golden(interval)
    checked = all(sets.checked for sets in found) and (golden is None or _is_stable(problem, golden))
    status = _status(stable, upper, interval) if damped else UNDAMPED
    status = status if checked else "unverified"
    C_s = golden if checked else None
    C_sl = interval[0] if interval else (stable[0][0] if stable else None)
    return ForwardDesign(
        critical=tuple(
            _at_speed(x, case.speed) for sets, case in zip(found, cases, strict=True) for x in sets.critical
        ),
        stable_intervals=stable,
        C_sl=C_sl,
        C_su=upper,
        C_s=C_s,
        status=status,
        message=REMEDIES[status],
        stable=C_s is not None,
        rotational_resistance=_resistance(problem, C_s),
        sensitivity=_sensitivity(problem, found, C_sl),
        load=None if problem.curve is None else problem.curve.load,
        checked=checked,
    )


def intersect(left: Iterable[Interval], right: Iterable[Interval]) -> tuple[Interval, ...]:
    """Return the intersection of two sets of open intervals."""
    right = tuple(right)
    both = [(max(a, c), min(b, d)) for a, b in left for c, d in right]
    return tuple(sorted((low, high) for low, high in both if low < high))


def factors_damped(problem: Problem) -> bool:
    """Return whether the motors' own yaw is damped; no yaw damper of the bogie can help there."""
    factors = characteristic({**problem.bogie.parameters(), "v": 1.0}, **problem.model).factors
    return not any(undamped_roots(p) for p in factors.values())


def _chosen(stable: tuple[Interval, ...], upper: float) -> Interval | None:
    below = intersect(stable, [(0.0, upper)])
    return max(below, key=lambda i: i[1] - i[0]) if below else None


def _golden(interval: Interval | None) -> float | None:
    if interval is None or np.isinf(interval[1]):
        return None
    return GOLDEN * interval[1] + (1 - GOLDEN) * interval[0]


def _status(stable: tuple[Interval, ...], upper: float | None, interval: Interval | None) -> str:
    if not stable:
        return "stable for none"
    if upper is not None and upper <= 0:
        return "infeasible in the curve"
    if interval is None:
        return "infeasible"
    limit = np.inf if upper is None else upper
    if interval[1] < limit or len(intersect(stable, [(0.0, limit)])) > 1:
        return "partly unstable"
    if np.isinf(interval[1]):
        return "no upper limit"
    return "stable for every C_s" if stable == ((0.0, np.inf),) else "ok"


def _at_speed(x: CriticalValue, speed: float) -> Critical:
    return Critical(x.C_s, x.omega, x.becomes, x.residual, float(speed))


def _is_stable(problem: Problem, C_s: float) -> bool:
    """Return whether the eigenvalues and Routh's array confirm a design that lies in a stable interval."""
    p = problem.bogie.parameters()
    verdicts = [stability_at(case.applied(p), C_s, **problem.model) for case in conditions(problem)]
    return all(x.stable and x.checked for x in verdicts)


def _resistance(problem: Problem, C_s: float | None) -> float | None:
    if C_s is None or problem.curve is None or not problem.bogie.W:
        return None
    return float(rotational_resistance(problem.bogie.parameters(), C_s, problem.curve))


def _sensitivity(problem: Problem, found: list[CriticalDamping], C_sl: float | None) -> dict[str, float]:
    for sets, case in zip(found, conditions(problem), strict=True):
        for x in sets.critical:
            if x.C_s == C_sl:
                return sensitivity(case.applied(problem.bogie.parameters()), x, **problem.model)
    return {}


def sensitivity(p: Mapping[str, float], x: CriticalValue, *, kind: str, equations: str) -> dict[str, float]:
    """Return d ln C / d ln p of a critical value for every parameter p and v, by implicit differentiation.

    Empty if the derivative does not exist (two critical values that have just met) or fails its residual check.
    """
    p = {name: float(value) for name, value in p.items() if name != "C_s"}
    solved = graphs.critical_damping(graphs.parameter_names(p), kind, equations)(list(p.values()), x.C_s, x.omega)
    C_s, residual, gradient = float(solved[0]), float(solved[2]), np.array(solved[3]).ravel()
    if not (abs(C_s / x.C_s - 1) < 1e-6 and residual < 1e-10 and np.all(np.isfinite(gradient))):
        return {}
    return {name: float(g * value / C_s) for (name, value), g in zip(p.items(), gradient, strict=True)}

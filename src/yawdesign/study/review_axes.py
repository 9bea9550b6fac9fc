"""Over which values the pictures of a design review go: speeds, dampings, conicities, motor mounts around a design."""

from math import inf, pi, sqrt

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import PARAMETERS, Problem
from yawdesign.problem.running import SPEED
from yawdesign.study.axes import damping_ratio

SPEEDS = (0.15, 1.5)  # of the highest speed that the problem names
BESIDE = (1 / 30, 30.0)  # of a damping that has no bounds
MOUNTS = (1 / 3, 3.0)  # of a motor mount that has no bounds
USUAL = {"C_s": (1e4, 1e7), "K_m": (6e4, 6e6), "C_m": (2e3, 2e5)}  # where there is none, zero being on no such axis
DECADES, RATIOS = 1e3, (0.005, 0.75, 3.0)  # above a bound that is zero; damping ratios: least, most of the first, most
CONICITIES, CREEP_FACTORS = (0.02, 0.5), (0.4, 1.0)


def speeds(problem: Problem, count: int) -> Float:
    """Return speeds around those that matter [m/s]."""
    required = [x.wanted for x in problem.requirements if x.measure == "critical_speed"]
    highest = max(float(x) for x in (*problem.speeds, *required))
    return np.linspace(SPEEDS[0] * highest, min(SPEEDS[1] * highest, SPEED.hard[1]), count)


def dampings(problem: Problem, marks: list[float], count: int) -> Float:
    """Return values of C_s between its bounds, or around a design, that hold some marks [N s/m]."""
    low, high = _reach(problem, "C_s", BESIDE)
    marked = [x for x in marks if x > 0 and np.isfinite(x)]
    low, high = min([low, *(x / 2 for x in marked)]), max([high, *(2 * x for x in marked)])
    least, most = PARAMETERS["C_s"].hard
    return np.geomspace(max(low, least, 1.0), min(high, most), count)


def conicities(problem: Problem, count: int) -> Float:
    """Return conicities that hold those of the problem and its conditions [-]."""
    return np.linspace(*_around(problem, "lambda", CONICITIES), count)


def creep_factors(problem: Problem, count: int) -> Float:
    """Return factors of the creep coefficients that hold those of the conditions [-]."""
    return np.linspace(*_around(problem, "creep_factor", CREEP_FACTORS), count)


def mount(problem: Problem) -> tuple[float, float]:
    """Return frequency [Hz] and damping ratio [-] of a motor suspension, eq. (12)."""
    p = {name: float(x) for name, x in problem.parameters().items()}
    return sqrt(p["K_m"] / p["M_m"]) / (2 * pi), damping_ratio(p) if p["K_m"] else inf


def _around(problem: Problem, name: str, usual: tuple[float, float]) -> tuple[float, float]:
    given = [
        x for key, values in (*problem.conditions.values, *problem.conditions.ranges) if key == name for x in values
    ]
    own = [problem.parameters()[name]] if name in problem.parameters() else []
    found = [float(x) for x in (*given, *own, *usual)]
    return min(found), max(found)


def mounts(problem: Problem, count: int) -> dict[str, Float]:
    """Return frequencies [Hz] and damping ratios [-] of the motor suspension that its bounds hold."""
    p = {name: float(x) for name, x in problem.parameters().items()}
    K, C = _reach(problem, "K_m", MOUNTS), _reach(problem, "C_m", MOUNTS)
    low, high = (sqrt(x / p["M_m"]) / (2 * pi) for x in K)
    ratios = [damping_ratio({**p, "C_m": c, "K_m": k}) for c, k in zip(C, reversed(K), strict=True)]
    least = min(max(ratios[0], RATIOS[0]), RATIOS[1])
    return {
        "f_m": np.geomspace(low, high, count),
        "xi_m": np.geomspace(least, max(min(ratios[1], RATIOS[2]), RATIOS[2] / RATIOS[1] * least), count),
    }


def _reach(problem: Problem, name: str, beside: tuple[float, float]) -> tuple[float, float]:
    """Return the bounds of a design variable, or values around the one that is given; they rise and are above zero."""
    if name in problem.design.variables:
        bounds = problem.design.variables[name]
        return float(bounds.min) or float(bounds.max) / DECADES, float(bounds.max)
    own = float(problem.parameters()[name])
    return (own * beside[0], own * beside[1]) if own else USUAL[name]

"""The curving limit of the yaw damper, eqs (13) and (14).

On a curve of radius R the bogie turns by L / (2 R) under the car body, over a transition of length l at speed V_r, so
at the rate L V_r / (2 R l). The moment that resists is
``T = (C_s b_3^2 + C_t b_0^2) L V_r / (2 R l) + K_2x b_2^2 L / (2 R)``, and eq. (13) limits T / (4 Q a).
"""

from collections.abc import Iterable, Mapping
from typing import Any

from yawdesign.problem import PARAMETERS, Curve, format_quantity
from yawdesign.problem.condition import CREEP, Condition
from yawdesign.problem.conditions import ConditionSet, distinct
from yawdesign.problem.running import CURVE
from yawdesign.vehicle.catalogue import Parameters
from yawdesign.vehicle.polynomials import Number

LOADS = {"axle": "Q = W, the axle load (the paper)", "wheel": "Q = W/2, the wheel load (railway standards)"}

# What the rotational resistance rises with, and what it falls with, eq. (13).
RAISING = frozenset({"C_s", "C_t", "K_2x", "b_0", "b_2", "b_3"})
LOWERING = frozenset({"W", "a"})
ENOUGH = ("limit", "R", "C_t", "K_2x")  # of what it is told how much of it is enough
_ROWS = {**PARAMETERS, **CURVE}


def resisting_moment(p: Parameters, C_s: Number, curve: Curve) -> Any:
    """Return the moment T that resists the bogie's rotation [N m], of any number type."""
    angle = curve.L / (2 * curve.R)
    rate = angle * curve.V_r / curve.l
    damping = C_s * p["b_3"] * p["b_3"] + p["C_t"] * p["b_0"] * p["b_0"]
    return damping * rate + p["K_2x"] * p["b_2"] * p["b_2"] * angle


def resistance_scale(p: Parameters, curve: Curve) -> Any:
    """Return 4 Q a [N m] with the load that the curve names."""
    return p["W"] * p["a"] * (4 if curve.load == "axle" else 2)


def rotational_resistance(p: Parameters, C_s: Number, curve: Curve) -> Any:
    """Return T / (4 Q a) of eq. (13) [-].

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units.
    C_s : number
        Damping of the pair of yaw dampers [N s/m].
    curve : Curve
        The curve; its `load` says whether Q is the axle load (the paper) or the wheel load (railway standards).
    """
    return resisting_moment(p, C_s, curve) / resistance_scale(p, curve)


def curving_limit(p: Parameters, curve: Curve) -> Any:
    """Return C_su of eq. (14) [N s/m], the damping with which T / (4 Q a) reaches the curve's limit; maybe negative.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1()
    >>> round(curving_limit(problem.bogie.parameters(), problem.curve), 3)
    2593442.982
    """
    rest = resisting_moment(p, 0, curve)
    slope = p["b_3"] * p["b_3"] * curve.L * curve.V_r / (2 * curve.R * curve.l)
    return (curve.limit * resistance_scale(p, curve) - rest) / slope


def curving_conditions(conditions: ConditionSet) -> tuple[Condition, ...]:
    """Return the conditions that differ for the curve, through which every bogie runs at the curve's own speed.

    The resistance rises or falls with every parameter, so those at the ends of ranges have the largest.
    """
    return distinct(conditions.corners, {"v", "lambda", "creep_factor", *CREEP})


def least_curving_limit(p: Parameters, conditions: Iterable[Condition], curve: Curve) -> float:
    """Return the least C_su as designed under all conditions [N s/m]; a tolerance of C_s lowers it."""
    each = ((condition.applied(p), condition.damping_factor) for condition in conditions)
    return min(float(curving_limit(q, curve)) / factor for q, factor in each)


def largest_resistance(p: Parameters, C_s: float, conditions: Iterable[Condition], curve: Curve) -> float | None:
    """Return the largest T / (4 Q a) under all conditions [-] with a C_s as designed; None without an axle load."""
    each = [condition.applied({**p, "C_s": C_s}) for condition in conditions]
    return max(float(rotational_resistance(q, q["C_s"], curve)) for q in each) if all(q["W"] for q in each) else None


def enough(p: Parameters, C_s: float, curve: Curve, names: Iterable[str]) -> dict[str, float]:
    """Return the values of some numbers each of which alone makes a damping keep the curve's limit, eq. (13).

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units.
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    curve : Curve
        The curve.
    names : iterable of str
        Of ``limit``, ``R``, and of the parameters ``C_t`` and ``K_2x``, which are left out where zero is not enough.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1(limit=0.03)
    >>> {name: round(x, 4) for name, x in enough(problem.parameters(), 0.0, problem.curve, ("limit", "R")).items()}
    {'limit': 0.0307, 'R': 307.2}
    """
    resistance, angle = float(rotational_resistance(p, C_s, curve)), curve.L / (2 * curve.R)
    surplus = (resistance - curve.limit) * float(resistance_scale(p, curve))  # of the moment
    arms = {"C_t": p["b_0"] ** 2 * angle * curve.V_r / curve.l, "K_2x": p["b_2"] ** 2 * angle}
    found = {"limit": resistance, "R": curve.R * resistance / curve.limit}
    found |= {name: p[name] - surplus / arm for name, arm in arms.items() if p[name] * arm >= surplus}
    return {name: float(found[name]) for name in names if name in found}


def excess(each: Iterable[Parameters], variables: Iterable[str], curve: Curve, given: Iterable[str] = ENOUGH) -> str:
    """Return in words by how much the limit is exceeded at the variables' values of least rotational resistance.

    Parameters
    ----------
    each : iterable of mapping
        These values and all others in SI units, ``C_s`` among them, under each condition that differs for the curve.
    variables : iterable of str
        What is told of the design.
    curve : Curve
        The curve.
    given : iterable of str
        Of what values are told that are enough.
    """
    every, names = list(each), [name for name in variables if name in RAISING | LOWERING]
    p = max(every, key=lambda q: resisting_moment(q, q["C_s"], curve) - curve.limit * resistance_scale(q, curve))
    where = ", ".join(f"{name} = {format_quantity(p[name], PARAMETERS[name].unit)}" for name in names)
    at = f"at {where}, where it is least," if where else "which no design variable changes,"
    if not p["W"]:
        return f"T/(4 Q a), {at} has no bound without an axle load (W = 0)"
    resistance, others = rotational_resistance(p, p["C_s"], curve), [name for name in given if name not in names]
    known = [enough(q, q["C_s"], curve, others) for q in every]
    values = {
        name: (max if name in CURVE else min)(q[name] for q in known) for name in known[0] if _in_all(name, known)
    }
    told = " or ".join(f"{name} = {format_quantity(x, _ROWS[name].unit)}" for name, x in values.items())
    return f"T/(4 Q a), {at} is {resistance:.6g}, and the limit is {curve.limit:.6g}; it is kept with {told}"


def _in_all(name: str, known: Iterable[Mapping[str, float]]) -> bool:
    return all(name in q for q in known)

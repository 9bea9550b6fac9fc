"""The ways in which one number of a problem can be relaxed, and the problem with that number changed."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from yawdesign.problem import PARAMETERS, Problem
from yawdesign.problem.condition import CREEP
from yawdesign.problem.running import CURVE, LOWEST_SEARCHED, SpeedRange

FAR = 10.0  # how many times a limit or a parameter is tried at most
FAR_BOUNDS = 100.0  # the same for a bound
IN_CURVE = ("K_2x", "C_t")  # what the curve's limit leaves less room for C_s with


@dataclass(frozen=True)
class Way:
    """A number of a problem that may be relaxed.

    Parameters
    ----------
    name : str
        Its key in a problem file, such as ``"curve.limit"``.
    kind : {"limit", "parameter", "speed", "requirement", "bound"}
        What it is.
    now, far : float
        Its value, and how far it may go, in SI units [SI].
    """

    name: str
    kind: str
    now: float
    far: float

    @property
    def key(self) -> str:
        """The last part of its name, but for a bound, of which it is the variable."""
        return self.name.split(".")[2 if self.kind == "bound" else -1]

    def at(self, share: Any) -> Any:
        """Return the value at a share of the way, 0 ... 1: geometric where neither end is zero."""
        if self.now > 0 and self.far > 0:
            return self.now * (self.far / self.now) ** share
        return self.now + (self.far - self.now) * share


def ways(problem: Problem) -> tuple[Way, ...]:
    """Return the ways in which a problem may be relaxed, a number that may go up or down in both."""
    return tuple(way for way in _every_way(problem) if way.now != way.far)


def _every_way(problem: Problem) -> Iterator[Way]:
    if problem.curve is not None:
        limit = float(problem.curve.limit)
        yield Way("curve.limit", "limit", limit, min(FAR * limit, CURVE["limit"].hard[1]))
        yield from _parameters(problem)
    fastest = max(map(float, problem.speeds))
    yield Way("speed", "speed", fastest, min(fastest, LOWEST_SEARCHED))
    for each in problem.requirements:
        least = min(float(each.wanted), LOWEST_SEARCHED) if each.measure == "critical_speed" else 0.0
        yield Way(f"requirements.{each.name}", "requirement", float(each.wanted), least)
    for name, variable in problem.design.variables.items():
        (lowest, highest), low, high = PARAMETERS[name].hard, float(variable.min), float(variable.max)
        yield Way(f"design.variables.{name}.max", "bound", high, min(FAR_BOUNDS * high, highest))
        yield Way(f"design.variables.{name}.min", "bound", low, max(low / FAR_BOUNDS, lowest))


def _parameters(problem: Problem) -> Iterator[Way]:
    """Yield the parameters that act in the curve, but for those that are variables or come with a condition."""
    given, conditions = problem.parameters(), problem.conditions
    replaced = {*conditions.keys, *(key for load in conditions.loads for key, _ in load.changes), *CREEP}
    for key in IN_CURVE:
        now = float(given.get(key, 0.0))
        if now > 0 and key not in replaced and key not in problem.design.variables:
            for far in (0.0, min(FAR * now, PARAMETERS[key].hard[1])):
                yield Way(f"bogie.{key}", "parameter", now, far)


def with_value(problem: Problem, way: Way, value: float) -> Problem:
    """Return a problem with another value of a number.

    Parameters
    ----------
    problem : Problem
        The problem.
    way : Way
        Which number.
    value : float
        In SI units [SI]. A speed is the highest one: those above it are lowered to it.
    """
    if way.kind in ("limit", "parameter"):
        return problem.replace(**{way.key: value})
    if way.kind == "speed":
        return problem.replace(speed=_at_most(problem.speed, value))
    if way.kind == "requirement":
        name = way.name.removeprefix("requirements.")
        changed = [replace(x, wanted=value) if x.name == name else x for x in problem.requirements]
        return problem.replace(requirements=tuple(changed))
    variable = problem.design.variables[way.key]
    other = replace(variable, **{way.name.rpartition(".")[2]: value})
    variables = {**problem.design.variables, way.key: other}
    return problem.replace(design=replace(problem.design, variables=variables))


def _at_most(speed: Any, value: float) -> Any:
    if isinstance(speed, SpeedRange):
        return replace(speed, max=value) if speed.min < value else value
    if isinstance(speed, tuple):
        return tuple(dict.fromkeys(float(np.minimum(v, value)) for v in speed))
    return min(speed, value)

"""What a sweep is asked for, checked: the quantity, the axes and what they hold, with all mistakes at once."""

import os
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from math import prod
from typing import Any, Self

import numpy as np

from yawdesign.problem import PARAMETERS, Curve, Problem, ProblemError
from yawdesign.problem.condition import CREEP, TOLERANCE, Condition
from yawdesign.problem.conditions import ConditionSet, condition_set
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.outside_the_model import answer_to
from yawdesign.problem.parameters import BOGIE, CAR_BODY, MOTOR_KEYS, NO_MOTOR
from yawdesign.problem.running import CURVE
from yawdesign.problem.table import RIGID, as_choice, key_of
from yawdesign.study.axes import DERIVED, ROWS, SETS, Axis, applied, read_axis, shape
from yawdesign.vehicle.vehicle import Model

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
ALL_AT_ONE = ("critical", "critical_speed")  # the values are those of one condition
ABOUT_CURVE = ("C_sl", "design")  # what depends on the curve
SEARCHED = (10 / 3.6, 600 / 3.6)  # for critical speeds, where the problem gives no range [m/s]

MOST_CONDITIONS = 1000  # at every point, those inside ranges among them
MOST_AXES = 3
HOLDS = ("C_m", "xi_m")
# Axes that set the same parameters.
EXCLUDE = (("f_m", "K_m"), ("xi_m", "C_m"), *(("creep_factor", name) for name in CREEP))
# What a point of the result takes, working copies included [bytes].
BYTES = {"stable": 16, "decay_rate": 32, "damping_ratio": 32, "C_sl": 160, "design": 220}
BYTES_OF_SETS = 240
SHARE_OF_MEMORY = 0.5
COMMON_MEMORY = 8 * 2**30  # where the system does not tell


@dataclass(frozen=True)
class Question:
    """What is asked at every point; plain data, so that it can be sent to other processes.

    Parameters
    ----------
    of : str
        One of `QUANTITIES`.
    model : Model
        Which equations.
    conditions : tuple of Condition
        The answer holds for all of them: what is listed, and some values of each range, both ends among them. What an
        axis gives is not among them; of a critical speed, the speed neither.
    searched : tuple of float
        Between which speeds [m/s] critical ones are looked for.
    variables : tuple of str
        Design variables; they decide which decoupled modes count in the margins.
    curve : Curve, optional
        Upper limit of the yaw damping.
    """

    of: str
    model: Model
    conditions: tuple[Condition, ...] = (Condition(()),)
    searched: tuple[float, float] = SEARCHED
    variables: tuple[str, ...] = ()
    curve: Curve | None = None

    @classmethod
    def about(cls, problem: Problem, of: str, given: Collection[str] = ()) -> Self:
        """Return the question that a problem asks, where axes give the values of some names."""
        speeds = problem.speeds
        return cls(
            of,
            Model.of(problem),
            remaining(problem, of, given).grid(MOST_CONDITIONS),
            searched=SEARCHED if len(speeds) == 1 else (float(speeds[0]), float(speeds[-1])),
            variables=tuple(sorted(problem.design.variables)),
            curve=problem.curve,
        )


def remaining(problem: Problem, of: str, given: Collection[str]) -> ConditionSet:
    """Return the conditions of a problem that are left beside axes: these replace those of what they set."""
    names = {*given, *(name for axis in given for name in SETS.get(axis, ()))}
    names |= {f"{TOLERANCE}{name}" for name in names} | ({"v"} if of == "critical_speed" else set())
    return condition_set(problem).without(names)


@dataclass(frozen=True)
class Task:
    """What a worker needs to know beside the values of the axes; a few kilobytes.

    Parameters
    ----------
    question : Question
        What is asked at every point.
    parameters : mapping
        Of the problem, in SI.
    hold : {"C_m", "xi_m"}
        As in `yawdesign.study.axes.applied`.
    """

    question: Question
    parameters: Mapping[str, float]
    hold: str


@dataclass(frozen=True)
class Request:
    """A sweep that can be computed.

    Parameters
    ----------
    problem : Problem
        Where the parameters that are no axes come from.
    of : str
        What was asked for.
    task : Task
        The same for a worker.
    axes : tuple of Axis
        One to three.
    """

    problem: Problem
    of: str
    task: Task
    axes: tuple[Axis, ...]

    @property
    def size(self) -> int:
        """Number of points."""
        return prod(shape(self.axes))

    def about(self, of: str, axes: tuple[Axis, ...]) -> "Request":
        """Return the same request about another quantity, over some of its axes; what is held stays held."""
        question = Question.about(self.problem, of, [axis.name for axis in axes])
        task = replace(self.task, question=question, parameters=_parameters(self.problem, of))
        return replace(self, of=of, task=task, axes=axes)


def request(problem: Problem, of: str, axes: Iterable[tuple[str, Any]], hold: str | None) -> Request:
    """Return a checked request; arguments as in `yawdesign.sweep`, the axes as pairs of name and values."""
    mistakes = Mistakes()
    pairs = [(key_of(name), values) for name, values in axes]
    names = [name for name, _ in pairs]
    quantity = ""
    with mistakes.under("of"):
        quantity = _quantity(problem, of)
    mistakes.found += _wrong_number(names).found
    read = _read(problem, pairs, mistakes)
    with mistakes.under("hold"):
        _check_hold(problem, hold, names)
    mistakes.found += _contradictions(names).found + _unanswerable(problem, quantity, names).found
    mistakes.report()
    task = Task(Question.about(problem, quantity, names), _parameters(problem, quantity), hold or "C_m")
    _check_derived(task, read)
    _check_memory(quantity, read)
    return Request(problem, of, task, read)


def _quantity(problem: Problem, of: str) -> str:
    as_choice(of, (*QUANTITIES, "margin"))
    return problem.design.objective if of == "margin" else of


def _parameters(problem: Problem, quantity: str) -> dict[str, float]:
    p = {name: float(x) for name, x in problem.parameters().items()}
    return p if quantity in NEEDS_DAMPING else {name: x for name, x in p.items() if name != "C_s"}


def _wrong_number(names: list[str]) -> Mistakes:
    mistakes = Mistakes()
    with mistakes.under("axes"):
        if not names:
            raise ProblemError("there is none: give one to three, such as v over 150 km/h:450 km/h:60")
        if len(set(names)) > MOST_AXES:
            raise ProblemError(f"{', '.join(names)} are {len(names)}: a sweep has at most {MOST_AXES}")
    for name in sorted({name for name in names if names.count(name) > 1}):
        with mistakes.under(name):
            raise ProblemError("is given twice: an axis stands once")
    return mistakes


def _read(problem: Problem, pairs: list[tuple[str, Any]], mistakes: Mistakes) -> tuple[Axis, ...]:
    found = []
    for name, values in pairs:
        with mistakes.under(name):
            _check_name(problem, name)
            found.append(read_axis(name, values))
    return tuple(found)


def _check_name(problem: Problem, name: str) -> None:
    if problem.bogie.kind == "trailer" and (name in MOTOR_KEYS or (name in DERIVED and DERIVED[name].motor)):
        raise ProblemError(NO_MOTOR)
    if name in CURVE and problem.curve is None:
        raise ProblemError("is a number of the curve, and there is none: give curve first")
    allowed = [key for key in ROWS if key not in PARAMETERS or key in problem.keys]
    if name in PARAMETERS and name not in allowed:
        raise ProblemError(_why_absent(problem, name))
    if name not in allowed:
        others = ", ".join(key for key in (*DERIVED, *CURVE) if key in allowed)
        unknown = f"{unknown_key(name, allowed)}; an axis is a parameter of the problem, v, or one of {others}"
        raise ProblemError(answer_to(name) or unknown)


def _why_absent(problem: Problem, name: str) -> str:
    if getattr(problem.bogie, name, None) == RIGID:
        return "is rigid in the problem: give it a stiffness first"
    under_body = name in CAR_BODY and (problem.car_body is not None or name not in BOGIE)
    return f"is not part of this vehicle: give its value under {'car_body' if under_body else 'bogie'} first"


def _check_hold(problem: Problem, hold: str | None, names: list[str]) -> None:
    if hold is None:
        return
    as_choice(hold, HOLDS)
    if problem.bogie.kind == "trailer":
        raise ProblemError(f"{hold} {NO_MOTOR.replace('remove it', 'do not hold it')}")
    both = [name for name in ("xi_m", "C_m") if name in names]
    if both:
        raise ProblemError(f"{hold} cannot be held while {both[0]} is an axis")
    if hold == "xi_m" and not problem.bogie.K_m:
        raise ProblemError("xi_m is not defined: K_m is 0")


def _contradictions(names: list[str]) -> Mistakes:
    mistakes = Mistakes()
    for one, other in EXCLUDE:
        with mistakes.under(one):
            if one in names and other in names:
                raise ProblemError(f"contradicts the axis {other}: {one} sets {other}")
    return mistakes


def _unanswerable(problem: Problem, quantity: str, names: list[str]) -> Mistakes:
    """Return what is missing for a quantity, or is an axis although the quantity is about it."""
    mistakes = Mistakes()
    with mistakes.under("C_s"):
        if quantity and quantity not in NEEDS_DAMPING and "C_s" in names:
            raise ProblemError(f"is no axis of {quantity}, which is about all C_s at once: ask for stable or a margin")
        if quantity in NEEDS_DAMPING and "C_s" not in names and problem.bogie.C_s is None:
            raise ProblemError(f"is missing: {quantity} needs it in the problem or as an axis")
    with mistakes.under("v"):
        if quantity == "critical_speed" and "v" in names:
            raise ProblemError("is no axis of critical_speed, which is sought in the problem's range of speeds")
    if quantity in QUANTITIES and quantity not in ABOUT_CURVE:
        for name in sorted(CURVE.keys() & set(names)):
            with mistakes.under(name):
                raise ProblemError(f"is a number of the curve, on which {quantity} does not depend: ask for design")
    with mistakes.under("conditions" if problem.conditions else "speed"):
        left = remaining(problem, quantity, names)
        if quantity in ALL_AT_ONE and not left.is_one:
            own = f"and each condition has its own {quantity.replace('_', ' ')} values"
            raise ProblemError(f"differ in {', '.join(_varied(left))}, {own}: give one, or axes of these")
    return mistakes


def _varied(conditions: ConditionSet) -> list[str]:
    """Return the names of what varies from condition to condition."""
    told = [each.described for each in conditions.corners]
    names = dict.fromkeys(name for each in told for name in each)
    return ["v" if name == "speed" else name for name in names if len({each.get(name) for each in told}) > 1]


def _check_derived(task: Task, axes: tuple[Axis, ...]) -> None:
    """Check the parameters that axes compute; they are monotonic, so the corners of the grid say it."""
    corners = np.meshgrid(*(axis.values[[0, -1]] for axis in axes), indexing="ij")
    point = {axis.name: x.ravel() for axis, x in zip(axes, corners, strict=True)}
    mistakes = Mistakes()
    for name, x in applied(task.parameters, point, task.hold).items():
        if name in PARAMETERS:
            with mistakes.under(name):
                for end in (np.min(x), np.max(x)):
                    PARAMETERS[name].check(float(end))
    mistakes.report()


def memory() -> float:
    """Return how much memory a result may take [bytes]."""
    try:
        whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        whole = COMMON_MEMORY
    return SHARE_OF_MEMORY * whole


def _check_memory(quantity: str, axes: tuple[Axis, ...]) -> None:
    points, each = prod(shape(axes)), BYTES.get(quantity, BYTES_OF_SETS)
    if points * each <= memory():
        return
    first = axes[0]
    rows = int(memory() / (each * points / first.values.size))
    parts = f"sweep {first.name} in parts of at most {rows} values" if rows > 1 else "sweep it in parts"
    grid = " × ".join(f"{axis.values.size} {axis.name}" for axis in axes)
    raise ProblemError(
        f"{grid} = {points:.3g} points need about {points * each / 1e9:.3g} GB, more than the {memory() / 1e9:.3g} GB "
        f"that a result may take here: use fewer values, or {parts} and write each to a file"
    )

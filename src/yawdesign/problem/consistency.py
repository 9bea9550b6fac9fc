"""What the parts of a problem allow together: bogie, car body, equations, curve, design variables and cases."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Literal, get_args

from .cases import Case, outside
from .condition import CREEP, CREEP_FACTOR, MOST_LISTED, Conditions, Load
from .diagnostics import Diagnostic
from .distributions import Distribution, unfit
from .outside_the_model import why_unknown
from .parameters import BOGIE, CAR_BODY, MOTOR_KEYS, NO_MOTOR, NO_ROLL, PARAMETERS, ROLL_NEEDS_IT, VERTICAL
from .requirements import Requirement, without_cases
from .running import SPEED
from .table import RIGID, Parameter

Equations = Literal["reciprocal", "as-printed"]
EQUATIONS: tuple[str, ...] = get_args(Equations)
GRAVITY = 9.80665  # [m/s^2], the standard acceleration of free fall
Values = Mapping[str, float | None]  # what is given of a part, by key; None where the value is not known


def misfits(
    *,
    kind: str,
    equations: object,
    bogie: Values,
    car_body: Values | None,
    speed_count: int,
    curve: bool,
    variables: Iterable[str],
    cases: Collection[Case],
    conditions: Conditions,
    requirements: tuple[Requirement, ...],
    uncertainty: Collection[Distribution] = (),
    speeds: Collection[float] = (),
) -> Iterator[Diagnostic]:
    """Yield what does not fit together, by dotted names.

    Parameters
    ----------
    kind, equations : str
        Of the bogie, and of the problem.
    bogie, car_body : mapping of str to float or None
        What is given of each, in SI; no car body: it stands still.
    speed_count : int
        How many speeds are looked at first.
    curve : bool
        Whether there is a curve.
    variables : iterable of str
        Keys of the design variables.
    cases : collection of Case
        The faults.
    conditions : Conditions
        Under which everything must hold.
    requirements : tuple of Requirement
        What must be reached.
    uncertainty : collection of Distribution
        Of parameters.
    speeds : collection of float
        The speeds [m/s]; none where they are not known.
    """
    variables = tuple(variables)
    yield from _vertical_suspension(bogie, car_body)
    if car_body is not None and equations == "as-printed":
        text = "the printed equations have no car body: write reciprocal, or remove car_body"
        yield Diagnostic(key="equations", message=text)
    if car_body is not None and "l_c" not in car_body and not curve:
        text = "is missing: give half the distance of the bogie centres, or a curve with L"
        yield Diagnostic(key="car_body.l_c", message=text, at_key=True)
    given = {**bogie, **(car_body or {})}
    for key in variables:
        if key not in present(given):
            yield Diagnostic(key=f"design.variables.{key}", message=why_absent(key, kind, given), at_key=True)
    changed = {*variables, *conditions.every_key, "C_s"}
    kept = {key: value for key, value in given.items() if key in present(given) and key not in changed}
    taken = {key: conditions.taken(key, given.get(key)) for key in present(given)}
    for case in cases:
        yield from _of_case(case, kind, given, kept, car_body is not None)
        for found in outside(case, taken):
            yield Diagnostic(key=f"cases.{found.key}", message=found.message)
    yield from _of_conditions(conditions, kind, given, variables)
    yield from _reached(conditions, given)
    yield from _size(conditions, speed_count)
    yield from without_cases(requirements, cases)
    yield from _of_uncertainty(uncertainty, kind, given, speeds, conditions)


def _of_conditions(
    conditions: Conditions, kind: str, given: Values, variables: Collection[str]
) -> Iterator[Diagnostic]:
    """Yield what does not belong there, and loads that are none."""
    names = [(key, key) for key in conditions.keys if key != CREEP_FACTOR.key]
    names += [(f"load.{load.name}.{key}", key) for load in conditions.loads for key, _ in load.changes]
    names += [(f"tolerance.{key}", key) for key, _ in conditions.tolerance]
    for place, key in names:
        texts = []
        if key not in present(given):
            texts.append(why_absent(key, kind, given))
        elif key in variables and not place.startswith("tolerance."):
            texts.append(f"is a design variable: a deviation of it is a tolerance, such as tolerance: {{{key}: 10 %}}")
        if place == key and key in CREEP and CREEP_FACTOR.key in conditions.keys:
            texts.append(f"stands beside {CREEP_FACTOR.key}, which multiplies it: give one of the two")
        if place.startswith("load.") and key in conditions.keys:
            texts.append(f"stands in conditions.{key} too: give one of the two")
        yield from (Diagnostic(key=f"conditions.{place}", message=text, at_key=True) for text in texts)
    if all(_is_as_designed(load, given) for load in conditions.loads):
        text = "changes nothing: its values are those as designed, and no other load differs"
        yield from (Diagnostic(key=f"conditions.load.{x.name}", message=text, at_key=True) for x in conditions.loads)


def _is_as_designed(load: Load, given: Values) -> bool:
    return all(given.get(key) == value for key, value in load.changes)


def _reached(conditions: Conditions, given: Values) -> Iterator[Diagnostic]:
    """Yield tolerances and factors that lead out of the range of a parameter, or change nothing."""
    creep = conditions.taken(CREEP_FACTOR.key, None)
    factors: list[tuple[str, Parameter, tuple[float, ...]]]
    factors = [(f"tolerance.{key}", PARAMETERS[key], (1 - share, 1 + share)) for key, share in conditions.tolerance]
    factors += [(CREEP_FACTOR.key, PARAMETERS[key], creep) for key in CREEP if creep]
    for place, row, by in factors:
        values = conditions.taken(row.key, given.get(row.key) if row.key in present(given) else None)
        text = ""
        if values and not any(values):
            text = f"changes nothing: {row.key} is 0, and so is every share of it"
        elif values:
            text = _outside(row.finite, [value * factor for value in values for factor in (min(by), max(by))])
        if text:
            yield Diagnostic(key=f"conditions.{place}", message=text)


def _outside(row: Parameter, values: Collection[float]) -> str:
    low, high = min(values), max(values)
    if row.hard[0] <= low and high <= row.hard[1]:
        return ""
    return f"makes {row.key} {row.range_text((low, high), row.unit)}, outside {row.range_text(row.hard, row.unit)}"


def _size(conditions: Conditions, speed_count: int) -> Iterator[Diagnostic]:
    size = conditions.combinations * speed_count
    if conditions and size > MOST_LISTED:
        text = f"every combination of lists, loads, ends of ranges and speeds makes {size}: at most {MOST_LISTED}"
        yield Diagnostic(key="conditions", message=text, at_key=True)


def _of_uncertainty(
    distributions: Collection[Distribution],
    kind: str,
    given: Values,
    speeds: Collection[float],
    conditions: Conditions,
) -> Iterator[Diagnostic]:
    known = (*present(given), CREEP_FACTOR.key, SPEED.key)
    for each in distributions:
        if each.name not in known:
            yield Diagnostic(key=f"uncertainty.{each.name}", message=why_absent(each.name, kind, given, known))
    yield from unfit([each for each in distributions if each.name in known], given, speeds, conditions)


def _vertical_suspension(bogie: Values, car_body: Values | None) -> Iterator[Diagnostic]:
    for key in VERTICAL:
        text = ""
        if car_body is not None:
            text = "belongs under car_body, where there is one" if key in bogie else ""
        elif (key in bogie) != ("I_b" in bogie):
            text = NO_ROLL if key in bogie else ROLL_NEEDS_IT
        if text:
            yield Diagnostic(key=f"bogie.{key}", message=text, at_key=True)


def _of_case(case: Case, kind: str, given: Values, kept: Values, has_car_body: bool) -> Iterator[Diagnostic]:
    """Yield what is wrong with a fault; `kept` are the values as designed that nothing else changes."""
    for change in case.changes:
        text = ""
        if change.parameter != change.key and not has_car_body:
            text = "there is one bogie where the car body stands still: give a car_body, or write " + change.parameter
        elif change.parameter not in present(given):
            text = why_absent(change.parameter, kind, given)
        if text:
            yield Diagnostic(key=f"cases.{case.name}.{change.key}", message=text, at_key=True)
    if all(change.is_none(kept.get(change.parameter)) for change in case.changes):
        text = "changes nothing: its values are those as designed"
        yield Diagnostic(key=f"cases.{case.name}", message=text, at_key=True)


def present(given: Values) -> tuple[str, ...]:
    """Return the names of the parameters of a vehicle, C_s among them, in the order of the table."""
    return tuple(key for key in PARAMETERS if key == "C_s" or given.get(key, RIGID) != RIGID)


def why_absent(key: str, kind: str, given: Values, known: Collection[str] = ()) -> str:
    """Return why a vehicle has no parameter of this name."""
    if key in MOTOR_KEYS and kind == "trailer":
        return NO_MOTOR
    if given.get(key) == RIGID:
        return "is rigid here: give its stiffness first"
    if key in PARAMETERS:
        part = "car_body" if key in CAR_BODY and key not in BOGIE else "bogie"
        return f"is not part of this vehicle: give its value under {part} first"
    return why_unknown(key, known or present(given))


def fitting_axle_load(p: Mapping[str, float], kind: str) -> float:
    """Return a quarter of the weight of a car body, two bogie frames, four wheelsets and the motors, if any [N]."""
    return GRAVITY * (p["M_c"] + 2 * p["M_b"] + 4 * p["M_w"] + (4 * p["M_m"] if kind == "power" else 0)) / 4

"""What is accepted in a problem file and may still be a slip: unusual values, and parts that do not match."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .condition import CREEP_FACTOR
from .consistency import fitting_axle_load
from .creep import CREEP
from .document import Path
from .parameters import BOGIE, CAR_BODY, PARAMETERS
from .problem import Problem
from .quantities import exact, format_quantity
from .requirements import MEASURES
from .running import CURVE, SPEED
from .table import Parameter, key_of

MOST_APART = 0.1  # of the axle loads from the weight
# Kalker's coefficients allow a lateral creep coefficient at most 1.1 times the longitudinal one (nu = 0.25).
MOST_LATERAL = 1.15


def doubts(problem: Problem, data: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Yield the place and the text of each doubt about a problem, from it and from what was written."""
    for path, row, value in _written_values(data):
        doubt = row.doubt(value)
        if doubt:
            yield path, doubt
    yield from _weight(problem, data)
    yield from _pivots(problem, data)
    yield from _creep(problem, data)
    yield from _not_among(problem)


def _written_values(data: Mapping[str, Any]) -> Iterator[tuple[Path, Parameter, Any]]:
    """Yield path, table row and value of every quantity that stands in the text."""
    for part, rows in (("bogie", BOGIE), ("car_body", CAR_BODY), ("curve", CURVE)):
        for key, value in data.get(part, {}).items():
            if key in rows:
                yield (part, key), rows[key], value
    for key, value in data["bogie"].get("creep", {}).items():
        yield ("bogie", "creep", key), CREEP[key], value
    yield from _each(("speed",), SPEED, data["speed"])
    yield from _of_conditions(data.get("conditions", {}))
    wanted = data.get("requirements", {})
    for place, values in ((("requirements",), wanted), (("requirements", "cases"), wanted.get("cases", {}))):
        yield from (((*place, key), MEASURES[key], value) for key, value in values.items() if key in MEASURES)
    for key, bounds in data.get("design", {}).get("variables", {}).items():
        for end, value in bounds.items():
            yield ("design", "variables", key, end), PARAMETERS[key], value


def _each(path: Path, row: Parameter, written: Any) -> Iterator[tuple[Path, Parameter, Any]]:
    """Yield a value, those of a list, or the ends of a range."""
    if isinstance(written, dict):
        yield from (((*path, end), row, written[end]) for end in ("min", "max"))
    elif isinstance(written, list):
        yield from (((*path, k), row, entry) for k, entry in enumerate(written))
    else:
        yield path, row, written


def _of_conditions(data: Mapping[str, Any]) -> Iterator[tuple[Path, Parameter, Any]]:
    rows = {**PARAMETERS, CREEP_FACTOR.key: CREEP_FACTOR}
    for key, written in data.items():
        if key_of(key) in rows:
            yield from _each(("conditions", key), rows[key_of(key)], written)
    for name, values in data.get("load", {}).items():
        yield from ((("conditions", "load", name, key), rows[key_of(key)], value) for key, value in values.items())


def _not_among(problem: Problem) -> Iterator[tuple[Path, str]]:
    """Doubt conditions that leave out the value as designed."""
    designed = problem.parameters()
    for key, value in designed.items():
        taken, row = problem.conditions.taken(key, value), PARAMETERS[key]
        if taken and not min(taken) <= value <= max(taken):
            place = ("conditions", key) if key in problem.conditions.keys else ("conditions", "load")
            own = f"the value as designed, {format_quantity(value, row.unit)}, is none of these"
            ends = (min(taken), max(taken))
            held = row.range_text(ends, row.unit) if ends[0] < ends[1] else format_quantity(ends[0], row.unit)
            yield place, f"{own}: answers hold for {held}"


def _weight(problem: Problem, data: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Doubt axle loads that are not a quarter of the weight."""
    if problem.car_body is None:
        return
    designed = problem.parameters()
    loads = problem.conditions.loads  # where there are some, the vehicle is met with one of these
    vehicles: dict[Path, dict[str, float]]
    vehicles = {("conditions", "load", x.name): designed | dict(x.changes) for x in loads}
    vehicles = vehicles or {("bogie", "W") if "W" in data["bogie"] else ("car_body",): designed}
    kind = problem.bogie.kind
    parts = "car body, two bogie frames, four wheelsets" + (" and four motors" if kind == "power" else "")
    for place, p in vehicles.items():
        W, fitting = p["W"], fitting_axle_load(p, kind)
        if abs(W - fitting) > MOST_APART * fitting:
            text = f"{_kN(W)} on each of four axles is {_kN(4 * W)}, but {parts} weigh {_kN(4 * fitting)}"
            yield place, f"{text}: W = {_kN(fitting)} would carry them"


def _kN(force: float) -> str:
    return format_quantity(force, "kN", digits=4)


def _pivots(problem: Problem, data: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Doubt bogie centres that are elsewhere in the curve."""
    if problem.car_body is None or problem.curve is None or problem.car_body.l_c is None:
        return
    l_c, L = exact(problem.car_body.l_c), exact(problem.curve.L)
    if 2 * l_c != L:
        text = f"{format_quantity(float(l_c), 'm')} is not half of curve.L, {format_quantity(float(L), 'm')}"
        yield _place(data, "car_body", "l_c"), f"{text}: the curve uses L, the motion of the car body l_c"


def _creep(problem: Problem, data: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Doubt a lateral creep coefficient that is much larger than the longitudinal one."""
    f_11, f_22 = problem.bogie.f_11, problem.bogie.f_22
    if f_11 > MOST_LATERAL * f_22:
        text = (
            f"{_kN(f_11)} is {f_11 / f_22:.3g} times f_22: are the two swapped? Here f_11 is lateral and f_22 "
            "longitudinal, elsewhere often the other way round"
        )
        yield _place(data, "bogie", "f_11"), text


def _place(data: Mapping[str, Any], part: str, key: str) -> Path:
    return (part, key) if key in data[part] else (part,)

"""A problem as tables: its parameters with their meaning, and what it asks for; nothing is computed here."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.tables import facts, speed, titled
from yawdesign.problem import PARAMETERS, SpeedRange, format_quantity, table1
from yawdesign.problem.condition import CREEP_FACTOR, TOLERANCE
from yawdesign.problem.condition_texts import change_text, range_text
from yawdesign.problem.parameters import given_of
from yawdesign.problem.requirements import MEASURES
from yawdesign.problem.running import CURVE
from yawdesign.problem.table import RIGID

if TYPE_CHECKING:
    from yawdesign.problem import Problem

OTHER = "*"  # beside a value that is not that of Table I


def problem_tables(problem: "Problem") -> RenderableType:
    """Return the tables of a `Problem`."""
    parts: list[RenderableType] = [facts(problem.title or "Problem", _facts(problem)), _parameters(problem)]
    tables = (_demands(problem), _variables(problem), _distributions(problem))
    return Group(*parts, *(table for table in tables if table.row_count))


def _facts(problem: "Problem") -> Iterator[tuple[str, str]]:
    kind = f"{problem.bogie.kind} bogie"
    yield "vehicle", f"car body on two bogies, {kind}" if problem.car_body else f"{kind}, car body standing still"
    yield "equations", problem.equations
    yield "speed", _speeds(problem.speed)
    yield from ((flag, "yes") for flag in problem.flags)
    if problem.curve is not None:
        numbers = (f"{name} = {_value(getattr(problem.curve, name), row.unit)}" for name, row in CURVE.items())
        yield "curve", ", ".join([*numbers, f"load: {problem.curve.load}"])
    yield "objective", problem.design.objective.replace("_", " ")


def _speeds(given: Any) -> str:
    if isinstance(given, SpeedRange):
        return f"every one from {speed(given.min)} to {speed(given.max)}"
    return ", ".join(map(speed, given)) if isinstance(given, tuple) else speed(given)


def _value(value: float, unit: str) -> str:
    return "rigid" if value == RIGID else format_quantity(value, unit)


def _parameters(problem: "Problem") -> Table:
    bogie, preset = given_of(problem.bogie), given_of(table1(kind=problem.bogie.kind).bogie)
    own = given_of(problem.car_body) if problem.car_body else {}
    others = {key for key, value in bogie.items() if key not in own and preset.get(key) != value}
    mark = f"; {OTHER} is not as in Table I" if others else ", the bogie as in Table I"
    table = titled(f"Parameters{mark}", "", "value", "", "meaning")
    table.columns[2].justify = table.columns[3].justify = "left"
    for key, value in {**bogie, **own}.items():
        row = PARAMETERS[key]
        style = "bold" if key in others else ""
        table.add_row(key, _value(value, row.unit), OTHER if key in others else "", row.meaning, style=style)
    return table


def _demands(problem: "Problem") -> Table:
    """Return what must hold, and under what."""
    table = titled("What must hold, and under which conditions", "", "")
    table.show_header, table.columns[1].justify = False, "left"
    for each in problem.requirements:
        unit = MEASURES[each.measure].unit
        least = f"{100 * each.wanted:.4g} %" if unit == "-" else format_quantity(each.wanted, unit)
        table.add_row(f"requirement: {each.name.replace('_', ' ')}", f"at least {least}")
    given = problem.conditions
    for name, values in given.values:
        table.add_row("every one of", ", ".join(change_text(name, value) for value in values))
    for name, ends in given.ranges:
        table.add_row("every value in", range_text(name, ends))
    for name, share in given.tolerance:
        table.add_row("tolerance", range_text(f"{TOLERANCE}{name}", (-share, share)))
    for load in given.loads:
        table.add_row("load", Text(f"{load.name}: {', '.join(_changes(load.changes))}"))
    for case in problem.cases:
        changes = ", ".join(f"{change.key} {_written(change)}" for change in case.changes)
        table.add_row("fault", Text(f"{case.name}: {changes}"))
    return table


def _changes(changes: Any) -> Iterator[str]:
    return (f"{key} = {_value(value, PARAMETERS[key].unit)}" for key, value in changes)


def _written(change: Any) -> str:
    return str(change.written) if change.share else _value(change.value, PARAMETERS[change.parameter].unit)


def _variables(problem: "Problem") -> Table:
    table = titled("What may be changed", "", "from", "to")
    for key, each in problem.design.variables.items():
        unit = PARAMETERS[key].unit
        table.add_row(key, format_quantity(each.min, unit), format_quantity(each.max, unit))
    if problem.design.catalogue:
        table.add_row("yaw damper", f"one of {len(problem.design.catalogue)}", "of the catalogue")
    return table


def _distributions(problem: "Problem") -> Table:
    table = titled("Uncertain parameters", "", "distribution")
    table.columns[1].justify = "left"
    for one in problem.uncertainty:
        table.add_row(CREEP_FACTOR.meaning if one.name == CREEP_FACTOR.key else one.name, _distribution(one))
    return table


def _distribution(one: Any) -> str:
    ((kind, value),) = one.written.items()
    shown = " ... ".join(map(str, value)) if isinstance(value, list) else value
    return f"{kind}: {shown}"

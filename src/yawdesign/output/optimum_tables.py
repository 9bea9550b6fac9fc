"""An optimum as tables for a terminal; nothing is computed here."""

from collections.abc import Iterator
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.damper.status import Status
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.relaxation_tables import relaxation_tables
from yawdesign.output.tables import (
    design_tables,
    facts,
    holds_under,
    margin,
    modes_table,
    requirement_tables,
    scope_lines,
    titled,
    verdict_lines,
)
from yawdesign.problem import PARAMETERS, format_quantity

if TYPE_CHECKING:
    from yawdesign.damper.forward import ForwardDesign
    from yawdesign.damper.optimum import Optimum, SingleOptimum

SHOWN_CAPPING = 5  # sensitivities


def optimum_tables(result: "Optimum") -> RenderableType:
    """Return the tables of an `Optimum`."""
    sensitivity = result.forward.sensitivity if result.margin is not None else {}
    first = verdict_lines(result.status, holds_under(result.searched, sensitivity), result.message)
    change = relaxation_tables(result.conflict, result.relaxations, result.objective)
    if result.margin is None:
        return Group(first, *change)
    own = [_optimum_facts(result), *change, _bounds(result), *requirement_tables(result.requirements), *_cases(result)]
    modes = [modes_table(result.modes), _fixed(result)]
    forward = _beside(result.forward)
    return Group(first, *scope_lines(result.forward.scope), *own, *modes, design_tables(forward))


def _beside(forward: "ForwardDesign") -> "ForwardDesign":
    """Return a forward design without what stands above it, and without the advice to optimise."""
    remedy = Status.named(forward.status).remedy
    told = forward.message.removesuffix(remedy).rstrip(":; ") if "optimise" in remedy else forward.message
    searched = "the same conditions; requirements and faults are looked at for the design above"
    return replace(forward, scope="", searched=searched, requirements=(), cases=(), message=told)


def _found(result: "Optimum") -> str:
    return "optimum" if result.status == Status.OPTIMAL else "best found"


def _optimum_facts(result: "Optimum") -> Table:
    name = {"decay_rate": "least decay rate", "damping_ratio": "least damping ratio"}[result.objective]
    rows = [
        (f"{name}, before", margin(result.margin_before, result.objective)),
        (f"{name}, {_found(result)}", margin(result.margin, result.objective)),
        ("the same by Routh's array", margin(result.margin_polynomial, result.objective)),
        ("Hurwitz minors all positive", "yes" if result.hurwitz_positive else "no"),
        ("active limits", ", ".join(result.active) or "none: the optimum is inside its bounds"),
        ("worst condition", condition_text(result.worst_condition)),
    ]
    if result.capped_by is not None:
        most = list(result.capping_sensitivity.items())[:SHOWN_CAPPING]
        rows[2:2] = [
            ("capped by, since the variables hardly move it", result.capped_by),
            (f"{name} of all other modes", margin(result.next_margin, result.objective)),
            (
                "what moves the capping mode most",
                ", ".join(f"{key} {value:+.2g}" for key, value in most) + " (% for 1 %)",
            ),
        ]
    if result.rotational_resistance is not None:
        rows.append(("rotational resistance T/(4Qa)", f"{result.rotational_resistance:.5f}"))
    if result.single_bogie is not None:
        rows += _single_rows(result, result.single_bogie)
    return facts(_found(result).capitalize(), rows)


def _single_rows(result: "Optimum", alone: "SingleOptimum") -> list[tuple[str, str]]:
    """Return what a single bogie would have answered, and what that is worth under the car body."""
    found = ((name, alone.optimum[name]) for name in result.bounds)
    values = [f"{name} = {format_quantity(x, PARAMETERS[name].unit)}" for name, x in found if x is not None]
    still, moving = (margin(x, result.objective) for x in (alone.margin, alone.margin_with_car_body))
    worth = f"{still}; with the car body {moving}" + ("" if alone.stable else ", UNSTABLE")
    return [("one bogie under a car body standing still", ", ".join(values) or "no design"), ("its margin", worth)]


def _cases(result: "Optimum") -> Iterator[RenderableType]:
    """Yield the table of what happens with each fault, before and after, and what has become worse."""
    if not result.cases:
        return
    columns = "fault", "stable", "decay rate before [1/s]", "decay rate [1/s]", "damping ratio [%]", "worst condition"
    table = titled("Faults, each under all conditions", *columns)
    table.columns[-1].justify = "left"
    before = {case.name: f"{case.decay_rate:.4g}" for case in result.cases_before}
    for case in result.cases:
        stable = ("yes" if case.stable else "NO") if case.checked else "not verified"
        numbers = before.get(case.name, "-"), f"{case.decay_rate:.4g}", f"{100 * case.damping_ratio:.2f}"
        table.add_row(case.name, stable, *numbers, condition_text(case.worst_condition))
    yield table
    if result.worsened:
        yield Text(
            f"The optimum survives worse than the design as written: {', '.join(result.worsened)}.", "bold yellow"
        )


def _bounds(result: "Optimum") -> Table:
    table = titled("Design variables", "variable", "before", _found(result), "min", "max", "place between the bounds")
    for name, bound in result.bounds.items():
        unit = PARAMETERS[name].unit
        before = result.before[name]
        shown = "not given" if before is None else format_quantity(before, unit)
        cells = [format_quantity(value, unit) for value in (bound.value, bound.min, bound.max)]
        table.add_row(name, shown, *cells, f"{100 * bound.position:.1f} %")
    return table


def _fixed(result: "Optimum") -> Table:
    table = titled("Modes that no design variable moves", "motion", "decay rate [1/s]", "frequency [Hz]")
    for name, roots in result.fixed_modes.items():
        for s in roots:
            if s.imag >= 0:
                table.add_row(name, f"{-s.real:.4f}", f"{s.imag / (2 * pi):.3f}")
    return table

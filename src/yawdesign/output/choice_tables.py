"""Tables of the dampers of a catalogue, the best first."""

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.tables import damping, margin, scope_lines, titled
from yawdesign.problem import to_unit
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from yawdesign.damper.candidates import Candidate, Choice

SHOWN = 30  # dampers; those after them are in the JSON


def choice_tables(result: "Choice") -> RenderableType:
    """Return the tables of a `Choice`."""
    best = result.best
    first = Text(f"The best damper is {best.name}: " if best else "No damper of the catalogue keeps all limits.")
    if best:
        first.append_text(Text(margin(best.margin, result.objective), "bold green"))
        first.append(f", C_s = {damping(best.C_s)}, worst at {condition_text(best.worst_condition)}.")
    first.append(f" This holds for {result.searched}.")
    shown = result.candidates[:SHOWN]
    rest = len(result.candidates) - len(shown)
    more = [Text(f"... and {rest} dampers more, which --json lists")] if rest else []
    ranges = [Text(NOT_SEARCHED)] if not all(each.searched for each in result.candidates if each.status == "ok") else []
    notes = [line for note in result.notes for line in scope_lines(note)]
    return Group(first, _table(result, shown), *more, *ranges, *_reasons(shown), *_cases(shown), *notes)


NOT_SEARCHED = (
    "* Only the ends of ranges, and some speeds, were looked at, on arrays; for the others the worst condition was "
    "searched, and every verdict taken twice."
)


def _table(result: "Choice", shown: "tuple[Candidate, ...]") -> Table:
    unit, scale = ("1/s", 1.0) if result.objective == "decay_rate" else ("%", 100.0)
    margins = f"least {result.objective.replace('_', ' ')} [{unit}]"
    resistance = [] if result.limit is None else ["T/(4Qa)"]
    columns = ("damper", "C_s [kN·s/m]", "K_ds [MN/m]", margins, *resistance)
    table = titled("Dampers, the best first", *columns)
    table.add_column("answer", justify="left")
    for each in shown:
        name = each.name + ("*" if each.status == "ok" and not each.searched else "")
        cells = [_number(each.C_s, "kN·s/m"), _number(each.K_ds, "MN/m"), f"{scale * each.margin:.4g}"]
        cells += [] if each.rotational_resistance is None else [f"{each.rotational_resistance:.4f}"]
        table.add_row(name, *cells, each.status, style="" if each.status == "ok" else "dim")
    return table


def _number(value: float, unit: str) -> str:
    return "rigid" if value == float("inf") else format_number(to_unit(value, unit), 5)


def _reasons(shown: "tuple[Candidate, ...]") -> list[Table]:
    """Return the reason of each answer that is no simple yes."""
    table = Table(title="Why not", title_justify="left", title_style="bold", show_header=False)
    for each in shown:
        if each.status != "ok":
            table.add_row(each.name, f"{each.status}: {each.reason}")
    return [table] if table.row_count else []


def _cases(shown: "tuple[Candidate, ...]") -> list[Table]:
    """Return what happens with each fault, for the dampers that keep all limits."""
    table = titled("Faults", "damper", "fault", "stable", "decay rate [1/s]", "damping ratio [%]")
    for each in shown:
        for case in each.cases if each.status == "ok" and each.searched else ():
            stable = "yes" if case.stable else "NO"
            numbers = f"{case.decay_rate:.4g}", f"{100 * case.damping_ratio:.2f}"
            table.add_row(each.name, case.name, stable, *numbers)
    return [table] if table.row_count else []

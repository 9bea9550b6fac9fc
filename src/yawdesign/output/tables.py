"""Results as tables for a terminal; nothing is computed here."""

import io
from collections.abc import Iterable, Mapping
from math import inf, log, pi
from typing import TYPE_CHECKING, Any

from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.hunting.scope import ONE_ONLY
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.table_widths import as_read, fitted
from yawdesign.problem import PARAMETERS, format_quantity
from yawdesign.problem.requirements import CASES

if TYPE_CHECKING:
    from yawdesign.damper.forward import Critical, ForwardDesign
    from yawdesign.damper.single_bogie import Parting, SingleBogie
    from yawdesign.hunting.verdict import CaseVerdict, Mode, RequirementVerdict, Stability

DAMPING = "kN·s/m"
SHOWN, SHOWN_CRITICAL, NAMED = 10, 12, 3  # sensitivities, critical values, sensitivities in the first line


def titled(title: str, *columns: str) -> Table:
    """Return an empty table; its first column is one of names, the others of numbers."""
    table = Table(title=title, title_justify="left", title_style="bold")
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k == 0 else "right")
    return table


def damping(value: float | None) -> str:
    """Return a damping with its unit."""
    return "none" if value is None else format_quantity(value, DAMPING)


def margin(value: float | None, objective: str) -> str:
    """Return a margin with its unit."""
    if value is None:
        return "not given"
    return f"{value:.6g} 1/s" if objective == "decay_rate" else f"{100 * value:.5g} %"


def speed(value: float) -> str:
    """Return a speed in km/h."""
    return format_quantity(value, "km/h")


def facts(title: str, rows: Iterable[tuple[str, str]]) -> Table:
    """Return a table of names and values."""
    table = Table(title=title, title_justify="left", title_style="bold", show_header=False)
    for name, value in rows:
        table.add_row(name, value)
    return table


def modes_table(modes: Iterable["Mode"]) -> Table:
    """Return the table of the modes."""
    table = titled("Modes, slowest decay first", "frequency [Hz]", "damping ratio [%]", "decay rate [1/s]")
    for mode in modes:
        frequency = f"{mode.frequency:.3f}" if mode.frequency else "no oscillation"
        table.add_row(frequency, f"{100 * mode.damping_ratio:.2f}", f"{mode.decay_rate:.4g}")
    return table


def verified(checked: bool) -> str:
    """Return whether a result was checked, in words."""
    return "yes, by two independent ways" if checked else "NO: the two ways differ"


def stability_tables(result: "Stability") -> RenderableType:
    """Return the tables of a `Stability`."""
    summary = facts(
        f"With C_s = {damping(result.C_s)}",
        [
            ("spectral abscissa, all modes", f"{result.spectral_abscissa:.6g} 1/s"),
            ("decay rate, modes that a design variable moves", margin(result.decay_rate, "decay_rate")),
            ("damping ratio, modes that a design variable moves", margin(result.damping_ratio, "damping_ratio")),
            ("worst condition", condition_text(result.worst_condition)),
            ("checked", verified(result.checked)),
        ],
    )
    beside = [*requirement_tables(result.requirements), *case_tables(result.cases)]
    return Group(_verdict(result), *scope_lines(result.scope), summary, *beside, modes_table(result.modes))


def _verdict(result: "Stability") -> Text:
    """Return the verdict and under which conditions it holds."""
    verdict = Text("stable", "bold green") if result.stable else Text("UNSTABLE", "bold red")
    if not result.checked:
        verdict = Text("NOT VERIFIED: too close to the boundary, or too stiff, for double precision", "bold yellow")
    at = "" if result.stable else f" with {condition_text(result.worst_condition)}. It was looked at"
    first = Text("The bogie is " if result.scope else "The vehicle is ").append_text(verdict)
    return first.append(f"{at} under {result.searched}.")


def requirement_tables(requirements: "Iterable[RequirementVerdict]") -> list[Table]:
    """Return the table of what is required and reached."""
    table = titled("Requirements, under all conditions", "requirement", "at least", "reached", "met")
    table.add_column("at", justify="left")
    for each in requirements:
        measure = each.name.removeprefix(CASES)
        met = ("yes" if each.met else "NO") if each.checked else "not verified"
        at = ", ".join([*([each.case] if each.case else []), condition_text(each.worst_condition)])
        table.add_row(each.name, _reached(each.wanted, measure), _reached(each.reached, measure), met, at)
    return [table] if table.row_count else []


def _reached(value: float | None, measure: str) -> str:
    if measure != "critical_speed":
        return margin(value, measure)
    return "beyond what was searched" if value is None else speed(value)


def scope_lines(scope: str) -> list[Text]:
    """Return what an answer does not hold, if there is anything."""
    return [Text(scope, "bold yellow" if scope.startswith("DO NOT") else "")] if scope else []


def case_tables(cases: "Iterable[CaseVerdict]") -> list[Table]:
    """Return the table of what happens with each fault."""
    table = titled("Faults", "fault", "stable", "decay rate [1/s]", "damping ratio [%]")
    table.add_column("at", justify="left")
    for case in cases:
        stable = ("yes" if case.stable else "NO") if case.checked else "not verified"
        numbers = f"{case.decay_rate:.4g}", f"{100 * case.damping_ratio:.2f}"
        table.add_row(case.name, stable, *numbers, condition_text(case.worst_condition))
    return [table] if table.row_count else []


def verdict_lines(status: str, under: str, message: str) -> Text:
    """Return what kind of answer it is and under which conditions; what that means stands in the next line."""
    return Text(f"{status}, {under}.\n{message[0].upper()}{message[1:]}.")


def holds_under(searched: str, sensitivity: Mapping[str, float]) -> str:
    """Return under which conditions an answer holds and, where that is one only, what moves C_sl most.

    Examples
    --------
    >>> holds_under("one condition only: 300 km/h", {"a": -42.3, "K_m": -7.4, "v": 25.9, "f_11": -20.2})
    'under one condition only: 300 km/h; 1 % more of a changes C_sl by -42.3 %, of v by +25.9 %, of f_11 by -20.2 %'
    """
    if not (searched.startswith(ONE_ONLY) and sensitivity):
        return f"under {searched}"
    (name, value), *others = sorted(sensitivity.items(), key=lambda item: -abs(item[1]))[:NAMED]
    more = "".join(f", of {other} by {change:+.1f} %" for other, change in others)
    return f"under {searched}; 1 % more of {name} changes C_sl by {value:+.1f} %{more}"


def design_tables(result: "ForwardDesign") -> RenderableType:
    """Return the tables of a `ForwardDesign`."""
    first = Text(f"Forward design: {result.status}, {holds_under(result.searched, result.sensitivity)}.", "bold")
    beside = [] if result.single_bogie is None else [_beside(result, result.single_bogie)]
    met = [*requirement_tables(result.requirements), *case_tables(result.cases)]
    own = [_design_facts(result), *met, *beside, *_critical(result), *_sensitivities(result)]
    return Group(first, *scope_lines(result.scope), *own)


def _beside(result: "ForwardDesign", alone: "SingleBogie") -> RenderableType:
    """Return the answer beside that of a single bogie, and where they part."""
    table = titled("With the car body, and one bogie under a car body that stands still", "", "vehicle", "single bogie")
    intervals = ("\n".join(interval(*i) for i in x.stable_intervals) or "none" for x in (result, alone))
    table.add_row("stable for C_s in", *intervals)
    table.add_row("C_sl", damping(result.C_sl), damping(alone.C_sl))
    table.add_row("C_s, golden section", damping(result.C_s), damping(alone.C_s))
    stable = {None: "-", True: "yes", False: "NO"}
    table.add_row("is that C_s stable under the car body", "yes" if result.stable else "-", stable[alone.stable])
    low, high = alone.searched
    lines = [f"creep x {x.creep_factor:g}: {_conicities(x, low, high)}" for x in alone.partings]
    where = f"of {low:g} ... {high:g} ({speed(alone.speed)}): {'; '.join(lines)}."
    return Group(table, Text(f"The vehicle needs more than 1.1 times the single bogie's damping at conicities {where}"))


def _conicities(parting: "Parting", low: float, high: float) -> str:
    if parting.conicities == ((low, high),):
        return "all that were looked at"
    return ", ".join(f"{a:.3g} ... {b:.3g}" for a, b in parting.conicities) or "none"


def interval(low: float, high: float) -> str:
    """Return a stable interval of the yaw damping."""
    return f"{damping(low)} ... " + ("no limit" if high == float("inf") else damping(high))


def allowed(C_su: float | None) -> str:
    """Return which yaw damping the curve allows."""
    return damping(C_su) if C_su is None or C_su >= 0 else "none: K_2x and C_t alone exceed the limit"


def _design_facts(result: "ForwardDesign") -> Table:
    many = len({tuple(x.condition.items()) for x in result.critical}) > 1
    where = "stable under every condition for C_s in" if many else "stable for C_s in"
    stable = [(where, interval(*i)) for i in result.stable_intervals]
    load = {"axle": " (Q = W, the axle load)", "wheel": " (Q = W/2, the wheel load)", None: ""}[result.load]
    rows = [
        *(stable or [(where, "none")]),
        ("C_sl, lower end of the stable interval", damping(result.C_sl)),
        *([("the condition that sets it", condition_text(result.worst_condition))] if result.worst_condition else []),
        (f"C_su, limit of the curve{load}", allowed(result.C_su)),
        ("C_s, golden section", damping(result.C_s)),
        ("is that C_s stable", "-" if result.C_s is None else "yes" if result.stable else "no"),
    ]
    if result.rotational_resistance is not None:
        rows.append(("rotational resistance T/(4Qa)", f"{result.rotational_resistance:.5f}"))
    rows += [("answer", f"{result.status}: {result.message}"), ("checked", verified(result.checked))]
    return facts("Forward design of the yaw damper", rows)


def _critical(result: "ForwardDesign") -> list[Table]:
    if not result.critical:
        return []
    shown = critical_shown(result)
    some = "" if len(shown) == len(result.critical) else f": {len(shown)} of {len(result.critical)}"
    table = titled(f"Critical values{some}", "C_s", "frequency [Hz]", "above it")
    table.add_column("with", justify="left")
    for x in shown:
        becomes = {"neither": "still unstable"}.get(x.becomes, x.becomes)
        table.add_row(damping(x.C_s), f"{x.omega / (2 * pi):.4f}", becomes, condition_text(x.condition))
    return [table]


def critical_shown(result: "ForwardDesign") -> list["Critical"]:
    """Return the critical values that are shown: of many those nearest to the ends of the stable intervals."""
    ends = [log(end) for interval in result.stable_intervals for end in interval if 0 < end < inf]
    order = list(range(len(result.critical)))
    if ends:
        order.sort(key=lambda k: min(abs(log(result.critical[k].C_s) - end) for end in ends))
    return [result.critical[k] for k in sorted(order[:SHOWN_CRITICAL])]


def _sensitivities(result: "ForwardDesign") -> list[Table]:
    if not result.sensitivity:
        return []
    table = titled("What moves C_sl most: change in % for 1 %", "parameter", "d ln C_sl / d ln p", "meaning")
    table.columns[-1].justify = "left"
    largest = sorted(result.sensitivity.items(), key=lambda item: -abs(item[1]))[:SHOWN]
    for name, value in largest:
        meaning = PARAMETERS[name].meaning if name in PARAMETERS else "running speed"
        table.add_row(name, f"{value:+.2f}", meaning)
    return [table]


def rendered(table: RenderableType) -> str:
    """Return tables as standard output shows them; brackets and colons in their texts are no markup."""
    terminal, text = Console(), io.StringIO()
    looks: dict[str, Any] = {"width": terminal.width, "force_terminal": terminal.is_terminal}
    Console(file=text, markup=False, emoji=False, **looks).print(fitted(table, terminal.width))
    return as_read(text.getvalue())

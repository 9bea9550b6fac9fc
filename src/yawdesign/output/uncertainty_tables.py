"""The answer for uncertain parameters as tables for a terminal; nothing is computed here."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.tables import damping, facts, margin, titled

if TYPE_CHECKING:
    from yawdesign.study.uncertainty import Uncertainty


def uncertainty_tables(result: "Uncertainty") -> RenderableType:
    """Return the tables of an `Uncertainty`."""
    return Group(
        _first_line(result), facts("Uncertain parameters", _facts(result)), _percentiles(result), _parameters(result)
    )


def _first_line(result: "Uncertainty") -> Text:
    (low, high), under = result.interval, f", under {result.held_under}"
    if result.probability_unstable is None:
        told = f"The samples cannot tell how likely it is unstable: between {low:.2g} and {high:.2g}"
        return Text(f"{told}{under}.", "bold yellow")
    value, half = result.probability_unstable, (high - low) / 2
    return Text(f"The probability that it is unstable is {value:.4g} ± {half:.1g}{under}.", "bold")


def _facts(result: "Uncertainty") -> Iterator[tuple[str, str]]:
    low, high = result.interval
    yield "95 % interval of the probability", f"{low:.6g} ... {high:.6g}"
    yield "found by", result.method
    yield "unstable samples", f"{result.failures} of {result.samples}"
    yield "as designed", "stable" if result.stable else "UNSTABLE"
    yield f"{result.objective.replace('_', ' ')} as designed", margin(result.margin, result.objective)
    wrong = f"{result.differences} of {result.compared} verdicts differ from eigenvalues" if result.differences else ""
    if result.unverified:
        wrong = ", ".join(filter(None, [wrong, f"{result.unverified} samples without a verdict"]))
    yield "checked", wrong or f"yes, {result.compared} verdicts against eigenvalues"


def _percentiles(result: "Uncertainty") -> Table:
    levels = list(result.percentiles["margin"])
    table = titled(f"Percentiles, of {result.percentiles_from} samples", "", *(f"{level} %" for level in levels))
    of_margin = (margin(x, result.objective) for x in result.percentiles["margin"].values())
    table.add_row(result.objective.replace("_", " "), *of_margin)
    table.add_row("C_sl", *(damping(x) for x in result.percentiles["C_sl"].values()))
    return table


def _parameters(result: "Uncertainty") -> Table:
    one = result.objective.replace("_", " ")
    title = f"Which parameters matter (shares of the variance of the {one}, from {result.sobol_from} margins)"
    table = titled(title, "parameter", "alone", "with others", "margin for +1 standard deviation", "d ln C_sl / d ln p")
    for name in sorted(result.sobol, key=lambda name: -(result.sobol[name].total or 0.0)):
        index, effect = result.sobol[name], result.effects[name]
        shares = (_share(index.first, index.first_error), _share(index.total, index.total_error))
        change = (
            "not known"
            if effect.margin is None
            else f"{'+' * (effect.margin > 0)}{margin(effect.margin, result.objective)}"
        )
        table.add_row(name, *shares, change, "none" if effect.sensitivity is None else f"{effect.sensitivity:+.2f}")
    return table


def _share(value: float | None, error: float | None) -> str:
    if value is None or error is None:
        return "not told by the samples"
    return f"{100 * value:.1f} ± {float(f'{100 * error:.1g}'):g} %"

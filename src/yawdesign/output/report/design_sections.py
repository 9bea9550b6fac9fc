"""Sections on the choice: stable damping, before and after, the front, the catalogue, what moves the answer."""

import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from yawdesign.output import style
from yawdesign.output.choice_tables import choice_tables
from yawdesign.output.plots import plot
from yawdesign.output.report.drawings import bars, marked
from yawdesign.output.report.fragments import Section, figure, paragraph, tables
from yawdesign.output.report.verdict import MARGINS
from yawdesign.output.tables import allowed, damping, facts, interval, margin, titled
from yawdesign.output.trade_off_tables import trade_off_tables
from yawdesign.output.uncertainty_tables import uncertainty_tables
from yawdesign.problem import PARAMETERS, format_quantity, to_unit

if TYPE_CHECKING:
    from yawdesign.damper.optimum import Optimum
    from yawdesign.study.design_review import DesignReview

SHOWN, LINE = 12, 34  # sensitivities, signs of a name in a line


def intervals(review: "DesignReview") -> Section:
    """Return where the yaw damping is stable, and where the design lies in that."""
    forward, chosen = review.forward, review.optimum.C_s
    axes = plot(forward, beside=[chosen] if chosen else [])
    if chosen is not None:
        text = f"{format_quantity(chosen, 'kN·s/m', 4)}, this design"
        bottom, top = axes.get_ylim()
        first = (to_unit(chosen, "kN·s/m"), bottom / (bottom - top))  # row, the one under every condition
        marked(axes, "design", [first], label=text, transform=axes.get_xaxis_transform())
    rows = [("stable for C_s in", _intervals(review)), ("C_sl, least stable", damping(forward.C_sl))]
    rows += [("C_su, curve's limit", allowed(forward.C_su)), ("C_s, golden section between them", damping(forward.C_s))]
    rows += [("C_s of this design", damping(chosen))] if chosen is not None else []
    ends = f"C_sl = {damping(forward.C_sl)}, C_su = {allowed(forward.C_su)}"
    told = f"Stable for C_s in {_intervals(review)}; {ends}, this design {damping(chosen)}."
    return Section(
        "intervals",
        "Stable yaw damping",
        figure(
            axes,
            "intervals-picture",
            "Stable intervals of the yaw damping",
            told,
            f"With the bogie of this design. Forward design: {forward.status}, {forward.message}.",
        )
        + tables(facts("Yaw damping of the pair", rows)),
    )


def _intervals(review: "DesignReview") -> str:
    found = review.forward.stable_intervals
    return " and ".join(interval(*ends) for ends in found) or "none"


def before_and_after(review: "DesignReview") -> Section | None:
    """Return the design variables and the margins as written and as handed in."""
    optimum = review.optimum
    if optimum.margin is None:
        return None
    golden = review.front.golden if review.front else None
    written = review.front.written if review.front else None
    table = titled("Before and after", "", "as written", *(["golden section"] if golden else []), "this design")

    def add(name: str, *cells: str) -> None:
        was, between, now = cells
        table.add_row(name, was, *([between] if golden else []), now)

    for name, bound in optimum.bounds.items():
        row = PARAMETERS[name]
        values = (optimum.before.get(name), golden.get(name) if golden else None, bound.value)
        add(f"{name}, {row.meaning}", *("not given" if x is None else format_quantity(x, row.unit) for x in values))
    margins = optimum.margin_before, golden["margin"] if golden else None, optimum.margin
    add(MARGINS[optimum.objective], *(margin(x, optimum.objective) for x in margins))
    if optimum.rotational_resistance is not None:
        resistances = (x["rotational_resistance"] if x else None for x in (written, golden))
        unknown = "not given" if optimum.margin_before is None else "not computed"
        cells = (unknown if x is None else f"{x:.5f}" for x in resistances)
        add("rotational resistance T/(4Qa)", *cells, f"{optimum.rotational_resistance:.5f}")
    verdicts = review.before.stable if review.before else None, golden["stable"] if golden else None, optimum.stable
    add("stable under every condition", *map(_yes, verdicts))
    worst = f"Limits that are reached: {', '.join(optimum.active) or 'none'}."
    return Section("change-of-design", "Before and after", _places(review.optimum) + tables(table) + paragraph(worst))


def _yes(value: bool | None) -> str:
    return {None: "not given", True: "yes", False: "NO"}[value]


def _places(optimum: "Optimum") -> str:
    told = "; ".join(f"{name} at {100 * x.position:.0f} % of its range" for name, x in optimum.bounds.items())
    return figure(plot(optimum), "places", "Place of each design variable between its bounds", f"{told}.")


def front(review: "DesignReview") -> Section | None:
    """Return how much margin each rotational resistance allows."""
    if review.front is None:
        return None
    points = review.front.front
    first, last = (
        f"{point['rotational_resistance']:.4f} with {margin(point['margin'], review.front.objective)}"
        for point in (points[0], points[-1])
    )
    told = f"From {first} to {last}, in {len(points)} points." if len(points) > 1 else f"One point: {first}."
    drawn = figure(plot(review.front), "front-picture", "Margin over rotational resistance", told)
    return Section("front", "Margin against rotational resistance", drawn + tables(trade_off_tables(review.front)))


def catalogue(review: "DesignReview") -> Section | None:
    """Return the dampers of the catalogue, the best first."""
    if review.choice is None:
        return None
    best = review.choice.best
    told = f"Best: {best.name}." if best else "No damper keeps all limits."
    drawn = figure(plot(review.choice), "catalogue-picture", "Margin of each damper over its damping", told)
    note = paragraph("The dampers are ranked with all other variables as written; the design above moves those too.")
    return Section("catalogue", "Dampers of the catalogue", drawn + note + tables(choice_tables(review.choice)))


def sensitivity(review: "DesignReview") -> Section | None:
    """Return what moves C_sl, and what uncertain parameters do to the margin."""
    body = "\n".join(_sensitivities(review))
    return Section("sensitivity", "What moves the answer", body) if body else None


def _sensitivities(review: "DesignReview") -> Iterator[str]:
    largest = sorted(review.forward.sensitivity.items(), key=lambda item: -abs(item[1]))[:SHOWN]
    if largest:
        names = [_named(name) for name, _ in largest]
        values: list[float] = [value for _, value in largest]
        axes = bars(
            names, values, "change of $C_\\mathrm{sl}$ for 1 % more [%]", [f"{x:+.3g}" for x in values], style.LESS
        )
        told = f"1 % more of {_meant(largest[0][0])} changes C_sl by {values[0]:+.3g} %, of the others by less."
        yield figure(axes, "tornado", "Sensitivities of the least stable yaw damping", told)
    if review.uncertainty is not None:
        yield from _uncertain(review.uncertainty)


def _named(name: str) -> str:
    return textwrap.fill(f"{name}: {_meaning(name)}", LINE)


def _meant(name: str) -> str:
    return f"{name} ({_meaning(name)})"


def _meaning(name: str) -> str:
    return PARAMETERS[name].meaning if name in PARAMETERS else "running speed"


def _uncertain(result: Any) -> Iterator[str]:
    for of, title in (
        ("tornado", "What each uncertain parameter does to the margin"),
        ("margin", "How the margin is distributed"),
    ):
        told = (
            f"{title}, for one standard deviation to either side."
            if of == "tornado"
            else f"{title}: share of samples with less."
        )
        yield figure(plot(result, of=of), f"uncertain-{of}", title, told)
    yield tables(uncertainty_tables(result))

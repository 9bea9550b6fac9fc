"""Sections on how it moves: damping over speed, root locus, the hunting mode, a run, the damper, the car body."""

from dataclasses import replace
from math import degrees, isinf
from typing import TYPE_CHECKING

from yawdesign.output.critical_speed_plots import condition_of_curve
from yawdesign.output.critical_speed_tables import critical_speed_tables
from yawdesign.output.markup import sentence
from yawdesign.output.mode_tables import followed_tables, modes_tables
from yawdesign.output.plan_view import caption
from yawdesign.output.plots import plot
from yawdesign.output.report.drawings import curves_over, of_design, under_words
from yawdesign.output.report.film import film
from yawdesign.output.report.fragments import Section, figure, folded, subheading, tables
from yawdesign.output.report.live_panel import live_panel
from yawdesign.output.response_tables import damper_tables, simulation_tables
from yawdesign.output.tables import damping, facts, margin, speed, titled
from yawdesign.problem import format_quantity

if TYPE_CHECKING:
    from rich.table import Table

    from yawdesign.response.run.damper_component import DamperComponent
    from yawdesign.study.design_review import DesignReview

VELOCITIES = (0.005, 0.01, 0.02, 0.05, 0.1)  # of a damper that moves at the hunting frequency [m/s]


def damping_over_speed(review: "DesignReview") -> Section | None:
    """Return the damping ratios of the modes over the speed, and up to which speed the design is stable."""
    if review.paths is None:
        return None
    target = next((x.wanted for x in review.problem.requirements if x.name == "damping_ratio"), None)
    told = f"Damping ratio of each mode over the running speed, {under_words(review.paths.condition)}."
    drawn = [
        figure(
            of_design(plot(review.paths, of="damping_ratio", target=target)),
            "damping-picture",
            "Damping ratio over speed",
            told,
        )
    ]
    drawn.append(folded("The same as a table", tables(followed_tables(review.paths))))
    if review.critical_speed is not None:
        drawn.append(subheading("Critical speed"))
        told = f"Least decay rate of all modes over the speed, {condition_of_curve(review.critical_speed)}."
        told += f" Where it is stable: {review.critical_speed.conditions}."
        drawn.append(figure(plot(review.critical_speed), "critical-picture", "Critical speed", told))
        drawn.append(tables(critical_speed_tables(replace(review.critical_speed, scope=""))))
    return Section("damping", "Damping over speed", "\n".join(drawn))


def root_locus(review: "DesignReview") -> Section | None:
    """Return the root locus over the speed, and the modes of the design."""
    if review.paths is None:
        return None
    low, high = review.paths.values[0], review.paths.values[-1]
    told = f"Eigenvalues from {speed(low)} to {speed(high)}, {under_words(review.paths.condition)}."
    drawn = figure(of_design(plot(review.paths)), "locus-picture", "Root locus over the running speed", told)
    modes = tables(modes_tables(review.modes)) if review.modes else ""
    return Section("locus", "Root locus over speed", drawn + modes)


def hunting(review: "DesignReview") -> Section | None:
    """Return the hunting mode in motion."""
    if review.modes is None:
        return None
    name = review.modes.hunting
    mode = next(x for x in review.modes.modes if name in (None, x.name))
    under = under_words(review.modes.condition)
    told = f"{caption(mode)}; {under}. One cycle again and again, without decay or growth."
    moving = film(review.modes, mode.name, "film", f"The mode {mode.name} in motion, seen from above", told)
    body = f'<figure class="film">{moving}<figcaption>{sentence(told)}</figcaption></figure>'
    return Section("hunting", "Hunting mode", body)


def run(review: "DesignReview") -> Section | None:
    """Return the run over a track."""
    if review.run is None:
        return None
    told = f"Track {review.run.track}, {under_words(review.run.condition)}; {review.run.runs[0].verdict}."
    drawn = figure(of_design(plot(review.run, until=10.0)), "run-picture", "Run over a track", told)
    return Section("run", "Run over a track", drawn + folded("All responses", tables(simulation_tables(review.run))))


def damper(review: "DesignReview") -> Section | None:
    """Return the yaw damper to order: stiffness and phase at the hunting frequency, force at velocities."""
    found = review.run.damper if review.run else None
    if found is None:
        return None
    parts = [_row_of_catalogue(review), tables(_at_hunting(found))]
    told = "Dynamic stiffness |Z| and phase of the pair of yaw dampers with their joints, over frequency."
    parts.append(figure(plot(found), "damper-picture", "Dynamic stiffness of the pair of yaw dampers", told))
    parts.append(tables(damper_tables(found)))
    return Section("damper", "The damper to order", "\n".join(parts))


def _row_of_catalogue(review: "DesignReview") -> str:
    if review.optimum.damper is None:
        return ""
    row = next(x for x in review.problem.design.catalogue if x.name == review.optimum.damper)
    given = [(key, str(value)) for key, value in row.written.items() if value is not None]
    return tables(facts("Row of the catalogue", given))


def _at_hunting(found: "DamperComponent") -> "Table":
    """Return what one damper of the pair does at the hunting frequency."""
    z, each = found.at_hunting, [("damping of each", damping(found.C_each))]
    each.append(("joints", "rigid" if isinf(found.K_ds) else format_quantity(found.K_ds, "MN/m")))
    if z is None:
        return facts("Each of the two dampers", each)
    each.append(("hunting frequency", f"{z.frequency:.3f} Hz"))
    each.append(("dynamic stiffness |Z| of the pair", format_quantity(z.stiffness, "MN/m", 4)))
    each.append(("phase, by which the force leads", f"{degrees(z.phase):.1f}°"))
    each.append(
        ("damping that is left of the pair's C_s", f"{damping(z.damping)}, {100 * z.damping / found.C_s:.1f} %")
    )
    for v in VELOCITIES:
        each.append((f"force of each at {1e3 * v:g} mm/s, joints included", format_quantity(z.force(v) / 2, "kN", 3)))
    return facts("At the hunting frequency", each)


def live(review: "DesignReview") -> Section | None:
    """Return the sliders by which other values are looked at in the page itself; they start above zero."""
    if review.design is None or not review.design.bogie.C_s or not review.design.parameters()["lambda"]:
        return None
    panel = live_panel(review.design, review.design.bogie.C_s)
    return Section("live", "Other values", panel, on_paper=False, whole=True)


def car_body(review: "DesignReview") -> Section | None:
    """Return the answers with and without the car body."""
    alone = review.forward.single_bogie
    if review.with_body is None or review.without_body is None or alone is None:
        return None
    told = (
        "Least stable yaw damping over the conicity, with the car body that moves, and of one bogie below a car body "
        "that stands still; where a curve ends, no damping is stable."
    )
    axes = curves_over(
        (review.with_body, review.without_body),
        ("car body moves", "car body stands still"),
        "kN·s/m",
        "least stable yaw damping $C_\\mathrm{sl}$",
    )
    table = titled("With and without the car body", "", "car body moves", "stands still")
    table.add_row("C_sl", damping(review.forward.C_sl), damping(alone.C_sl))
    table.add_row("C_s, golden section", damping(review.forward.C_s), damping(alone.C_s))
    single = review.optimum.single_bogie
    if single is not None:
        objective = review.optimum.objective
        table.add_row("C_s, optimum", damping(review.optimum.C_s), damping(single.optimum.get("C_s")))
        table.add_row(
            "its margin as it seems", margin(review.optimum.margin, objective), margin(single.margin, objective)
        )
        table.add_row(
            "its margin with the car body",
            margin(review.optimum.margin, objective),
            margin(single.margin_with_car_body, objective),
        )
    return Section(
        "car-body",
        "With and without the car body",
        figure(axes, "body-picture", "Least stable damping with and without the car body", told) + tables(table),
    )

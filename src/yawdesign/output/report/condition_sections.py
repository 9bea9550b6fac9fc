"""Sections on conditions: requirements, the worst conditions, faults, and maps around them."""

from typing import TYPE_CHECKING, Any

from yawdesign.output import style
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.plots import plot
from yawdesign.output.report.drawings import bars, marked, of_design
from yawdesign.output.report.fragments import Section, figure, paragraph, tables
from yawdesign.output.sweep_style import LIMIT_TEXT
from yawdesign.output.tables import margin, requirement_tables, titled
from yawdesign.study.review_axes import mount

if TYPE_CHECKING:
    from yawdesign.study.design_review import DesignReview

SHOWN = 15  # conditions


def requirements(review: "DesignReview") -> Section | None:
    """Return what was required and what the design reaches."""
    found = review.optimum.requirements or (review.after.requirements if review.after else ())
    if not found:
        return None
    missed = [each.name for each in found if not each.met]
    told = (
        f"Missed: {', '.join(missed)}." if missed else f"All {len(found)} are met." if len(found) > 1 else "It is met."
    )
    return Section("requirements", "Requirements", paragraph(told) + tables(*requirement_tables(found)))


def conditions(review: "DesignReview") -> Section | None:
    """Return the margins under each condition, the worst first, where there are several."""
    every = review.each_condition
    if len(every) < 2:
        return None
    shown = every[:SHOWN]
    names = [condition_text(row.condition) for row in shown]
    rates = [row.decay_rate for row in shown]
    axes = bars(names, rates, "least decay rate [1/s]", [f"{rate:.3g}" for rate in rates], style.UNSTABLE)
    unstable = sum(row.decay_rate < 0 for row in every)
    worst = f"{names[0]} with {shown[0].decay_rate:.4g} 1/s"
    told = f"The worst of {len(every)} conditions is {worst}; unstable under {unstable or 'none'}."
    table = titled(
        f"The {len(shown)} worst of {len(every)} conditions", "condition", "decay rate [1/s]", "damping ratio [%]"
    )
    for name, row in zip(names, shown, strict=True):
        table.add_row(name, f"{row.decay_rate:.4g}", f"{100 * row.damping_ratio:.2f}")
    drawn = figure(axes, "conditions-picture", "Least decay rate under each condition", told)
    return Section("conditions", "Worst conditions", drawn + tables(table))


def faults(review: "DesignReview") -> Section | None:
    """Return what each fault leaves, before and after."""
    if review.after is None or not review.after.cases:
        return None
    columns = "fault", "stable", "decay rate as written", "decay rate", "damping ratio"
    table = titled("Least margins with each fault, under all conditions", *columns)
    table.add_column("at", justify="left")
    before = {case.name: case for case in (review.before.cases if review.before else ())}
    for case in review.after.cases:
        was = before.get(case.name)
        stable = ("yes" if case.stable else "NO") if case.checked else "not verified"
        was_shown = margin(was.decay_rate, "decay_rate") if was else "not given"
        left = margin(case.decay_rate, "decay_rate"), margin(case.damping_ratio, "damping_ratio")
        table.add_row(case.name, stable, was_shown, *left, condition_text(case.worst_condition))
    worse = review.optimum.worsened
    warning = (
        paragraph(f"This design survives worse than the one as written: {', '.join(worse)}.", "warning")
        if worse
        else ""
    )
    return Section("faults", "Faults", warning + tables(table))


def chart(review: "DesignReview") -> Section | None:
    """Return what is stable over speed and yaw damping."""
    if review.chart is None or review.design is None:
        return None
    axes = of_design(plot(review.chart))
    limited = LIMIT_TEXT in axes.get_legend_handles_labels()[1]
    told = (
        f"What is stable over running speed and yaw damping, {_under(review.chart)}. The ring is this design"
        f"{'; the dashed line is what the curve allows' if limited else ''}."
    )
    drawn = figure(axes, "chart-picture", "Stability over speed and yaw damping", told)
    return Section("chart", "Stability over speed and yaw damping", drawn)


def _under(sweep: Any) -> str:
    return f"for {sweep.conditions}" if sweep.conditions else "with all else as designed"


def wear(review: "DesignReview") -> Section | None:
    """Return the margin over conicity and creep, with the conditions of the problem marked."""
    if review.wear is None or review.design is None:
        return None
    own = review.design.parameters()["lambda"]
    points = sorted(
        {(row.condition.get("lambda", own), row.condition.get("creep_factor", 1.0)) for row in review.each_condition}
    )
    axes = marked(of_design(plot(review.wear)), "condition", points)
    what = "Margin of this design over conicity and creep"
    dots = " The dots are the conditions of the problem." if len(points) > 1 else ""
    told = f"{what}, {_under(review.wear)}. The ring is this design.{dots}"
    return Section("wear", "Conicity and creep", figure(axes, "wear-picture", "Margin over conicity and creep", told))


def mounts(review: "DesignReview") -> Section | None:
    """Return the margin over frequency and damping of the motor suspension."""
    if review.mounts is None or review.design is None:
        return None
    written, (f_m, xi_m) = mount(review.problem), mount(review.design)
    changed = written != (f_m, xi_m)
    axes = marked(of_design(plot(review.mounts)), "before", [written] if changed else [])
    told = (
        f"Margin over the motor suspension, with the yaw damper of this design, {_under(review.mounts)}. The ring is "
        f"this design ({f_m:.3g} Hz, {100 * xi_m:.3g} %){', the square the motor suspension as written' * changed}."
    )
    return Section(
        "mounts", "Motor suspension", figure(axes, "mounts-picture", "Margin over the motor suspension", told)
    )

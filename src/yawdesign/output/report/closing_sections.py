"""The last sections: what the model assumes and leaves out, how each number was checked, and where all this is from."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from yawdesign.output.report.fragments import Section, items, subheading, tables
from yawdesign.output.tables import facts, margin, titled

if TYPE_CHECKING:
    from yawdesign.problem import Problem
    from yawdesign.study.design_review import DesignReview

Check = tuple[str, str, str, bool]


def limits(review: "DesignReview") -> Section:
    """Return assumptions and limits of the model."""
    body = "\n".join(
        [
            subheading("Assumed"),
            items(_assumed(review.problem)),
            subheading("Not in this model"),
            items(_left_out(review)),
        ]
    )
    return Section("limits", "Assumptions and limits", body)


def _assumed(problem: "Problem") -> Iterator[str]:
    yield "Small lateral and yaw motions about the centre of a straight track: all equations are linear."
    yield "The conicity is the equivalent one; creep forces are proportional to creepages, by f_11 and f_22."
    yield "Each damper is linear, in series with the stiffness of its joints."
    if problem.bogie.kind == "power" and problem.equations == "as-printed":
        yield "Equations as printed in the paper: the motors' yaw suspension turns the motors, but not the frame."
    elif problem.bogie.kind == "power":
        yield "Reciprocal equations: the motors' yaw suspension turns the frame as well as the motors."
    if problem.car_body is not None:
        yield "The car body is rigid, on two equal bogies; it moves laterally, yaws and rolls."
        yield "C_s is the damping of one bogie's pair of yaw dampers; both bogies have the same."
    if problem.curve is not None:
        load = {"axle": "the axle load W, as in the paper", "wheel": "the wheel load W/2, as in railway standards"}
        yield f"The curve limits T/(4Qa) by its transition, eq. (13), with Q as {load[problem.curve.load]}."
    yield "A percentage of a tolerance, a fault or a distribution is a share of the value as designed."


def _left_out(review: "DesignReview") -> Iterator[str]:
    if review.problem.car_body is None:
        yield (
            "The car body stands still: its sway and yaw, and what they do to the bogies at low conicity or reduced "
            "creep, are not in these answers."
        )
    yield "Flange contact, friction, blow-off of dampers, conicity that changes with amplitude, and so limit cycles."
    yield "Bending of car body, frame and wheelsets; vertical dynamics; traction and braking."
    yield "The best design is the best that a search found, and the worst condition inside ranges likewise: no proof."
    yield "A verdict holds for the conditions that are named with it, and for no others."


def checks(review: "DesignReview") -> Section:
    """Return how each kind of number was checked, and with which result."""
    table = titled("Two ways to each number", "number")
    for column in ("found by", "checked by", "result"):
        table.add_column(column, justify="left")
    for number, found_by, checked_by, good in _checks(review):
        table.add_row(
            number, found_by, checked_by, "✔\N{NO-BREAK SPACE}agree" if good else "✘ DIFFER: do not rely on it"
        )
    return Section("checks", "How each number was checked", tables(table))


def _checks(review: "DesignReview") -> Iterator[Check]:
    yield from _of_the_design(review)
    yield from _of_many_cases(review)
    yield from _of_the_run(review)


def _of_the_design(review: "DesignReview") -> Iterator[Check]:
    optimum = review.optimum
    if review.after is not None:
        yield (
            "stability, decay rate, damping ratio",
            "eigenvalues of the state matrix",
            "Routh's array counts the same roots",
            review.after.checked,
        )
    if optimum.margin is not None:
        by_array = margin(optimum.margin_polynomial, optimum.objective)
        yield (
            f"margin of the design, {margin(optimum.margin, optimum.objective)}",
            "eigenvalues",
            f"bisection with Routh's array: {by_array}",
            optimum.checked,
        )
        if optimum.stable:
            yield (
                "stability of the design",
                "eigenvalues",
                "all Hurwitz minors of eq. (10) are positive",
                optimum.hurwitz_positive,
            )
    yield (
        "critical C_s, stable intervals",
        "roots on the imaginary axis",
        "unstable roots counted on both sides of each, by eigenvalues and Routh's array",
        review.forward.checked,
    )
    if review.critical_speed is not None:
        yield (
            "critical speed",
            "roots on the imaginary axis",
            "eigenvalues and Routh's array on both sides",
            review.critical_speed.checked,
        )


def _of_many_cases(review: "DesignReview") -> Iterator[Check]:
    if review.front is not None:
        good = all(point["checked"] for point in review.front.front)
        yield (
            f"{len(review.front.front)} points of the front",
            "eigenvalues",
            "Routh's array, each under all conditions",
            good,
        )
    if review.paths is not None:
        yield (
            "modes over the speed",
            "eigenvalues, followed",
            f"residual of the characteristic polynomial {review.paths.residual:.1g}",
            review.paths.checked,
        )
    for name, sweep in (
        ("speed and yaw damping", review.chart),
        ("conicity and creep", review.wear),
        ("motor suspension", review.mounts),
    ):
        if sweep is not None:
            left = int(sweep.known.size - sweep.known.sum())
            yield (
                f"map over {name}",
                "Routh's array on arrays of points",
                f"doubtful points by eigenvalues; {left} points not verified",
                not left,
            )
    if review.uncertainty is not None:
        found = review.uncertainty
        yield (
            "probability of instability",
            "Routh's array",
            f"{found.compared} verdicts against eigenvalues, {found.differences} differ",
            found.checked,
        )


def _of_the_run(review: "DesignReview") -> Iterator[Check]:
    if review.run is not None:
        one = review.run.runs[0]
        yield (
            "run over a track",
            "exact time steps",
            f"growth fitted to the run {one.fitted_rate:+.4g} 1/s, eigenvalue {one.spectral_abscissa:+.4g} 1/s",
            review.run.checked,
        )
        if review.run.damper is not None:
            yield (
                "dynamic stiffness of the damper",
                "its law",
                "force over displacement in the vehicle's frequency response",
                review.run.damper.checked,
            )


def provenance(origin: Mapping[str, str]) -> Section:
    """Return with what this page was made, when, and from which file."""
    return Section("provenance", "Provenance", tables(facts("Made from and with", origin.items())))

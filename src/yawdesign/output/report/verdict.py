"""The first sections: the verdict with what it holds under, what to change where there is none, and what was put in."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from yawdesign.damper.status import Status
from yawdesign.output.condition_texts import condition_text
from yawdesign.output.markup import sentence
from yawdesign.output.relaxation_tables import relaxation_tables
from yawdesign.output.report.fragments import Section, paragraph, subheading, tables
from yawdesign.output.tables import damping, facts, margin, speed, titled
from yawdesign.problem import PARAMETERS, Problem, SpeedRange, format_quantity, table1
from yawdesign.problem.condition_texts import change_text, range_text
from yawdesign.problem.conditions import condition_set
from yawdesign.problem.running import CURVE

if TYPE_CHECKING:
    from yawdesign.study.design_review import DesignReview

MARGINS = {"decay_rate": "least decay rate", "damping_ratio": "least damping ratio"}
# Sign, words and look of the verdict: never the colour alone.
GOOD, BAD, DOUBTFUL = ("✔", "good"), ("✘", "bad"), ("?", "doubtful")


def verdict(review: "DesignReview") -> Section:
    """Return the verdict in a line, what it holds under, and the numbers of the design."""
    optimum = review.optimum
    looks = {str(Status.OPTIMAL): GOOD, str(Status.UNVERIFIED_OPTIMUM): DOUBTFUL}
    sign, look = looks.get(str(optimum.status), BAD)
    sign = f'<span class="sign" aria-hidden="true">{sign}</span>'
    line = f'<p class="verdict {look}">{sign} {sentence(_line(review))}</p>'
    under = paragraph(f"This holds for {optimum.searched}.")
    message = paragraph(f"{optimum.status}: {optimum.message}.")
    scope = review.forward.scope
    warning = paragraph(scope, "warning" if scope.startswith("DO NOT") else "note") if scope else ""
    missed = [paragraph(told, "warning") for told in _not_held(review)]
    return Section("verdict", "Verdict", "\n".join([line, *missed, under, message, warning, tables(_facts(review))]))


def _not_held(review: "DesignReview") -> Iterator[str]:
    """Yield what the design does not survive or reach, though nothing in the problem requires it."""
    cases = review.after.cases if review.after is not None else ()
    for kind, names in (
        ("Unstable with this fault", [case.name for case in cases if case.checked and not case.stable]),
        ("Not verified with this fault", [case.name for case in cases if not case.checked]),
    ):
        if names:
            yield f"{kind}: {'; '.join(names)}."
    found = review.critical_speed
    if found is not None and found.stable_up_to is not None and found.stable_up_to < found.speed_wanted:
        wanted = f"{speed(found.speed_wanted)}, the 1.1 v at which vehicles are tested for acceptance"
        yield f"Stable up to {speed(found.stable_up_to)} only, below {wanted}."


def _line(review: "DesignReview") -> str:
    optimum = review.optimum
    if optimum.margin is None:
        return f"No design: {optimum.message}."
    with_damper = f"with the damper {optimum.damper}, " if optimum.damper else ""
    left = margin(optimum.margin, optimum.objective)
    numbers = f"C_s = {damping(optimum.C_s)} leaves a {MARGINS[optimum.objective]} of {left}"
    at = f" at worst, with {condition_text(optimum.worst_condition)}"
    if optimum.status == Status.OPTIMAL:
        return f"Stable, and every limit is kept: {with_damper}{numbers}{at}."
    if optimum.status == Status.UNVERIFIED_OPTIMUM:
        return f"Not verified: {with_damper}{numbers}{at}."
    first = "Stable, but a limit is missed" if optimum.stable else "No stable design"
    return f"{first}: the best that was found, {with_damper}{numbers}{at}."


def _facts(review: "DesignReview") -> Any:
    optimum, after = review.optimum, review.after
    rows = [("status", str(optimum.status))]
    if optimum.C_s is not None:
        rows += [("damping of the pair of yaw dampers, C_s", damping(optimum.C_s))]
        rows += [("damping of each of the two", damping(optimum.C_s / 2))]
    if optimum.margin is not None:
        rows += [(MARGINS[optimum.objective], margin(optimum.margin, optimum.objective))]
    if after is not None:
        other = "damping_ratio" if optimum.objective == "decay_rate" else "decay_rate"
        rows += [(MARGINS[other], margin(getattr(after, other), other))]
        rows += [("worst condition", condition_text(after.worst_condition))]
    if optimum.capped_by is not None:
        rows += [("capped by, since the variables hardly move it", optimum.capped_by)]
    if review.critical_speed is not None:
        found = review.critical_speed
        up_to = f"beyond {speed(found.searched[1])}" if found.stable_up_to is None else speed(found.stable_up_to)
        rows += [("critical speed", up_to)]
    if optimum.rotational_resistance is not None and review.problem.curve is not None:
        limit = review.problem.curve.limit
        rows += [("rotational resistance T/(4Qa)", f"{optimum.rotational_resistance:.5f}, at most {limit:.5g}")]
    if optimum.active:
        rows += [("limits that are reached", ", ".join(optimum.active))]
    return facts("The design", rows)


def change(review: "DesignReview") -> Section | None:
    """Return what to change, where there is no stable or feasible design."""
    shown = relaxation_tables(review.optimum.conflict, review.optimum.relaxations, review.optimum.objective)
    return Section("change", "What to change", tables(*shown)) if shown else None


def inputs(review: "DesignReview") -> Section:
    """Return what the problem holds, and what of it differs from Table I."""
    problem = review.problem
    parts = [
        tables(_running(problem), *_demands(problem)),
        subheading("Parameters"),
        paragraph(_differences(problem)),
        tables(*_parameters(problem)),
    ]
    return Section("input", "Input", "\n".join(parts))


def _running(problem: Problem) -> Any:
    given = problem.speed
    if isinstance(given, SpeedRange):
        speeds = f"every speed from {speed(given.min)} to {speed(given.max)}"
    else:
        speeds = ", ".join(map(speed, problem.speeds))
    rows = [("title", problem.title or "none"), ("bogie", problem.bogie.kind), ("equations", problem.equations)]
    rows += [("car body", "moves on two bogies" if problem.car_body else "stands still"), ("running speed", speeds)]
    if problem.curve is None:
        return facts("What is asked", [*rows, ("curve", "none: the damping has no upper limit")])
    curve = [f"{key} = {format_quantity(getattr(problem.curve, key), row.unit)}" for key, row in CURVE.items()]
    load = {"axle": "Q is the axle load W", "wheel": "Q is the wheel load W/2"}[problem.curve.load]
    return facts("What is asked", [*rows, ("curve", ", ".join([*curve, load]))])


def _demands(problem: Problem) -> Iterator[Any]:
    """Yield conditions, faults, requirements, design variables and distributions, where there are any."""
    every = condition_set(problem)
    rows = [(name, change_text(name, *values)) for name, values in problem.conditions.values]
    rows += [(name, f"every value of {range_text(name, ends)}") for name, ends in every.ranges]
    rows += [(f"load {load.name}", _changed(dict(load.changes))) for load in problem.conditions.loads]
    if rows:
        yield facts(f"Conditions, {len(every.corners)} combinations of listed values and ends", rows)
    if problem.cases:
        cases = (
            (case.name, ", ".join(f"{x.key}: {_written(x.written)}" for x in case.changes)) for case in problem.cases
        )
        yield facts("Faults to survive", cases)
    if problem.requirements:
        wanted = (
            (x.name, speed(x.wanted) if x.measure == "critical_speed" else margin(x.wanted, x.measure))
            for x in problem.requirements
        )
        yield facts("Requirements, at least", wanted)
    table = titled(f"Design variables; objective: {MARGINS[problem.design.objective]}", "variable", "min", "max")
    for name, bounds in problem.design.variables.items():
        table.add_row(name, *(format_quantity(x, PARAMETERS[name].unit) for x in (bounds.min, bounds.max)))
    yield table
    if problem.uncertainty:
        given = problem.to_dict()["uncertainty"]
        yield facts("Distributions", ((name, _written(x)) for name, x in given.items()))


def _changed(values: Mapping[str, Any]) -> str:
    return ", ".join(change_text(name, value) for name, value in values.items())


def _written(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_written(x)}" for key, x in value.items())
    if isinstance(value, (list, tuple)):
        return " ... ".join(map(_written, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _differences(problem: Problem) -> str:
    """Return in a sentence what of the bogie is not as in Table I."""
    printed, given = table1(kind=problem.bogie.kind).parameters(), problem.bogie.parameters()
    changed = [name for name, x in given.items() if name in printed and x != printed[name]]
    added = [name for name in given if name not in printed]
    told = [
        *(["changed: " + ", ".join(changed)] if changed else []),
        *(["added: " + ", ".join(added)] if added else []),
    ]
    return f"Against Table I of the paper {'; '.join(told)}." if told else "The bogie is that of Table I of the paper."


def _parameters(problem: Problem) -> Iterator[Any]:
    """Yield the tables of bogie and car body beside Table I; what differs is marked by a sign and by words."""
    printed = table1(kind=problem.bogie.kind).parameters()
    of_body = set(problem.car_body.parameters()) - set(problem.bogie.parameters()) if problem.car_body else set()
    columns = "", "value", "Table I"
    bogie, body = titled("Bogie, beside Table I of the paper", *columns), titled("Car body", "", "value")
    any_differs = any(printed.get(name) != value for name, value in problem.bogie.parameters().items())
    for table in (bogie, body):
        for name in ("meaning", *(("differs",) if table is bogie and any_differs else ())):
            table.add_column(name, justify="left")
    for name, value in problem.parameters().items():
        row = PARAMETERS[name]
        shown = "rigid" if value == float("inf") else format_quantity(value, row.unit)
        if name in of_body:
            body.add_row(name, shown, row.meaning)
            continue
        known = printed.get(name)
        table1_value = "not in it" if known is None else format_quantity(known, row.unit)
        differs = "" if value == known else "≠ added" if known is None else "≠ changed"
        bogie.add_row(name, shown, table1_value, row.meaning, *([differs] if any_differs else []))
    yield bogie
    if of_body:
        yield body

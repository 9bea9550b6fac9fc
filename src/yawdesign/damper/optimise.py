"""The design of largest margin that the curve allows, checked by a second route, or what to change."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from yawdesign.damper.best_design import Map, best_design
from yawdesign.damper.capping import GIVEN_AWAY, CappingMode, at_design, capping_modes, names_of, sensitivity
from yawdesign.damper.catalogue_optimum import best_of_catalogue
from yawdesign.damper.curving import excess, largest_resistance
from yawdesign.damper.demands import LEAST_SCALE, RESERVE
from yawdesign.damper.design_space import MISSED, Space, fraction, scale
from yawdesign.damper.forward import ForwardDesign, design, forward_design
from yawdesign.damper.optimum import Bound, Optimum, SingleOptimum
from yawdesign.damper.relaxations import conflict, relaxations
from yawdesign.damper.second_route import Checked, checked_under_all, hurwitz_positive, next_margins
from yawdesign.damper.stable_intervals import others_stable
from yawdesign.damper.status import Status
from yawdesign.hunting.all_conditions import Judged, case_verdicts, worst_verdict
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.requirements import required
from yawdesign.hunting.scope import conditions_told
from yawdesign.hunting.verdict import CaseVerdict, RequirementVerdict
from yawdesign.hunting.worst_condition import worst_conditions
from yawdesign.problem import Curve, Problem, ProblemError
from yawdesign.problem.arguments import Progress, as_executor
from yawdesign.problem.progress import between, unseen
from yawdesign.problem.table import as_seed
from yawdesign.vehicle.vehicle import Vehicle

ACTIVE = 1e-4  # a variable within this share of its range from a bound stands at the bound
OF_CATALOGUE = "`choose` tells what each damper of the catalogue lacks"  # nothing is relaxed there
NAMED = 4  # changes that the message names
WORSE = 1e-6  # by so much of it a fault's decay rate must fall to be called worse [1/s]


def optimise(
    problem: Problem,
    *,
    seed: int = 0,
    options: Mapping[str, Any] | None = None,
    executor: Any = None,
    progress: Progress = lambda text, part: None,
) -> Optimum:
    """Return the design with the largest margin under the curving constraint of eq. (13) that meets the requirements.

    Parameters
    ----------
    problem : Problem
        Its design variables, bounds and objective say what is sought. The margin is the worst under all its conditions.
    seed : int, optional
        Of the search points. With up to three variables the answer does not depend on it; with more, try a few.
    options : mapping, optional
        Options of CasADi's `nlpsol` for IPOPT; they take the place of the defaults.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who searches, where there are several searches: with more than three variables, and with a catalogue.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    Optimum
        The design variables in SI, the margin, and what limits it.

    Raises
    ------
    ProblemError
        If C_s is neither given nor a design variable.
    """
    seed = as_seed(seed) or 0
    if problem.design.catalogue:
        alone = partial(_without_changes, seed=seed, options=options or {})
        damper, best = best_of_catalogue(problem, alone, executor=executor, progress=progress)
        return replace(best, damper=damper.name, message=best.message.replace(Status.UNSTABLE.remedy, OF_CATALOGUE))
    spread = map if executor is None else as_executor(executor).map
    found = _optimum(problem, seed, options or {}, between(progress, 0.0, 0.6), spread)
    if found.status not in (Status.UNSTABLE, Status.NO_FEASIBLE_DESIGN):
        return found
    near = None if found.C_s is None else {name: bound.value for name, bound in found.bounds.items()}
    changes = relaxations(problem, design=near, seed=seed, progress=between(progress, 0.6, 0.8))
    enough = [change.name for change in changes if change.met][:NAMED]
    remedy = (
        f"enough alone is a change of {' or '.join(enough)}" if enough else "no single change that was tried is enough"
    )
    message = found.message.replace(Status.UNSTABLE.remedy, remedy)
    excluded = conflict(problem, seed=seed, progress=between(progress, 0.8, 1.0))
    return replace(found, message=message, conflict=excluded, relaxations=changes)


def _without_changes(problem: Problem, seed: int, options: Mapping[str, Any]) -> Optimum:
    """Return the best design of a damper of a catalogue."""
    return _optimum(problem, seed, options, unseen)


def _optimum(problem: Problem, seed: int, options: Mapping[str, Any], progress: Progress, spread: Map = map) -> Optimum:
    """Return the best design, without what to change where there is none."""
    space = Space(problem)
    if "C_s" not in space.names and problem.bogie.C_s is None:
        raise ProblemError("bogie.C_s is missing: give its value, or make it a design variable")
    if space.curve is not None and not space.feasible(space.values(space.gentlest)):
        return _nothing(space, space.curve)
    space, x = best_design(space, seed, options, between(progress, 0.0, 0.5), spread)
    merit = float(np.squeeze(space.margins_at(x[:, None])))
    capping = capping_modes(space, x) if space.model.has_car_body and merit > -MISSED else ()
    if capping:
        # Numbers, and not x, go on: the curve's limit stays where it is.
        values = space.values(x)
        anchor = {name: float(values[name]) for name in space.names}
        second = replace(space, pairs=len(capping), floor=(1 - GIVEN_AWAY) * merit, anchors_given=(anchor,))
        space, x = best_design(second, seed, options, between(progress, 0.5, 0.8), spread)
    progress("checking the best design", 0.8)
    answer = _answer(space, x, capping)
    return replace(answer, single_bogie=_single(space, seed, options, between(progress, 0.9, 1.0)))


def _single(space: Space, seed: int, options: Mapping[str, Any], progress: Progress) -> SingleOptimum | None:
    """Return what one bogie alone would have answered, and what that is worth under the car body."""
    problem = space.problem.of_one_bogie
    if problem is None or not set(space.names) <= set(problem.keys):
        return None
    alone = _optimum(problem, seed, options, lambda _, part: progress("one bogie alone", part))
    if alone.margin is None:
        return SingleOptimum(alone.optimum, None, None, stable=False)
    chosen = {name: bound.value for name, bound in alone.bounds.items()}
    p = {name: float(value) for name, value in (space.problem.parameters() | chosen).items()}
    moving = worst_verdict(space.problem, p)
    return SingleOptimum(alone.optimum, alone.margin, float(getattr(moving, space.objective)), stable=moving.stable)


def _answer(space: Space, x: Float, capping: Sequence[CappingMode]) -> Optimum:
    values = {name: float(np.squeeze(v)) for name, v in space.values(x).items()}
    checked = checked_under_all(_with_lowest(space, values), values)
    nexts = next_margins(space, checked.vehicles) if capping else None
    judged, with_faults = Judged(space.problem, values), [Judged(space.problem, values, x) for x in space.problem.cases]
    requirements = required(judged, with_faults)
    bounds = {name: _bound(space, name, values[name]) for name in space.names}
    curve = space.curve
    resisted = None if curve is None else largest_resistance(values, values["C_s"], space.loads, curve)
    status, message = _status(checked, requirements, nexts is None or nexts.agree, curve is not None)
    return _optimum_of(
        space,
        forward_design(space.model, values, space.condition_set, space.curve),
        status,
        optimum={name: values.get(name) for name in _named(space)},
        margin=checked.margin,
        **_capped(space, checked.vehicles[0], capping, None if nexts is None else nexts.margin),
        worst_condition=checked.worst.described,
        active=_active(bounds, resisted, space.curve, requirements),
        message=message,
        stable=checked.stable,
        rotational_resistance=resisted,
        bounds=bounds,
        fixed_modes=checked.results[0].fixed_modes,
        modes=checked.results[0].modes,
        hurwitz_positive=all(hurwitz_positive(vehicle) for vehicle in checked.vehicles),
        margin_polynomial=checked.second,
        checked=status != Status.UNVERIFIED_OPTIMUM,
        requirements=requirements,
        **_cases(space.problem, tuple(one.case_verdict for one in with_faults)),
    )


def _with_lowest(space: Space, values: Mapping[str, float]) -> Space:
    """Return a space that looks also at the worst conditions inside ranges that are hardly worse than those known."""
    if not space.condition_set.ranges:
        return space
    measure = Measure(space.objective, space.names)
    found = (worst.condition for worst in worst_conditions(space.model, dict(values), space.condition_set, measure))
    return replace(space, known=(tuple(dict.fromkeys((*space.conditions, *found))), *space.known[1:]))


def _status(
    checked: Checked, requirements: Sequence[RequirementVerdict], agree: bool, in_curve: bool
) -> tuple[Status, str]:
    """Return what kind of answer it is, in a word and in a sentence."""
    if not (agree and checked.agree and all(each.checked for each in requirements)):
        return Status.UNVERIFIED_OPTIMUM, Status.UNVERIFIED_OPTIMUM.message
    if not checked.stable:
        helpless = not all(others_stable(vehicle) for vehicle in checked.vehicles)
        return Status.UNSTABLE, Status.UNDAMPED.message if helpless else Status.UNSTABLE.told(in_curve=in_curve)
    missed = ", ".join(each.name for each in requirements if not each.met)
    status, reason = Status.OPTIMAL, ""
    if missed:
        status, reason = Status.REQUIREMENTS_MISSED, f"the one that misses least misses {missed}"
    return status, status.told(reason, in_curve=in_curve)


def _cases(problem: Problem, after: tuple[CaseVerdict, ...]) -> dict[str, Any]:
    """Return how the faults are survived by a design and by the problem as written."""
    before: tuple[CaseVerdict, ...] = ()
    if problem.bogie.C_s is not None:
        before = case_verdicts(problem, {name: float(value) for name, value in problem.parameters().items()})
    pairs = zip(after, before, strict=False)
    worsened = tuple(new.name for new, old in pairs if new.decay_rate < old.decay_rate - WORSE)
    return {"cases": after, "cases_before": before, "worsened": worsened}


def _capped(space: Space, vehicle: Vehicle, capping: Sequence[CappingMode], margin: float | None) -> dict[str, Any]:
    """Return what is told of the modes that cap the margin, under its worst condition."""
    if not capping:
        return {}
    modes = [at_design(vehicle, mode, space.objective) for mode in capping]
    return {
        "next_margin": margin,
        "capped_by": names_of(vehicle, modes),
        "capping_sensitivity": sensitivity(vehicle, modes[0], space.objective),
    }


def _nothing(space: Space, curve: Curve) -> Optimum:
    values = {name: float(value) for name, value in space.values(space.gentlest).items()}
    return _optimum_of(
        space,
        design(space.problem),
        Status.NO_FEASIBLE_DESIGN,
        optimum=dict.fromkeys(_named(space)),
        margin=None,
        worst_condition={},
        active=("rotational_resistance",),
        message=Status.NO_FEASIBLE_DESIGN.told(excess(space.in_curve(values), space.names, curve)),
        stable=False,
        rotational_resistance=None,
        bounds={},
        fixed_modes={},
        modes=(),
        hurwitz_positive=False,
        margin_polynomial=None,
        checked=True,
    )


def _named(space: Space) -> tuple[str, ...]:
    return tuple(dict.fromkeys(("C_s", "K_m", "C_m", *space.names)))


def _optimum_of(space: Space, forward: ForwardDesign, status: Status, **own: Any) -> Optimum:
    return Optimum(
        C_s=own["optimum"]["C_s"],
        objective=space.objective,
        margin_before=_margin_before(space),
        status=status,
        C_su=forward.C_su,
        before={name: space.problem.parameters().get(name) for name in space.names},
        load=forward.load,
        forward=forward,
        searched=conditions_told(space.condition_set, space.problem.parameters()),
        **own,
    )


def _margin_before(space: Space) -> float | None:
    if space.problem.bogie.C_s is None:
        return None
    p = {name: float(value) for name, value in space.problem.parameters().items()}
    return float(getattr(worst_verdict(space.problem, p), space.objective))


def _bound(space: Space, name: str, value: float) -> Bound:
    low, high = space.bounds(name)
    return Bound(value, low, high, fraction(low, high, value, scale(name)))


def _active(
    bounds: Mapping[str, Bound],
    resistance: float | None,
    curve: Curve | None,
    requirements: Sequence[RequirementVerdict],
) -> tuple[str, ...]:
    ends = [(f"{name} min", b.position) for name, b in bounds.items()]
    ends += [(f"{name} max", 1 - b.position) for name, b in bounds.items()]
    if resistance is not None and curve is not None:
        ends.append(("rotational_resistance", 1 - resistance / curve.limit))
    ends += [(f"requirements.{x.name}", _room(x)) for x in requirements if x.met]
    return tuple(name for name, gap in ends if gap < ACTIVE)


def _room(requirement: RequirementVerdict) -> float:
    """Return by which share more is reached than a requirement makes a design keep."""
    if requirement.reached is None:
        return np.inf
    measure = requirement.name.rpartition(".")[2]
    kept = max(requirement.wanted, RESERVE.get(measure, 0.0))
    return (requirement.reached - kept) / max(requirement.wanted, LEAST_SCALE.get(measure, 0.0))

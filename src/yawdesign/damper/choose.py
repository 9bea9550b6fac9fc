"""The dampers of a catalogue in a vehicle: each is scored, the best are looked at closer, all are ranked."""

from collections.abc import Callable, Iterable
from typing import Any

from yawdesign.damper.candidates import OK, UNVERIFIED, Candidate, Choice, rank
from yawdesign.damper.scored_rows import ScoredRows, in_groups, verified
from yawdesign.hunting.scope import conditions_told, scope
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress, as_executor
from yawdesign.problem.conditions import condition_set
from yawdesign.problem.damper_catalogue import CatalogueDamper
from yawdesign.problem.progress import between
from yawdesign.vehicle.vehicle import Vehicle

ALL = 0.2  # share of the work that is done when all dampers have been looked at on arrays
CLOSER = 10  # of the best, for which the worst condition is searched and all is computed twice
LINEAR = (
    "blow_off and damping_after are shown and not computed with: above its blow-off force a damper gives less damping "
    "than this linear model has."
)


def choose(problem: Problem, *, executor: Any = None, progress: Progress = lambda text, part: None) -> Choice:
    """Return the dampers of a problem's catalogue, the best first, with the reason for each that is refused.

    Each takes the place of the yaw damper, all other values are as written. The ten best are looked at closer: inside
    of ranges the worst condition is searched for, and all verdicts are taken twice.

    Parameters
    ----------
    problem : Problem
        With ``design.catalogue``. Bounds of C_s, if it is a design variable, leave out dampers.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who looks closer; by default this process.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    Choice
        The dampers with their margins, the best first.

    Raises
    ------
    ProblemError
        If there is no catalogue.

    Examples
    --------
    >>> import yawdesign as yd
    >>> rows = [{"name": f"D{c}", "damping": f"{c} kN s/m", "stiffness": "20 MN/m"} for c in (10, 400, 1400)]
    >>> found = yd.choose(yd.table1().replace(design=yd.Design(catalogue=rows)))
    >>> [(each.name, each.status) for each in found.candidates]
    [('D400', 'ok'), ('D10', 'unstable'), ('D1400', "exceeds the curve's limit")]
    """
    spread: Callable[..., Iterable[Candidate]] = map if executor is None else as_executor(executor).map
    dampers = catalogue_of(problem)
    groups, known = in_groups(problem, dampers), dict[str, Candidate]()
    for k, group in enumerate(groups):
        progress(f"{len(dampers)} dampers on arrays", ALL * k / len(groups))
        known |= {each.name: each for each in group.candidates()}
    rows = {damper.name: damper for damper in dampers}
    done = ALL
    while todo := _next(known.values()):
        told = between(progress, done, (1 + done) / 2)
        alone = [ScoredRows(problem, (rows[each.name],)) for each in todo]
        answers = iter(spread(verified, alone, todo))
        for k, each in enumerate(todo):
            told(f"closer: {each.name}", k / len(todo))
            known[each.name] = next(answers)
        done = (1 + done) / 2
    ranked = sorted(known.values(), key=rank)
    curve = problem.curve
    linear = LINEAR if any(damper.blow_off is not None for damper in dampers) else ""
    return Choice(
        candidates=tuple(ranked),
        objective=problem.design.objective,
        limit=None if curve is None else float(curve.limit),
        searched=conditions_told(condition_set(problem), problem.parameters()),
        notes=tuple(filter(None, (scope(Vehicle.of(groups[0].space.problem)), linear))),
    )


def catalogue_of(problem: Problem) -> tuple[CatalogueDamper, ...]:
    """Return the dampers of a problem; an error if there are none."""
    if not problem.design.catalogue:
        raise ProblemError("design.catalogue is missing: give the name of a file, or dampers, to choose from")
    return problem.design.catalogue


def _next(known: Iterable[Candidate]) -> list[Candidate]:
    """Return which dampers to look at closer.

    A closer look finds no more than an estimate: it is done where the first ten that keep all limits have had theirs.
    """
    first = sorted(known, key=rank)[:CLOSER]
    return [each for each in first if not each.searched and each.status in (OK, UNVERIFIED)]

"""The best design with a damper of a catalogue: the other variables move for each of the promising dampers.

What a damper promises is the best merit of some points of the other variables. Dampers are optimised in that order; one
is left out if it promises less than the best optimum by more than twice of what optimising has gained so far. This is a
search and no proof.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.stats import qmc

from yawdesign.damper.choose import catalogue_of
from yawdesign.damper.design_space import MISSED, Space
from yawdesign.damper.optimum import Optimum
from yawdesign.damper.scored_rows import OWN, ScoredRows, bounds_of_rows, in_groups, with_damper
from yawdesign.hunting.arrays import Float, Index
from yawdesign.problem import PARAMETERS, Problem, ProblemError, Variable
from yawdesign.problem.arguments import Progress, as_executor
from yawdesign.problem.damper_catalogue import CatalogueDamper
from yawdesign.problem.quantities import Written, exact

POINTS = 1024  # of the other variables, by which dampers are compared
FIRST = 12  # of them whose margins are computed for every damper
MOST_LOOKS = 30  # at the others: as half of those that beat a damper's best are better still, about ten are needed
LEAST = 3  # dampers that are optimised in any case
TOGETHER = 4  # dampers that are given to an executor at a time
CREDIT = 2  # times the largest gain so far by which another damper may fall short
SPAN = 1e-9  # relative width of the bounds of C_s where nothing else is a variable


def best_of_catalogue(
    problem: Problem,
    optimised: Callable[[Problem], Optimum],
    *,
    executor: Any = None,
    progress: Progress = lambda text, part: None,
) -> tuple[CatalogueDamper, Optimum]:
    """Return the damper of the catalogue with which the other variables reach most, and that optimum.

    Parameters
    ----------
    problem : Problem
        With a catalogue; C_s and K_ds come from it.
    optimised : callable
        Returns the optimum of a problem without one; an executor must be able to send it.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who optimises; by default this process.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Raises
    ------
    ProblemError
        If there is no catalogue, or no damper of it keeps the bounds.
    """
    together, spread = (1, map) if executor is None else (TOGETHER, as_executor(executor).map)
    progress("comparing the dampers", 0.0)
    promised = _promised(problem)
    least = LEAST if _others(problem) else 1
    found: list[tuple[tuple[bool, float], CatalogueDamper, Optimum]] = []
    gain = 0.0
    for batch in (promised[k : k + together] for k in range(0, len(promised), together)):
        level = max((merit for (_, merit), _, _ in found), default=-np.inf)
        some = [each for each in batch if len(found) < least or each[1] + CREDIT * gain >= level]
        if not some:
            break
        tasks = [_without_catalogue(problem, damper) for damper, _ in some]
        answers: Iterator[Optimum] = iter(spread(optimised, tasks))
        for damper, promise in some:
            progress(f"optimising with {damper.name}", len(found) / len(promised))
            answer = next(answers)
            margin = -np.inf if answer.margin is None else answer.margin
            found.append(((answer.status == "optimal", margin), damper, answer))
            if promise > -MISSED:
                gain = max(gain, margin - promise)
    _, damper, answer = max(found, key=lambda each: each[0])
    return damper, answer


def _promised(problem: Problem) -> list[tuple[CatalogueDamper, float]]:
    """Return the dampers that keep the bounds with what they promise, the most promising first."""
    bounds = bounds_of_rows(problem)
    dampers = [
        each
        for each in catalogue_of(problem)
        if all(low <= float(getattr(each, name)) <= high for name, (low, high) in bounds.items())
    ]
    if not dampers:
        ends = "; ".join(f"{name} {PARAMETERS[name].range_text(range_)}" for name, range_ in bounds.items())
        raise ProblemError(f"design.catalogue: no damper of it lies within the bounds: {ends}")
    promised = [
        (damper, float(merit))
        for rows in in_groups(problem, dampers)
        for damper, merit in zip(rows.dampers, _merits(rows), strict=True)
    ]
    return sorted(promised, key=lambda each: (-each[1], each[0].C_s))


def _merits(rows: ScoredRows) -> Float:
    """Return the best merit of each damper over some points of the other variables, the gentlest and as written."""
    problem, size = rows.space.problem, len(rows.dampers)
    others = _others(problem)
    if not others:
        return rows.space.margins(rows.values)
    space = Space(replace(problem, design=replace(problem.design, variables=others)))
    x = np.concatenate([space.anchors, qmc.Sobol(len(others), rng=0).random(POINTS).T], axis=1)
    p, which, left = space.values(x), np.repeat(np.arange(size), x.shape[1]), np.tile(np.arange(x.shape[1]), size)
    rng, best = np.random.default_rng(0), np.full(size, -np.inf)

    def at(row: Index, point: Index) -> dict[str, Any]:
        there = {name: value[point] if np.ndim(value) else value for name, value in p.items()}
        return there | {name: rows.values[name][row] for name in OWN if name in rows.values}

    chosen: Any = left < FIRST  # first these, then one of each damper that beats its best, as long as there are any
    for _ in range(MOST_LOOKS):
        np.maximum.at(best, which[chosen], rows.space.margins(at(which[chosen], left[chosen])))
        better = rows.space.beats(at(which, left), best[which])
        which, left = which[better], left[better]
        order = rng.permutation(len(left))
        chosen = order[np.unique(which[order], return_index=True)[1]]
        if not len(left):
            break
    return best


def _without_catalogue(problem: Problem, damper: CatalogueDamper) -> Problem:
    """Return the problem with a damper, of which the other variables move; without any C_s is held by its bounds."""
    alone = with_damper(problem, damper)
    variables = _others(problem)
    if not variables:
        least = Written(exact(damper.C_s))
        variables = {"C_s": Variable(min=least, max=Written(least.exact * (1 + exact(SPAN))))}
    return replace(alone, design=replace(alone.design, variables=variables))


def _others(problem: Problem) -> dict[str, Variable]:
    """Return the design variables that do not come from the catalogue."""
    return {name: variable for name, variable in problem.design.variables.items() if name not in OWN}

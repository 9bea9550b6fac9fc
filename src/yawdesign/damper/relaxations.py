"""What to change where there is no answer: the least change of each single number with which there is one.

Each is found by solving again: the best design of a space in which the number gives way, by dense verdicts and
refinement. The changed problem is then looked at as any other, under all conditions.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from yawdesign.damper.changed_problem import Way, ways, with_value
from yawdesign.damper.design_space import MISSED, Space
from yawdesign.damper.relaxed_space import STABILITY, RelaxedSpace
from yawdesign.damper.stencils import distinct, refine
from yawdesign.hunting.arrays import Float
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress

SLACK = 1e-3  # of the least change: so much more is told, with which a search finds more than one design
NOTHING = 1e-7  # a change by less, relative, is none
FIRST = 192  # points that give a first level
MOST_POINTS, BLOCK = 131_072, 16_384  # in three variables and more; each one less takes a quarter of it
PASSED = 48  # points of a block that are better than all before and get a value
STARTS, APART = 6, 0.05  # points that are refined, and how far they are apart
CANDIDATES = 100  # of which these are chosen
MOST_ADDED = 8  # times that conditions are added


@dataclass(frozen=True)
class Relaxation:
    """The least change of one number of a problem with which there is a design.

    Parameters
    ----------
    name : str
        Its key in a problem file: ``"curve.limit"``, ``"bogie.K_2x"``, ``"speed"`` (those above it are lowered to it),
        ``"requirements.damping_ratio"``, ``"design.variables.C_s.max"``.
    kind : {"limit", "parameter", "speed", "requirement", "bound"}
        What it is.
    now : float
        Its value as written, in SI units [SI].
    value : float or None
        The value with which there is a design; None if no change of it alone is enough [SI].
    change : float or None
        ``value / now - 1`` [-].
    searched : float
        How far it was changed at most [SI].
    design : mapping
        Values of the design variables with which all is met then, in SI units.
    margin : float or None
        The worst margin of that design: [1/s] for a decay rate, [-] for a damping ratio.
    met : bool
        Whether there is such a value, and the design was found to meet everything with it, under all conditions.
    """

    name: str
    kind: str
    now: float
    value: float | None
    change: float | None
    searched: float
    design: Mapping[str, float]
    margin: float | None
    met: bool


def relaxations(
    problem: Problem,
    *,
    design: Mapping[str, float] | None = None,
    seed: int = 0,
    progress: Progress = lambda text, part: None,
) -> tuple[Relaxation, ...]:
    """Return the least change of each single number with which there is a design, the smallest change first.

    Parameters
    ----------
    problem : Problem
        Without an answer: no design within its bounds meets all that it demands.
    design : mapping, optional
        Values of the variables of a design that misses it by little, from which the search starts too.
    seed : int, optional
        Of the search points.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    tuple of Relaxation
        Of a number that may go up or down the smaller change; none if there is a design without any.
    """
    every, found = ways(problem), list[Relaxation]()
    anchors = () if design is None else (dict(design),)
    for k, way in enumerate(every):
        progress(f"relaxing {way.name}", k / len(every))
        found.append(_relaxation(RelaxedSpace(problem, anchors_given=anchors, way=way), seed))
        if found[-1].change is not None and abs(found[-1].change) < NOTHING:
            return ()
    return tuple(sorted(_one_of_each(found), key=_size))


def relaxed(problem: Problem, relaxation: Relaxation) -> Problem:
    """Return a problem with a relaxation in it.

    Parameters
    ----------
    problem : Problem
        The one that it belongs to.
    relaxation : Relaxation
        With a value.
    """
    if relaxation.value is None:
        raise ProblemError(f"{relaxation.name}: no change of it alone is enough")
    way = Way(relaxation.name, relaxation.kind, relaxation.now, relaxation.searched)
    return with_value(problem, way, relaxation.value)


def _size(relaxation: Relaxation) -> float:
    return np.inf if relaxation.change is None else abs(relaxation.change)


def _one_of_each(found: Sequence[Relaxation]) -> list[Relaxation]:
    """Return the smaller change of what may go up or down."""
    best = {one.name: one for one in sorted(found, key=_size, reverse=True)}
    return list(best.values())


def _relaxation(space: RelaxedSpace, seed: int) -> Relaxation:
    """Return the least relaxation of one number; conditions are added until no worse one is found."""
    way = space.way
    for _ in range(MOST_ADDED if space.passes_curve else 0):
        x = best_point(space, space.anchors, seed)
        share = -float(space.margins_at(x)[0])
        if not np.isfinite(share):
            break
        value = float(way.at(min(share * (1 + SLACK), 1.0)))
        changed = Space(with_value(space.problem, way, value), known=space.known_at(value))
        y = refine(changed, x, changed.margins_at(x), np.random.default_rng(seed), radius=1e-3, rounds=20, tries=3)
        more = changed.with_worst(y[:, 0])
        if more is None:
            return _of_design(space, value, changed, y[:, :1])
        space = replace(space, known=more.known)
    return Relaxation(way.name, way.kind, way.now, None, None, way.far, {}, None, met=False)


def _of_design(space: RelaxedSpace, value: float, changed: Space, x: Float) -> Relaxation:
    way, values, margin = space.way, changed.values(x[:, 0]), float(changed.margins_at(x)[0])
    return Relaxation(
        name=way.name,
        kind=way.kind,
        now=way.now,
        value=value,
        change=value / way.now - 1,
        searched=way.far,
        design={name: float(values[name]) for name in changed.names},
        margin=margin,
        met=margin > 0,
    )


def conflict(problem: Problem, *, seed: int = 0, progress: Progress = lambda text, part: None) -> tuple[str, ...]:
    """Return what a problem without an answer demands in vain: any of it can be had without one other, but not all.

    Parameters
    ----------
    problem : Problem
        Without an answer.
    seed : int, optional
        Of the search points.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    tuple of str
        Keys of a problem file, and ``"stability"``. There may be other such sets; none if there is a design.
    """
    if _is_possible(problem, 0.0, seed):
        return ()
    bounds = [f"design.variables.{name}" for name in problem.design.variables]
    curve = [] if problem.curve is None else ["curve.limit"]
    left = [*(f"requirements.{each.name}" for each in problem.requirements), STABILITY, *bounds, *curve]
    for k, name in enumerate(every := tuple(left)):
        progress(f"looking for a design without {name}", k / len(every))
        others = [one for one in left if one != name]
        if not _is_possible(_demanding(problem, others), 0.0 if STABILITY in others else -MISSED, seed):
            left = others
    return tuple(left)


def _demanding(problem: Problem, names: Sequence[str]) -> Problem:
    """Return a problem that demands some of what it did; bounds that are not demanded are far away."""
    for way in ways(problem):
        if way.kind == "bound" and way.name.rpartition(".")[0] not in names:
            problem = with_value(problem, way, way.far)
    kept = tuple(each for each in problem.requirements if f"requirements.{each.name}" in names)
    return problem.replace(requirements=kept, curve=problem.curve if "curve.limit" in names else None)


def _is_possible(problem: Problem, level: float, seed: int) -> bool:
    """Return whether a search finds a design with a merit above a level."""
    space = Space(problem)
    if not np.any(space.feasible(space.values(space.gentlest))):
        return False
    block = np.random.default_rng(seed).random((len(space.names), BLOCK))
    if space.beats_at(block, np.full(BLOCK, level)).any():
        return True
    return bool(space.margins_at(best_point(space, space.anchors, seed))[0] > level)


def best_point(space: Space, anchors: Float, seed: int) -> Float:
    """Return the best point of a space that was found, shape (variables, 1)."""
    rng, d = np.random.default_rng(seed), len(space.names)
    x = np.concatenate([anchors, rng.random((d, FIRST))], axis=1)
    merit = space.margins_at(x)
    for _ in range(_blocks(d)):
        block = rng.random((d, BLOCK))
        best = max(float(merit.max()), -np.finfo(float).max)
        passed = block[:, space.beats_at(block, np.full(BLOCK, best))][:, :PASSED]
        if passed.shape[1]:
            x, merit = np.concatenate([x, passed], axis=1), np.concatenate([merit, space.margins_at(passed)])
    order = np.argsort(-merit, kind="stable")[:CANDIDATES]
    order = order[np.isfinite(merit[order])]
    if not order.size:
        return x[:, :1]
    order = order[distinct(x[:, order], merit[order], np.full(len(order), APART))[:STARTS]]
    return refine(space, x[:, order], merit[order], rng, points=64, tries=3, until=1e-4, rounds=30)[:, :1]


def _blocks(d: int) -> int:
    return max(1, (MOST_POINTS >> 2 * max(0, 3 - d)) // BLOCK)

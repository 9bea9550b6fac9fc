"""The front between margin and rotational resistance: for each resistance the design of largest margin.

It begins with the least resistance that a stable design has, and ends at twice the curve's limit, or before it where
more resistance leaves no larger margin. Each point is an optimum of its own, whose search begins with the designs of
both neighbours that are known: first halfway between the ends, then halfway between those, and so on. What stands
between other neighbours may be looked for in another process; a point that one with less resistance beats is looked
for again from there.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, as_completed
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np

from yawdesign.damper.best_design import best_design
from yawdesign.damper.curving import excess
from yawdesign.damper.design_space import Space
from yawdesign.damper.forward import design
from yawdesign.damper.least_resistance import LeastResistance, resistances
from yawdesign.damper.pareto_front import GAIN, Point, TradeOff, described, pareto
from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.scope import conditions_told
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress, as_executor
from yawdesign.problem.condition import Condition
from yawdesign.problem.progress import between, unseen
from yawdesign.problem.stopping import held
from yawdesign.problem.table import as_count, as_seed

LEAST = {"decay_rate": 1e-4, "damping_ratio": 1e-5}  # margin with which a design counts as stable [1/s], [-]
MOST_POINTS = 1000
FARTHEST = 2.0  # the last resistance, in the curve's limit
INACTIVE = 1e-4  # share of the limit by which a design stays below it where it has no part in the optimum
TURNS = ((2, 1e-3), (1, 1e-5))  # of NLP and refinement, for the last point
NEAR_TURNS = ((1, 1e-4),)  # ... for the others, which begin close to the best design
NEAR = 0.1  # share of the margin by which designs may fall behind a neighbour's, and are looked at nevertheless

Known = tuple[tuple[Condition, ...], ...]
Values = dict[str, float]
Solved = tuple[Known, Values]  # the conditions that decide a design, and all its parameters


class _Task(NamedTuple):
    """A problem, the conditions and the design that are known, and the seed of the search."""

    problem: Problem
    known: Known
    near: tuple[Values, ...]
    seed: int


class IncompleteTradeOffError(RuntimeError):
    """The points of a front could not all be found; those that were are in ``result``.

    Parameters
    ----------
    reason : str
        What happened.
    result : TradeOff
        With the points that are finished.
    """

    def __init__(self, reason: str, result: TradeOff) -> None:
        super().__init__(f"{reason}; {len(result.front)} points are finished: they are in .result")
        self.reason = reason
        self.result = result


def trade_off(
    problem: Problem,
    *,
    points: int = 12,
    seed: int = 0,
    executor: Any = None,
    progress: Progress = lambda text, part: None,
) -> TradeOff:
    """Return the front between margin and rotational resistance: designs that no other beats in both.

    Parameters
    ----------
    problem : Problem
        With a curve. Its design variables, bounds and objective say what is sought; the margin is the worst under all
        its conditions, and its requirements are met at every point.
    points : int, optional
        For how many resistances the best design is looked for, 2 or more. With three or more one is the curve's limit.
    seed : int, optional
        Of the search points.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who computes; by default this process.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    TradeOff
        The front, and the design as written beside it.

    Raises
    ------
    ProblemError
        If there is no curve, or C_s is neither given nor a design variable.
    IncompleteTradeOffError
        On Ctrl-C, or if a worker died; it holds the points that are finished.
    """
    try:
        count = as_count(points, 2, MOST_POINTS)
    except ProblemError as error:
        raise error.under("points") from None
    if problem.curve is None:
        raise ProblemError("curve is missing: without a curve there is no rotational resistance to trade off")
    if "C_s" not in problem.design.variables and problem.bogie.C_s is None:
        raise ProblemError("bogie.C_s is missing: give its value, or make it a design variable")
    return _Front(problem, as_seed(seed) or 0, None if executor is None else as_executor(executor), progress).found(
        count
    )


class _Front:
    """The search of a front."""

    def __init__(self, problem: Problem, seed: int, executor: Executor | None, progress: Progress) -> None:
        assert problem.curve is not None
        self.problem, self.seed, self.executor, self.progress = problem, seed, executor, progress
        self.limit = float(problem.curve.limit)
        self.space = Space(_limited(problem, FARTHEST * self.limit))
        self.ends_at: float | None = None

    def found(self, count: int) -> TradeOff:
        """Return the front, looked for at so many resistances."""
        space, curve = self.space, self.space.curve
        values = _numbers(space, space.gentlest)
        if curve is not None and not space.feasible(values):
            status = Status.NO_FEASIBLE_DESIGN
            return self._result((), status, status.told(excess(space.in_curve(values), space.names, curve)))
        gentle = LeastResistance(space.problem, level=LEAST[space.objective])
        begin = gentle.gentlest_design(self.seed, between(self.progress, 0.0, 0.2))
        if begin is None:
            status = Status.NO_FRONT if space.demands else Status.UNSTABLE
            return self._result((), status, status.message)
        first = _kept(*begin)
        space = Space(space.problem, known=first[0], anchors_given=({name: first[1][name] for name in space.names},))
        best, x = best_design(space, self.seed, {}, between(self.progress, 0.2, 0.3), turns=TURNS)
        last = self._last(_kept(best, x))
        return self._finished(first, last, count)

    def _last(self, last: Solved) -> Solved:
        """Return the design at which the front ends: where the limit has no part in one, that of least resistance."""
        if self._resistance(last) >= FARTHEST * self.limit * (1 - INACTIVE):
            return last
        known, values = last
        space = Space(self.space.problem, known=known)
        margin = float(space.margins(dict(values)))
        given = ({name: values[name] for name in space.names},)
        level = margin - GAIN * abs(margin)
        there = LeastResistance(space.problem, known=known, level=level, anchors_given=given)
        found = there.gentlest_design(self.seed, between(self.progress, 0.3, 0.35))
        last = last if found is None else _kept(*found)
        self.ends_at = self._resistance(last)
        return last

    def _between(self, first: Solved, last: Solved, count: int) -> list[float]:
        """Return the resistances from the first to the last but one, for which the best design is looked for."""
        low, high = self._resistance(first), self._resistance(last)
        if high <= low * (1 + INACTIVE):
            return []
        limits = np.linspace(low, high, count)
        if low < self.limit < high and count > 2:
            limits[1 + np.argmin(np.abs(limits[1:-1] - self.limit))] = self.limit
        return [float(limit) for limit in limits[:-1]]

    def _finished(self, first: Solved, last: Solved, count: int) -> TradeOff:
        """Return the front between its ends."""
        limits, end = self._between(first, last, count), self._resistance(last)
        solved = {end: last}
        try:
            for places in _halving(len(limits)):
                tasks = {}
                for place, *sides in places:
                    near = [solved[[*limits, end][side]] for side in sides] or [first, last]
                    tasks[limits[place]] = self._task(limits[place], near)
                for limit, one in self._each(tasks, len(solved) - 1, len(limits)):
                    solved[limit] = one
                    done = len(solved) - 1
                    self.progress(f"{done} of {len(limits)} points of the front", _share(done, len(limits)))
            self._raise_beaten(solved)
        except (KeyboardInterrupt, BrokenExecutor) as error:
            with held():
                happened = "a worker died" if isinstance(error, BrokenExecutor) else "it was stopped"
                status = Status.STOPPED
                raise IncompleteTradeOffError(
                    happened, self._result(self._points(solved.values()), status, status.message)
                ) from error
        front = self._points(solved.values())
        return self._result(front, *self._judged(front))

    def _task(self, limit: float, near: Sequence[Solved]) -> _Task:
        known = tuple(tuple(dict.fromkeys(chain(*parts))) for parts in zip(*(known for known, _ in near), strict=True))
        return _Task(_limited(self.problem, limit), known, tuple(values for _, values in near), self.seed)

    def _each(self, tasks: Mapping[float, _Task], before: int, count: int) -> Iterator[tuple[float, Solved]]:
        """Yield the solutions in the order in which they come; so many of all are solved before."""
        if self.executor is None:
            for done, (limit, task) in enumerate(tasks.items(), before):
                ends = _share(done, count), _share(done + 1, count)
                yield limit, _solved(*task, progress=between(self.progress, *ends))
            return
        futures = {self.executor.submit(_solved, *task): limit for limit, task in tasks.items()}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            for future in futures:
                future.cancel()

    def _raise_beaten(self, solved: dict[float, Solved]) -> None:
        """Look again for each best design that one with less resistance beats, from that one."""
        best: Solved | None = None
        for limit in sorted(solved):
            here = solved[limit]
            if best is not None and self._margin(here) < self._margin(best) * (1 - GAIN):
                here = solved[limit] = _solved(*self._task(limit, [best]))
            if best is None or self._margin(here) > self._margin(best):
                best = here

    def _margin(self, solved: Solved) -> float:
        known, values = solved
        return float(Space(self.space.problem, known=known).margins(dict(values)))

    def _resistance(self, solved: Solved) -> float:
        return float(resistances(self.space, dict(solved[1])))

    def _points(self, solved: Iterable[Solved]) -> tuple[Point, ...]:
        return pareto(described(self.space, values) for _, values in solved)

    def _judged(self, front: Sequence[Point]) -> tuple[Status, str]:
        """Return what kind of answer a front is, and that in a sentence."""
        if not front or not all(point["checked"] for point in front):
            return Status.UNVERIFIED_OPTIMUM, Status.UNVERIFIED_OPTIMUM.message
        text = Status.FRONT.message
        if self.ends_at is not None:
            text += f"; it ends at {self.ends_at:.5g}: no more margin was found with more resistance"
        if front[0]["rotational_resistance"] > self.limit * (1 + INACTIVE):
            text += f"; the curve's limit of {self.limit:.5g} allows no design"
        return Status.FRONT, text

    def _result(self, front: tuple[Point, ...], status: Status, message: str) -> TradeOff:
        golden, written = design(self.problem).C_s, self.problem.bogie.C_s
        return TradeOff(
            front=front,
            objective=self.space.objective,
            limit=self.limit,
            golden=self._beside(golden),
            written=self._beside(written),
            ends_at=self.ends_at,
            status=status,
            message=message,
            searched=conditions_told(self.space.condition_set, self.problem.parameters()),
        )

    def _beside(self, C_s: float | None) -> Point | None:
        """Return the point of a design with another C_s and everything else as written."""
        if C_s is None:
            return None
        values = {name: float(value) for name, value in self.problem.parameters().items()}
        return described(self.space, {**values, "C_s": C_s})


def _share(done: int, count: int) -> float:
    """Return the share of the work that is done with so many points: finding the ends is part of it."""
    return 0.35 + 0.65 * done / count


def _halving(count: int) -> Iterator[Sequence[tuple[int, ...]]]:
    """Yield places 0 ... count - 1 in turns, each with the places on both sides of it that came in earlier turns.

    Before the first turn the place `count` is known; what the first place begins with is not among the places.

    Examples
    --------
    >>> list(_halving(5))
    [[(0,)], [(2, 0, 5)], [(1, 0, 2), (3, 2, 5)], [(4, 3, 5)]]
    """
    ends = [0, count]
    if count:
        yield [(0,)]
    while turn := [((low + high) // 2, low, high) for low, high in pairwise(ends) if high - low > 1]:
        yield turn
        ends = sorted([*ends, *(place for place, _, _ in turn)])


def _solved(problem: Problem, known: Known, near: Sequence[Values], seed: int, progress: Progress = unseen) -> Solved:
    """Return the best design of a problem, whose search begins with known conditions and known designs."""
    given = tuple({name: values[name] for name in problem.design.variables} for values in near)
    beginning = Space(problem, known=known, anchors_given=given, near=NEAR)
    space, x = best_design(beginning, seed, {}, progress, turns=NEAR_TURNS)
    return _kept(space, x)


def _kept(space: Space, x: Float) -> Solved:
    return (space.conditions, *(one.conditions for one in space.demanded)), _numbers(space, x)


def _limited(problem: Problem, limit: float) -> Problem:
    return problem.replace(limit=limit)


def _numbers(space: Space, x: Float) -> Values:
    return {name: float(np.squeeze(value)) for name, value in space.values(x).items()}

"""The worst of all conditions for one design: of lists every combination, of ranges a search inside them.

First on a grid, with verdicts: a level falls until few conditions leave less. Then from the lowest few that are apart,
each to the lowest margin near it by the gradient: where a margin is lowest it is that of one mode, and smooth. This is
a search and no proof: a narrow dip between the points of the grid may be missed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise, product
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float, Index
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet
from yawdesign.vehicle.vehicle import Model

PER_RANGE = {1: 129, 2: 33, 3: 17}  # points of the grid along each range; of more ranges there is a Sobol sequence
SEQUENCE = 8192
MOST_POINTS = 300_000  # of the grid, all lists together
MOST_SLOW_POINTS = 2_000  # the same where eigenvalues give the verdicts
LEAST_POINTS = 16  # for each combination of lists
SAMPLE = 64  # margins that are computed to lower the level
FEW = 192  # conditions of which the margins are all computed
SOME = 10 * FEW  # of more of them only some, where ranges are searched further
MOST_LOOKS = 12
SLACK = 0.1  # of the lowest margin: conditions with so much more are starts too
STARTS = 5  # conditions from which the lowest margin nearby is looked for
LOWEST = -1e9  # what counts as a margin of minus infinity
APART = 1e-3  # two that are closer than this, relative to the ranges, are one
STEP = 1e-5  # of the differences along a range, relative to it


@dataclass(frozen=True)
class Worst:
    """A condition with a low margin.

    Parameters
    ----------
    condition : Condition
        Which one.
    margin : float
        There: [1/s] or [-].
    """

    condition: Condition
    margin: float


def worst_conditions(model: Model, p: dict[str, Any], conditions: ConditionSet, measure: Measure) -> tuple[Worst, ...]:
    """Return conditions under which a vehicle's margin is low, the lowest first.

    Parameters
    ----------
    model, p : Model, dict
        The vehicle's equations and numbers as designed, ``C_s`` [N s/m] among them.
    conditions : ConditionSet
        In which the worst is looked for.
    measure : Measure
        Which margin.
    """
    names, ends = _names(conditions)
    place, x = _grid(conditions, MOST_SLOW_POINTS if measure.by_eigenvalues else MOST_POINTS)
    sets = _sets(model, p, conditions, place, x)
    margin = _low_margins(measure, sets, some=bool(conditions.ranges))
    found: list[tuple[int, Float, float]] = []
    for k in _starts(conditions, place, x, margin):
        there, least = _descended(model, p, conditions.lists[place[k]], names, ends, x[:, k], measure)
        if all(place[k] != j or np.max(np.abs(there - other), initial=0) > APART for j, other, _ in found):
            found.append((int(place[k]), there, least))
    values = [dict(zip(names, _between(ends, there).tolist(), strict=True)) for _, there, _ in found]
    worst = [Worst(conditions.at(k, x), least) for (k, _, least), x in zip(found, values, strict=True)]
    return tuple(sorted(worst, key=lambda one: one.margin))


def exceeds_everywhere(
    model: Model, p: dict[str, Any], conditions: ConditionSet, measure: Measure, level: float
) -> bool:
    """Return whether a margin surely exceeds a level at every point of the grid; the other arguments as above."""
    yes, sure = measure.exceeds(_sets(model, p, conditions, *_grid(conditions, MOST_POINTS)), level)
    return bool(np.all(yes & sure))


def _names(conditions: ConditionSet) -> tuple[list[str], Float]:
    ends = np.array([ends for _, ends in conditions.ranges], dtype=float).reshape(-1, 2)
    return [name for name, _ in conditions.ranges], ends


def _between(ends: Float, x: Float) -> Float:
    """Return values at points of the unit cube, shape (ranges, ...)."""
    low, high = (ends[:, k].reshape(-1, *[1] * (x.ndim - 1)) for k in (0, 1))
    return np.asarray(np.clip(low + (high - low) * x, low, high))


def _grid(conditions: ConditionSet, most: int) -> tuple[Index, Float]:
    """Return points in all combinations of lists: which combination, and where in the cube of the ranges."""
    d, lists = len(conditions.ranges), len(conditions.lists)
    x = _points(d, max(most // lists, LEAST_POINTS))
    return np.repeat(np.arange(lists), x.shape[1]), np.tile(x, lists)


@lru_cache
def _points(d: int, most: int) -> Float:
    if d == 0:
        return np.zeros((0, 1))
    if d in PER_RANGE:
        n = max(2, min(PER_RANGE[d], int(most ** (1 / d))))
        return np.array(list(product(np.linspace(0, 1, n), repeat=d))).T
    from scipy.stats import qmc  # takes longer to import than a search in up to three ranges

    corners = np.array(list(product((0.0, 1.0), repeat=d))).T
    inside = qmc.Sobol(d, rng=0).random(1 << (min(SEQUENCE, most) - 1).bit_length()).T
    return np.concatenate([corners, inside], axis=1)


def _sets(model: Model, p: dict[str, Any], conditions: ConditionSet, place: Index, x: Float) -> ParameterSets:
    """Return the vehicle under the conditions at points of the cube; the places rise."""
    names, ends = _names(conditions)
    values, ways = _between(ends, x), []
    borders = np.searchsorted(place, np.arange(len(conditions.lists) + 1)).tolist()
    for condition, (start, stop) in zip(conditions.lists, pairwise(borders), strict=True):
        ways.append((condition.with_values(dict(zip(names, values[:, start:stop], strict=True))), stop - start))
    return under_conditions(model, p, ways)


def _low_margins(measure: Measure, sets: ParameterSets, *, some: bool) -> Float:
    """Return the margins of those vehicles that have the lowest ones, or of some of them; infinity for others."""
    rng = np.random.default_rng(0)
    margin = np.full(sets.size, np.inf)
    left = _not_above(measure, sets, margin, np.arange(sets.size), SLACK, rng)
    if some and len(left) > SOME:  # many are nearly as low, or unstable ones have no verdict
        lowest = _not_above(measure, sets, margin, left, 0.0, rng)
        left = rng.choice(left, SOME, replace=False)
        left = left if len(lowest) > SOME else np.union1d(lowest, left)
    margin[left] = measure.of(sets.part(left))
    return margin


def _not_above(
    measure: Measure, sets: ParameterSets, margin: Float, left: Index, slack: float, rng: np.random.Generator
) -> Index:
    """Return those of the vehicles left whose margins may be below the least of samples; those of samples are noted.

    A slack, relative to that least margin, keeps those that are a little above too.
    """
    for _ in range(MOST_LOOKS):
        if len(left) <= FEW:
            break
        sample = rng.choice(left, SAMPLE, replace=False)
        margin[sample] = measure.of(sets.part(sample))
        least = margin.min()
        yes, sure = measure.exceeds(sets.part(left), least + slack * abs(least))
        left = left[~(yes & sure)]
    return left


def _starts(conditions: ConditionSet, place: Index, x: Float, margin: Float) -> Iterator[int]:
    """Yield the points with the lowest margins, none of which is close to a lower one."""
    chosen: list[int] = []
    per_range = PER_RANGE.get(len(conditions.ranges), 8)
    for k in np.argsort(margin, kind="stable")[: 20 * STARTS]:
        close = (place[k] == place[j] and np.all(np.abs(x[:, k] - x[:, j]) < 2.5 / per_range) for j in chosen)
        if not np.isfinite(margin[k]) or len(chosen) == STARTS:
            return
        if not any(close):
            chosen.append(int(k))
            yield int(k)


def _descended(
    model: Model,
    p: dict[str, Any],
    condition: Condition,
    names: Sequence[str],
    ends: Float,
    start: Float,
    measure: Measure,
) -> tuple[Float, float]:
    """Return the point of the cube with the lowest margin near a start, and that margin."""
    d, best = len(start), (start, np.inf)

    def margins(x: Float) -> Float:
        values = dict(zip(names, _between(ends, x), strict=True))
        return measure.of(under_conditions(model, p, [(condition.with_values(values), x.shape[1])]))

    def value_and_slope(x: Float) -> tuple[float, Float]:
        nonlocal best
        inside = np.clip(x, STEP, 1 - STEP)
        steps = np.concatenate([np.eye(d), -np.eye(d)], axis=1) * STEP
        found = margins(np.concatenate([x[:, None], inside[:, None] + steps], axis=1))
        if found[0] < best[1]:
            best = x.copy(), float(found[0])
        with np.errstate(invalid="ignore"):  # where a floor is missed, a margin is minus infinity
            slope = np.nan_to_num((found[1 : d + 1] - found[d + 1 :]) / (2 * STEP), posinf=0.0, neginf=0.0)
        return float(np.maximum(found[0], LOWEST)), slope

    if d == 0:
        return start, float(margins(start[:, None])[0])
    from scipy.optimize import minimize  # not needed where nothing is a range

    minimize(value_and_slope, start, jac=True, method="L-BFGS-B", bounds=[(0, 1)] * d, options={"maxiter": 40})
    return best

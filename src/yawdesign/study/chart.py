"""What a picture of a sweep shows beside its values; it is found here, because a picture computes nothing."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.damper.curving import curving_conditions, least_curving_limit
from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Array, Bools, Float
from yawdesign.problem import Problem
from yawdesign.problem.running import CURVE
from yawdesign.study.answers import joined
from yawdesign.study.axes import Axis, applied, damping_ratio
from yawdesign.study.executors import answer
from yawdesign.study.request import Request, remaining

Kinds = NDArray[np.int8]

# What there is to say of a point, beside a value.
STABLE, UNSTABLE, VALUE, ALWAYS, NEVER, LATER, NONE, UNKNOWN = range(8)
# Halvings of the distance between two points, the rest is not seen; fewer where the quick way fails near the change.
STEPS, FEWER_STEPS = 8, 5
MOST = 50_000  # places that are looked for, or limits of curves; no picture shows more


@dataclass(frozen=True, eq=False)
class Chart:
    """What a picture of a sweep over one or two axes shows beside its values.

    Parameters
    ----------
    kinds : ndarray of int
        What kind of answer each point has [-]: stable, a value, none, ...
    crossings : tuple of ndarray
        For each axis: at which of its values the kind changes between a point and the next one [SI]; NaN where it
        does not.
    C_su : ndarray or None
        What the curve allows over the axis beside C_s, under all conditions [N s/m].
    as_written : mapping name -> tuple of float
        What the problem itself has of the axes, of C_s and of the speed, in SI units.
    between : mapping name -> ndarray, or None
        Over one axis: all critical values at further places, where their number changes, in SI units; ``axis`` has
        the places.
    """

    kinds: Kinds
    crossings: tuple[Float, ...]
    C_su: Float | None
    as_written: Mapping[str, tuple[float, ...]]
    between: Mapping[str, Array] | None = None

    def without(self, k: int) -> "Chart":
        """Return the same without an axis that has one value."""
        crossings = tuple(np.take(x, 0, axis=k) for n, x in enumerate(self.crossings) if n != k)
        return replace(self, kinds=np.take(self.kinds, 0, axis=k), crossings=crossings)


def charted(
    asked: Request, axes: tuple[Axis, ...], columns: Mapping[str, Array], known: Bools, fixed: Mapping[str, float]
) -> Chart | None:
    """Return what a picture shows beside the values of a sweep; None where there is no such picture.

    Parameters
    ----------
    asked : Request
        What was asked for.
    axes : tuple of Axis
        Of the values.
    columns : mapping name -> ndarray
        What was found.
    known : ndarray of bool
        Points that have a verified answer.
    fixed : mapping name -> float
        Values of the request's other axes [SI].
    """
    several = [axis for axis in axes if axis.values.size > 1]
    if not 1 <= len(several) <= 2:
        return None
    of = asked.task.question.of
    kinds = kinds_of(of, columns, known)
    fixed = {**fixed, **{axis.name: float(axis.values[0]) for axis in axes if axis.values.size == 1}}
    return Chart(
        kinds=kinds,
        crossings=tuple(_crossings(asked, axes, columns, kinds, k, fixed) for k in range(len(axes))),
        C_su=_curving_limits(asked, [axis for axis in several if axis.name != "C_s"], fixed),
        as_written={name: as_written(asked.problem, name) for name in dict.fromkeys((*_names(axes), "C_s", "v"))},
        between=_between(asked, several[0], columns, fixed) if len(several) == 1 else None,
    )


def _names(axes: tuple[Axis, ...]) -> list[str]:
    return [axis.name for axis in axes]


def as_written(problem: Problem, name: str) -> tuple[float, ...]:
    """Return what a problem itself has of an axis [SI]: its speeds, one value of everything else, or nothing.

    Examples
    --------
    >>> import yawdesign as yd
    >>> [round(x, 2) for name in ("f_m", "xi_m", "v") for x in as_written(yd.table1(), name)]
    [3.0, 0.3, 83.33]
    """
    p = problem.parameters()
    if name == "v":
        return tuple(map(float, problem.speeds))
    if name in CURVE:
        return () if problem.curve is None else (float(getattr(problem.curve, name)),)
    if name in ("f_m", "xi_m"):
        if not p.get("K_m") or not p.get("M_m"):
            return ()
        return (sqrt(p["K_m"] / p["M_m"]) / (2 * pi),) if name == "f_m" else (damping_ratio(p),)
    value = 1.0 if name == "creep_factor" else p.get(name)
    return () if value is None or not isfinite(value) else (float(value),)


def kinds_of(of: str, columns: Mapping[str, Array], known: Bools) -> Kinds:
    """Return what there is to say of each point, beside a value."""
    if of in ("stable", "decay_rate", "damping_ratio"):
        found = np.where(columns[of] > 0, STABLE, UNSTABLE)
    elif of == "C_sl":
        value = columns["C_sl"]
        found = np.where(np.isnan(value), NEVER, np.where(value == 0, ALWAYS, VALUE))
    elif of == "design":
        never = columns["status"] == Status.STABLE_FOR_NONE
        found = np.where(np.isfinite(columns["C_s"]), VALUE, np.where(never, NEVER, NONE))
    else:
        found = _kinds_of_values(columns["unstable_roots"], shown_values(of, columns))
    return np.where(known, found, UNKNOWN).astype(np.int8)


def _kinds_of_values(roots: Float, shown: Float) -> Kinds:
    """Return the kinds of points with all critical values, of which one is shown where there is one."""
    stable, unstable = np.any(roots == 0, axis=-1), np.any(roots > 0, axis=-1)
    return np.select([np.isfinite(shown), stable & unstable, stable], [VALUE, LATER, ALWAYS], NEVER).astype(np.int8)


def shown_values(of: str, columns: Mapping[str, Array]) -> Float:
    """Return of all critical values at each point the one that matters: the largest damping, the speed of the end."""
    values: Float = columns[of]
    if not values.shape[-1]:
        return np.full(values.shape[:-1], np.nan)
    if of == "critical_speed":
        roots = columns["unstable_roots"]
        lost = (roots[..., :-1] == 0) & (roots[..., 1:] > 0)
        return np.asarray(np.fmin.reduce(np.where(lost, values, np.nan), axis=-1))
    return np.asarray(np.fmax.reduce(values, axis=-1))


def _crossings(
    asked: Request,
    axes: tuple[Axis, ...],
    columns: Mapping[str, Array],
    kinds: Kinds,
    k: int,
    fixed: Mapping[str, float],
) -> Float:
    """Return at which values of an axis the kind changes between one point and the next."""
    x, count = axes[k].values, kinds.shape[k] - 1
    first, second = (np.take(kinds, range(n, n + count), axis=k) for n in (0, 1))
    out = np.full(first.shape, np.nan)
    places = np.nonzero((first != second) & (first != UNKNOWN) & (second != UNKNOWN))
    low, high = x[places[k]], x[places[k] + 1]
    of = asked.task.question.of
    if of in ("decay_rate", "damping_ratio"):
        # Where the margin between the points is zero: never beyond one of them.
        y = columns[of]
        y_1, y_2 = y[places], y[(*places[:k], places[k] + 1, *places[k + 1 :])]
        part = y_1 / (y_1 - y_2)
        out[places] = _blend(low, high, part)
    elif 0 < low.size <= MOST:
        point = {**fixed, **{a.name: a.values[i] for a, i in zip(axes, places, strict=True)}}
        out[places] = _halved(asked, point, axes[k].name, low, high, kinds[places])
    return out


def _blend(low: Float, high: Float, part: Any) -> Float:
    """Return what lies between two ends, at a part of the ratio where both are positive."""
    positive = (low > 0) & (high > 0)
    a, b = np.where(positive, low, 1.0), np.where(positive, high, 1.0)
    return np.asarray(np.where(positive, a * (b / a) ** part, low + (high - low) * part))


def _halved(asked: Request, point: Mapping[str, Any], name: str, low: Float, high: Float, kinds: Kinds) -> Float:
    of = asked.task.question.of
    for _ in range(STEPS if of == "stable" else FEWER_STEPS):
        middle = _blend(low, high, 0.5)
        found = answer(asked.task, {**point, name: middle}, None)
        same = kinds_of(of, found.columns, ~found.unverified) == kinds
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return _blend(low, high, 0.5)


def _curving_limits(asked: Request, beside: list[Axis], fixed: Mapping[str, float]) -> Float | None:
    """Return what the curve allows over the axis beside C_s; None where there is no curve, or no single such axis."""
    curve, of = asked.problem.curve, asked.task.question.of
    if curve is None or len(beside) > 1:
        return None
    names = _names(asked.axes)
    conditions = curving_conditions(remaining(asked.problem, of, names))
    values = beside[0].values if beside else np.array([1.0])
    if len(conditions) * values.size > MOST:
        return None
    limits = []
    for x in values.tolist():
        point = {**fixed, **{axis.name: x for axis in beside}}
        p = applied(asked.task.parameters, point, asked.task.hold)
        own = replace(curve, **{name: value for name, value in point.items() if name in CURVE})
        limits.append(least_curving_limit(p, conditions, own))
    return np.array(limits)


def _between(asked: Request, axis: Axis, columns: Mapping[str, Array], fixed: Mapping[str, float]) -> Any:
    """Return all critical values where their number changes, at ever smaller distances."""
    of = asked.task.question.of
    if of not in ("critical", "critical_speed"):
        return None
    flat = {name: x.reshape(axis.values.size, *x.shape[-1:]) for name, x in columns.items() if name != "count"}
    roots = np.nan_to_num(flat["unstable_roots"], nan=-1)
    places = np.flatnonzero(np.any(roots[1:] != roots[:-1], axis=1))
    if not 0 < places.size <= MOST:
        return None
    low, high, mine = axis.values[places], axis.values[places + 1], roots[places]
    kept: list[dict[str, Array]] = []
    for _ in range(STEPS):
        middle = _blend(low, high, 0.5)
        found = answer(asked.task, {**fixed, axis.name: middle}, None)
        if found.unverified.any():
            return None
        kept.append({"axis": middle, **{name: found.columns[name] for name in flat}})
        same = _same_counts(np.nan_to_num(found.columns["unstable_roots"], nan=-1), mine)
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return {name: joined([each[name] for each in kept]) for name in kept[0]}


def _same_counts(found: Float, wanted: Float) -> Bools:
    width = max(found.shape[1], wanted.shape[1])
    a, b = (np.pad(x, ((0, 0), (0, width - x.shape[1])), constant_values=-1) for x in (found, wanted))
    return np.asarray(np.all(a == b, axis=1))

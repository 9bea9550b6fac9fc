"""Up to which speed a design is stable under all conditions, whatever speeds the problem names.

All critical speeds under few conditions. Then the worst condition at any lower speed is searched, and its critical
speeds added, until none is unstable below the lowest: each step is one of Newton's, because the speed at which the
worst one becomes stable is where the next search begins.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from yawdesign.hunting.all_conditions import Judged
from yawdesign.hunting.many.critical_speeds import ON_AXIS, critical_speeds
from yawdesign.hunting.many.margins import others_stable
from yawdesign.hunting.many.measure import parts_by_zeros
from yawdesign.hunting.many.worst_margin import under_conditions
from yawdesign.hunting.worst_condition import worst_conditions
from yawdesign.problem.condition import Condition
from yawdesign.problem.conditions import ConditionSet
from yawdesign.problem.running import HIGHEST_SEARCHED, LOWEST_SEARCHED

FEW_CORNERS = 32  # under which all critical speeds are computed
MOST_SEARCHES = 40
STABLE = 1e-6  # [1/s]: an instability slower than this is rounding
ASIDE = 1e-5  # of a speed: so far to both sides of it the verdicts must differ
AT_LEAST, MARGIN_OF_TESTS = 2.0, 1.1  # times what is required, what is run, the search goes


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which stability is gained or lost.

    Parameters
    ----------
    v : float
        Speed [m/s].
    omega : float
        Angular frequency of the pair of roots on the imaginary axis [rad/s].
    becomes : {"stable", "unstable", "neither"}
        What the vehicle is above it: with one condition more unstable roots may come, which is ``"neither"``.
    condition : mapping
        The condition under which this is so, without its speed: SI units, a load by its name.
    """

    v: float
    omega: float
    becomes: str
    condition: Mapping[str, Any]


@dataclass(frozen=True)
class StableSpeeds:
    """What was found of critical speeds.

    Parameters
    ----------
    critical : tuple of CriticalSpeed
        In rising order; see `yawdesign.CriticalSpeeds`.
    up_to : float or None
        Every speed from the lowest searched one up to this is stable [m/s]; 0 where that one is not; None beyond the
        searched range.
    worst : Condition
        Where stability ends; of all speeds the one of the least margin, if it does not.
    searched : tuple of float
        Between which speeds [m/s].
    checked : bool
        Whether eigenvalues, and Routh's array on both sides of `up_to`, agree.
    """

    critical: tuple[CriticalSpeed, ...]
    up_to: float | None
    worst: Condition
    searched: tuple[float, float]
    checked: bool


@dataclass(frozen=True)
class _Line:
    """A condition with its critical speeds, and the numbers of unstable roots between them."""

    condition: Condition
    v: tuple[float, ...]
    omega: tuple[float, ...]
    unstable: tuple[float, ...]
    verified: bool

    def first_unstable(self, low: float) -> float:
        """Return the lowest speed from which on it is unstable; infinite if there is none."""
        return next((v for v, count in zip((low, *self.v), self.unstable, strict=True) if count), np.inf)

    @property
    def changes(self) -> Iterator[CriticalSpeed]:
        """Its critical speeds."""
        for v, omega, before, above in zip(self.v, self.omega, self.unstable, self.unstable[1:], strict=False):
            becomes = "neither" if before and above else "unstable" if above else "stable"
            yield CriticalSpeed(v, omega, becomes, self.condition.described)


def searched_speeds(judged: Judged) -> tuple[float, float]:
    """Return between which speeds [m/s] critical ones are looked for: to 600 km/h, more where more is required."""
    problem = judged.problem
    required = [float(x.wanted) for x in problem.requirements if x.measure == "critical_speed"]
    highest = [AT_LEAST * max(required, default=0.0), MARGIN_OF_TESTS * float(max(problem.speeds))]
    return LOWEST_SEARCHED, max(HIGHEST_SEARCHED, *highest)


def stable_speeds(judged: Judged) -> StableSpeeds:
    """Return up to which speed a design is stable under all conditions.

    Parameters
    ----------
    judged : Judged
        The design, maybe with a fault; the speeds of its conditions are not looked at.
    """
    given, searched = judged.conditions.without({"v"}), searched_speeds(judged)
    corners = given.corners if len(given.corners) <= FEW_CORNERS else ()
    lines, lowest, agreed = _worst_added(judged, given, _lines(judged, corners, searched), searched)
    every = all(line.verified for line in lines)
    limit = _limit(lines, searched[0])
    if np.isinf(limit):
        good = judged.at(lowest)
        return StableSpeeds((), None, lowest, searched, agreed and every and good.stable and good.checked)
    first = min(lines, key=lambda line: line.first_unstable(searched[0]))
    worst = first.condition.with_values({"v": limit})
    if limit == searched[0]:
        passed, up_to = not judged.at(worst).stable, 0.0
    else:
        passed, up_to = _ends_at(judged, worst), limit
    critical = tuple(first.changes) if given.is_one else tuple(_ends(lines, searched))
    if given.ranges or not corners:  # only the lowest one was searched under all conditions, by another way too
        critical, every = tuple(x for x in critical if x.v == up_to), first.verified
    on_axis = all(_on_axis(judged, x, lines) for x in critical)
    return StableSpeeds(critical, up_to, worst, searched, agreed and every and passed and on_axis)


def _limit(lines: Sequence[_Line], low: float) -> float:
    return min((line.first_unstable(low) for line in lines), default=np.inf)


def _worst_added(
    judged: Judged, given: ConditionSet, lines: list[_Line], searched: tuple[float, float]
) -> tuple[list[_Line], Condition, bool]:
    """Return also the conditions that are unstable at a lower speed, the worst one below it, and whether all agree."""
    low, high = searched
    for _ in range(MOST_SEARCHES):
        limit = _limit(lines, low)
        at = given.with_speeds(low, min(limit, high))
        found = worst_conditions(judged.model, dict(judged.p), at, judged.every_mode)
        worse = dict.fromkeys(x.condition.without({"v"}) for x in found if x.margin < -STABLE)
        if limit == low or not worse:
            return lines, found[0].condition, True
        lines = lines + _lines(judged, tuple(worse), searched)
        if _limit(lines, low) >= limit:
            break
    return lines, found[0].condition, False


def _lines(judged: Judged, conditions: Sequence[Condition], searched: tuple[float, float]) -> list[_Line]:
    """Return the critical speeds under some conditions."""
    if not conditions:
        return []
    sets = under_conditions(judged.model, {**judged.p, "v": searched[0]}, [(condition, 1) for condition in conditions])
    if judged.case:
        sets = sets.with_fault(judged.case)
    lines: dict[int, _Line] = {}
    for places, part in parts_by_zeros(sets):
        field, (others, sure) = critical_speeds(part, searched), others_stable(part)
        for k, place in enumerate(places):
            count = field.count[k]
            unstable = field.unstable_roots[k, : count + 1] + (not others[k])
            verified = bool(sure[k] and not field.unverified[k])
            v, omega = (tuple(x[k, :count].tolist()) for x in (field.critical, field.omega))
            lines[int(place)] = _Line(conditions[place], v, omega, tuple(unstable.tolist()), verified)
    return [lines[k] for k in range(len(conditions))]


def _ends(lines: Sequence[_Line], searched: tuple[float, float]) -> Iterator[CriticalSpeed]:
    """Yield the ends of what is unstable under any condition, within the searched range."""
    low, high = searched
    until, last = low, None
    for start, stop, line in sorted(_unstable(lines, searched), key=lambda piece: piece[:2]):
        if start > until or last is None:
            if last is not None:
                yield next(x for x in last.changes if x.v == until)
            if start > low:
                yield replace(next(x for x in line.changes if x.v == start), becomes="unstable")
        if stop > until or last is None:
            until, last = stop, line
    if last is not None and until < high:
        yield next(x for x in last.changes if x.v == until)


def _unstable(lines: Sequence[_Line], searched: tuple[float, float]) -> Iterator[tuple[float, float, _Line]]:
    """Yield the intervals of speed in which each condition is unstable."""
    low, high = searched
    for line in lines:
        start = None
        for v, count in zip((low, *line.v), line.unstable, strict=True):
            if count and start is None:
                start = v
            elif not count and start is not None:
                yield start, v, line
                start = None
        if start is not None:
            yield start, high, line


def _on_axis(judged: Judged, found: CriticalSpeed, lines: Sequence[_Line]) -> bool:
    """Return whether an eigenvalue lies on the imaginary axis at a critical speed."""
    condition = next(line.condition for line in lines if line.condition.described == found.condition)
    s = np.array(judged.at(condition.with_values({"v": found.v})).eigenvalues)
    return bool(np.any(np.abs(s - 1j * found.omega) < ON_AXIS * max(1.0, found.omega)))


def _ends_at(judged: Judged, worst: Condition) -> bool:
    """Return whether stability ends at the speed of a condition, by the verdicts on both sides."""
    below, above = (judged.at(worst.with_values({"v": worst.speed * (1 + side * ASIDE)})) for side in (-1, 1))
    return below.stable and not above.stable and below.checked and above.checked

"""Where and how fast the bogie runs: its speeds and the tightest curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args

from .arguments import named
from .diagnostics import Mistakes, ProblemError
from .quantities import Written, exact
from .table import (
    Parameter,
    as_choice,
    as_count,
    as_several,
    check_ends,
    check_fields,
    documented,
    parameter,
    shown,
    table,
)

Load = Literal["axle", "wheel"]
LOADS: tuple[str, ...] = get_args(Load)
STEPS = (2, 1001)
MOST_ACCELERATION = 4.0  # [m/s^2], across the curve; tilting trains reach 3

SPEED = Parameter(
    key="speed",
    symbol="v",
    unit="km/h",
    meaning="running speed",
    hard=(0.01, 1000.0),
    usual=(20 / 3.6, 600 / 3.6),
    source="300",
)


@named
@documented
@dataclass(frozen=True, kw_only=True)
class Curve:
    """The tightest curve, which limits the damping from above.

    The rotational resistance T / (4 Q a) in the transition curve must not exceed `limit`.

    Parameters
    ----------
    limit : float
        Largest rotational resistance [-].
    load : {"axle", "wheel"}
        Meaning of Q: the axle load W, as in the paper, or the wheel load W/2, as in railway standards.
    """

    R: float = parameter("R", "m", "radius of the curve", hard=(1.0, 1e7), usual=(60, 20e3), source="300")
    L: float = parameter(
        "L", "m", "distance of the bogie centres of the car", hard=(0.1, 1e3), usual=(5, 30), source="19"
    )
    l: float = parameter("l", "m", "length of the transition curve", hard=(0.1, 1e5), usual=(5, 2e3), source="60")  # noqa: E741
    V_r: float = parameter(
        r"V_\mathrm{r}",
        "km/h",
        "largest speed in the curve",
        hard=(0.01, 1000.0),
        usual=(5 / 3.6, 400 / 3.6),
        source="90",
    )
    limit: float = parameter(
        r"X_\mathrm{max}",
        "-",
        "largest rotational resistance T/(4 Q a)",
        hard=(1e-6, 100.0),
        usual=(0.01, 0.5),
        source="0.08",
        default=0.08,
    )
    load: Load = "axle"

    def __post_init__(self) -> None:
        mistakes, given = Mistakes(), self.V_r
        with mistakes.under("curve"):
            check_fields(self)
            CURVE["V_r"].accept(given, doubtful=is_fast_for(self.V_r, self.R))
        with mistakes.under("curve.load"):
            as_choice(self.load, LOADS)
        mistakes.report()


CURVE = table(Curve)


def is_fast_for(V_r: object, R: object) -> bool:
    """Return whether a speed is too high for a curve, and may have been meant in another unit."""
    return bool(CURVE["V_r"].check(V_r) ** 2 / CURVE["R"].check(R) > MOST_ACCELERATION)


MOST_SPEEDS = 1000
LOWEST_SEARCHED, HIGHEST_SEARCHED = 10 / 3.6, 600 / 3.6  # [m/s], for critical speeds


def as_speeds(value: Any, check: Callable[[object], float] = SPEED.check) -> float | tuple[float, ...]:
    """Return a speed, or several in rising order [m/s]; a list of one is that one."""
    if isinstance(value, (str, Mapping)) or not hasattr(value, "__len__"):
        return check(value)
    entries = as_several(value)
    if not entries:
        raise ProblemError("is an empty list: give the speeds, or a range {min: ..., max: ...}")
    if len(entries) > MOST_SPEEDS:
        raise ProblemError(f"{len(entries)} speeds: give at most {MOST_SPEEDS}, or a range {{min: ..., max: ...}}")
    mistakes, found = Mistakes(), set[float]()
    for k, entry in enumerate(entries):
        with mistakes.under(f"{k}"):
            speed = check(entry)
            if speed in found:
                raise ProblemError(f"{shown(entry)} stands twice")
            found.add(speed)
    mistakes.report()
    return found.pop() if len(found) == 1 else tuple(sorted(found))


@named
@dataclass(frozen=True, kw_only=True)
class SpeedRange:
    """A range of running speeds, every one of which may come; at equally spaced ones it is looked at first.

    Parameters
    ----------
    min, max : float
        Least and largest speed [m/s].
    steps : int
        Number of speeds, both ends included.
    """

    min: float
    max: float
    steps: int = 11

    def __post_init__(self) -> None:
        mistakes, given = Mistakes(), (self.min, self.max)
        with mistakes.under("speed"):
            low, high = check_ends(self.min, self.max, SPEED)
            object.__setattr__(self, "min", low)
            object.__setattr__(self, "max", high)
        with mistakes.under("speed.steps"):
            object.__setattr__(self, "steps", as_count(self.steps, *STEPS))
        mistakes.report()
        for end in given:
            SPEED.accept(end)

    @property
    def values(self) -> tuple[float, ...]:
        """The speeds [m/s], each the nearest double of its exact value."""
        low, high = exact(self.min), exact(self.max)
        last = self.steps - 1
        return tuple(Written(low + (high - low) * step / last) for step in range(self.steps))

"""Which followed modes are drawn, how each looks and is called, and where the vehicle becomes stable or unstable."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.pictures import quantity
from yawdesign.output.style import line_of
from yawdesign.problem import format_quantity, to_unit
from yawdesign.problem.table import Parameter
from yawdesign.response.modes.followed_modes import FollowedModes
from yawdesign.study.axes import ROWS
from yawdesign.vehicle.motions import BOGIES

MOST = 10  # modes of a vehicle in one picture
ALIKE = 0.012  # of the size of a picture: curves that are nearer lie on each other


@dataclass(frozen=True)
class Paths:
    """Followed modes as they are drawn.

    Parameters
    ----------
    result : FollowedModes
        All of them.
    shown : tuple of int
        Which modes are drawn; each has its own look in every picture of the result.
    """

    result: FollowedModes
    shown: tuple[int, ...]

    @classmethod
    def of(cls, result: FollowedModes, widest: float) -> "Paths":
        """Choose: of those that two bogies have alike the less damped ones, and not too many."""
        slow = [k for k in range(len(result.names)) if np.nanmax(result.eigenvalues[:, k].real) > -widest]
        least = {k: float(np.nanmin(result.damping_ratio[:, k])) for k in slow}
        first: dict[str, int] = {}
        for k in sorted(slow, key=least.__getitem__):
            first.setdefault(_without_bogies(result.names[k]), k)
        chosen = slow if len(first) == len(slow) else sorted([*first.values()][:MOST])
        return cls(result, tuple(chosen))

    @property
    def row(self) -> Parameter:
        """What is known of the parameter."""
        return ROWS[self.result.axis]

    def in_unit(self, value: float) -> float:
        """Return a value of the parameter in the unit in which people see it."""
        return to_unit(float(value), self.row.unit)

    @property
    def values(self) -> Float:
        """The parameter in that unit."""
        return np.asarray(self.result.values * self.in_unit(1.0))

    @property
    def label(self) -> str:
        """Of an axis of the parameter."""
        unit = f" [{self.row.unit}]" if self.row.unit.strip("-") else ""
        return f"{self.row.meaning} ${self.row.symbol}${unit}"

    @property
    def geometric(self) -> bool:
        """Whether the values have equal ratios, over a wide range."""
        if not np.all(self.values > 0):
            return False
        ratio = self.values[1:] / self.values[:-1]
        return bool(np.allclose(ratio, ratio[0], rtol=1e-6) and abs(np.log(ratio.prod())) > 2)

    @property
    def held(self) -> str:
        """What does not vary, for a title."""
        parts = [] if self.result.C_s is None else [quantity("C_s", self.result.C_s)]
        parts += [] if self.result.speed is None else [format_quantity(self.result.speed, "km/h", 4)]
        return "".join(f", {part}" for part in parts)

    def look(self, k: int) -> dict[str, Any]:
        """Return colour and dashes of a mode."""
        return line_of(self.shown.index(k))

    def name(self, k: int) -> str:
        """Return the name of a mode without what it says of the bogies."""
        return _without_bogies(self.result.names[k])

    @property
    def critical(self) -> Iterator[tuple[float, str]]:
        """Where the first mode becomes unstable or the last one stable, on straight lines between the points, in SI."""
        order = np.argsort(self.result.values)
        values, abscissa = self.result.values[order], np.nanmax(self.result.eigenvalues.real, axis=1)[order]
        for (x, s), (y, t) in pairwise(zip(values, abscissa, strict=True)):
            if s * t < 0:
                yield float(x - s * (y - x) / (t - s)), "unstable" if t > 0 else "stable"

    def alike(self, modes: Sequence[int], places: Float) -> list[list[int]]:
        """Return modes whose curves lie on each other as one group.

        Parameters
        ----------
        modes : sequence of int
            Among them.
        places : ndarray, shape (points, modes)
            Of all modes, relative to the size of the picture.
        """
        groups: list[list[int]] = []
        for k in modes:
            near = (g for g in groups if _apart(places[:, g[0]], places[:, k]) < ALIKE)
            if (group := next(near, None)) is None:
                groups.append([k])
            else:
                group.append(k)
        return groups


def _apart(one: Any, other: Any) -> float:
    difference = np.abs(one - other)
    alone = np.isfinite(one) != np.isfinite(other)
    return float(np.inf if alone.any() or not np.isfinite(difference).any() else np.nanmax(difference))


def _without_bogies(name: str) -> str:
    return next((name.removesuffix(f", {words}") for words in BOGIES.values() if name.endswith(f", {words}")), name)

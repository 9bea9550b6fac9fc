"""A block of points: parameters, some of which have one value for each point."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Block:
    """Points that are looked at together.

    Parameters
    ----------
    values : mapping
        Symbols of Table I in SI units, maybe ``v`` and ``C_s``: floats, or arrays of length `size`.
    size : int
        How many points.
    """

    values: Mapping[str, Any]
    size: int

    @classmethod
    def split(cls, p: Mapping[str, Any], length: int) -> Iterator["Block"]:
        """Yield blocks of at most so many points."""
        arrays = {name: np.asarray(x, dtype=float).reshape(-1) for name, x in p.items()}
        n = max(x.size for x in arrays.values())
        for first in range(0, n, length):
            part = {name: _simple(x if x.size == 1 else x[first : first + length]) for name, x in arrays.items()}
            yield cls(part, min(length, n - first))

    @property
    def zeros(self) -> frozenset[str]:
        """Parameters that are zero at all points: they lower the degree of the polynomials."""
        return frozenset(name for name, x in self.values.items() if np.ndim(x) == 0 and x == 0)

    def with_values(self, **changes: Any) -> "Block":
        """Return the same points with other values."""
        return Block({**self.values, **changes}, self.size)

    def cases(self, speeds: Sequence[float]) -> list["Block"]:
        """Return one block for each speed, or this one if it has speeds of its own."""
        return [self] if "v" in self.values else [self.with_values(v=v) for v in speeds]

    def whole(self, name: str) -> Any:
        """Return the values of a parameter at all points."""
        return np.broadcast_to(self.values[name], self.size)

    def point(self, k: Any) -> dict[str, float]:
        """Return the values at one point."""
        return {name: float(x[k] if np.ndim(x) else x) for name, x in self.values.items()}

    def part(self, chosen: Any) -> "Block":
        """Return some of the points."""
        values = {name: x[chosen] if np.ndim(x) else x for name, x in self.values.items()}
        return Block(values, len(np.arange(self.size)[chosen]))


def _simple(x: Any) -> Any:
    """Return a number where all points have the same."""
    return float(x[0]) if x[0] == x[-1] and (x == x[0]).all() else np.ascontiguousarray(x)

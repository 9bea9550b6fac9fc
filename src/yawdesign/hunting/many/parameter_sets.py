"""Many vehicles of one model: parameters, some of which have one value for each vehicle."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from yawdesign.problem.cases import Case
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.vehicle import Model, Vehicle


@dataclass(frozen=True, eq=False)
class ParameterSets:
    """Sets of parameters that are looked at together.

    Parameters
    ----------
    model : Model
        Which equations.
    values : mapping
        Symbols of Table I in SI units, maybe ``v`` [m/s] and ``C_s`` [N s/m]: floats, or arrays of length `size`.
    size : int
        How many sets.
    """

    model: Model
    values: Mapping[str, Any]
    size: int

    @classmethod
    def split(cls, model: Model, p: Mapping[str, Any], length: int) -> Iterator[Self]:
        """Yield parts of at most so many sets."""
        arrays = {name: np.asarray(x, dtype=float).reshape(-1) for name, x in p.items()}
        n = max(x.size for x in arrays.values())
        for first in range(0, n, length):
            part = {name: _simple(x if x.size == 1 else x[first : first + length]) for name, x in arrays.items()}
            yield cls(model, part, min(length, n - first))

    @cached_property
    def vehicle(self) -> Vehicle:
        """All of them at once: a vehicle whose numbers are arrays."""
        return self.model.at(self.values)

    @property
    def zeros(self) -> frozenset[str]:
        """Parameters that are zero in all sets: they lower the degree of the polynomials."""
        return frozenset(name for name, x in self.values.items() if np.ndim(x) == 0 and x == 0)

    def replace(self, **changes: Any) -> "ParameterSets":
        """Return the same sets with other values."""
        return ParameterSets(self.model, {**self.values, **changes}, self.size)

    def under(self, condition: Condition) -> "ParameterSets":
        """Return the same sets under a condition."""
        return ParameterSets(self.model, condition.applied(self.values), self.size)

    def with_fault(self, case: Case) -> "ParameterSets":
        """Return the same sets with a fault."""
        return ParameterSets(self.model.with_fault(case), case.applied(self.values), self.size)

    def whole(self, name: str) -> Any:
        """Return the values of a parameter in all sets."""
        return np.broadcast_to(self.values[name], self.size)

    def vehicle_at(self, k: Any) -> Vehicle:
        """Return the vehicle of one set, whose numbers are floats."""
        return self.model.at({name: float(x[k] if np.ndim(x) else x) for name, x in self.values.items()})

    def part(self, chosen: Any) -> "ParameterSets":
        """Return some of the sets."""
        values = {name: x[chosen] if np.ndim(x) else x for name, x in self.values.items()}
        return ParameterSets(self.model, values, len(np.arange(self.size)[chosen]))


def _simple(x: Any) -> Any:
    """Return a number where all sets have the same."""
    return float(x[0]) if x[0] == x[-1] and (x == x[0]).all() else np.ascontiguousarray(x)

"""The conditions under which everything must hold: plain data, changes to the parameters, the speed among them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from .problem import Problem

CREEP = ("f_11", "f_22")  # what `creep_factor` multiplies


@dataclass(frozen=True)
class Condition:
    """One running condition.

    Parameters
    ----------
    changes : tuple of (name, value)
        In SI units: a running speed ``v``, a parameter that is replaced, or ``creep_factor``, which multiplies both
        creep coefficients.
    """

    changes: tuple[tuple[str, float], ...]

    @property
    def speed(self) -> float:
        """Running speed [m/s]."""
        return dict(self.changes)["v"]

    @property
    def described(self) -> dict[str, float]:
        """Its values by the names that a problem file uses: ``speed`` [m/s], and SI values of others."""
        return {"speed" if name == "v" else name: float(value) for name, value in self.changes}

    def applied(self, p: Mapping[str, Any]) -> dict[str, Any]:
        """Return parameters with this condition in them."""
        return applied(p, self.changes)

    def without(self, names: Collection[str]) -> Condition:
        """Return what remains of it where other values of some names are given: those of an axis of a sweep."""
        return Condition(tuple(change for change in self.changes if change[0] not in names))


def applied(p: Mapping[str, Any], changes: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return parameters with changes in them, in their order; numbers of any type."""
    out = dict(p)
    for name, value in changes:
        if name == "creep_factor":
            out |= {key: out[key] * value for key in CREEP}
        else:
            out[name] = value
    return out


def conditions(problem: Problem) -> tuple[Condition, ...]:
    """Return the conditions of a problem: its speed, or the speeds of its range."""
    return tuple(Condition((("v", v),)) for v in problem.speeds)


def distinct(conditions: Iterable[Condition], given: Collection[str]) -> tuple[Condition, ...]:
    """Return what remains of conditions where some names are given, each once."""
    return tuple(dict.fromkeys(condition.without(given) for condition in conditions))

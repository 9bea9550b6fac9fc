"""A condition under which everything must hold, and all of a problem as they were written: plain data."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from math import prod
from typing import Any

from .quantities import decimal_text
from .table import Parameter

CREEP = ("f_11", "f_22")  # what `creep_factor` multiplies
CREEP_FACTOR = Parameter(
    key="creep_factor",
    symbol=r"k_\mathrm{creep}",
    unit="-",
    meaning="factor of both creep coefficients",
    hard=(1e-6, 1e6),
    usual=(0.3, 1.0),
    source="1",
)
TOLERANCE = "tolerance."  # before the name of a parameter that deviates from its value by a share
MOST_LISTED = 10_000  # combinations of what is listed, with the ends of ranges and the speeds of the first look


@dataclass(frozen=True)
class Load:
    """A named set of values of bogie and car body.

    Parameters
    ----------
    name : str
        What it is called.
    changes : tuple of (name, value)
        Parameters and their values in SI units [SI].
    """

    name: str
    changes: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Condition:
    """One running condition.

    Parameters
    ----------
    changes : tuple of (name, value)
        In SI units [SI]: a running speed ``v``, a parameter that is replaced, ``creep_factor``, which multiplies both
        creep coefficients, or ``tolerance.K_m``, the share by which a parameter deviates from its value [-].
    load : Load, optional
        Values that are replaced together.
    """

    changes: tuple[tuple[str, Any], ...]
    load: Load | None = None

    @property
    def speed(self) -> float:
        """Running speed [m/s]."""
        return float(dict(self.changes)["v"])

    @property
    def damping_factor(self) -> float:
        """What C_s is multiplied by: 1 without a tolerance of it [-]."""
        return 1 + float(dict(self.changes).get(f"{TOLERANCE}C_s", 0.0))

    @property
    def described(self) -> dict[str, Any]:
        """Its values by the names that a problem file uses: ``speed`` [m/s], SI values of others, a load by its name.

        A tolerance is told by the share by which its parameter deviates [-].
        """
        found: dict[str, Any] = {"speed" if name == "v" else name: float(value) for name, value in self.changes}
        return found | ({"load": self.load.name} if self.load else {})

    def applied(self, p: Mapping[str, Any]) -> dict[str, Any]:
        """Return parameters with this condition in them."""
        return applied(p, (*(self.load.changes if self.load else ()), *self.changes))

    def with_values(self, values: Mapping[str, Any]) -> Condition:
        """Return the condition with other values of some names, numbers or arrays."""
        kept = tuple((name, values.get(name, value)) for name, value in self.changes)
        known = {name for name, _ in self.changes}
        return Condition((*kept, *((name, value) for name, value in values.items() if name not in known)), self.load)

    def without(self, names: Collection[str]) -> Condition:
        """Return what remains of it where other values of some names are given: those of an axis of a sweep."""
        load = self.load and Load(self.load.name, tuple(x for x in self.load.changes if x[0] not in names))
        gone = {*names, *(CREEP_FACTOR.key for key in CREEP if key in names)}
        return Condition(tuple(change for change in self.changes if change[0] not in gone), load)


def applied(p: Mapping[str, Any], changes: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return parameters with changes in them; numbers of any type. What multiplies a value comes after all values."""
    out, factors = dict(p), []
    for name, value in changes:
        if name == CREEP_FACTOR.key:
            factors += [(key, value) for key in CREEP]
        elif name.startswith(TOLERANCE):
            factors.append((name.removeprefix(TOLERANCE), 1 + value))
        else:
            out[name] = value
    for name, factor in factors:
        if name in out:  # C_s may be what is looked for
            out[name] = out[name] * factor
    return out


@dataclass(frozen=True)
class Conditions:
    """What a problem must hold under, beside its speeds, as it was written.

    Parameters
    ----------
    values : tuple of (name, tuple of float)
        Values of parameters and of ``creep_factor`` in SI units, every one of which may come [SI].
    ranges : tuple of (name, (low, high))
        Ranges of them, every value in which may come [SI].
    tolerance : tuple of (name, share)
        By which share of its value a parameter may deviate to either side [-].
    loads : tuple of Load
        Named sets of values of which one at a time comes.
    """

    values: tuple[tuple[str, tuple[float, ...]], ...] = ()
    ranges: tuple[tuple[str, tuple[float, float]], ...] = ()
    tolerance: tuple[tuple[str, float], ...] = ()
    loads: tuple[Load, ...] = ()

    def __bool__(self) -> bool:
        return any((self.values, self.ranges, self.tolerance, self.loads))

    @property
    def keys(self) -> tuple[str, ...]:
        """The parameters that it replaces, ``creep_factor`` among them."""
        return tuple(dict.fromkeys(name for name, _ in (*self.values, *self.ranges)))

    @property
    def every_key(self) -> frozenset[str]:
        """The parameters that it changes in any way, by loads and tolerances too."""
        creep = CREEP if CREEP_FACTOR.key in self.keys else ()
        loaded = (name for load in self.loads for name, _ in load.changes)
        return frozenset((*self.keys, *creep, *loaded, *dict(self.tolerance)))

    @property
    def combinations(self) -> int:
        """The number of combinations of what is listed and of the ends of ranges."""
        listed = prod(len(values) for _, values in self.values) * max(1, len(self.loads))
        ends: int = 2 ** (len(self.ranges) + len(self.tolerance))
        return listed * ends

    def taken(self, name: str, designed: float | None) -> tuple[float, ...]:
        """Return the values that are given of a parameter, the ends of its range among them [SI].

        Where it may keep its value, that as designed is one of them, if it is known.
        """
        loaded = [dict(load.changes).get(name) for load in self.loads]
        found = (*dict(self.values).get(name, ()), *dict(self.ranges).get(name, ()))
        found += tuple(value for value in loaded if value is not None)
        kept = name not in self.keys and (not loaded or None in loaded)
        return (*found, designed) if kept and designed is not None else found

    def of(self, keys: Collection[str]) -> Conditions:
        """Return what is said of some parameters: those of a bogie."""
        known = {*keys, CREEP_FACTOR.key}
        loads = {tuple(change for change in x.changes if change[0] in known): x.name for x in reversed(self.loads)}
        return Conditions(
            values=tuple(x for x in self.values if x[0] in known),
            ranges=tuple(x for x in self.ranges if x[0] in known),
            tolerance=tuple(x for x in self.tolerance if x[0] in known),
            loads=tuple(Load(loads[changes], changes) for changes in reversed(loads)) if any(loads) else (),
        )

    @property
    def written(self) -> dict[str, Any]:
        """The same with the keys of a problem file, in SI units; shares are percentages."""
        found: dict[str, Any] = {name: list(values) for name, values in self.values}
        found |= {name: {"min": low, "max": high} for name, (low, high) in self.ranges}
        if self.tolerance:
            found["tolerance"] = {name: f"{decimal_text(share, '%')} %" for name, share in self.tolerance}
        if self.loads:
            found["load"] = {load.name: dict(load.changes) for load in self.loads}
        return found

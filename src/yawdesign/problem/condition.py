"""A condition under which everything must hold, and what a problem file says of them: plain data."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion
from .parameters import PARAMETERS
from .quantities import format_quantity
from .table import Parameter, as_quantity, as_several, as_text, check_ends, key_of, shown

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
OWN_KEYS = ("creep_factor", "tolerance", "load")  # of `conditions`, beside parameters
MOST_TOLERANCE = 1.0  # a deviation by the whole value, at which a stiffness or a damping would vanish
_EXAMPLE = "lambda: [0.05, 0.10, 0.40] or creep_factor: {min: 0.5, max: 1}"


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

    def of(self, keys: Collection[str]) -> Conditions:
        """Return what is said of some parameters: those of a bogie."""
        known = {*keys, CREEP_FACTOR.key}
        loads = [Load(x.name, tuple(change for change in x.changes if change[0] in known)) for x in self.loads]
        return Conditions(
            values=tuple(x for x in self.values if x[0] in known),
            ranges=tuple(x for x in self.ranges if x[0] in known),
            tolerance=tuple(x for x in self.tolerance if x[0] in known),
            loads=tuple(load for load in loads if load.changes),
        )

    @property
    def written(self) -> dict[str, Any]:
        """The same with the keys of a problem file, in SI units; shares are percentages."""
        found: dict[str, Any] = {name: [float(x) for x in values] for name, values in self.values}
        found |= {name: {"min": float(low), "max": float(high)} for name, (low, high) in self.ranges}
        if self.tolerance:
            found["tolerance"] = {name: f"{100 * float(share):.15g} %" for name, share in self.tolerance}
        if self.loads:
            found["load"] = {load.name: {key: float(x) for key, x in load.changes} for load in self.loads}
        return found


def as_conditions(value: object) -> Conditions:
    """Return conditions, given as such or as a problem file has them.

    Examples
    --------
    >>> as_conditions({"lambda": [0.05, 0.4], "tolerance": {"K_m": "10 %"}}).tolerance
    (('K_m', 0.1),)
    """
    found, mistakes = read_conditions(value)
    if mistakes:
        raise ProblemError(mistakes)
    return found


def read_conditions(value: object) -> tuple[Conditions, list[Diagnostic]]:
    """Return the conditions that are right, and the mistakes in the others."""
    if isinstance(value, Conditions):
        return value, []
    mistakes = Mistakes()
    values: dict[str, tuple[float, ...]] = {}
    ranges: dict[str, tuple[float, float]] = {}
    tolerance: dict[str, float] = {}
    loads: list[Load] = []
    with mistakes.under(""):
        for name, written in _items(value, _EXAMPLE):
            with mistakes.under(name):
                if name == "tolerance":
                    tolerance = _tolerance(written)
                elif name == "load":
                    loads = _loads(written)
                elif isinstance(written, Mapping):
                    ranges[_row(name).key] = _range(written, _row(name))
                else:
                    values[_row(name).key] = _values(written, _row(name))
    return Conditions(tuple(values.items()), tuple(ranges.items()), tuple(tolerance.items()), tuple(loads)), (
        mistakes.found
    )


def _items(value: object, example: str) -> Iterator[tuple[str, object]]:
    if not isinstance(value, Mapping) or not value:
        what = "has no value" if value is None else f"{shown(value)} is not what stands here"
        raise ProblemError(f"{what}, expected keys and values, such as {example}")
    yield from ((key_of(str(name)), each) for name, each in value.items())


def _row(name: str) -> Parameter:
    if name == CREEP_FACTOR.key:
        return CREEP_FACTOR
    if name in ("speed", "v"):
        raise ProblemError("stands beside conditions, not in it: speed may be a list or a range")
    if name == "C_s":
        raise ProblemError("is what is designed: a deviation of it is a tolerance, such as tolerance: {C_s: 15 %}")
    if name not in PARAMETERS:
        raise ProblemError(f"is not a parameter{suggestion(name, (*PARAMETERS, *OWN_KEYS))}")
    return PARAMETERS[name].finite


def _values(written: object, row: Parameter) -> tuple[float, ...]:
    mistakes, found = Mistakes(), []
    entries = as_several(written)
    if not entries:
        raise ProblemError("is an empty list: give the values that may come, or remove the key")
    for k, entry in enumerate(entries):
        with mistakes.under(f"{k}" if isinstance(written, (list, tuple)) else ""):
            number = row.check(entry)
            if number in found:
                raise ProblemError(f"{shown(entry)} stands twice")
            found.append(number)
    mistakes.report()
    return tuple(found)


def _range(written: Mapping[Any, object], row: Parameter) -> tuple[float, float]:
    mistakes = Mistakes()
    for key in written:
        with mistakes.under(str(key)):
            if key not in ("min", "max"):
                raise ProblemError(f"is not known here{suggestion(str(key), ('min', 'max'))}; a range has min and max")
    for key in ("min", "max"):
        with mistakes.under(""):
            if key not in written:
                raise ProblemError(f"{key} is missing: a range is {{min: ..., max: ...}}")
    mistakes.report()
    return check_ends(written["min"], written["max"], row)


def _tolerance(written: object) -> dict[str, float]:
    mistakes, found = Mistakes(), dict[str, float]()
    with mistakes.under(""):
        for name, share in _items(written, "K_m: 10 %"):
            with mistakes.under(name):
                if name not in PARAMETERS:
                    raise ProblemError(f"is not a parameter{suggestion(name, PARAMETERS)}")
                number = as_quantity(share, "-")
                if not 0 < number < MOST_TOLERANCE:
                    raise ProblemError(
                        f"{shown(share)} is no tolerance: more than 0 % and less than 100 % of the value"
                    )
                found[name] = number
    mistakes.report()
    return found


def _loads(written: object) -> list[Load]:
    mistakes, found = Mistakes(), []
    with mistakes.under(""):
        for name, changes in _items(written, "laden: {W: 200 kN}"):
            with mistakes.under(name):
                found.append(Load(as_text(name).strip(), _changes(changes)))
    mistakes.report()
    return found


def _changes(written: object) -> tuple[tuple[str, float], ...]:
    mistakes, found = Mistakes(), []
    with mistakes.under(""):
        for key, value in _items(written, "W: 200 kN"):
            with mistakes.under(key):
                if key == CREEP_FACTOR.key:
                    raise ProblemError("is no part of a load: it stands beside load")
                found.append((key, _row(key).check(value)))
    mistakes.report()
    return tuple(found)


def tolerated(share: float, value: float, row: Parameter) -> str:
    """Return in words which values a tolerance means."""
    low, high = (format_quantity(value * (1 + sign * share), row.unit) for sign in (-1, 1))
    return f"{low} ... {high}"

"""The cases: faults that must be survived, as changes to the values as designed, of both bogies or of one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion, wrong_key
from .outside_the_model import why_unknown
from .parameters import BOGIE, CAR_BODY, PARAMETERS
from .quantities import decimal_text, format_quantity, split_quantity
from .table import Parameter, as_quantity, as_text, key_of, shown

BOGIES = ("leading", "trailing")
SHARE = "C_s share"  # of a bogie's own yaw dampers, what C_s is multiplied by
ONE_BOGIE = tuple(f"{bogie}.{key}" for bogie in BOGIES for key in BOGIE)
_EXAMPLE = "one yaw damper lost: {C_s: 50 %, K_ds: 50 %}"


@dataclass(frozen=True)
class Change:
    """One value in a fault.

    Parameters
    ----------
    key : str
        A parameter, ``leading.`` or ``trailing.`` before it if it is that of one bogie.
    value : float
        In SI units; or, if it is a `share`, of the value as designed [-].
    share : bool
        Whether the value is a share.
    """

    key: str
    value: float
    share: bool = False

    @property
    def parameter(self) -> str:
        """The parameter, of whichever bogie."""
        return self.key.rpartition(".")[2]

    @property
    def written(self) -> float | str:
        """The value as a problem file has it: a share is a percentage [%], any other in SI units [SI]."""
        return f"{decimal_text(self.value, '%')} %" if self.share else self.value

    def is_none(self, designed: float | None) -> bool:
        """Return whether it leaves a value as designed as it is; None where that is not known, or may be changed."""
        return (self.share and self.value == 1) or (designed is not None and self.result(designed) == designed)

    def result(self, designed: float) -> float:
        """Return the value with the fault, from that as designed."""
        return designed * self.value if self.share else self.value


@dataclass(frozen=True)
class Case:
    """A fault.

    Parameters
    ----------
    name : str
        What it is called.
    changes : tuple of Change
        What differs from the design.
    """

    name: str
    changes: tuple[Change, ...]

    @property
    def of_one_bogie(self) -> bool:
        """Whether it makes the bogies of a vehicle differ."""
        return any(change.key != change.parameter for change in self.changes)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the numbers that it changes; of one bogie's yaw dampers the share of C_s."""
        pairs = [change.key.rpartition(".") for change in self.changes]
        return tuple(f"{bogie}.{SHARE if key == 'C_s' else key}" if bogie else key for bogie, _, key in pairs)

    def applied(self, p: Mapping[str, Any]) -> dict[str, Any]:
        """Return parameters with this fault in them; numbers of any type.

        The yaw dampers of one bogie become a share of C_s, in whose powers the motions are written.
        """
        out = dict(p)
        for change, name in zip(self.changes, self.names, strict=True):
            bogie, _, key = change.key.rpartition(".")
            if bogie and key == "C_s":
                out[name] = change.value if change.share else change.value / p[key]
            else:
                out[name] = p[key] * change.value if change.share else change.value
        return out


def as_cases(value: object) -> tuple[Case, ...]:
    """Return faults, given as such or as a problem file has them: changes by the name of each.

    Examples
    --------
    >>> as_cases({"one yaw damper lost": {"C_s": "50 %"}})[0].changes
    (Change(key='C_s', value=0.5, share=True),)
    """
    cases, mistakes = read_cases(value)
    if mistakes:
        raise ProblemError(mistakes)
    return cases


def read_cases(value: object) -> tuple[tuple[Case, ...], list[Diagnostic]]:
    """Return the faults that are right, and the mistakes in the others."""
    mistakes, found = Mistakes(), []
    with mistakes.under(""):
        for name, changes in _items(value):
            with mistakes.under(str(name)):
                found.append(Case(_name(name), _changes(changes)))
    return tuple(found), mistakes.found


def _items(value: object) -> list[tuple[object, object]]:
    if isinstance(value, Mapping):
        return list(value.items())
    if isinstance(value, (tuple, list)) and all(isinstance(case, Case) for case in value):
        names = [case.name for case in value]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise ProblemError(f"{shown(twice)} stands twice")
        return [(case.name, {change.key: change for change in case.changes}) for case in value]
    what = "has no value" if value is None else f"{shown(value)} is not what stands here"
    raise ProblemError(f"{what}, expected faults by name, such as {_EXAMPLE}")


def _name(name: object) -> str:
    text = as_text(name).strip()
    if not text:
        raise wrong_key("a fault needs a name")
    return text


def _changes(given: object) -> tuple[Change, ...]:
    if not isinstance(given, Mapping) or not given:
        raise ProblemError(f"names no change, expected keys and values, such as {_EXAMPLE}")
    mistakes, found = Mistakes(), []
    for key, value in given.items():
        with mistakes.under(str(key)):
            found.append(_change(*_key(str(key), given), value))
    mistakes.report()
    return tuple(found)


def _key(written: str, others: Mapping[str, object]) -> tuple[str, Parameter]:
    """Return a key as results have it, and its row of the table."""
    bogie, point, name = written.rpartition(".")
    name = key_of(name)
    key = f"{bogie}{point}{name}"
    if bogie in BOGIES and name in CAR_BODY and name not in BOGIE:
        raise wrong_key(f"belongs to the car body, of which there is one: write {name}")
    if key not in PARAMETERS and key not in ONE_BOGIE:
        known = (*PARAMETERS, *ONE_BOGIE)
        near = f"is not a parameter{suggestion(key, known)}"
        raise wrong_key(near if bogie in BOGIES else why_unknown(key, known, "is not a parameter"))
    if bogie and name in others:
        raise wrong_key(f"stands beside {name}, which means both bogies: give each bogie its own, or both the same")
    return key, PARAMETERS[name].finite


def _change(key: str, row: Parameter, value: object) -> Change:
    """Return one change, its value checked as far as that is possible without the value as designed."""
    share = value.share if isinstance(value, Change) else is_percentage(value)
    given = value.value if isinstance(value, Change) else value
    if not share:
        return Change(key, row.check(given))
    number = as_quantity(given, "-")
    if number < 0:
        raise ProblemError(f"{shown(given)} is no share of the value as designed: it is less than nothing")
    return Change(key, number, share=True)


def is_percentage(value: object) -> bool:
    """Return whether a value is written as a percentage."""
    try:
        return isinstance(value, str) and split_quantity(value)[1] == "%"
    except ProblemError:
        return False  # no quantity at all: the row of the table says so


def outside(case: Case, designed: Mapping[str, Collection[float]]) -> Iterator[Diagnostic]:
    """Yield the shares in a fault that lead out of the range of a parameter; the values that it has by key."""
    for change in case.changes:
        row = PARAMETERS[change.parameter].finite
        for value in designed.get(change.parameter, ()) if change.share else ():
            try:
                row.check(change.result(value))
            except ProblemError:
                reached = format_quantity(change.result(value), row.unit)
                text = f"{change.written} of the value as designed is {reached}"
                hint = "; a damper is removed by 0 % of its damping" if PARAMETERS[change.parameter].rigid else ""
                yield Diagnostic(
                    key=f"{case.name}.{change.key}",
                    message=f"{text}, outside {row.range_text(row.hard, row.unit)}{hint}",
                )
                break

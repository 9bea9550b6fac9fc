"""What a problem file says of conditions, read and checked: lists, ranges, tolerances and loads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeVar

from .condition import CREEP_FACTOR, MOST_LISTED, Conditions, Load
from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion, wrong_key
from .outside_the_model import why_unknown
from .parameters import PARAMETERS
from .table import Parameter, as_quantity, as_several, as_text, check_ends, key_of, shown

T = TypeVar("T")
OWN_KEYS = (CREEP_FACTOR.key, "tolerance", "load")  # of `conditions`, beside parameters
MOST_TOLERANCE = 1.0  # a deviation by the whole value, at which a stiffness or a damping would vanish
_EXAMPLE = "lambda: [0.05, 0.10, 0.40] or creep_factor: {min: 0.5, max: 1}"
_ENDS = ("min", "max")


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
    if isinstance(value, Conditions) or (isinstance(value, Mapping) and not value):
        return value or Conditions(), []
    mistakes = Mistakes()
    values: dict[str, tuple[float, ...]] = {}
    ranges: dict[str, tuple[float, float]] = {}
    tolerance: dict[str, float] = {}
    loads: list[Load] = []
    with mistakes.under(""):
        for name, written in _items(value, _EXAMPLE):
            with mistakes.under(name):
                if name == "tolerance":
                    _add_tolerances(tolerance, written)
                elif name == "load":
                    _add_loads(loads, written)
                elif isinstance(written, Mapping):
                    _put(ranges, row := _row(name), _range(written, row))
                else:
                    _put(values, row := _row(name), _values(written, row))
    found = Conditions(tuple(values.items()), tuple(ranges.items()), tuple(tolerance.items()), tuple(loads))
    return found, mistakes.found


def _items(value: object, example: str) -> Iterator[tuple[str, object]]:
    if not isinstance(value, Mapping) or not value:
        what = "has no value" if value is None else f"{shown(value)} is not what stands here"
        raise ProblemError(f"{what}, expected keys and values, such as {example}")
    yield from ((str(name), each) for name, each in value.items())


def _row(name: str) -> Parameter:
    key = key_of(name)
    if key in ("speed", "v"):
        raise wrong_key("stands beside conditions, not in it: speed may be a list or a range")
    if key == "C_s":
        raise wrong_key("is what is designed: a deviation of it is a tolerance, such as tolerance: {C_s: 15 %}")
    if key != CREEP_FACTOR.key and key not in PARAMETERS:
        raise wrong_key(why_unknown(name, (*PARAMETERS, *OWN_KEYS), "is not a parameter"))
    return CREEP_FACTOR if key == CREEP_FACTOR.key else PARAMETERS[key].finite


def _put(found: dict[str, T], row: Parameter, value: T) -> None:
    """Add what was read of a parameter, of which a Python name is another name."""
    if row.key in found:
        raise wrong_key(f"stands twice: {row.key} is the same")
    found[row.key] = value


def _values(written: object, row: Parameter) -> tuple[float, ...]:
    mistakes, found = Mistakes(), dict[float, None]()
    entries = as_several(written)
    if not entries:
        raise ProblemError("is an empty list: give the values that may come, or remove the key")
    if len(entries) > MOST_LISTED:
        raise ProblemError(f"lists {len(entries)} values: at most {MOST_LISTED}")
    for k, entry in enumerate(entries):
        with mistakes.under("" if entries == [written] else f"{k}"):
            number = row.check(entry)
            if number in found:
                raise ProblemError(f"{shown(entry)} stands twice")
            found[number] = None
    mistakes.report()
    return tuple(found)


def _range(written: Mapping[object, object], row: Parameter) -> tuple[float, float]:
    mistakes = Mistakes()
    for key in map(str, written):
        with mistakes.under(key):
            if key not in _ENDS:
                raise wrong_key(f"is not known here{suggestion(key, _ENDS)}; a range has min and max")
    for key in _ENDS if not mistakes.found else ():
        with mistakes.under(key):
            if key not in written:
                raise wrong_key("is missing: a range is {min: ..., max: ...}")
    mistakes.report()
    return check_ends(written["min"], written["max"], row)


def _add_tolerances(found: dict[str, float], written: object) -> None:
    """Add the tolerances that are right, and report the mistakes in the others."""
    mistakes = Mistakes()
    with mistakes.under(""):
        for name, share in _items(written, "K_m: 10 %"):
            with mistakes.under(name):
                if key_of(name) not in PARAMETERS:
                    raise wrong_key(why_unknown(name, tuple(PARAMETERS), "is not a parameter"))
                _put(found, PARAMETERS[key_of(name)], _share(share))
    mistakes.report()


def _share(written: object) -> float:
    share = as_quantity(written, "%")
    if not 0 < share < MOST_TOLERANCE:
        raise ProblemError(f"{shown(written)} is no tolerance: more than 0 % and less than 100 % of the value")
    return share


def _add_loads(found: list[Load], written: object) -> None:
    """Add the loads that are right, and report the mistakes in the others."""
    mistakes = Mistakes()
    with mistakes.under(""):
        for name, changes in _items(written, "laden: {W: 200 kN}"):
            with mistakes.under(name):
                found.append(_load(name, changes, found))
    mistakes.report()


def _load(written: str, given: object, others: list[Load]) -> Load:
    name = as_text(written).strip()
    if not name:
        raise wrong_key("a load needs a name")
    changes = _changes(given)
    for other in others:
        if other.name == name:
            raise wrong_key(f"{name} stands twice")
        if dict(other.changes) == dict(changes):
            raise ProblemError(f"has the values of {other.name}: remove one of the two")
    return Load(name, changes)


def _changes(written: object) -> tuple[tuple[str, float], ...]:
    if written == {}:
        return ()  # the vehicle as designed
    mistakes, found = Mistakes(), dict[str, float]()
    with mistakes.under(""):
        for name, value in _items(written, "W: 200 kN"):
            with mistakes.under(name):
                if name == CREEP_FACTOR.key:
                    raise wrong_key("is no part of a load: it stands beside load")
                _put(found, row := _row(name), row.check(value))
    mistakes.report()
    return tuple(found.items())

"""How parameters are distributed: plain data, for the probability that a vehicle is unstable."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from .cases import Change, is_percentage
from .condition import CREEP, CREEP_FACTOR, Conditions
from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion
from .outside_the_model import why_unknown
from .parameters import PARAMETERS
from .quantities import format_quantity
from .running import SPEED
from .table import Parameter, as_quantity, key_of, shown

CUT = 5.0  # standard deviations at which a normal and a lognormal distribution end
MOST_NORMAL = 1 / CUT  # coefficient of variation with which a normal distribution ends at zero
MOST_LOGNORMAL = 1.0
KINDS = ("uniform", "normal", "lognormal")
_EXAMPLE = "{uniform: [0.05, 0.40]}, {normal: 10 %} or {lognormal: 10 %}"


@dataclass(frozen=True)
class Distribution:
    """How one parameter is distributed.

    Parameters
    ----------
    name : str
        A parameter, ``creep_factor`` or ``speed``.
    kind : {"uniform", "normal", "lognormal"}
        A normal and a lognormal distribution have the value as designed as their mean, and end at five standard
        deviations.
    numbers : tuple of Change
        Of a uniform distribution both ends, in SI units or as shares of the value as designed; of the others the
        standard deviation as a share of it.
    """

    name: str
    kind: str
    numbers: tuple[Change, ...]

    @property
    def key(self) -> str:
        """The name of its values in equations: ``v`` for the speed."""
        return "v" if self.name == "speed" else self.name

    @property
    def row(self) -> Parameter:
        """Its row of the table."""
        return _row(self.name)

    @property
    def in_shares(self) -> bool:
        """Whether it needs the value as designed."""
        return any(number.share for number in self.numbers)

    @property
    def written(self) -> dict[str, Any]:
        """The same as a problem file has it; shares are percentages."""
        numbers = [number.written for number in self.numbers]
        return {self.kind: numbers if self.kind == "uniform" else numbers[0]}

    @property
    def log_deviation(self) -> float:
        """Standard deviation of the logarithm of a lognormal distribution [-]."""
        return math.sqrt(math.log1p(self.numbers[0].value ** 2))

    def deviation(self, designed: float) -> float:
        """Return its standard deviation [SI], from the value as designed."""
        if self.kind == "uniform":
            low, high = self.ends(designed)
            return (high - low) / math.sqrt(12)
        return abs(designed) * self.numbers[0].value

    def ends(self, designed: float) -> tuple[float, float]:
        """Return the least and the largest value [SI], from the value as designed."""
        if self.kind == "uniform":
            ends = [number.result(designed) for number in self.numbers]
        elif self.kind == "normal":
            ends = [designed * (1 + sign * CUT * self.numbers[0].value) for sign in (-1, 1)]
        else:
            s = self.log_deviation
            ends = [designed * math.exp(sign * CUT * s - s * s / 2) for sign in (-1, 1)]
        return min(ends), max(ends)


def as_distributions(value: object) -> tuple[Distribution, ...]:
    """Return distributions, given as such or as a problem file has them.

    Examples
    --------
    >>> as_distributions({"lambda": {"uniform": [0.05, 0.4]}, "K_m": {"lognormal": "10 %"}})[1].written
    {'lognormal': '10 %'}
    """
    found, mistakes = read_distributions(value)
    if mistakes:
        raise ProblemError(mistakes)
    return found


def read_distributions(value: object) -> tuple[tuple[Distribution, ...], list[Diagnostic]]:
    """Return the distributions that are right, and the mistakes in the others."""
    if isinstance(value, (tuple, list)) and all(isinstance(entry, Distribution) for entry in value):
        value = written(value)
    mistakes, found = Mistakes(), []
    with mistakes.under(""):
        for name, entry in _items(
            value, "parameters with their distributions, such as lambda: {uniform: [0.05, 0.40]}"
        ):
            with mistakes.under(name):
                found.append(_distribution(key_of(name), entry))
    return tuple(found), mistakes.found


def written(distributions: Iterable[Distribution]) -> dict[str, Any]:
    """Return distributions with the keys of a problem file, in SI units."""
    return {each.name: each.written for each in distributions}


def _items(value: object, expected: str) -> Iterator[tuple[str, object]]:
    if not isinstance(value, Mapping):
        what = "has no value" if value is None else f"{shown(value)} is not what stands here"
        raise ProblemError(f"{what}, expected {expected}")
    yield from ((str(name), each) for name, each in value.items())


def _row(name: str) -> Parameter:
    rows = {**PARAMETERS, CREEP_FACTOR.key: CREEP_FACTOR, SPEED.key: SPEED}
    if name not in rows:
        raise ProblemError(why_unknown(name, tuple(rows), "is not a parameter"))
    return rows[name].finite


def _distribution(name: str, value: object) -> Distribution:
    row, mistakes = _row(name), Mistakes()
    entries = list(_items(value, f"a distribution: {_EXAMPLE}"))
    for kind, _ in entries:
        with mistakes.under(kind):
            if kind not in KINDS:
                known = f"; known here: {', '.join(KINDS)}"
                raise ProblemError(f"is not a distribution{suggestion(kind, KINDS) or known}")
    mistakes.report()
    if len(entries) != 1:
        raise ProblemError(f"needs one distribution: {_EXAMPLE}")
    ((kind, numbers),) = entries
    with mistakes.under(kind):
        found = _ends(row, numbers) if kind == "uniform" else (_variation(name, kind, numbers),)
    mistakes.report()
    return Distribution(name, kind, found)


def _ends(row: Parameter, value: object) -> tuple[Change, ...]:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise ProblemError(f"{shown(value)} is not [low, high], such as [{row.example}, {row.example}]")
    mistakes, found = Mistakes(), []
    for k, entry in enumerate(value):
        with mistakes.under(f"{k}"):
            share = is_percentage(entry)
            found.append(Change(row.key, as_quantity(entry, "-") if share else row.accept(entry), share))
    mistakes.report()
    low, high = found
    if low.share != high.share:
        raise ProblemError("has one end as a share of the value as designed and one as a quantity: write both alike")
    if low.value >= high.value:
        with mistakes.under("1"):
            text = "makes it empty: low is the same" if low.value == high.value else f"is less than {shown(value[0])}"
            raise ProblemError(f"{shown(value[1])} {text}; a uniform distribution is [low, high]")
    mistakes.report()
    return low, high


def _variation(name: str, kind: str, value: object) -> Change:
    number = as_quantity(value, "-")
    most = MOST_NORMAL if kind == "normal" else MOST_LOGNORMAL
    if number <= 0:
        raise ProblemError(f"{shown(value)} is no standard deviation: a share of the value above 0 %, such as 10 %")
    if number > most:
        why = f": a normal distribution would reach below zero, write lognormal: {shown(value)}"
        raise ProblemError(f"{shown(value)} is more than {100 * most:g} %{why if kind == 'normal' else ''}")
    return Change(name, number, share=True)


def unfit(
    distributions: Collection[Distribution],
    designed: Mapping[str, float | None],
    speeds: Collection[float],
    conditions: Conditions,
) -> Iterator[Diagnostic]:
    """Yield the distributions that do not fit a problem.

    Parameters
    ----------
    distributions : collection of Distribution
        Of parameters that the vehicle has.
    designed : mapping of str to float or None
        Values as designed, where known.
    speeds : collection of float
        Of the problem [m/s]; none where they are not known.
    conditions : Conditions
        Under which everything must hold.
    """
    names = {each.name for each in distributions}
    given = {*conditions.keys, *(key for load in conditions.loads for key, _ in load.changes)}
    values = {**designed, CREEP_FACTOR.key: 1.0, SPEED.key: next(iter(speeds)) if len(speeds) == 1 else None}
    for each in distributions:
        text = ""
        if each.name == CREEP_FACTOR.key and (both := [key for key in CREEP if key in names or key in given]):
            where = "uncertainty" if both[0] in names else "conditions"
            text = f"multiplies {both[0]}, which stands under {where}: give one of the two"
        elif each.in_shares and each.name == SPEED.key and len(speeds) > 1:
            text = "is a share of one speed, and there are several: give uniform: [200 km/h, 300 km/h]"
        elif each.name == "C_s" and "C_s" not in designed:
            text = "has no value as designed: give bogie.C_s"
        elif (value := values.get(each.name)) is not None:
            text = _leaves(each, value)
        if text:
            yield Diagnostic(key=f"uncertainty.{each.name}", message=text)


def _leaves(one: Distribution, value: float) -> str:
    """Return why a distribution has no width, or leaves the range of its parameter."""
    if one.in_shares and value == 0:
        return "has no width: it is a share of the value as designed, which is 0"
    low, high = one.row.hard
    for end in one.ends(value):
        if not low <= end <= high:
            reached = format_quantity(end, one.row.unit)
            return f"reaches {reached}, outside {one.row.range_text(one.row.hard, one.row.unit)}"
    return ""

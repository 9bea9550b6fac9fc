"""The columns of the parameter table, and the one place where values are checked against it."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from numbers import Real
from types import MappingProxyType
from typing import Any, TypeVar, cast

from .characters import refusal
from .diagnostics import Mistakes, ProblemError, suggestion, warn_of_unit
from .outside_the_model import answer_to, why_no_number
from .quantities import Written, exact, format_number, format_quantity, parse_quantity, split_quantity
from .units import UnitError, kind_of, parse_unit, si_unit

T = TypeVar("T")
RIGID = math.inf
LONGEST_TEXT = 1000
MOST_BITS = 4000  # of an exact number: a double with a unit of any size has fewer
Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One row of the parameter table.

    Parameters
    ----------
    key : str
        Name in files and in results, such as ``K_1x`` or ``lambda``.
    symbol : str
        LaTeX, without dollar signs.
    unit : str
        Unit in which people see it.
    meaning : str
        What it is, in a few words.
    hard : tuple of float
        Least and largest value that is accepted, in SI; zero is allowed where the least value is 0.
    usual : tuple of float
        Least and largest value that is not doubted, in SI.
    source : str
        Value in Table I or the design example of the paper, as printed and in the displayed unit.
    group : str
        Title of the rows that stand together in a file.
    motor : bool
        Whether only a power bogie has it.
    optional : bool
        Whether it may be left out.
    rigid : bool
        Whether it is a stiffness that may be infinite: the word ``rigid`` stands for that.
    """

    key: str = ""
    symbol: str
    unit: str
    meaning: str
    hard: Range
    usual: Range
    source: str
    group: str = ""
    motor: bool = False
    optional: bool = False
    rigid: bool = False

    @property
    def si(self) -> str:
        """SI unit."""
        return si_unit(self.unit)

    @property
    def example(self) -> str:
        """The value of the paper as it may be written in a file."""
        return f"{self.source} {self.unit.strip('-')}".strip()

    @property
    def finite(self) -> Parameter:
        """The same row for values that must be numbers: bounds, and values in faults."""
        return replace(self, rigid=False)

    def check(self, value: object) -> Any:
        """Return a number or a text with a unit as an SI number inside the hard range, or infinity if it is rigid.

        Raises
        ------
        ProblemError
            If it is no number, has another dimension or lies outside.
        """
        if self.rigid and _is_rigid(value):
            return RIGID
        if why := why_no_number(value):
            raise ProblemError(f"{shown(value)} is not a number: {why}")
        number = as_quantity(value, self.unit, self.si)
        low, high = map(exact, self.hard)
        if not low <= number.exact <= high:
            raise ProblemError(f"{shown(value)} is outside {self.range_text(self.hard, _unit_of(value))}")
        return number

    def accept(self, value: object, *, doubtful: bool = False) -> Any:
        """Return a value as `check` does; warn where a bare number may have been meant in km/h.

        Numbers in Python are SI: only a text without a unit and what is above the usual range are doubted, and what the
        caller finds `doubtful`.
        """
        number = self.check(value)
        if self._is_bare(value) and (isinstance(value, str) or doubtful or number > self.usual[1]):
            warn_of_unit(f"{self.key}: {self._read_as(value)}")
        return number

    def doubt(self, value: object) -> str | None:
        """Return why an accepted value is unusual or may have been meant in another unit, or None."""
        if self._is_bare(value):
            return self._read_as(value)
        number = self.check(value)
        if self._is_usual(number) or number == RIGID:
            return None
        usual = self.range_text(self.usual, _unit_of(value))
        return f"{shown(value)} is unusual, {usual} is common: are value and unit right?"

    def _is_usual(self, number: float) -> bool:
        return self.usual[0] <= number <= self.usual[1]

    def _is_bare(self, value: object) -> bool:
        """Return whether a value has no unit although people do not think of it in SI: a speed is in km/h."""
        return self.unit == "km/h" and not isinstance(value, Written) and not _unit_of(value)

    def _read_as(self, value: object) -> str:
        number, bare = self.check(value), shown(value)
        usual = "" if self._is_usual(number) else f"; {self.range_text(self.usual, self.unit)} is common"
        read = f"{bare} is read as {bare} {self.si}, which is {format_quantity(number, self.unit)}{usual}"
        return f"{read}: write {bare} {self.unit}, or {bare} {self.si} if that is meant"

    def range_text(self, ends: Range, unit: str = "") -> str:
        """Return a range as a text in a unit, SI if none is given."""
        unit = unit or self.si
        low, high = (format_number(float(exact(end) / parse_unit(unit).factor)) for end in ends)
        return f"{low} ... {high} {unit.strip('-')}".strip()


def parameter(
    symbol: str, unit: str, meaning: str, *, hard: Range, usual: Range, source: str, default: Any = MISSING, **more: Any
) -> Any:
    """Make a dataclass field that carries a row of the table; the key is the field's name."""
    row = Parameter(symbol=symbol, unit=unit, meaning=meaning, hard=hard, usual=usual, source=source, **more)
    if row.motor or row.optional:
        default = None
    return field(default=default, metadata={"parameter": row})


def table(cls: type) -> Mapping[str, Parameter]:
    """Return the rows of a dataclass made with :func:`parameter`, by key and in order."""
    rows = {key_of(f.name): f.metadata["parameter"] for f in fields(cls) if "parameter" in f.metadata}
    return MappingProxyType({key: replace(row, key=key) for key, row in rows.items()})


def check_end(value: object, row: Parameter, low: Written | None) -> Any:
    """Return the upper end of a range in SI, which must lie above the lower end where that is known."""
    high = row.check(value)
    if low is None or low.exact < high.exact:
        return high
    if low.exact == high.exact:
        raise ProblemError(f"{shown(value)} makes an empty range: min is the same")
    least = format_quantity(low, _unit_of(value) or row.si)
    raise ProblemError(f"{shown(value)} is less than min, which is {least}")


def check_ends(low: object, high: object, row: Parameter) -> tuple[Written, Written]:
    """Return both ends of a range in SI; the first must be less than the second."""
    mistakes = Mistakes()
    least = most = None
    with mistakes.under("min"):
        least = row.check(low)
    with mistakes.under("max"):
        most = check_end(high, row, least)
    mistakes.report()
    return cast(Written, least), cast(Written, most)


def field_name(key: str) -> str:
    """Return the Python name of a key: ``lambda`` is a reserved word and becomes ``lambda_``."""
    return _RESERVED.get(key, key)


def key_of(name: str) -> str:
    """Return the key that a Python name stands for: ``lambda`` for ``lambda_``."""
    return _KEYS.get(name, name)


_RESERVED = {"lambda": "lambda_"}
_KEYS = {name: key for key, name in _RESERVED.items()}


def as_quantity(value: object, unit: str, si: str = "") -> Written:
    """Return a number (SI) or a text with a unit of the given dimension as an exact SI number."""
    if isinstance(value, str):
        return parse_quantity(value, unit)
    if value is None:
        raise ProblemError(f"has no value, expected a number in {si or si_unit(unit)} or a text with a unit")
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ProblemError(f"{shown(value)} is not a number, expected {kind_of(unit)} in {si or si_unit(unit)}")
    try:
        number = Written(value if isinstance(value, Written) else exact(value))  # type: ignore[arg-type]
    except (ValueError, OverflowError):
        raise ProblemError(f"{shown(value)} is not a finite number") from None
    if max(number.exact.numerator.bit_length(), number.exact.denominator.bit_length()) > MOST_BITS:
        raise ProblemError(f"{shown(value)} has too many digits to compute with")
    return number


def as_several(value: Any) -> list[Any]:
    """Return the entries of a list or of an array as plain numbers, or a single value as the only entry."""
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        return [value]
    entries: list[Any] = [value] if getattr(value, "ndim", 1) == 0 else list(value)
    return [entry.item() if getattr(entry, "shape", None) == () else entry for entry in entries]


def _is_rigid(value: object) -> bool:
    return value.strip() == "rigid" if isinstance(value, str) else isinstance(value, Real) and value == RIGID


def as_switch(value: object) -> bool:
    """Return `value` if it is true or false."""
    if isinstance(value, bool):
        return value
    raise ProblemError(f"{shown(value)} is neither true nor false")


def as_choice(value: object, choices: Collection[str]) -> str:
    """Return `value` if it is one of `choices`."""
    if isinstance(value, str) and value in choices:
        return value
    why = f"; {answer}" if isinstance(value, str) and (answer := answer_to(value)) else ""
    near = suggestion(value, choices) if isinstance(value, str) else ""
    raise ProblemError(f"{shown(value)} is not one of: {', '.join(choices)}{why or near}")


def as_count(value: object, low: int, high: int) -> int:
    """Return a whole number from `low` to `high`."""
    number = as_quantity(value, "-").exact
    if number.denominator != 1 or not low <= number <= high:
        raise ProblemError(f"{shown(value)} is not a whole number from {low} to {high}")
    return int(number)


def as_seed(value: object) -> int | None:
    """Return the seed of random numbers: a whole number that is not negative, or nothing if there is none."""
    try:
        return None if value is None else as_count(value, 0, 2**63 - 1)
    except ProblemError as error:
        raise error.under("seed") from None


def as_text(value: object) -> str:
    """Return a text of one line, without control characters."""
    if not isinstance(value, str):
        raise ProblemError(f"{shown(value)} is not a text")
    text = value.removesuffix("\n")  # with which a YAML block ends
    if len(text) > LONGEST_TEXT:
        raise ProblemError(f"{shown(value)} is longer than {LONGEST_TEXT} characters")
    why = refusal(text)
    if why:
        raise ProblemError(why)
    return text


def check_fields(instance: Any) -> None:
    """Convert and check all fields of a frozen dataclass that stand in its table, in place; report all mistakes."""
    mistakes = Mistakes()
    for key, row in table(type(instance)).items():
        value = getattr(instance, field_name(key))
        if value is None and (row.motor or row.optional):
            continue
        with mistakes.under(key):
            object.__setattr__(instance, field_name(key), row.check(value))
    mistakes.report()


def documented(cls: type[T]) -> type[T]:
    """Append the table of a dataclass to its docstring."""
    lines = [f"{field_name(p.key)} : float\n    {p.meaning} [{p.si}]." for p in table(cls).values()]
    text = "\n".join(lines).replace("\n", "\n    ")
    cls.__doc__ = f"{(cls.__doc__ or '').rstrip()}\n    {text}\n    "
    return cls


def shown(value: object) -> str:
    """Return a value as messages repeat it."""
    if value is None:
        return "no value"
    if isinstance(value, bool):
        return str(value).lower()
    try:
        text = value.strip() if isinstance(value, str) else " ".join(f"{value!r}".split())
    except ValueError:  # of a number that Python refuses to write out
        text = "a number of thousands of digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


def _unit_of(value: object) -> str:
    try:
        return split_quantity(value)[1] if isinstance(value, str) else ""
    except UnitError:
        return ""

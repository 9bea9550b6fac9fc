"""What a design must reach under all conditions, and with the faults: plain data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion
from .running import SPEED
from .table import Parameter, shown

MEASURES: Mapping[str, Parameter] = {
    "decay_rate": Parameter(
        key="decay_rate",
        symbol=r"\sigma",
        unit="1/s",
        meaning="least decay rate of all modes that a design variable moves",
        hard=(0.0, 1e3),
        usual=(0.0, 10.0),
        source="1",
    ),
    "damping_ratio": Parameter(
        key="damping_ratio",
        symbol=r"\zeta",
        unit="-",
        meaning="least damping ratio of all modes that a design variable moves",
        hard=(0.0, 0.99),
        usual=(0.0, 0.3),
        source="0.05",
    ),
    "critical_speed": replace(SPEED, key="critical_speed", meaning="speed up to which every speed is stable"),
}
CASES = "cases."  # before a measure that the faults must reach
_EXAMPLE = "damping_ratio: 5 %"


@dataclass(frozen=True)
class Requirement:
    """What must be reached.

    Parameters
    ----------
    name : str
        ``decay_rate``, ``damping_ratio`` or ``critical_speed``; with ``cases.`` before it, what every fault must reach.
    wanted : float
        The least value [1/s], [-] or [m/s].
    """

    name: str
    wanted: float

    @property
    def of_cases(self) -> bool:
        """Whether the faults must reach it, and not the vehicle as designed."""
        return self.name.startswith(CASES)

    @property
    def measure(self) -> str:
        """What is measured: a key of `MEASURES`."""
        return self.name.removeprefix(CASES)


def as_requirements(value: object) -> tuple[Requirement, ...]:
    """Return requirements, given as such or as a problem file has them.

    Examples
    --------
    >>> as_requirements({"damping_ratio": "5 %", "cases": {"damping_ratio": "0 %"}})[1].name
    'cases.damping_ratio'
    """
    if isinstance(value, (tuple, list)) and all(isinstance(entry, Requirement) for entry in value):
        value = written(value)
    mistakes, found = Mistakes(), []
    if value == {}:
        return ()
    with mistakes.under(""):
        for name, wanted in _items(value):
            with mistakes.under(name):
                found.append(_requirement(name, wanted))
    mistakes.report()
    return tuple(found)


def _items(value: object) -> Iterator[tuple[str, object]]:
    if not isinstance(value, Mapping):
        what = "has no value" if value is None else f"{shown(value)} is not what stands here"
        raise ProblemError(f"{what}, expected requirements, such as {_EXAMPLE}")
    for name, wanted in value.items():
        if name == "cases" and isinstance(wanted, Mapping):
            yield from ((f"{CASES}{key}", each) for key, each in wanted.items())
        else:
            yield str(name), wanted


def _requirement(name: str, wanted: object) -> Requirement:
    key = name.removeprefix(CASES)
    if key not in MEASURES:
        raise ProblemError(f"is not known here{suggestion(key, MEASURES)}; known here: {', '.join(MEASURES)}, cases")
    return Requirement(name, MEASURES[key].accept(wanted))


def written(requirements: object) -> dict[str, object]:
    """Return requirements with the keys of a problem file, in SI units."""
    found: dict[str, object] = {}
    for each in requirements if isinstance(requirements, (tuple, list)) else ():
        if each.of_cases:
            found.setdefault("cases", {})[each.measure] = float(each.wanted)  # type: ignore[index]
        else:
            found[each.name] = float(each.wanted)
    return found


def without_cases(requirements: tuple[Requirement, ...], cases: object) -> Iterator[Diagnostic]:
    """Yield the requirements of faults where there are none."""
    for each in requirements:
        if each.of_cases and not cases:
            yield Diagnostic(key=f"requirements.{each.name}", message="there are no faults: give cases, or remove this")

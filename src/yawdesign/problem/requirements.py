"""What a design must reach under all conditions, and with the faults: plain data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from .diagnostics import Diagnostic, Mistakes, ProblemError, suggestion, wrong_key
from .outside_the_model import answer_to
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


def as_requirements(
    value: object, check: Callable[[Parameter, object], float] = Parameter.check
) -> tuple[Requirement, ...]:
    """Return requirements, given as such or as a problem file has them; `check` makes each value a number in SI.

    Examples
    --------
    >>> as_requirements({"damping_ratio": "5 %", "cases": {"damping_ratio": "0 %"}})[1].name
    'cases.damping_ratio'
    """
    found, mistakes = read_requirements(value, check)
    if mistakes:
        raise ProblemError(mistakes)
    return found


def read_requirements(
    value: object, check: Callable[[Parameter, object], float] = Parameter.check
) -> tuple[tuple[Requirement, ...], list[Diagnostic]]:
    """Return the requirements that are right, and the mistakes in the others."""
    mistakes, found = Mistakes(), dict[str, Requirement]()
    with mistakes.under(""):
        for name, wanted in _given(value):
            with mistakes.under(name):
                if name in found:
                    raise wrong_key("stands twice")
                found[name] = Requirement(name, check(_row(name, wanted), wanted))
    return tuple(found.values()), mistakes.found


def _given(value: object) -> Iterator[tuple[str, object]]:
    if isinstance(value, (tuple, list)) and all(isinstance(each, Requirement) for each in value):
        yield from ((each.name, each.wanted) for each in value)
        return
    if not isinstance(value, Mapping):
        raise _not_keys(value, _EXAMPLE)
    for name, wanted in value.items():
        if name == "cases" and isinstance(wanted, Mapping) and wanted:
            yield from ((f"{CASES}{key}", each) for key, each in wanted.items())
        else:
            yield str(name), wanted


def _not_keys(value: object, example: str) -> ProblemError:
    what = "has no value" if value is None else f"{shown(value)} is not what stands here"
    return ProblemError(f"{what}, expected requirements, such as {example}")


def _row(name: str, wanted: object) -> Parameter:
    measure = name.removeprefix(CASES)
    if name == "cases":
        raise _not_keys(wanted, "damping_ratio: 0 %")
    if measure not in MEASURES:
        known = (*MEASURES, "cases") if measure == name else tuple(MEASURES)
        unknown = f"is not known here{suggestion(measure, known)}; known here: {', '.join(known)}"
        raise wrong_key(answer_to(measure) or unknown)
    return MEASURES[measure]


def written(requirements: object) -> dict[str, object]:
    """Return requirements with the keys of a problem file, in SI units."""
    found: dict[str, object] = {}
    for each in requirements if isinstance(requirements, (tuple, list)) else ():
        if each.of_cases:
            found.setdefault("cases", {})[each.measure] = each.wanted  # type: ignore[index]
        else:
            found[each.name] = each.wanted
    return found


def without_cases(requirements: tuple[Requirement, ...], cases: object) -> Iterator[Diagnostic]:
    """Yield the requirements of faults where there are none."""
    text = "there are no faults: give cases, or remove this"
    for each in requirements if not cases else ():
        if each.of_cases:
            yield Diagnostic(key=f"requirements.{each.name}", message=text, at_key=True)

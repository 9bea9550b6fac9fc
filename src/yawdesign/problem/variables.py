"""What may be changed in a design, and what is to be best."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Literal, Self, get_args

from .arguments import named, refused
from .damper_catalogue import CatalogueDamper, as_catalogue
from .diagnostics import Mistakes, ProblemError
from .outside_the_model import why_unknown
from .parameters import PARAMETERS, parameter_keys
from .table import Parameter, as_choice, check_ends, key_of

Objective = Literal["decay_rate", "damping_ratio"]
OBJECTIVES: tuple[str, ...] = get_args(Objective)


@named
@dataclass(frozen=True, kw_only=True)
class Variable:
    """Bounds of a design variable.

    Parameters
    ----------
    min, max : float
        Bounds in SI. Texts with a unit are converted as soon as the variable is part of a Design, which knows what
        it measures.
    """

    min: float
    max: float

    def checked(self, row: Parameter) -> Self:
        """Return the bounds in SI, checked against a row of the parameter table."""
        return replace(self, **dict(zip(("min", "max"), check_ends(self.min, self.max, row), strict=True)))


class Variables(Mapping[str, Variable]):
    """The design variables by key: a mapping that cannot be changed and can be hashed."""

    def __init__(self, variables: Mapping[str, Variable]) -> None:
        self._variables = dict(variables)

    def __getitem__(self, key: str) -> Variable:
        return self._variables[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._variables)

    def __len__(self) -> int:
        return len(self._variables)

    def __hash__(self) -> int:
        return hash(frozenset(self._variables.items()))

    def __repr__(self) -> str:
        return repr(self._variables)


DEFAULT_BOUNDS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "C_s": ("10 kN·s/m", "10 MN·s/m"),
        "K_m": ("62.648 kN/m", "6.2648 MN/m"),  # a tenth and ten times the value of Table I
        "C_m": ("1.995 kN·s/m", "199.5 kN·s/m"),
    }
)


def default_variables(kind: str) -> Variables:
    """Return the design variables of a problem that names none: C_s, and K_m and C_m where there are motors."""
    keys = [key for key in DEFAULT_BOUNDS if key in parameter_keys(kind)]
    bounds = {key: check_ends(*DEFAULT_BOUNDS[key], PARAMETERS[key]) for key in keys}
    return Variables({key: Variable(min=low, max=high) for key, (low, high) in bounds.items()})


@named
@dataclass(frozen=True, kw_only=True)
class Design:
    """What may be changed, and what is to be best.

    Parameters
    ----------
    objective : {"decay_rate", "damping_ratio"}
        Largest least decay rate [1/s] or largest least damping ratio [-].
    variables : mapping of str to Variable
        Bounds by parameter key. If there are none, a problem takes C_s and, for a power bogie, K_m and C_m.
    catalogue : tuple of CatalogueDamper
        The yaw damper is one of these, if there are any; bounds of C_s leave some of them out.
    """

    objective: Objective = "decay_rate"
    variables: Mapping[str, Variable] = field(default_factory=lambda: Variables({}))
    catalogue: tuple[CatalogueDamper, ...] = ()

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("design.objective"):
            as_choice(self.objective, OBJECTIVES)
        with mistakes.under("design.catalogue"):
            object.__setattr__(self, "catalogue", as_catalogue(self.catalogue, optional=True))
        checked: dict[str, Variable] = {}
        for given, variable in self._given():
            key = key_of(given)
            with mistakes.under(f"design.variables.{key}"):
                checked[key] = _checked_variable(key, variable)
        mistakes.report()
        object.__setattr__(self, "variables", Variables(checked))

    def _given(self) -> Iterable[tuple[Any, object]]:
        if not isinstance(self.variables, Mapping):
            raise refused("design.variables", "a mapping of names to Variable(min=..., max=...)", self.variables)
        return self.variables.items()


def _checked_variable(key: object, variable: object) -> Variable:
    if not isinstance(key, str) or key not in PARAMETERS:
        raise ProblemError(why_unknown(str(key), tuple(PARAMETERS)))
    if not isinstance(variable, Variable):
        raise ProblemError(f"{variable!r} is not a Variable(min=..., max=...)")
    return variable.checked(PARAMETERS[key].finite)

"""The problem: a bogie, the speeds it runs at, the curve it must pass, and what may be changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from numbers import Real
from typing import Any, Literal, Self, get_args

from .arguments import named
from .diagnostics import Mistakes, ProblemError, unknown_key
from .parameters import MOTOR_KEYS, NO_MOTOR, Bogie, parameter_keys
from .running import SPEED, Curve, SpeedRange
from .table import as_choice, as_text, field_name, key_of
from .variables import Design, default_variables

Equations = Literal["reciprocal", "as-printed"]
EQUATIONS: tuple[str, ...] = get_args(Equations)


@named
@dataclass(frozen=True, kw_only=True)
class Problem:
    """Everything that an answer depends on.

    Parameters
    ----------
    bogie : Bogie
        The bogie.
    speed : float or SpeedRange
        Running speed [m/s], or a range of them; a text with a unit is converted.
    equations : {"reciprocal", "as-printed"}
        Whether the motors' yaw reaction acts on the frame, or is left out as in the paper's equations.
    curve : Curve, optional
        The tightest curve; without it the damping has no upper limit.
    design : Design
        What may be changed, and what is to be best.
    title : str
        Any text; it heads tables and plots.
    """

    bogie: Bogie
    speed: float | SpeedRange
    equations: Equations = "reciprocal"
    curve: Curve | None = None
    design: Design = field(default_factory=Design)
    title: str = ""

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("title"):
            object.__setattr__(self, "title", as_text(self.title))
        with mistakes.under("equations"):
            as_choice(self.equations, EQUATIONS)
        for name, kind in (("bogie", Bogie), ("curve", Curve | None), ("design", Design)):
            with mistakes.under(name):
                _instance(getattr(self, name), kind)
        if not isinstance(self.speed, SpeedRange):
            with mistakes.under("speed"):
                object.__setattr__(self, "speed", SPEED.accept(self.speed))
        mistakes.report()
        self._fill_design()

    def _fill_design(self) -> None:
        if not self.design.variables:
            design = replace(self.design, variables=default_variables(self.bogie.kind))
            object.__setattr__(self, "design", design)
        mistakes = Mistakes()
        for key in self.design.variables:
            with mistakes.under(f"design.variables.{key}"):
                if key not in parameter_keys(self.bogie.kind):
                    raise ProblemError(NO_MOTOR)
        mistakes.report()

    @property
    def speeds(self) -> tuple[float, ...]:
        """The running speeds [m/s] in rising order; one, if no range is given."""
        return self.speed.values if isinstance(self.speed, SpeedRange) else (self.speed,)

    def replace(self, **changes: Any) -> Self:
        """Return a problem with other values.

        Parameters
        ----------
        **changes
            Fields of the problem (``speed="250 km/h"``) or parameters of the bogie (``C_s="1 MN s/m"``).

        Returns
        -------
        Problem
            The changed problem.

        Raises
        ------
        ProblemError
            If a name is not known or a value is not accepted.
        """
        own = {f.name for f in fields(self)}
        keys = {name: key_of(name) for name in changes}
        allowed = (*own, *parameter_keys(self.bogie.kind))
        mistakes = Mistakes()
        for key in keys.values():
            with mistakes.under(key):
                if key not in allowed:
                    raise ProblemError(NO_MOTOR if key in MOTOR_KEYS else unknown_key(key, allowed))
        with mistakes.under("bogie"):
            _instance(changes.get("bogie", self.bogie), Bogie)
        with mistakes.under("speed"):
            if isinstance(speed := changes.get("speed"), Real):  # a speed that was computed is hardly whole
                changes["speed"] = SPEED.accept(speed, doubtful=SPEED.check(speed).exact.denominator == 1)
        mistakes.report()
        mine = {name: value for name, value in changes.items() if name in own}
        bogies = {field_name(keys[name]): value for name, value in changes.items() if name not in own}
        bogie = replace(mine.pop("bogie", self.bogie), **bogies)
        return replace(self, bogie=bogie, **mine)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, with the keys of a problem file."""
        plain: dict[str, Any] = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        plain["bogie"] = {"kind": self.bogie.kind} | _plain(self.bogie.parameters())
        return plain


def _instance(value: object, kind: Any) -> None:
    if not isinstance(value, kind):
        expected = getattr(kind, "__name__", "Curve")
        raise ProblemError(f"{value!r} is not a {expected}")


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    return float(value) if isinstance(value, float) else value

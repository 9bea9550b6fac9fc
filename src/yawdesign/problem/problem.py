"""The problem: a bogie, the car body on it, its speeds, the curve it must pass, and what may be changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from numbers import Real
from typing import Any, Literal, Self, get_args

from .arguments import named
from .cases import Case
from .diagnostics import Mistakes, ProblemError, unknown_key
from .parameters import BOGIE, CAR_BODY, MOTOR_KEYS, NO_MOTOR, PARAMETERS, Bogie, CarBody, bogie_keys
from .quantities import Written, exact
from .running import CURVE, SPEED, Curve, SpeedRange
from .table import RIGID, as_choice, as_text, field_name, key_of
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
    cases : tuple of Case
        Faults that must be survived.
    design : Design
        What may be changed, and what is to be best.
    car_body : CarBody, optional
        The car body on two such bogies, with reciprocal equations; without it the car body stands still.
    title : str
        Any text; it heads tables and plots.
    """

    bogie: Bogie
    speed: float | SpeedRange
    equations: Equations = "reciprocal"
    car_body: CarBody | None = None
    curve: Curve | None = None
    cases: tuple[Case, ...] = ()
    design: Design = field(default_factory=Design)
    title: str = ""

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("title"):
            object.__setattr__(self, "title", as_text(self.title))
        with mistakes.under("equations"):
            as_choice(self.equations, EQUATIONS)
        for name, kind in _PARTS.items():
            with mistakes.under(name):
                _instance(getattr(self, name), kind)
        if not isinstance(self.speed, SpeedRange):
            with mistakes.under("speed"):
                object.__setattr__(self, "speed", SPEED.accept(self.speed))
        mistakes.report()
        self._fit_together()
        self._fill_design()

    def _fit_together(self) -> None:
        """Refuse what bogie, car body and equations do not allow together; fill in l_c."""
        mistakes = Mistakes()
        roll = ("K_2z", "C_2z")
        for key in roll:
            with mistakes.under(f"bogie.{key}"):
                given = getattr(self.bogie, key) is not None
                if self.car_body is not None and given:
                    raise ProblemError("belongs under car_body, where there is one")
                if self.car_body is None and given != (self.bogie.I_b is not None):
                    raise ProblemError("belongs to roll: give I_b too" if given else "is missing: I_b needs it")
        if self.car_body is not None:
            with mistakes.under("equations"):
                if self.equations == "as-printed":
                    raise ProblemError("the printed equations have no car body: write reciprocal, or remove car_body")
            with mistakes.under("car_body.l_c"):
                if self.car_body.l_c is None:
                    if self.curve is None:
                        raise ProblemError("is missing: give half the distance of the bogie centres, or a curve with L")
                    half = Written(exact(self.curve.L) / 2)
                    object.__setattr__(self, "car_body", replace(self.car_body, l_c=half))
        mistakes.report()

    def _fill_design(self) -> None:
        if not self.design.variables:
            design = replace(self.design, variables=default_variables(self.bogie.kind))
            object.__setattr__(self, "design", design)
        mistakes = Mistakes()
        for key in self.design.variables:
            with mistakes.under(f"design.variables.{key}"):
                if key not in self.keys:
                    raise ProblemError(self._why_absent(key))
        mistakes.report()

    def _why_absent(self, key: str) -> str:
        if key in MOTOR_KEYS and self.bogie.kind == "trailer":
            return NO_MOTOR
        if key in PARAMETERS:
            part = "car_body" if key in CAR_BODY else "bogie"
            return f"is not part of this vehicle: give its value under {part} first"
        return unknown_key(key, self.keys)

    def parameters(self) -> dict[str, float]:
        """Return the values of bogie and car body in SI by key, without those that are not given or rigid.

        Returns
        -------
        dict of str to float
        """
        return self.bogie.parameters() | (self.car_body.parameters() if self.car_body else {})

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of its parameters, C_s among them, in the order of the table."""
        given = self.parameters()
        return tuple(key for key in PARAMETERS if key in given or key == "C_s")

    @property
    def flags(self) -> tuple[str, ...]:
        """What the numbers do not say: ``"overturning"``, ``"no gravitational stiffness"``."""
        body = self.car_body is not None and self.car_body.overturning
        found = {"overturning": body, "no gravitational stiffness": not self.bogie.gravitational_stiffness}
        return tuple(name for name, true in found.items() if true)

    @property
    def speeds(self) -> tuple[float, ...]:
        """The running speeds [m/s] in rising order; one, if no range is given."""
        return self.speed.values if isinstance(self.speed, SpeedRange) else (self.speed,)

    def replace(self, **changes: Any) -> Self:
        """Return a problem with other values.

        Parameters
        ----------
        **changes
            Fields of the problem (``speed="250 km/h"``), parameters of the bogie (``C_s="1 MN s/m"``), of the car body
            or of the curve (``limit=0.1``), or the ``objective``; a name is looked for in this order.

        Returns
        -------
        Problem
            The changed problem.

        Raises
        ------
        ProblemError
            If a name is not known or a value is not accepted.
        """
        mistakes = Mistakes()
        parts: dict[str, dict[str, Any]] = {name: {} for name in ("own", *_PARTS)}
        for name, value in changes.items():
            with mistakes.under(key_of(name)):
                parts[self._part_of(key_of(name))][field_name(key_of(name))] = value
        mine = parts.pop("own")
        with mistakes.under("speed"):
            if isinstance(speed := mine.get("speed"), Real):  # a speed that was computed is hardly whole
                mine["speed"] = SPEED.accept(speed, doubtful=SPEED.check(speed).exact.denominator == 1)
        for name, values in parts.items():
            with mistakes.under(name):
                part = mine.get(name, getattr(self, name))
                _instance(part, _PARTS[name])
                if values:
                    mine[name] = replace(part, **values)
        mistakes.report()
        return replace(self, **mine)

    def _part_of(self, key: str) -> str:
        """Return which part of the problem has a key."""
        own = {f.name for f in fields(self)}
        body = {f.name for f in fields(CarBody)} if self.car_body else set()
        curve = {f.name for f in fields(Curve)} if self.curve else set()
        allowed = {
            **dict.fromkeys(own, "own"),
            **dict.fromkeys(("objective",), "design"),
            **dict.fromkeys((*CURVE, "load") if curve else (), "curve"),
            **dict.fromkeys((*CAR_BODY, "overturning") if body else (), "car_body"),
            **dict.fromkeys((*bogie_keys(self.bogie.kind), "gravitational_stiffness"), "bogie"),
        }
        if body:
            allowed |= dict.fromkeys(("K_2z", "C_2z"), "car_body")
        if key not in allowed:
            known = key in MOTOR_KEYS or key in PARAMETERS
            raise ProblemError(self._why_absent(key) if known else unknown_key(key, allowed))
        return allowed[key]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, with the keys of a problem file."""
        plain: dict[str, Any] = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        plain["bogie"] = {"kind": self.bogie.kind} | _given(self.bogie)
        if self.car_body is not None:
            plain["car_body"] = _given(self.car_body)
        return plain


_PARTS: Mapping[str, Any] = {"bogie": Bogie, "car_body": CarBody | None, "curve": Curve | None, "design": Design}


def _given(part: Bogie | CarBody) -> dict[str, Any]:
    """Return what was given of a part, by key."""
    rows = BOGIE if isinstance(part, Bogie) else CAR_BODY
    values = {key: getattr(part, field_name(key)) for key in rows}
    found = {key: "rigid" if value == RIGID else float(value) for key, value in values.items() if value is not None}
    switches = {"gravitational_stiffness": True, "overturning": False}
    return found | {key: getattr(part, key) for key, usual in switches.items() if getattr(part, key, usual) != usual}


def _instance(value: object, kind: Any) -> None:
    if not isinstance(value, kind):
        expected = next(a for a in (kind, *get_args(kind)) if isinstance(a, type)).__name__
        raise ProblemError(f"{value!r} is not a {expected}")


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    return float(value) if isinstance(value, float) else value

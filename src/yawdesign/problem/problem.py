"""The problem: a bogie, the car body on it, its speeds, the curve it must pass, and what may be changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from numbers import Real
from typing import Any, Literal, Self, get_args

from .arguments import named
from .cases import Case, as_cases
from .condition import CREEP_FACTOR, Conditions
from .consistency import misfits, present, why_absent
from .diagnostics import Mistakes, ProblemError
from .distributions import Distribution, as_distributions
from .distributions import written as written_distributions
from .notebook_view import NotebookView
from .parameters import CAR_BODY, VERTICAL, Bogie, CarBody, bogie_keys, given_of
from .quantities import Written, exact
from .requirements import Requirement, as_requirements
from .requirements import written as written_requirements
from .running import CURVE, SPEED, Curve, SpeedRange, as_speeds
from .table import RIGID, Parameter, as_choice, as_text, field_name, key_of, shown
from .variables import Design, default_variables
from .written_conditions import as_conditions

Equations = Literal["reciprocal", "as-printed"]
EQUATIONS: tuple[str, ...] = get_args(Equations)


@named
@dataclass(frozen=True, kw_only=True)
class Problem(NotebookView):
    """Everything that an answer depends on.

    Parameters
    ----------
    bogie : Bogie
        The bogie.
    speed : float, sequence of float or SpeedRange
        Running speed [m/s], several of them, or a range, every speed in which may come; a text with a unit is
        converted.
    equations : {"reciprocal", "as-printed"}
        Whether the motors' yaw reaction acts on the frame, or is left out as in the paper's equations.
    curve : Curve, optional
        The tightest curve; without it the damping has no upper limit.
    design : Design
        What may be changed, and what is to be best.
    car_body : CarBody, optional
        The car body on two such bogies, with reciprocal equations; without it the car body stands still.
    title : str
        Any text; it heads tables and plots.
    cases : tuple of Case
        Faults that must be survived; they may be given as a problem file has them, ``{"one yaw damper lost": {"C_s":
        "50 %", "K_ds": "50 %"}}``: a percentage is a share of the value as designed.
    conditions : Conditions
        Under which everything must hold, beside the speeds; they may be given as a problem file has them,
        ``{"lambda": [0.05, 0.4], "creep_factor": {"min": 0.5, "max": 1}}``.
    requirements : tuple of Requirement
        What must be reached under all conditions; they may be given as a problem file has them,
        ``{"damping_ratio": "5 %", "critical_speed": "330 km/h"}``.
    uncertainty : tuple of Distribution
        Of parameters, the creep factor or the speed; they may be given as a problem file has them, ``{"lambda":
        {"uniform": [0.05, 0.4]}, "K_m": {"lognormal": "10 %"}}``.
    """

    bogie: Bogie
    speed: float | tuple[float, ...] | SpeedRange
    equations: Equations = "reciprocal"
    car_body: CarBody | None = None
    curve: Curve | None = None
    design: Design = field(default_factory=Design)
    title: str = ""
    cases: tuple[Case, ...] = ()
    conditions: Conditions = field(default_factory=Conditions)
    requirements: tuple[Requirement, ...] = ()
    uncertainty: tuple[Distribution, ...] = ()

    def __post_init__(self) -> None:
        mistakes = Mistakes()
        with mistakes.under("title"):
            object.__setattr__(self, "title", as_text(self.title))
        with mistakes.under("equations"):
            as_choice(self.equations, EQUATIONS)
        for name, kind in _PARTS.items():
            with mistakes.under(name):
                _instance(getattr(self, name), kind)
        with mistakes.under("" if isinstance(self.speed, Mapping) else "speed"):
            object.__setattr__(self, "speed", _speed(self.speed))
        with mistakes.under("cases"):
            object.__setattr__(self, "cases", as_cases(self.cases))
        with mistakes.under("conditions"):
            object.__setattr__(self, "conditions", as_conditions(self.conditions))
        with mistakes.under("requirements"):
            object.__setattr__(self, "requirements", as_requirements(self.requirements, Parameter.accept))
        with mistakes.under("uncertainty"):
            object.__setattr__(self, "uncertainty", as_distributions(self.uncertainty))
        mistakes.report()
        if not self.design.variables:
            design = replace(self.design, variables=default_variables(self.bogie.kind))
            object.__setattr__(self, "design", design)
        self._fit_together()

    def _fit_together(self) -> None:
        """Refuse what its parts do not allow together; fill in l_c."""
        found = tuple(
            misfits(
                kind=self.bogie.kind,
                equations=self.equations,
                bogie=given_of(self.bogie),
                car_body=given_of(self.car_body) if self.car_body else None,
                speed_count=self._speed_count,
                curve=self.curve is not None,
                variables=self.design.variables,
                cases=self.cases,
                conditions=self.conditions,
                requirements=self.requirements,
                uncertainty=self.uncertainty,
                speeds=self.speeds,
            )
        )
        if found:
            raise ProblemError(found)
        if self.car_body is not None and self.car_body.l_c is None and self.curve is not None:
            half = Written(exact(self.curve.L) / 2)
            object.__setattr__(self, "car_body", replace(self.car_body, l_c=half))

    @property
    def _speed_count(self) -> int:
        return self.speed.steps if isinstance(self.speed, SpeedRange) else len(self.speeds)

    def parameters(self) -> dict[str, float]:
        """Return the values of bogie and car body in SI by key, without those that are not given or rigid.

        Returns
        -------
        dict of str to float
        """
        return self.bogie.parameters() | (self.car_body.parameters() if self.car_body else {})

    @property
    def of_one_bogie(self) -> Self | None:
        """The same problem for one bogie under a car body that stands still; None if it is that already."""
        if self.car_body is None:
            return None
        vertical = {key: getattr(self.car_body, key) for key in VERTICAL} if self.bogie.I_b is not None else {}
        bogie = replace(self.bogie, **vertical)
        keys = present(bogie.parameters())
        variables = {key: variable for key, variable in self.design.variables.items() if key in keys}
        design = replace(self.design, variables=variables)
        cases = tuple(case for case in self.cases if {change.key for change in case.changes} <= set(keys))
        requirements = tuple(each for each in self.requirements if cases or not each.of_cases)
        return replace(
            self,
            car_body=None,
            bogie=bogie,
            cases=cases,
            conditions=self.conditions.of(keys),
            requirements=requirements,
            uncertainty=tuple(x for x in self.uncertainty if x.name in (*keys, CREEP_FACTOR.key, SPEED.key)),
            design=design,
        )

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of its parameters, C_s among them, in the order of the table."""
        return present(self.parameters())

    @property
    def flags(self) -> tuple[str, ...]:
        """What the numbers do not say: ``"overturning"``, ``"no gravitational stiffness"``."""
        body = self.car_body is not None and self.car_body.overturning
        found = {"overturning": body, "no gravitational stiffness": not self.bogie.gravitational_stiffness}
        return tuple(name for name, true in found.items() if true)

    @property
    def speeds(self) -> tuple[float, ...]:
        """The running speeds [m/s] in rising order: one, several, or those at which a range is looked at first."""
        if isinstance(self.speed, SpeedRange):
            return self.speed.values
        return self.speed if isinstance(self.speed, tuple) else (self.speed,)

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
            allowed |= dict.fromkeys(VERTICAL, "car_body")
        if key not in allowed:
            raise ProblemError(why_absent(key, self.bogie.kind, self.parameters(), allowed))
        return allowed[key]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, with the keys of a problem file."""
        plain: dict[str, Any] = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        plain["bogie"] = {"kind": self.bogie.kind} | _given(self.bogie)
        if self.car_body is not None:
            plain["car_body"] = _given(self.car_body)
        plain["cases"] = {case.name: {change.key: change.written for change in case.changes} for case in self.cases}
        plain["conditions"] = self.conditions.written
        plain["requirements"] = written_requirements(self.requirements)
        catalogue = plain["design"].pop("catalogue")
        if catalogue:
            plain["design"]["catalogue"] = [damper.written for damper in self.design.catalogue]
        plain["uncertainty"] = written_distributions(self.uncertainty)
        return plain


_PARTS: Mapping[str, Any] = {"bogie": Bogie, "car_body": CarBody | None, "curve": Curve | None, "design": Design}


def _speed(given: Any) -> float | tuple[float, ...] | SpeedRange:
    """Return speeds as a problem holds them: a range may be given as a problem file has it."""
    if isinstance(given, SpeedRange):
        return given
    if not isinstance(given, Mapping):
        return as_speeds(given, SPEED.accept)
    unknown = next((key for key in given if key not in ("min", "max", "steps")), None)
    if unknown is not None:
        raise ProblemError(f"speed: {shown(given)} is no range: {unknown} is not known, it has min, max and steps")
    return SpeedRange(**given)


def _given(part: Bogie | CarBody) -> dict[str, Any]:
    """Return what was given of a part, by key."""
    found = {key: "rigid" if value == RIGID else float(value) for key, value in given_of(part).items()}
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
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return float(value) if isinstance(value, float) else value

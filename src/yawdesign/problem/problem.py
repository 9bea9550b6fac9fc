"""The problem: a bogie, the car body on it, its speeds, the curve it must pass, and what may be changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path
from typing import Any, Self, get_args

from .arguments import named, refused
from .bare_speeds import warn_of_bare_speeds
from .cases import Case, as_cases
from .catalogue_file import with_named_catalogue
from .changes import ChangedData, NewValue, changed
from .condition import CREEP_FACTOR, Conditions
from .consistency import EQUATIONS, Equations, misfits, present
from .diagnostics import Mistakes, ProblemError
from .distributions import Distribution, as_distributions
from .file_data import checked_data
from .notebook_view import NotebookView
from .parameters import VERTICAL, Bogie, CarBody, given_of
from .problem_text import problem_text
from .problem_workbook import problem_sheets
from .quantities import Written, exact
from .requirements import Requirement, as_requirements
from .running import SPEED, Curve, SpeedRange, as_speeds
from .table import Parameter, as_choice, as_text, key_of, shown
from .variables import Design, default_variables
from .whole_files import write_whole
from .workbook_writing import write_workbook
from .written_conditions import as_conditions
from .written_problem import in_plain_numbers, with_text_keys, written


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

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the problem that plain data describe.

        Parameters
        ----------
        data : mapping
            What `to_dict` returns, or what a problem file holds: numbers in SI or texts with a unit; a preset may be
            named, and a file with a catalogue, which is looked for in the current folder.

        Returns
        -------
        Problem

        Raises
        ------
        ProblemError
            With all mistakes.

        Examples
        --------
        >>> Problem.from_dict({"bogie": {"base": "table1"}, "speed": "250 km/h"}).bogie.K_m
        626480.0
        """
        if not isinstance(data, Mapping):
            raise refused("data", "a mapping, such as `to_dict` returns", data)
        return cls._of(ChangedData({key: value for key, value in data.items() if value is not None}), whole=False)

    @classmethod
    def _of(cls, new: ChangedData, *, whole: bool) -> Self:
        """Return the problem that changed data describe; a bare speed is doubted, a `whole` number too."""
        data = with_named_catalogue(with_text_keys(new.data))
        checked = checked_data(data)
        mistakes = [*new.mistakes, *(each.diagnostic for each in dict.fromkeys(checked.faults))]
        if mistakes:
            raise ProblemError(mistakes)
        warn_of_bare_speeds(data, whole=whole)
        return cls(**checked.parts)

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

    def replace(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Self:
        """Return a problem with other values.

        Parameters
        ----------
        changes : mapping, optional
            New values by name.
        **more
            The same: any key of a problem file. A name that stands alone is looked for in bogie, car body, curve and
            speed, and is the objective or the creep factor; others are dotted, ``{"design.variables.C_s.max": "2 MN
            s/m"}``. Values are as a problem file has them, or parts such as `Bogie`; None removes a key. The new value
            of a parameter takes the place of the conditions of its name.

        Returns
        -------
        Problem
            The changed problem.

        Raises
        ------
        ProblemError
            If a name is not known or a value is not accepted.

        Examples
        --------
        >>> import yawdesign as yd
        >>> problem = yd.table1().replace(C_s="1.2 MN s/m", speed="280 km/h", limit=0.1)
        >>> problem.replace({"design.variables.C_s.max": "2 MN s/m"}).design.variables["C_s"].max
        2000000.0
        """
        if not isinstance(changes, Mapping | None):
            raise refused("changes", "a mapping of names to values", changes)
        values = [
            NewValue(str(name), written(value), key_of(name)) for name, value in {**(changes or {}), **more}.items()
        ]
        new = changed({key: value for key, value in self._written.items() if value is not None}, values)
        return self._of(new, whole=True)

    @property
    def _written(self) -> dict[str, Any]:
        """The same with the keys of a problem file and exact numbers."""
        return {each.name: written(getattr(self, each.name)) or _EMPTY.get(each.name) for each in fields(self)}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold, with the keys of a problem file."""
        plain: dict[str, Any] = in_plain_numbers(self._written)
        return plain

    def to_yaml(self, path: str | PathLike[str] | None = None, *, replace: bool = False) -> str:
        """Return the problem as the text of a problem file, which reads as the same problem again.

        Parameters
        ----------
        path : path, optional
            File to write it to.
        replace : bool
            Whether another file may be replaced.

        Returns
        -------
        str
            YAML 1.2, in the units people use. Numbers have the decimals they were written with. The dampers of a
            catalogue stand in it.

        Raises
        ------
        ProblemError
            If there is a file and it may not be replaced, or the catalogue is larger than a problem file may be.

        Examples
        --------
        >>> import yawdesign as yd
        >>> print(yd.table1().replace(title="Slower", speed="280 km/h").to_yaml().splitlines()[1])
        title: Slower
        """
        text = problem_text(self._written)
        if path is not None:
            write_whole(Path(path), text.encode(), replace=replace)
        return text

    def to_excel(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write the problem as a workbook, which reads as the same problem again.

        Parameters
        ----------
        path : path
            Its name ends in .xlsx. The sheet ``problem`` has a row for each value, the sheet ``dampers`` those of a
            catalogue.
        replace : bool
            Whether another file may be replaced.

        Raises
        ------
        ProblemError
            If there is a file and it may not be replaced, or openpyxl is not installed (``yawdesign[excel]``).
        """
        write_workbook(path, problem_sheets(self.to_yaml()), replace=replace)


_EMPTY: Mapping[str, Any] = {"title": "", "cases": {}, "conditions": {}, "requirements": {}, "uncertainty": {}}
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


def _instance(value: object, kind: Any) -> None:
    if not isinstance(value, kind):
        expected = next(a for a in (kind, *get_args(kind)) if isinstance(a, type)).__name__
        raise ProblemError(f"{value!r} is not a {expected}")

"""Drafts of functions for other codes: named symbols go in, named expressions come out, with units and meanings."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import casadi as ca

from yawdesign.damper.design_space import JOINTED, LEAST
from yawdesign.problem import PARAMETERS, Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.parameters import parameter_keys
from yawdesign.problem.running import CURVE, SPEED
from yawdesign.problem.table import key_of


@dataclass(frozen=True)
class Port:
    """An input or an output of an exported function.

    Parameters
    ----------
    name : str
        The paper's symbol where there is one.
    unit : str
        SI; ``-`` for a plain number.
    meaning : str
        What it is, in a few words.
    shape : (int, int)
        Rows and columns; in C the columns stand one after the other.
    value : tuple of float
        Of an input: its value in the problem.
    rows, columns : tuple of str
        Of a matrix: what its rows and columns belong to.
    units : tuple of str
        Of a matrix whose entries differ in their unit: that of each entry, column by column; `unit` is then ``SI``.
    """

    name: str
    unit: str
    meaning: str
    shape: tuple[int, int] = (1, 1)
    value: tuple[float, ...] = ()
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    units: tuple[str, ...] = ()


@dataclass(frozen=True)
class Setting:
    """The parameters of a problem: which of them stay inputs, and the values of all.

    Parameters
    ----------
    values : mapping name -> float or None
        Bogie, speed ``v`` and curve in SI; None where the problem has no single value.
    open : tuple of str
        Names that stay inputs, in the order of `values`.
    model : mapping
        The keywords that choose the equations.
    load : str or None
        The load Q of the curve; None if the problem has no curve.
    top_speed : float
        The largest speed of the problem [m/s].
    """

    values: Mapping[str, float | None]
    open: tuple[str, ...]
    model: Mapping[str, str]
    load: str | None
    top_speed: float

    @classmethod
    def of(cls, problem: Problem, inputs: Collection[str] | None) -> "Setting":
        """Return the setting of a problem; without `inputs` everything stays an input."""
        p, speeds = problem.bogie.parameters(), problem.speeds
        values: dict[str, float | None] = {key: p.get(key) for key in parameter_keys(problem.bogie.kind)}
        values["v"] = speeds[0] if len(speeds) == 1 else None
        values |= {key: getattr(problem.curve, key) for key in CURVE if problem.curve is not None}
        values = {key: None if value is None else float(value) for key, value in values.items()}
        wanted = set(values) if inputs is None else _known(inputs, values)
        load = None if problem.curve is None else problem.curve.load
        return cls(values, tuple(key for key in values if key in wanted), problem.model, load, float(speeds[-1]))

    @property
    def bogie(self) -> tuple[str, ...]:
        """The parameters on which the characteristic polynomial depends, beside C_s."""
        return tuple(key for key in self.values if key not in CURVE and key != "C_s")

    @property
    def curves(self) -> bool:
        """Whether there is a rotational resistance: a curve, and an axle load that is not fixed at 0."""
        return self.load is not None and ("W" in self.open or self.values["W"] != 0)

    @property
    def examples(self) -> dict[str, float]:
        """Values of all parameters; where the problem has none those of the paper, and its largest speed."""
        usual = {"C_s": float(PARAMETERS["C_s"].check(PARAMETERS["C_s"].example)), "v": self.top_speed}
        values = {key: usual[key] if value is None else value for key, value in self.values.items()}
        return values | {key: LEAST for key in JOINTED.intersection(self.open) if values[key] == 0}


def _known(inputs: Collection[str], allowed: Collection[str]) -> set[str]:
    names = ["v" if name == "speed" else key_of(name) for name in inputs]
    mistakes = Mistakes()
    for name in names:
        with mistakes.under(f"inputs: {name}"):
            if name not in allowed:
                raise ProblemError(unknown_key(name, allowed))
    mistakes.report()
    return set(names)


def per(unit: str, divisor: str) -> str:
    """Return a unit divided by another.

    Examples
    --------
    >>> per("N·s/m", "kg"), per("rad/s", "s"), per("m", "m"), per("1/s", "-"), per("-", "N/m")
    ('N·s/m/kg', 'rad/s²', '-', '1/s', '1/(N/m)')
    """
    if unit == divisor or divisor == "-":
        return "-" if unit == divisor else unit
    if unit.endswith("/s") and divisor == "s":
        return f"{unit}²"
    bracketed = f"({divisor})" if set(divisor) & set("/·") else divisor
    return f"{'1' if unit == '-' else unit}/{bracketed}"


def described(name: str) -> tuple[str, str]:
    """Return SI unit and meaning of a parameter."""
    row = SPEED if name == "v" else PARAMETERS.get(name) or CURVE[name]
    return row.si or "-", row.meaning


@dataclass
class Draft:
    """One function while it is being written.

    Parameters
    ----------
    setting : Setting
        Says which parameters are symbols and which are numbers.
    symbols : type
        `casadi.SX`, or `casadi.MX` for a function with a rootfinder in it.
    """

    setting: Setting
    symbols: Any = ca.SX
    inputs: list[tuple[Port, Any]] = field(default_factory=list)
    outputs: list[tuple[Port, Any]] = field(default_factory=list)
    baked: dict[str, float] = field(default_factory=dict)

    def parameters(self, names: Sequence[str]) -> dict[str, Any]:
        """Return a symbol for each parameter that stays an input, a number for each other one."""
        mistakes = Mistakes()
        values = {}
        for name in names:
            with mistakes.under(name):
                values[name] = self._parameter(name)
        mistakes.report()
        return values

    def _parameter(self, name: str) -> Any:
        if name in self.setting.open:
            return self.input(name, *described(name), self.setting.examples[name])
        value = self.setting.values[name]
        if value is None:
            raise ProblemError("has no single value in the problem: give one, or let it be an input")
        self.baked[name] = value
        return value

    def input(self, name: str, unit: str, meaning: str, *value: float) -> Any:
        """Add an input, a column with the length of the value, and return its symbol."""
        symbol = self.symbols.sym(name, len(value))
        self.inputs.append((Port(name, unit, meaning, (len(value), 1), value), symbol))
        return symbol

    def output(self, name: str, unit: str, meaning: str, value: Any, **labels: Any) -> None:
        """Add an output: a matrix, or a list that becomes a column; entries are expressions or numbers."""
        matrix = ca.vertcat(*value) if isinstance(value, (list, tuple)) else value
        matrix = ca.densify(self.symbols(matrix))
        self.outputs.append((Port(name, unit, meaning, tuple(matrix.shape), **labels), matrix))

    def function(self, name: str) -> ca.Function:
        """Return the function."""
        return ca.Function(
            name,
            [symbol for _, symbol in self.inputs],
            [expression for _, expression in self.outputs],
            [port.name for port, _ in self.inputs],
            [port.name for port, _ in self.outputs],
        )

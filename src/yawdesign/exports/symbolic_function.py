"""A function while it is written: named symbols go in, named expressions come out, with units and meanings."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import casadi as ca

from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.problem import PARAMETERS, ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.running import CURVE, SPEED
from yawdesign.vehicle.vehicle import Vehicle


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


@dataclass
class SymbolicFunction:
    """A function whose inputs and outputs are added one by one.

    Parameters
    ----------
    parametric : ParametricModel
        Says which parameters are symbols and which are numbers.
    symbols : type
        `casadi.SX`, or `casadi.MX` for a function with a rootfinder in it.
    meaning : str, optional
        What it computes, where that is not what its builder says.
    """

    parametric: ParametricModel
    symbols: Any = ca.SX
    meaning: str = ""
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
        if name in self.parametric.free:
            return self.input(name, *described(name), self.parametric.examples[name])
        value = self.parametric.values[name]
        if value is None:
            raise ProblemError("has no single value in the problem: give one, or let it be an input")
        self.baked[name] = value
        return value

    def vehicle(self) -> Vehicle:
        """Return the vehicle of these symbols and numbers, all of which become known to the function."""
        return self.parametric.model.at(self.parameters((*self.parametric.names, "C_s")))

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


def described(name: str) -> tuple[str, str]:
    """Return SI unit and meaning of a parameter."""
    row = SPEED if name == "v" else PARAMETERS.get(name) or CURVE[name]
    return row.si or "-", row.meaning


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

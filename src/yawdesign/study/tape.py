"""A CasADi Function as a straight line of array operations, for many points at once.

CasADi's own virtual machine goes through the graph once for every point. Here every operation of the graph runs on a
block of points that stays in the processor's cache: with NumPy, or, where a C compiler is at hand, in a C function
whose scalars are vectors of points. Both do the same operations in the same order and give the same bits.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from yawdesign.study import compiled
from yawdesign.study.compiled import Run

Float = NDArray[np.float64]
BLOCK = 8192  # points; long enough that NumPy's calls cost little, and a row still fits the innermost caches
MANY = 20_000  # points from which on a compilation of about a second pays

BINARY = {
    ca.OP_ADD: (np.add, "{0} + {1}"),
    ca.OP_SUB: (np.subtract, "{0} - {1}"),
    ca.OP_MUL: (np.multiply, "{0} * {1}"),
    ca.OP_DIV: (np.divide, "{0} / {1}"),
    ca.OP_LT: (np.less, "LESS({0}, {1})"),
}
UNARY: dict[int, tuple[Callable[..., Any], str]] = {
    ca.OP_NEG: (np.negative, "-{0}"),
    ca.OP_FABS: (np.absolute, "SIZE({0})"),
    ca.OP_INV: (lambda x, *out: np.divide(1.0, x, *out), "(ZERO + 1.0) / {0}"),
}
# Operations that CasADi writes with one operand and that are one with two.
DOUBLED = {ca.OP_SQ: ca.OP_MUL, ca.OP_TWICE: ca.OP_ADD}


@dataclass(frozen=True)
class Step:
    """One operation: ``register[target] = operation(register[i] for i in sources)``."""

    operation: int
    target: int
    sources: tuple[int, ...]


class Tape:
    """The operations of a CasADi Function of scalars.

    Parameters
    ----------
    function : casadi.Function
        Made of SX, of which every input is a scalar.

    Attributes
    ----------
    inputs : tuple of str
        Names of the inputs, in order.
    size : int
        Number of values that come out for each point.
    """

    def __init__(self, function: ca.Function) -> None:
        self.inputs = tuple(function.name_in())
        self.size = function.nnz_out()
        self.constants: dict[int, float] = {}
        self.steps: list[Step] = []
        self.results = [-1] * self.size
        self._record(function)

    def _record(self, function: ca.Function) -> None:
        """Read the instructions, giving every value a register of its own."""
        offsets = np.cumsum([0, *(function.nnz_out(k) for k in range(function.n_out()))])
        place: dict[int, int] = {}
        count = len(self.inputs)
        for k in range(function.n_instructions()):
            operation, into = function.instruction_id(k), function.instruction_output(k)
            if operation == ca.OP_OUTPUT:
                self.results[offsets[into[0]] + into[1]] = place[function.instruction_input(k)[0]]
            elif operation == ca.OP_INPUT:
                place[into[0]] = function.instruction_input(k)[0]
            else:
                if operation == ca.OP_CONST:
                    self.constants[count] = function.instruction_constant(k)
                else:
                    sources = tuple(place[i] for i in function.instruction_input(k))
                    self._add(operation, count, sources)
                place[into[0]] = count
                count += 1
        self.registers = count

    def _add(self, operation: int, target: int, sources: tuple[int, ...]) -> None:
        if operation in DOUBLED:
            operation, sources = DOUBLED[operation], (sources[0], sources[0])
        if operation not in BINARY and operation not in UNARY:
            raise NotImplementedError(f"no array operation for CasADi's operation {operation}")
        self.steps.append(Step(operation, target, sources))

    def __call__(self, values: Mapping[str, Any], *, threads: int = 1) -> Float:
        """Return the outputs at many points.

        Parameters
        ----------
        values : mapping
            A number, or an array with one value for each point, for every input.
        threads : int
            Among how many threads the points are shared.

        Returns
        -------
        ndarray, shape (size, points)
        """
        arguments = [np.ascontiguousarray(values[name], dtype=float) for name in self.inputs]
        points = max((x.size for x in arguments), default=1)
        out = np.empty((self.size, points))
        run: Run = (self._compiled if points >= MANY else None) or self._interpret
        edges = shares(points, threads, BLOCK)
        if len(edges) == 1:
            run(arguments, out, *edges[0])
        else:
            with ThreadPoolExecutor(len(edges)) as pool:
                for done in [pool.submit(run, arguments, out, *edge) for edge in edges]:
                    done.result()
        return out

    @cached_property
    def _compiled(self) -> Run | None:
        run = compiled.load(self.source())
        return run if run and self._agrees(run) else None

    def _agrees(self, run: Run) -> bool:
        """Return whether compiled code gives the bits of NumPy at points that cover full and broken vectors."""
        random = np.random.default_rng(0)
        arguments = [random.uniform(0.5, 2.0, 21 if k % 3 else 1) for k in range(len(self.inputs))]
        one, two = np.empty((self.size, 21)), np.empty((self.size, 21))
        run(arguments, one, 0, 21)
        self._interpret(arguments, two, 0, 21)
        return np.array_equal(one, two, equal_nan=True)

    def source(self) -> str:
        """Return the operations in C, on vectors of points."""
        lines = [f"  const vector r{k} = load(in[{k}], stride[{k}], point, end);" for k in range(len(self.inputs))]
        lines += [f"  const vector r{k} = ZERO + {_literal(x)};" for k, x in self.constants.items()]
        for step in self.steps:
            text = (BINARY if len(step.sources) == 2 else UNARY)[step.operation][1]
            lines.append(f"  const vector r{step.target} = {text.format(*(f'r{i}' for i in step.sources))};")
        lines += [f"  store(out + {k} * points, r{register}, point, end);" for k, register in enumerate(self.results)]
        return "\n".join(lines)

    def _interpret(self, arguments: Sequence[Float], out: Float, start: int, end: int) -> None:
        """Run the operations with NumPy, block by block."""
        with np.errstate(all="ignore"):
            calls, inputs, results = self._bind(arguments, min(BLOCK, end - start))
            for first in range(start, end, BLOCK):
                last = min(first + BLOCK, end)
                for k, row in inputs.items():
                    row[: last - first] = arguments[k][first:last]
                for function, operands in calls:
                    function(*operands)
                for k, row in enumerate(results):
                    out[k, first:last] = row[: last - first] if row.size > 1 else row

    def _bind(self, arguments: Sequence[Float], length: int) -> tuple[list[Any], dict[int, Float], list[Float]]:
        """Return the operations bound to rows of a buffer, the rows of the inputs, and those of the results.

        What is the same for all points is computed here. A row is used again after the last step that reads it.
        """
        same = {k: x.reshape(()) for k, x in enumerate(arguments) if x.size == 1}
        same |= {k: np.array(x) for k, x in self.constants.items()}
        inputs = {k: np.ones(length) for k, x in enumerate(arguments) if x.size > 1}
        place: dict[int, Any] = same | inputs
        free: dict[str, list[Any]] = {"d": [], "?": []}
        last_use = {i: k for k, step in enumerate(self.steps) for i in step.sources}
        kept, calls = {*self.results, *inputs}, []
        for k, step in enumerate(self.steps):
            function = (BINARY if len(step.sources) == 2 else UNARY)[step.operation][0]
            operands = [place[i] for i in step.sources]
            if all(i in same for i in step.sources):
                same[step.target] = place[step.target] = np.asarray(function(*operands), dtype=float)
                continue
            kind = self._kind(step, operands)
            row = place[step.target] = free[kind].pop() if free[kind] else np.ones(length, dtype=kind)
            calls.append((_as_numbers(function, operands) if kind == "d" else function, (*operands, row)))
            for i in {i for i in step.sources if last_use[i] == k and i not in same and i not in kept}:
                free[place[i].dtype.char].append(place[i])
        return calls, inputs, [place[k] for k in self.results]

    @staticmethod
    def _kind(step: Step, operands: Sequence[Any]) -> str:
        """Return the type of a result: comparisons and products of them need one byte, not eight."""
        logical = step.operation == ca.OP_LT or (step.operation == ca.OP_MUL and all(x.dtype == bool for x in operands))
        return "?" if logical else "d"


def _as_numbers(function: Callable[..., Any], operands: Sequence[Any]) -> Callable[..., Any]:
    """Return the function such that it takes comparisons for numbers: NumPy's sum of two of them is one of them."""
    return partial(function, dtype=float) if any(x.dtype == bool for x in operands) else function


def shares(points: int, threads: int, least: int) -> list[tuple[int, int]]:
    """Return the first and the last point but one of every thread, at least so many points each."""
    parts = max(1, min(threads, points // least))
    size = -(-points // (parts * least)) * least
    return [(first, min(first + size, points)) for first in range(0, points, size)]


def _literal(value: float) -> str:
    return float(value).hex()

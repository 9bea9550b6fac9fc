"""A straight line of operations on arrays, for many points at once.

CasADi's own virtual machine goes through the graph once for every point. Here every operation of the graph runs on a
block of points that stays in the processor's cache: with NumPy, or, where a C compiler is at hand, in a C function
whose scalars are vectors of points. Both do the same operations in the same order and give the same bits.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from threading import Lock, local
from typing import Any

import casadi as ca
import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.hunting.many import compiled
from yawdesign.hunting.many.c_statements import Statements
from yawdesign.hunting.many.compiled import Run
from yawdesign.hunting.many.recording import Operation, Recording

BLOCK = 8192  # points; long enough that NumPy's calls cost little, and a row still fits the innermost caches
MANY = 100_000  # points after which a compilation, about half a second for a single bogie, has paid
LOOK = 0.2  # of these points: after so many one that was kept is looked for


class Tape:
    """The operations of a recording, run on many points.

    Parameters
    ----------
    recording : Recording
        What is to be done.

    Attributes
    ----------
    inputs : tuple of str
        Names of the inputs, in order.
    size : int
        Number of values that come out for each point.
    """

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        self.inputs, self.constants, self.steps, self.results = recording
        self.size = len(self.results)
        self._lock, self._asked, self._tried = Lock(), 0, 0
        self._fast: Run | None = None
        self._own = local()

    def __call__(self, values: Mapping[str, Any]) -> Float:
        """Return the outputs at many points.

        Parameters
        ----------
        values : mapping
            A number, or an array with one value for each point, for every input. Others may be there: they are not
            read, but count as points.

        Returns
        -------
        ndarray, shape (size, points)
        """
        arguments = [np.ascontiguousarray(values[name], dtype=float) for name in self.inputs]
        points = max(np.size(x) for x in values.values())
        out = np.empty((self.size, points))
        self._runner(points)(arguments, out, 0, points)
        return out

    def _runner(self, points: int) -> Run:
        """Return how to run: compiled, once so many points were asked for that this has paid."""
        with self._lock:
            self._asked += points
            # The time of a compilation has a part that does not grow with the tape, the time of a point has none.
            many = MANY * (0.4 + 1000 / max(1, len(self.steps)))
            wanted = int(self._asked >= LOOK * many) + int(self._asked >= many)
            if wanted > self._tried and not self._fast:
                self._tried = wanted
                run = compiled.load(self.source(), compiling=wanted == 2)
                self._fast = run if run and self._agrees(run) else None
                if run and not self._fast:
                    compiled.note("it does not give the numbers of NumPy")
            return self._fast or self._interpret

    def _agrees(self, run: Run) -> bool:
        """Return whether compiled code gives the bits of NumPy at points that cover full and broken vectors."""
        random = np.random.default_rng(0)
        arguments = [random.uniform(0.5, 2.0, 21 if k % 3 else 1) for k in range(len(self.inputs))]
        one, two = np.empty((self.size, 21)), np.empty((self.size, 21))
        run(arguments, one, 0, 21)
        self._interpret(arguments, two, 0, 21)
        return np.array_equal(one, two, equal_nan=True)

    def source(self) -> Statements:
        """Return the operations in C, on vectors of points."""
        return Statements(len(self.inputs), self.constants, self.steps, self.results)

    def _interpret(self, arguments: Sequence[Float], out: Float, start: int, end: int) -> None:
        """Run the operations with NumPy."""
        length = min(BLOCK, 1 << (end - start - 1).bit_length())
        key = length, tuple(x.size == 1 for x in arguments)
        programs: dict[Any, _Bound] = vars(self._own).setdefault("programs", {})
        if key not in programs:
            programs[key] = _Bound(self, *key)
        programs[key](arguments, out, start, end)


class _Bound:
    """The operations of a tape bound to the rows of a buffer, so that a block of points costs one NumPy call for each.

    Not to be shared by threads.

    Parameters
    ----------
    tape : Tape
        What is to be done.
    length : int
        Most points of a block.
    uniform : collection of bool
        For every input, whether it is the same for all points; the inputs are the first registers.
    """

    def __init__(self, tape: Tape, length: int, uniform: Sequence[bool]) -> None:
        self.length = length
        self._place: dict[int, Any] = {k: np.ones(() if same else length) for k, same in enumerate(uniform)}
        self._inputs = dict(self._place)
        self._place |= {k: np.array(x) for k, x in tape.constants.items()}
        self._calls: list[tuple[Callable[..., Any], tuple[Any, ...]]] = []
        self._bind(tape.steps, {*tape.results, *self._place})
        self._results = [self._place[k] for k in tape.results]

    def _bind(self, steps: Sequence[Operation], kept: set[int]) -> None:
        """Give every step its rows. A row is used again after the last step that reads it."""
        last_use = {i: k for k, step in enumerate(steps) for i in step.sources}
        free: dict[tuple[Any, str], list[Any]] = {}
        for k, step in enumerate(steps):
            operands = [self._place[i] for i in step.sources]
            shape = np.broadcast_shapes(*(x.shape for x in operands))
            logical = _is_logical(step.code, operands)
            kind = shape, "?" if logical else "d"
            spare = free.setdefault(kind, [])
            row = self._place[step.target] = spare.pop() if spare else np.ones(shape, dtype=kind[1])
            function = step.kinds[0]
            self._calls.append((function if logical else _as_numbers(function, operands), (*operands, row)))
            for i in {i for i in step.sources if last_use[i] == k and i not in kept}:
                x = self._place[i]
                free.setdefault((x.shape, x.dtype.char), []).append(x)

    def __call__(self, arguments: Sequence[Float], out: Float, start: int, end: int) -> None:
        """Run all steps on the points from start to end but one."""
        with np.errstate(all="ignore"):
            for first in range(start, end, self.length):
                last = min(first + self.length, end)
                for k, row in self._inputs.items():
                    x = arguments[k]
                    if row.ndim:
                        row[: last - first] = x[first:last]
                    else:
                        row[()] = x.reshape(-1)[0]
                for function, operands in self._calls:
                    function(*operands)
                for k, row in enumerate(self._results):
                    out[k, first:last] = row[: last - first] if row.ndim else row


def _is_logical(code: int, operands: Sequence[Any]) -> bool:
    """Return whether the result is true or false: a comparison, or a product of such."""
    return code == ca.OP_LT or (code == ca.OP_MUL and all(x.dtype == bool for x in operands))


def _as_numbers(function: Callable[..., Any], operands: Sequence[Any]) -> Callable[..., Any]:
    """Return the function such that it takes comparisons for numbers: NumPy's sum of two of them is one of them."""
    return partial(function, dtype=float) if any(x.dtype == bool for x in operands) else function

"""Operations bound to the rows of a buffer, so that a block of points costs one NumPy call an operation and no more."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Float


class Step(NamedTuple):
    """One operation: ``register[target] = function(register[i] for i in sources)``.

    A logical step gives true and false, and a product of those is logical too.
    """

    function: Callable[..., Any]
    target: int
    sources: tuple[int, ...]
    compares: bool
    multiplies: bool


class Program:
    """Steps bound to buffers of a certain length; not to be shared by threads.

    Parameters
    ----------
    steps : sequence of Step
        In the order in which they are to be done.
    constants : mapping register -> value
        Known before.
    uniform : collection of bool
        For every input, whether it is the same for all points; the inputs are the first registers.
    results : sequence of int
        Registers that are asked for.
    length : int
        Most points of a block.
    """

    def __init__(
        self,
        steps: Sequence[Step],
        constants: Mapping[int, float],
        uniform: Sequence[bool],
        results: Sequence[int],
        length: int,
    ) -> None:
        self.length = length
        self._place: dict[int, Any] = {k: np.ones(() if same else length) for k, same in enumerate(uniform)}
        self._inputs = dict(self._place)
        self._place |= {k: np.array(x) for k, x in constants.items()}
        self._calls: list[tuple[Callable[..., Any], tuple[Any, ...]]] = []
        self._bind(steps, {*results, *self._inputs, *constants})
        self._results = [self._place[k] for k in results]

    def _bind(self, steps: Sequence[Step], kept: set[int]) -> None:
        """Give every step its rows. A row is used again after the last step that reads it."""
        last_use = {i: k for k, step in enumerate(steps) for i in step.sources}
        free: dict[tuple[Any, str], list[Any]] = {}
        for k, step in enumerate(steps):
            operands = [self._place[i] for i in step.sources]
            shape = np.broadcast_shapes(*(x.shape for x in operands))
            logical = step.compares or (step.multiplies and all(x.dtype == bool for x in operands))
            kind = shape, "?" if logical else "d"
            spare = free.setdefault(kind, [])
            row = self._place[step.target] = spare.pop() if spare else np.ones(shape, dtype=kind[1])
            self._calls.append((step.function if logical else _as_numbers(step.function, operands), (*operands, row)))
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


def _as_numbers(function: Callable[..., Any], operands: Sequence[Any]) -> Callable[..., Any]:
    """Return the function such that it takes comparisons for numbers: NumPy's sum of two of them is one of them."""
    return partial(function, dtype=float) if any(x.dtype == bool for x in operands) else function

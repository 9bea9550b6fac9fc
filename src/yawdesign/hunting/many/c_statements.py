"""The C code of a straight line of operations on vectors of points.

A compiler's time grows faster than the function it compiles, so a long line is cut into functions. What one of them
leaves to a later one stands in an array, in which a place is used again after its last reader.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

LENGTH = 2500  # operations that stand in one function at most; those of a single bogie do

PART = "static __attribute__((noinline)) void part%d(vector *restrict x) {\n%s\n}\n"


class Statements:
    """C code of operations: functions, and the statements for a vector of points that call them.

    Parameters
    ----------
    inputs : int
        How many inputs there are; they are the first registers.
    constants : mapping register -> float
        Registers that never change.
    steps : sequence
        Operations, each with the register of its result, ``target``, those of its operands, ``sources``, and in
        ``kinds`` its text in C last.
    results : sequence of int
        Registers that come out.
    """

    def __init__(
        self, inputs: int, constants: Mapping[int, float], steps: Sequence[Any], results: Sequence[int]
    ) -> None:
        self._inputs, self._constants, self._results = inputs, constants, results
        count = max(1, -(-len(steps) // LENGTH))
        size = max(1, -(-len(steps) // count))
        self._parts = [steps[k : k + size] for k in range(0, len(steps), size)]
        self._place: dict[int, int] = {k: place for place, k in enumerate([*range(inputs), *constants])}
        self.places = len(self._place)
        self.functions = "\n".join(self._functions())

    def _functions(self) -> Iterator[str]:
        made_in = {step.target: k for k, part in enumerate(self._parts) for step in part}
        last_in = {i: k for k, part in enumerate(self._parts) for step in part for i in step.sources}
        last_in |= dict.fromkeys([*self._results, *self._place], len(self._parts))
        free: list[int] = []
        for k, part in enumerate(self._parts):
            read = dict.fromkeys(i for step in part for i in step.sources if made_in.get(i) != k)
            left = [step.target for step in part if last_in.get(step.target, -1) > k]
            lines = [f"  const vector r{i} = x[{self._place[i]}];" for i in read]
            lines += [f"  const vector r{step.target} = {_text(step)};" for step in part]
            # All is read before anything is written: a place that is read here for the last time is free.
            free += [self._place[i] for i in read if last_in[i] == k]
            for register in left:
                if not free:
                    free.append(self.places)
                    self.places += 1
                self._place[register] = free.pop()
                lines.append(f"  x[{self._place[register]}] = r{register};")
            yield PART % (k, "\n".join(lines))

    @property
    def once(self) -> str:
        """What stands before the loop over the points: the array and its constants."""
        lines = [f"  vector x[{self.places}];"]
        lines += [f"  x[{self._place[k]}] = ZERO + {float(value).hex()};" for k, value in self._constants.items()]
        return "\n".join(lines)

    @property
    def each(self) -> str:
        """What is done for each vector of points."""
        lines = [f"    x[{k}] = load(in[{k}], stride[{k}], point, end);" for k in range(self._inputs)]
        lines += [f"    part{k}(x);" for k in range(len(self._parts))]
        lines += [
            f"    store(out + {k} * points, x[{self._place[register]}], point, end);"
            for k, register in enumerate(self._results)
        ]
        return "\n".join(lines)


def _text(step: Any) -> str:
    return str(step.kinds[-1].format(*(f"r{i}" for i in step.sources)))

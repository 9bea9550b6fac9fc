"""What a CasADi Function of scalars does, as a list of operations that can be kept in a file."""

import io
from collections.abc import Callable
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

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


class Operation(NamedTuple):
    """One operation of the graph: CasADi's code for it, the register of the result, those of its operands."""

    code: int
    target: int
    sources: tuple[int, ...]

    @property
    def kinds(self) -> tuple[Callable[..., Any], str]:
        """What it is in NumPy and in C."""
        return (BINARY if len(self.sources) == 2 else UNARY)[self.code]


class Recording(NamedTuple):
    """Operations on registers, of which the inputs are the first.

    Parameters
    ----------
    inputs : tuple of str
        Names of the inputs, in order.
    constants : dict register -> float
        Registers that never change.
    steps : list of Operation
        In order.
    results : list of int
        Registers that come out.
    """

    inputs: tuple[str, ...]
    constants: dict[int, float]
    steps: list[Operation]
    results: list[int]


def record(function: ca.Function) -> Recording:
    """Return the operations of a function made of SX, of which every input is a scalar.

    Every value gets a register of its own; what is there twice is computed once.
    """
    recording = Recording(tuple(function.name_in()), {}, [], [-1] * function.nnz_out())
    offsets = np.cumsum([0, *(function.nnz_out(k) for k in range(function.n_out()))])
    known: dict[tuple[Any, ...], int] = {}
    place: dict[int, int] = {}
    for k in range(function.n_instructions()):
        operation, into = function.instruction_id(k), function.instruction_output(k)
        sources = function.instruction_input(k)
        if operation == ca.OP_OUTPUT:
            recording.results[offsets[into[0]] + into[1]] = place[sources[0]]
        elif operation == ca.OP_INPUT:
            place[into[0]] = sources[0]
        else:
            operands = tuple(place[i] for i in sources)
            constant = function.instruction_constant(k) if operation == ca.OP_CONST else None
            key = operation, repr(constant), operands  # -0.0 is another constant than 0.0
            if key not in known:
                known[key] = count = len(recording.inputs) + len(known)
                if constant is not None:
                    recording.constants[count] = constant
                else:
                    recording.steps.append(_operation(operation, count, operands))
            place[into[0]] = known[key]
    return recording


def _operation(code: int, target: int, sources: tuple[int, ...]) -> Operation:
    if code in DOUBLED:
        code, sources = DOUBLED[code], (sources[0], sources[0])
    if code not in (BINARY if len(sources) == 2 else UNARY):
        raise NotImplementedError(f"no array operation for CasADi's operation {code}")
    return Operation(code, target, sources)


def packed(recording: Recording) -> bytes:
    """Return a recording as the content of a file."""
    inputs, constants, steps, results = recording
    content = io.BytesIO()
    np.savez(
        content,
        inputs=np.array(inputs, dtype=str),
        places=np.array([*constants], dtype=np.int32),
        constants=np.array([*constants.values()], dtype=float),
        steps=np.array([(code, target, *sources, -1)[:4] for code, target, sources in steps], dtype=np.int32),
        results=np.array(results, dtype=np.int32),
    )
    return content.getvalue()


def unpacked(content: bytes) -> Recording:
    """Return the recording of a file.

    Raises
    ------
    ValueError, OSError, KeyError, zipfile.BadZipFile, NotImplementedError
        If it is none.
    """
    with np.load(io.BytesIO(content), allow_pickle=False) as file:
        rows = file["steps"].tolist()
        return Recording(
            inputs=tuple(file["inputs"].tolist()),
            constants=dict(zip(file["places"].tolist(), file["constants"].tolist(), strict=True)),
            steps=[_operation(code, target, (a, b) if b >= 0 else (a,)) for code, target, a, b in rows],
            results=file["results"].tolist(),
        )

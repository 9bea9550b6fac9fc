"""Header, self-test, example and Makefile that go with the C source of exported functions."""

import math
from collections.abc import Iterator, Mapping, Sequence
from string import Template

from yawdesign.exports.file_contents import ExportNames
from yawdesign.exports.functions import Documented, work_sizes
from yawdesign.exports.symbolic_function import Port
from yawdesign.exports.templates import EXAMPLE, HEADER, MAKEFILE, SELF_TEST
from yawdesign.problem.characters import printable

LARGE = 2_000_000  # characters of a C source with functions so long that GCC optimises them for many minutes


def ascii_text(text: str) -> str:
    """Return a text in printable ASCII on one line, which neither begins nor ends a comment."""
    for sign, plain in {"·": " ", "²": "^2"}.items():
        text = text.replace(sign, plain)
    return printable(text).encode("ascii", "replace").decode().replace("*/", "* /").replace("/*", "/ *")


def header(functions: Mapping[str, Documented], about: str, names: ExportNames) -> str:
    """Return the header: what goes in and out, names of the places, sizes of the work vectors, and values to start."""
    blocks = "\n".join(_block(names.symbol(name), f) for name, f in functions.items())
    return Template(HEADER).substitute(about=ascii_text(about), functions=blocks, guard=names.guard)


def signature(s: str) -> str:
    """Return how a function is declared in C."""
    return f"int {s}(const casadi_real** arg, casadi_real** res, casadi_int* iw, casadi_real* w, int mem)"


def vector_sizes(s: str, f: Documented) -> dict[str, int]:
    """Return the lengths of the vectors that a function is called with; none is zero, which C does not allow."""
    return {size: max(1, value) for size, value in work_sizes(s, f.function).items()}


def _block(s: str, f: Documented) -> str:
    lines = [
        f"/* {ascii_text(f.meaning)}",
        " *",
        *_described("in", f.inputs),
        " *",
        *_described("out", f.outputs),
        " */",
    ]
    lines.append(f"{signature(s)};")
    lines.append(f"int {s}_work(casadi_int* sz_arg, casadi_int* sz_res, casadi_int* sz_iw, casadi_int* sz_w);")
    lines += [f"casadi_int {s}_n_in(void);", f"casadi_int {s}_n_out(void);"]
    lines += [f"const char* {s}_name_{way}(casadi_int i);" for way in ("in", "out")]
    lines += [f"const casadi_int* {s}_sparsity_{way}(casadi_int i); /* rows, columns, ... */" for way in ("in", "out")]
    lines += [_places(s, "in", f.inputs), _places(s, "out", f.outputs)]
    lines += [f"#define {s}_SZ_{size.upper()} {value}" for size, value in vector_sizes(s, f).items()]
    lines.append(
        f"#define {s}_VALUES {_numbers([x for port in f.inputs for x in port.value])} /* inputs, the problem's */"
    )
    return "\n".join(lines) + "\n"


def _described(way: str, ports: Sequence[Port]) -> Iterator[str]:
    for place, port in enumerate(ports):
        size = "" if port.shape == (1, 1) else f" ({port.shape[0]} x {port.shape[1]})"
        unit = "units in the manifest" if port.units else ascii_text(port.unit)
        yield f" * {way:>3} {place:>2}  {port.name}{size} [{unit}] {ascii_text(port.meaning)}"


def _places(s: str, way: str, ports: Sequence[Port]) -> str:
    names = [f"{s}_{way}_{port.name} = {place}" for place, port in enumerate(ports)]
    return f"enum {{ {', '.join([*names, f'{s}_{way}_count = {len(ports)}'])} }};"


def _numbers(values: Sequence[float]) -> str:
    return "{" + ", ".join(_number(x) for x in values or [0.0]) + "}"


def _number(x: float | None) -> str:
    if x is None or math.isnan(x):
        return "NAN"
    return repr(float(x)) if math.isfinite(x) else ("INFINITY" if x > 0 else "-INFINITY")


def self_test_source(tests: Mapping[str, Mapping[str, Mapping[str, Sequence[float]]]], names: ExportNames) -> str:
    """Return a C program that runs all self-test vectors and prints what differs."""
    cases, rows = [], []
    for name, test in tests.items():
        for way in ("inputs", "outputs"):
            flat = [x for values in test[way].values() for x in values]
            cases.append(f"static const double {name}_{way}[] = {_numbers(flat)};")
        s = names.symbol(name)
        calls = ", ".join(
            s + end for end in ("", "_work", "_n_in", "_n_out", "_sparsity_in", "_sparsity_out", "_name_out")
        )
        sizes = ", ".join(f"{s}_SZ_{size}" for size in ("ARG", "RES", "IW", "W"))
        rows.append(f'  {{"{name}", {calls}, {{{sizes}}}, {name}_inputs, {name}_outputs}},')
    return Template(SELF_TEST).substitute(cases="\n".join(cases), rows="\n".join(rows), header=names.header)


def example_source(name: str, f: Documented, names: ExportNames) -> str:
    """Return a C program that evaluates one function with inputs from the command line."""
    first = next((port.name for port in f.inputs), "name")
    return Template(EXAMPLE).substitute(name=name, s=names.symbol(name), first=first, header=names.header)


def makefile(names: ExportNames, source: str) -> str:
    """Return the Makefile for a C source."""
    # Of so long a source gcc notes at each build that it no longer looks at its indentation.
    optimised = "-O2" if len(source) < LARGE else "-O0 -Wno-misleading-indentation"
    return Template(MAKEFILE).substitute(prefix=names.prefix, optimised=optimised)

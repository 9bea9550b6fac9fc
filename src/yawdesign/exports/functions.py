"""Named CasADi Functions of a problem, with documented inputs and outputs."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import casadi as ca
import numpy as np

from yawdesign.exports.builders import BUILDERS
from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.exports.symbolic_function import Port, SymbolicFunction
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, Chosen, chosen
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes, suggestion
from yawdesign.problem.result import plain

ROOTFINDING = frozenset({"critical_damping"})  # a rootfinder is no operation between numbers: MX instead of SX
SOLVED = 1e-10  # largest residual of a solution
SelfTest = dict[str, dict[str, list[float]]]

PREAMBLE = """\
#if defined(__GNUC__) && !defined(MATLAB_MEX_FILE)
#pragma GCC diagnostic ignored "-Wunused-const-variable" /* tables that only the MEX gateway reads */
#endif
"""


@dataclass(frozen=True)
class Documented:
    """A function and what its inputs and outputs are.

    Parameters
    ----------
    function : casadi.Function
        The function itself.
    meaning : str
        What it computes.
    inputs, outputs : tuple of Port
        In the order of the function.
    baked : mapping name -> float
        Parameters that are numbers in it, SI.
    condition : mapping
        Whose values these are: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] if there is one, and
        what else is not as written, in SI units.
    """

    function: ca.Function
    meaning: str
    inputs: tuple[Port, ...]
    outputs: tuple[Port, ...]
    baked: Mapping[str, float]
    condition: Mapping[str, Any]


class Functions(Mapping[str, ca.Function]):
    """CasADi Functions by name.

    Parameters
    ----------
    documented : mapping name -> Documented
        The functions with what is known about them; `documented` of this object gives it back.
    """

    def __init__(self, documented: Mapping[str, Documented]) -> None:
        self._documented = dict(documented)

    @property
    def documented(self) -> Mapping[str, Documented]:
        """The functions with units and meanings of their inputs and outputs."""
        return dict(self._documented)

    def __getitem__(self, name: str) -> ca.Function:
        return self._documented[name].function

    def __iter__(self) -> Iterator[str]:
        return iter(self._documented)

    def __len__(self) -> int:
        return len(self._documented)

    def to_dict(self) -> dict[str, Any]:
        """Return meaning, inputs, outputs, baked values and their condition of each function as plain data."""
        return {
            name: plain(
                {
                    "meaning": f.meaning,
                    "inputs": _ports(f.inputs),
                    "outputs": _ports(f.outputs),
                    "baked": f.baked,
                    "condition": f.condition,
                }
            )
            for name, f in self._documented.items()
        }

    def __repr__(self) -> str:
        return "\n".join(line for name, f in self._documented.items() for line in _lines(name, f))


def _ports(ports: Iterable[Port]) -> list[dict[str, Any]]:
    return [{key: entry for key, entry in asdict(port).items() if entry != ()} for port in ports]


def _lines(name: str, f: Documented) -> Iterator[str]:
    yield f"{name}: {f.meaning}"
    for kind, ports in (("in ", f.inputs), ("out", f.outputs)):
        for port in ports:
            size = "" if port.shape == (1, 1) else f" {port.shape[0]}x{port.shape[1]}"
            yield f"  {kind} {port.name}{size} [{port.unit}] {port.meaning}"


def functions(
    problem: Problem,
    inputs: Collection[str] | None = None,
    only: Collection[str] | None = None,
    *,
    condition: Asked = AS_WRITTEN,
) -> Functions:
    """Return the functions of a problem as CasADi Functions with named inputs and outputs.

    Parameters
    ----------
    problem : Problem
        Its values are baked into the functions where a parameter is no input.
    inputs : collection of str, optional
        Parameters that stay inputs: those of bogie and car body, ``v``, and R, L, l, V_r and limit of the curve. All
        of them if not given. A text is split at its commas.
    only : collection of str, optional
        Names of the functions; all if not given (without a curve, or with an axle load that is 0 and no input, all but
        ``rotational_resistance``).
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    Functions
        A mapping from names to `casadi.Function`; `documented` tells units and meanings. ``lambda`` keeps its name, so
        a call from Python is ``f(**{"lambda": 0.15, ...})``.

    Raises
    ------
    ProblemError
        If a name is not known, or a parameter that is no input has no single value in the problem.

    Examples
    --------
    >>> import yawdesign as yd
    >>> f = yd.functions(yd.table1(equations="as-printed"), inputs=["v"])["critical_damping"]
    >>> f
    Function(critical_damping:(v,C_s_start,omega_start)->(C_sl,omega,residual,gradient) MXFunction)
    >>> round(float(f(v=350 / 3.6, C_s_start=2e5, omega_start=22)["C_sl"]), 2)
    255130.52
    """
    return functions_of(chosen(problem, condition), inputs, only)


def functions_of(asked: Chosen, inputs: Collection[str] | None, only: Collection[str] | None) -> Functions:
    """Return the functions of a problem under a condition. Other parameters as in `functions`."""
    parametric = ParametricModel.of(asked.problem, None if inputs is None else listed(inputs))
    condition = asked.described(parametric.values["v"])
    return Functions({name: _documented(name, parametric, condition) for name in _wanted(only, parametric)})


def listed(names: Collection[str]) -> tuple[str, ...]:
    """Return names as a tuple; a text is split at its commas."""
    parts = names.split(",") if isinstance(names, str) else names
    return tuple(name.strip() for name in parts if name.strip())


def _wanted(only: Collection[str] | None, parametric: ParametricModel) -> tuple[str, ...]:
    if only is None:
        return tuple(name for name in BUILDERS if name != "rotational_resistance" or parametric.resists)
    mistakes = Mistakes()
    names = listed(only)
    for name in names:
        with mistakes.under(f"function {name}"):
            if name not in BUILDERS:
                near = suggestion(name, BUILDERS)
                raise ProblemError(f"is not known{near or '; there are ' + ', '.join(BUILDERS)}")
    mistakes.report()
    return tuple(name for name in BUILDERS if name in names)


def _documented(name: str, parametric: ParametricModel, condition: Mapping[str, Any]) -> Documented:
    f, build = SymbolicFunction(parametric, ca.MX if name in ROOTFINDING else ca.SX), BUILDERS[name]
    build(f)
    return Documented(
        function=f.function(name),
        meaning=f.meaning or (build.__doc__ or "").strip(),
        inputs=tuple(port for port, _ in f.inputs),
        outputs=tuple(port for port, _ in f.outputs),
        baked=f.baked,
        condition=condition,
    )


def self_test(f: Documented) -> SelfTest | None:
    """Return inputs with the problem's values, and the outputs that belong to them, matrices column by column.

    None where the problem has no critical damping: what Newton's method then ends with is no number to compare.
    """
    values = {port.name: list(port.value) for port in f.inputs}
    found = f.function.call([ca.DM(value) for value in values.values()])
    columns = [np.array(value).ravel(order="F").tolist() for value in found]
    outputs = {port.name: column for port, column in zip(f.outputs, columns, strict=True)}
    solved = f.function.name() not in ROOTFINDING or outputs["residual"][0] < SOLVED
    return {"inputs": values, "outputs": outputs} if solved else None


def versions() -> dict[str, str]:
    """Return the versions that write functions."""
    from yawdesign import __version__

    return {"yawdesign": __version__, "casadi": str(ca.CasadiMeta.version())}


def c_source(name: str, exported: Mapping[str, ca.Function]) -> str:
    """Return one C source with functions, which needs libm only; with -DMATLAB_MEX_FILE it is a MEX file.

    Parameters
    ----------
    name : str
        Of the file, without its suffix; it stands before all internal names.
    exported : mapping symbol -> casadi.Function
        The functions by the names that they get in C.
    """
    generator = ca.CodeGenerator(name, {"mex": True})
    for symbol, function in exported.items():
        generator.add(_named(symbol, function))
    with TemporaryDirectory() as folder:  # `dump` would leave out the MEX gateway
        written = Path(generator.generate(folder + "/"))
        source = written.read_text(encoding="utf-8")
    if "#error" in source:  # CasADi only warns
        raise RuntimeError("CasADi cannot write C code for one of the functions")
    return PREAMBLE + source


def _named(symbol: str, function: ca.Function) -> ca.Function:
    inputs = function.mx_in()
    return ca.Function(symbol, inputs, function.call(inputs), function.name_in(), function.name_out())


def work_sizes(symbol: str, function: ca.Function) -> dict[str, int]:
    """Return the lengths of the work vectors that `symbol` of a C source needs."""
    named = _named(symbol, function)
    return {size: getattr(named, f"sz_{size}")() for size in ("arg", "res", "iw", "w")}

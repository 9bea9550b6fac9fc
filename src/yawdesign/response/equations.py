"""The equations of motion x' = A(p) x + B(p) u as a CasADi function of parameters, inputs and states, and as C."""

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from yawdesign.bogie.assembly import StateSpace, physical
from yawdesign.bogie.elements import Link, Maxwell, Single
from yawdesign.bogie.vehicles import YAW_DAMPER, Parameters, bogie

# A damper in series with its joints: without damping it has no force, and its dashpot no equation.
DASHPOTS = ("C_s", "C_t", "C_m")
LEAST_DAMPING = 1e-9  # N s/m; a damper with less is left out
OUTPUTS = ("yaw_damper_stroke", "yaw_damper_force")


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion, with every parameter free.

    Parameters
    ----------
    parameters : tuple of str
        Symbols of Table I, `C_s` and ``v``, without the damping of dampers that are not there.
    inputs : tuple of str
        Track inputs: ``alignment_1`` [m], ``cross_level_1`` [rad], ``alignment_2``, ``cross_level_2``.
    states : tuple of str
        Coordinates (``y_b``), velocities (``y_b_dot``), strokes of the dashpots (``yaw_damper_dashpot``): the order of
        `yawdesign.stability.modes.state_matrix`.
    outputs : tuple of str
        ``yaw_damper_stroke`` [m] and ``yaw_damper_force`` [N] (of the pair).
    function : casadi.Function
        Inputs ``p``, ``u``, ``x``, vectors in the orders above, SI; outputs ``dx`` and ``y``.
    """

    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    states: tuple[str, ...]
    outputs: tuple[str, ...]
    function: ca.Function


def equations_of_motion(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> EquationsOfMotion:
    """Return the equations of motion of a bogie.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units, `C_s` and ``v``. Only their names count, and which dampers have no damping:
        those are left out, with their dashpot's state and their parameter.
    kind, equations : str
        As in `yawdesign.bogie.vehicles.bogie`.

    Examples
    --------
    >>> from yawdesign import table1
    >>> motion = equations_of_motion({**table1().bogie.parameters(), "v": 83.0})
    >>> len(motion.states), motion.states[0], motion.states[10], motion.states[20]
    (25, 'y_b', 'y_b_dot', 'yaw_damper_dashpot')
    """
    absent = {name: 0 for name in DASHPOTS if name in p and p[name] < LEAST_DAMPING}
    names = tuple(name for name in p if name not in absent)
    symbols = ca.SX.sym("p", len(names))
    elements = physical(
        bogie({**dict(zip(names, ca.vertsplit(symbols), strict=True)), **absent}, kind=kind, equations=equations)
    )
    system = StateSpace(elements)
    u, x = ca.SX.sym("u", len(system.input_names)), ca.SX.sym("x", system.size)
    dx = _product(system.entries, x, system.size) + _product(system.inputs, u, system.size)
    states = (
        *system.coordinates,
        *(f"{name}_dot" for name in system.coordinates),
        *(f"{name.replace(' ', '_')}_dashpot" for name in system.dashpots),
    )
    y = ca.vertcat(*_yaw_damper(elements, dict(zip(states, ca.vertsplit(x), strict=True))))
    function = ca.Function("equations_of_motion", [symbols, u, x], [dx, y], ["p", "u", "x"], ["dx", "y"])
    return EquationsOfMotion(names, system.input_names, states, OUTPUTS, function)


def _product(entries: Mapping[tuple[int, int], ca.SX], x: ca.SX, rows: int) -> ca.SX:
    product = ca.SX.zeros(rows)
    for (i, j), value in entries.items():
        product[i] += value * x[j]
    return product


def _yaw_damper(elements: list[Single], x: Mapping[str, ca.SX]) -> tuple[ca.SX, ca.SX]:
    link = next(e for e in elements if isinstance(e, Link) and e.name == YAW_DAMPER)
    (law,) = (law for law in link.laws if isinstance(law, Maxwell))
    stroke = sum(g * x[name] for name, g in link.displacement.items())
    dashpot = x.get("yaw_damper_dashpot", stroke)  # a damper that is not there gives way
    return stroke, law.K * (stroke - dashpot)


def c_source(motion: EquationsOfMotion) -> tuple[str, Mapping[str, int]]:
    """Return the equations of motion as C99 with CasADi's calling convention, and the sizes a caller must know.

    Parameters
    ----------
    motion : EquationsOfMotion
        What `equations_of_motion` returns.

    Returns
    -------
    source : str
        Functions ``motion(known) -> unknown`` and ``tangent(known, seed) -> derivative along seed``, where known are
        parameters, inputs and states in one vector, and unknown are the states' derivatives and the outputs.
    sizes : mapping
        Lengths of each function's arrays of arguments, results and work, such as ``MOTION_WORK``.
    """
    f = motion.function
    parts = [f.size1_in(i) for i in range(3)]
    known = ca.SX.sym("known", sum(parts))
    seed = ca.SX.sym("seed", sum(parts))
    unknown = ca.vertcat(*f(*ca.vertsplit(known, [0, parts[0], parts[0] + parts[1], sum(parts)])))
    functions = [
        ca.Function("motion", [known], [unknown]),
        ca.Function("tangent", [known, seed], [ca.jtimes(unknown, known, seed)]),
    ]
    generator = ca.CodeGenerator("motion.c")
    for function in functions:
        generator.add(function)
    return generator.dump(), {key: size for function in functions for key, size in _sizes(function).items()}


def _sizes(function: ca.Function) -> dict[str, int]:
    name = function.name().upper()
    # C has no arrays of length zero.
    return {
        f"{name}_ARGUMENTS": max(1, function.sz_arg()),
        f"{name}_RESULTS": max(1, function.sz_res()),
        f"{name}_WORK": max(1, function.sz_w()),
    }

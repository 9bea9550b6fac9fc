"""The equations of motion x' = A(p) x + B(p) u as a CasADi function of parameters, inputs and states, and as C."""

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from yawdesign.exports.functions import c_source, work_sizes
from yawdesign.exports.states import state_names, state_space_matrices
from yawdesign.vehicle.catalogue import Parameters
from yawdesign.vehicle.old import DAMPERS, YAW_DAMPER, YAW_FORCE, StateSpace, bogie, physical
from yawdesign.vehicle.signals import OLD_OUTPUTS, SignalNames, acceleration

# A damper in series with its joints: without damping it has no force, and its dashpot no equation.
IN_SERIES = ("C_s", "C_t", "C_m")
LEAST_DAMPING = 1e-9  # N s/m; a damper with less is left out


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion, with every parameter free.

    Parameters
    ----------
    parameters : tuple of str
        Symbols of Table I, `C_s` and ``v``, without the damping of dampers that are not there.
    inputs, states : tuple of str
        Names as in `yawdesign.state_space` and `yawdesign.simulate`.
    dashpots : tuple of str
        Names of the dampers to which the last states belong.
    outputs : tuple of str
        Accelerations ``y_b_acceleration``, ...; ``yaw_damper_force``, ``yaw_damper_pair_force`` and
        ``yaw_damper_displacement``, and the last two again by the names of version 0.1.
    function : casadi.Function
        Inputs ``p``, ``u``, ``x``, vectors in the orders above, SI; outputs ``dx`` and ``y``.
    """

    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    states: SignalNames
    dashpots: tuple[str, ...]
    outputs: tuple[str, ...]
    function: ca.Function


def equations_of_motion(p: Parameters, model: Mapping[str, str]) -> EquationsOfMotion:
    """Return the equations of motion of a bogie.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units, `C_s` and ``v``. Only their names count, and which dampers have no damping:
        those are left out, with their dashpot's state and their parameter.
    model : mapping
        ``kind`` and ``equations`` as in `yawdesign.vehicle.catalogue.bogie`.

    Examples
    --------
    >>> from yawdesign import table1
    >>> motion = equations_of_motion({**table1().bogie.parameters(), "v": 83.0}, {"kind": "power"})
    >>> len(motion.states), motion.states[0], motion.states[10], motion.states[20], motion.dashpots[0]
    (25, 'y_b', 'y_b_velocity', 'yaw_damper_stroke', 'yaw damper')
    """
    absent = {name: 0 for name in IN_SERIES if name in p and p[name] < LEAST_DAMPING}
    names = tuple(name for name in p if name not in absent)
    vector = ca.SX.sym("p", len(names))
    symbols = {**dict(zip(names, ca.vertsplit(vector), strict=True)), **absent}
    along = state_names(symbols, symbols["C_s"], model)
    u, x = ca.SX.sym("u", len(along.inputs)), ca.SX.sym("x", len(along.states))
    A, B, C, _ = state_space_matrices(symbols, symbols["C_s"], model).values()
    dx, coordinates = ca.densify(A @ x + B @ u), (len(along.outputs) - len(OLD_OUTPUTS)) // 2
    accelerations, of_damper = dx[coordinates : 2 * coordinates], ca.densify((C @ x)[-len(OLD_OUTPUTS) :])
    y = ca.vertcat(accelerations, of_damper[0] / DAMPERS[YAW_DAMPER], of_damper, of_damper)
    function = ca.Function("equations_of_motion", [vector, u, x], [dx, y], ["p", "u", "x"], ["dx", "y"])
    dashpots = tuple(link.name for link, _ in StateSpace(physical(bogie(symbols, **model))).strokes)
    outputs = (*map(acceleration, along.states[:coordinates]), YAW_FORCE, *OLD_OUTPUTS.values(), *OLD_OUTPUTS)
    return EquationsOfMotion(names, along.inputs, along.states, dashpots, outputs, function)


def motion_source(motion: EquationsOfMotion) -> tuple[str, Mapping[str, int]]:
    """Return the equations of motion as C with CasADi's calling convention, and the sizes a caller must know.

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
        Lengths of each function's arrays of arguments, results and work, such as ``MOTION_W``.
    """
    f = motion.function
    ends = [0, f.size1_in("p"), f.size1_in("p") + f.size1_in("u"), f.nnz_in()]
    known, seed = ca.SX.sym("known", ends[-1]), ca.SX.sym("seed", ends[-1])
    unknown = ca.vertcat(*f(*ca.vertsplit(known, ends)))
    functions = {
        "motion": ca.Function("motion", [known], [unknown]),
        "tangent": ca.Function("tangent", [known, seed], [ca.densify(ca.jtimes(unknown, known, seed))]),
    }
    sizes = {
        # C has no arrays of length zero.
        f"{name}_{size}".upper(): max(1, length)
        for name, function in functions.items()
        for size, length in work_sizes(name, function).items()
    }
    return c_source("motion", functions), sizes

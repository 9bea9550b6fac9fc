"""The equations of motion x' = A(p) x + B(p) u as a CasADi function of parameters, inputs and states, and as C."""

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from yawdesign.exports.functions import c_source, work_sizes
from yawdesign.exports.state_space import matrices, of_yaw_dampers
from yawdesign.vehicle.signals import SignalNames, acceleration
from yawdesign.vehicle.vehicle import Vehicle

LEAST_DAMPING = 1e-9  # N s/m; a damper with less is left out: its stroke has no equation without damping


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion, with every parameter free.

    Parameters
    ----------
    parameters : tuple of str
        Symbols of Table I, `C_s` and ``v``, without the damping of dampers that are not there.
    vehicle : Vehicle
        The vehicle of these symbols; its state space has the names and units of inputs and states.
    outputs : SignalNames
        Accelerations ``y_b_acceleration``, ...; ``yaw_damper_force``, ``yaw_damper_pair_force`` and
        ``yaw_damper_displacement``.
    function : casadi.Function
        Inputs ``p``, ``u``, ``x``, vectors in the orders of parameters, inputs and states, SI; outputs ``dx`` and
        ``y``, which has the `outputs` and after them those that have an old name once more.
    """

    parameters: tuple[str, ...]
    vehicle: Vehicle
    outputs: SignalNames
    function: ca.Function


def equations_of_motion(vehicle: Vehicle) -> EquationsOfMotion:
    """Return the equations of motion of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle
        Of its numbers only the names count, and which dampers have no damping: those are left out, with their dashpot's
        state and their parameter.

    Examples
    --------
    >>> from yawdesign import table1
    >>> from yawdesign.vehicle.vehicle import Model
    >>> motion = equations_of_motion(Model().at(table1().bogie.parameters(), v=83.0))
    >>> states = motion.vehicle.state_space.states
    >>> len(states), states[0], states[10], states[20], motion.outputs[-1]
    (25, 'y_b', 'y_b_velocity', 'yaw_damper_stroke', 'yaw_damper_displacement')
    """
    p, model = vehicle.p, vehicle.model
    absent = {name: 0 for name in model.joints if p[name] < LEAST_DAMPING}
    names = tuple(name for name in p if name not in absent)
    vector = ca.SX.sym("p", len(names))
    free = model.at({**dict(zip(names, ca.vertsplit(vector), strict=True)), **absent})
    system = free.state_space
    forces = of_yaw_dampers(system, "force", "pair force", "displacement")
    u, x = ca.SX.sym("u", len(system.inputs)), ca.SX.sym("x", system.size)
    A, B, C, D = matrices(system, forces).values()
    dx = ca.densify(A @ x + B @ u)
    # Accelerations by their own rows of C and D would be written once more, which makes the C code a quarter longer.
    n = len(system.coordinates)
    y = ca.vertcat(dx[n : 2 * n], ca.densify(C @ x + D @ u))
    outputs = SignalNames((*map(acceleration, system.coordinates), *forces))
    again = [y[outputs.index(name)] for name in outputs.aliases]
    results = [dx, ca.vertcat(y, *again)]
    function = ca.Function("equations_of_motion", [vector, u, x], results, ["p", "u", "x"], ["dx", "y"])
    return EquationsOfMotion(names, free, outputs, function)


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

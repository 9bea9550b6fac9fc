"""The linear model of a problem as plain matrices."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca

from yawdesign.exports.described_vehicle import short_name
from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.exports.symbolic_function import SymbolicFunction
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, chosen, condition_in_words
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.result import Result
from yawdesign.vehicle.elements import Link
from yawdesign.vehicle.signals import SignalNames, of_damper
from yawdesign.vehicle.state_space import Entries, StateSpace


@dataclass(frozen=True, repr=False, eq=False)
class StateSpaceModel(Result):
    """The linear model x' = A x + B u, y = C x + D u of a vehicle on its track.

    Parameters
    ----------
    A, B, C, D : ndarray
        Matrices, SI: 25 states (15 without motors), 4 inputs; with a car body 56 (36), 8 inputs.
    states, inputs, outputs : tuple of str
        Names: coordinates ``y_b``, their velocities ``y_b_velocity``, the dampers' strokes ``yaw_damper_stroke``, ...;
        ``alignment_1``, ``cross_level_1``, ...; coordinates, velocities, ``yaw_damper_pair_force`` and
        ``yaw_damper_displacement``; with a car body ``y_w12``, ``alignment_12``, ``yaw_damper_pair_force_1``, the
        leading bogie (or wheelset) first. They are those of `yawdesign.simulate`. The names before, ``v_y_b``, ``z_1``,
        ``F_s`` and ``u_s``, are found by ``index`` until the next version.
    state_units, input_units, output_units : tuple of str
        SI units in the same order.
    C_s, speed : float
        Damping of the pair of yaw dampers [N s/m] and speed [m/s] to which this belongs.
    title : str
        Title of the problem.
    name : str
        ``bogie``, or ``vehicle`` with a car body.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and what else is not as
        written, in SI units.
    """

    A: Float
    B: Float
    C: Float
    D: Float
    states: SignalNames
    inputs: tuple[str, ...]
    outputs: SignalNames
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]
    C_s: float
    speed: float
    title: str
    name: str
    condition: Mapping[str, Any]

    def to_control(self) -> Any:
        """Return a `control.StateSpace` of python-control with named states, inputs and outputs."""
        try:
            import control
        except ImportError:
            text = "python-control is not installed: pip install 'yawdesign[control]'"
            raise ProblemError(text) from None
        labels = {"states": list(self.states), "inputs": list(self.inputs), "outputs": list(self.outputs)}
        return control.ss(self.A, self.B, self.C, self.D, name=self.name, **labels)

    def __repr__(self) -> str:
        lines = [
            f"StateSpaceModel: {len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs",
            f"  C_s      {self.C_s:.9g} N s/m, speed {self.speed:.9g} m/s",
            f"  {condition_in_words(self.condition)}",
        ]
        for kind in ("state", "input", "output"):
            named = zip(getattr(self, kind + "s"), getattr(self, kind + "_units"), strict=True)
            lines.append(f"  {kind + 's':<8} " + ", ".join(f"{name} [{unit}]" for name, unit in named))
        return "\n".join(lines)


def state_space(problem: Problem, *, condition: Asked = AS_WRITTEN) -> StateSpaceModel:
    """Return the linear model of a problem's vehicle as matrices, moved by the track.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``, and one speed unless the condition says which.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    StateSpaceModel
        The matrices with names and units of states, inputs and outputs.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s`` or several speeds, or the condition is not accepted.

    Examples
    --------
    >>> import yawdesign as yd
    >>> model = yd.state_space(yd.table1())
    >>> model.A.shape, model.B.shape, model.inputs[0]
    ((25, 25), (25, 4), 'alignment_1')
    """
    asked = chosen(problem, condition)
    vehicle = SymbolicFunction(ParametricModel.of(asked.problem, free=())).vehicle()
    system = vehicle.state_space
    outputs = exported_outputs(system)
    return StateSpaceModel(
        **{name: ca.evalf(matrix).full() for name, matrix in matrices(system, outputs).items()},
        states=system.states,
        inputs=system.inputs,
        outputs=outputs,
        state_units=system.state_units,
        input_units=system.input_units,
        output_units=tuple(map(system.unit_of, outputs)),
        C_s=vehicle.C_s,
        speed=vehicle.v,
        title=problem.title,
        name=short_name(vehicle.model),
        condition=asked.described(vehicle.v),
    )


def exported_outputs(system: StateSpace) -> SignalNames:
    """Return the names of coordinates, velocities, and force and displacement of the yaw dampers."""
    moves = system.states[: 2 * len(system.coordinates)]
    return SignalNames((*moves, *of_yaw_dampers(system, "pair force", "displacement")))


def of_yaw_dampers(system: StateSpace, *what: str) -> list[str]:
    """Return the names of what belongs to each pair of yaw dampers."""
    dampers = [link.name for link in system.elements if isinstance(link, Link) and link.varied]
    return [of_damper(name, each) for name in dampers for each in what]


def matrices(system: StateSpace, outputs: Sequence[str]) -> dict[str, ca.SX]:
    """Return A, B, C and D for some of the outputs; what is structurally zero has no entry."""
    C, D = system.rows_of(outputs)
    n, inputs = system.size, len(system.inputs)
    return {
        "A": _matrix(system.A, n, n),
        "B": _matrix(system.B, n, inputs),
        "C": _matrix(C, len(outputs), n),
        "D": _matrix(D, len(outputs), inputs),
    }


def _matrix(entries: Entries, rows: int, columns: int) -> ca.SX:
    matrix = ca.SX(rows, columns)
    for place, value in entries.items():
        matrix[place] = value
    return matrix

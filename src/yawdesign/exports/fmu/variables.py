"""The one table of an FMU's variables, from which its description and its C header are written."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from yawdesign.exports.equations_of_motion import LEAST_DAMPING, EquationsOfMotion
from yawdesign.exports.fmu.meanings import signal_meanings
from yawdesign.problem import PARAMETERS
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import Parameter
from yawdesign.vehicle.signals import rate_unit
from yawdesign.vehicle.state_space import StateSpace

SHOWN = {"m": "mm", "rad": "mrad", "N": "kN"}  # in which unit people like to see a signal
NOMINAL = {"m": 1e-3, "rad": 1e-3, "m/s": 1e-2, "rad/s": 1e-2}  # size of a state


@dataclass(frozen=True, kw_only=True)
class FmuVariable:
    """One variable of an FMU; its value reference is its place in the table.

    Parameters
    ----------
    name, description : str
        As the importing program shows them.
    causality : {"parameter", "input", "output", "local", "independent"}
        As in FMI 3.
    unit, shown : str
        SI unit of the value, and the unit in which people like to see it.
    start, least, greatest, nominal : float, optional
        In SI; what has no start value is calculated.
    derivative_of : int, optional
        Value reference of the state whose derivative this is.
    aliases : tuple of str
        Other names of the same value.
    """

    name: str
    description: str
    causality: str
    unit: str
    shown: str = ""
    start: float | None = None
    least: float | None = None
    greatest: float | None = None
    nominal: float | None = None
    derivative_of: int | None = None
    aliases: tuple[str, ...] = ()

    @property
    def variability(self) -> str:
        """As in FMI 3: a parameter may be changed while the simulation runs."""
        return "tunable" if self.causality == "parameter" else "continuous"


def variables(motion: EquationsOfMotion, values: Mapping[str, float]) -> list[FmuVariable]:
    """Return the table: parameters, inputs, states, derivatives, outputs, time.

    Parameters
    ----------
    motion : EquationsOfMotion
        What the FMU computes.
    values : mapping
        Start values of the parameters in SI.
    """
    system, joints = motion.vehicle.state_space, motion.vehicle.model.joints
    meanings = signal_meanings(system)
    parameters = [_parameter(name, values[name], series=name in joints) for name in motion.parameters]
    inputs = [
        _signal(name, meanings[name], unit, "input", start=0.0)
        for name, unit in zip(system.inputs, system.input_units, strict=True)
    ]
    states = list(_states(system, meanings))
    first = len(parameters) + len(inputs)
    derivatives = [_derivative(state, first + i) for i, state in enumerate(states)]
    outputs = [_signal(name, meanings[name], system.unit_of(name), "output") for name in motion.outputs]
    again = [
        replace(outputs[motion.outputs.index(name)], name=old, description=f"old name of {name}")
        for old, name in motion.outputs.aliases.items()
    ]
    time = FmuVariable(name="time", description="time", causality="independent", unit="s")
    return [*parameters, *inputs, *states, *derivatives, *outputs, *again, time]


def _parameter(name: str, value: float, *, series: bool) -> FmuVariable:
    """Return the variable of a parameter; `series`: it is the damping of a damper in series with its joints."""
    row: Parameter = SPEED if name == "v" else PARAMETERS[name]
    least, greatest = row.hard
    return FmuVariable(
        name=name,
        description=row.meaning,
        causality="parameter",
        unit=row.si,
        shown=row.unit,
        start=float(value),
        least=LEAST_DAMPING if series else least,
        greatest=greatest,
    )


def _signal(name: str, meaning: str, unit: str, causality: str, **more: Any) -> FmuVariable:
    """Return the variable of an input, a state or an output of the state space."""
    shown = SHOWN.get(unit, "")
    return FmuVariable(name=name, description=meaning, causality=causality, unit=unit, shown=shown, **more)


def _states(system: StateSpace, meanings: Mapping[str, str]) -> Iterator[FmuVariable]:
    """Yield the states; coordinates and velocities are outputs as well."""
    old = {name: alias for alias, name in system.states.aliases.items()}
    for k, (name, unit) in enumerate(zip(system.states, system.state_units, strict=True)):
        causality = "output" if k < 2 * len(system.coordinates) else "local"
        aliases = (old[name],) if name in old else ()
        yield _signal(name, meanings[name], unit, causality, start=0.0, nominal=NOMINAL[unit], aliases=aliases)


def _derivative(state: FmuVariable, reference: int) -> FmuVariable:
    unit = rate_unit(state.unit.removesuffix("/s"), 2) if state.unit.endswith("/s") else rate_unit(state.unit)
    return FmuVariable(
        name=f"der({state.name})",
        description=f"time derivative of {state.name}",
        causality="local",
        unit=unit,
        derivative_of=reference,
        aliases=tuple(f"der({name})" for name in state.aliases),
    )

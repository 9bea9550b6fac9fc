"""The one table of an FMU's variables, from which its description and its C header are written."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from yawdesign.exports.equations_of_motion import LEAST_DAMPING, EquationsOfMotion
from yawdesign.problem import PARAMETERS
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import Parameter
from yawdesign.vehicle.elements import Link, Mass, WheelRailContact, parted
from yawdesign.vehicle.motions import BOGIES
from yawdesign.vehicle.signals import DIRECTIONS, ENDS, acceleration, of_damper, rate_unit, velocity
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


Meaning = tuple[str, str]  # name of a signal, and what it is
MOVED = {"m": "displacement", "rad": "angle"}


def signal_meanings(system: StateSpace) -> dict[str, str]:
    """Return what inputs, states and outputs are, by their names."""
    masses = [e for e in system.elements if isinstance(e, Mass)]
    two_bogies = any(len(parted(mass.coordinate)[1]) == len("12") for mass in masses)

    def at_end(part: str, name: str) -> str:
        return _at_end(part, name, two_bogies=two_bogies)

    bodies = {mass.coordinate: f"the {at_end(mass.body, mass.coordinate)}" for mass in masses}
    meanings: dict[str, str] = {}
    for element in system.elements:
        match element:
            case Mass():
                meanings |= _of_mass(element, bodies[element.coordinate])
            case WheelRailContact():
                meanings |= _of_track(element, bodies[element.y])
            case Link() if element.name:
                kind = parted(element.name)[0].strip()
                each, all_ = (at_end(word, element.name) for word in (kind, f"{kind}s"))
                meanings |= _of_dampers(element, each, all_ if element.pieces > 1 else each)
    return meanings


def _at_end(part: str, name: str, *, two_bogies: bool) -> str:
    """Return what a part is called that stands at the ends with whose numbers a name ends, the outer one first."""
    ends = parted(name)[1]
    bogie, end = (ends[:1], ends[1:]) if two_bogies else ("", ends)
    whose = f" of the {BOGIES[bogie]}" if bogie else ""
    return f"{ENDS[end]} {part}{whose}" if end else f"{part}{whose}"


def _of_mass(mass: Mass, body: str) -> Iterator[Meaning]:
    direction = DIRECTIONS[mass.coordinate.split("_")[0]]
    position = f"{direction} {MOVED[mass.unit]} of {body}"
    yield mass.coordinate, position
    yield velocity(mass.coordinate), f"rate of the {position}"
    yield acceleration(mass.coordinate), f"{direction} acceleration of {body}"


def _of_track(contact: WheelRailContact, wheelset: str) -> Iterator[Meaning]:
    yield contact.alignment, f"lateral position of the track's centre line under {wheelset}"
    yield contact.cross_level, f"cross-level angle of the track under {wheelset}"


def _of_dampers(link: Link, damper: str, several: str) -> Iterator[Meaning]:
    yield of_damper(link.name, "stroke"), f"stroke of the dashpot of the {several}, without its joints"
    if link.pieces == 1:
        yield of_damper(link.name, "force"), f"force of the {damper}"
        return
    yield of_damper(link.name, "force"), f"force of each of the two {several}"
    yield of_damper(link.name, "pair force"), f"force of both {several} together"
    yield of_damper(link.name, "displacement"), f"displacement of each {damper} with its joints"

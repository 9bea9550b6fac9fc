"""The one table of an FMU's variables, from which its description and its C header are written."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from yawdesign.exports.equations_of_motion import IN_SERIES, LEAST_DAMPING, EquationsOfMotion
from yawdesign.problem import PARAMETERS
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import Parameter
from yawdesign.vehicle.old import PAIR_FORCE, YAW_DISPLACEMENT, YAW_FORCE
from yawdesign.vehicle.signals import OLD_OUTPUTS, velocity

_MOTION = {"y": ("m", "mm", "lateral displacement"), "phi": ("rad", "mrad", "yaw angle")}
_BODIES = {"b": "bogie frame", "w": "wheelset", "m": "motor"}
_ENDS = {"1": "front ", "2": "rear "}
_OUTPUTS = {
    YAW_DISPLACEMENT: ("m", "mm", "displacement of each yaw damper with its joints"),
    YAW_FORCE: ("N", "kN", "force of each of the two yaw dampers"),
    PAIR_FORCE: ("N", "kN", "force of both yaw dampers together"),
}


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
    known = [
        *(_parameter(name, values[name]) for name in motion.parameters),
        *(_input(name) for name in motion.inputs),
        *_states(motion),
    ]
    first = len(motion.parameters) + len(motion.inputs)
    unknown = [
        *(_derivative(state, first + i) for i, state in enumerate(known[first:])),
        *(_output(name) for name in motion.outputs),
    ]
    time = FmuVariable(name="time", description="time", causality="independent", unit="s")
    return [*known, *unknown, time]


def _parameter(name: str, value: float) -> FmuVariable:
    row: Parameter = SPEED if name == "v" else PARAMETERS[name]
    least, greatest = row.hard
    return FmuVariable(
        name=name,
        description=row.meaning,
        causality="parameter",
        unit=row.si,
        shown=row.unit,
        start=float(value),
        least=LEAST_DAMPING if name in IN_SERIES else least,
        greatest=greatest,
    )


def _input(name: str) -> FmuVariable:
    kind, end = name.rsplit("_", 1)
    where = f"under the {_ENDS[end]}wheelset"
    if kind == "alignment":
        return FmuVariable(
            name=name,
            description=f"lateral position of the track's centre line {where}",
            causality="input",
            unit="m",
            shown="mm",
            start=0.0,
        )
    return FmuVariable(
        name=name,
        description=f"cross-level angle of the track {where}",
        causality="input",
        unit="rad",
        shown="mrad",
        start=0.0,
    )


def _states(motion: EquationsOfMotion) -> Iterator[FmuVariable]:
    moves = len(motion.states) - len(motion.dashpots)
    for name in motion.states[:moves]:
        coordinate = name.removesuffix("_velocity")
        yield _coordinate(name) if name == coordinate else _velocity(coordinate)
    for k, (name, damper) in enumerate(zip(motion.states[moves:], motion.dashpots, strict=True), 1):
        text = f"stroke of the dashpot of the {_damper(damper)}, without its joints"
        known = FmuVariable(
            name=name, description=text, causality="local", unit="m", shown="mm", start=0.0, nominal=1e-3
        )
        yield replace(known, aliases=(f"z_{k}",))


def _damper(name: str) -> str:
    return f"{_ENDS[name[-1]]}{name[:-1].strip()}" if name[-1] in _ENDS else f"{name}s"


def _velocity(name: str) -> FmuVariable:
    """Return the variable of the velocity of a coordinate."""
    x = _coordinate(name)
    text, unit = f"rate of the {x.description}", f"{x.unit}/s"
    x = replace(x, name=velocity(name), aliases=(f"v_{name}",))
    return replace(x, description=text, unit=unit, shown="", nominal=1e-2)


def _coordinate(name: str) -> FmuVariable:
    kind, body = name.split("_")
    unit, shown, text = _MOTION[kind]
    description = f"{text} of the {_ENDS.get(body[1:], '')}{_BODIES[body[0]]}"
    return FmuVariable(
        name=name, description=description, causality="output", unit=unit, shown=shown, start=0.0, nominal=1e-3
    )


def _derivative(state: FmuVariable, reference: int) -> FmuVariable:
    rate = state.name.endswith("_velocity")
    return FmuVariable(
        name=f"der({state.name})",
        description=f"time derivative of {state.name}",
        causality="local",
        unit=state.unit.replace("/s", "/s²") if rate else f"{state.unit}/s",
        derivative_of=reference,
        aliases=tuple(f"der({name})" for name in state.aliases),
    )


def _output(name: str) -> FmuVariable:
    new = OLD_OUTPUTS.get(name, name)
    if new in _OUTPUTS:
        unit, shown, text = _OUTPUTS[new]
        text = text if new == name else f"old name of {new}"
        return FmuVariable(name=name, description=text, causality="output", unit=unit, shown=shown)
    x = _coordinate(name.removesuffix("_acceleration"))
    text = x.description.replace("displacement", "acceleration").replace("yaw angle", "yaw acceleration")
    return replace(x, name=name, description=text, unit=f"{x.unit}/s²", shown="", start=None, nominal=None)

"""What the signals of a state space are, in words, from what its elements are called."""

from collections.abc import Iterator

from yawdesign.vehicle.elements import Link, Mass, WheelRailContact
from yawdesign.vehicle.signals import DIRECTIONS, ENDS, acceleration, of_damper, velocity
from yawdesign.vehicle.state_space import StateSpace

Meaning = tuple[str, str]  # name of a signal, and what it is
MOVED = {"m": "displacement", "rad": "angle"}


def signal_meanings(system: StateSpace) -> dict[str, str]:
    """Return what inputs, states and outputs are, by their names."""
    bodies = {e.coordinate: f"the {_at_end(e.body, e.coordinate)}" for e in system.elements if isinstance(e, Mass)}
    meanings: dict[str, str] = {}
    for element in system.elements:
        match element:
            case Mass():
                meanings |= _of_mass(element, bodies[element.coordinate])
            case WheelRailContact():
                meanings |= _of_track(element, bodies[element.y])
            case Link() if element.maxwell:
                meanings |= _of_dampers(element)
    return meanings


def _at_end(part: str, name: str) -> str:
    """Return what a part is called that stands at the end with whose number a name ends."""
    return f"{ENDS[name[-1]]} {part}" if name[-1] in ENDS else part


def _of_mass(mass: Mass, body: str) -> Iterator[Meaning]:
    direction = DIRECTIONS[mass.coordinate.split("_")[0]]
    position = f"{direction} {MOVED[mass.unit]} of {body}"
    yield mass.coordinate, position
    yield velocity(mass.coordinate), f"rate of the {position}"
    yield acceleration(mass.coordinate), f"{direction} acceleration of {body}"


def _of_track(contact: WheelRailContact, wheelset: str) -> Iterator[Meaning]:
    yield contact.alignment, f"lateral position of the track's centre line under {wheelset}"
    yield contact.cross_level, f"cross-level angle of the track under {wheelset}"


def _of_dampers(link: Link) -> Iterator[Meaning]:
    damper = _at_end(link.name.rstrip(" 12"), link.name)
    several = f"{damper}s" if link.pieces > 1 else damper
    yield of_damper(link.name, "stroke"), f"stroke of the dashpot of the {several}, without its joints"
    if link.pieces == 1:
        yield of_damper(link.name, "force"), f"force of the {damper}"
        return
    yield of_damper(link.name, "force"), f"force of each of the two {several}"
    yield of_damper(link.name, "pair force"), f"force of both {several} together"
    yield of_damper(link.name, "displacement"), f"displacement of each {damper} with its joints"

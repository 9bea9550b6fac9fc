"""The state space of a vehicle: x' = A x + B u, y = C x + D u, with names and units, for numbers of any type.

The states are the coordinates, their velocities, and the dashpot stroke z of every damper in series with a spring, for
which z' = K/c (u - z) and the force is K (u - z). With a rigid joint the force is c u', and there is no stroke.
The inputs are what the track does under each wheelset; the outputs are all that is of interest.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from yawdesign.vehicle.elements import (
    Coefficients,
    Dashpot,
    Law,
    Link,
    Mass,
    Maxwell,
    Point,
    Single,
    Spring,
    WheelRailContact,
)
from yawdesign.vehicle.polynomials import Number, plus, times
from yawdesign.vehicle.signals import SignalNames, acceleration, of_damper, rate_unit, velocity

Entries = dict[tuple[int, int], Any]
Row = dict[int, Any]


class StateSpace:
    """Matrices of a list of elements by their entries that are not structurally zero.

    Parameters
    ----------
    elements : sequence of Mass, Link, WheelRailContact, Point
        In the coordinates of each end, or in half sums and half differences of both.

    Attributes
    ----------
    coordinates : tuple of str
        In the order of their masses.
    states, inputs : SignalNames
        Coordinates ``y_b``, velocities ``y_b_velocity``, strokes ``yaw_damper_stroke``; ``alignment_1`` [m],
        ``cross_level_1`` [rad], ``alignment_2``, ... in the order of the contacts.
    state_units, input_units : tuple of str
        SI units in the same order.
    A, B : dict (row, column) -> number
        Entries.
    strokes : tuple of (Link, Maxwell)
        What each state behind the velocities belongs to.
    elements : tuple
        What it is made of.
    """

    def __init__(self, elements: Sequence[Single]) -> None:
        self.elements = tuple(elements)
        masses = {e.coordinate: e for e in elements if isinstance(e, Mass)}
        contacts = [e for e in elements if isinstance(e, WheelRailContact)]
        self.coordinates = tuple(masses)
        self.inputs = SignalNames(name for e in contacts for name in (e.alignment, e.cross_level))
        self.input_units = ("m", "rad") * len(contacts)
        self.A: Entries = {}
        self.B: Entries = {}
        self.strokes: tuple[tuple[Link, Maxwell], ...] = ()
        self._masses = masses
        self._place = {x: i for i, x in enumerate(self.coordinates)}
        self._input = {name: k for k, name in enumerate(self.inputs)}
        for i in range(len(masses)):
            self.A[i, len(masses) + i] = 1
        for element in elements:
            if isinstance(element, Link):
                self._add_link(element)
            elif isinstance(element, WheelRailContact):
                self._add_contact(element)

    @property
    def size(self) -> int:
        """Number of states."""
        return 2 * len(self.coordinates) + len(self.strokes)

    @property
    def states(self) -> SignalNames:
        """Names of the states."""
        strokes = (of_damper(link.own_name, "stroke") for link, _ in self.strokes)
        return SignalNames((*self.coordinates, *map(velocity, self.coordinates), *strokes))

    @property
    def state_units(self) -> tuple[str, ...]:
        """SI units of the states."""
        units = [mass.unit for mass in self._masses.values()]
        return (*units, *(rate_unit(unit) for unit in units), *("m" for _ in self.strokes))

    @property
    def owners(self) -> tuple[Mass | Link, ...]:
        """What each state belongs to; a mass appears twice, for its coordinate and for the velocity."""
        masses = tuple(self._masses.values())
        return (*masses, *masses, *(link for link, _ in self.strokes))

    def _put(self, row: int, column: int, value: Number) -> None:
        self.A[row, column] = plus(self.A.get((row, column), 0), value)

    def _push(self, x: str, column: int, force: Number) -> None:
        """Add a force -force * state[column] to the equation of coordinate x."""
        self._put(len(self._masses) + self._place[x], column, -force / self._masses[x].m)

    def _add_contact(self, contact: WheelRailContact) -> None:
        for (row, x), p in contact.entries().items():
            for order, value in enumerate(p):
                self._push(row, order * len(self._masses) + self._place[x], value)
        for (row, name), force in contact.inputs().items():
            place = len(self._masses) + self._place[row], self._input[name]
            self.B[place] = force / self._masses[row].m

    def _add_link(self, link: Link) -> None:
        for law in map(_without_rigid_joint, link.laws):
            match law:
                case Spring():
                    self._respond(link, law.K, 0)
                case Dashpot():
                    self._respond(link, law.c, len(self._masses))
                case Maxwell():
                    self._add_maxwell(link, law)

    def _respond(self, link: Link, constant: Number, offset: int) -> None:
        displacement = [(offset + self._place[other], g) for other, g in link.displacement.items()]
        for x, force in link.force.items():
            each = times(constant, force)
            for column, g in displacement:
                self._push(x, column, times(each, g))

    def _add_maxwell(self, link: Link, law: Maxwell) -> None:
        if _is_absent(law):
            return  # no damping, no force, no state
        stroke, rate = self.size, law.K / law.c
        self.strokes = (*self.strokes, (link, law))
        self._respond(link, law.K, 0)
        for x, force in link.force.items():
            self._push(x, stroke, times(-law.K, force))
        for other, g in link.displacement.items():
            self._put(stroke, self._place[other], times(rate, g))
        self._put(stroke, stroke, -rate)

    def states_of(self, coordinates: frozenset[str]) -> tuple[int, ...]:
        """Return the places of the states of an independent motion, given by its coordinates."""
        return tuple(k for k, owner in enumerate(self.owners) if not coordinates.isdisjoint(_acts_on(owner)))

    @cached_property
    def _rows(self) -> dict[str, tuple[Row, Row, str]]:
        """The rows of C and D of every output, and its unit."""
        points = [e for e in self.elements if isinstance(e, Point)]
        moved = {x: ({x: 1}, mass.unit) for x, mass in self._masses.items()} | {e.name: (e.gap, e.unit) for e in points}
        rows: dict[str, tuple[Row, Row, str]] = {x: (self._moved(u), {}, unit) for x, (u, unit) in moved.items()}
        rows |= {velocity(x): (self._moved(u, rate=1), {}, rate_unit(unit)) for x, (u, unit) in moved.items()}
        rows |= {acceleration(x): (*self._acceleration(u), rate_unit(unit, 2)) for x, (u, unit) in moved.items()}
        for contact in (e for e in self.elements if isinstance(e, WheelRailContact)):
            rows[f"lateral_force_{contact.y.removeprefix('y_w')}"] = (*self._lateral_force(contact), "N")
        for k, (link, law) in enumerate(self.strokes, 2 * len(self.coordinates)):
            force = {j: times(law.K, g) for j, g in self._moved(link.displacement).items()} | {k: -law.K}
            rows |= self._damper(link, force, stroke=k)
        for link, damper in self._dampers():
            if isinstance(damper, Dashpot) and not _is_absent(damper):
                rate = self._moved(link.displacement, rate=1)
                rows |= self._damper(link, {j: times(damper.c, g) for j, g in rate.items()})
        return rows

    def _dampers(self) -> Iterator[tuple[Link, Dashpot | Maxwell]]:
        """Yield the dampers of the links that have a name."""
        for link in (e for e in self.elements if isinstance(e, Link) and e.name):
            for law in map(_without_rigid_joint, link.laws):
                if isinstance(law, (Dashpot, Maxwell)):
                    yield link, law

    @cached_property
    def _absent(self) -> dict[str, tuple[Row, Row, str]]:
        """The same of dampers without damping, which are no outputs unless they are asked for."""
        rows: dict[str, tuple[Row, Row, str]] = {}
        for link, law in self._dampers():
            rows |= self._damper(link, {}) if _is_absent(law) else {}
        return rows

    def _row(self, output: str) -> tuple[Row, Row, str]:
        return self._rows[output] if output in self._rows else self._absent[output]

    def _moved(self, displacement: Coefficients, rate: int = 0) -> Row:
        """Return the row of C of a displacement, or of its rate."""
        return {rate * len(self.coordinates) + self._place[x]: g for x, g in displacement.items()}

    def _acceleration(self, displacement: Coefficients) -> tuple[Row, Row]:
        of_states: Row = {}
        of_inputs: Row = {}
        for row, g in self._moved(displacement, rate=1).items():
            for whole, matrix in ((of_states, self.A), (of_inputs, self.B)):
                for (i, j), x in matrix.items():
                    if i == row:
                        whole[j] = plus(whole.get(j, 0), times(g, x))
        return of_states, of_inputs

    def _lateral_force(self, contact: WheelRailContact) -> tuple[Row, Row]:
        """Return the lateral force of the rails on a wheelset, gravity and creep together."""
        n = len(self.coordinates)
        c = {
            order * n + self._place[x]: -value
            for (row, x), polynomial in contact.entries().items()
            for order, value in enumerate(polynomial if row == contact.y else ())
        }
        d = {self._input[name]: force for (row, name), force in contact.inputs().items() if row == contact.y}
        return c, d

    def _damper(self, link: Link, force: Row, stroke: int | None = None) -> dict[str, tuple[Row, Row, str]]:
        """Return force and stroke of each damper and, where a link stands for several, the force of all of them."""
        each: Row = {j: x / link.pieces for j, x in force.items()} if link.pieces > 1 else force
        rows: dict[str, tuple[Row, Row, str]] = {of_damper(link.own_name, "force"): (each, {}, "N")}
        if stroke is not None:
            rows[of_damper(link.own_name, "stroke")] = {stroke: 1}, {}, "m"
        if link.pieces > 1:
            rows[of_damper(link.own_name, "pair force")] = force, {}, "N"
            rows[of_damper(link.own_name, "displacement")] = self._moved(link.displacement), {}, "m"
        return rows

    @property
    def outputs(self) -> SignalNames:
        """Names of all outputs."""
        return SignalNames(self._rows)

    @property
    def output_units(self) -> tuple[str, ...]:
        """SI units of the outputs."""
        return tuple(unit for _, _, unit in self._rows.values())

    @property
    def C(self) -> Entries:
        """Entries of the output matrix."""
        return {(i, j): x for i, (c, _, _) in enumerate(self._rows.values()) for j, x in c.items()}

    @property
    def D(self) -> Entries:
        """Entries of the feed-through matrix."""
        return {(i, j): x for i, (_, d, _) in enumerate(self._rows.values()) for j, x in d.items()}

    def unit_of(self, output: str) -> str:
        """Return the SI unit of an output."""
        return self._row(output)[2]

    def rows_of(self, outputs: Sequence[str]) -> tuple[Entries, Entries]:
        """Return the entries of C and D for some of the outputs, in this order.

        A damper without damping, which has no outputs of its own, has the force zero here.

        Raises
        ------
        KeyError
            With the name of an output that this vehicle does not have.
        """
        rows = [self._row(name) for name in outputs]
        C = {(i, j): x for i, (c, _, _) in enumerate(rows) for j, x in c.items()}
        return C, {(i, j): x for i, (_, d, _) in enumerate(rows) for j, x in d.items()}


def _is_absent(law: Dashpot | Maxwell) -> bool:
    """Return whether a damper is known to have no damping."""
    return isinstance(law.c, (int, float)) and law.c == 0


def _without_rigid_joint(law: Law) -> Law:
    """Return a damper with a joint that is known to be rigid as what it is: a dashpot."""
    if isinstance(law, Maxwell) and isinstance(law.K, float) and math.isinf(law.K):
        return Dashpot(law.c)
    return law


def _acts_on(owner: Mass | Link) -> Sequence[str]:
    return (owner.coordinate,) if isinstance(owner, Mass) else tuple(owner.force)


def fill(entries: Mapping[tuple[int, int], Any], matrix: Any, convert: Callable[[Number], Any] = lambda x: x) -> Any:
    """Write entries into a matrix (or a stack of them) that is indexed by (row, column) at the end."""
    for (i, j), value in entries.items():
        matrix[..., i, j] = convert(value)
    return matrix

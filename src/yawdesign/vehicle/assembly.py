"""Assembly of elements: to a polynomial matrix in s, and to a state matrix with its track inputs.

The polynomial matrix keeps one extra row for the force of every link, ``denominator(s) force = numerator(s) u``. So a
link's polynomials enter every determinant at most once, and terms that would cancel never arise.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from yawdesign.vehicle.elements import (
    Dashpot,
    Link,
    Mass,
    Maxwell,
    Single,
    Spring,
    WheelRailContact,
    parallel,
)
from yawdesign.vehicle.polynomials import Number, Polynomial, add, plus, scale, times

Entries = dict[tuple[Any, Any], Polynomial]
StateEntries = dict[tuple[int, int], Any]


def polynomial_matrix(elements: Iterable[Single]) -> Entries:
    """Return the polynomial matrix in s of a list of elements.

    Rows and columns are named by coordinates and, for the force of each link, by the link's name or its number.
    Its determinant is that of the equations of motion times the denominators of all Maxwell elements.
    """
    entries: Entries = {}

    def put(row: Any, column: Any, p: Polynomial) -> None:
        entries[row, column] = add(entries[row, column], p) if (row, column) in entries else p

    for number, element in enumerate(elements):
        match element:
            case Mass():
                put(element.coordinate, element.coordinate, (0, 0, element.m))
            case WheelRailContact():
                for (row, column), p in element.entries().items():
                    put(row, column, p)
            case Link():
                force = element.name or number
                numerator, denominator = parallel(element.laws)
                put(force, force, denominator)
                for x, g in element.displacement.items():
                    put(force, x, scale(numerator, times(-1, g)))
                for x, g in element.force.items():
                    put(x, force, (g,))
    return entries


class StateSpace:
    """State matrix A and input matrix B of a list of elements: x' = A x + B u.

    The states are the coordinates, their velocities, and the dashpot stroke z of every Maxwell element, for which
    z' = K/c (u - z) and the force is K (u - z). With a rigid joint (K = inf) the force is c u', without a stroke.

    Parameters
    ----------
    elements : sequence of Mass, Link, WheelRailContact
        In physical coordinates.

    Attributes
    ----------
    coordinates : tuple of str
        In the order of their masses.
    entries : dict (row, column) -> number
        The entries of A that are not structurally zero.
    input_names : tuple of str
        The track inputs u in the order of the contacts: alignment_1 [m], cross_level_1 [rad], alignment_2, ...
    inputs : dict (row, column) -> number
        The entries of B that are not structurally zero.
    strokes : list of (Link, Maxwell)
        What each state behind the velocities belongs to: the dashpots, in the order of their states.
    size : int
        Number of states.
    """

    def __init__(self, elements: Sequence[Single]) -> None:
        masses = {e.coordinate: e.m for e in elements if isinstance(e, Mass)}
        self.coordinates = tuple(masses)
        self.entries: StateEntries = {}
        self.inputs: StateEntries = {}
        self.strokes: list[tuple[Link, Maxwell]] = []
        contacts = [e for e in elements if isinstance(e, WheelRailContact)]
        self.input_names = tuple(name for e in contacts for name in (e.alignment, e.cross_level))
        self.size = 2 * len(masses)
        self._place = {x: i for i, x in enumerate(self.coordinates)}
        self._masses = masses
        for i in range(len(masses)):
            self.entries[i, len(masses) + i] = 1
        for element in elements:
            if isinstance(element, Link):
                self._add_link(element)
            elif isinstance(element, WheelRailContact):
                self._add_contact(element)

    def _put(self, row: int, column: int, value: Number) -> None:
        self.entries[row, column] = plus(self.entries.get((row, column), 0), value)

    def _push(self, x: str, column: int, force: Number) -> None:
        """Add a force -force * state[column] to the equation of coordinate x."""
        self._put(len(self._masses) + self._place[x], column, -force / self._masses[x])

    def _add_contact(self, contact: WheelRailContact) -> None:
        for (row, x), p in contact.entries().items():
            for order, value in enumerate(p):
                self._push(row, order * len(self._masses) + self._place[x], value)
        for (row, name), force in contact.inputs().items():
            place = len(self._masses) + self._place[row], self.input_names.index(name)
            self.inputs[place] = force / self._masses[row]

    def _add_link(self, link: Link) -> None:
        for law in link.laws:
            match law:
                case Spring():
                    self._respond(link, law.K, 0)
                case Dashpot():
                    self._respond(link, law.c, len(self._masses))
                case Maxwell():
                    self._add_maxwell(link, law)

    def _respond(self, link: Link, constant: Number, offset: int) -> None:
        for x, force in link.force.items():
            for other, g in link.displacement.items():
                self._push(x, offset + self._place[other], times(times(constant, force), g))

    def _add_maxwell(self, link: Link, law: Maxwell) -> None:
        if isinstance(law.c, (int, float)) and law.c == 0:
            return  # no damping, no force, no state
        if isinstance(law.K, float) and math.isinf(law.K):  # a rigid joint has no stroke of its own
            self._respond(link, law.c, len(self._masses))
            return
        stroke, rate = self.size, law.K / law.c
        self.size += 1
        self.strokes.append((link, law))
        self._respond(link, law.K, 0)
        for x, force in link.force.items():
            self._push(x, stroke, times(-law.K, force))
        for other, g in link.displacement.items():
            self._put(stroke, self._place[other], times(rate, g))
        self._put(stroke, stroke, -rate)

    def fill(self, matrix: Any, convert: Callable[[Number], Any] = lambda x: x) -> Any:
        """Write the entries into a matrix (or a stack of them) that is indexed by (row, column) at the end."""
        for (i, j), value in self.entries.items():
            matrix[..., i, j] = convert(value)
        return matrix

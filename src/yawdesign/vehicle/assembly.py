"""Assembly of elements to a polynomial matrix in s.

It keeps one extra row for the force of every link, ``denominator(s) force = numerator(s) u``. So a link's polynomials
enter every determinant at most once, and terms that would cancel never arise.
"""

from collections.abc import Iterable
from typing import Any

from yawdesign.vehicle.elements import Link, Mass, Single, WheelRailContact, parallel
from yawdesign.vehicle.polynomials import Polynomial, add, scale, times

Entries = dict[tuple[Any, Any], Polynomial]


def polynomial_matrix(elements: Iterable[Single]) -> Entries:
    """Return the polynomial matrix in s of a list of elements.

    Rows and columns are named by coordinates and, for the force of each link, by the link's name or its number.
    Its determinant is that of the equations of motion times the denominators of all Maxwell elements.

    Raises
    ------
    ValueError
        If a link has the name of another one.
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
                if (force, force) in entries:
                    raise ValueError(f"two parts are called {force}")
                numerator, denominator = parallel(element.laws)
                put(force, force, denominator)
                for x, g in element.displacement.items():
                    put(force, x, scale(numerator, times(-1, g)))
                for x, g in element.force.items():
                    put(x, force, (g,))
    return entries

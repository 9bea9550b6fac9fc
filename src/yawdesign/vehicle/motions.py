"""The motions of a vehicle: the independent parts of its equations, each a polynomial in s and in the yaw damping C_s.

They are found on the graph of the polynomial matrix, so they belong to the model and not to its numbers. What no yaw
damper reaches is a motion like any other, whose polynomial has no power of C_s.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import combinations
from typing import Any

from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.determinant import Determinant, Node
from yawdesign.vehicle.elements import Dashpot, Link, Mass, Maxwell, Single, Spring, parted
from yawdesign.vehicle.polynomials import ONE, ZERO, Number, Polynomial, add, multiply, scale

Law = tuple[Polynomial, Polynomial]

COUPLED = "coupled motion"
TOGETHER = {"+": "together", "-": "against each other"}
BOGIES = {"+": "both bogies alike", "-": "one bogie against the other", "1": "leading bogie", "2": "trailing bogie"}


@dataclass(frozen=True)
class Motion:
    """An independent part of the equations, with the polynomial ``coefficients[0] + C_s coefficients[1] + ...``.

    Parameters
    ----------
    name : str
        The coupled motion, or what moves in a decoupled one, such as ``motors yawing against each other``.
    coordinates : frozenset of str
        What moves in it, half sums ``y_w+`` and half differences ``y_w-`` of both ends.
    coefficients : tuple of tuple
        A polynomial in s, lowest power first, for every power of C_s [N s/m]. The highest coefficients may be zero
        where a damper has no damping. The coupled motion of the power bogie has degree 23 in s (21 as printed), that
        of the trailer bogie 15, and both degree 1 in C_s; with a car body 50 ... 52 or 34 ... 36, and 2 in C_s. Empty
        for a motion of a model, which has no numbers.
    dampers : int
        How many links of yaw dampers are in it: its degree in C_s.
    """

    name: str
    coordinates: frozenset[str]
    coefficients: tuple[Polynomial, ...] = ()
    dampers: int = 0

    @property
    def varied(self) -> bool:
        """Whether a yaw damper reaches it."""
        return self.dampers > 0

    def polynomial(self, C_s: Number) -> Polynomial:
        """Return its characteristic polynomial, lowest power of s first, with a yaw damping [N s/m]."""
        return reduce(lambda value, part: add(part, scale(value, C_s)), self.coefficients[::-1])


def outlines(elements: Sequence[Single]) -> tuple[Motion, ...]:
    """Return the independent motions as `motions` does, without their coefficients: only the graph is looked at."""
    matrix, names = Determinant(polynomial_matrix(elements)), {x.own_name for x in _yaw_dampers(elements)}
    return tuple(Motion(name, where, dampers=len(names & piece)) for name, where, piece in _parts(elements, matrix))


def numbers_in(elements: Sequence[Single]) -> dict[str, list[Any]]:
    """Return by the name of each motion the numbers that it is made of, but for C_s."""
    dampers = {damper.own_name: _law(damper) for damper in _yaw_dampers(elements)}
    entries = _without_laws(polynomial_matrix(_with_unit_laws(elements)), dampers)
    found = {}
    for name, _, piece in _parts(elements, Determinant(entries)):
        inside = [p for (row, column), p in entries.items() if row in piece and column in piece]
        inside += [p for damper, laws in dampers.items() if damper in piece for p in laws]
        found[name] = [a for p in inside for a in p]
    return found


def motions(elements: Sequence[Single]) -> tuple[Motion, ...]:
    """Return the independent motions of elements, those that a yaw damper reaches first.

    With the law n / d = C_s s / (1 + C_s s / K) of a yaw damper the determinant is ``d free + n locked``, where `free`
    is the determinant without the damper and `locked` the one in which its displacement is held at zero; so with
    several dampers it is a sum over all ways to free and to lock them.

    Parameters
    ----------
    elements : sequence
        In half sums and half differences. Of the links with `varied` the damping is not looked at.

    Raises
    ------
    ValueError
        If a yaw damper has no name, or is not one damper in series with a spring.
    """
    dampers = {damper.own_name: _law(damper) for damper in _yaw_dampers(elements)}
    matrix = Determinant(_without_laws(polynomial_matrix(_with_unit_laws(elements)), dampers))
    found = []
    for name, coordinates, piece in _parts(elements, matrix):
        own = {damper: law for damper, law in dampers.items() if damper in piece}
        found.append(Motion(name, coordinates, _coefficients(matrix, piece, own), len(own)))
    return tuple(found)


def polynomials(elements: Sequence[Single]) -> dict[str, Polynomial]:
    """Return the characteristic polynomial of every motion at the yaw damping that the elements have, by its name.

    The polynomials are those of `motions`, lowest power of s first, but for rounding. With the yaw dampers' laws in the
    matrix there is one determinant instead of one for every way to free and to lock them: with two, half the work.

    Parameters
    ----------
    elements : sequence
        As in `motions`; a yaw damper that has no damping may leave highest coefficients that are zero.
    """
    matrix = Determinant(polynomial_matrix(elements))
    return {name: matrix.of(piece) for name, _, piece in _parts(elements, matrix)}


def _yaw_dampers(elements: Iterable[Single]) -> list[Link]:
    return [e for e in elements if isinstance(e, Link) and e.varied]


def _parts(elements: Sequence[Single], matrix: Determinant) -> list[tuple[str, frozenset[str], frozenset[Node]]]:
    """Return name, coordinates and nodes of all motions, those that a yaw damper reaches first."""
    dampers = {damper.own_name for damper in _yaw_dampers(elements)}
    masses = {e.coordinate: e for e in elements if isinstance(e, Mass)}
    found = []
    for piece in matrix.factors(matrix.nodes):
        coordinates = frozenset(x for x in masses if x in piece)
        if coordinates:
            name = COUPLED if dampers & piece else _name([masses[x] for x in sorted(coordinates)])
            found.append((name, coordinates, piece))
    return sorted(found, key=lambda part: part[0] != COUPLED)


def _law(damper: Link) -> Law:
    """Return what C_s multiplies in the law of a yaw damper: share s in its numerator, share s / K in 1 + C_s ..."""
    match damper.laws:
        case (Maxwell(K=K),):
            return (0, damper.share), (0, damper.share / K)
        case (Dashpot(),):
            return (0, damper.share), ZERO
    raise ValueError(f"{damper.name} must be one damper, in series with a spring or not: its damping is C_s")


def _with_unit_laws(elements: Iterable[Single]) -> list[Single]:
    return [replace(e, laws=(Spring(1),)) if isinstance(e, Link) and e.varied else e for e in elements]


def _without_laws(entries: dict[Any, Polynomial], dampers: Iterable[str]) -> dict[Any, Polynomial]:
    """Return the matrix in which the displacement of every yaw damper is held at zero."""
    held = {(name, name) for name in dampers}
    return {place: p for place, p in entries.items() if place not in held}


def _coefficients(matrix: Determinant, piece: frozenset[Node], dampers: dict[str, Law]) -> tuple[Polynomial, ...]:
    """Return the polynomial of a piece by powers of C_s, given the laws of the yaw dampers in it."""
    powers: list[Polynomial] = [ZERO] * (len(dampers) + 1)
    for count in range(len(dampers) + 1):
        for locked in combinations(dampers, count):
            free = [name for name in dampers if name not in locked]
            minor = _minor(matrix, piece - set(free), locked)
            # Every locked damper brings its numerator, every free one its denominator.
            laws = [(ZERO, dampers[name][0]) for name in locked] + [(ONE, dampers[name][1]) for name in free]
            for power, factor in enumerate(_product(laws)):
                powers[power] = add(powers[power], multiply(factor, minor))
    return tuple(powers)


def _minor(matrix: Determinant, nodes: frozenset[Node], locked: Sequence[str]) -> Polynomial:
    return matrix.rooted(locked[0], nodes, ZERO) if locked else matrix.of(nodes)


def _product(laws: Sequence[tuple[Polynomial, Polynomial]]) -> list[Polynomial]:
    """Return the product of laws a + C_s b by powers of C_s."""
    product: list[Polynomial] = [ONE]
    for a, b in laws:
        grown: list[Polynomial] = [ZERO] * (len(product) + 1)
        for power, p in enumerate(product):
            grown[power] = add(grown[power], multiply(a, p))
            grown[power + 1] = add(grown[power + 1], multiply(b, p))
        product = grown
    return product


def _name(masses: Sequence[Mass]) -> str:
    """Return what moves in a motion that no yaw damper reaches."""
    alone = {(mass.alone, parted(mass.coordinate)[1]) for mass in masses}
    subject, ends = alone.pop()
    if not subject or alone:
        return ", ".join(mass.coordinate for mass in masses)
    inner, outer = TOGETHER.get(ends[-1:], ""), BOGIES.get(ends[:-1], "")
    return ", ".join(filter(None, (f"{subject} {inner}".strip(), outer)))

"""Elements of a linear vehicle: force laws, links, masses, wheel-rail contact, and pairs of them at both ends.

A *law* says what force answers a relative displacement ``u``, as a ratio of polynomials in s. A *link* puts laws in
parallel between coordinates. Everything here holds numbers of any type (see :mod:`yawdesign.vehicle.polynomials`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

from yawdesign.vehicle.polynomials import ONE, Number, Polynomial, add, multiply, times

Coefficients = Mapping[str, Number]


class Law(Protocol):
    """What a link does with its relative displacement u: force = numerator(s) / denominator(s) u."""

    @property
    def numerator(self) -> Polynomial:
        """Lowest power first."""

    @property
    def denominator(self) -> Polynomial:
        """Lowest power first, first coefficient 1."""


@dataclass(frozen=True)
class Spring:
    """Spring, force K u (K in N/m or N m/rad)."""

    K: Number
    denominator: Polynomial = ONE

    @property
    def numerator(self) -> Polynomial:
        """Stiffness."""
        return (self.K,)


@dataclass(frozen=True)
class Dashpot:
    """Viscous damper, force c u' (c in N s/m or N m s/rad)."""

    c: Number
    denominator: Polynomial = ONE

    @property
    def numerator(self) -> Polynomial:
        """Damping times s."""
        return (0, self.c)


@dataclass(frozen=True)
class Maxwell:
    """Damper in series with a spring, force K c s / (K + c s) u.

    Both polynomials are divided by K, so that a rigid joint (K -> inf) is a plain dashpot. A damper with a joint of
    stiffness k at both ends has K = k / 2 (eqs (4) to (6) of the paper with the pistons eliminated).

    Parameters
    ----------
    K : number
        Series stiffness [N/m].
    c : number
        Damping [N s/m].
    """

    K: Number
    c: Number

    @property
    def numerator(self) -> Polynomial:
        """Damping times s."""
        return (0, self.c)

    @property
    def denominator(self) -> Polynomial:
        """1 + c s / K."""
        return (1, self.c / self.K)


def parallel(laws: tuple[Law, ...]) -> tuple[Polynomial, Polynomial]:
    """Return numerator and denominator of laws that share their displacement."""
    numerator, denominator = laws[0].numerator, laws[0].denominator
    for law in laws[1:]:
        numerator = add(multiply(numerator, law.denominator), multiply(law.numerator, denominator))
        denominator = multiply(denominator, law.denominator)
    return numerator, denominator


@dataclass(frozen=True)
class Link:
    """Laws in parallel between coordinates.

    Parameters
    ----------
    laws : tuple of Law
        What answers the relative displacement.
    gap : mapping coordinate -> coefficient
        The relative displacement u = sum of coefficient * coordinate. The force acts back with the same coefficients.
    lever : mapping, optional
        The part of u that changes its sign at the rear end, if the link stands in a `Pair`.
    acts_on : set of coordinates, optional
        Where the force acts; all coordinates of u if not given (Newton's third law). The paper's printed equations
        lack one reaction; that is what this is for.
    name : str, optional
        A name by which the link can be found in the matrix.
    """

    laws: tuple[Law, ...]
    gap: Coefficients
    lever: Coefficients = field(default_factory=dict)
    acts_on: frozenset[str] | None = None
    name: str = ""

    @property
    def displacement(self) -> Coefficients:
        """Gap and lever together."""
        return {**self.gap, **self.lever}

    @property
    def force(self) -> Coefficients:
        """What the force is multiplied by in the equation of each coordinate it acts on."""
        acting = self.displacement if self.acts_on is None else self.acts_on
        return {x: g for x, g in self.displacement.items() if x in acting}


@dataclass(frozen=True)
class Mass:
    """Mass (or moment of inertia) m of one coordinate."""

    coordinate: str
    m: Number


@dataclass(frozen=True)
class WheelRailContact:
    """Linear creep and gravitational stiffness of one wheelset (eq. (2)).

    In the equations of y and phi stand ``W lambda/b y + 2 f_11 (y'/v - phi)`` and
    ``-W b lambda phi + 2 f_22 (b lambda/r y + b^2 phi'/v)``. The rail comes in where the wheelset's displacement on it
    matters: ``y - y_a`` stands in the gravitational stiffness and in the conicity term, and a cross-level angle theta
    pushes with ``W theta``. The creep of y' knows no rail velocity.

    Parameters
    ----------
    y, phi : str
        Coordinates of the wheelset: lateral [m], yaw [rad].
    W : number
        Axle load [N].
    conicity, b, r : number
        Equivalent conicity [-], half distance of the contact points [m], rolling radius [m].
    f_11, f_22 : number
        Lateral and longitudinal creep coefficient of one wheel [N].
    v : number
        Speed [m/s].
    alignment, cross_level : str, optional
        Inputs of the track under the wheelset: lateral position of the track's centre line y_a [m] and cross-level
        angle theta [rad].
    """

    y: str
    phi: str
    W: Number
    conicity: Number
    b: Number
    r: Number
    f_11: Number
    f_22: Number
    v: Number
    alignment: str = "alignment"
    cross_level: str = "cross_level"

    def entries(self) -> dict[tuple[str, str], Polynomial]:
        """Return the polynomial entries (row, column) of the contact."""
        gravity = self.W * self.conicity
        return {
            (self.y, self.y): (gravity / self.b, 2 * self.f_11 / self.v),
            (self.y, self.phi): (-2 * self.f_11,),
            (self.phi, self.y): (2 * self.f_22 * self.b * self.conicity / self.r,),
            (self.phi, self.phi): (-gravity * self.b, 2 * self.f_22 * self.b * self.b / self.v),
        }

    def inputs(self) -> dict[tuple[str, str], Number]:
        """Return the force [N], or moment [N m], in the equation of a coordinate per unit of a track input."""
        entries = self.entries()
        return {
            (self.y, self.alignment): entries[self.y, self.y][0],
            (self.y, self.cross_level): self.W,
            (self.phi, self.alignment): entries[self.phi, self.y][0],
        }


Single = Link | Mass | WheelRailContact


@dataclass(frozen=True)
class Pair:
    """The same elements at the front and at the rear end of a vehicle.

    Parameters
    ----------
    elements : tuple
        The front end's elements. In the rear ones the `Link.lever` has the opposite sign.
    own : set of str
        Coordinates that each end has for itself: ``y_w`` becomes ``y_w1`` and ``y_w2``, or, folded, half the sum
        ``y_w+`` and half the difference ``y_w-``. So do the track inputs: ``alignment_1``, ``alignment_2``.
    """

    elements: tuple[Single, ...]
    own: frozenset[str] = frozenset()

    def ends(self) -> list[Single]:
        """Return front and rear elements, in the coordinates of each end."""
        return [self._rename(_at_end(e, sign), end) for end, sign in (("1", 1), ("2", -1)) for e in self.elements]

    def folded(self) -> list[Single]:
        """Return the elements acting on half the sums and half the differences of the two ends.

        Sums meet only the even part of a link's displacement, differences only its lever; so the two groups are
        coupled by nothing but the bodies that both ends share, and the coupling graph of a bogie becomes a tree.
        """
        return [self._rename(half, sign) for sign in "+-" for e in self.elements if (half := self._fold(e, sign))]

    def _fold(self, element: Single, sign: str) -> Single | None:
        if not isinstance(element, Link):
            return element
        shared = {x: g for x, g in element.gap.items() if x not in self.own} if sign == "+" else element.lever
        own = {x: g for x, g in element.gap.items() if x in self.own}
        if not shared and not own:
            return None
        # Half the sum of two forces is what each end's own equation sees; a shared body feels both ends: twice that.
        return _Folded(element.laws, {**shared, **own}, acts_on=element.acts_on, name=element.name, own=self.own)

    def _rename(self, element: Single, suffix: str) -> Single:
        def new(x: str) -> str:
            return x + suffix if x in self.own else x

        match element:
            case Mass():
                return replace(element, coordinate=new(element.coordinate))
            case WheelRailContact():
                track = {x: f"{getattr(element, x)}_{suffix}" for x in ("alignment", "cross_level")}
                return replace(element, y=new(element.y), phi=new(element.phi), **track)
        renamed = replace(
            element,
            gap={new(x): g for x, g in element.gap.items()},
            acts_on=None if element.acts_on is None else frozenset(map(new, element.acts_on)),
            name=element.name and element.name + suffix,
        )
        if isinstance(renamed, _Folded):
            return replace(renamed, own=frozenset(map(new, renamed.own)))
        return renamed


@dataclass(frozen=True)
class _Folded(Link):
    """A pair of links seen by half the sum, or half the difference, of their displacements."""

    own: frozenset[str] = frozenset()

    @property
    def force(self) -> Coefficients:
        return {x: g if x in self.own else times(2, g) for x, g in super().force.items()}


def _at_end(element: Single, sign: int) -> Single:
    if not isinstance(element, Link) or not element.lever:
        return element
    return replace(element, lever={x: times(sign, g) for x, g in element.lever.items()})


Element = Single | Pair

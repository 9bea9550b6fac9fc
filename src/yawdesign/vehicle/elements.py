"""Elements of a linear vehicle: force laws, links, masses, wheel-rail contact, and pairs of them at both ends.

A *law* says what force answers a relative displacement ``u``, as a ratio of polynomials in s. A *link* puts laws in
parallel between coordinates. Everything here holds numbers of any type (see :mod:`yawdesign.vehicle.polynomials`).
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

from yawdesign.vehicle.polynomials import ONE, Number, Polynomial, add, multiply, plus, times, trim

Coefficients = Mapping[str, Any]


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
    outer : mapping, optional
        The same for the pair that holds that pair.
    acts_on : set of coordinates, optional
        Where the force acts; all coordinates of u if not given (Newton's third law). The paper's printed equations
        lack one reaction; that is what this is for.
    name : str, optional
        What people call it, such as ``yaw damper``. Outputs and modes of a damper in series with a spring are named
        after it, so such a damper must have one.
    pieces : int
        How many equal ones the link stands for.
    varied : bool
        Whether it is a yaw damper: its damping is C_s, in whose powers the motions are written.
    share : number
        What C_s is multiplied by in it [-].
    ends : mapping coordinate -> int, optional
        How many ends of pairs a coordinate feels at once where half sums and differences stand for both ends.
    """

    laws: tuple[Law, ...]
    gap: Coefficients
    lever: Coefficients = field(default_factory=dict)
    outer: Coefficients = field(default_factory=dict)
    acts_on: frozenset[str] | None = None
    name: str = ""
    pieces: int = 1
    varied: bool = False
    share: Number = 1
    ends: Mapping[str, int] = field(default_factory=dict)

    @property
    def displacement(self) -> Coefficients:
        """All parts of u together."""
        return joined(self.gap, self.lever, self.outer)

    @property
    def force(self) -> Coefficients:
        """What the force is multiplied by in the equation of each coordinate it acts on."""
        acting = self.displacement if self.acts_on is None else self.acts_on
        return {x: times(self.ends.get(x, 1), g) for x, g in self.displacement.items() if x in acting}

    @property
    def maxwell(self) -> "tuple[Maxwell, ...]":
        """Its dampers that are in series with a spring."""
        return tuple(law for law in self.laws if isinstance(law, Maxwell))

    @property
    def own_name(self) -> str:
        """Its name; a ValueError says where it acts if it has none."""
        if not self.name:
            raise ValueError(f"a damper in series with a spring has no name, at {', '.join(self.displacement)}")
        return self.name


def joined(*parts: Coefficients) -> dict[str, Any]:
    """Return the sum of parts of a displacement."""
    out: dict[str, Any] = {}
    for part in parts:
        for x, g in part.items():
            out[x] = plus(out[x], g) if x in out else g
    return out


@dataclass(frozen=True)
class Mass:
    """Mass (or moment of inertia) m of one coordinate.

    Parameters
    ----------
    coordinate : str
        Its name, such as ``y_b``.
    m : number
        Mass [kg], or moment of inertia [kg m^2].
    unit : {"m", "rad"}
        Unit of the coordinate.
    body : str, optional
        What it is part of, such as ``wheelset``; what follows is said of its coordinate.
    name : str, optional
        What a mode is called in which it moves most; the coordinate's own name if not given.
    creeping : str, optional
        The same for a mode that does not oscillate.
    alone : str, optional
        What moves if nothing else does: the subject of "against each other".
    """

    coordinate: str
    m: Number
    unit: str = "m"
    body: str = ""
    name: str = ""
    creeping: str = ""
    alone: str = ""


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
    gravitates : bool
        Whether the gravitational stiffness is there: the terms with W, but for that of theta.
    spinning : number
        Moment of inertia about the axle [kg m^2]. As the wheelset runs, shifted by y, it rolls by lambda y / b, and the
        spin v / r turns a roll velocity into a yaw moment, a yaw velocity into a lateral force.
    ahead : number
        How far the wheelset stands in front of the vehicle's centre [m]; which track it meets when follows from this.
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
    gravitates: bool = True
    spinning: Number = 0
    ahead: Number = 0

    def entries(self) -> dict[tuple[str, str], Polynomial]:
        """Return the polynomial entries (row, column) of the contact."""
        gravity = self.W * self.conicity if self.gravitates else 0
        spin = times(self.spinning, self.v * self.conicity / (self.r * self.b))
        return {
            (self.y, self.y): (gravity / self.b if self.gravitates else 0, 2 * self.f_11 / self.v),
            (self.y, self.phi): trim((-2 * self.f_11, times(-1, spin)), _is_absent),
            (self.phi, self.y): trim((2 * self.f_22 * self.b * self.conicity / self.r, spin), _is_absent),
            (self.phi, self.phi): (
                -gravity * self.b if self.gravitates else 0,
                2 * self.f_22 * self.b * self.b / self.v,
            ),
        }

    def inputs(self) -> dict[tuple[str, str], Any]:
        """Return the force [N], or moment [N m], in the equation of a coordinate per unit of a track input."""
        entries = self.entries()
        return {
            (self.y, self.alignment): entries[self.y, self.y][0],
            (self.y, self.cross_level): self.W,
            (self.phi, self.alignment): entries[self.phi, self.y][0],
        }


def _is_absent(x: Any) -> bool:
    return type(x) is int and x == 0


@dataclass(frozen=True)
class Point:
    """A point of a body whose motion is looked at beside the coordinates.

    Parameters
    ----------
    name : str
        Like that of a coordinate, such as ``y_c``: in a pair ``y_c1`` at the front end and ``y_c2`` at the rear one.
    gap, lever : mapping coordinate -> coefficient
        Its displacement, as in a `Link`.
    unit : {"m", "rad"}
        Unit of the displacement.
    """

    name: str
    gap: Coefficients
    lever: Coefficients = field(default_factory=dict)
    unit: str = "m"


Single = Link | Mass | WheelRailContact | Point


@dataclass(frozen=True)
class Pair:
    """The same elements at the front and at the rear end of a vehicle, or of a part of it.

    Parameters
    ----------
    elements : tuple
        The front end's elements, pairs among them. In the rear ones the `Link.lever` has the opposite sign.
    own : set of str
        Coordinates that each end has for itself: ``y_w`` becomes ``y_w1`` and ``y_w2``, or, folded, half the sum
        ``y_w+`` and half the difference ``y_w-``. So do the track inputs: ``alignment_1``, ``alignment_2``, and what
        belongs to the ends of a pair inside: ``y_w11``, ``y_w12``, ``y_w21``, ``y_w22``, the outer end first.
    rear : tuple, optional
        The rear end's elements, the same but for their numbers, where these differ. Such a pair is not folded.
    half : number
        Half the distance of both ends [m]; 0 where no wheelset stands in the pair.
    """

    elements: "tuple[Element, ...]"
    own: frozenset[str] = frozenset()
    rear: "tuple[Element, ...]" = ()
    half: Number = 0

    def both_ends(self) -> list[Single]:
        """Return front and rear elements, in the coordinates of each end."""
        return self._apart(physical(self.elements), physical(self.rear or self.elements))

    def folded(self) -> list[Single]:
        """Return the elements acting on half the sums and half the differences of the two ends.

        Sums meet only the even part of a link's displacement, differences only its lever; so the two groups are
        coupled by nothing but the bodies that both ends share, and the coupling graph of a bogie becomes a tree.
        """
        inside = folded(self.elements)
        if self.rear:
            return self._apart(inside, folded(self.rear))
        return [self._rename(half, sign) for sign in "+-" for e in inside if (half := self._fold(e, sign))]

    def _apart(self, front: "Iterable[Single]", rear: "Iterable[Single]") -> list[Single]:
        ends = (("1", 1, front), ("2", -1, rear))
        return [self._rename(_at_end(e, sign, self.half), end) for end, sign, inside in ends for e in inside]

    def _owns(self, x: str) -> bool:
        return parted(x)[0] in self.own

    def _fold(self, element: Single, sign: str) -> Single | None:
        if isinstance(element, Point):
            part = element.gap if sign == "+" else element.lever
            return replace(element, gap=part, lever={}) if part else None
        if not isinstance(element, Link):
            return element
        own = {x: g for x, g in element.gap.items() if self._owns(x)}
        shared = {x: g for x, g in element.gap.items() if x not in own} if sign == "+" else element.lever
        if not shared and not own:
            return None
        # What changes its sign with the outer end is alike at both inner ones.
        lever = element.outer if sign == "+" else {}
        # Half the sum of two forces is what each end's own equation sees; a shared body feels both ends: twice that.
        ends = {**element.ends, **{x: 2 * element.ends.get(x, 1) for x in (*shared, *lever)}}
        return replace(element, gap={**shared, **own}, lever=lever, outer={}, ends=ends)

    def _rename(self, element: Single, suffix: str) -> Single:
        def new(x: str) -> str:
            return _numbered(x, suffix) if self._owns(x) else x

        match element:
            case Mass():
                return replace(element, coordinate=new(element.coordinate))
            case WheelRailContact():
                track: Any = {x: _numbered(getattr(element, x), suffix, "_") for x in ("alignment", "cross_level")}
                return replace(element, y=new(element.y), phi=new(element.phi), **track)
            case Point():
                moved: Any = {part: {new(x): g for x, g in getattr(element, part).items()} for part in ("gap", "lever")}
                return replace(element, name=_numbered(element.name, suffix), **moved)
        parts: Any = {part: {new(x): g for x, g in getattr(element, part).items()} for part in ("gap", "lever", "ends")}
        acts_on = None if element.acts_on is None else frozenset(map(new, element.acts_on))
        return replace(element, acts_on=acts_on, name=element.name and _numbered(element.name, suffix, " "), **parts)


def parted(name: str) -> tuple[str, str]:
    """Return a name without its ends, and these."""
    stem = name.rstrip("12+-")
    return stem, name[len(stem) :]


def _numbered(name: str, suffix: str, blank: str = "") -> str:
    """Return a name with an end behind it, and behind that the end inside."""
    stem, inside = parted(name)
    return stem + suffix + inside if inside else f"{name}{blank}{suffix}"


def _at_end(element: Single, sign: int, half: Number) -> Single:
    """Return an element at the front (+1) or rear (-1) end; its lever then is that of the next pair around."""
    match element:
        case WheelRailContact():
            return replace(element, ahead=plus(element.ahead, times(sign, half)))
        case Mass():
            return element
    gap = joined(element.gap, {x: times(sign, g) for x, g in element.lever.items()})
    if isinstance(element, Point):
        return replace(element, gap=gap, lever={})
    return replace(element, gap=gap, lever=element.outer, outer={})


Element = Single | Pair


def physical(elements: Iterable[Element]) -> list[Single]:
    """Return the elements in the coordinates of each end (y_w1, y_w2, ...)."""
    return [s for e in elements for s in (e.both_ends() if isinstance(e, Pair) else [e])]


def folded(elements: Iterable[Element]) -> list[Single]:
    """Return the elements in half sums and half differences of both ends (y_w+, y_w-, ...)."""
    return [s for e in elements for s in (e.folded() if isinstance(e, Pair) else [e])]

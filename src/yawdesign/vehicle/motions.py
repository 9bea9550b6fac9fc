"""The characteristic polynomial A(s) + C_s B(s) of a bogie, with its exact factors split off."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from yawdesign.vehicle.assembly import folded, polynomial_matrix
from yawdesign.vehicle.catalogue import YAW_DAMPER, Parameters, bogie
from yawdesign.vehicle.elements import Element, Link, Single, Spring
from yawdesign.vehicle.polynomials import ZERO, Determinant, Number, Polynomial, add, product, scale, scale_variable

FACTOR_NAMES = {
    frozenset({"phi_m-"}): "motors yawing against each other",
    frozenset({"phi_m+"}): "motors yawing together",
}
DAMPER_FACTOR = "yaw dampers against each other"


@dataclass(frozen=True)
class Characteristic:
    """Characteristic polynomial ``(A(s) + C_s B(s)) * product of factors`` of the coupled and the decoupled motions.

    All polynomials have their lowest power first. The highest coefficient may be zero where a damper has none.

    Parameters
    ----------
    A, B : tuple
        The coupled motion; degree 23 with reciprocal equations, 21 as printed, 15 without motors.
    factors : mapping name -> polynomial
        Motions of their own that no yaw damper reaches.
    """

    A: Polynomial
    B: Polynomial
    factors: Mapping[str, Polynomial]

    def core(self, C_s: Number) -> Polynomial:
        """Return the coupled motion's polynomial A + C_s B."""
        return add(self.A, scale(self.B, C_s))

    def full(self, C_s: Number) -> Polynomial:
        """Return the polynomial of all modes (degree 25, without motors 15)."""
        return product([self.core(C_s), *self.factors.values()])


def characteristic(p: Parameters, *, kind: str = "power", equations: str = "reciprocal") -> Characteristic:
    """Return the characteristic polynomial of the paper's bogie, for any number type.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units, and ``v`` [m/s]. ``C_s`` is not needed: the polynomial is linear in it.
    kind, equations : str
        As in `yawdesign.vehicle.catalogue.bogie`.

    Examples
    --------
    >>> from yawdesign import table1
    >>> problem = table1()
    >>> c = characteristic({**problem.bogie.parameters(), "v": 300 / 3.6})
    >>> len(c.A), len(c.B), list(c.factors)
    (23, 24, ['motors yawing against each other'])
    """
    return split(bogie({**p, "C_s": 0}, kind=kind, equations=equations), p["K_ds"])


def split(elements: Iterable[Element], K_ds: Number) -> Characteristic:
    """Return the characteristic polynomial of any vehicle with a link named `YAW_DAMPER`, as a function of its C_s.

    With the law C_s s / (1 + C_s s / K_ds) the determinant is ``free (1 + C_s s / K_ds) + locked C_s s``, where `free`
    is the determinant without the damper and `locked` the one in which its displacement is held at zero.

    Parameters
    ----------
    elements : iterable
        The vehicle; the law of the named link is not looked at.
    K_ds : number
        Series stiffness of the yaw damper [N/m].
    """
    unit_law = [_with_unit_law(e) for e in folded(elements)]
    matrix = Determinant(polynomial_matrix(unit_law))
    pieces = matrix.factors(matrix.nodes)
    core = next(piece for piece in pieces if YAW_DAMPER in piece)
    free = matrix.of(core - {YAW_DAMPER})
    locked = matrix.rooted(YAW_DAMPER, core, ZERO)
    factors = {_factor_name(piece): matrix.of(piece) for piece in pieces if piece != core}
    return Characteristic(free, (0, *add(scale(free, 1 / K_ds), locked)), factors)


def _with_unit_law(element: Single) -> Single:
    if isinstance(element, Link) and element.name == YAW_DAMPER:
        return replace(element, laws=(Spring(1),))
    return element


def _factor_name(piece: Iterable[object]) -> str:
    coordinates = frozenset(x for x in piece if isinstance(x, str))
    return FACTOR_NAMES.get(coordinates, ", ".join(sorted(coordinates)))


def paper_coefficients(
    p: Parameters, C_s: Number, *, kind: str = "power", equations: str = "reciprocal", unit: Number = 1
) -> tuple[Number, ...]:
    """Return chi_0 ... chi_26 of eq. (9), the determinant of the 22 x 22 matrix (7), highest power of s first.

    Parameters
    ----------
    p, kind, equations
        As in `characteristic`.
    C_s : number
        Damping of the pair of yaw dampers [N s/m].
    unit : number, optional
        Time scale [rad/s]: the coefficients are those of the polynomial in s / unit.

    Returns
    -------
    tuple
        27 coefficients (17 without motors); with the model as printed those of (7) to the last factor.
    """
    c = characteristic(p, kind=kind, equations=equations)
    joints = [p["K_ds"], p["K_dt"]] + ([p["K_dm"]] if kind == "power" else [])
    fourth = product([(K,) for K in joints for _ in range(4)])
    whole = product([c.full(C_s), (1, C_s / p["K_ds"]), fourth])
    return tuple(reversed(scale_variable(whole, unit)))

"""The second route to a margin: Routh's array of the polynomials, which knows nothing of eigenvalues."""

import decimal
import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise

import numpy as np

from yawdesign.damper.design_space import Space, Values
from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.hurwitz import hurwitz_minors
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.many.worst_margin import WorstMargin
from yawdesign.hunting.routh import TIME_UNIT, routh_column, sector_column, sector_rows
from yawdesign.hunting.verdict import Stability, stability_at
from yawdesign.problem import exact
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.polynomials import Polynomial, scale_variable, shift, trim
from yawdesign.vehicle.vehicle import Model, Vehicle

# How close the margins by two routes must be. Where two roots coalesce, as they do at many optima, an eigenvalue is
# right to 1e-8 of its own modulus only; a hunting mode's is 10 ... 30 rad/s.
AGREE = {"decay_rate": 2e-5, "damping_ratio": 1e-6}
SECTIONS, LEVELS = 3, 1025  # how often the margin is enclosed, and by how many levels
DIGITS, HALVINGS = 100, 24  # with exact coefficients
TOO_MANY = 1000  # roots: what is counted where Routh's array breaks down


LOOKED_AT = 24  # conditions of the least margins that are looked at one by one


@dataclass(frozen=True)
class Checked:
    """A design under all conditions that are known, by two routes.

    Parameters
    ----------
    vehicles : tuple of Vehicle
        Under the conditions of the least margins, the worst first.
    results : tuple of Stability
        The stability of each.
    worst : Condition
        The worst condition.
    margin, second : float
        The worst margin by eigenvalues, and by Routh's array [1/s], [-].
    stable : bool
        Whether it is stable under every condition.
    agree : bool
        Whether both routes agree.
    """

    vehicles: tuple[Vehicle, ...]
    results: tuple[Stability, ...]
    worst: Condition
    margin: float
    second: float
    stable: bool
    agree: bool


def checked_under_all(space: Space, values: Values) -> Checked:
    """Return a design under all conditions of a space: the worst ones one by one, the others by verdicts on arrays.

    Parameters
    ----------
    space : Space
        With the conditions that are looked at.
    values : mapping
        The design's parameters, C_s among them.
    """
    sets, tolerance = ParameterSets(space.model, values, 1), AGREE[space.objective]
    measure = Measure(space.objective, space.names)
    order = np.argsort(WorstMargin(space.conditions, measure).under_each(sets)[:, 0], kind="stable")
    near, far = order[:LOOKED_AT], order[LOOKED_AT:]
    vehicles = [space.model.at(space.conditions[k].applied(values)) for k in near]
    results = [stability_at(vehicle, space.names) for vehicle in vehicles]
    margins = [float(getattr(result, space.objective)) for result in results]
    first = int(np.argmin(margins))
    margin = margins[first]
    second = margin_by_routh(space, vehicles, margin)
    stable, agree = all(result.stable for result in results), all(result.checked for result in results)
    if len(far):
        others = [space.conditions[k] for k in far]
        every = Measure("decay_rate", space.model.parameters)
        stable &= bool(WorstMargin(others, every).exceeds(sets, np.zeros(1))[0])
        agree &= margin < 0 or bool(WorstMargin(others, measure).exceeds(sets, np.array([margin - tolerance]))[0])
    turned = [first, *(k for k in range(len(near)) if k != first)]
    return Checked(
        vehicles=tuple(vehicles[k] for k in turned),
        results=tuple(results[k] for k in turned),
        worst=space.conditions[near[first]],
        margin=margin,
        second=second,
        stable=stable,
        agree=agree and abs(second - margin) <= tolerance,
    )


@dataclass(frozen=True)
class NextMargin:
    """The worst margin of all modes but those that cap it, by eigenvalues, and whether Routh's array agrees."""

    margin: float
    agree: bool


def next_margins(space: Space, vehicles: Sequence[Vehicle]) -> NextMargin:
    """Return the worst margin of all modes but those that cap it. Parameters as in `margin_by_routh`."""
    others = Measure(space.objective, space.names, pairs=space.pairs)
    margin = min(float(others.of(ParameterSets(space.model, vehicle.p, 1))[0]) for vehicle in vehicles)
    second = margin_by_routh(space, vehicles, margin, space.pairs)
    return NextMargin(margin, abs(second - margin) <= AGREE[space.objective])


def margin_by_routh(space: Space, vehicles: Sequence[Vehicle], margin: float, pairs: int = 0) -> float:
    """Return the margin by Routh's array, looked for around the one by eigenvalues; NaN if it is not there.

    Parameters
    ----------
    space : Space
        The design space, with the variables and the objective.
    vehicles : sequence of Vehicle
        The design under each condition.
    margin : float
        By eigenvalues [1/s], [-].
    pairs : int, optional
        So many pairs of roots, those of the least margins, are left out under each condition.
    """
    found = _in_double_precision(space, vehicles, margin, pairs)
    if abs(found - margin) <= AGREE[space.objective]:
        return found
    return _in_decimals(space, vehicles, margin, pairs)


def _in_double_precision(space: Space, vehicles: Sequence[Vehicle], margin: float, pairs: int) -> float:
    ratio, chosen = space.objective == "damping_ratio", [_polynomials(space, vehicle) for vehicle in vehicles]

    def exceeded(level: Float) -> Bools:
        counts = [np.sum([_beyond(p, level, ratio) for p in polynomials], axis=0) for polynomials in chosen]
        return np.asarray(np.max(counts, axis=0) <= (pairs if ratio else 2 * pairs))

    if ratio and margin <= 0:  # the sector's scheme ends at zero
        return float("nan") if exceeded(np.zeros(1)) else margin
    low, high = margin - 100 * AGREE[space.objective], margin + 100 * AGREE[space.objective]
    for _ in range(SECTIONS):
        levels = np.linspace(max(low, 0) if ratio else low, high, LEVELS)
        passed = exceeded(levels)
        if not passed[0] or passed.all():
            return float("nan")
        end = int(np.argmin(passed))  # the first that is not exceeded
        low, high = levels[end - 1], levels[end]
    return float(low)


def _in_decimals(space: Space, vehicles: Sequence[Vehicle], margin: float, pairs: int) -> float:
    """Return the same from exact coefficients: where roots are close to each other, double precision does not tell."""
    ratio = space.objective == "damping_ratio"
    with decimal.localcontext(decimal.Context(prec=DIGITS, Emax=decimal.MAX_EMAX, Emin=decimal.MIN_EMIN, traps=[])):
        exactly = [vehicle.model.at({name: exact(x) for name, x in vehicle.p.items()}) for vehicle in vehicles]
        chosen = [[tuple(map(_decimal, p)) for p in _polynomials(space, vehicle)] for vehicle in exactly]

        def exceeded(level: Decimal) -> bool:
            counts = [sum(_beyond_exactly(p, level, ratio) for p in polynomials) for polynomials in chosen]
            return max(counts) <= (pairs if ratio else 2 * pairs)

        near = Decimal(AGREE[space.objective])
        low, high = Decimal(margin) - near, Decimal(margin) + near
        if low < 0 < ratio or not exceeded(low) or exceeded(high):
            return float("nan")
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if exceeded(middle) else (low, middle)
        return float(low)


def _polynomials(space: Space, vehicle: Vehicle) -> list[Polynomial]:
    """Return the polynomials that count in the margin, in s / (100 rad/s)."""
    movable = space.model.movable(space.names)
    chosen = [motion for motion in vehicle.motions if motion.name in movable]
    return [scale_variable(trim(motion.polynomial(vehicle.C_s)), int(TIME_UNIT)) for motion in chosen]


def _decimal(x: Fraction) -> Decimal:
    return Decimal(Fraction(x).numerator) / Decimal(Fraction(x).denominator)


def _beyond(p: Polynomial, level: Float, ratio: bool) -> Index:
    """Return how many roots of a polynomial lie beyond a level: of those in a sector one of each pair is counted."""
    with np.errstate(all="ignore"):
        entries = sector_column(p, level) if ratio else routh_column(shift(p, -level / TIME_UNIT))
        column = np.array([np.broadcast_to(x, level.shape) for x in entries], dtype=float)
        changes = np.sum(np.sign(column[1:]) != np.sign(column[:-1]), axis=0)
    regular = np.isfinite(column).all(axis=0) & (column != 0).all(axis=0)
    return np.asarray(np.where(regular, changes, TOO_MANY), dtype=np.intp)


def _beyond_exactly(p: Polynomial, level: Decimal, ratio: bool) -> int:
    """Return the same of decimals."""
    if ratio:
        column = [row[0] for row in sector_rows(p, -level, (1 - level * level).sqrt())]
    else:
        column = routh_column(shift(p, -level / int(TIME_UNIT)))
    if not all(math.isfinite(x) and x for x in column):
        return TOO_MANY
    return sum((a > 0) != (b > 0) for a, b in pairwise(column))


def hurwitz_positive(vehicle: Vehicle) -> bool:
    """Return whether all Hurwitz minors are positive: of the paper's polynomial where the vehicle is one of the paper.

    Other vehicles, with a car body or with rigid joints, have no printed matrix; there it is each motion's own.
    """
    if vehicle.model == Model(vehicle.model.kind, vehicle.model.equations):
        polynomials = [vehicle.paper_coefficients(TIME_UNIT)[::-1]]
    else:
        polynomials = [scale_variable(motion.polynomial(vehicle.C_s), TIME_UNIT) for motion in vehicle.motions]
    # A damper without damping lowers the degree.
    return all(sign > 0 for p in polynomials for sign in hurwitz_minors(trim(p)[::-1])[0])

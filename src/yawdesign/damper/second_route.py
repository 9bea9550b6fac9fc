"""The second route to a margin: Routh's array of the polynomials, which knows nothing of eigenvalues."""

from collections.abc import Sequence

import numpy as np

from yawdesign.damper.design_space import Space
from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.hurwitz import hurwitz_minors
from yawdesign.hunting.routh import TIME_UNIT, routh_column, sector_column
from yawdesign.vehicle.polynomials import Polynomial, scale_variable, shift, trim
from yawdesign.vehicle.vehicle import Model, Vehicle

# How close the margins by two routes must be. Where two roots coalesce, as they do at many optima, an eigenvalue is
# right to 1e-8 of its own modulus only; a hunting mode's is 10 ... 30 rad/s.
AGREE = {"decay_rate": 2e-5, "damping_ratio": 1e-6}
SECTIONS, LEVELS = 3, 1025  # how often the margin is enclosed, and by how many levels
TOO_MANY = 1000  # roots: what is counted where Routh's array breaks down


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
    movable, ratio = space.model.movable(space.names), space.objective == "damping_ratio"
    chosen = [[m.polynomial(vehicle.C_s) for m in vehicle.motions if m.name in movable] for vehicle in vehicles]
    most = pairs if ratio else 2 * pairs

    def exceeded(level: Float) -> Bools:
        counts = [sum(_beyond(trim(p), level, ratio) for p in polynomials) for polynomials in chosen]
        return np.asarray(np.all([count <= most for count in counts], axis=0))

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


def _beyond(p: Polynomial, level: Float, ratio: bool) -> Index:
    """Return how many roots of a polynomial lie beyond a level: of those in a sector one of each pair is counted."""
    scaled = scale_variable(p, TIME_UNIT)
    with np.errstate(all="ignore"):
        entries = sector_column(scaled, level) if ratio else routh_column(shift(scaled, -level / TIME_UNIT))
        column = np.array([np.broadcast_to(x, level.shape) for x in entries], dtype=float)
        changes = np.sum(np.sign(column[1:]) != np.sign(column[:-1]), axis=0)
    regular = np.isfinite(column).all(axis=0) & (column != 0).all(axis=0)
    return np.asarray(np.where(regular, changes, TOO_MANY), dtype=np.intp)


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

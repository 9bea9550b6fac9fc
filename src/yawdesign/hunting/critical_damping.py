"""All critical values of the yaw damping of a vehicle, and the intervals of stability between them.

Those of one bogie come from :mod:`yawdesign.hunting.many.critical_values`, those of a vehicle with a car body from
:mod:`yawdesign.hunting.vehicle_values`; both find all of them. The smallest critical value
need not be the boundary of stability, and stability may be lost again above another: eq. (11) of the paper and its
"minimum positive real root" do not see that.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from yawdesign.hunting.boundary import polish
from yawdesign.hunting.eigenvalues import backward_error, count_undamped, motion_eigenvalues
from yawdesign.hunting.many.critical_table import CriticalField
from yawdesign.hunting.many.critical_values import critical_field, recomputed
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.receptance import Receptance
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.vehicle_values import VehicleValues, vehicle_values
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.vehicle import Vehicle

Interval = tuple[float, float]

TIGHT = 1e-9  # largest backward error of a critical value that counts as checked


@dataclass(frozen=True)
class CriticalValue:
    """A yaw damping at which a pair of roots lies on the imaginary axis.

    Parameters
    ----------
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    omega : float
        Angular frequency of the motion at the boundary [rad/s].
    becomes : {"stable", "unstable", "neither"}
        What the vehicle becomes when C_s grows through the value.
    residual : float
        Backward error of the characteristic polynomial at (C_s, j omega) [-].
    """

    C_s: float
    omega: float
    becomes: str
    residual: float


@dataclass(frozen=True)
class CriticalDamping:
    """All critical values, and the stability between them.

    Parameters
    ----------
    critical : tuple of CriticalValue
        In ascending order of C_s.
    unstable_roots : tuple of int
        Number of roots of the coupled motion in the right half-plane, below the first critical value (towards 0),
        between the first and the second, ..., above the last (towards infinity).
    checked : bool
        True if each critical value changes the number of unstable roots the way its root crosses the axis, by two
        independent routes: Routh's array and the eigenvalues where double precision decides; else a Sturm chain and
        Routh's array in so many digits that twice as many give the same answer.
    """

    critical: tuple[CriticalValue, ...]
    unstable_roots: tuple[int, ...]
    checked: bool

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """The open intervals of C_s that `unstable_roots` counts; the last one has no end."""
        return tuple(pairwise([0.0, *(c.C_s for c in self.critical), np.inf]))

    @property
    def stable_intervals(self) -> tuple[Interval, ...]:
        """The open intervals of C_s in which the coupled motion is stable."""
        return tuple(i for i, n in zip(self.intervals, self.unstable_roots, strict=True) if n == 0)


def critical_damping(vehicle: Vehicle) -> CriticalDamping:
    """Return all critical values of the yaw damping of the coupled motion.

    Parameters
    ----------
    vehicle : Vehicle
        Its numbers are floats; its own C_s is not looked at.
    """
    linear = len(vehicle.coupled.coefficients) == 2
    found, counts, checked = _of_one_damper(vehicle) if linear else vehicle_values(vehicle)
    values = tuple(
        CriticalValue(C_s, omega, _becomes(before, after), _residual(vehicle.coupled, C_s, omega))
        for (C_s, omega), (before, after) in zip(found, pairwise(counts), strict=True)
    )
    return CriticalDamping(values, counts, checked and all(x.residual < TIGHT for x in values))


def _of_one_damper(vehicle: Vehicle) -> VehicleValues:
    """Return what belongs to one link of yaw dampers: the polynomial is linear in C_s."""
    sets = ParameterSets(vehicle.model, vehicle.p, 1)
    field = critical_field(sets)
    if not field.recomputed[0] and not _eigenvalues_agree(vehicle, field):
        field = recomputed(field, sets, [0])
    found = [*zip(*field.values_at(0), strict=True)]
    if not field.recomputed[0]:
        found = polish(vehicle, found)
    return VehicleValues(tuple(found), field.counts_at(0), not field.unverified[0])


def _eigenvalues_agree(vehicle: Vehicle, field: CriticalField) -> bool:
    """Return whether the eigenvalues count as many unstable roots in every interval."""
    values, _ = field.values_at(0)
    joint = vehicle.model.joints.get("C_s")
    natural = vehicle.p[joint] / TIME_UNIT if joint else float(Receptance(vehicle).natural()[0])
    everywhere = vehicle.replace(C_s=np.array(_places(values, natural)))
    found = count_undamped(motion_eigenvalues(everywhere, everywhere.coupled))
    return tuple(map(int, found)) == field.counts_at(0)


def _places(values: Sequence[float], natural: float) -> list[float]:
    """Return one damping in every interval; without critical values the one that is natural to the vehicle."""
    if not values:
        return [natural]
    return [values[0] / 2, *(float(np.sqrt(a * b)) for a, b in pairwise(values)), 2 * values[-1]]


def _becomes(before: int, after: int) -> str:
    if before and not after:
        return "stable"
    return "unstable" if after and not before else "neither"


def _residual(coupled: Motion, C_s: float, omega: float) -> float:
    return float(backward_error(coupled.polynomial(C_s), 1j * np.asarray(omega)))

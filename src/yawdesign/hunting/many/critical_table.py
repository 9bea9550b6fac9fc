"""Tables of critical values of many vehicles, and the counts of unstable roots between them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Bools, Float, Index
from yawdesign.hunting.many import counts
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.receptance import Receptance
from yawdesign.hunting.routh import TIME_UNIT

FAR = 1e60  # from a damping whose joint relaxes at 100 rad/s to where 0 and infinity are looked at


@dataclass(frozen=True)
class CriticalField:
    """Critical values of many points.

    Parameters
    ----------
    critical, omega : array, shape (n, m)
        C_s [N s/m] in rising order, and angular frequency [rad/s]; filled up with NaN.
    unstable_roots : array, shape (n, m + 1)
        Number of roots in the right half-plane in every interval between them, from C_s towards 0 to C_s towards
        infinity; filled up with NaN.
    recomputed : array of bool, shape (n,)
        Whether double precision did not decide, and the values come from decimals of many digits.
    unverified : array of bool, shape (n,)
        Whether these did not decide either: the values are those of double precision and no verdict.
    """

    critical: Float
    omega: Float
    unstable_roots: Float
    recomputed: Bools
    unverified: Bools

    def values_at(self, k: int) -> tuple[list[float], list[float]]:
        """Return the critical values of a point, and their frequencies."""
        known = ~np.isnan(self.critical[k])
        return self.critical[k][known].tolist(), self.omega[k][known].tolist()

    def counts_at(self, k: int) -> tuple[int, ...]:
        """Return the number of unstable roots in every interval of a point."""
        row = self.unstable_roots[k]
        return tuple(int(count) for count in row[~np.isnan(row)])


class Rows:
    """A table with a row for every point, filled from its left end with values in rising order.

    Parameters
    ----------
    owner : array of int
        To which point each value belongs.
    key : array
        By what the values of a point are ordered.
    n : int
        Number of points.
    """

    def __init__(self, owner: Index, key: Float, n: int) -> None:
        self._order = np.lexsort((key, owner))
        self._owner = owner[self._order]
        self.count = np.bincount(owner, minlength=n)
        self._rank = np.arange(len(owner)) - np.repeat(np.cumsum(self.count) - self.count, self.count)

    def spread(self, column: Float) -> Float:
        """Return the table of a column; what is not there is NaN."""
        out = np.full((len(self.count), int(self.count.max(initial=0))), np.nan)
        out[self._owner, self._rank] = column[self._order]
        return out


def natural_damping(sets: ParameterSets) -> Float:
    """Return the C_s whose joint relaxes at 100 rad/s; for a rigid joint one of the vehicle's size."""
    joint = sets.model.joints.get("C_s")
    if joint is None:
        return Receptance(sets.vehicle).natural(sets.size)
    return np.broadcast_to(sets.values[joint], sets.size) / TIME_UNIT


def counted(parts: Sequence[Float], critical: Float, natural: Float) -> tuple[Float, Bools]:
    """Return the number of unstable roots in every interval of C_s, and where a count is doubtful.

    Parameters
    ----------
    parts : sequence of array, shape (degree + 1, n)
        The polynomials that the powers of C_s multiply, lowest power of s first.
    critical : array, shape (n, m)
        As in `CriticalField`.
    natural : array, shape (n,)
        As `natural_damping` gives it.
    """
    n, m = critical.shape
    C_s = np.full((n, m + 1), np.nan)
    # Each value's upper neighbour; beyond the last one infinity.
    upper = np.concatenate([critical[:, 1:], np.full((n, 1), np.nan)], axis=1)[:, :m]
    C_s[:, 1:] = np.where(np.isnan(upper), FAR * natural[:, None], np.sqrt(np.abs(critical)) * np.sqrt(np.abs(upper)))
    C_s[:, 1:][np.isnan(critical)] = np.nan
    C_s[:, 0] = natural / FAR
    row, column = np.nonzero(~np.isnan(C_s))
    size, power = max(map(len, parts)), np.ones(len(row))
    core = np.zeros((size, len(row)))
    for part in parts:
        core[: len(part)] += power * np.take(part, row, axis=1)
        power = power * C_s[row, column]
    count, doubts = counts.counts(size)({f"a{k}": core[k] for k in range(size)})
    unstable = np.full((n, m + 1), np.nan)
    unstable[row, column] = count
    doubtful = np.zeros(n, dtype=bool)
    doubtful[row[doubts > 0]] = True
    return unstable, doubtful

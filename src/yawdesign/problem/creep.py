"""Creep coefficients from the axle load: the contact ellipse by Hertz, its resistance to creep by Kalker."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .arguments import named
from .diagnostics import Mistakes, ProblemError
from .parameters import BOGIE
from .table import check_fields, documented, parameter, table

# J. J. Kalker: On the Rolling Contact of Two Elastic Bodies in the Presence of Dry Friction, Delft 1967: C_11 and C_22
# for a Poisson's ratio of 0, 1/4, 1/2; in the rows a/b = 0.1 ... 1, then b/a = 0.9 ... 0.1, a being the semi-axis along
# the rail.
MADE = ("f_11", "f_22")  # what `creep` stands in a file instead of
_POISSON = (0.0, 0.25, 0.5)
_C_11 = (
    (2.51, 2.59, 2.68, 2.78, 2.88, 2.98, 3.09, 3.19, 3.29, 3.40, 3.51, 3.65, 3.82, 4.06, 4.37, 4.84, 5.57, 6.96, 10.7),
    (3.31, 3.37, 3.44, 3.53, 3.62, 3.72, 3.81, 3.91, 4.01, 4.12, 4.22, 4.36, 4.54, 4.78, 5.10, 5.57, 6.34, 7.78, 11.7),
    (4.85, 4.81, 4.80, 4.82, 4.83, 4.91, 4.97, 5.05, 5.12, 5.20, 5.30, 5.42, 5.58, 5.80, 6.11, 6.57, 7.34, 8.82, 12.9),
)
_C_22 = (
    (2.51, 2.59, 2.68, 2.78, 2.88, 2.98, 3.09, 3.19, 3.29, 3.40, 3.51, 3.65, 3.82, 4.06, 4.37, 4.84, 5.57, 6.96, 10.7),
    (2.52, 2.63, 2.75, 2.88, 3.01, 3.14, 3.28, 3.41, 3.54, 3.67, 3.81, 3.99, 4.21, 4.50, 4.90, 5.48, 6.40, 8.14, 12.8),
    (2.53, 2.66, 2.81, 2.98, 3.14, 3.31, 3.48, 3.65, 3.82, 3.98, 4.16, 4.39, 4.67, 5.04, 5.56, 6.31, 7.51, 9.79, 16.0),
)


@named
@documented
@dataclass(frozen=True, kw_only=True)
class Creep:
    """What creep coefficients follow from, beside the axle load and the radius of the wheel."""

    kalker_factor: float = parameter(
        r"k",
        "-",
        "share of Kalker's linear creep coefficients: 1 for dry and clean rails",
        hard=(1e-3, 10.0),
        usual=(0.2, 1.0),
        source="1",
        default=1.0,
    )
    rail_radius: float = parameter(
        r"R_\mathrm{r}",
        "mm",
        "radius of the rail head across the rail, under a conical tread",
        hard=(1e-3, 1e3),
        usual=(0.02, 2.0),
        source="300",
        default=0.3,
    )
    G: float = parameter(
        "G",
        "GPa",
        "shear modulus of wheel and rail",
        hard=(1e3, 1e15),
        usual=(70e9, 90e9),
        source="80.8",
        default=80.8e9,
    )
    nu: float = parameter(
        r"\nu",
        "-",
        "Poisson's ratio of wheel and rail",
        hard=(0.0, 0.5),
        usual=(0.2, 0.35),
        source="0.3",
        default=0.3,
    )

    def __post_init__(self) -> None:
        check_fields(self)


CREEP = table(Creep)


def creep_coefficients(
    W: Any, r: Any, *, kalker_factor: Any = 1.0, rail_radius: Any = 0.3, G: Any = 80.8e9, nu: Any = 0.3
) -> dict[str, float]:
    """Return the creep coefficients of each wheel, lateral ``f_11`` and longitudinal ``f_22``, by Hertz and Kalker.

    The wheel load W/2 presses a cone of radius r on a rail whose head has a radius across; the contact ellipse has the
    semi-axes a along and b across the rail (Hertz). Then f_22 = k C_11 G a b and f_11 = k C_22 G a b with Kalker's
    coefficients of linear theory: stationary rolling, small creep, no spin, wheel and rail of one material. Both grow
    as W to the power of 2/3. Values between those of Kalker's table are interpolated, to about 1 %.

    Parameters
    ----------
    W : float
        Axle load [N]. Here and below a text with a unit is converted.
    r : float
        Rolling radius of the wheels [m].
    kalker_factor : float
        Share k of Kalker's coefficients [-]: 1 for dry and clean rails, down to 0.5 and less for wet or dirty ones.
    rail_radius : float
        Radius of the rail head across the rail [m]. With a tread of curvature 1/R_w in the same plane it is that of
        the relative curvature, 1 / (1/rail_radius + 1/R_w), R_w being negative for a hollow tread.
    G, nu : float
        Shear modulus [N/m^2] and Poisson's ratio [-].

    Returns
    -------
    dict of str to float
        ``f_11`` and ``f_22`` [N]: what `Problem.replace` takes.

    Raises
    ------
    ProblemError
        If a value is not accepted, or one axis of the ellipse is more than ten times the other.

    References
    ----------
    J. J. Kalker: On the Rolling Contact of Two Elastic Bodies in the Presence of Dry Friction. Delft 1967.
    K. L. Johnson: Contact Mechanics. Cambridge 1985, section 4.2.

    Examples
    --------
    >>> {key: round(f / 1e3) for key, f in creep_coefficients("200 kN", "0.625 m", kalker_factor=0.6).items()}
    {'f_11': 9349, 'f_22': 10106}
    """
    mistakes = Mistakes()
    load = radius = 0.0
    with mistakes.under("W"):
        load = BOGIE["W"].check(W)
    with mistakes.under("r"):
        radius = BOGIE["r"].check(r)
    with mistakes.under(""):
        creep = Creep(kalker_factor=kalker_factor, rail_radius=rail_radius, G=G, nu=nu)
    mistakes.report()
    a, b = contact_ellipse(load / 2, radius, creep.rail_radius, creep.G, creep.nu)
    if not a * b:
        raise ProblemError("W is too small for a contact: creep coefficients need an axle load")
    if not 0.1 <= a / b <= 10:
        raise ProblemError(
            f"the contact ellipse, {a:.3g} m by {b:.3g} m, is longer than 10 to 1: Kalker's table ends there"
        )
    unit = float(creep.kalker_factor * creep.G * a * b)
    return {"f_11": unit * _interpolated(_C_22, a / b, creep.nu), "f_22": unit * _interpolated(_C_11, a / b, creep.nu)}


def contact_ellipse(N: float, r: float, rail_radius: float, G: float, nu: float) -> tuple[float, float]:
    """Return the semi-axes of the contact ellipse along and across the rail [m] (Johnson, eqs (4.25) to (4.27)).

    Parameters
    ----------
    N : float
        Load of the wheel [N].
    r, rail_radius : float
        Radius of the wheel, and of the rail head across [m].
    G, nu : float
        Shear modulus [N/m^2] and Poisson's ratio [-] of both.
    """
    low, high = sorted((1 / (2 * r), 1 / (2 * rail_radius)))  # of the gap; the longer axis lies along the lower
    k = _axes_ratio(low / high)
    K, share = _elliptic(1 - k * k)
    longer = math.cbrt(3 * N * (1 - nu) / (2 * math.pi * G) * K * share / low)
    return (longer, k * longer) if r >= rail_radius else (k * longer, longer)


def _axes_ratio(curvatures: float) -> float:
    """Return the shorter over the longer semi-axis for the ratio of the lower to the higher curvature, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        k = (low + high) / 2
        _, share = _elliptic(1 - k * k)
        # (K - E) / (E / k^2 - K), with K - E = m K share and m = 1 - k^2
        low, high = (k, high) if k * k * share / (1 - share) < curvatures else (low, k)
    return high


def _elliptic(m: float) -> tuple[float, float]:
    """Return the complete elliptic integral K of parameter m and (K - E) / (m K), by arithmetic-geometric means."""
    a, b, weight, total = 1.0, math.sqrt(1 - m), 0.5, 0.5
    for _ in range(8):  # which converges quadratically
        weight *= 2
        total += weight * ((a - b) / 2) ** 2 / m if m else 0.0
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a), total


def _interpolated(rows: tuple[tuple[float, ...], ...], ratio: float, nu: float) -> float:
    """Return a coefficient between those of a table: linear in the ratio of the axes, a parabola in Poisson's ratio."""
    place = (ratio if ratio <= 1 else 2 - 1 / ratio) * 10 - 1
    index = min(int(place), len(rows[0]) - 2)
    at = [row[index] + (place - index) * (row[index + 1] - row[index]) for row in rows]
    total = 0.0
    for value, own in zip(at, _POISSON, strict=True):
        others = [other for other in _POISSON if other != own]
        total += value * math.prod((nu - other) / (own - other) for other in others)
    return total

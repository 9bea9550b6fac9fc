"""Whether the bogie of a problem is stable, and by what margin."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from yawdesign.hunting.arrays import Complex
from yawdesign.hunting.eigenvalues import (
    backward_error,
    core_eigenvalues,
    count_undamped,
    damping_ratio,
    decay_rate,
    eigenvalues,
    in_order,
    polished,
    roots,
    state_matrix,
)
from yawdesign.hunting.routh import count_unstable
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.result import Result
from yawdesign.vehicle.catalogue import Parameters
from yawdesign.vehicle.old import DAMPER_FACTOR, Characteristic, characteristic
from yawdesign.vehicle.polynomials import Polynomial, product

EXACT = 1e-9  # largest backward error with which an eigenvalue counts as a root of the characteristic polynomial


@dataclass(frozen=True)
class Mode:
    """One real root or one pair of conjugate roots.

    Parameters
    ----------
    frequency : float
        Damped frequency [Hz]; 0 for a real root.
    damping_ratio : float
        -Re(s)/|s| [-].
    decay_rate : float
        -Re(s) [1/s].
    """

    frequency: float
    damping_ratio: float
    decay_rate: float


@dataclass(frozen=True, repr=False)
class Stability(Result):
    """Stability of a bogie at one yaw damping and one speed, the worst of the problem's speeds.

    Parameters
    ----------
    stable : bool
        All roots lie in the left half-plane, by their eigenvalues and by Routh's array.
    spectral_abscissa : float
        Largest real part [1/s] of all modes of the 25-state model (15 states without motors).
    decay_rate, damping_ratio : float
        Margins [1/s], [-] over the modes that some design variable can move.
    eigenvalues : tuple of complex
        Of the 25-state model [1/s], least damped first.
    modes : tuple of Mode
        The same as frequencies and damping.
    fixed_modes : mapping name -> tuple of complex
        The roots that no design variable moves, and that of the two yaw dampers working against each other.
    C_s, speed : float
        Damping of the pair of yaw dampers [N s/m] and speed [m/s] to which this belongs.
    unstable_roots : int
        Number of eigenvalues in the right half-plane.
    checked : bool
        True if Routh's array counts as many roots, and every eigenvalue is a root of the characteristic polynomial.
    """

    stable: bool
    spectral_abscissa: float
    decay_rate: float
    damping_ratio: float
    eigenvalues: tuple[complex, ...]
    modes: tuple[Mode, ...]
    fixed_modes: Mapping[str, tuple[complex, ...]]
    C_s: float
    speed: float
    unstable_roots: int
    checked: bool


def given_damping(problem: Problem) -> float:
    """Return the yaw damping written in the problem [N s/m]; an error if there is none."""
    if problem.bogie.C_s is None:
        raise ProblemError("bogie.C_s is missing: give the damping of the pair of yaw dampers, such as C_s: 1 MN s/m")
    return problem.bogie.C_s


def stability(problem: Problem) -> Stability:
    """Return the stability of a problem's bogie with the yaw damping written in it.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``. Over a range of speeds the result is that of the least decay rate.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``.

    Examples
    --------
    >>> import yawdesign as yd
    >>> round(yd.stability(yd.table1(equations="as-printed")).spectral_abscissa, 8)
    -1.29853702
    """
    p, C_s = problem.bogie.parameters(), given_damping(problem)
    variables = problem.design.variables
    results = [stability_at({**p, "v": v}, C_s, variables, **problem.model) for v in problem.speeds]
    return min(results, key=lambda result: (result.stable, result.decay_rate))


def stability_at(p: Parameters, C_s: float, variables: Collection[str] = (), *, kind: str, equations: str) -> Stability:
    """Return the stability at given parameters.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units and ``v``, floats.
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    variables : collection of str
        Design variables; they decide which decoupled modes count in the margins.
    kind, equations : str
        As in `yawdesign.vehicle.catalogue.bogie`.
    """
    c = characteristic(p, kind=kind, equations=equations)
    whole = c.full(C_s)
    s = _roots(whole, eigenvalues(state_matrix(p, C_s, kind=kind, equations=equations)))
    fixed = fixed_factors(p, variables, kind=kind, equations=equations)
    moved = np.concatenate(
        [
            _roots(c.core(C_s), core_eigenvalues(p, C_s, kind=kind, equations=equations)),
            *(roots(c.factors[n]) for n in c.factors if n not in fixed),
        ]
    )
    unstable = int(count_undamped(s))
    counted = _count(c, C_s)
    agree = counted == unstable and bool(np.all(backward_error(whole, s) < EXACT))
    return Stability(
        stable=unstable == 0 and counted == 0,
        spectral_abscissa=float(s.real.max()),
        decay_rate=float(decay_rate(moved)),
        damping_ratio=float(damping_ratio(moved)),
        eigenvalues=tuple(complex(x) for x in s),
        modes=modes(s),
        fixed_modes={n: tuple(complex(x) for x in roots(c.factors[n])) for n in fixed} | _damper_mode(p, C_s),
        C_s=float(C_s),
        speed=float(p["v"]),
        unstable_roots=unstable,
        checked=agree,
    )


def _roots(p: Polynomial, s: Complex) -> Complex:
    """Return eigenvalues, polished where they are no roots of their polynomial, the least damped first."""
    if np.all(backward_error(p, s) < EXACT):
        return s
    return in_order(polished(p, s))


def modes(s: Complex) -> tuple[Mode, ...]:
    """Return one Mode for each real eigenvalue and each conjugate pair."""
    upper = s[s.imag >= 0]
    return tuple(
        Mode(float(x.imag / (2 * np.pi)), float(-x.real / abs(x)) if x else 0.0, float(-x.real)) for x in upper
    )


def _count(c: Characteristic, C_s: float) -> int:
    """Return the number of roots that are not in the left half-plane, by Routh's array; -1 if it breaks down."""
    core = count_unstable(c.core(C_s))
    return core if core < 0 else core + sum(undamped_roots(p) for p in c.factors.values())


def undamped_roots(quadratic: tuple[float, ...]) -> int:
    """Return how many roots of a decoupled motion k + c s + m s^2 are not damped, from the signs of k and c."""
    k, c, _ = quadratic
    if k > 0 and c > 0:
        return 0
    return 1 if c > 0 else 2


def _damper_mode(p: Parameters, C_s: float) -> dict[str, tuple[complex, ...]]:
    return {DAMPER_FACTOR: (complex(-p["K_ds"] / C_s),)} if C_s else {}


def fixed_factors(p: Parameters, variables: Collection[str], *, kind: str, equations: str) -> tuple[str, ...]:
    """Return the names of the decoupled motions whose polynomial no design variable changes."""
    changed = {**p, **{name: p[name] * 1.5 + 1 for name in variables if name in p}}
    before = characteristic(p, kind=kind, equations=equations).factors
    after = characteristic(changed, kind=kind, equations=equations).factors
    return tuple(name for name in before if product([before[name]]) == product([after[name]]))

"""What is said of a vehicle's stability, and how it is found under one condition, by two independent ways."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Complex
from yawdesign.hunting.eigenvalues import (
    EXACT,
    backward_error,
    count_undamped,
    damping_ratio,
    decay_rate,
    in_order,
    motion_eigenvalues,
    polished,
)
from yawdesign.hunting.routh import count_unstable
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.conditions import conditions
from yawdesign.problem.result import Result
from yawdesign.vehicle.elements import Link, parted
from yawdesign.vehicle.polynomials import Polynomial
from yawdesign.vehicle.signals import BOGIES, ENDS
from yawdesign.vehicle.vehicle import Vehicle


@dataclass(frozen=True)
class Mode:
    """One real root or one pair of conjugate roots.

    Parameters
    ----------
    frequency : float
        Damped frequency [Hz]; 0 for a real root.
    damping_ratio : float
        -Re(s)/abs(s) [-].
    decay_rate : float
        -Re(s) [1/s].
    """

    frequency: float
    damping_ratio: float
    decay_rate: float


@dataclass(frozen=True)
class CaseVerdict:
    """Stability with a fault, under the condition in which it is worst.

    Parameters
    ----------
    name : str
        The fault, as the problem calls it.
    stable : bool
        All roots lie in the left half-plane, by their eigenvalues and by Routh's array, under every condition.
    decay_rate, damping_ratio : float
        Margins [1/s], [-] over the modes that a design variable moves.
    worst_condition : mapping
        The condition of the least decay rate, of all modes where one is unstable: ``speed`` [m/s], others in SI units,
        a load by its name.
    checked : bool
        As in `Stability`.
    """

    name: str
    stable: bool
    decay_rate: float
    damping_ratio: float
    worst_condition: Mapping[str, Any]
    checked: bool


@dataclass(frozen=True)
class RequirementVerdict:
    """Whether a requirement is met, under all conditions.

    Parameters
    ----------
    name : str
        As the problem file has it: ``damping_ratio``, ``cases.damping_ratio``.
    wanted : float
        The least value that is required [1/s], [-] or [m/s].
    reached : float or None
        The worst value under all conditions, and of all faults where these must reach it [1/s], [-] or [m/s]; None for
        a critical speed beyond the searched range, which then counts as met.
    met : bool
        Whether that is enough.
    worst_condition : mapping
        The condition of the reached value: ``speed`` [m/s], others in SI units, a load by its name.
    case : str or None
        The fault with the worst value, where faults must reach it.
    checked : bool
        True if two independent ways agree on it.
    """

    name: str
    wanted: float
    reached: float | None
    met: bool
    worst_condition: Mapping[str, Any]
    case: str | None
    checked: bool


@dataclass(frozen=True, repr=False)
class Stability(Result):
    """Stability of a vehicle at one yaw damping, under all conditions of a problem.

    A vehicle is one bogie under a car body that stands still, or a car body on two bogies. Eigenvalues, modes and speed
    are those under the worst condition.

    Parameters
    ----------
    stable : bool
        All roots lie in the left half-plane, by their eigenvalues and by Routh's array, under every condition.
    spectral_abscissa : float
        Largest real part [1/s] of all modes under any condition: of the bogie's 25 states (15 without
        motors), or the 56 (36) of a vehicle with a car body.
    decay_rate, damping_ratio : float
        Margins [1/s], [-] over the modes that a design variable moves, each the worst under all conditions.
    eigenvalues : tuple of complex
        All of them [1/s], least damped first.
    modes : tuple of Mode
        The same as frequencies and damping.
    fixed_modes : mapping name -> tuple of complex
        The roots [1/s] that no design variable moves, and that of the two yaw dampers working against each other.
    C_s, speed : float
        Damping of the pair of yaw dampers of each bogie as designed [N s/m], and speed [m/s] of the worst condition.
    unstable_roots : int
        Number of eigenvalues in the right half-plane.
    checked : bool
        True if, under the worst conditions, Routh's array counts as many roots, and every eigenvalue is a root of the
        characteristic polynomial; and if both ways agree under many others.
    worst_condition : mapping
        The condition of the least decay rate, of all modes where one is unstable: ``speed`` [m/s], others in SI units,
        a load by its name.
    requirements : tuple of RequirementVerdict
        What was required and reached.
    cases : tuple of CaseVerdict
        The same with each fault of the problem.
    searched : str
        Under which conditions this holds, and how the worst one was found.
    scope : str
        What this answer does not hold; empty where a car body moves in it.
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
    worst_condition: Mapping[str, Any] = field(default_factory=dict)
    requirements: tuple[RequirementVerdict, ...] = ()
    cases: tuple[CaseVerdict, ...] = ()
    searched: str = ""
    scope: str = ""


def given_damping(problem: Problem) -> float:
    """Return the yaw damping written in the problem [N s/m]; an error if there is none."""
    if problem.bogie.C_s is None:
        raise ProblemError("bogie.C_s is missing: give the damping of the pair of yaw dampers, such as C_s: 1 MN s/m")
    return problem.bogie.C_s


def least_stable(problem: Problem) -> tuple[Vehicle, Stability]:
    """Return a problem's vehicle at the speed of the least decay rate, and its stability there."""
    given_damping(problem)
    vehicles, looked = Vehicle.of(problem), conditions(problem)
    found = [stability_at(vehicle, problem.design.variables) for vehicle in vehicles]
    place = min(range(len(found)), key=lambda k: (found[k].stable, found[k].decay_rate))
    checked = all(result.checked for result in found)
    return vehicles[place], replace(found[place], worst_condition=looked[place].described, checked=checked)


def stability_at(vehicle: Vehicle, variables: Collection[str] = ()) -> Stability:
    """Return the stability of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle
        Its numbers are floats, ``C_s`` [N s/m] among them.
    variables : collection of str
        Design variables; they decide which decoupled modes count in the margins.
    """
    C_s, movable = float(vehicle.C_s), vehicle.model.movable(variables)
    polynomials = vehicle.polynomials
    s = {x.name: roots_of(polynomials[x.name], motion_eigenvalues(vehicle, x)) for x in vehicle.model.motions}
    every, moved = in_order(np.concatenate([*s.values()])), np.concatenate([s[name] for name in movable])
    exact = all(np.all(backward_error(p, s[name]) < EXACT) for name, p in polynomials.items())
    unstable = int(count_undamped(every))
    counts = [count_unstable(p) for p in polynomials.values()]  # -1 where Routh's array breaks down
    fixed = {name: s[name] for name in s if name not in movable}
    return Stability(
        stable=unstable == 0 and not any(counts),
        spectral_abscissa=float(every.real.max()),
        decay_rate=float(decay_rate(moved)),
        damping_ratio=float(damping_ratio(moved)),
        eigenvalues=tuple(complex(x) for x in every),
        modes=modes(every),
        fixed_modes={name: tuple(complex(x) for x in roots) for name, roots in fixed.items()}
        | _between_pieces(vehicle),
        C_s=C_s,
        speed=float(vehicle.v),
        unstable_roots=unstable,
        checked=exact and min(counts) >= 0 and sum(counts) == unstable,
    )


def roots_of(p: Polynomial, s: Complex) -> Complex:
    """Return eigenvalues, polished where they are no roots of their polynomial, the least damped first.

    Roots at zero, which a polynomial without its lowest coefficients says exactly, have no rounding.
    """
    zeros = next((k for k, a in enumerate(p) if a != 0), 0)
    s = np.where(np.argsort(np.argsort(np.abs(s), kind="stable"), kind="stable") < zeros, 0, s)
    return in_order(s if np.all(backward_error(p, s) < EXACT) else polished(p, s))


def modes(s: Complex) -> tuple[Mode, ...]:
    """Return one Mode for each real eigenvalue and each conjugate pair."""
    upper = s[s.imag >= 0]
    return tuple(
        Mode(float(x.imag / (2 * np.pi)), float(-x.real / abs(x)) if x else 0.0, float(-x.real)) for x in upper
    )


def _between_pieces(vehicle: Vehicle) -> dict[str, tuple[complex, ...]]:
    """Return the roots -K/c of equal dampers that work against each other: one link stands for them in the model."""
    links = [e for e in vehicle.physical if isinstance(e, Link) and e.pieces > 1]
    laws = [(*parted(link.name), law) for link in links for law in link.maxwell if law.c]
    two = vehicle.model.has_car_body
    return {
        ", ".join((f"{name.strip()}s against each other", *_place(end, two))): (complex(-law.K / law.c),)
        for name, end, law in laws
    }


def _place(end: str, two_bogies: bool) -> list[str]:
    """Return in words which bogie and which end of it the number behind a name means."""
    bogie, inside = (end[:1], end[1:]) if two_bogies else ("", end)
    return [f"{BOGIES[x]} bogie" for x in bogie] + [f"{ENDS[x]} end" for x in inside]

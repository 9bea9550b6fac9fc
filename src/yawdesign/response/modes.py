"""The modes of a bogie: frequency, damping, shape, and what takes part in each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
import scipy.linalg as sl

from yawdesign.bogie.characteristic import characteristic
from yawdesign.bogie.polynomials import Polynomial
from yawdesign.bogie.vehicles import Parameters
from yawdesign.problem import Problem
from yawdesign.problem.result import Result
from yawdesign.response.names import assign_groups, group, groups_of, shares, stem, unique_names
from yawdesign.response.spectrum import Index, Motion, Spectrum, motion, parts, spectrum, unfold, whole_vector
from yawdesign.stability.modes import Complex, Float, backward_error
from yawdesign.stability.verdict import EXACT, Mode, given_damping, stability


@dataclass(frozen=True)
class NamedMode(Mode):
    """A mode with a name: one real root or one pair of conjugate roots.

    Parameters
    ----------
    name : str
        What moves in it, such as ``"motor lateral 1"``; no other mode of the bogie has it.
    eigenvalue : complex
        The root above the real axis, or on it [1/s].
    shape : mapping coordinate -> complex
        Displacements [m] and angles [rad], scaled so that the largest of all displacements and of all angles times the
        half wheelbase is 1 and leads with phase zero. The motion is the real part of ``shape * exp(eigenvalue t)``.
    participation : mapping str -> float
        Share of each coordinate (with its velocity) and of each damper's stroke in the mode: left times right
        eigenvector. The shares sum to 1 and do not depend on units.
    residual : float
        The larger of two backward errors: of the characteristic polynomial at the eigenvalue, and of the eigenvector.
    """

    name: str
    eigenvalue: complex
    shape: Mapping[str, complex]
    participation: Mapping[str, float]
    residual: float


@dataclass(frozen=True, repr=False)
class Modes(Result):
    """All modes of a bogie at one speed.

    Parameters
    ----------
    modes : tuple of NamedMode
        The least damped first (by decay rate).
    stable : bool
        Whether all of them decay, as `yawdesign.stability` says it.
    C_s, speed : float
        Damping of the pair of yaw dampers [N s/m] and speed [m/s].
    equations : str
        ``"reciprocal"`` or ``"as-printed"``.
    parameters : mapping
        The bogie in SI units.
    checked : bool
        True if the stability was checked, and every eigenvalue is a root of the characteristic polynomial.
    """

    modes: tuple[NamedMode, ...]
    stable: bool
    C_s: float
    speed: float
    equations: str
    parameters: Mapping[str, float]
    checked: bool


def modes(problem: Problem) -> Modes:
    """Return the modes of a problem's bogie with the yaw damping written in it.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``. Of a range of speeds the one of least decay rate is taken.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``.

    Examples
    --------
    >>> import yawdesign as yd
    >>> first = yd.modes(yd.table1()).modes[0]
    >>> first.name, round(first.frequency, 4), round(first.damping_ratio, 5)
    ('wheelset hunting 1', 2.5535, 0.07113)
    """
    verdict = stability(problem)
    p, model = parameters_at(problem, verdict.speed), problem.model
    found = modes_at(p, given_damping(problem), **model)
    exact = all(mode.residual < EXACT for mode in found)
    bogie = {name: value for name, value in p.items() if name != "v"}
    return Modes(
        modes=found,
        stable=verdict.stable,
        C_s=verdict.C_s,
        speed=verdict.speed,
        equations=problem.equations,
        parameters=bogie,
        checked=verdict.checked and exact,
    )


def parameters_at(problem: Problem, v: float) -> dict[str, float]:
    """Return the parameters of a problem's bogie at a speed, as floats."""
    return {**{name: float(value) for name, value in problem.bogie.parameters().items()}, "v": float(v)}


def modes_at(p: Parameters, C_s: float, *, kind: str, equations: str) -> tuple[NamedMode, ...]:
    """Return the modes at given parameters, the least decaying first.

    Parameters
    ----------
    p : mapping
        Symbols of Table I in SI units and ``v``, floats.
    C_s : float
        Damping of the pair of yaw dampers [N s/m].
    kind, equations : str
        As in `yawdesign.bogie.vehicles.bogie`.
    """
    system = motion(p, C_s, kind=kind, equations=equations)
    places = parts(system.matrix != 0)
    found = [spectrum(system.matrix[np.ix_(states, states)]) for states in places]
    names = _names(system, places, found)
    polynomial = characteristic(p, kind=kind, equations=equations).full(C_s)
    roots = [(states, part, k) for states, part in zip(places, found, strict=True) for k in _upper(part)]
    made = [_mode(name, system, *root, float(p["a"]), polynomial) for name, root in zip(names, roots, strict=True)]
    return tuple(sorted(made, key=lambda mode: (mode.decay_rate, mode.frequency)))


def _upper(part: Spectrum) -> range:
    """Return the places of the roots on the real axis and above it."""
    return range(part.real + (len(part.s) - part.real) // 2)


def _names(system: Motion, places: Sequence[Index], found: Sequence[Spectrum]) -> tuple[str, ...]:
    states = [[system.states[i] for i in place] for place in places]
    share = [shares(part, names, groups_of(system)) for part, names in zip(found, states, strict=True)]
    owner = list(chain.from_iterable([names] * len(names) for names in states))
    s = np.concatenate([part.s for part in found])
    all_names = name_roots(system, owner, np.hstack(share), joined_twins(found), s.imag != 0)
    upper = s.imag >= 0
    return unique_names([name for name, up in zip(all_names, upper, strict=True) if up], np.abs(s[upper]))


def joined_twins(found: Sequence[Spectrum]) -> Index:
    """Return for each root of all parts together the place of its conjugate."""
    start = np.cumsum([0, *(len(part.s) for part in found)])
    return np.concatenate([part.twin + first for part, first in zip(found, start, strict=False)])


def name_roots(
    system: Motion, owner: Sequence[Sequence[str]], share: Float, twin: Index, oscillates: Sequence[bool] | Index
) -> list[str]:
    """Return the name of each root, not yet unique.

    Parameters
    ----------
    system : Motion
        What moves.
    owner : sequence of sequence of str
        For each root the states of the part of the motion it belongs to.
    share : ndarray, shape (groups, roots)
        Participation.
    twin, oscillates : sequences
        For each root its conjugate, and whether it is complex.
    """
    groups = groups_of(system)
    room = [sum(group(state) == name for state in system.states) for name in groups]
    chosen = assign_groups(share, room, twin)
    return [stem(groups[i], states, bool(waves)) for i, states, waves in zip(chosen, owner, oscillates, strict=True)]


def _mode(
    name: str, system: Motion, states: Index, part: Spectrum, k: int, arm: float, polynomial: Polynomial
) -> NamedMode:
    s = complex(part.s[k])
    vector = whole_vector(system.matrix, states, s, part.right[:, k])
    left = np.zeros(len(system.matrix), dtype=complex)
    left[states] = part.left[:, k]
    return NamedMode(
        frequency=s.imag / (2 * np.pi),
        damping_ratio=-s.real / abs(s) if s else 0.0,
        decay_rate=-s.real,
        name=name,
        eigenvalue=s,
        shape=_shape(system, vector, arm),
        participation=_participation(system, left, vector),
        residual=max(float(backward_error(polynomial, part.s[k])), _eigenvector_error(system.matrix, s, vector)),
    )


def _shape(system: Motion, vector: Complex, arm: float) -> dict[str, complex]:
    shape = unfold(system.coordinates, vector[: len(system.coordinates)])
    weight = {x: arm if x.startswith("phi") else 1.0 for x in shape}
    largest = max(shape, key=lambda x: weight[x] * abs(shape[x]))
    unit = weight[largest] * shape[largest]
    return {x: value / unit for x, value in shape.items()}


def _participation(system: Motion, left: Complex, right: Complex) -> dict[str, float]:
    """Return the shares of the coordinates of each end and of each damper's stroke."""
    n = len(system.coordinates)
    total: dict[str, complex] = {}
    for names, place in (
        (system.coordinates, slice(0, n)),
        (system.coordinates, slice(n, 2 * n)),
        (system.strokes, slice(2 * n, None)),
    ):
        displacement, force = unfold(names, right[place]), unfold(names, left[place], forces=True)
        for x, value in displacement.items():
            total[x] = total.get(x, 0) + value * force[x]
    size = sum(abs(value) for value in total.values()) or 1.0
    return {x: abs(value) / size for x, value in total.items()}


def _eigenvector_error(matrix: Float, s: complex, vector: Complex) -> float:
    """Return the size of A x - s x relative to that of A and x, in units that make A's rows and columns alike."""
    balanced, (scale, _) = sl.matrix_balance(matrix, permute=False, separate=True)
    x = vector / scale
    return float(np.linalg.norm(balanced @ x - s * x) / (np.linalg.norm(balanced) * np.linalg.norm(x)))

"""The modes of a vehicle: frequency, damping, shape, and what takes part in each."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as sl

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, chosen
from yawdesign.hunting.eigenvalues import EXACT, backward_error, folded_matrix
from yawdesign.hunting.verdict import Mode, least_stable
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.diagnostics import unknown_key
from yawdesign.problem.result import Result
from yawdesign.response.modes.eigenvectors import unfold, whole_vector
from yawdesign.response.modes.names import NamedRoot, named_roots
from yawdesign.response.modes.participation import owners
from yawdesign.vehicle.elements import parted
from yawdesign.vehicle.polynomials import Polynomial
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Vehicle

SMALLEST = 1e-12  # of the car body's displacement: wheelsets that move less count as moving so much


@dataclass(frozen=True)
class NamedMode(Mode):
    """A mode with a name: one real root or one pair of conjugate roots.

    Parameters
    ----------
    name : str
        What moves in it, such as ``"motor lateral 1"``; no other mode of the vehicle has it.
    eigenvalue : complex
        The root above the real axis, or on it [1/s].
    shape : mapping coordinate -> complex
        Displacements [m] and angles [rad], scaled so that the largest of all displacements is 1 and leads with phase
        zero. An angle counts as a displacement of its body: times the half wheelbase; for the car body times l_c (yaw)
        and ``|h_s|`` (roll; b_2 where h_s is 0), for roll of the frame times b_1. The motion is the real part
        of ``shape * exp(eigenvalue t)``.
    participation : mapping str -> float
        Share of each coordinate (with its velocity) and of each damper's stroke in the mode [-]: left times right
        eigenvector. The shares sum to 1 and do not depend on units.
    conicity : float
        How much the root depends on the conicity, ``|d ln eigenvalue / d ln lambda|`` [-]: 1/2 for a wheelset that
        rolls freely, 0 for what knows nothing of the wheels.
    hunting : bool
        Whether it is the hunting of the vehicle, of which the least decay rate counts where each bogie has its own.
    car_body : float or None
        How far the car body moves over one of the bogies, at the height of the secondary springs, relative to the
        wheelset that moves farthest [-]; None if no car body moves. Where it is above
        1 in an oscillation that grows, that is low-conicity sway.
    residual : float
        The larger of two backward errors [-]: of the characteristic polynomial at the eigenvalue, and of the
        eigenvector.
    """

    name: str
    eigenvalue: complex
    shape: Mapping[str, complex]
    participation: Mapping[str, float]
    conicity: float
    hunting: bool
    car_body: float | None
    residual: float


@dataclass(frozen=True, repr=False)
class Modes(Result):
    """All modes of a vehicle at one speed: ``modes["frame yaw"]`` is one of them, by its name or its place.

    Parameters
    ----------
    modes : tuple of NamedMode
        The least damped first (by decay rate).
    hunting : str or None
        Name of the one that is the hunting; of two bogies that of the least decay rate. None if nothing that
        oscillates depends on the conicity.
    stable : bool
        Whether all of them decay, as `yawdesign.stability` says it.
    C_s, speed : float
        Damping of the pair of yaw dampers [N s/m] and speed [m/s].
    equations : str
        ``"reciprocal"`` or ``"as-printed"``.
    parameters : mapping
        The vehicle in SI units.
    checked : bool
        True if the stability was checked, and every eigenvalue is a root of the characteristic polynomial.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and what else is not as
        written, in SI units.
    """

    modes: tuple[NamedMode, ...]
    hunting: str | None
    stable: bool
    C_s: float
    speed: float
    equations: str
    parameters: Mapping[str, float]
    checked: bool
    condition: Mapping[str, Any]

    def __getitem__(self, which: str | int) -> NamedMode:
        """Return the mode with a name, or at a place in their order."""
        if not isinstance(which, str):
            return self.modes[which]
        named = {mode.name: mode for mode in self.modes}
        if which not in named:
            raise ProblemError(f"mode {which!r} {unknown_key(which, tuple(named))}; modes: {'; '.join(named)}")
        return named[which]

    def __iter__(self) -> Iterator[NamedMode]:
        return iter(self.modes)

    def __len__(self) -> int:
        return len(self.modes)


def modes(problem: Problem, *, condition: Asked = AS_WRITTEN) -> Modes:
    """Return the modes of a problem's vehicle with the yaw damping written in it.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``. Of several speeds the one of least decay rate is taken.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    Modes
        Every mode by name, the slowest first.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``, or the condition is not accepted.

    Examples
    --------
    >>> import yawdesign as yd
    >>> first = yd.modes(yd.table1()).modes[0]
    >>> first.name, round(first.frequency, 4), round(first.damping_ratio, 5)
    ('wheelset hunting 1', 2.5535, 0.07113)
    """
    asked = chosen(problem, condition)
    vehicle, verdict = least_stable(asked.problem)
    found = modes_at(vehicle)
    hunting = hunting_mode(found)
    exact = all(mode.residual < EXACT for mode in found)
    return Modes(
        modes=found,
        hunting=None if hunting is None else hunting.name,
        stable=verdict.stable,
        C_s=verdict.C_s,
        speed=verdict.speed,
        equations=problem.equations,
        parameters={name: float(value) for name, value in asked.problem.parameters().items()},
        checked=verdict.checked and exact,
        condition=asked.described(verdict.speed),
    )


def modes_at(vehicle: Vehicle) -> tuple[NamedMode, ...]:
    """Return the modes of a vehicle, the least decaying first.

    Parameters
    ----------
    vehicle : Vehicle
        All its numbers are floats.
    """
    matrix, polynomial = folded_matrix(vehicle), vehicle.polynomial
    made = [_mode(root, vehicle, matrix, polynomial) for root in named_roots(vehicle)]
    return tuple(sorted(made, key=lambda mode: (mode.decay_rate, mode.frequency)))


def hunting_mode(modes: Sequence[NamedMode]) -> NamedMode | None:
    """Return the hunting of a vehicle among its modes; None if nothing that oscillates depends on the conicity."""
    return next((mode for mode in modes if mode.hunting), None)


def _mode(root: NamedRoot, vehicle: Vehicle, matrix: Float, polynomial: Polynomial) -> NamedMode:
    s = root.s
    vector = whole_vector(matrix, root.states, s, root.part.right[:, root.place])
    left = np.zeros(len(matrix), dtype=complex)
    left[root.states] = root.part.left[:, root.place]
    shape = _shape(vehicle, vector)
    return NamedMode(
        frequency=s.imag / (2 * np.pi),
        damping_ratio=-s.real / abs(s) if s else 0.0,
        decay_rate=-s.real,
        name=root.name,
        eigenvalue=s,
        shape=shape,
        participation=_participation(vehicle.folded_state_space, left, vector),
        conicity=root.conicity,
        hunting=root.hunting,
        car_body=_car_body(vehicle.p, shape),
        residual=max(float(backward_error(polynomial, np.array(s))), _eigenvector_error(matrix, s, vector)),
    )


def _shape(vehicle: Vehicle, vector: Complex) -> dict[str, complex]:
    coordinates, units, arms = vehicle.folded_state_space.coordinates, vehicle.model.coordinates, _arms(vehicle.p)
    shape = unfold(coordinates, vector[: len(coordinates)])
    weight = {x: arms[parted(x)[0]] if units[x] == "rad" else 1.0 for x in shape}
    largest = max(shape, key=lambda x: weight[x] * abs(shape[x]))
    unit = weight[largest] * shape[largest] or 1.0
    return {x: value / unit for x, value in shape.items()}


def _arms(p: Mapping[str, float]) -> Mapping[str, float]:
    """Return by what an angle is multiplied to be a displacement of its body [m], by the name of the coordinate.

    Yaw of the car body displaces it over the bogies, its roll where the secondary springs stand, roll of the frame the
    axle boxes; yaw of all other bodies counts at the half wheelbase.
    """
    rolling = {"th_c": abs(p["h_s"]) or p["b_2"], "psi_c": p["l_c"]} if "l_c" in p else {}
    return defaultdict(lambda: p["a"], {"th_b": p["b_1"], **rolling})


def _car_body(p: Mapping[str, float], shape: Mapping[str, complex]) -> float | None:
    """Return how far the car body moves over a bogie relative to the wheelsets."""
    if "y_c" not in shape:
        return None
    middle, yaw = shape["y_c"] + p["h_s"] * shape["th_c"], p["l_c"] * shape["psi_c"]
    wheelsets = max(abs(value) for x, value in shape.items() if parted(x)[0] == "y_w")
    over = max(abs(middle + yaw), abs(middle - yaw))
    return over / max(wheelsets, SMALLEST * over) if over else 0.0


def _participation(space: StateSpace, left: Complex, right: Complex) -> dict[str, float]:
    """Return the shares of the coordinates of each end and of each damper's stroke."""
    n, names = len(space.coordinates), [owner.name for owner in owners(space)]
    total: dict[str, complex] = {}
    for place in (slice(0, n), slice(n, 2 * n), slice(2 * n, None)):
        displacement = unfold(names[place], right[place])
        force = unfold(names[place], left[place], forces=True)
        for x, value in displacement.items():
            total[x] = total.get(x, 0) + value * force[x]
    size = sum(abs(value) for value in total.values()) or 1.0
    return {x: abs(value) / size for x, value in total.items()}


def _eigenvector_error(matrix: Float, s: complex, vector: Complex) -> float:
    """Return the size of A x - s x relative to that of A and x, in units that make A's rows and columns alike."""
    balanced, (scale, _) = sl.matrix_balance(matrix, permute=False, separate=True)
    x = vector / scale
    return float(np.linalg.norm(balanced @ x - s * x) / (np.linalg.norm(balanced) * np.linalg.norm(x)))

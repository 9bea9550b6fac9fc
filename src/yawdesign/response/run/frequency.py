"""Answers to a harmonic track, exact: by the state matrix, and again by the polynomial matrix."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, Chosen, chosen
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.result import Result
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import as_choice, as_several
from yawdesign.response.run.system import System, system_at
from yawdesign.response.track.lines import INPUTS, WAVELENGTH
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.elements import WheelRailContact
from yawdesign.vehicle.polynomials import evaluate
from yawdesign.vehicle.vehicle import families, known_coordinates

MOST_WAVELENGTHS = 100_000  # about 1 GB
BLOCK = 1000  # frequencies solved at once
EXACT = 1e-9  # largest relative difference of the two ways


@dataclass(frozen=True, repr=False, eq=False)
class FrequencyResponse(Result):
    """Complex amplitude of every coordinate on a harmonic track of amplitude 1 (1 m, or 1 rad of cross-level).

    The time factor is exp(+j w t), the phase is zero where the first wheelset stands, and each one behind it sees the
    track later. Of an unstable vehicle this is the motion that it would have if it did not grow.

    Parameters
    ----------
    wavelength, frequency : float or ndarray
        Wavelength [m] and frequency v / wavelength [Hz].
    input : str
        "alignment" or "cross_level".
    speed, C_s : float
        Speed [m/s] and damping of the pair of yaw dampers [N s/m].
    stable : bool
        Whether free motions die out.
    checked : bool
        True if state matrix and polynomial matrix give the same to 1e-9.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and what else is not as
        written, in SI units.
    amplitudes : mapping of str to complex or ndarray
        By coordinate, per unit of the input: lateral ones such as ``y_b`` [m], angles such as ``phi_b`` [rad]. Each is
        an attribute of the result as well, ``result.y_b``; what a vehicle does not have, such as a motor, is None.
    """

    wavelength: Any
    frequency: Any
    input: str
    speed: float
    C_s: float
    stable: bool
    checked: bool
    condition: Mapping[str, Any]
    amplitudes: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        if name in known_coordinates():
            return vars(self).get("amplitudes", {}).get(name)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        columns = {"wavelength": self.wavelength, "frequency": self.frequency, **self.amplitudes}
        return {"amplitudes": {name: np.atleast_1d(values) for name, values in columns.items()}}

    def _entries(self) -> Mapping[str, Any]:
        """Return its values by the keys of `to_dict`: those of all coordinates that such a vehicle may have."""
        own = {name: value for name, value in super()._entries().items() if name != "amplitudes"}
        like = next(names for names in families() if self.amplitudes.keys() <= set(names))
        return own | {name: self.amplitudes.get(name) for name in like}


def frequency_response(
    problem: Problem,
    wavelength: Any = 20.0,
    input: str = "alignment",  # noqa: A002 - the word of the field
    *,
    speed: Any = None,
    condition: Asked = AS_WRITTEN,
) -> FrequencyResponse:
    """Return how the vehicle answers a harmonic track.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``.
    wavelength : float, str or sequence of them
        Wavelength of the track [m] or text with a unit; an array of shape (n,) gives answers of shape (n,).
    input : {"alignment", "cross_level"}
        What varies along the track: its centre line [m] or its cross-level angle [rad]. Either acts through gravity and
        conicity as in (W lambda/b)(y_w - y_a), 2 f_22 (b lambda/r)(y_w - y_a) and W theta.
    speed : float or str, optional
        Speed [m/s] or text with a unit; the problem's own if it has a single one.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    FrequencyResponse

    Raises
    ------
    ProblemError
        If a value is not accepted, ``C_s`` is missing, or the problem has a range of speeds and none is given.

    Examples
    --------
    >>> import yawdesign as yd
    >>> problem = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m", speed="250 km/h")
    >>> y_b = yd.frequency_response(problem, wavelength="20 m").y_b
    >>> round(y_b.real, 6), round(y_b.imag, 6)
    (-1.069824, -0.021305)
    """
    mistakes = Mistakes()
    with mistakes.under("wavelength"):
        lengths = _lengths(wavelength)
    with mistakes.under("input"):
        as_choice(input, INPUTS)
    with mistakes.under(""):
        asked, v = at_one_speed(problem, condition, speed)
    mistakes.report()
    system = system_at(asked.problem, v)
    omega = 2 * np.pi * v / lengths
    u = system.wheelsets.harmonic(omega, input)
    x = states(system, omega, u)[:, : len(system.coordinates)]
    other = _by_polynomials(system, omega, u)
    scalar = isinstance(wavelength, str) or np.ndim(wavelength) == 0

    def shaped(values: Any) -> Any:
        return values[0].item() if scalar else values

    return FrequencyResponse(
        wavelength=shaped(lengths),
        frequency=shaped(v / lengths),
        input=input,
        speed=v,
        C_s=system.C_s,
        stable=system.stable,
        checked=_same(x, other),
        condition=asked.described(v),
        amplitudes={name: shaped(x[:, k]) for k, name in enumerate(system.coordinates)},
    )


def _lengths(wavelength: Any) -> Float:
    values = as_several(wavelength)
    if not values:
        raise ProblemError("no wavelength is given: expected one or a list of them")
    if len(values) > MOST_WAVELENGTHS:
        raise ProblemError(f"{len(values)} values are too many: at most {MOST_WAVELENGTHS} at a time")
    return np.array([float(WAVELENGTH.check(x)) for x in values])


def at_one_speed(problem: Problem, condition: Asked, speed: Any = None) -> tuple[Chosen, float]:
    """Return a problem under a condition, and the speed [m/s]: a given one, or the single one that there is then."""
    mistakes, given = Mistakes(), []
    with mistakes.under("speed"):
        given = [] if speed is None else [SPEED.accept(speed)]
    with mistakes.under(""):
        asked = chosen(problem, condition, given)
    mistakes.report()
    if len(asked.speeds) > 1:
        text = "is missing: the problem has a range of speeds, say which one, such as '300 km/h'"
        raise ProblemError(text).under("speed")
    return asked, float(asked.speeds[0])


def states(system: System, omega: Float, u: Complex) -> Complex:
    """Return the states of the harmonic motion under inputs u exp(j omega t), shape (len(omega), n)."""
    unit = np.eye(len(system.A))
    blocks = []
    for k in range(0, len(omega), BLOCK):
        s = 1j * omega[k : k + BLOCK, None, None]
        force = u[k : k + BLOCK] @ system.B.T
        blocks.append(np.linalg.solve(s * unit - system.A, force[..., None])[..., 0])
    return np.concatenate(blocks) if blocks else np.zeros((0, len(unit)), dtype=complex)


def outputs(system: System, omega: Float, u: Complex) -> Complex:
    """Return all outputs of the harmonic motion under inputs u exp(j omega t), shape (len(omega), outputs)."""
    return np.asarray(states(system, omega, u) @ system.C.T + u @ system.D.T)


def _by_polynomials(system: System, omega: Float, u: Complex) -> Complex:
    space = system.space
    entries = polynomial_matrix(space.elements)
    rows = {node: k for k, node in enumerate(dict.fromkeys(row for row, _ in entries))}
    matrix = np.zeros((len(omega), len(rows), len(rows)), dtype=complex)
    i, j = np.array([(rows[row], rows[column]) for row, column in entries]).T
    powers = tuple(np.array(power, dtype=float) for power in zip_longest(*entries.values(), fillvalue=0))
    matrix[:, i, j] = evaluate(powers, 1j * omega[:, None])
    force = np.zeros((len(omega), len(rows)), dtype=complex)
    columns = dict(zip(space.inputs, u.T, strict=True))
    for contact in (e for e in space.elements if isinstance(e, WheelRailContact)):
        for (row, name), value in contact.inputs().items():
            force[:, rows[row]] += value * columns[name]
    found = np.linalg.solve(matrix, force[..., None])[..., 0]
    return np.asarray(found[:, [rows[x] for x in space.coordinates]])


def _same(x: Complex, y: Complex) -> bool:
    size = np.max(np.abs(x), axis=1, keepdims=True)
    return bool(np.all(np.abs(x - y) <= EXACT * np.maximum(size, np.abs(x)) + np.finfo(float).tiny))

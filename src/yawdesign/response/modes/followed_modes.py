"""Modes followed through a sweep of one parameter, each keeping its identity and the name it has in the problem."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Complex, Float
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, chosen
from yawdesign.hunting.eigenvalues import EXACT, backward_error, folded_matrix
from yawdesign.hunting.verdict import given_damping, least_stable
from yawdesign.problem import PARAMETERS, Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.result import Result
from yawdesign.problem.running import SPEED
from yawdesign.problem.table import Parameter, as_several, key_of
from yawdesign.response.modes.eigenvectors import parts
from yawdesign.response.modes.links import LOST
from yawdesign.response.modes.names import named_roots
from yawdesign.response.modes.paths import Path, follow_part, names_at_home, size
from yawdesign.vehicle.vehicle import Model, Vehicle

SPEED_NAMES = ("v", "speed")
MOST_VALUES = 10_000  # of the parameter: about a minute and 0.3 GB


@dataclass(frozen=True)
class Meeting:
    """Two modes that meet, or nearly, between two values of the parameter.

    Parameters
    ----------
    low, high : float
        The meeting lies between these values of the parameter, in its SI unit.
    modes : tuple of str
        Who meets.
    kind : {"become a pair", "become two real roots", "pass close by", "cannot be told apart"}
        What two roots do as the parameter goes from its first value to its last. Two that pass close by come nearer
        than 0.1 % of their size; they stay who they are, but their motions are then nearly one, or are exchanged. Two
        that cannot be told apart coincide, as far as can be resolved; who is who afterwards is not known.
    eigenvalue : complex
        Where they meet [1/s].
    distance : float
        How near they come [1/s]; 0 for roots that meet.
    """

    low: float
    high: float
    modes: tuple[str, ...]
    kind: str
    eigenvalue: complex
    distance: float


@dataclass(frozen=True, repr=False, eq=False)
class FollowedModes(Result):
    """Modes of a bogie along one parameter.

    Parameters
    ----------
    axis, unit : str
        The parameter, and its SI unit.
    values : ndarray, shape (points,)
        Its values [`unit`].
    names : tuple of str
        Of the modes: what `modes` calls each at the problem's own value of the parameter, wherever that lies (at the
        speed that `modes` takes; at the least value of the axis, if the problem has none of its own). Of a pair that
        has become two real roots, the second one is called so.
    eigenvalues : ndarray, shape (points, modes)
        [1/s], on the real axis or above it. A pair of conjugate roots is one mode, a real root is one. Where two real
        modes meet and become a pair, the mode of the larger root goes on as the pair, and the other is nan until the
        pair becomes two real roots again.
    frequency, damping_ratio : ndarray, shape (points, modes)
        [Hz], [-].
    certainty : ndarray, shape (points - 1, modes)
        How sure each link between neighbouring points is [-]: one minus the error of the predicted root, relative to
        the error the next best root would have had; the least over all steps in between. Above 0.75 unless two modes
        meet; nan where two meet on the real axis, since what is the same root there is a convention.
    meetings : tuple of Meeting
        Where two modes meet.
    speed, C_s : float or None
        What was held [m/s], [N s/m]; None for the parameter that was swept.
    evaluations : int
        Number of spectra it took.
    residual : float
        Largest backward error of the characteristic polynomial at the eigenvalues [-].
    checked : bool
        True if every eigenvalue is a root of the characteristic polynomial, and every link is sure.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and what else is not as
        written, in SI units; without the parameter that was swept.
    """

    axis: str
    unit: str
    values: Float
    names: tuple[str, ...]
    eigenvalues: Complex
    frequency: Float
    damping_ratio: Float
    certainty: Float
    meetings: tuple[Meeting, ...]
    speed: float | None
    C_s: float | None
    evaluations: int
    residual: float
    checked: bool
    condition: Mapping[str, Any]

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        points, count = len(self.values), len(self.names)
        columns = {self.axis: np.repeat(self.values, count), "name": list(self.names) * points}
        numbers = ("frequency", "damping_ratio", "eigenvalues")
        columns |= {name.replace("eigenvalues", "eigenvalue"): getattr(self, name).ravel() for name in numbers}
        return {"modes": columns, **super()._tables()}

    def _units(self) -> Mapping[str, str]:
        return {self.axis: self.unit}


def follow_modes(
    problem: Problem, *, condition: Asked = AS_WRITTEN, **axis: Sequence[float | str] | NDArray[np.float64]
) -> FollowedModes:
    """Follow the modes of a problem's bogie along one parameter.

    Parameters
    ----------
    problem : Problem
        The bogie; with one speed, unless the speed is what varies.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as
        written. What is followed goes through it.
    **axis
        One parameter and its values in rising or falling order, SI numbers or texts with a unit: ``v``, or any
        parameter of the bogie, such as ``C_s=["100 kN s/m", "1 MN s/m"]``.

    Returns
    -------
    FollowedModes

    Raises
    ------
    ProblemError
        If there is not one axis, or one of its values is not accepted.

    Examples
    --------
    >>> import yawdesign as yd
    >>> paths = yd.follow_modes(yd.table1(), v=["100 km/h", "200 km/h", "300 km/h"])
    >>> hunting = paths.names.index("wheelset hunting 1")
    >>> [round(float(f), 3) for f in paths.frequency[:, hunting]]
    [1.307, 2.209, 2.553]
    """
    asked = chosen(problem, condition)
    problem = asked.problem
    name, row, values = _axis(problem, axis)
    C_s = None if name == "C_s" else given_damping(problem)
    vehicle = Model.of(problem).at(problem.parameters(), v=problem.speeds[0])
    matrices = _matrices(vehicle, name, values)
    home = _home(problem, vehicle, name, values, matrices)
    places = parts(np.any([matrices(value) != 0 for value in (*values, home)], axis=0))
    paths = [follow_part(values, home, matrices, states) for states in places]
    branches = np.hstack([path.s for path in paths])
    kept = np.flatnonzero(np.any(branches.imag >= 0, axis=0))
    kept = kept[np.argsort(size(branches[:, kept]), kind="stable")]
    roots = named_roots(vehicle.replace(**{name: home}))
    named = (names_at_home(path, states, roots) for path, states in zip(paths, places, strict=True))
    all_names = list(chain.from_iterable(named))
    names = tuple(all_names[k] for k in kept)
    s = np.where(branches.imag >= 0, branches, complex(np.nan, np.nan))[:, kept]
    certainty = np.hstack([path.certainty for path in paths])[:, kept]
    speed = None if name == "v" else float(problem.speeds[0])
    label = {int(k): mode for k, mode in zip(kept, names, strict=True)}
    meetings = _meetings(paths, label)
    polynomial = vehicle.replace(**{name: values[:, None]}).polynomial
    residual = float(np.nanmax(backward_error(polynomial, s)))
    sure = all(meeting.kind != LOST for meeting in meetings)
    return FollowedModes(
        axis=name,
        unit=row.si,
        values=values,
        names=names,
        eigenvalues=s,
        frequency=s.imag / (2 * np.pi),
        damping_ratio=-s.real / np.where(s == 0, 1, np.abs(s)),
        certainty=certainty,
        meetings=meetings,
        speed=speed,
        C_s=C_s,
        evaluations=matrices.cache_info().misses,
        residual=residual,
        checked=residual < EXACT and sure,
        condition=asked.described(speed, without=name),
    )


def _axis(problem: Problem, axis: Mapping[str, Any]) -> tuple[str, Parameter, Float]:
    """Return the one axis, its row of the table, and its values in SI."""
    if len(axis) != 1:
        listed = ", ".join(axis) or "none given"
        raise ProblemError(f"modes are followed along one parameter, not {len(axis)}: {listed}")
    (key, given), allowed = next(iter(axis.items())), (*SPEED_NAMES, *problem.keys)
    key = "v" if key == "speed" else key_of(key)
    mistakes = Mistakes()
    with mistakes.under(key):
        if key not in allowed:
            raise ProblemError(unknown_key(key, allowed))
        if key != "v" and len(problem.speeds) > 1:
            raise ProblemError("is followed at one speed, the problem has a range: problem.replace(speed=...)")
    mistakes.report()
    row = replace(SPEED, key="v") if key == "v" else PARAMETERS[key]
    return key, row, _values(key, row, given)


def _values(key: str, row: Parameter, given: Any) -> Float:
    listed, computed = as_several(given), isinstance(given, np.ndarray)
    if len(listed) > MOST_VALUES:
        raise ProblemError(f"{key}: {len(listed)} values are too many: at most {MOST_VALUES} are followed")
    mistakes, values = Mistakes(), []
    for k, value in enumerate(listed):
        with mistakes.under(f"{key}[{k}]"):
            values.append(float(row.check(value) if computed else row.accept(value)))
    mistakes.report()
    steps = np.sign(np.diff(values))
    if len(values) < 2 or not (np.all(steps > 0) or np.all(steps < 0)):
        raise ProblemError(f"{key}: give at least two values, all rising or all falling")
    return np.array(values)


def _matrices(vehicle: Vehicle, name: str, values: Float) -> Any:
    """Return a function that returns, and remembers, the state matrix at a value of the axis."""

    def at(value: Any) -> Float:
        return folded_matrix(vehicle.replace(**{name: value}))

    if len(at(values[0])) != len(at(values[-1])):
        raise ProblemError(f"{name}: the value 0 takes a damper out of the model; start above it")
    every = at(values)  # at once, which is faster; those between them follow where they are needed
    given = dict(zip(values, np.broadcast_to(every, (len(values), *every.shape[-2:])), strict=True))
    return cache(lambda value: given[value] if value in given else at(value))


def _home(problem: Problem, vehicle: Vehicle, name: str, values: Float, matrices: Callable[[float], Float]) -> float:
    """Return the problem's own value of the axis, where the modes get their names.

    Where the problem has none, or there has a damper less than along the axis, it is the least one of the axis.
    """
    own = least_stable(problem)[1].speed if name == "v" else vehicle.p.get(name)
    if own is None or len(matrices(float(own))) != len(matrices(float(values[0]))):
        return float(values.min())
    return float(own)


def _meetings(paths: Sequence[Path], label: Mapping[int, str]) -> tuple[Meeting, ...]:
    found, first = [], 0
    for path in paths:
        for e in path.encounters:
            names = tuple(sorted({label[first + k] for k in e.roots if first + k in label}))
            found.append(Meeting(min(e.low, e.high), max(e.low, e.high), names, e.kind, e.s, e.distance))
        first += len(path.home)
    return tuple(sorted(found, key=lambda meeting: meeting.low))

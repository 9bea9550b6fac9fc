"""The design of largest margin that the curve allows: dense search, IPOPT, and a polish by verdicts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from yawdesign.damper.best_design import best_design
from yawdesign.damper.capping import GIVEN_AWAY, CappingMode, at_design, capping_modes, names_of, sensitivity
from yawdesign.damper.curving import excess, largest_resistance
from yawdesign.damper.design_space import Space, fraction, scale
from yawdesign.damper.forward import ForwardDesign, design, forward_design
from yawdesign.damper.second_route import AGREE, hurwitz_positive, margin_by_routh
from yawdesign.damper.stable_intervals import others_stable
from yawdesign.damper.status import Status
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.many.measure import Measure
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.verdict import CaseVerdict, Mode, Stability, judged, stability_at
from yawdesign.problem import Curve, Problem, ProblemError
from yawdesign.problem.arguments import Progress
from yawdesign.problem.result import Result
from yawdesign.problem.table import as_seed
from yawdesign.vehicle.vehicle import Vehicle

ACTIVE = 1e-4  # a variable within this share of its range from a bound stands at the bound


@dataclass(frozen=True)
class Bound:
    """Where a variable of the optimum lies.

    Parameters
    ----------
    value, min, max : float
        In SI units; the bounds as written.
    position : float
        Between its bounds, 0 ... 1 [-], on the scale of the search: linear below the parameter's least usual value,
        geometric above.
    """

    value: float
    min: float
    max: float
    position: float


@dataclass(frozen=True)
class SingleOptimum:
    """What optimising one bogie under a car body that stands still would have answered for a vehicle.

    Parameters
    ----------
    optimum : mapping
        Values of the design variables, in SI units (None without motors).
    margin : float or None
        Its worst margin under the car body that stands still: [1/s] for a decay rate, [-] for a damping ratio.
    margin_with_car_body : float or None
        The worst margin of that design under the car body that moves [1/s], [-].
    stable : bool
        Whether it is stable there.
    """

    optimum: Mapping[str, float | None]
    margin: float | None
    margin_with_car_body: float | None
    stable: bool


@dataclass(frozen=True, repr=False)
class Optimum(Result):
    """Answer of the optimisation.

    Parameters
    ----------
    optimum : mapping
        Value of C_s, K_m, C_m and of every other design variable, in SI units (None without motors).
    objective : {"decay_rate", "damping_ratio"}
        What was maximised.
    C_s : float or None
        Damping of the pair of yaw dampers at the optimum [N s/m]; that of the golden section is ``forward.C_s``.
    margin, margin_before : float or None
        Worst margin under all conditions, of the optimum and of the problem as written (None without a value of C_s):
        [1/s] for a decay rate, [-] for a damping ratio.
    worst_condition : mapping
        The condition under which the optimum has that margin: ``speed`` [m/s].
    active : tuple of str
        Limits at which the optimum lies: ``"K_m max"``, ``"rotational_resistance"``.
    status : Status
        What kind of answer this is.
    message : str
        The same in a sentence, and what to do.
    stable : bool
        Whether the optimum is stable under every condition.
    C_su : float or None
        What the curve allows with the optimum's bogie, eq. (14) [N s/m].
    rotational_resistance : float or None
        T / (4 Q a) of the optimum [-].
    bounds : mapping name -> Bound
        Where in its bounds each variable lies.
    before : mapping
        Values of the design variables as written, in SI units (None where not given).
    fixed_modes : mapping name -> tuple of complex
        Roots that no design variable moves [1/s].
    modes : tuple of Mode
        All modes of the optimum under its worst condition.
    next_margin : float or None
        Where modes cap the margin that the variables hardly move (less than a fifth over their bounds): the worst
        margin of all others, which is then the largest with at most 2 % of the largest margin given away [1/s], [-].
    capped_by : str or None
        Names of those modes, such as ``"lower sway"``, as `modes` calls them.
    capping_sensitivity : mapping
        d ln margin / d ln p [-] of the first of them for every parameter p and the speed v, the largest first.
    cases : tuple of CaseVerdict
        Stability of the optimum with each fault of the problem.
    requirements : tuple
        What was required and reached: none.
    hurwitz_positive : bool
        Whether all Hurwitz minors of eq. (10) are positive at the optimum, under every condition.
    margin_polynomial : float or None
        The margin by Routh's array of the polynomial, found by bisection: the second route [1/s], [-].
    checked : bool
        Whether both routes agree.
    load : str or None
        The load that stands for Q in eq. (13): axle or wheel.
    forward : ForwardDesign
        The forward design with the optimum's bogie: critical values, stable intervals, golden section.
    single_bogie : SingleOptimum or None
        For a vehicle with a car body whose variables a bogie has: what one bogie alone would have answered.
    """

    optimum: Mapping[str, float | None]
    objective: str
    C_s: float | None
    margin: float | None
    margin_before: float | None
    worst_condition: Mapping[str, float]
    active: tuple[str, ...]
    status: str
    message: str
    stable: bool
    C_su: float | None
    rotational_resistance: float | None
    bounds: Mapping[str, Bound]
    before: Mapping[str, float | None]
    fixed_modes: Mapping[str, tuple[complex, ...]]
    modes: tuple[Mode, ...]
    hurwitz_positive: bool
    margin_polynomial: float | None
    checked: bool
    load: str | None
    forward: ForwardDesign
    next_margin: float | None = None
    capped_by: str | None = None
    capping_sensitivity: Mapping[str, float] = field(default_factory=dict)
    requirements: tuple[Any, ...] = ()
    cases: tuple[CaseVerdict, ...] = ()
    single_bogie: SingleOptimum | None = None


def optimise(
    problem: Problem,
    *,
    seed: int = 0,
    options: Mapping[str, Any] | None = None,
    progress: Progress = lambda text, part: None,
) -> Optimum:
    """Return the design with the largest margin under the curving constraint of eq. (13).

    Parameters
    ----------
    problem : Problem
        Its design variables, bounds and objective say what is sought. The margin is the worst over its speeds.
    seed : int, optional
        Of the search points. With up to three variables the answer does not depend on it; with more, try a few.
    options : mapping, optional
        Options of CasADi's `nlpsol` for IPOPT; they win over the defaults.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Raises
    ------
    ProblemError
        If C_s is neither given nor a design variable.
    """
    seed = as_seed(seed) or 0
    space = Space(problem)
    if "C_s" not in space.names and problem.bogie.C_s is None:
        raise ProblemError("bogie.C_s is missing: give its value, or make it a design variable")
    if space.curve is not None and not space.feasible(space.values(space.gentlest)):
        return _nothing(space, space.curve)
    space, x = best_design(space, seed, options or {}, progress)
    capping = capping_modes(space, x) if space.model.has_car_body else ()
    if capping:
        # Numbers, and not x, go on: the curve's limit stays where it is.
        least, values = float(np.squeeze(space.margins_at(x[:, None]))), space.values(x)
        anchor = {name: float(values[name]) for name in space.names}
        second = replace(space, pairs=len(capping), floor=(1 - GIVEN_AWAY) * least, anchors_given=(anchor,))
        space, x = best_design(second, seed, options or {}, progress)
    return replace(_answer(space, x, capping), single_bogie=_single(space, seed, options))


def _single(space: Space, seed: int, options: Mapping[str, Any] | None) -> SingleOptimum | None:
    """Return what one bogie alone would have answered, and what that is worth under the car body."""
    problem = space.problem.of_one_bogie
    if problem is None or not set(space.names) <= set(problem.keys):
        return None
    alone = optimise(problem, seed=seed, options=options)
    if alone.margin is None:
        return SingleOptimum(alone.optimum, None, None, stable=False)
    chosen = {name: bound.value for name, bound in alone.bounds.items()}
    p = {name: float(value) for name, value in (space.problem.parameters() | chosen).items()}
    vehicles = [space.model.at(condition.applied(p)) for condition in space.conditions]
    results = [stability_at(vehicle, space.names) for vehicle in vehicles]
    moving, _ = _worst(space, results)
    return SingleOptimum(alone.optimum, alone.margin, moving, stable=all(result.stable for result in results))


def _answer(space: Space, x: Float, capping: Sequence[CappingMode]) -> Optimum:
    values = {name: float(np.squeeze(v)) for name, v in space.values(x).items()}
    vehicles = [space.model.at(condition.applied(values)) for condition in space.conditions]
    results = [stability_at(vehicle, space.names) for vehicle in vehicles]
    margin, worst = _worst(space, results)
    second = margin_by_routh(space, vehicles, margin)
    nexts = _next_margins(space, vehicles) if capping else (margin, margin)
    stable = all(result.stable for result in results)
    agree = all(result.checked for result in results) and abs(second - margin) <= AGREE[space.objective]
    agree = agree and abs(nexts[0] - nexts[1]) <= AGREE[space.objective]
    status = (Status.OPTIMAL if stable else Status.UNSTABLE) if agree else Status.UNVERIFIED_OPTIMUM
    helpless = status == Status.UNSTABLE and not all(others_stable(vehicle) for vehicle in vehicles)
    bounds = {name: _bound(space, name, values[name]) for name in space.names}
    resisted = space.curve and largest_resistance(values, values["C_s"], space.loads, space.curve)
    return _optimum(
        space,
        forward_design(space.model, values, space.condition_set, space.curve),
        status,
        optimum={name: values.get(name) for name in _named(space)},
        margin=margin,
        **_capped(space, vehicles[worst], capping, nexts),
        worst_condition=space.conditions[worst].described,
        active=_active(bounds, resisted, space.curve),
        message=Status.UNDAMPED.message if helpless else status.message,
        stable=stable,
        rotational_resistance=resisted,
        bounds=bounds,
        fixed_modes=results[worst].fixed_modes,
        modes=results[worst].modes,
        hurwitz_positive=all(hurwitz_positive(vehicle) for vehicle in vehicles),
        margin_polynomial=second,
        checked=agree,
        cases=tuple(judged(case, vehicles, space.conditions, space.names) for case in space.problem.cases),
    )


def _next_margins(space: Space, vehicles: Sequence[Vehicle]) -> tuple[float, float]:
    """Return the worst margin of all modes but those that cap it, by eigenvalues and by Routh's array."""
    others = Measure(space.objective, space.names, pairs=space.pairs)
    margin = min(float(others.of(ParameterSets(space.model, vehicle.p, 1))[0]) for vehicle in vehicles)
    return margin, margin_by_routh(space, vehicles, margin, space.pairs)


def _capped(space: Space, vehicle: Vehicle, capping: Sequence[CappingMode], nexts: Sequence[float]) -> dict[str, Any]:
    """Return what is told of the modes that cap the margin, under its worst condition."""
    if not capping:
        return {}
    modes = [at_design(vehicle, mode, space.objective) for mode in capping]
    return {
        "next_margin": nexts[0],
        "capped_by": names_of(vehicle, modes),
        "capping_sensitivity": sensitivity(vehicle, modes[0], space.objective),
    }


def _nothing(space: Space, curve: Curve) -> Optimum:
    values = {name: float(value) for name, value in space.values(space.gentlest).items()}
    return _optimum(
        space,
        design(space.problem),
        Status.NO_FEASIBLE_DESIGN,
        optimum=dict.fromkeys(_named(space)),
        margin=None,
        worst_condition={},
        active=("rotational_resistance",),
        message=Status.NO_FEASIBLE_DESIGN.told(excess(values, space.names, curve)),
        stable=False,
        rotational_resistance=None,
        bounds={},
        fixed_modes={},
        modes=(),
        hurwitz_positive=False,
        margin_polynomial=None,
        checked=True,
    )


def _named(space: Space) -> tuple[str, ...]:
    return tuple(dict.fromkeys(("C_s", "K_m", "C_m", *space.names)))


def _optimum(space: Space, forward: ForwardDesign, status: Status, **own: Any) -> Optimum:
    return Optimum(
        C_s=own["optimum"]["C_s"],
        objective=space.objective,
        margin_before=_margin_before(space),
        status=status,
        C_su=forward.C_su,
        before={name: space.problem.parameters().get(name) for name in space.names},
        load=forward.load,
        forward=forward,
        **own,
    )


def _margin_before(space: Space) -> float | None:
    if space.problem.bogie.C_s is None:
        return None
    return _worst(space, [stability_at(vehicle, space.names) for vehicle in Vehicle.of(space.problem)])[0]


def _worst(space: Space, results: Sequence[Stability]) -> tuple[float, int]:
    """Return the worst margin, and the number of its condition."""
    margins = [float(getattr(result, space.objective)) for result in results]
    return min(margins), margins.index(min(margins))


def _bound(space: Space, name: str, value: float) -> Bound:
    low, high = space.bounds(name)
    return Bound(value, low, high, fraction(low, high, value, scale(name)))


def _active(bounds: Mapping[str, Bound], resistance: float | None, curve: Curve | None) -> tuple[str, ...]:
    ends = [(f"{name} min", b.position) for name, b in bounds.items()]
    ends += [(f"{name} max", 1 - b.position) for name, b in bounds.items()]
    if resistance is not None and curve is not None:
        ends.append(("rotational_resistance", 1 - resistance / curve.limit))
    return tuple(name for name, gap in ends if gap < ACTIVE)

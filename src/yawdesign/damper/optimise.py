"""The design of largest margin that the curve allows: dense search, IPOPT, and a polish by verdicts."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from yawdesign.damper.curving import excess, rotational_resistance
from yawdesign.damper.design_space import Space, fraction, scale
from yawdesign.damper.forward import REMEDIES, UNDAMPED, ForwardDesign, design, factors_damped
from yawdesign.damper.nlp import improve
from yawdesign.damper.search import refine, search
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.hurwitz import hurwitz_minors
from yawdesign.hunting.old import stability_at
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.verdict import Mode, Stability
from yawdesign.problem import Curve, Problem, ProblemError
from yawdesign.problem.arguments import Progress
from yawdesign.problem.table import as_seed
from yawdesign.vehicle.old import paper_coefficients
from yawdesign.vehicle.polynomials import trim

TURNS = ((6, 1e-3), (2, 1e-5))  # number of starts of the NLP, radius of the refinement after it
# How close the margins by two routes must be. Where two roots coalesce, as they do at many optima, an eigenvalue is
# right to 1e-8 of its own modulus only; a hunting mode's is 10 ... 30 rad/s.
AGREE = {"decay_rate": 2e-5, "damping_ratio": 1e-6}
MOST_SEARCHES = 7  # in six variables and more; what these miss, other seeds may find
ACTIVE = 1e-4  # a variable within this share of its range from a bound stands at the bound

MESSAGES = {
    "optimal": "best design found within the bounds and the curve's limit",
    "unstable": "no design within the bounds is stable: lower the speed, widen the bounds or vary other parameters",
    "infeasible": "no design within the bounds keeps the curve's limit: {}; lower C_s or its bounds, allow a larger "
    "radius or limit, or let other parameters vary",
    "unverified": "eigenvalues and Routh's array differ: do not use this result; the parameters are too extreme for "
    "double precision",
}


@dataclass(frozen=True)
class Bound:
    """Where a variable of the optimum lies.

    Parameters
    ----------
    value, min, max : float
        In SI units; the bounds as written.
    position : float
        Between its bounds, 0 ... 1, on the scale of the search: linear below the parameter's least usual value,
        geometric above.
    """

    value: float
    min: float
    max: float
    position: float


@dataclass(frozen=True, repr=False)
class Optimum(ForwardDesign):
    """Answer of the optimisation; the keys of `ForwardDesign` are those of the optimum's bogie.

    Parameters
    ----------
    optimum : mapping
        Value of C_s, K_m, C_m and of every other design variable, in SI units (None without motors).
    objective : {"decay_rate", "damping_ratio"}
        What was maximised.
    margin, margin_before : float or None
        Worst margin over all speeds, of the optimum and of the problem as written (None without a value of C_s): 1/s
        for a decay rate.
    active : tuple of str
        Limits at which the optimum lies: ``"K_m max"``, ``"rotational_resistance"``.
    bounds : mapping name -> Bound
        Where in its bounds each variable lies.
    status, message : str
        What kind of answer this is, and what to do.
    design_status : str
        Status of the forward design with the optimum's bogie.
    rotational_resistance : float or None
        T / (4 Q a) of the optimum.
    fixed_modes : mapping name -> tuple of complex
        Roots that no design variable moves [1/s].
    modes : tuple of Mode
        All modes of the optimum at the worst speed.
    hurwitz_positive : bool
        Whether all Hurwitz minors of eq. (10) are positive at the optimum, at every speed.
    margin_polynomial : float or None
        The margin by Routh's array of the polynomial, found by bisection: the second route.
    before : mapping
        Values of the design variables as written (None where not given).
    forward : ForwardDesign
        The forward design with the optimum's bogie.
    optimum_stable : bool
        Whether the optimum is stable at every speed (`stable` belongs to the golden section, `C_s`).
    """

    optimum: Mapping[str, float | None]
    objective: str
    margin: float | None
    margin_before: float | None
    active: tuple[str, ...]
    bounds: Mapping[str, Bound]
    design_status: str
    fixed_modes: Mapping[str, tuple[complex, ...]]
    modes: tuple[Mode, ...]
    hurwitz_positive: bool
    margin_polynomial: float | None
    before: Mapping[str, float | None]
    forward: ForwardDesign
    optimum_stable: bool


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
    found = np.concatenate([search(space, seed + k, progress) for k in range(_searches(space))], axis=1)
    return _answer(space, _best(space, found, seed, options or {}, progress))


def _searches(space: Space) -> int:
    """Return how many independent searches are made: what one cannot sample densely, several must not miss."""
    return min(max(1, 2 * len(space.names) - 5), MOST_SEARCHES)


def _best(space: Space, x: Float, seed: int, options: Mapping[str, Any], progress: Progress) -> Float:
    """Return the best point after IPOPT and refinement in turn: each leaves the ridges on which the other stops."""
    rng, margin = np.random.default_rng(seed), space.margins_at(x)
    order = np.argsort(-margin, kind="stable")
    x, margin = x[:, order], margin[order]
    more = min(max(1, len(space.names) - 2), MOST_SEARCHES)  # local optima multiply with the variables
    for turn, (starts, radius) in enumerate(TURNS):
        progress("solving the NLP", turn / len(TURNS))
        reached = [
            y for k in range(min(starts * more, x.shape[1])) for y in improve(space, x[:, k], float(margin[k]), options)
        ]
        reached = [y[:, None] for y in reached if np.all(np.isfinite(y))]
        x = np.concatenate([x, *reached], axis=1)
        margin = space.margins_at(x)
        order = np.argsort(-margin, kind="stable")[: 4 * more]
        x = refine(space, x[:, order], margin[order], rng, radius=radius, until=1e-11, rounds=30)
        margin = space.margins_at(x)
    return x[:, 0]


def _answer(space: Space, x: Float) -> Optimum:
    values = {name: float(np.squeeze(v)) for name, v in space.values(x).items()}
    margin = float(space.margins(values))
    second = _bisect(space, values, margin)
    worst = _worst(space, values)
    final = space.problem.replace(**values)
    forward = design(final)
    agree = worst.checked and abs(second - margin) <= AGREE[space.problem.design.objective]
    status = "unverified" if not agree else ("optimal" if worst.stable else "unstable")
    bounds = {name: _bound(space, name, values[name]) for name in space.names}
    return _optimum(
        space,
        forward,
        status,
        optimum={name: values.get(name) for name in dict.fromkeys(("C_s", "K_m", "C_m", *space.names))},
        margin=margin,
        active=_active(space, values, bounds),
        bounds=bounds,
        rotational_resistance=_resistance(space, values),
        fixed_modes=worst.fixed_modes,
        modes=worst.modes,
        hurwitz_positive=_hurwitz_positive(space, values),
        margin_polynomial=second,
        optimum_stable=worst.stable,
        checked=agree and forward.checked,
        message=_message(space, status),
    )


def _message(space: Space, status: str) -> str:
    if status == "unstable" and not factors_damped(space.problem):
        return REMEDIES[UNDAMPED]
    return MESSAGES[status]


def _nothing(space: Space, curve: Curve) -> Optimum:
    values = {name: float(value) for name, value in space.values(space.gentlest).items()}
    message = MESSAGES["infeasible"].format(excess(values, space.names, curve))
    nothing: dict[str, Any] = {"margin": None, "active": ("rotational_resistance",), "bounds": {}, "fixed_modes": {}}
    nothing |= {"optimum_stable": False, "message": message}
    nothing |= {"modes": (), "hurwitz_positive": False, "margin_polynomial": None, "rotational_resistance": None}
    names = dict.fromkeys(("C_s", "K_m", "C_m", *space.names))
    return _optimum(space, design(space.problem), "infeasible", optimum=names, **nothing)


def _optimum(space: Space, forward: ForwardDesign, status: str, **own: Any) -> Optimum:
    inherited = {f.name: getattr(forward, f.name) for f in fields(forward)}
    common = {
        "objective": space.problem.design.objective,
        "margin_before": _margin_before(space),
        "status": status,
        "design_status": forward.status,
        "before": {name: space.problem.bogie.parameters().get(name) for name in space.names},
        "forward": forward,
    }
    return Optimum(**{**inherited, **common, **own})


def _margin_before(space: Space) -> float | None:
    p = space.problem.bogie.parameters()
    if "C_s" not in p:
        return None
    return _worst_margin(space, {name: float(v) for name, v in p.items()})


def _worst_margin(space: Space, values: Mapping[str, float]) -> float:
    results = [_at(space, values, k) for k in range(len(space.cases))]
    return float(min(getattr(result, space.problem.design.objective) for result in results))


def _at(space: Space, values: Mapping[str, float], k: int) -> Stability:
    return stability_at(space.cases[k].applied(values), values["C_s"], space.names, **space.model)


def _worst(space: Space, values: Mapping[str, float]) -> Stability:
    results = [_at(space, values, k) for k in range(len(space.cases))]
    return min(results, key=lambda r: (r.stable, getattr(r, space.problem.design.objective)))


def _bisect(space: Space, values: Mapping[str, float], margin: float) -> float:
    """Return the margin by Routh's array, looked for around the one by eigenvalues."""
    if space.problem.design.objective == "damping_ratio" and margin <= 0:
        return float("nan") if space.beats(dict(values), 0.0) else margin  # the sector's scheme ends at zero
    width = 100 * AGREE[space.problem.design.objective]
    low, high = margin - width, margin + width
    if not space.beats(dict(values), low) or space.beats(dict(values), high):
        return float("nan")
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if space.beats(dict(values), middle) else (low, middle)
    return float(low)


def _bound(space: Space, name: str, value: float) -> Bound:
    low, high = space.bounds(name)
    return Bound(value, low, high, fraction(low, high, value, scale(name)))


def _active(space: Space, values: Mapping[str, float], bounds: Mapping[str, Bound]) -> tuple[str, ...]:
    ends = [(f"{name} min", b.position) for name, b in bounds.items()]
    ends += [(f"{name} max", 1 - b.position) for name, b in bounds.items()]
    resistance = _resistance(space, values)
    if resistance is not None and space.curve is not None:
        ends.append(("rotational_resistance", 1 - resistance / space.curve.limit))
    return tuple(name for name, gap in ends if gap < ACTIVE)


def _resistance(space: Space, values: Mapping[str, float]) -> float | None:
    if space.curve is None or not values["W"]:
        return None
    return float(rotational_resistance(values, values["C_s"], space.curve))


def _hurwitz_positive(space: Space, values: Mapping[str, float]) -> bool:
    positive = True
    for case in space.cases:
        chi = paper_coefficients(case.applied(values), values["C_s"], unit=TIME_UNIT, **space.model)
        chi = trim(chi[::-1])[::-1]  # a damper without damping lowers the degree
        positive &= all(sign > 0 for sign in hurwitz_minors(chi)[0])
    return bool(positive)

"""The NLP that IPOPT solves: the largest margin, with the polynomial as a product of quadratics.

The polynomial, shifted by the margin t, is set equal to a product of quadratics s^2 + p s + q (and one linear factor
if its degree is odd) whose coefficients are variables beside the design; p >= 0 and q >= 0 say that all roots decay
faster than t. For a damping ratio the polynomial is not shifted and p^2 >= 4 t^2 q. Unlike single roots, the factors
stay smooth functions of the design where two roots coalesce or three modes tie, as they do at the best designs.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np

from yawdesign.damper.curving import resistance_scale, resisting_moment
from yawdesign.damper.design_space import Space, between, fraction, rigid_joints, scale
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.eigenvalues import roots
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.vehicle.old import characteristic
from yawdesign.vehicle.polynomials import Polynomial, product, scale_variable, shift, trim

OPTIONS: Mapping[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.max_iter": 200,
    "ipopt.tol": 1e-9,
    "error_on_fail": False,
}

# From a kink IPOPT must not be pushed far inside first, from a slope it must: no one setting serves all starts.
PUSHES: tuple[Mapping[str, Any], ...] = (
    {},
    {"ipopt.mu_init": 1e-4, "ipopt.bound_push": 1e-6, "ipopt.bound_frac": 1e-6},
    {"ipopt.mu_init": 1e-6, "ipopt.bound_push": 1e-8, "ipopt.bound_frac": 1e-8, "ipopt.slack_bound_push": 1e-8},
)


@dataclass
class _Program:
    """Variables with name, scale, guess and bounds, and constraints, as they are collected."""

    x: list[ca.SX] = field(default_factory=list)
    guess: list[float] = field(default_factory=list)
    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)
    g: list[ca.SX] = field(default_factory=list)
    g_low: list[float] = field(default_factory=list)
    g_high: list[float] = field(default_factory=list)

    def variable(self, name: str, guess: float, low: float, high: float, scale: float = 1.0) -> ca.SX:
        """Add a variable; bounds and guess are in its own unit, the solver sees it divided by scale."""
        symbol = ca.SX.sym(name)
        self.x.append(symbol)
        self.guess.append(guess / scale)
        self.low.append(low / scale)
        self.high.append(high / scale)
        return symbol * scale

    def constrain(self, expression: ca.SX, low: float, high: float) -> None:
        """Add a constraint."""
        self.g.append(expression)
        self.g_low.append(low)
        self.g_high.append(high)


def improve(space: Space, x: Float, margin: float, options: Mapping[str, Any]) -> list[Float]:
    """Return the points that IPOPT reaches from a point of the cube; some may be worse, or no numbers: look at them.

    Parameters
    ----------
    space : Space
        The design space.
    x : ndarray, shape (variables,)
        Start.
    margin : float
        Margin there.
    options : mapping
        CasADi `nlpsol` options; they win over the defaults.

    Returns
    -------
    list of ndarray
        One point of the cube for each of `PUSHES`.
    """
    program, t = _program(space, x, margin)
    places = [_solve(program, t, {**OPTIONS, **push, **options}, len(space.names)) for push in PUSHES]
    return [_in_cube(space, place) if np.all(np.isfinite(place)) else place for place in places]


def _in_cube(space: Space, places: Float) -> Float:
    """Return the point of the cube that belongs to fractions between the bounds as written."""
    pairs = zip(space.names, places, strict=True)
    values = {name: between(*space.bounds(name), place, scale(name)) for name, place in pairs}
    return space.coordinates({name: float(value) for name, value in values.items()})


def _program(space: Space, x: Float, margin: float) -> tuple[_Program, ca.SX]:
    program, start = _Program(), {name: float(np.squeeze(v)) for name, v in space.values(x).items()}
    ratio = space.problem.design.objective == "damping_ratio"
    unit = 1.0 if ratio else TIME_UNIT
    t0 = margin / unit - 1e-6 * abs(margin / unit)
    t = program.variable("margin", t0, -np.inf, 0.999 if ratio else np.inf, scale=max(abs(t0), 1e-3))
    values: dict[str, Any] = dict(space.fixed)
    for name, place in zip(space.names, _places(space, start), strict=True):
        values[name] = between_sx(*space.bounds(name), program.variable(name, place, 0.0, 1.0), scale(name))
    if space.curve is not None:
        share = resisting_moment(values, values["C_s"], space.curve)
        allowed = space.curve.limit * resistance_scale(values, space.curve)
        size = space.curve.limit * resistance_scale(start, space.curve)
        program.constrain((share - allowed) / size, -np.inf, 0.0)
    stiff = {K: np.inf for K, is_rigid in rigid_joints(start).items() if is_rigid}
    start, values = start | stiff, values | stiff
    for number, case in enumerate(space.cases):
        now = _polynomials(space, case.applied(start), start["C_s"])
        for part, p in enumerate(_polynomials(space, case.applied(values), values["C_s"])):
            _factorise(program, f"{number}.{part}", p, now[part], t, t0, ratio)
    return program, t


def _solve(program: _Program, t: ca.SX, options: Mapping[str, Any], variables: int) -> Float:
    nlp = {"x": ca.vertcat(*program.x), "f": -t, "g": ca.vertcat(*program.g)}
    solver = ca.nlpsol("margin", "ipopt", nlp, dict(options))
    found = solver(x0=program.guess, lbx=program.low, ubx=program.high, lbg=program.g_low, ubg=program.g_high)
    return np.clip(np.array(found["x"]).ravel()[1 : 1 + variables], 0, 1)


def _places(space: Space, values: Mapping[str, float]) -> list[float]:
    return [fraction(*space.bounds(name), values[name], scale(name)) for name in space.names]


def between_sx(low: float, high: float, x: ca.SX, size: float) -> ca.SX:
    """Return `between` for a symbol."""
    grown: ca.SX = (low + size) * (ca.exp(np.log1p((high - low) / (low + size)) * x) - 1)
    return low + grown


def _polynomials(space: Space, p: Mapping[str, Any], C_s: Any) -> list[Polynomial]:
    c = characteristic(p, **space.model)
    return [scale_variable(q, TIME_UNIT) for q in (c.core(C_s), *(c.factors[name] for name in space.movable))]


def _factorise(program: _Program, name: str, p: Polynomial, now: Polynomial, t: ca.SX, t0: float, ratio: bool) -> None:
    """Constrain a polynomial to be a product of factors with the margin t."""
    now = trim(now)
    p = p[: len(now)]
    shifted = p if ratio else shift(p, -t)
    start = np.array(now if ratio else shift(now, -t0), dtype=float)
    factors = [_quadratic(program, f"{name}.{k}", p_, q_, t, ratio) for k, (p_, q_) in enumerate(_pairs(start))]
    if len(now) % 2 == 0:
        real = -float(_reals(start)[0])
        factors.append((program.variable(f"{name}.r", real, 0.0, np.inf, scale=max(real, 1e-2)), 1))
    for k, (whole, parts) in enumerate(zip(shifted[:-1], product(factors)[:-1], strict=True)):
        size = max(abs(start[k] / start[-1]), 1e-12 * np.max(np.abs(start / start[-1])))
        program.constrain((whole / shifted[-1] - parts) / size, 0.0, 0.0)


def _quadratic(program: _Program, name: str, p: float, q: float, t: ca.SX, ratio: bool) -> Polynomial:
    width = float(np.sqrt(abs(q)))
    damping = program.variable(name + ".p", p, 0.0, np.inf, scale=max(abs(p), 0.1 * width, 1e-3))
    stiffness = program.variable(name + ".q", q, 0.0, np.inf, scale=max(abs(q), 1e-6))
    if ratio:
        scale = 4 * max(abs(q), 1e-6)
        program.constrain((damping**2 - 4 * t**2 * stiffness) / scale, 0.0, np.inf)
    return (stiffness, damping, 1)


def _reals(start: Float) -> Float:
    s = roots(tuple(start))
    return np.sort(s.real[s.imag == 0])


def _pairs(start: Float) -> list[tuple[float, float]]:
    """Return (p, q) of each conjugate pair, and of the real roots two by two, the slowest of an odd number left out."""
    s = roots(tuple(start))
    pairs = [(-2 * x.real, abs(x) ** 2) for x in s[s.imag > 0]]
    reals = _reals(start)
    reals = reals[1:] if len(reals) % 2 else reals
    pairs += [(-(a + b), a * b) for a, b in zip(reals[::2], reals[1::2], strict=True)]
    return [(float(p), float(q)) for p, q in pairs]

"""The NLP that IPOPT solves: the largest margin, with the polynomial as a product of quadratics.

The polynomial, shifted by the margin t, is set equal to a product of quadratics s^2 + p s + q (and one linear factor
if its degree is odd) whose coefficients are variables beside the design; p >= 0 and q >= 0 say that all roots decay
faster than t. For a damping ratio the polynomial is not shifted and p^2 >= 4 t^2 q. Unlike single roots, the factors
stay smooth functions of the design where two roots coalesce or three modes tie, as they do at the best designs.

The sizes by which variables and constraints are scaled belong to the start, and are parameters: one NLP serves all
starts whose polynomials have the same degrees.
"""

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from yawdesign.damper.curving import resistance_scale, resisting_moment
from yawdesign.damper.design_space import Space, Values, between, fraction, scale
from yawdesign.hunting.arrays import Float
from yawdesign.hunting.eigenvalues import roots
from yawdesign.hunting.many.measure import FASTEST
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.polynomials import Polynomial, product, scale_variable, shift, trim

OPTIONS: Mapping[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.max_iter": 60,  # those that succeed need 5 to 40
    "ipopt.tol": 1e-9,
    # IPOPT relaxes bounds by 1e-8. At a double root a curve's limit exceeded by that, and kept again afterwards, moves
    # the root by the square root of it.
    "ipopt.bound_relax_factor": 0.0,
    "error_on_fail": False,
    "show_eval_warnings": False,
}

# From a kink IPOPT must not be pushed far inside first, from a slope it must: no one setting serves all starts.
PUSHES: tuple[Mapping[str, Any], ...] = (
    {},
    {"ipopt.mu_init": 1e-4, "ipopt.bound_push": 1e-6, "ipopt.bound_frac": 1e-6},
    {"ipopt.mu_init": 1e-6, "ipopt.bound_push": 1e-8, "ipopt.bound_frac": 1e-8, "ipopt.slack_bound_push": 1e-8},
)
DERIVATIVES = {"hess_lag": "nlp_hess_l", "jac_g": "nlp_jac_g", "grad_f": "nlp_grad_f"}
MOST_ROUNDS = 4  # in which conditions are added


class Improver:
    """IPOPT, from any start in a design space.

    Parameters
    ----------
    space : Space
        The design space.
    options : mapping
        CasADi `nlpsol` options; they take the place of the defaults.
    """

    def __init__(self, space: Space, options: Mapping[str, Any]) -> None:
        self.space = space
        self.options = options
        self._known: dict[Any, _Program] = {}

    def improve(self, x: Float, margin: float) -> list[Float]:
        """Return the points that IPOPT reaches from a point of the cube; some may be worse: look at them.

        The NLP knows the condition that is the worst at the start, and then those that are the worst where it ends.

        Parameters
        ----------
        x : ndarray, shape (variables,)
            Start.
        margin : float
            Margin there.
        """
        start = {name: float(np.squeeze(value)) for name, value in self.space.values(x).items()}
        known = self._worst(x[:, None])
        reached: list[Float] = []
        for _ in range(MOST_ROUNDS):
            found = self._solved(start, margin, sorted(known))
            reached += found
            worst = self._worst(np.stack(found, axis=1)) if found else set()
            if worst <= known:
                break
            known |= worst
        return reached

    def _worst(self, x: Float) -> set[int]:
        """Return which conditions are the worst at some points of the cube, by their numbers."""
        return {int(k) for k in self.space.under_each(self.space.values(x)).argmin(axis=0)}

    def _solved(self, start: Values, margin: float, known: Sequence[int]) -> list[Float]:
        stiff = {K: np.inf for c, K in self.space.model.joints.items() if start[c] * FASTEST < start[K]}
        now = [p for k in known for p in _polynomials(self.space, start | stiff, self.space.conditions[k])]
        now = [trim(p) for p in now]
        structure = tuple(known), tuple(stiff), tuple(len(p) - 1 for p in now)
        if structure not in self._known:
            conditions = [self.space.conditions[k] for k in known]
            self._known[structure] = _Program(self.space, conditions, stiff, structure[2], self.options)
        places = self._known[structure].solve(start, now, margin)
        return [_in_cube(self.space, place) for place in places if np.all(np.isfinite(place))]


def _in_cube(space: Space, places: Float) -> Float:
    """Return the point of the cube that belongs to fractions between the bounds as written."""
    pairs = zip(space.names, places, strict=True)
    values = {name: between(*space.bounds(name), place, scale(name)) for name, place in pairs}
    return space.coordinates({name: float(value) for name, value in values.items()})


def _polynomials(space: Space, values: Values, condition: Condition) -> list[Polynomial]:
    """Return the polynomials that count in the margin, in s / (100 rad/s)."""
    vehicle, movable = space.model.at(condition.applied(values)), space.model.movable(space.names)
    chosen = (motion for motion in vehicle.motions if motion.name in movable)
    return [scale_variable(motion.polynomial(vehicle.C_s), TIME_UNIT) for motion in chosen]


class _Constraint(NamedTuple):
    expression: Any
    low: float = 0.0
    high: float = 0.0


class _Program:
    """The NLP of some conditions, for all starts whose polynomials have the same degrees.

    Its variables are the margin, the fractions between the bounds as written, and of every polynomial the p and then
    the q of all quadratics, and the linear factor's root if there is one.

    Parameters
    ----------
    space : Space
        The design space.
    conditions : sequence of Condition
        Under which the margin is to be large.
    stiff : mapping
        Stiffnesses that are infinite: those of rigid joints.
    degrees : sequence of int
        Those of the polynomials.
    options : mapping
        Of the solver.
    """

    def __init__(
        self,
        space: Space,
        conditions: Sequence[Condition],
        stiff: Values,
        degrees: Sequence[int],
        options: Mapping[str, Any],
    ) -> None:
        self.space = space
        self.options = options
        self.ratio = space.objective == "damping_ratio"
        own = 1 + len(space.names)
        self._x = ca.SX.sym("x", own + sum(degrees))
        self._scale = ca.SX.sym("scale", self._x.numel())
        t, *others = ca.vertsplit(self._x * self._scale)
        values = space.fixed | {
            name: between_sx(*space.bounds(name), place, scale(name))
            for name, place in zip(space.names, others, strict=False)
        }
        self._objective = -t
        self._constraints = [_Constraint(excess, low=-np.inf) for excess in self._excess(values)]
        polynomials = [p for condition in conditions for p in _polynomials(space, values | stiff, condition)]
        first = own - 1
        for p, n in zip(polynomials, degrees, strict=True):
            self._constraints += _factorised(p[: n + 1], others[first : first + n], t, self.ratio)
            first += n
        self._size = ca.SX.sym("size", len(self._constraints))

    def _excess(self, values: Values) -> list[Any]:
        """Return by how much the moment exceeds what the curve allows, under each load."""
        curve = self.space.curve
        if curve is None:
            return []
        loads = [load.applied(values) for load in self.space.loads]
        return [resisting_moment(p, p["C_s"], curve) - curve.limit * resistance_scale(p, curve) for p in loads]

    @cached_property
    def _solvers(self) -> list[ca.Function]:
        """One for each of `PUSHES`; they share their derivatives, which take longest to make."""
        g = ca.vertcat(*(c.expression for c in self._constraints)) / self._size
        nlp = {"x": self._x, "p": ca.vertcat(self._scale, self._size), "f": self._objective, "g": g}
        solvers: list[ca.Function] = []
        for push in PUSHES:
            shared = {key: solvers[0].get_function(name) for key, name in DERIVATIVES.items()} if solvers else {}
            solvers.append(ca.nlpsol("margin", "ipopt", nlp, {**OPTIONS, **push, **shared, **self.options}))
        return solvers

    def solve(self, start: Values, now: Sequence[Polynomial], margin: float) -> list[Float]:
        """Return the fractions between the bounds that each of `PUSHES` reaches.

        Parameters
        ----------
        start : mapping
            Parameters at the start.
        now : sequence of tuple
            The polynomials there, in s / (100 rad/s), of the program's degrees.
        margin : float
            The margin there.
        """
        unit = 1.0 if self.ratio else TIME_UNIT
        t = margin / unit - 1e-6 * abs(margin / unit)
        names = self.space.names
        places = [fraction(*self.space.bounds(name), start[name], scale(name)) for name in names]
        factors = [_Factors.of(p if self.ratio else shift(p, -t), self.ratio) for p in now]
        guess = np.concatenate([[t], places, *(f.guess for f in factors)])
        size = np.concatenate([[max(abs(t), 1e-3)], np.ones(len(names)), *(f.scale for f in factors)])
        low = np.concatenate([[-np.inf], np.zeros(len(guess) - 1)])
        most = [0.999 if self.ratio else np.inf]
        high = np.concatenate([most, np.ones(len(names)), np.full(len(guess) - 1 - len(names), np.inf)])
        arguments = {
            "x0": guess / size,
            "p": np.concatenate([size, self._allowed(start), *(f.sizes for f in factors)]),
            "lbx": low / size,
            "ubx": high / size,
            "lbg": [c.low for c in self._constraints],
            "ubg": [c.high for c in self._constraints],
        }
        found = [np.array(solver(**arguments)["x"]).ravel() for solver in self._solvers]
        return [np.clip(x[1 : 1 + len(names)], 0, 1) for x in found]

    def _allowed(self, start: Values) -> list[float]:
        curve = self.space.curve
        return (
            [] if curve is None else [curve.limit * resistance_scale(x.applied(start), curve) for x in self.space.loads]
        )


def between_sx(low: float, high: float, x: ca.SX, size: float) -> ca.SX:
    """Return `between` for a symbol."""
    grown: ca.SX = (low + size) * (ca.exp(np.log1p((high - low) / (low + size)) * x) - 1)
    return low + grown


def _factorised(p: Polynomial, unknown: Sequence[ca.SX], t: ca.SX, ratio: bool) -> list[_Constraint]:
    """Constrain a polynomial to be a product of factors with the margin t."""
    pairs = len(unknown) // 2
    damping, stiffness, real = unknown[:pairs], unknown[pairs : 2 * pairs], unknown[2 * pairs :]
    factors: list[Polynomial] = [(q, d, 1) for d, q in zip(damping, stiffness, strict=True)]
    factors += [(r, 1) for r in real]
    shifted = p if ratio else shift(p, -t)
    steep = [d**2 - 4 * t**2 * q for d, q in zip(damping, stiffness, strict=True)] if ratio else []
    equal = [whole / shifted[-1] - parts for whole, parts in zip(shifted[:-1], product(factors)[:-1], strict=True)]
    return [*(_Constraint(x, high=np.inf) for x in steep), *(_Constraint(x) for x in equal)]


class _Factors(NamedTuple):
    """The factors of a polynomial of numbers: p and q of all quadratics and the root of the linear factor.

    Also their scales, and the sizes of the constraints.
    """

    guess: Float
    scale: Float
    sizes: Float

    @classmethod
    def of(cls, polynomial: Polynomial, ratio: bool) -> "_Factors":
        s = roots(polynomial)
        reals = np.sort(s.real[s.imag == 0])
        single, reals = np.split(reals, [len(reals) % 2])
        upper = s[s.imag > 0]
        p = np.concatenate([-2 * upper.real, -(reals[::2] + reals[1::2])])
        q = np.concatenate([np.abs(upper) ** 2, reals[::2] * reals[1::2]])
        scale_q = np.maximum(np.abs(q), 1e-6)
        scale_p = np.maximum(np.maximum(np.abs(p), 0.1 * np.sqrt(np.abs(q))), 1e-3)
        coefficients = np.abs(np.array(polynomial[:-1], dtype=float) / polynomial[-1])
        coefficients = np.maximum(coefficients, 1e-12 * np.max(coefficients, initial=1.0))
        return cls(
            np.concatenate([p, q, -single]),
            np.concatenate([scale_p, scale_q, np.maximum(-single, 1e-2)]),
            np.concatenate([4 * scale_q if ratio else [], coefficients]),
        )

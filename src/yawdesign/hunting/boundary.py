"""The stability boundary as CasADi expression graphs, solved by a CasADi rootfinder.

Every graph comes from the same generic code as the numbers do, fed with SX symbols.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.hurwitz import hurwitz_minors as generic_minors
from yawdesign.hunting.hurwitz import require_paper_bogie
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.hunting.routh import routh_column as generic_column
from yawdesign.vehicle.polynomials import Polynomial, evaluate, scale_variable
from yawdesign.vehicle.vehicle import Model, Vehicle

Names = tuple[str, ...]

NEAR = 1e-8  # how far the rootfinder may move a guess that is known to eight digits; farther lies another root


def _symbols(names: Names) -> tuple[ca.SX, dict[str, ca.SX]]:
    vector = ca.SX.sym("p", len(names))
    return vector, {name: vector[i] for i, name in enumerate(names)}


def parameter_names(p: Iterable[str]) -> Names:
    """Return the names that make up the parameter vector of the graphs: all but C_s."""
    return tuple(name for name in p if name != "C_s")


@lru_cache
def routh_column(model: Model, names: Names) -> ca.Function:
    """Return Routh's column of the coupled motion as a CasADi Function of the parameter vector and C_s.

    The polynomial is taken in s / (100 rad/s); the signs of the entries decide.
    """
    p, values = _symbols(names)
    C_s = ca.SX.sym("C_s")
    core = scale_variable(model.at(values).coupled.polynomial(C_s), TIME_UNIT)
    return ca.Function("routh_column", [p, C_s], [ca.vertcat(*generic_column(core))], ["p", "C_s"], ["column"])


@lru_cache
def hurwitz_minors(model: Model, names: Names) -> ca.Function:
    """Return sign and log10 of Delta_1 ... Delta_26 (16 without motors) as a CasADi Function of p and C_s."""
    require_paper_bogie(model)
    p, values = _symbols(names)
    C_s = ca.SX.sym("C_s")
    chi = model.at(values, C_s=C_s).paper_coefficients(TIME_UNIT)
    signs, logarithms = generic_minors(chi, functions=ca)
    outputs = [ca.vertcat(*signs), ca.vertcat(*logarithms)]
    return ca.Function("hurwitz_minors", [p, C_s], outputs, ["p", "C_s"], ["sign", "log10"])


@lru_cache
def boundary(model: Model, names: Names) -> ca.Function:
    """Return the equations of the stability boundary, scaled to order one.

    Inputs: ``z`` = (ln C_s, omega / 100), ``p``; output: real and imaginary part of A(j w) + C_s B(j w), divided by
    the sum of the coefficients' magnitudes times powers of w.
    """
    p, values = _symbols(names)
    z = ca.SX.sym("z", 2)
    core = scale_variable(model.at(values).coupled.polynomial(ca.exp(z[0])), TIME_UNIT)
    real, imaginary = _on_axis(core, z[1])
    size = evaluate(core, z[1])
    return ca.Function("boundary", [z, p], [ca.vertcat(real, imaginary) / size], ["z", "p"], ["g"])


def _on_axis(p: Polynomial, omega: ca.SX) -> tuple[ca.SX, ca.SX]:
    signed = [(1, 1, -1, -1)[k % 4] * a for k, a in enumerate(p)]
    real = [a if k % 2 == 0 else 0 for k, a in enumerate(signed)]
    imaginary = [a if k % 2 else 0 for k, a in enumerate(signed)]
    return evaluate(tuple(real), omega), evaluate(tuple(imaginary), omega)


@lru_cache
def boundary_slope(model: Model, names: Names) -> ca.Function:
    """Return d ln C_s / d p along the boundary by the implicit function theorem: (z, p) -> slope.

    One reverse sweep with l from J' l = (1, 0), where J = d g / d z. By Cramer's rule, so that a singular J gives
    numbers that are not finite; a linear solver would end the evaluation.
    """
    z, p = ca.SX.sym("z", 2), ca.SX.sym("p", len(names))
    g = boundary(model, names)(z, p)
    J = ca.jacobian(g, z)
    weights = ca.vertcat(J[1, 1], -J[0, 1]) / (J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0])
    return ca.Function("boundary_slope", [z, p], [-ca.jtimes(g, p, weights, True)], ["z", "p"], ["slope"])


@lru_cache
def rootfinder(model: Model, names: Names, method: str = "newton") -> ca.Function:
    """Return the rootfinder of `boundary`: (z0, p) -> z. Of CasADi's methods only fast_newton becomes C code."""
    g = boundary(model, names)
    z, p = ca.SX.sym("z", 2), ca.SX.sym("p", len(names))
    problem = {"x": z, "p": p, "g": g(z, p)}
    return ca.rootfinder("critical", method, problem, {"abstol": 1e-14, "max_iter": 50, "error_on_fail": False})


@lru_cache
def critical_damping(model: Model, names: Names) -> ca.Function:
    """Return a critical value and its derivatives as a CasADi Function.

    Returns
    -------
    casadi.Function
        Inputs: ``p`` (parameters in the order of names), ``C_s`` [N s/m] and ``omega`` [rad/s], a guess. Outputs:
        ``C_s``, ``omega``, ``residual`` (of the scaled boundary equations; the rootfinder itself reports success
        too easily), ``gradient`` of C_s with respect to p and ``hessian``, both by implicit differentiation.
    """
    p, start, omega = ca.MX.sym("p", len(names)), ca.MX.sym("C_s"), ca.MX.sym("omega")
    z = rootfinder(model, names)(ca.vertcat(ca.log(start), omega / TIME_UNIT), p)
    C_s = ca.exp(z[0])
    residual = ca.norm_2(boundary(model, names)(z, p))  # norm_inf of NaN is 0
    hessian, gradient = ca.hessian(C_s, p)
    outputs = [C_s, z[1] * TIME_UNIT, residual, gradient, hessian]
    labels = ["C_s_critical", "omega_critical", "residual", "gradient", "hessian"]
    return ca.Function("critical_damping", [p, start, omega], outputs, ["p", "C_s", "omega"], labels)


def polish(vehicle: Vehicle, guesses: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return (C_s, omega) of each guess after the rootfinder; a guess that it leads astray is kept as it is."""
    names = parameter_names(vehicle.p)
    solve, vector = rootfinder(vehicle.model, names), np.array([vehicle.p[name] for name in names])
    return [_polish(solve, vector, C_s, omega) for C_s, omega in guesses]


def _polish(solve: ca.Function, p: NDArray[np.float64], C_s: float, omega: float) -> tuple[float, float]:
    start = np.array([np.log(C_s), omega / TIME_UNIT])
    z = np.array(solve(start, p)).ravel()
    moved = np.abs(z - start)
    near = np.all(np.isfinite(z)) and np.all(moved < NEAR * np.maximum(1, np.abs(start)))
    return (float(np.exp(z[0])), float(z[1] * TIME_UNIT)) if near else (C_s, omega)

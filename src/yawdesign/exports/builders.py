"""The functions for other codes, one builder each: the code that numbers use too, with symbols in their place."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from yawdesign.damper.curving import LOADS, curving_limit, resisting_moment, rotational_resistance
from yawdesign.exports.parametric_model import ParametricModel
from yawdesign.exports.state_space import exported_outputs, matrices
from yawdesign.exports.symbolic_function import SymbolicFunction, described, per
from yawdesign.hunting.boundary import boundary, boundary_slope, rootfinder
from yawdesign.hunting.eigenvalues import motion_eigenvalues
from yawdesign.hunting.hurwitz import hurwitz_minors as generic_minors
from yawdesign.hunting.routh import TIME_UNIT, sector_column
from yawdesign.hunting.routh import routh_column as generic_column
from yawdesign.problem import ProblemError
from yawdesign.problem.running import CURVE
from yawdesign.vehicle.elements import Dashpot, Law, Mass, Maxwell
from yawdesign.vehicle.polynomials import Polynomial, product, scale_variable, shift, trim
from yawdesign.vehicle.vehicle import Vehicle

IN_SCALE = "in s / (100 rad/s)"
NOWHERE = 1e5, 20.0  # N s/m, rad/s: where a bogie has no critical value, any start is as good


def _core(vehicle: Vehicle) -> Polynomial:
    """Return the coupled motion's polynomial in s / (100 rad/s), without known zeros."""
    return _trimmed(scale_variable(vehicle.coupled.polynomial(vehicle.C_s), TIME_UNIT))


def _trimmed(p: Polynomial) -> Polynomial:
    """Return a polynomial without the highest powers that a damper without damping leaves out."""
    return trim(p, lambda a: bool(a.is_zero() if isinstance(a, ca.SX) else a == 0))


def _core_unit(vehicle: Vehicle) -> str:
    """Return the unit of the coupled motion's coefficients, those of a determinant of stiffnesses."""
    units = [e.unit for e in vehicle.folded if isinstance(e, Mass) and e.coordinate in vehicle.coupled.coordinates]
    return f"(N/m)^{units.count('m')}·(N·m)^{units.count('rad')}"


def state_matrix(f: SymbolicFunction) -> None:
    """Linear model x' = A x + B u, y = C x + D u: coordinates, velocities and damper strokes, moved by the track."""
    system = f.vehicle().state_space
    outputs = exported_outputs(system)
    rates = [per(unit, "s") for unit in system.state_units]
    output_units = [system.unit_of(name) for name in outputs]
    for name, matrix in matrices(system, outputs).items():
        rows, row_units = (system.states, rates) if name in "AB" else (outputs, output_units)
        columns, over = (system.states, system.state_units) if name in "AC" else (system.inputs, system.input_units)
        units = tuple(per(one, two) for two in over for one in row_units)
        f.output(name, "SI", f"matrix {name}", matrix, rows=rows, columns=columns, units=units)


def characteristic_polynomial(f: SymbolicFunction) -> None:
    """Characteristic polynomial: of the coupled motion, scaled, and the paper's eq. (9) as sign and logarithm."""
    vehicle = f.vehicle()
    core = scale_variable(vehicle.coupled.polynomial(vehicle.C_s), TIME_UNIT)
    parts = {"ABC"[k]: scale_variable(part, TIME_UNIT) for k, part in enumerate(vehicle.coupled.coefficients)}
    unit, whole = _core_unit(vehicle), " + ".join(["A", "C_s B", "C_s^2 C"][: len(parts)])
    f.output("core", unit, f"coefficients of {whole} {IN_SCALE}, lowest power first", core)
    for name, part in parts.items():
        f.output(name, unit, f"coefficients of {name} {IN_SCALE}, lowest power first", part)
        unit = per(unit, "N·s/m")
    chi = _whole_polynomial(f.parametric, vehicle)
    unscale = [(len(chi) - 1 - i) * math.log10(TIME_UNIT) for i in range(len(chi))]
    logarithms = [ca.log10(ca.fabs(x)) - y for x, y in zip(chi, unscale, strict=True)]
    if f.parametric.as_in_the_paper:
        f.output("chi_sign", "-", "signs of chi_0, chi_1, ... of eq. (9), highest power first", [*map(ca.sign, chi)])
        f.output("chi_log10", "-", "log10 |chi_0|, log10 |chi_1|, ... of eq. (9) in SI units", logarithms)
        return
    f.meaning = "Characteristic polynomial: of the coupled motion, scaled, and of all motions as sign and logarithm."
    f.output("whole_sign", "-", "signs of the coefficients of all motions, highest power first", [*map(ca.sign, chi)])
    f.output("whole_log10", "-", "log10 of the magnitudes of these coefficients in SI units", logarithms)


def _whole_polynomial(parametric: ParametricModel, vehicle: Vehicle) -> Polynomial:
    """Return the polynomial of all motions in s / (100 rad/s), highest power first: of the paper's bogie eq. (9)."""
    if parametric.as_in_the_paper:
        return vehicle.paper_coefficients(TIME_UNIT)
    return tuple(reversed(scale_variable(vehicle.polynomial, TIME_UNIT)))


def routh_column(f: SymbolicFunction) -> None:
    """First column of Routh's array of the coupled motion: stable exactly if all entries are positive."""
    vehicle = f.vehicle()
    core, unit = _core(vehicle), _core_unit(vehicle)
    f.output("column", unit, f"first column of Routh's array {IN_SCALE}", generic_column(core))


def hurwitz_minors(f: SymbolicFunction) -> None:
    """Hurwitz minors of eq. (10): stable if all signs are +1, but for roots on the axis, which rounding hides."""
    chi = _whole_polynomial(f.parametric, f.vehicle())
    if not f.parametric.as_in_the_paper:
        f.meaning = "Hurwitz minors of the polynomial of all motions: stable if all signs are +1, but for roots on the "
        f.meaning += "axis, which rounding hides."
    signs, logarithms = generic_minors(tuple(reversed(_trimmed(tuple(reversed(chi))))), functions=ca)
    f.output("sign", "-", "signs of Delta_1, Delta_2, ...", signs)
    f.output("log10", "-", "log10 |Delta_1|, log10 |Delta_2|, ... in SI units", logarithms)


def critical_damping(f: SymbolicFunction) -> None:
    """Critical yaw damping that Newton's method reaches from a start, with its gradient. Check the residual."""
    model, names = f.parametric.model, f.parametric.names
    values = f.parameters(names)
    p = ca.vertcat(*values.values())
    C_s, omega = _start_of_critical_damping(f.parametric)
    C_s_start = f.input("C_s_start", "N·s/m", "start of C_sl, positive", C_s)
    omega_start = f.input("omega_start", "rad/s", "start of omega, positive", omega)
    solve = rootfinder(model, names, method="fast_newton")
    z = solve(ca.vertcat(ca.log(C_s_start), omega_start / TIME_UNIT), p)
    C_sl = ca.exp(z[0])
    residual = ca.norm_2(boundary(model, names)(z, p))
    places = [k for k, name in enumerate(names) if name in f.parametric.free]
    gradient = C_sl * boundary_slope(model, names)(z, p)[places]
    f.output("C_sl", "N·s/m", "critical damping of the pair of yaw dampers", C_sl)
    f.output("omega", "rad/s", "angular frequency of the motion at the boundary", ca.fabs(z[1]) * TIME_UNIT)
    f.output("residual", "-", "a solution only if this is below 1e-10; NaN is none", residual)
    about = "derivative of C_sl with respect to each parameter"
    rows = tuple(names[k] for k in places)
    units = tuple(per("N·s/m", described(name)[0]) for name in rows)
    f.output("gradient", "SI", about, gradient, rows=rows, units=units)


def _start_of_critical_damping(parametric: ParametricModel) -> tuple[float, float]:
    """Return (C_s [N s/m], omega [rad/s]) near the least critical value of the problem's bogie."""
    found = parametric.critical
    return (1.02 * found[0].C_s, 0.99 * found[0].omega) if found else NOWHERE


def critical_equations(f: SymbolicFunction) -> None:
    """Equations of the stability boundary: both are zero where C_sl is critical and omega its frequency."""
    model, names = f.parametric.model, f.parametric.names
    p = ca.vertcat(*f.parameters(names).values())
    start = _start_of_critical_damping(f.parametric)
    C_sl = f.input("C_sl", "N·s/m", "damping of the pair of yaw dampers, positive", start[0])
    omega = f.input("omega", "rad/s", "angular frequency of the motion", start[1])
    residual = boundary(model, names)(ca.vertcat(ca.log(C_sl), omega / TIME_UNIT), p)
    f.output("residual", "-", "real and imaginary part of the polynomial at j omega, of order one", residual)


def rotational_resistance_function(f: SymbolicFunction) -> None:
    """Rotational resistance in the curve, eq. (13), and the damping that the curve allows, eq. (14)."""
    if f.parametric.load is None:
        raise ProblemError("rotational_resistance needs a curve, and the problem has none")
    if not f.parametric.resists:
        raise ProblemError("rotational_resistance is T / (4 Q a), and the axle load W is 0: let it be an input")
    p = f.parameters(("W", "a", "b_0", "b_2", "b_3", "K_2x", "C_t", "C_s"))
    curve: Any = SimpleNamespace(**f.parameters(tuple(CURVE)), load=f.parametric.load)
    load = LOADS[f.parametric.load]
    f.output("X", "-", f"rotational resistance T / (4 Q a), {load}", rotational_resistance(p, p["C_s"], curve))
    f.output("T", "N·m", "moment that resists the rotation", resisting_moment(p, p["C_s"], curve))
    f.output("C_su", "N·s/m", "C_s at which T / (4 Q a) reaches the limit", curving_limit(p, curve))


def stability_margin(f: SymbolicFunction) -> None:
    """Chains that are positive exactly if every coupled mode has more than a given decay rate or damping ratio."""
    vehicle = f.vehicle()
    core, unit = _core(vehicle), _core_unit(vehicle)
    sigma = f.input("sigma", "1/s", "decay rate", 0.5)
    zeta = f.input("zeta", "-", "damping ratio, 0 <= zeta < 1", 0.01)
    f.output("decay_column", unit, "all positive: decay rates > sigma", generic_column(_shifted(core, sigma)))
    f.output("ratio_column", unit, "all positive: damping ratios > zeta", sector_column(core, zeta, functions=ca))


def margin_equations(f: SymbolicFunction) -> None:
    """Equations of an NLP for the largest margin: the polynomial, shifted by sigma, as a product of quadratics."""
    core = _core(f.vehicle())
    sigma = f.input("sigma", "1/s", "decay rate by which the polynomial is shifted; 0 for a damping ratio", 0.1)
    zeta = f.input("zeta", "-", "damping ratio; 0 for a decay rate", 0.01)
    start = _quadratic_factors(f.parametric)
    p = f.input("quadratic_p", "-", f"p of the factors s^2 + p s + q {IN_SCALE}", *start.p)
    q = f.input("quadratic_q", "-", f"q of the factors s^2 + p s + q {IN_SCALE}", *start.q)
    factors: list[Polynomial] = [(q[k], p[k], 1) for k in range(len(start.p))]
    if start.r:
        factors.append((f.input("linear_r", "-", f"r of the factor s + r {IN_SCALE}", *start.r), 1))
    whole = _shifted(core, sigma)
    residual = [a / whole[-1] - b for a, b in zip(whole[:-1], product(factors)[:-1], strict=True)]
    f.output("residual", "-", "coefficients of the monic polynomial minus those of the product", residual)
    f.output("sector", "-", "p^2 - 4 zeta^2 q: not negative where the ratio exceeds zeta", p**2 - 4 * zeta**2 * q)


@dataclass(frozen=True)
class Factors:
    """Quadratic factors s^2 + p s + q and, if the degree is odd, a linear one s + r, in s / (100 rad/s)."""

    p: tuple[float, ...]
    q: tuple[float, ...]
    r: tuple[float, ...]


def _quadratic_factors(parametric: ParametricModel) -> Factors:
    """Return the factors of the coupled motion's polynomial with the problem's values."""
    vehicle = parametric.example
    s = motion_eigenvalues(vehicle, vehicle.coupled) / TIME_UNIT
    upper, real = s[s.imag > 0], np.sort(s.real[s.imag == 0])[::-1]
    odd, real = (real[:1], real[1:]) if len(real) % 2 else (real[:0], real)
    p = [*(-2 * upper.real), *(-(real[::2] + real[1::2]))]
    q = [*(np.abs(upper) ** 2), *(real[::2] * real[1::2])]
    return Factors(tuple(map(float, p)), tuple(map(float, q)), tuple(float(-x) for x in odd))


def _shifted(core: Polynomial, sigma: Any) -> Polynomial:
    return shift(core, -sigma / TIME_UNIT)


def dynamic_stiffness(f: SymbolicFunction) -> None:
    """Dynamic stiffness Z(j omega) of the pair of yaw dampers with their joints, force over displacement."""
    p = f.parameters([name for name in ("K_ds", "C_s") if name in f.parametric.values])
    omega = f.input("omega", "rad/s", "angular frequency", 20.0)
    law: Law = Maxwell(p["K_ds"], p["C_s"]) if "K_ds" in p else Dashpot(p["C_s"])
    (_, c), (_, lag) = law.numerator, (*law.denominator, 0)[:2]
    real = c * omega * lag * omega / (1 + (lag * omega) ** 2)
    imaginary = c * omega / (1 + (lag * omega) ** 2)
    f.output("Z_re", "N/m", "real part of Z, the storage stiffness", real)
    f.output("Z_im", "N/m", "imaginary part of Z, the loss stiffness", imaginary)
    f.output("K_dyn", "N/m", "magnitude of Z", c * omega / ca.sqrt(1 + (lag * omega) ** 2))
    f.output("phase", "rad", "phase of Z", math.pi / 2 - ca.atan(lag * omega))


BUILDERS: Mapping[str, Callable[[SymbolicFunction], None]] = {
    "state_matrix": state_matrix,
    "characteristic_polynomial": characteristic_polynomial,
    "routh_column": routh_column,
    "hurwitz_minors": hurwitz_minors,
    "critical_damping": critical_damping,
    "critical_equations": critical_equations,
    "rotational_resistance": rotational_resistance_function,
    "stability_margin": stability_margin,
    "margin_equations": margin_equations,
    "dynamic_stiffness": dynamic_stiffness,
}

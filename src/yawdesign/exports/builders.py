"""The functions for other codes, one builder each: the generic code of the rooms before, fed with symbols."""

import math
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import casadi as ca

from yawdesign.damper.curving import LOADS, curving_limit, resisting_moment, rotational_resistance
from yawdesign.exports.ports import Draft, described, per
from yawdesign.exports.starts import quadratic_factors, start_of_critical_damping
from yawdesign.exports.states import state_names, state_space_matrices
from yawdesign.hunting.hurwitz import hurwitz_minors as generic_minors
from yawdesign.hunting.old import boundary as graphs
from yawdesign.hunting.routh import TIME_UNIT, sector_column
from yawdesign.hunting.routh import routh_column as generic_column
from yawdesign.problem import ProblemError
from yawdesign.problem.running import CURVE
from yawdesign.vehicle.elements import Mass, Maxwell
from yawdesign.vehicle.old import Characteristic, bogie, characteristic, folded, paper_coefficients
from yawdesign.vehicle.polynomials import Polynomial, product, scale_variable, shift, trim

IN_SCALE = "in s / (100 rad/s)"


def _all(draft: Draft) -> tuple[dict[str, Any], Any]:
    p = draft.parameters((*draft.setting.bogie, "C_s"))
    return p, p.pop("C_s")


def _core(draft: Draft) -> tuple[Polynomial, str]:
    """Return the coupled motion's polynomial in s / (100 rad/s), without known zeros, and its coefficients' unit."""
    p, C_s = _all(draft)
    c = characteristic(p, **draft.setting.model)
    core = scale_variable(c.core(C_s), TIME_UNIT)
    return _trimmed(core), _unit(c, p, draft)


def _unit(c: Characteristic, p: Mapping[str, Any], draft: Draft) -> str:
    """Return the unit of the coupled motion's coefficients, those of a determinant of stiffnesses."""
    elements = folded(bogie({**p, "C_s": 0}, **draft.setting.model))
    coordinates = [e.coordinate for e in elements if isinstance(e, Mass)]
    yaw = sum(x.startswith("phi") for x in coordinates)
    # A factor is the yaw of the motors, one coordinate.
    return f"(N/m)^{len(coordinates) - yaw}·(N·m)^{yaw - len(c.factors)}"


def _trimmed(p: Polynomial) -> Polynomial:
    """Return a polynomial without the highest powers that a damper without damping leaves out."""
    return trim(p, lambda a: bool(a.is_zero() if isinstance(a, ca.SX) else a == 0))


def state_matrix(draft: Draft) -> None:
    """Linear model x' = A x + B u, y = C x + D u: coordinates, velocities and damper strokes, moved by the track."""
    p, C_s = _all(draft)
    names = state_names(p, C_s, draft.setting.model)
    for name, matrix in state_space_matrices(p, C_s, draft.setting.model).items():
        rows = names.states if name in "AB" else names.outputs
        columns = names.states if name in "AC" else names.inputs
        rates = [per(unit, "s") for unit in names.state_units]
        over = names.state_units if name in "AC" else names.input_units
        units = tuple(per(one, two) for two in over for one in (rates if name in "AB" else names.output_units))
        draft.output(name, "SI", f"matrix {name}", matrix, rows=rows, columns=columns, units=units)


def characteristic_polynomial(draft: Draft) -> None:
    """Characteristic polynomial: of the coupled motion, scaled, and the paper's eq. (9) as sign and logarithm."""
    p, C_s = _all(draft)
    c = characteristic(p, **draft.setting.model)
    A, B = (scale_variable(part, TIME_UNIT) for part in (c.A, c.B))
    core = scale_variable(c.core(C_s), TIME_UNIT)
    unit = _unit(c, p, draft)
    draft.output("core", unit, f"coefficients of A + C_s B {IN_SCALE}, lowest power first", core)
    draft.output("A", unit, f"coefficients of A {IN_SCALE}, lowest power first", A)
    draft.output("B", per(unit, "N·s/m"), f"coefficients of B {IN_SCALE}, lowest power first", B)
    chi = paper_coefficients(p, C_s, **draft.setting.model, unit=TIME_UNIT)
    unscale = [(len(chi) - 1 - i) * math.log10(TIME_UNIT) for i in range(len(chi))]
    logarithms = [ca.log10(ca.fabs(x)) - y for x, y in zip(chi, unscale, strict=True)]
    draft.output("chi_sign", "-", "signs of chi_0, chi_1, ... of eq. (9), highest power first", [*map(ca.sign, chi)])
    draft.output("chi_log10", "-", "log10 |chi_0|, log10 |chi_1|, ... of eq. (9) in SI units", logarithms)


def routh_column(draft: Draft) -> None:
    """First column of Routh's array of the coupled motion: stable exactly if all entries are positive."""
    core, unit = _core(draft)
    draft.output("column", unit, f"first column of Routh's array {IN_SCALE}", generic_column(core))


def hurwitz_minors(draft: Draft) -> None:
    """Hurwitz minors of eq. (10): stable if all signs are +1, but for roots on the axis, which rounding hides."""
    p, C_s = _all(draft)
    chi = paper_coefficients(p, C_s, **draft.setting.model, unit=TIME_UNIT)
    signs, logarithms = generic_minors(tuple(reversed(_trimmed(tuple(reversed(chi))))), functions=ca)
    draft.output("sign", "-", "signs of Delta_1, Delta_2, ...", signs)
    draft.output("log10", "-", "log10 |Delta_1|, log10 |Delta_2|, ... in SI units", logarithms)


def critical_damping(draft: Draft) -> None:
    """Critical yaw damping that Newton's method reaches from a start, with its gradient. Check the residual."""
    names, model = draft.setting.bogie, draft.setting.model
    values = draft.parameters(names)
    p = ca.vertcat(*values.values())
    C_s, omega = start_of_critical_damping(draft.setting)
    C_s_start = draft.input("C_s_start", "N·s/m", "start of C_sl, positive", C_s)
    omega_start = draft.input("omega_start", "rad/s", "start of omega, positive", omega)
    solve = graphs.rootfinder(names, **model, method="fast_newton")
    z = solve(ca.vertcat(ca.log(C_s_start), omega_start / TIME_UNIT), p)
    C_sl = ca.exp(z[0])
    residual = ca.norm_2(graphs.boundary(names, **model)(z, p))
    places = [k for k, name in enumerate(names) if name in draft.setting.open]
    gradient = C_sl * graphs.boundary_slope(names, **model)(z, p)[places]
    draft.output("C_sl", "N·s/m", "critical damping of the pair of yaw dampers", C_sl)
    draft.output("omega", "rad/s", "angular frequency of the motion at the boundary", ca.fabs(z[1]) * TIME_UNIT)
    draft.output("residual", "-", "a solution only if this is below 1e-10; NaN is none", residual)
    about = "derivative of C_sl with respect to each parameter"
    rows = tuple(names[k] for k in places)
    units = tuple(per("N·s/m", described(name)[0]) for name in rows)
    draft.output("gradient", "SI", about, gradient, rows=rows, units=units)


def critical_equations(draft: Draft) -> None:
    """Equations of the stability boundary: both are zero where C_sl is critical and omega its frequency."""
    names, model = draft.setting.bogie, draft.setting.model
    p = ca.vertcat(*draft.parameters(names).values())
    start = start_of_critical_damping(draft.setting)
    C_sl = draft.input("C_sl", "N·s/m", "damping of the pair of yaw dampers, positive", start[0])
    omega = draft.input("omega", "rad/s", "angular frequency of the motion", start[1])
    residual = graphs.boundary(names, **model)(ca.vertcat(ca.log(C_sl), omega / TIME_UNIT), p)
    draft.output("residual", "-", "real and imaginary part of the polynomial at j omega, of order one", residual)


def rotational_resistance_function(draft: Draft) -> None:
    """Rotational resistance in the curve, eq. (13), and the damping that the curve allows, eq. (14)."""
    if draft.setting.load is None:
        raise ProblemError("rotational_resistance needs a curve, and the problem has none")
    if not draft.setting.curves:
        raise ProblemError("rotational_resistance is T / (4 Q a), and the axle load W is 0: let it be an input")
    p = draft.parameters(("W", "a", "b_0", "b_2", "b_3", "K_2x", "C_t", "C_s"))
    curve: Any = SimpleNamespace(**draft.parameters(tuple(CURVE)), load=draft.setting.load)
    load = LOADS[draft.setting.load]
    draft.output("X", "-", f"rotational resistance T / (4 Q a), {load}", rotational_resistance(p, p["C_s"], curve))
    draft.output("T", "N·m", "moment that resists the rotation", resisting_moment(p, p["C_s"], curve))
    draft.output("C_su", "N·s/m", "C_s at which T / (4 Q a) reaches the limit", curving_limit(p, curve))


def stability_margin(draft: Draft) -> None:
    """Chains that are positive exactly if every coupled mode has more than a given decay rate or damping ratio."""
    core, unit = _core(draft)
    sigma = draft.input("sigma", "1/s", "decay rate", 0.5)
    zeta = draft.input("zeta", "-", "damping ratio, 0 <= zeta < 1", 0.01)
    draft.output("decay_column", unit, "all positive: decay rates > sigma", generic_column(_shifted(core, sigma)))
    draft.output("ratio_column", unit, "all positive: damping ratios > zeta", sector_column(core, zeta, functions=ca))


def margin_equations(draft: Draft) -> None:
    """Equations of an NLP for the largest margin: the polynomial, shifted by sigma, as a product of quadratics."""
    core, _ = _core(draft)
    sigma = draft.input("sigma", "1/s", "decay rate by which the polynomial is shifted; 0 for a damping ratio", 0.1)
    zeta = draft.input("zeta", "-", "damping ratio; 0 for a decay rate", 0.01)
    start = quadratic_factors(draft.setting)
    p = draft.input("quadratic_p", "-", f"p of the factors s^2 + p s + q {IN_SCALE}", *start.p)
    q = draft.input("quadratic_q", "-", f"q of the factors s^2 + p s + q {IN_SCALE}", *start.q)
    factors: list[Polynomial] = [(q[k], p[k], 1) for k in range(len(start.p))]
    if start.r:
        factors.append((draft.input("linear_r", "-", f"r of the factor s + r {IN_SCALE}", *start.r), 1))
    whole = _shifted(core, sigma)
    residual = [a / whole[-1] - b for a, b in zip(whole[:-1], product(factors)[:-1], strict=True)]
    draft.output("residual", "-", "coefficients of the monic polynomial minus those of the product", residual)
    draft.output("sector", "-", "p^2 - 4 zeta^2 q: not negative where the ratio exceeds zeta", p**2 - 4 * zeta**2 * q)


def _shifted(core: Polynomial, sigma: Any) -> Polynomial:
    return shift(core, -sigma / TIME_UNIT)


def dynamic_stiffness(draft: Draft) -> None:
    """Dynamic stiffness Z(j omega) of the pair of yaw dampers with their joints, force over displacement."""
    p = draft.parameters(("K_ds", "C_s"))
    omega = draft.input("omega", "rad/s", "angular frequency", 20.0)
    law = Maxwell(p["K_ds"], p["C_s"])
    (_, c), (_, lag) = law.numerator, law.denominator
    real = c * omega * lag * omega / (1 + (lag * omega) ** 2)
    imaginary = c * omega / (1 + (lag * omega) ** 2)
    draft.output("Z_re", "N/m", "real part of Z, the storage stiffness", real)
    draft.output("Z_im", "N/m", "imaginary part of Z, the loss stiffness", imaginary)
    draft.output("K_dyn", "N/m", "magnitude of Z", c * omega / ca.sqrt(1 + (lag * omega) ** 2))
    draft.output("phase", "rad", "phase of Z", math.pi / 2 - ca.atan(lag * omega))


BUILDERS: Mapping[str, Callable[[Draft], None]] = {
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

"""Tables I and III and eqs (9), (11), (13), (14) of the paper, row by row."""

from collections.abc import Iterator
from dataclasses import replace
from math import isclose

from yawdesign.damper.curving import curving_limit, rotational_resistance
from yawdesign.damper.forward import ForwardDesign
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.equation_11 import minor_polynomial, positive_roots
from yawdesign.hunting.exact import NotDecidedError
from yawdesign.problem import PARAMETERS, exact, parse_quantity
from yawdesign.problem.parameters import parameter_keys
from yawdesign.study.paper_bogie import EQUATIONS, PaperBogie
from yawdesign.study.printed_values import (
    C_S,
    C_SL,
    C_SU,
    DEGREE_OF_9,
    DEGREE_OF_11,
    GOLDEN_SECTION,
    LAST_DIGIT,
    LIMIT,
    MOTOR_DAMPING_RATIO,
    MOTOR_FREQUENCY,
)
from yawdesign.study.reproduced_row import PRINTED, ReproducedRow, judged, row

DAMPING = "N·s/m"
ROUNDED = 0.05  # [%] by which the digits of Table I let Table III differ
SAME = 1e-9  # relative difference of two routes that is none
ROUNDING = "the rounding of K_m and C_m in Table I"
HALF_A_DIGIT = "half of the last digit that is printed"


def table_1(bogie: PaperBogie) -> Iterator[ReproducedRow]:
    """Yield Table I as used, and what its rounded values come from."""
    where = "Table I"
    for key in parameter_keys("power"):
        parameter = PARAMETERS[key]
        printed = float(parse_quantity(f"{parameter.source} {parameter.unit}".replace(" -", "")))
        used = float(bogie.p[key])
        yield row(
            *(where, f"{key}, {parameter.meaning}"),
            printed=printed,
            computed=used,
            unit=parameter.si,
            tolerance=0.0,
            reason="taken as it is printed",
            check="given, not computed",
        )
    motors = bogie.motors
    for key, value in bogie.unrounded.items():
        parameter = PARAMETERS[key]
        printed = float(parse_quantity(f"{parameter.source} {parameter.unit}"))
        yield row(
            *(where, f"{key} from {MOTOR_FREQUENCY:g} Hz and a damping ratio of {MOTOR_DAMPING_RATIO:g}, pi = 3.14"),
            printed=printed,
            computed=value,
            unit=parameter.si,
            tolerance=100 * _half_a_digit(parameter.source, parameter.unit) / printed,
            reason=HALF_A_DIGIT,
            misprint=12,
            check=f"eq. (12) the other way round: K_m and C_m as used have {motors[0]:.4f} Hz and {motors[1]:.4f}",
        )


def _half_a_digit(digits: str, unit: str) -> float:
    places = len(digits.partition(".")[2])
    return 0.5 * 10.0**-places * float(parse_quantity(f"1 {unit}"))


def table_3(bogie: PaperBogie) -> Iterator[ReproducedRow]:
    """Yield Table III, with both equations, and with the motor values that Table I rounds."""
    where, half = "Table III", 100 * LAST_DIGIT / 2
    for equations in EQUATIONS:
        found = bogie.designs[equations]
        yield row(
            *(where, "C_sl, least stable yaw damping"),
            printed=C_SL,
            computed=found.C_sl if found.critical else "none: stable for every C_s",
            unit=DAMPING,
            check="Routh's array and eigenvalues count the same unstable roots on both sides",
            checked=found.checked,
            **judged(equations, ROUNDED, ROUNDING, 12),
        )
    vehicle = bogie.vehicles[PRINTED]
    unrounded = critical_damping(vehicle.replace(**bogie.unrounded))
    low = next((low for low, _ in unrounded.stable_intervals), None)
    yield row(
        *(where, "C_sl with K_m, C_m as they are before rounding"),
        printed=C_SL,
        computed=low,
        unit=DAMPING,
        equations=PRINTED,
        tolerance=half / C_SL,
        reason=HALF_A_DIGIT,
        misprint=12,
        check="Routh's array and eigenvalues count the same unstable roots on both sides",
        checked=unrounded.checked,
    )
    upper = bogie.designs[PRINTED].C_su
    yield row(
        *(where, "C_su, most yaw damping in the curve, Q = W"),
        printed=C_SU,
        computed=upper,
        unit=DAMPING,
        tolerance=half / C_SU,
        reason=HALF_A_DIGIT,
        misprint=10,
        check="put into eq. (13) it gives the limit",
        checked=_gives_limit(bogie, upper),
    )
    for equations in EQUATIONS:
        found = bogie.designs[equations]
        yield row(
            *(where, "C_s, golden section"),
            printed=C_S,
            computed=found.C_s,
            unit=DAMPING,
            check="0.382 C_su + 0.618 C_sl; stable there by Routh's array and by eigenvalues",
            checked=found.checked and _is_golden(found),
            **judged(equations, ROUNDED, ROUNDING, 12),
        )
    golden = None if low is None or upper is None else GOLDEN_SECTION[0] * upper + GOLDEN_SECTION[1] * low
    yield row(
        *(where, "C_s, golden section, with K_m, C_m as they are before rounding"),
        printed=C_S,
        computed=golden,
        unit=DAMPING,
        equations=PRINTED,
        tolerance=half / C_S,
        reason=HALF_A_DIGIT,
        misprint=12,
        check="from C_sl and C_su above, each found by two routes",
        checked=unrounded.checked,
    )


def _is_golden(found: ForwardDesign) -> bool:
    if found.C_s is None or found.C_sl is None or found.C_su is None:
        return found.C_s is None
    high = min(found.C_su, *(end for low, end in found.stable_intervals if low < found.C_s < end))
    return isclose(found.C_s, GOLDEN_SECTION[0] * high + GOLDEN_SECTION[1] * found.C_sl, rel_tol=SAME)


def _gives_limit(bogie: PaperBogie, C_su: float | None) -> bool:
    curve = bogie.given.curve
    if curve is None or C_su is None:
        return False
    return isclose(rotational_resistance(bogie.p, C_su, curve), curve.limit, rel_tol=SAME)


def equations_13_14(bogie: PaperBogie) -> Iterator[ReproducedRow]:
    """Yield what eqs (13) and (14) give, with both loads that Q may be."""
    curve = bogie.given.curve
    assert curve is not None
    axle, wheel = replace(curve, load="axle"), replace(curve, load="wheel")
    yield row(
        *("(13)", "T/(4 Q a) with the printed C_su, Q = W"),
        printed=LIMIT,
        computed=float(rotational_resistance(bogie.p, C_SU, axle)),
        unit="-",
        tolerance=100 * LAST_DIGIT / 2 / C_SU,
        reason="the rounding of the printed C_su",
        misprint=10,
        check="eq. (14) solved for the limit gives the printed C_su",
        checked=isclose(curving_limit(bogie.p, replace(axle, limit=rotational_resistance(bogie.p, C_SU, axle))), C_SU),
    )
    of_wheel = float(curving_limit(bogie.p, wheel))
    yield row(
        *("(14)", "C_su with Q = W/2, the wheel load of railway standards"),
        printed=C_SU,
        computed=of_wheel,
        unit=DAMPING,
        reason="the paper calls Q the axle load and takes it so; the X factor of railway standards has the wheel load",
        misprint=10,
        check="put into eq. (13) it gives the limit",
        checked=isclose(rotational_resistance(bogie.p, of_wheel, wheel), wheel.limit, rel_tol=SAME),
    )


def equations_9_11(bogie: PaperBogie) -> Iterator[ReproducedRow]:
    """Yield degrees and signs of the characteristic equation, and eq. (11) with its smallest root."""
    for equations in EQUATIONS:
        vehicle = bogie.vehicles[equations]
        exactly = vehicle.model.at({name: exact(x) for name, x in vehicle.p.items()})
        chi, rounded = exactly.paper_coefficients(), vehicle.paper_coefficients()
        yield row(
            *("(9)", "degree of the characteristic equation"),
            printed=float(DEGREE_OF_9),
            computed=float(len(chi) - 1),
            equations=equations,
            tolerance=0.0,
            reason="a whole number",
            misprint=5,
            check="in rational numbers and in double precision",
            checked=len(rounded) == len(chi),
        )
        yield row(
            *("(9)", "chi_0 ... chi_26"),
            printed="all positive",
            computed="all positive" if min(chi) > 0 else "not all positive",
            equations=equations,
            agrees=min(chi) > 0,
            reason="that all are positive does not suffice for stability, nor does Delta_26 > 0 beside it",
            misprint=7,
            check="in rational numbers and in double precision",
            checked=bool(min(rounded) > 0) == bool(min(chi) > 0),
        )
        yield from _equation_11(bogie, equations)


def _equation_11(bogie: PaperBogie, equations: str) -> Iterator[ReproducedRow]:
    critical = critical_damping(bogie.vehicles[equations])
    try:
        minor = minor_polynomial(bogie.vehicles[equations])
        degree, roots = float(len(minor) - 1), positive_roots(minor)
    except NotDecidedError:
        degree, roots = None, None
    yield row(
        *("(11)", "degree of Delta_25 and Delta_26 in C_s"),
        printed=float(DEGREE_OF_11),
        computed=degree,
        equations=equations,
        tolerance=0.0,
        reason="a whole number",
        check="exact at more places than a polynomial of degree 50 has coefficients",
        checked=degree is not None,
    )
    found = [x.C_s for x in critical.critical]
    yield row(
        *("(11)", "smallest positive real root"),
        printed=C_SL,
        computed=next(iter(roots or ()), "none"),
        unit=DAMPING,
        check="the roots hold every C_s at which a pair of eigenvalues lies on the imaginary axis",
        checked=roots is not None
        and critical.checked
        and all(any(isclose(C_s, root, rel_tol=SAME) for root in roots) for C_s in found),
        **judged(equations, ROUNDED, f"{ROUNDING}; in general the smallest root need not be C_sl", 8),
    )

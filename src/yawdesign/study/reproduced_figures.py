"""Figs 3, 4 and 5 of the paper: critical damping over the motor suspension, and whether the design settles."""

from collections.abc import Iterator, Mapping
from math import isclose, sqrt

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.hunting.critical_damping import CriticalDamping, critical_damping
from yawdesign.hunting.stability import stability
from yawdesign.response.run.run import Run
from yawdesign.response.run.simulate import Simulation, simulate
from yawdesign.study.paper_bogie import EQUATIONS, PaperBogie
from yawdesign.study.printed_values import (
    C_S,
    NAMED_F_M,
    NAMED_XI_M,
    OVER_F_M,
    OVER_XI_M,
    SETTLING,
    SPEEDS_OF_FIGURES,
)
from yawdesign.study.reproduced_row import PRINTED, ReproducedRow, row
from yawdesign.study.result import Sweep
from yawdesign.study.sweep import sweep

FLAT, FAR = 0.01, (100.0, 1000.0)  # by which the end of a curve may change, and between which f_m [Hz]
DRAWN_TO = 8.0  # [Hz]
SAME = 1e-6  # relative difference of two routes that is none
TWO_COUNTS = "unstable roots on both sides, by Routh and by eigenvalues"
NO_NUMBER = "the figure prints no number: a value for comparison"
NO_TRACK = "the paper does not say which irregularity: here German low, 0.3 to 40 Hz"
# Closer together where the motors move at the frequency of the hunting motion and the curve folds.
F_M = np.unique(
    np.concatenate([np.linspace(1, DRAWN_TO, 281), np.linspace(3.2, 3.6, 161), np.linspace(3.22, 3.24, 41)])
)
XI_M = np.linspace(0.02, 1.0, 491)


def figure_3(bogie: PaperBogie) -> dict[str, Sweep]:
    """Return the curves of Fig. 3: (a) with the motors' damping held and with their damping ratio held, and (b)."""
    problem = bogie.problems[PRINTED]
    return {
        "fig3a-damping-held": sweep(problem, of="critical", f_m=F_M),
        "fig3a-ratio-held": sweep(problem, of="critical", f_m=F_M, hold="xi_m"),
        "fig3b": sweep(problem, of="critical", xi_m=XI_M),
    }


def rows_of_figure_3(bogie: PaperBogie, curves: Mapping[str, Sweep]) -> Iterator[ReproducedRow]:
    """Yield the course of each curve, its named points, and where there are several critical values."""
    for hold, of_damping in (("C_m", "C_m held"), ("xi_m", "xi_m held")):
        yield _course_over_frequency(bogie, hold, of_damping)
    yield _course_over_ratio(bogie)
    for f_m in (*NAMED_F_M, FAR[1]):
        yield _point(bogie, "Fig. 3a", f"f_m = {f_m:g} Hz, C_m held", K_m=_stiffness(bogie, f_m))
    for f_m in (*NAMED_F_M, FAR[1]):
        held = {"K_m": _stiffness(bogie, f_m), "C_m": bogie.p["C_m"] * f_m / _frequency(bogie)}
        yield _point(bogie, "Fig. 3a", f"f_m = {f_m:g} Hz, xi_m held", **held)
    for xi_m in NAMED_XI_M:
        C_m = 2 * xi_m * sqrt(bogie.p["K_m"] * bogie.p["M_m"])
        yield _point(bogie, "Fig. 3b", f"xi_m = {xi_m:g}", C_m=C_m)
    yield _several(curves["fig3a-damping-held"], "Fig. 3a", "f_m with several critical values, C_m held", "Hz")
    yield _several(curves["fig3a-ratio-held"], "Fig. 3a", "f_m with several critical values, xi_m held", "Hz")
    yield _several(curves["fig3b"], "Fig. 3b", "xi_m with several critical values", "-")


def _frequency(bogie: PaperBogie) -> float:
    return sqrt(bogie.p["K_m"] / bogie.p["M_m"]) / (2 * np.pi)


def _stiffness(bogie: PaperBogie, f_m: float) -> float:
    return float(bogie.p["M_m"] * (2 * np.pi * f_m) ** 2)


def _course_over_frequency(bogie: PaperBogie, hold: str, words: str) -> ReproducedRow:
    f_m = np.unique(np.concatenate([F_M, np.geomspace(DRAWN_TO, FAR[1], 60)]))
    found = sweep(bogie.problems[PRINTED], of="C_sl", f_m=f_m, hold=hold)
    y = found.main
    least = int(np.nanargmin(y))
    most = least + int(np.nanargmax(y[least:]))
    flat = bool(np.ptp(y[f_m >= FAR[0]]) < FLAT * y[-1])
    falls = bool(np.all(np.diff(y[: least + 1]) <= 0))
    agrees = falls and 0 < least < most and flat
    course = f"least {_shown(y[least])} at {f_m[least]:.3g} Hz, most {_shown(y[most])} at {f_m[most]:.3g} Hz"
    return row(
        *("Fig. 3a", f"C_sl over f_m, {words}"),
        printed=OVER_F_M,
        computed=f"{course}, {_shown(y[-1])} at {FAR[1]:g} Hz",
        equations=PRINTED,
        agrees=agrees,
        reason="which of C_m and xi_m is held is not printed: both curves have this course",
        check="each value by Routh's array, the named points by eigenvalues",
        checked=bool(found.known.all()),
    )


def _course_over_ratio(bogie: PaperBogie) -> ReproducedRow:
    found = sweep(bogie.problems[PRINTED], of="C_sl", xi_m=XI_M)
    y = found.main
    least = int(np.nanargmin(y))
    falls, rises = bool(np.all(np.diff(y[: least + 1]) <= 0)), bool(np.all(np.diff(y[least:]) >= 0))
    return row(
        *("Fig. 3b", "C_sl over xi_m"),
        printed=OVER_XI_M,
        computed=f"least {_shown(y[least])} at {XI_M[least]:.3g}, {_shown(y[-1])} at {XI_M[-1]:g}",
        equations=PRINTED,
        agrees=falls and rises and 0 < least < len(y) - 1,
        reason="the course that the paper describes",
        check="each value by Routh's array, the named points by eigenvalues",
        checked=bool(found.known.all()),
    )


def _shown(value: float) -> str:
    return f"{value / 1e3:.3g} kN·s/m"


def _point(bogie: PaperBogie, where: str, what: str, **changes: float) -> ReproducedRow:
    found = critical_damping(bogie.vehicles[PRINTED].replace(**changes))
    return row(
        *(where, f"critical C_s, {what}"),
        computed=_values(found),
        unit="N·s/m",
        equations=PRINTED,
        reason=NO_NUMBER,
        check=TWO_COUNTS,
        checked=found.checked,
    )


def _values(found: CriticalDamping) -> float | str:
    """Return the critical value, or all of them in words if there is not exactly one."""
    if len(found.critical) == 1:
        return found.critical[0].C_s
    return ", ".join(_shown(x.C_s) for x in found.critical) or "none"


def _several(curve: Sweep, where: str, what: str, unit: str) -> ReproducedRow:
    several = np.sum(~np.isnan(curve.main), axis=-1) > 1
    x = curve.axes[0].values
    return row(
        *(where, what),
        computed=_stretches(x, several),
        unit=unit,
        equations=PRINTED,
        reason="the figure shows one value everywhere; where there are several the smallest one need not be C_sl",
        misprint=8,
        check="the number of unstable roots changes by two at each value",
        checked=bool(curve.known.all()),
    )


def _stretches(x: Float, there: Float) -> str:
    steps = np.diff(np.concatenate([[0], there.astype(int), [0]]))
    ends = zip(np.flatnonzero(steps == 1), np.flatnonzero(steps == -1) - 1, strict=True)
    return ", ".join(f"{x[a]:.4g} ... {x[b]:.4g}" for a, b in ends) or "none"


def figures_4_5(bogie: PaperBogie) -> dict[str, Simulation]:
    """Return the runs of Figs 4 and 5 with the printed design, from rest."""
    problem = bogie.problems[PRINTED].replace(C_s=C_S)
    return {
        f"fig{number}": simulate(problem, "german-low", speed=kmh / 3.6, start="rest")
        for number, kmh in SPEEDS_OF_FIGURES.items()
    }


def rows_of_figures_4_5(bogie: PaperBogie, runs: Mapping[str, Simulation]) -> Iterator[ReproducedRow]:
    """Yield whether the amplitudes settle with the printed design, and how fast a free motion dies out."""
    for number, kmh in SPEEDS_OF_FIGURES.items():
        where, run = f"Fig. {number}", runs[f"fig{number}"].runs[0]
        for equations in EQUATIONS:
            yield from _settling(bogie, equations, where, kmh, run)
        yield row(
            *(where, f"growth rate fitted on the free motion at {kmh:g} km/h"),
            computed=run.fitted_rate,
            unit="1/s",
            equations=PRINTED,
            reason=NO_NUMBER,
            check="the eigenvalue",
            checked=run.checked,
        )
        yield from _sizes(bogie, where, kmh)


def _settling(bogie: PaperBogie, equations: str, where: str, kmh: float, run: Run) -> Iterator[ReproducedRow]:
    problem = bogie.problems[equations].replace(C_s=C_S, speed=kmh / 3.6)
    found = stability(problem)
    settles = found.stable and (run.settles or equations != PRINTED)
    fitted = ", and the rate fitted on the motion" if equations == PRINTED else ""
    same = equations != PRINTED or isclose(found.spectral_abscissa, run.spectral_abscissa, rel_tol=SAME)
    yield row(
        *(where, f"displacements of the frame at {kmh:g} km/h, C_s = 1 046 770 N·s/m"),
        printed=SETTLING,
        computed="settle" if settles else "do not settle",
        equations=equations,
        agrees=settles,
        reason="the sign of the spectral abscissa",
        check=f"eigenvalues and Routh's array{fitted}",
        checked=found.checked and same and (equations != PRINTED or run.checked),
    )
    yield row(
        *(where, f"spectral abscissa at {kmh:g} km/h"),
        computed=found.spectral_abscissa,
        unit="1/s",
        equations=equations,
        reason=NO_NUMBER,
        check="eigenvalues and Routh's array",
        checked=found.checked and same,
    )


def _sizes(bogie: PaperBogie, where: str, kmh: float) -> Iterator[ReproducedRow]:
    problem = bogie.problems[PRINTED].replace(C_s=C_S)
    run = simulate(problem, "german-low", speed=kmh / 3.6).runs[0]
    for name, what, unit in (("y_b", "lateral displacement", "m"), ("phi_b", "yaw displacement", "rad")):
        computed = None if run.rms_stationary is None else run.rms_stationary[name]
        yield row(
            *(where, f"{what} of the frame, RMS at {kmh:g} km/h"),
            computed=computed,
            unit=unit,
            equations=PRINTED,
            reason=NO_TRACK,
            check="the integral over the spectrum, and a run of 60 s",
            checked=computed is None or (run.checked and isclose(computed, run.rms[name], rel_tol=0.02)),
        )

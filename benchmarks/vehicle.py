"""A car body on two bogies against what a user would otherwise write: times and answers side by side.

Run: python benchmarks/vehicle.py [--points N] [--evaluations N] [--only ROWS ...]

The competitor is NumPy: 56-state matrices typed from the equations of motion, stacked eigenvalues, brentq over C_s, and
differential evolution. Without YAWDESIGN_CAMPAIGN=1 differential evolution gets a tenth of its 20 000 evaluations. The compile cache is
a new folder: the first row is cold, all others are warm.
"""

import argparse
import os
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq, differential_evolution

import yawdesign as yd
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.many import compiled, counts, margins
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.problem.parameters import CarBody
from yawdesign.vehicle.vehicle import Model

SHARE = 1.0 if os.environ.get("YAWDESIGN_CAMPAIGN") == "1" else 0.1
BODY = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
ROWS = 500  # matrices at once: more do not fit the caches
Spring = tuple[Any, Mapping[str, Any]]


def vehicle() -> yd.Problem:
    return replace(yd.table1(), car_body=BODY)


def state_matrices(p: Mapping[str, Any]) -> np.ndarray:
    """Return the state matrices of a power vehicle, as one types them from the equations: q, q', damper forces."""
    masses: dict[str, Any] = {"y_c": p["M_c"], "psi_c": p["J_c"], "th_c": p["I_c"]}
    springs: list[Spring] = [(2 * 2 * p["K_2z"] * p["b_2"] ** 2, {"th_c": 1})]
    dashpots: list[Spring] = [(2 * 2 * p["C_2z"] * p["b_2"] ** 2, {"th_c": 1})]
    maxwell: list[tuple[Any, Any, Mapping[str, Any]]] = []
    contacts = []
    for e, i in ((1, "1"), (-1, "2")):
        y, phi, along = f"y_b{i}", f"phi_b{i}", e * p["l_c"]
        masses |= {y: p["M_b"], phi: p["J_b"]}
        yawing = {phi: 1, "psi_c": -1}
        springs += [
            (p["K_2y"], {y: 1, "y_c": -1, "psi_c": -along, "th_c": -p["h_s"]}),
            (p["K_2x"] * p["b_2"] ** 2, yawing),
        ]
        maxwell.append((p["K_ds"], p["C_s"], {x: p["b_3"] * g for x, g in yawing.items()}))
        for s, j in ((1, "1"), (-1, "2")):
            arm, w, m = s * p["b_0"], i + j, i + j
            reach = {y: 1, phi: arm, "y_c": -1, "psi_c": -along - arm, "th_c": -p["h_t"]}
            maxwell.append((p["K_dt"] / 2, p["C_t"] / 2, reach))
            masses |= {f"y_w{w}": p["M_w"], f"phi_w{w}": p["J_w"], f"y_m{m}": p["M_m"], f"phi_m{m}": p["J_m"]}
            springs += [
                (p["K_1y"], {y: 1, phi: s * p["a"], f"y_w{w}": -1}),
                (p["K_1x"] * p["b_1"] ** 2, {phi: 1, f"phi_w{w}": -1}),
                (p["K_mphi"], {phi: 1, f"phi_m{m}": -1}),
            ]
            dashpots.append((p["C_mphi"], {phi: 1, f"phi_m{m}": -1}))
            hung = {y: 1, phi: s * p["a_0"], f"y_m{m}": -1}
            springs.append((p["K_m"], hung))
            maxwell.append((p["K_dm"] / 2, p["C_m"], hung))
            contacts.append((f"y_w{w}", f"phi_w{w}"))
    place = {x: k for k, x in enumerate(masses)}
    n, size = len(masses), np.broadcast_shapes(*(np.shape(x) for x in p.values()))
    A = np.zeros((*size, 2 * n + len(maxwell), 2 * n + len(maxwell)))
    A[..., np.arange(n), n + np.arange(n)] = 1

    def between(stiffness: Any, gap: Mapping[str, Any], first: int) -> None:
        for x, g in gap.items():
            for z, h in gap.items():
                A[..., n + place[x], first + place[z]] -= stiffness * g * h / masses[x]

    for stiffness, gap in springs:
        between(stiffness, gap, 0)
    for damping, gap in dashpots:
        between(damping, gap, n)
    for k, (stiffness, damping, gap) in enumerate(maxwell):
        A[..., 2 * n + k, 2 * n + k] = -stiffness / damping
        for x, g in gap.items():
            A[..., n + place[x], 2 * n + k] -= g / masses[x]
            A[..., 2 * n + k, n + place[x]] += stiffness * g
    v, b, gravity = p["v"], p["b"], p["W"] * p["lambda"]
    for y, phi in contacts:
        for x, z, first, value in (
            (y, y, 0, gravity / b), (y, y, n, 2 * p["f_11"] / v), (y, phi, 0, -2 * p["f_11"]),
            (phi, y, 0, 2 * p["f_22"] * b * p["lambda"] / p["r"]), (phi, phi, 0, -gravity * b),
            (phi, phi, n, 2 * p["f_22"] * b * b / v),
        ):  # fmt: skip
            A[..., n + place[x], first + place[z]] -= value / masses[x]
    return A


def abscissas(p: Mapping[str, Any], n: int) -> np.ndarray:
    """Return the spectral abscissas of many vehicles."""
    found = []
    for k in range(0, n, ROWS):
        part = {name: x[k : k + ROWS] if np.ndim(x) else x for name, x in p.items()}
        found.append(np.linalg.eigvals(state_matrices(part)).real.max(axis=-1))
    return np.concatenate(found)


def seconds(work: Callable[[], Any], repeat: int = 3) -> tuple[float, Any]:
    """Return the shortest time and the answer."""
    times, answer = [], None
    for _ in range(repeat):
        begin = time.perf_counter()
        answer = work()
        times.append(time.perf_counter() - begin)
    return min(times), answer


def line(*cells: object) -> None:
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def base() -> dict[str, float]:
    return {name: float(x) for name, x in vehicle().parameters().items()} | {"v": 300 / 3.6}


def verdicts(points: int) -> None:
    rng, model = np.random.default_rng(0), Model.of(vehicle())
    p: dict[str, Any] = {name: x * np.exp(rng.uniform(-0.4, 0.4, points)) for name, x in base().items()}
    p["C_s"] = 10 ** rng.uniform(4, 7.5, points)
    sets = ParameterSets(model, p, points)
    cold, _ = seconds(lambda: margins.stable(sets), 1)
    fast, (stable, sure) = seconds(lambda: margins.stable(sets), 5)
    find, compiled._compiler = compiled._compiler, lambda: None
    counts.verdicts.cache_clear()
    plain, (same, _) = seconds(lambda: margins.stable(sets), 2)
    compiled._compiler = find
    few = min(points, 10_000)
    other, abscissa = seconds(lambda: abscissas(p, few), 1)
    wrong = int(np.sum((abscissa < 0) != stable[:few]))
    per = other / few * 1e6
    text = (
        f"{wrong} of {few} differ; NumPy and compiled the same: {np.array_equal(stable, same)}; sure {sure.mean():.5f}"
    )
    for name, cost in (("compiled, warm", fast), ("without a compiler", plain)):
        own = cost / points * 1e6
        line(f"verdict, {name}", f"{own:.2f} us", "stacked eigenvalues", f"{per:.0f} us", f"{per / own:.0f}", text)
    line(f"verdicts of {points} points, cold", f"{cold:.2f} s", "", f"{per * points / 1e6:.0f} s",
         f"{per * points / 1e6 / cold:.0f}", "the tape made, compiled and kept")  # fmt: skip


def criticals() -> None:
    p = base()

    def abscissa(x: float) -> float:
        return float(np.linalg.eigvals(state_matrices({**p, "C_s": np.exp(x)})).real.max())

    def scanned() -> list[float]:
        places = np.linspace(np.log(1e3), np.log(1e8), 60)
        values = np.array([abscissa(x) for x in places])
        changes = np.flatnonzero(values[:-1] * values[1:] < 0)
        return [float(np.exp(brentq(abscissa, places[k], places[k + 1], xtol=1e-12))) for k in changes]

    task = Model.of(vehicle()).at(p)
    own_time, own = seconds(lambda: critical_damping(task))
    other_time, other = seconds(scanned, 1)
    ends = [c for interval in own.stable_intervals for c in interval if 1e3 < c < 1e8]
    error = max((min(abs(a / b - 1) for a in ends) for b in other), default=np.nan)
    line("all critical values at a point", f"{own_time:.3f} s", "60 eigenvalue problems and brentq", f"{other_time:.3f} s",
         f"{other_time / own_time:.1f}", f"{len(own.critical)} values, {len(ends)} ends of stability; brentq finds {len(other)}, the same to {error:.0e}")  # fmt: skip


def optima(evaluations: int) -> None:
    p = base()
    bounds = {"C_s": (1e4, 1e7), "K_m": (0.1 * p["K_m"], 10 * p["K_m"]), "C_m": (0.1 * p["C_m"], 10 * p["C_m"])}
    for more in ({}, {"C_t": (0.1 * p["C_t"], 10 * p["C_t"])}):
        every = {**bounds, **more}
        variables = {name: yd.Variable(min=low, max=high) for name, (low, high) in every.items()}
        task = vehicle().replace(design=yd.Design(objective="damping_ratio", variables=variables))
        cold, _ = seconds(lambda task=task: yd.optimise(task), 1)
        warm, found = seconds(lambda task=task: yd.optimise(task), 1)
        limit = {"C_s": float(found.C_su)} if found.C_su else {}
        names = list(every)

        def ratios(x: np.ndarray, names: list[str] = names) -> np.ndarray:
            s = np.linalg.eigvals(state_matrices({**p, **dict(zip(names, np.exp(x), strict=True))}))
            return np.sort(-s.real / np.abs(s), axis=-1)

        ends = [(np.log(low), np.log(min(high, limit.get(name, high)))) for name, (low, high) in every.items()]
        other, least = seconds(lambda ends=ends: evolved(lambda x: -ratios(x)[..., 0], ends, evaluations), 1)
        line(f"optimise in {', '.join(names)}", f"{warm:.1f} s ({cold:.1f} s cold)", f"differential evolution, {evaluations}",
             f"{other:.1f} s", f"{other / warm:.1f}", f"worst ratio {found.margin:.6f} and {least:.6f}")  # fmt: skip
        if found.next_margin is None:
            continue
        floor = 0.98 * least  # what is given away for the modes behind the one that caps the margin

        def behind(x: np.ndarray, floor: float = floor) -> np.ndarray:
            found = ratios(x)
            return np.where(found[..., 0] >= floor, -found[..., 2], 1 + floor - found[..., 0])

        other, second = seconds(lambda ends=ends: evolved(behind, ends, evaluations), 1)
        line("the same: all other modes, worst ratio at least 98 %", "in it", f"differential evolution, {evaluations}",
             f"{other:.1f} s", "", f"ratio {found.next_margin:.6f} and {second:.6f}")  # fmt: skip


def evolved(objective: Callable[[np.ndarray], np.ndarray], ends: list[tuple[float, float]], evaluations: int) -> float:
    size = 15 * len(ends)
    found = differential_evolution(
        objective, ends, popsize=15, maxiter=max(1, evaluations // size - 1),
        tol=0, atol=0, polish=False, vectorized=True, updating="deferred", rng=0)  # fmt: skip
    return -float(found.fun)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=100_000, help="random points of the verdicts")
    parser.add_argument("--evaluations", type=int, default=int(20_000 * SHARE), help="of differential evolution")
    parser.add_argument("--only", nargs="*", default=["verdicts", "criticals", "optima"], help="which rows")
    arguments = parser.parse_args()
    line("work", "time", "against", "time", "ratio", "agreement")
    line(*["---"] * 6)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        if "verdicts" in arguments.only:
            verdicts(arguments.points)
        if "criticals" in arguments.only:
            criticals()
        if "optima" in arguments.only:
            optima(arguments.evaluations)


if __name__ == "__main__":
    main()

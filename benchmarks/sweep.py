"""Verdicts and critical values of many bogies against what a user would otherwise write: times and answers.

Run: python benchmarks/sweep.py [--points N] [--exact N] [--long SECONDS]

Times are microseconds a point. Competitors that are slow are timed on a sample of the same points.
"""

import argparse
import os
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import control
import numpy as np
from scipy.optimize import brentq

import yawdesign as yd
from yawdesign.hunting.boundary import critical_damping as critical_function
from yawdesign.hunting.boundary import parameter_names
from yawdesign.hunting.certificate import certify
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import MARGINS, motion_eigenvalues, state_matrix
from yawdesign.hunting.many import compiled, counts
from yawdesign.study.answers import evaluate
from yawdesign.study.request import Question
from yawdesign.vehicle.polynomials import add, even_odd, multiply, scale, scale_variable
from yawdesign.vehicle.vehicle import Model

MODEL = Model(equations="as-printed")
SPEED = 300 / 3.6


def table1() -> dict[str, float]:
    p = yd.table1(equations="as-printed").bogie.parameters()
    return {name: float(x) for name, x in p.items() if name != "C_s" and x is not None} | {"v": SPEED}


def question(of: str) -> Question:
    return Question(of, MODEL)


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


def parts(p: Mapping[str, Any], n: int) -> Iterator[dict[str, Any]]:
    for k in range(n):
        yield {name: x[k] if np.ndim(x) else x for name, x in p.items()}


def some(p: Mapping[str, Any], n: int) -> dict[str, Any]:
    return {name: x[:n] if np.ndim(x) else x for name, x in p.items()}


def without_compiler(work: Callable[[], Any]) -> Any:
    """Run with plain NumPy: no compiler is found, and no tape has compiled code."""
    find, compiled._compiler = compiled._compiler, lambda: None
    counts.verdicts.cache_clear()
    try:
        return work()
    finally:
        compiled._compiler = find
        counts.verdicts.cache_clear()


def verdicts(points: int) -> None:
    rng = np.random.default_rng(0)
    p = {name: x * np.exp(rng.uniform(-0.7, 0.7, points)) for name, x in table1().items()}
    p["C_s"] = 10 ** rng.uniform(3, 8, points)
    numpy_time, plain = without_compiler(lambda: seconds(lambda: evaluate(question("stable"), p), 2))
    evaluate(question("stable"), p)
    fast_time, fast = seconds(lambda: evaluate(question("stable"), p), 5)
    sample = min(points, 20_000)
    A = state_matrix(MODEL.at(some(p, sample)))
    eig_time, _ = seconds(lambda: np.linalg.eigvals(A))
    few = min(sample, 2000)
    control_time, poles = seconds(
        lambda: [control.ss(a, np.zeros((25, 1)), np.zeros((1, 25)), 0).poles() for a in A[:few]], 1
    )

    def filled_and_solved() -> list[Any]:
        own = [state_matrix(MODEL.at(q)) for q in parts(p, 200)]
        return [control.ss(a, np.zeros((25, 1)), np.zeros((1, 25)), 0).poles() for a in own]

    filled_time, _ = seconds(filled_and_solved, 1)
    same = np.array_equal(plain.columns["stable"], fast.columns["stable"])
    agreement = differences(p, points, fast.columns["stable"])
    per = 1e6 / points
    line("verdict, NumPy", f"{numpy_time * per:.3f}", "eigvals of given stacked matrices", f"{eig_time / sample * 1e6:.1f}",
         f"{eig_time / sample / numpy_time * points:.0f}", agreement)  # fmt: skip
    line("verdict, compiled", f"{fast_time * per:.4f}", "the same", f"{eig_time / sample * 1e6:.1f}",
         f"{eig_time / sample / fast_time * points:.0f}", f"NumPy and compiled the same: {same}; recomputed {fast.recomputed.sum()}")  # fmt: skip
    for name, cost in (("matrices given", control_time / few), ("matrices filled in the loop", filled_time / 200)):
        agree = sum((x.real.max() < 0) != y for x, y in zip(poles, fast.columns["stable"], strict=False))
        line("verdict, compiled", f"{fast_time * per:.4f}", f"python-control in a loop, {name}", f"{cost * 1e6:.0f}",
             f"{cost / fast_time * points:.0f}", f"{agree} of {few} differ")  # fmt: skip


def differences(p: Mapping[str, Any], points: int, stable: np.ndarray) -> str:
    """Compare all verdicts with eigenvalues, and say how near to the boundary those lie that differ."""
    near: list[float] = []
    for first in range(0, points, 20_000):
        part = {name: x[first : first + 20_000] for name, x in p.items()}
        s = np.linalg.eigvals(state_matrix(MODEL.at(part)))
        abscissa = s.real.max(axis=1)
        near += list(np.abs(abscissa[(abscissa < 0) != stable[first : first + 20_000]]))
    return f"{len(near)} of {points} differ" + (f", |Re| at most {max(near):.1e} 1/s" if near else "")


def grid(n: int) -> dict[str, Any]:
    p = table1()
    f_m, xi_m = (x.ravel() for x in np.meshgrid(np.linspace(0.5, 8, n), np.linspace(0.05, 1, n), indexing="ij"))
    omega = 2 * np.pi * f_m
    return p | {"K_m": omega**2 * p["M_m"], "C_m": 2 * xi_m * omega * p["M_m"]}


COUPLED = MODEL.at(table1()).coupled  # which coordinates move in it is found once: a competitor need not do it again


def spectral_abscissa(p: Mapping[str, Any], C_s: Any) -> np.ndarray:
    """Return the largest real part of the coupled motion."""
    return np.asarray(motion_eigenvalues(MODEL.at(p, C_s=C_s), COUPLED).real.max(axis=-1))


def scan_and_brentq(p: Mapping[str, float]) -> list[float]:
    """Return the critical values as one would find them: the spectral abscissa at 60 dampings, brentq between."""

    def abscissa(x: float) -> float:
        return float(spectral_abscissa(p, np.exp(x)))

    places = np.linspace(np.log(1e3), np.log(1e8), 60)
    stacked = spectral_abscissa(p, np.exp(places))
    changes = np.flatnonzero(stacked[:-1] * stacked[1:] < 0)
    return [float(np.exp(brentq(abscissa, places[k], places[k + 1], xtol=1e-10))) for k in changes]


def companion(p: Mapping[str, Any]) -> np.ndarray:
    """Return the roots of the polynomial in w^2 of all points, from stacked companion matrices."""
    A, B = (scale_variable(part, 100.0) for part in MODEL.at(p).coupled.coefficients)
    (ea, oa), (eb, ob) = even_odd(A), even_odd(B)
    F = np.stack(np.broadcast_arrays(*add(multiply(eb, oa), scale(multiply(ea, ob), -1))), axis=-1)
    matrices = np.zeros((len(F), F.shape[1] - 1, F.shape[1] - 1))
    matrices[:, 1:, :-1] = np.eye(F.shape[1] - 2)
    matrices[:, :, -1] = -F[:, :-1] / F[:, -1:]
    return np.linalg.eigvals(matrices)


def criticals(exact: int) -> None:
    p = grid(200)
    n = len(p["K_m"])
    evaluate(question("critical"), p)
    own_time, own = seconds(lambda: evaluate(question("critical"), p))
    chosen = np.random.default_rng(1).choice(n, exact, replace=False)
    points = [{name: float(x[k] if np.ndim(x) else x) for name, x in p.items()} for k in chosen]
    scan_time, scanned = seconds(lambda: [scan_and_brentq(q) for q in points[:100]], 1)
    counts = own.columns["count"][chosen]
    missed = sum(len(x) != count for x, count in zip(scanned, counts, strict=False))
    per = own_time / n
    line("critical values on 200 x 200", f"{per * 1e6:.2f}", "60 eigenvalue problems and brentq", f"{scan_time * 1e4:.0f}",
         f"{scan_time / 100 / per:.0f}", f"{missed} of 100 counts differ from the scan's")  # fmt: skip
    sample = {name: x[:4000] if np.ndim(x) else x for name, x in p.items()}
    companion_time, _ = seconds(lambda: companion(sample))
    line("the same", f"{per * 1e6:.2f}", "batched companion eigenvalues", f"{companion_time / 4000 * 1e6:.0f}",
         f"{companion_time / 4000 / per:.1f}", f"recomputed {own.recomputed.sum()}, unverified {own.unverified.sum()}")  # fmt: skip
    certified = [certify(MODEL.at(q)) for q in points]
    right = sum(len(c.critical) == count for c, count in zip(certified, counts, strict=True))
    worst = max(
        (abs(x.C_s / y - 1) for c, k in zip(certified, chosen, strict=True)
         for x, y in zip(c.critical, own.columns["critical"][k], strict=False)), default=0.0,
    )  # fmt: skip
    line("the same", "", "exact rationals", "", "", f"{right} of {exact} counts right, values to {worst:.0e}")


def growth() -> None:
    import resource

    for side in (32, 100, 316, 1000):
        p = grid(side)
        cost, _ = seconds(lambda p=p: evaluate(question("critical"), p), 3 if side < 1000 else 1)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        line(
            f"critical values on {side} x {side}",
            f"{cost / side**2 * 1e6:.2f}",
            "",
            "",
            "",
            f"peak memory {memory:.0f} MB",
        )


def margins_of_a_map(side: int) -> None:
    """Compare margins by verdicts and Newton's method with those of stacked eigenvalues, in one thread each."""
    C_s, conicity = np.meshgrid(np.geomspace(1e4, 1e7, side), np.linspace(0.05, 0.4, side), indexing="ij")
    for model in (MODEL, Model()):
        p = table1() | {"C_s": C_s.ravel(), "lambda": conicity.ravel()}
        for of, measure in MARGINS.items():
            asked = Question(of, model, variables=("C_s", "K_m", "C_m"))
            evaluate(asked, p, threads=1)
            own_time, own = seconds(lambda asked=asked, p=p: evaluate(asked, p, threads=1))
            sample = np.arange(0, side**2, max(1, side**2 // 20_000))
            vehicle = model.at({name: x[sample] if np.ndim(x) else x for name, x in p.items()})
            eig_time, s = seconds(lambda vehicle=vehicle: motion_eigenvalues(vehicle, vehicle.coupled), 1)
            error = np.max(np.abs(own.columns[of][sample] / measure(s) - 1))
            per, other = own_time / side**2 * 1e6, eig_time / len(sample) * 1e6
            line(f"{of} on {side} x {side}, {model.equations}", f"{per:.2f}", "stacked eigenvalues", f"{other:.1f}",
                 f"{other / per:.0f}", f"to {error:.0e}, recomputed {own.recomputed.sum()}; {own_time:.1f} s")  # fmt: skip


def gradient() -> None:
    p = table1()
    (x,) = critical_damping(MODEL.at(p)).critical
    names = parameter_names(p)
    f, values = critical_function(MODEL, names), list(p.values())
    first = f.factory("first", ["p", "C_s", "omega"], ["C_s_critical", "residual", "gradient"])
    own_time, solved = seconds(lambda: [first(values, x.C_s, x.omega) for _ in range(200)][-1])
    base = np.array(values)

    def by_differences() -> np.ndarray:
        def solve(v: np.ndarray) -> float:
            q = dict(zip(names, v, strict=True))
            return brentq(lambda C_s: float(spectral_abscissa(q, C_s)), 6e4, 1.4e5, xtol=1e-8)

        steps = np.diag(1e-5 * base)
        return np.array([(solve(base + h) - solve(base - h)) / (2 * h.sum()) for h in steps])

    other_time, other = seconds(by_differences, 1)
    g = np.array(solved[2]).ravel()
    error = np.max(np.abs(other - g) * base) / np.max(np.abs(g) * base)
    line("C_sl with 32 derivatives", f"{own_time / 200 * 1e6:.0f}", "central differences of brentq", f"{other_time * 1e6:.0f}",
         f"{other_time / own_time * 200:.0f}", f"differ by {error:.0e}, the residual here is {float(solved[1]):.0e}")  # fmt: skip


def processes(long: float) -> None:
    problem = yd.table1(equations="as-printed").replace(C_s=1e6)
    per = 4e-6  # s a point
    side = int(np.sqrt(long / per))
    axes = {"K_m": np.geomspace(1e5, 5e6, side), "C_m": np.geomspace(2e3, 2e5, side)}
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with ProcessPoolExecutor(1) as pool:
        one, a = seconds(lambda: yd.sweep(problem, of="decay_rate", executor=pool, **axes), 1)
    with ProcessPoolExecutor(2) as pool:
        two, b = seconds(lambda: yd.sweep(problem, of="decay_rate", executor=pool, **axes), 1)
    from dask.distributed import Client

    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        client.run(os.getpid)
        dask, c = seconds(lambda: yd.sweep(problem, of="decay_rate", executor=client, **axes), 1)
    for name, cost, answer in (("2 processes", two, b), ("dask, 2 local workers", dask, c)):
        same = np.array_equal(a.values, answer.values)
        line(
            f"decay rates on {side} x {side}, {name}",
            f"{cost:.1f} s",
            "1 process",
            f"{one:.1f} s",
            f"{one / cost:.2f}",
            f"the same: {same}",
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=1_000_000, help="random points of the verdicts")
    parser.add_argument("--exact", type=int, default=1000, help="points of the grid checked in exact rationals")
    parser.add_argument("--side", type=int, default=755, help="points along each axis of the map of margins")
    parser.add_argument("--long", type=float, default=40.0, help="seconds of the work that is shared by processes")
    arguments = parser.parse_args()
    line("work", "us a point", "against", "us a point", "ratio", "agreement")
    line(*["---"] * 6)
    verdicts(arguments.points)
    criticals(arguments.exact)
    growth()
    margins_of_a_map(arguments.side)
    gradient()
    processes(arguments.long)


if __name__ == "__main__":
    main()

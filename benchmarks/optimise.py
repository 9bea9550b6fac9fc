"""The optimum against differential evolution, as a user would write it: answers and times side by side.

Run: python benchmarks/optimise.py [--random N] [--seeds N]

Differential evolution gets 40 000 evaluations a run, batched NumPy eigenvalues of the state matrices, and five seeds.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np
from scipy.optimize import differential_evolution

import yawdesign as yd
from yawdesign.damper.curving import curving_limit
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.vehicle.vehicle import Model


def problem(objective: str, equations: str, seed: int | None = None) -> yd.Problem:
    base = yd.table1(equations=equations)
    bogie, speed = base.bogie, 300 / 3.6
    if seed is not None:
        rng = np.random.default_rng(seed)
        keys = [k for k in bogie.parameters() if k not in {"W", "r"}]
        values = {k: float(bogie.parameters()[k]) * float(1.4 ** rng.uniform(-1, 1)) for k in keys}
        base, speed = base.replace(**values), float(rng.uniform(200, 350)) / 3.6
    p = base.bogie
    variables = {
        "C_s": yd.Variable(min=1e3, max=1e7),
        "K_m": yd.Variable(min=0.1 * p.K_m, max=10 * p.K_m),
        "C_m": yd.Variable(min=0.1 * p.C_m, max=10 * p.C_m),
    }
    return base.replace(speed=speed, design=yd.Design(objective=objective, variables=variables))


def margin_of(task: yd.Problem) -> Callable[[np.ndarray], np.ndarray]:
    """Return what differential evolution minimises: minus the margin, over logarithms of the variables."""
    p, model = {**task.bogie.parameters(), "v": task.speeds[0]}, Model.of(task)
    names, coupled = tuple(task.design.variables), model.motions[0]

    def negative_margin(x: np.ndarray) -> np.ndarray:
        values = dict(zip(names, np.exp(x), strict=True))
        s = np.linalg.eigvals(motion_matrix(model.at({**p, **values}), coupled))
        measure = -s.real if task.design.objective == "decay_rate" else -s.real / np.abs(s)
        return -measure.min(axis=-1)

    return negative_margin


def bounds_of(task: yd.Problem) -> list[tuple[float, float]]:
    """Return the bounds of the logarithms of the variables; the curve limits C_s."""
    variables = task.design.variables
    high = {name: float(v.max) for name, v in variables.items()}
    high["C_s"] = min(high["C_s"], float(curving_limit(task.bogie.parameters(), task.curve)))
    return [(np.log(float(v.min)), np.log(high[name])) for name, v in variables.items()]


def evolve(task: yd.Problem, seed: int) -> tuple[float, float]:
    begin = time.perf_counter()
    found = differential_evolution(
        margin_of(task), bounds_of(task), popsize=15, maxiter=40_000 // 45 - 1, tol=0, atol=0, polish=False, vectorized=True,
        updating="deferred", rng=seed,
    )  # fmt: skip
    return -float(found.fun), time.perf_counter() - begin


def row(name: str, task: yd.Problem, seeds: int) -> str:
    begin = time.perf_counter()
    ours = yd.optimise(task)
    mine = time.perf_counter() - begin
    runs = [evolve(task, seed) for seed in range(seeds)]
    margins, total = [m for m, _ in runs], sum(t for _, t in runs)
    assert ours.margin is not None
    ratio = ours.margin / max(margins)
    return (
        f"| {name} | {ours.margin:.6f} | {mine:.1f} s | {max(margins):.6f} | {min(margins):.6f} | {total:.1f} s "
        f"| {ratio:.6f} | {total / mine:.1f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--random", type=int, default=0, help="number of random bogies beside Table I")
    parser.add_argument("--seeds", type=int, default=5, help="runs of differential evolution a problem")
    arguments = parser.parse_args()
    print("| problem | margin | time | DE best run | DE worst run | DE, all runs | margin / DE best | DE time / ours |")
    print("|---|---|---|---|---|---|---|---|")
    cases = [(o, e) for o in ("decay_rate", "damping_ratio") for e in ("as-printed", "reciprocal")]
    for objective, equations in cases:
        print(row(f"Table I, {equations}, {objective}", problem(objective, equations), arguments.seeds), flush=True)
    for seed in range(arguments.random):
        objective, equations = cases[seed % 4]
        task = problem(objective, equations, seed)
        print(row(f"random {seed}, {equations}, {objective}", task, arguments.seeds), flush=True)


if __name__ == "__main__":
    main()

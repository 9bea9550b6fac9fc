"""Points of the front between margin and rotational resistance against differential evolution under the same limit.

Run: python benchmarks/trade_off.py [--points N] [--seeds N] [--evaluations N]

Differential evolution sees batched NumPy eigenvalues of the state matrices under every condition, and starts anew for
every point and seed. One problem is Table I under one condition, the other under fifteen: conicity 0.05 ... 0.40 times
creep 1 ... 0.5. Three points of each front are compared: those at a quarter, a half and three quarters of it.
"""

import argparse
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy.optimize import differential_evolution

import yawdesign as yd
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.problem.conditions import conditions
from yawdesign.vehicle.vehicle import Model

FIFTEEN = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.7, 0.5]}
POPULATION = 45


def problems(objective: str) -> dict[str, yd.Problem]:
    base = yd.table1().replace(objective=objective)
    return {"one condition": base, "15 conditions": base.replace(conditions=FIFTEEN)}


def least_margin(task: yd.Problem, names: tuple[str, ...]) -> Callable[[np.ndarray], np.ndarray]:
    """Return what differential evolution minimises: minus the worst margin, over logarithms of the variables."""
    p, model = task.bogie.parameters(), Model.of(task)
    coupled = model.motions[0]

    def negative_margin(x: np.ndarray) -> np.ndarray:
        worst = np.full(x.shape[1:], np.inf)
        for condition in conditions(task):
            values = condition.applied({**p, **dict(zip(names, np.exp(x), strict=True))})
            s = np.linalg.eigvals(motion_matrix(model.at(values), coupled))
            measure = -s.real if task.design.objective == "decay_rate" else -s.real / np.abs(s)
            worst = np.minimum(worst, measure.min(axis=-1))
        return -worst

    return negative_margin


def evolve(task: yd.Problem, point: Mapping[str, Any], seed: int, evaluations: int) -> float:
    """Return the largest margin that one run finds with at most the damping of a point of the front."""
    variables = task.design.variables
    high = {name: float(variable.max) for name, variable in variables.items()} | {"C_s": point["C_s"]}
    bounds = [(np.log(float(variable.min)), np.log(high[name])) for name, variable in variables.items()]
    found = differential_evolution(
        least_margin(task, tuple(variables)), bounds, popsize=POPULATION // len(bounds), tol=0, atol=0, polish=False,
        maxiter=evaluations // POPULATION - 1, vectorized=True, updating="deferred", rng=seed,
    )  # fmt: skip
    return -float(found.fun)


def rows(name: str, task: yd.Problem, points: int, seeds: int, evaluations: int) -> None:
    begin = time.perf_counter()
    result = yd.trade_off(task, points=points)
    mine = time.perf_counter() - begin
    count = len(result.front)
    for k in sorted({count // 4, count // 2, 3 * count // 4}):
        point, begin = result.front[k], time.perf_counter()
        margins = [evolve(task, point, seed, evaluations) for seed in range(seeds)]
        theirs = time.perf_counter() - begin
        print(
            f"| {name}, {task.design.objective} | {point['rotational_resistance']:.5f} | {point['margin']:.7f} "
            f"| {max(margins):.7f} | {min(margins):.7f} | {point['margin'] / max(margins):.7f} "
            f"| {mine:.0f} s for {count} points | {theirs:.0f} s for this one |",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=12, help="of each front")
    parser.add_argument("--seeds", type=int, default=5, help="runs of differential evolution a point")
    parser.add_argument("--evaluations", type=int, default=11_000, help="of each run")
    parser.add_argument("--problems", type=int, default=2, help="1: under one condition only")
    arguments = parser.parse_args()
    print("| problem | T/(4Qa) | margin | DE best run | DE worst run | margin / DE best | time | DE, all runs |")
    print("|---|---|---|---|---|---|---|---|")
    for objective in ("decay_rate", "damping_ratio"):
        for name, task in list(problems(objective).items())[: arguments.problems]:
            rows(name, task, arguments.points, arguments.seeds, arguments.evaluations)


if __name__ == "__main__":
    main()

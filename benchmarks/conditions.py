"""The optimum under many conditions against differential evolution, as a user would write it: answers and times.

Run: python benchmarks/conditions.py [--evaluations N] [--evolutions N] [--seeds N] [--only ROWS ...]

Differential evolution looks at every condition of every design by batched NumPy eigenvalues of the state matrices, with
11 000 evaluations a run and five seeds; of ranges it sees a grid, as one would take. Both answers are then judged alike:
by the lowest margin over all conditions, of ranges over a finer grid and downhill from its lowest points. Ours runs
with ten seeds; the compile cache is a new folder, the first run is cold, and one more runs without a compiler.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import differential_evolution, minimize

import yawdesign as yd
from yawdesign.damper.curving import curving_limit
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.vehicle.vehicle import Model

TOGETHER = 2000  # matrices at once: more do not fit the caches
CONICITIES, CREEPS, SPEEDS = (0.05, 0.10, 0.15, 0.25, 0.40), (1.0, 0.7, 0.5), (200, 230, 260, 300, 330)
RANGES = ((0.05, 0.40), (0.5, 1.0), (200 / 3.6, 330 / 3.6))  # of conicity, creep and speed [m/s]
COARSE, FINE = (5, 3, 3), (33, 17, 14)  # points of the grids along them
DOWNHILL = 5  # points of the finer grid from which the lowest margin is looked for


@dataclass(frozen=True)
class Row:
    """One comparison."""

    variables: tuple[str, ...]
    objective: str
    speeds: tuple[float, ...] = (300.0,)  # [km/h]
    ranges: bool = False

    @property
    def task(self) -> yd.Problem:
        base = yd.table1()
        p = base.bogie
        every = {"C_s": (1e3, 1e7), "K_m": (0.1 * p.K_m, 10 * p.K_m), "C_m": (0.1 * p.C_m, 10 * p.C_m)}
        bounds = {name: yd.Variable(min=every[name][0], max=every[name][1]) for name in self.variables}
        design = yd.Design(objective=self.objective, variables=bounds)
        if not self.ranges:
            conditions: dict[str, object] = {"lambda": list(CONICITIES), "creep_factor": list(CREEPS)}
            return base.replace(conditions=conditions, speed=[f"{v} km/h" for v in self.speeds], design=design)
        conicity, creep, speed = ({"min": low, "max": high} for low, high in RANGES)
        conditions = {"lambda": conicity, "creep_factor": creep}
        return base.replace(conditions=conditions, speed=yd.SpeedRange(**speed), design=design)

    def grid(self, points: tuple[int, ...]) -> np.ndarray:
        """Return conicities, creep factors and speeds, shape (3, conditions); of lists all of them."""
        if self.ranges:
            axes = [np.linspace(low, high, n) for (low, high), n in zip(RANGES, points, strict=True)]
            return np.array([*product(*axes)]).T
        return np.array([*product(CONICITIES, CREEPS, [v / 3.6 for v in self.speeds])]).T


ROWS = {
    "15 conditions, C_s, K_m, C_m, decay rate": Row(("C_s", "K_m", "C_m"), "decay_rate"),
    "15 conditions, C_s, decay rate": Row(("C_s",), "decay_rate"),
    "15 conditions, C_s, damping ratio": Row(("C_s",), "damping_ratio"),
    "ranges, C_s, K_m, C_m, decay rate": Row(("C_s", "K_m", "C_m"), "decay_rate", ranges=True),
    "75 conditions, C_s, decay rate": Row(("C_s",), "decay_rate", SPEEDS),
    "75 conditions, C_s, K_m, C_m, decay rate": Row(("C_s", "K_m", "C_m"), "decay_rate", SPEEDS),
}


def margins_of(row: Row) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return the function of designs, shape (variables, n), and conditions, shape (3, n), that gives the margins."""
    task = row.task
    p, model = {name: float(x) for name, x in task.bogie.parameters().items()}, Model.of(task)

    def margins(designs: np.ndarray, conditions: np.ndarray) -> np.ndarray:
        found = []
        for k in range(0, designs.shape[1], TOGETHER):
            conicity, creep, v = conditions[:, k : k + TOGETHER]
            changed = dict(zip(row.variables, designs[:, k : k + TOGETHER], strict=True))
            changed |= {"lambda": conicity, "f_11": creep * p["f_11"], "f_22": creep * p["f_22"], "v": v}
            s = np.linalg.eigvals(motion_matrix(model.at({**p, **changed}), model.motions[0]))
            measure = -s.real if row.objective == "decay_rate" else -s.real / np.abs(s)
            found.append(measure.min(axis=-1))
        return np.concatenate(found)

    return margins


def worst_of(row: Row, designs: np.ndarray, points: tuple[int, ...]) -> np.ndarray:
    """Return the worst margins of designs, shape (variables, n), over the conditions of a grid."""
    grid, n = row.grid(points), designs.shape[1]
    m = grid.shape[1]
    return margins_of(row)(np.repeat(designs, m, axis=1), np.tile(grid, n)).reshape(n, m).min(axis=1)


def judged(row: Row, design: np.ndarray) -> float:
    """Return the worst margin of one design: of ranges on the finer grid, and downhill from its lowest points."""
    if not row.ranges:
        return float(worst_of(row, design[:, None], FINE)[0])
    margins, grid = margins_of(row), row.grid(FINE)
    found = margins(np.repeat(design[:, None], grid.shape[1], axis=1), grid)
    ends = np.array(RANGES)

    def there(x: np.ndarray) -> float:
        place = ends[:, 0] + np.clip(x, 0, 1) * (ends[:, 1] - ends[:, 0])
        return float(margins(design[:, None], place[:, None])[0])

    starts = (grid[:, np.argsort(found)[:DOWNHILL]].T - ends[:, 0]) / (ends[:, 1] - ends[:, 0])
    options = {"xatol": 1e-6, "fatol": 1e-9}
    return min(
        float(minimize(there, x, method="Nelder-Mead", bounds=[(0, 1)] * 3, options=options).fun) for x in starts
    )


def bounds_of(row: Row) -> list[tuple[float, float]]:
    """Return the bounds of the logarithms of the row's variables, in their order; the curve limits C_s."""
    task = row.task
    ends = {name: (float(variable.min), float(variable.max)) for name, variable in task.design.variables.items()}
    ends["C_s"] = ends["C_s"][0], min(ends["C_s"][1], float(curving_limit(task.bogie.parameters(), task.curve)))
    return [(np.log(ends[name][0]), np.log(ends[name][1])) for name in row.variables]


def evolved(row: Row, evaluations: int, seed: int) -> tuple[np.ndarray, float]:
    """Return the design that differential evolution finds, and the time [s]."""
    bounds = bounds_of(row)
    begin, size = time.perf_counter(), 15 * len(bounds)
    found = differential_evolution(
        lambda x: -worst_of(row, np.exp(x), COARSE), bounds, popsize=15, maxiter=max(1, evaluations // size - 1),
        tol=0, atol=0, polish=False, vectorized=True, updating="deferred", rng=seed,
    )  # fmt: skip
    return np.exp(found.x), time.perf_counter() - begin


def optimised(row: Row, seed: int) -> tuple[np.ndarray, float, float]:
    """Return our design, the margin that it is said to have, and the time [s]."""
    task = row.task
    begin = time.perf_counter()
    found = yd.optimise(task, seed=seed)
    elapsed = time.perf_counter() - begin
    assert found.margin is not None
    return np.array([found.optimum[name] for name in row.variables]), float(found.margin), elapsed


def without_a_compiler(name: str) -> float:
    """Return the time of one run in another process that finds no compiler [s]."""
    command = [sys.executable, __file__, "--time", name]
    done = subprocess.run(command, env={**os.environ, "YAWDESIGN_CC": ""}, capture_output=True, text=True, check=True)
    return float(json.loads(done.stdout))


def compared(name: str, evaluations: int, evolutions: int, seeds: int) -> str:
    """Return a row of the table."""
    row = ROWS[name]
    runs = [optimised(row, seed) for seed in range(seeds)]
    margins, times = [margin for _, margin, _ in runs], [elapsed for *_, elapsed in runs]
    ours = judged(row, runs[0][0])
    others = [evolved(row, evaluations, seed) for seed in range(evolutions)]
    theirs = [judged(row, design) for design, _ in others] or [float("nan")]
    shown = f"{margins[0]:.10f} | {max(margins) / min(margins) - 1:.0e} | {ours / margins[0] - 1:+.0e}"
    cells = f"{times[0]:.1f} s | {min(times):.1f} s | {without_a_compiler(name):.1f} s"
    beside = f"{max(theirs):.6f} | {min(theirs):.6f} | {sum(t for _, t in others):.0f} s | {ours / max(theirs):.6f}"
    return f"| {name} | {shown} | {cells} | {beside} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--evaluations", type=int, default=11_000, help="of each run of differential evolution")
    parser.add_argument("--evolutions", type=int, default=5, help="runs of differential evolution")
    parser.add_argument("--seeds", type=int, default=10, help="runs of ours")
    parser.add_argument("--only", nargs="*", default=list(ROWS), metavar="WORDS", help="rows whose names hold these")
    parser.add_argument("--time", choices=ROWS, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.time:
        print(json.dumps(optimised(ROWS[arguments.time], 0)[2]))
        return
    columns = (
        "problem", "margin", "spread over seeds", "by eigenvalues", "cold", "warm", "without a compiler",
        "DE best run", "DE worst run", "DE, all runs", "margin / DE best",
    )  # fmt: skip
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        for name in ROWS:
            if any(words in name for words in arguments.only):
                parts = arguments.evaluations, arguments.evolutions, arguments.seeds
                print(compared(name, *parts), flush=True)


if __name__ == "__main__":
    main()

"""The time to rank a catalogue of 200 dampers, and for how many of them the answer is that of each one alone.

Run: python benchmarks/choose.py [--rows N] [--compared N]
"""

import argparse
import time
from dataclasses import replace

import numpy as np

import yawdesign as yd
from yawdesign.damper.candidates import Candidate
from yawdesign.damper.scored_rows import with_damper

LISTS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [0.5, 0.75, 1.0]}
RANGES = {"lambda": {"min": 0.05, "max": 0.4}, "creep_factor": {"min": 0.5, "max": 1.0}}
LOST = {"one yaw damper lost": {"C_s": "50 %", "K_ds": "50 %"}}
TASKS = {
    "one condition": {},
    "15 conditions": {"conditions": LISTS},
    "15 conditions, a fault, a damping ratio": {
        "conditions": LISTS, "cases": LOST, "requirements": {"damping_ratio": "5 %"},
    },
    "15 conditions, a fault, a damping ratio and a critical speed": {
        "conditions": LISTS, "cases": LOST, "requirements": {"damping_ratio": "5 %", "critical_speed": "330 km/h"},
    },
    "ranges of conicity and creep": {"conditions": RANGES},
}  # fmt: skip


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rows", type=int, default=200)
    options.add_argument("--compared", type=int, default=20)
    asked = options.parse_args()
    rng = np.random.default_rng(0)
    catalogue = tuple(
        yd.CatalogueDamper(name=f"D{k}", damping=float(c), stiffness=float(s))
        for k, (c, s) in enumerate(
            zip(np.geomspace(1e4, 3e6, asked.rows), rng.uniform(4e6, 40e6, asked.rows), strict=True)
        )
    )
    for name, more in TASKS.items():
        problem = replace(yd.table1(), design=yd.Design(catalogue=catalogue), **more)
        begin, own = time.perf_counter(), time.process_time()
        found = yd.choose(problem)
        took, used = time.perf_counter() - begin, time.process_time() - own
        compared = found.candidates[:: max(1, asked.rows // asked.compared)]
        same = sum(agrees(problem, each) for each in compared)
        print(f"{name}: {took:.2f} s ({used:.2f} s of this process); {same} of {len(compared)} the same alone")


def agrees(problem: yd.Problem, candidate: Candidate) -> bool:
    damper = next(each for each in problem.design.catalogue if each.name == candidate.name)
    alone = yd.stability(with_damper(problem, damper))
    refused = candidate.status in ("unstable", "exceeds the curve's limit", "outside the bounds")
    met = all(each.met for each in alone.requirements)
    same = met == (candidate.status == "ok") or refused
    if candidate.searched or not problem.conditions.ranges:
        same = same and abs(alone.decay_rate - candidate.margin) <= 1e-6 * max(abs(candidate.margin), 1)
    return same and (alone.stable or candidate.status != "ok")


if __name__ == "__main__":
    main()

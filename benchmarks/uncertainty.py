"""The probability of instability: time of 2**20 samples, error against independent samples, verdicts and eigenvalues.

Run: python benchmarks/uncertainty.py [--body]
"""

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import yawdesign as yd
from yawdesign.study.probability import draws, probability_unstable
from yawdesign.study.replicates import UncertainVehicle, Workers, workers_of
from yawdesign.study.samples import REPLICATES
from yawdesign.study.uncertainty import SAMPLES, judged_vehicle

DISTRIBUTIONS = {
    "lambda": {"uniform": [0.05, 0.40]},
    "creep_factor": {"uniform": [0.5, 1.0]},
    "K_m": {"lognormal": "10 %"},
    "C_m": {"lognormal": "10 %"},
    "C_s": {"normal": "10 %"},
}
SEEDS = 20


def seconds(work: Callable[[], Any]) -> tuple[float, Any]:
    begin = time.perf_counter()
    answer = work()
    return time.perf_counter() - begin, answer


def scatter(workers: Workers, vehicle: UncertainVehicle, samples: int) -> dict[str, float]:
    """Return the standard deviation of a probability over seeds, with Sobol and with independent points."""
    found = {}
    for name, independent in (("scrambled Sobol", False), ("independent", True)):
        values = []
        for seed in range(SEEDS):
            jobs = [(draw, 1.0) for draw in draws(vehicle, samples, seed, independent=independent)]
            counted = workers.all("", vehicle.counted, jobs)
            values.append(sum(x.unstable for x in counted) / samples)
        found[name] = float(np.std(values, ddof=1))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--body", action="store_true", help="with a car body on two such bogies")
    body = yd.CarBody(**BODY) if parser.parse_args().body else None
    problem = yd.table1().replace(C_s=1046770, uncertainty=DISTRIBUTIONS, car_body=body)
    vehicle = judged_vehicle(problem)
    with workers_of(None, lambda text, part: None) as workers:
        probability_unstable(workers, vehicle, 2**10, 0)  # compiles
        time_taken, found = seconds(lambda: probability_unstable(workers, vehicle, SAMPLES, 0))
        low, high = found.interval
        print(f"{found.samples} samples: {time_taken:.2f} s, probability {found.value:.6f} in [{low:.6f}, {high:.6f}]")
        time_taken, different = seconds(
            lambda: sum(
                workers.all(
                    "", vehicle.differing, [(draw, 10_000 // REPLICATES) for draw in draws(vehicle, SAMPLES, 0)]
                )
            )
        )
        print(f"10000 verdicts beside eigenvalues: {different} differ, {time_taken:.2f} s")
        for name, deviation in scatter(workers, vehicle, 2**17).items():
            print(f"standard deviation of the probability from 2**17 {name} points: {deviation:.2e}")
    time_taken, _ = seconds(lambda: yd.uncertainty(problem))
    print(f"with percentiles, indices and derivatives: {time_taken:.1f} s")


BODY = {
    "M_c": 34500,
    "J_c": 1.521e6,
    "I_c": 124304,
    "l_c": 9.5,
    "h_s": 0.852,
    "h_t": 0.97,
    "K_2z": 0.61e6,
    "C_2z": 9800,
}

if __name__ == "__main__":
    main()

"""One critical damping with its gradient: exported C code, the Python API, and SciPy's brentq on NumPy eigenvalues.

Run: python benchmarks/export.py [--seconds S]

All in one process run, one after the other and three times over; the best of three counts. The C program is compiled with
-O2 and measures itself. brentq looks for the zero of the largest real part of the coupled motion's state matrix, between half
and double the answer, as one would write it without a characteristic polynomial; its gradient is that of central differences.
"""

import argparse
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import yawdesign as yd
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import motion_matrix
from yawdesign.vehicle.motions import Motion
from yawdesign.vehicle.vehicle import Vehicle

DRIVER = r"""
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "yawdesign.h"
#define P(name) yawdesign_critical_damping_##name
int main(int argc, char **argv) {
  static double w[P(SZ_W)];
  static casadi_int iw[P(SZ_IW)];
  double x[] = P(VALUES), value, residual, gradient[P(in_count)], sum = 0;
  const double *arg[P(SZ_ARG)] = {0};
  double *res[P(SZ_RES)] = {0};
  long n = argc > 1 ? atol(argv[1]) : 1, k;
  struct timespec a, b;
  for (k = 0; k < P(in_count); ++k) arg[k] = &x[k];
  res[P(out_C_sl)] = &value;
  res[P(out_residual)] = &residual;
  res[P(out_gradient)] = gradient;
  clock_gettime(CLOCK_MONOTONIC, &a);
  for (k = 0; k < n; ++k) {
    x[P(in_v)] *= k % 2 ? 1 + 1e-9 : 1 - 1e-9;
    if (yawdesign_critical_damping(arg, res, iw, w, 0) || !(residual < 1e-10)) return 3;
    sum += value;
  }
  clock_gettime(CLOCK_MONOTONIC, &b);
  printf("%.17g %.9g\n", sum / n, ((b.tv_sec - a.tv_sec) + 1e-9 * (b.tv_nsec - a.tv_nsec)) / n);
  return 0;
}
"""


def compiled(task: yd.Problem, folder: Path) -> Path:
    yd.export(task, folder / "out", only="critical_damping", formats="c")
    (folder / "driver.c").write_text("#define _POSIX_C_SOURCE 199309L\n" + DRIVER)
    sources = [folder / "driver.c", folder / "out" / "yawdesign.c"]
    subprocess.run(
        ["cc", "-std=c99", "-O2", f"-I{folder / 'out'}", "-o", folder / "driver", *sources, "-lm"], check=True
    )
    return folder / "driver"


def timed(call: Callable[[], object], seconds: float) -> float:
    """Return the time of one call."""
    count, begin = 0, time.perf_counter()
    while time.perf_counter() - begin < seconds or not count:
        call()
        count += 1
    return (time.perf_counter() - begin) / count


def by_brentq(vehicle: Vehicle, motion: Motion, near: float) -> float:
    def largest(C_s: float) -> float:
        return float(np.linalg.eigvals(motion_matrix(vehicle.replace(C_s=C_s), motion)).real.max())

    return float(brentq(largest, near / 2, 2 * near, xtol=1e-9 * near, rtol=1e-12))


def gradient_by_brentq(vehicle: Vehicle, motion: Motion, near: float) -> list[float]:
    steps = {name: 1e-5 * value for name, value in vehicle.p.items() if name != "C_s"}
    ends = [[vehicle.replace(**{n: vehicle.p[n] + sign * h}) for sign in (1, -1)] for n, h in steps.items()]
    moved = [[by_brentq(end, motion, near) for end in pair] for pair in ends]
    return [(up - down) / (2 * h) for (up, down), h in zip(moved, steps.values(), strict=True)]


def row(name: str, task: yd.Problem, seconds: float) -> str:
    (vehicle,) = Vehicle.of(task)
    f = yd.functions(task).documented["critical_damping"]
    values = [port.value[0] for port in f.inputs]
    answer = float(f.function(*values)[0])
    routes: dict[str, Callable[[], object]] = {
        "casadi": lambda: f.function(*values),
        "all": lambda: critical_damping(Vehicle(vehicle.model, vehicle.p)),
        "brentq": lambda: by_brentq(vehicle, vehicle.coupled, answer),
        "differences": lambda: gradient_by_brentq(vehicle, vehicle.coupled, answer),
    }
    best = dict.fromkeys(["c", *routes], np.inf)
    with tempfile.TemporaryDirectory() as folder:
        program = compiled(task, Path(folder))
        for _ in range(3):
            value, once = subprocess.run(
                [program, str(int(seconds * 2e4) + 1)], capture_output=True, text=True, check=True
            ).stdout.split()
            assert abs(float(value) / answer - 1) < 1e-7
            best["c"] = min(best["c"], float(once))
            for route, call in routes.items():
                best[route] = min(best[route], timed(call, seconds))
    assert abs(by_brentq(vehicle, vehicle.coupled, answer) / answer - 1) < 1e-6
    c = best["c"]
    cells = [f"{best[r] * 1e6:,.0f} us ({best[r] / c:,.0f})".replace(",", " ") for r in routes]
    return f"| {name} | {c * 1e6:.1f} us | " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=1.0, help="for each measurement")
    arguments = parser.parse_args()
    print(
        "| bogie | C, with gradient | CasADi in Python, with gradient | all critical values, checked | brentq | ",
        end="",
    )
    print("brentq, gradient by differences |\n|---|---|---|---|---|---|")
    trailer = yd.table1().bogie.parameters()
    trailer = {("lambda_" if k == "lambda" else k): x for k, x in trailer.items() if not yd.PARAMETERS[k].motor}
    tasks = {
        "Table I, as printed": yd.table1(equations="as-printed"),
        "Table I, reciprocal": yd.table1(),
        "trailer": yd.Problem(bogie=yd.Bogie(kind="trailer", **trailer), speed=300 / 3.6),
    }
    for name, task in tasks.items():
        print(row(name, task, arguments.seconds), flush=True)


if __name__ == "__main__":
    main()

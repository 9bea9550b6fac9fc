"""Critical values of random bogies against exact rationals: how many are wrong, missed, invented or unverified.

Run: python benchmarks/exact.py [--wide N] [--undamped N] [--folds N] [--seeds 1 2 3]

Three kinds of bogies around Table I, of all equations: every parameter times or divided by up to ten, some of them zero;
nearly undamped ones; and bogies at a fold, where two critical values are about to meet and vanish. Each is asked both
ways: alone (`critical_damping`, what `design` uses) and among many (`evaluate`, what `sweep` uses). The exact answer is that of
`certify`: proved roots of rational polynomials and Sturm chains. A value is wrong if it is off by more than 1e-8 of itself, or a number of
unstable roots differs; it counts against an answer only where that says "checked".
"""

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

import yawdesign as yd
from yawdesign.hunting.certificate import Certificate, certify
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.study.answers import evaluate
from yawdesign.study.request import Question
from yawdesign.vehicle.vehicle import Model, Vehicle

MODELS = (Model("power", "as-printed"), Model("power", "reciprocal"), Model("trailer", "reciprocal"))
TABLE_1 = {name: float(x) for name, x in yd.table1().bogie.parameters().items() if name != "C_s" and x is not None}
TRAILER = {
    name: float(x)
    for name, x in yd.table1(kind="trailer").bogie.parameters().items()
    if name != "C_s" and x is not None
}
MAY_BE_ZERO = ("C_m", "C_t", "b_0", "W", "K_2x", "K_2y", "C_mphi", "K_mphi")
LOW_DAMPING = ("C_m", "C_t", "C_mphi")
VERDICTS = ("right", "wrong", "missed", "invented", "unverified")
CLOSE = 1e-8


def random_bogie(rng: np.random.Generator, spread: float) -> Vehicle:
    model = MODELS[rng.integers(len(MODELS))]
    base = TRAILER if model.kind == "trailer" else TABLE_1
    p = {name: x * spread ** rng.uniform(-1, 1) for name, x in base.items()}
    return model.at(p, v=rng.uniform(100, 450) / 3.6)


def wide(rng: np.random.Generator) -> Iterator[Vehicle]:
    while True:
        vehicle = random_bogie(rng, (1.5, 3.0, 10.0)[rng.integers(3)])
        zeros = [name for name in MAY_BE_ZERO if name in vehicle.p and rng.random() < 0.02]
        yield vehicle.replace(**dict.fromkeys(zeros, 0.0))


def undamped(rng: np.random.Generator) -> Iterator[Vehicle]:
    while True:
        vehicle = random_bogie(rng, 3.0)
        low = {
            name: vehicle.p[name] * 10 ** rng.uniform(-8, -1)
            for name in LOW_DAMPING
            if name in vehicle.p and rng.random() < 0.7
        }
        yield vehicle.replace(**low)


def folds(rng: np.random.Generator) -> Iterator[Vehicle]:
    """Yield bogies at which two critical values are apart by anything between rounding and a hundredth."""
    while True:
        vehicle = random_bogie(rng, 3.0)
        name = rng.choice([x for x in vehicle.p if x not in ("W", "b_0")])
        values = vehicle.p[name] * np.geomspace(0.5, 2, 40)
        counts = _counts(vehicle.replace(**{name: values}))
        for k in np.flatnonzero(np.abs(np.diff(counts)) == 2)[:2]:
            distance = 10 ** rng.uniform(-16, -4)
            fold = _fold(vehicle, name, (values[k], values[k + 1]), counts[k], distance / 4)
            more = math.copysign(1.0, (values[k] - values[k + 1]) * (counts[k] - counts[k + 1]))
            near = vehicle.replace(**{name: float(fold * (1 + more * distance))})
            if any(b.C_s < 1.1 * a.C_s for a, b in pairwise(critical_damping(near).critical)):
                yield near


def _fold(vehicle: Vehicle, name: str, ends: tuple[float, float], count: int, close: float) -> float:
    """Return where the number of critical values changes, to a relative distance or rounding."""
    low, high = ends
    while abs(high - low) > max(close, 3e-16) * abs(low):
        middle = (low + high) / 2
        low, high = (middle, high) if _counts(vehicle.replace(**{name: middle}))[0] == count else (low, middle)
    return (low + high) / 2


def _counts(vehicle: Vehicle) -> np.ndarray:
    return np.asarray(_together(vehicle).columns["count"])


def _together(vehicle: Vehicle) -> Any:
    return evaluate(Question("critical", vehicle.model), vehicle.p)


KINDS = {"wide": wide, "nearly undamped": undamped, "at a fold": folds}


def alone(bogies: Sequence[Vehicle]) -> list[tuple[list[float], list[int], bool]]:
    answers = [critical_damping(vehicle) for vehicle in bogies]
    return [([x.C_s for x in a.critical], list(a.unstable_roots), a.checked) for a in answers]


def among_many(bogies: Sequence[Vehicle]) -> list[tuple[list[float], list[int], bool]]:
    """Return the same from arrays, those of one model together."""
    answers: dict[int, tuple[list[float], list[int], bool]] = {}
    for model in MODELS:
        chosen = [k for k, vehicle in enumerate(bogies) if vehicle.model == model]
        if not chosen:
            continue
        p = {name: np.array([bogies[k].p[name] for k in chosen]) for name in bogies[chosen[0]].p}
        # A parameter that is zero at some points only has no polynomial of lower degree: those points by themselves.
        zero = np.any([x == 0 for x in p.values()], axis=0)
        for part in [~zero, *(np.arange(len(chosen)) == k for k in np.flatnonzero(zero))]:
            if part.any():
                found = _together(model.at({name: x[part] for name, x in p.items()}))
                for row, k in enumerate(np.array(chosen)[part]):
                    answers[int(k)] = _row(found, row)
    return [answers[k] for k in range(len(bogies))]


def _row(found: Any, k: int) -> tuple[list[float], list[int], bool]:
    values, counts = (found.columns[name][k] for name in ("critical", "unstable_roots"))
    return values[~np.isnan(values)].tolist(), counts[~np.isnan(counts)].astype(int).tolist(), not found.unverified[k]


def proved(vehicle: Vehicle) -> Certificate | None:
    """Return the exact answer, or nothing where a root stays on the imaginary axis for every C_s (zero springs)."""
    try:
        return certify(vehicle)
    except ArithmeticError:
        return None


def judged(answer: tuple[list[float], list[int], bool], exact: Certificate | None) -> str:
    values, counts, checked = answer
    if not checked:
        return "unverified"
    if exact is None:  # what is never stable must not be called so
        return "right" if all(counts) else "wrong"
    expected = [x.C_s for x in exact.critical]
    if len(values) != len(expected):
        return "missed" if len(values) < len(expected) else "invented"
    close = all(math.isclose(a, b, rel_tol=CLOSE) for a, b in zip(values, expected, strict=True))
    return "right" if close and counts == list(exact.unstable_roots) else "wrong"


def campaign(kind: str, n: int, seed: int) -> dict[str, Counter[str]]:
    """Return how many of n bogies of a kind are judged how, asked alone and among many."""
    source = KINDS[kind](np.random.default_rng([seed, list(KINDS).index(kind)]))
    bogies = [next(source) for _ in range(n)]
    exact = [proved(vehicle) for vehicle in bogies]
    ways = {"alone": alone(bogies), "among many": among_many(bogies)}
    return {way: Counter(judged(a, e) for a, e in zip(answers, exact, strict=True)) for way, answers in ways.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for kind, n in (("wide", 3000), ("undamped", 1000), ("folds", 500)):
        parser.add_argument(f"--{kind}", type=int, default=n, help="bogies for each seed")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    arguments = parser.parse_args()
    sizes = dict(zip(KINDS, (arguments.wide, arguments.undamped, arguments.folds), strict=True))
    print("| seed | bogies | asked | " + " | ".join(VERDICTS) + " |")
    print("| --- " * (3 + len(VERDICTS)) + "|", flush=True)
    bad = 0
    for seed in arguments.seeds:
        for kind, n in sizes.items():
            for way, counts in campaign(kind, n, seed).items():
                print(
                    f"| {seed} | {n} {kind} | {way} | " + " | ".join(str(counts[x]) for x in VERDICTS) + " |",
                    flush=True,
                )
                bad += sum(counts[x] for x in ("wrong", "missed", "invented"))
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

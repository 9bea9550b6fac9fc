"""Broken problem files: each is read, or refused with the place of every mistake, and none takes long."""

import math
import time

import numpy as np
import pytest

from yawdesign.problem import starter
from yawdesign.problem.reader import read_text

GOOD = (
    starter(),
    starter("trailer"),
    starter("trailer", car_body=True),
    "bogie: {base: table1, K_ds: rigid, C_1y: 20 kN s/m}\ncar_body: {base: huo-dai, l_c: 9 m}\nspeed: 80 m/s\n"
    "cases:\n  one. lost: {leading.C_s: 50 %, C_t: 0}\n  b: {K_2z: 3e5}\n",
    "{bogie: {base: table1, K_m: &k 6.3e5, C_t: 60 kN.s/m}, speed: {min: 200 km/h, max: 300 km/h, steps: 5}}",
    "bogie:\t# a tab\n  base: table1\nspeed:\t90 km/h\t# fast\ncurve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90}\n"
    "title: >\n  a\n  b\n",
    "bogie: {base: table1}\nspeed: [200 km/h, 80 m/s]\nconditions:\n  lambda: [0.05, 40 %]\n"
    "  creep_factor: {min: 0.5, max: 1}\n  tolerance: {K_m: 10 %, C_s: 0.15}\n  load: {ta.re: {W: 120 kN}, b: {W: 0}}\n"
    "cases: {a: {C_s: 50 %}}\nrequirements: {damping_ratio: 5 %, critical_speed: 330 km/h, cases: {decay_rate: 0.1}}\n",
)


def survives(text):
    """Return whether a text was read; every mistake has its place, and all numbers are finite."""
    start = time.perf_counter()
    problem, diagnostics = read_text(text, "problem.yaml")
    assert time.perf_counter() - start < 5
    assert (problem is None) == any(d.severity == "error" for d in diagnostics)
    for diagnostic in diagnostics:
        assert diagnostic.line >= 1
        assert diagnostic.column >= 1
        assert diagnostic.render().startswith(f"problem.yaml:{diagnostic.line}:{diagnostic.column}: ")
        assert len(diagnostic.message) < 800, diagnostic.message
        diagnostic.render().encode()
    if problem is not None:
        assert all(math.isfinite(x) for x in (*problem.bogie.parameters().values(), *problem.speeds) if x is not None)
        problem.title.encode()
        assert problem.title.isprintable() or "\u00a0" in problem.title or "\ufeff" in problem.title
    return problem is not None


def campaign(mutated, seeds):
    read = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        read += survives(mutated(GOOD[seed % len(GOOD)], rng))
    return read


def test_mutated_files(mutated):
    assert 10 < campaign(mutated, range(200)) < 190


@pytest.mark.slow
def test_thousands_of_mutated_files(mutated):
    assert campaign(mutated, range(1000, 5000)) > 200


def test_the_texts_themselves_are_read():
    assert all(map(survives, GOOD))

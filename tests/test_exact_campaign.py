"""The campaign of benchmarks/exact.py at a part of its size: no answer that says it is checked is wrong."""

import importlib.util
import os
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd

ROOT = Path(__file__).parents[1]
SHARE = float(os.environ.get("YAWDESIGN_CAMPAIGN", "0.1"))
SIZES = {"wide": 3000, "nearly undamped": 1000, "at a fold": 500}
UNVERIFIED = {"wide": 0.001, "nearly undamped": 0.01, "at a fold": 0.05}  # refusing what is hard is no cure


@pytest.fixture(scope="module")
def exact():
    spec = importlib.util.spec_from_file_location("exact", ROOT / "benchmarks" / "exact.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["exact"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["exact"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", SIZES)
def test_what_says_it_is_checked_is_right(exact, kind):
    n = max(1, int(SHARE * SIZES[kind]))
    for counts in exact.campaign(kind, n, seed=4).values():
        assert not counts["wrong"] + counts["missed"] + counts["invented"]
        assert counts["unverified"] <= max(UNVERIFIED[kind] * n, 1)
        assert counts["right"] + counts["unverified"] == n


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::yawdesign.problem.diagnostics.UnitWarning")
@pytest.mark.parametrize("kind", ["wide", "nearly undamped"])
def test_designs_are_verified(exact, kind):
    """The verdict at the chosen damping too: eigenvalues must not fail where the critical values are known."""
    source, n = exact.KINDS[kind](np.random.default_rng(8)), max(1, int(SHARE * SIZES[kind] / 2))
    unverified = 0
    for vehicle in (next(source) for _ in range(n)):
        model = vehicle.model
        base = yd.table1(**({"kind": "trailer"} if model.kind == "trailer" else {"equations": model.equations}))
        p = dict(vehicle.p)
        design = yd.design(base.replace(speed=p.pop("v"), **p))
        unverified += design.status == "unverified"
    assert unverified <= max(UNVERIFIED[kind] * n, 1)


@pytest.mark.parametrize("kind", SIZES)
def test_a_few_of_each_kind(exact, kind):
    for counts in exact.campaign(kind, 3, seed=5).values():
        assert counts == Counter(right=3)


def test_the_judge_sees_what_is_wrong(exact):
    source = exact.wide(np.random.default_rng(6))
    proved = next(x for x in (exact.proved(vehicle) for vehicle in source) if x and len(x.critical) == 1)
    value, counts = proved.critical[0].C_s, list(proved.unstable_roots)
    assert exact.judged(([value], counts, True), proved) == "right"
    assert exact.judged(([value * (1 + 1e-7)], counts, True), proved) == "wrong"
    assert exact.judged(([value], counts[::-1], True), proved) == "wrong"
    assert exact.judged(([], counts[:1], True), proved) == "missed"
    assert exact.judged(([value, 2 * value], [*counts, 0], True), proved) == "invented"
    assert exact.judged(([], counts[:1], False), proved) == "unverified"

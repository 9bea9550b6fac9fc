"""Differential evolution in benchmarks/ is asked what `optimise` is asked: the same margin, the same bounds."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd

ROOT = Path(__file__).parents[1]
C_SU = 2_593_442.982


@pytest.fixture(params=["optimise", "conditions"])
def loaded(request, monkeypatch):
    spec = importlib.util.spec_from_file_location(
        f"benchmark_{request.param}", ROOT / "benchmarks" / f"{request.param}.py"
    )
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, module)
    spec.loader.exec_module(module)
    return request.param, module


def test_the_competitor_has_the_margin_and_the_bounds_of_the_problem(loaded):
    name, module = loaded
    if name == "optimise":
        task = module.problem("decay_rate", "reciprocal")
        order, bounds = tuple(task.design.variables), module.bounds_of(task)
        negative_margin = module.margin_of(task)
    else:
        row = module.ROWS["15 conditions, C_s, K_m, C_m, decay rate"]
        task, order, bounds = row.task, row.variables, module.bounds_of(row)

        def negative_margin(x):
            return -module.worst_of(row, np.exp(x)[:, None], module.FINE)[0]

    high = {key: float(np.exp(top)) for key, (_, top) in zip(order, bounds, strict=True)}
    assert high == pytest.approx({"C_s": C_SU, "K_m": 6.2648e6, "C_m": 199_500.0})
    x = np.array([top - 0.3 * k - 0.5 for k, (_, top) in enumerate(bounds)])
    there = task.replace(**{key: float(value) for key, value in zip(order, np.exp(x), strict=True)})
    assert -float(negative_margin(x)) == pytest.approx(yd.stability(there).decay_rate, rel=1e-8)

"""Tapes: NumPy, compiled code and CasADi give the same bits."""

import casadi as ca
import numpy as np
import pytest

from yawdesign.hunting.boundary import routh_column
from yawdesign.hunting.many import counts, library_cache, tape
from yawdesign.hunting.many.recording import record
from yawdesign.hunting.many.tape import Tape
from yawdesign.vehicle.vehicle import Model


@pytest.fixture(autouse=True)
def own_cache(monkeypatch, tmp_path):
    """Compile into a folder of the test's own."""
    monkeypatch.setattr(library_cache, "cache_folder", lambda: tmp_path / "cache" / "0")


def arrays(p, n, seed=0, spread=2.0):
    rng = np.random.default_rng(seed)
    return {name: x * spread ** rng.uniform(-1, 1, n) for name, x in p.items()} | {
        "C_s": 10 ** rng.uniform(3, 8, n),
    }


def every_operation():
    x, y, z = (ca.SX.sym(name) for name in "xyz")
    outputs = [x + y, x - y, x * y, x / y, 1 / x, -x, x * x, 2 * x, ca.fabs(x - y), x < y, (x < y) * (y < z)]
    outputs += [(x < y) + (y < z), (x < y) - (y < z), (x < y) * z, ca.SX(0.1) * z, ca.SX(7)]
    return ca.Function("f", [x, y, z], [ca.vertcat(*outputs)], ["x", "y", "z"], ["out"])


@pytest.mark.parametrize("uniform", ["", "x", "xy", "yz"])
def test_every_operation_is_casadis(uniform):
    f, rng = every_operation(), np.random.default_rng(0)
    n = tape.BLOCK + 3
    values = {name: rng.normal(size=n) if name not in uniform else 0.7 for name in "xyz"}
    whole = [np.broadcast_to(values[name], n).reshape(1, -1) for name in "xyz"]
    expected = np.array(f.map(n)(*whole))
    assert np.array_equal(Tape(record(f))(values), expected)


def test_the_same_bits_three_ways(table1, monkeypatch):
    p, model = arrays(table1, 2 * tape.BLOCK + 5), Model()
    expected = counts.unstable_roots(model)(p)
    monkeypatch.setattr(tape, "MANY", 0)
    compiled_tape = counts.unstable_roots.__wrapped__(model)
    assert np.array_equal(compiled_tape(p), expected)
    assert compiled_tape._fast is not None, "there is a compiler on the machines that test this"
    names = tuple(table1)
    f = routh_column(model, names)
    for k in range(0, 200, 20):
        column = np.array(f([p[name][k] for name in names], p["C_s"][k])).ravel()
        assert np.sum(np.diff(np.sign(column)) != 0) == expected[0, k]


def test_an_operation_that_is_not_known():
    x = ca.SX.sym("x")
    with pytest.raises(NotImplementedError, match="no array operation"):
        record(ca.Function("f", [x], [ca.sin(x)], ["x"], ["y"]))


def test_what_is_there_twice_is_computed_once():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    outputs = [(x + y) * x, (x + y) * y, x * 0.1 + 0.0, -ca.SX(0.0), ca.SX(0.0)]
    one = Tape(record(ca.Function("f", [x, y], [ca.vertcat(*outputs)], ["x", "y"], ["out"])))
    assert len(one.steps) == len({(step.code, step.sources) for step in one.steps}) < 6
    assert one({"x": 2.0, "y": 3.0})[:3, 0].tolist() == [10.0, 15.0, 0.2]

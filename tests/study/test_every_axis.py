"""Every quantity over every axis that is allowed, one and two at a time, for both kinds of bogie, to the end."""

import warnings
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem import ProblemError
from yawdesign.problem.running import CURVE
from yawdesign.study import executors
from yawdesign.study import sweep as sweeps
from yawdesign.study.axes import ROWS
from yawdesign.study.request import QUANTITIES, request

PROBLEMS = Path(__file__).parents[2] / "problems"
BOGIES = {
    "power": yd.load(PROBLEMS / "table1.yaml"),
    "trailer": yd.load(PROBLEMS / "trailer-bogie.yaml").replace(C_s=1e6),
}
HOLDS = (None, "C_m", "xi_m")
EACH = [(kind, of) for kind in BOGIES for of in QUANTITIES]
# What cannot be asked, and nothing else: every other combination must come to its end.
REFUSED = (
    "is no axis of",
    "contradicts the axis",
    "cannot be held while",
    "is a number of the curve",
)


def allowed(kind):
    """Return the names of all axes that a bogie of some kind has."""
    own = BOGIES[kind].parameters()
    derived = [name for name in ROWS if name not in yd.PARAMETERS and not (kind == "trailer" and ROWS[name].motor)]
    return [*own, *derived]


def usual(kind, name):
    """Return two values of an axis around that of the problem."""
    known = {"v": 80.0, "f_m": 3.0, "xi_m": 0.3, "creep_factor": 0.9, **vars(yd.table1(kind).curve)}
    value = float(known[name] if name in known else BOGIES[kind].parameters()[name])
    return [value, 1.01 * value]


def grids(kind, of, number):
    """Yield all axes that may be asked together, with what is held."""
    for names in combinations(allowed(kind), number):
        axes = [(name, usual(kind, name)) for name in names]
        for hold in HOLDS if {"f_m", "M_m", "K_m"} & {*names} and kind == "power" else (None,):
            if not refusal(kind, of, axes, hold):
                yield axes, hold


def refusal(kind, of, axes, hold):
    """Return why a sweep cannot be asked for, which must be one of the known reasons."""
    try:
        request(BOGIES[kind], of, axes, hold)
    except ProblemError as error:
        reason = str(error)
        assert any(text in reason for text in REFUSED), (axes, hold, reason)
        return reason
    return ""


def check_to_the_end(kind, of, number):
    count = 0
    for axes, hold in grids(kind, of, number):
        result = sweeps.swept(BOGIES[kind], of, axes, hold=hold)
        assert result.finished.all(), axes
        assert result.values.shape == (2,) * number
        expected = expects_boundary(of, [name for name, _ in axes])
        assert (result.boundary is not None) == expected, (of, axes)
        if expected:
            assert result.boundary.finished.all()
            assert result.boundary.request.task.hold == result.request.task.hold
        count += 1
    return count


def expects_boundary(of, names):
    """Return whether a picture of the sweep shows all critical values over its other axis."""
    if of in ("C_sl", "design"):
        return len(names) == 1 and names[0] not in CURVE  # no critical value depends on the curve
    return of in ("stable", "decay_rate", "damping_ratio") and len(names) == 2 and "C_s" in names


@pytest.mark.parametrize(("kind", "of"), EACH)
@pytest.mark.slow
def test_one_axis(kind, of):
    assert check_to_the_end(kind, of, 1) >= (31 if kind == "power" else 22)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "of"), EACH)
def test_two_axes(kind, of):
    assert check_to_the_end(kind, of, 2) >= (350 if kind == "power" else 200)


@pytest.mark.parametrize("of", ["stable", "decay_rate", "damping_ratio"])
@pytest.mark.parametrize(("kind", "name"), [("trailer", "v"), ("power", "xi_m"), ("power", "C_m"), ("power", "f_m")])
def test_a_map_over_the_yaw_damping_has_its_critical_lines(kind, name, of):
    axes = [(name, usual(kind, name)), ("C_s", [1e5, 1e6])]
    result = sweeps.swept(BOGIES[kind], of, axes)
    alone = sweeps.swept(BOGIES[kind], "critical", axes[:1])
    assert result.boundary.main == pytest.approx(alone.main, rel=1e-12, nan_ok=True)
    assert [axis.name for axis in result.boundary.axes] == [name]


def test_the_critical_lines_hold_what_the_sweep_holds():
    default, damping, ratio = (
        sweeps.swept(BOGIES["power"], "C_sl", [("f_m", [2.0, 5.0])], hold=hold).boundary.main[:, 0] for hold in HOLDS
    )
    assert np.array_equal(default, damping)
    assert abs(ratio / damping - 1).min() > 1e-3


@pytest.mark.parametrize("error", [ValueError("of the lines"), MemoryError("too little")])
def test_a_fault_after_the_last_point_costs_the_lines_alone(monkeypatch, error):
    expected = sweeps.swept(BOGIES["power"], "C_sl", [("v", [70.0, 80.0])])
    computed = executors.answer

    def fails(task, *arguments):
        if task.question.of == "critical":
            raise error
        return computed(task, *arguments)

    monkeypatch.setattr(executors, "answer", fails)
    with pytest.warns(RuntimeWarning, match="the sweep itself is whole"):
        result = sweeps.swept(BOGIES["power"], "C_sl", [("v", [70.0, 80.0])])
    assert result.boundary is None
    assert np.array_equal(result.values, expected.values)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert sweeps.swept(BOGIES["power"], "C_sl", [("v", [70.0, 80.0])]).finished.all()


def test_a_stop_after_the_last_point_costs_none(monkeypatch):
    computed = executors.answer

    def stopped(task, *arguments):
        if task.question.of == "critical":
            raise KeyboardInterrupt
        return computed(task, *arguments)

    monkeypatch.setattr(executors, "answer", stopped)
    with pytest.raises(yd.IncompleteSweepError) as caught:
        sweeps.swept(BOGIES["power"], "C_sl", [("v", [70.0, 80.0])])
    assert caught.value.interrupted
    assert caught.value.result.finished.all()

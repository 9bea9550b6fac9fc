"""Every parameter that may be zero, alone and two at a time, through every command: an answer, or a clear message."""

import math
from itertools import combinations

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.exports.functions import self_test
from yawdesign.output.mode_tables import followed_tables, modes_tables
from yawdesign.output.response_tables import simulation_tables
from yawdesign.output.tables import design_tables, stability_tables
from yawdesign.problem.parameters import parameter_keys
from yawdesign.problem.table import field_name

MODELS = [("power", "reciprocal"), ("power", "as-printed"), ("trailer", "reciprocal")]
ALONE = [
    (kind, equations, (key,))
    for kind, equations in MODELS
    for key in parameter_keys(kind)
    if yd.PARAMETERS[key].hard[0] == 0
]
TWO = [
    (kind, equations, one + other)
    for kind, equations in MODELS
    for one, other in combinations([keys for k, e, keys in ALONE if (k, e) == (kind, equations)], 2)
]


def problem_of(kind, equations, keys):
    return yd.table1(kind, equations=equations).replace(**{field_name(key): 0 for key in keys})


def numbers(data):
    if isinstance(data, dict):
        data = list(data.values())
    if isinstance(data, (list, tuple)):
        return [x for entry in data for x in numbers(entry)]
    if isinstance(data, np.ndarray):
        return numbers(data.ravel().tolist())
    if isinstance(data, complex):
        return [data.real, data.imag]
    return [data] if isinstance(data, float) else []


def finite(result):
    """Return whether all numbers are finite; a design's intervals may end at infinity."""
    values = numbers({name: value for name, value in vars(result).items() if name != "histories"})
    return not any(map(math.isnan if isinstance(result, yd.ForwardDesign) else math.isinf, values)) and not any(
        map(math.isnan, values)
    )


def modes(problem):
    result = yd.modes(problem)
    assert modes_tables(result)
    assert result.stable is yd.stability(problem).stable
    shapes = [mode.shape for mode in result.modes]
    assert all(max(map(abs, shape.values())) == 0 or max(map(abs, shape.values())) > 0.1 for shape in shapes)
    return result


def stability(problem):
    result = yd.stability(problem)
    assert stability_tables(result)
    return result


def design(problem):
    result = yd.design(problem)
    assert design_tables(result)
    return result


def simulate(problem):
    result = yd.simulate(problem, duration="2 s")
    assert simulation_tables(result)
    return result


def released(problem):
    return yd.simulate(problem, "smooth", start="offset", duration="2 s")


def follow(problem):
    result = yd.follow_modes(problem, v=[60.0, 83.0])
    assert followed_tables(result)
    present = result.eigenvalues[~np.isnan(result.eigenvalues)]
    assert np.all(np.isfinite(present))
    return result


QUICK = [modes, stability, design, yd.frequency_response, yd.state_space]
LONGER = [simulate, released]


@pytest.mark.parametrize(
    "command",
    [*QUICK, *(pytest.param(command, marks=pytest.mark.slow) for command in LONGER)],
    ids=lambda command: command.__name__,
)
def test_each_zero(command):
    for kind, equations, keys in ALONE:
        assert finite(command(problem_of(kind, equations, keys))), (kind, equations, keys)


@pytest.mark.parametrize("which", MODELS, ids=" ".join)
def test_modes_are_followed_with_each_zero(which):
    for kind, equations, keys in ALONE:
        if (kind, equations) == which:
            assert follow(problem_of(kind, equations, keys)).evaluations < 2000, keys


@pytest.mark.parametrize("which", MODELS, ids=" ".join)
def test_stationary_motion_with_each_zero(which):
    for kind, equations, keys in ALONE:
        problem = problem_of(kind, equations, keys)
        if (kind, equations) != which:
            continue
        if yd.stability(problem).stable:
            assert finite(yd.stationary_response(problem)), keys
        else:
            with pytest.raises(yd.ProblemError, match="there is no stationary motion"):
                yd.stationary_response(problem)


@pytest.mark.parametrize("which", MODELS, ids=" ".join)
def test_modes_are_followed_from_each_zero(which):
    for kind, equations, (key,) in ALONE:
        if (kind, equations) != which:
            continue
        problem = yd.table1(kind, equations=equations)
        values = np.array([0, 0.5, 1]) * getattr(problem.bogie, field_name(key))
        if key in ("C_s", "C_t", "C_m"):
            with pytest.raises(yd.ProblemError, match="takes a damper out of the model"):
                yd.follow_modes(problem, **{key: values})
            continue
        paths = yd.follow_modes(problem, **{key: values})
        assert paths.evaluations < 2000, key
        own = {mode.name: mode.eigenvalue for mode in yd.modes(problem).modes}
        found = dict(zip(paths.names, paths.eigenvalues[-1], strict=True))
        assert [found[name] for name in own] == pytest.approx(list(own.values()), rel=1e-6, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("which", MODELS, ids=" ".join)
def test_functions_with_each_zero(which):
    """Signs say zero where a logarithm is infinite, and everything else is a number."""
    for kind, equations, keys in ALONE:
        if (kind, equations) != which:
            continue
        problem = problem_of(kind, equations, keys)
        found = yd.functions(problem, inputs=["v"])
        assert ("rotational_resistance" in found) == ("W" not in keys)
        for name, function in found.documented.items():
            test = self_test(function)
            assert test is not None or name == "critical_damping"
            for output, values in (test or {"outputs": {}})["outputs"].items():
                if "log10" not in output:
                    assert np.all(np.isfinite(values)), (keys, name, output)


@pytest.mark.parametrize("keys", [(), ("C_t",), ("C_m",), ("C_s",), ("C_m", "C_t"), ("b_0",), ("K_m",)], ids=str)
@pytest.mark.parametrize("equations", ["reciprocal", "as-printed"])
def test_hurwitz_minors_tell_stability_without_a_damper(keys, equations):
    problem = problem_of("power", equations, keys)
    function = yd.functions(problem, inputs=["v"], only=["hurwitz_minors"]).documented["hurwitz_minors"]
    signs = self_test(function)["outputs"]["sign"]
    assert all(sign == 1 for sign in signs) == yd.stability(problem).stable


def test_no_axle_load_has_no_rotational_resistance():
    problem = yd.table1().replace(W=0)
    assert "rotational_resistance" not in yd.functions(problem, inputs=["v"])
    assert "rotational_resistance" in yd.functions(problem)
    with pytest.raises(yd.ProblemError, match="axle load W is 0"):
        yd.functions(problem, inputs=["v"], only=["rotational_resistance"])


def test_dampers_at_the_centre():
    """With b_0 = 0 the lateral dampers never work against each other: a root of its own, in which no body moves."""
    problem = yd.table1().replace(b_0=0)
    result = yd.modes(problem)
    alone = next(mode for mode in result.modes if mode.name == "lateral damper relaxation, against each other")
    assert alone.eigenvalue == pytest.approx(-problem.bogie.K_dt / problem.bogie.C_t)
    assert not any(alone.shape.values())
    assert alone.participation["lateral damper 1"] == pytest.approx(0.5)
    assert result.checked


def test_a_motor_that_nothing_holds_stays_where_it_is():
    result = yd.modes(yd.table1().replace(K_m=0, C_m=0))
    free = [mode for mode in result.modes if mode.eigenvalue == 0]
    assert [mode.name.split(",")[0] for mode in free] == ["motor lateral"] * len(free)
    assert len({mode.name for mode in free}) == len(free) == 4
    for mode in free:
        assert abs(mode.shape["y_m1"]) == pytest.approx(1)
        assert abs(mode.shape["y_b"]) < 1e-9
    assert not result.stable


def test_a_frame_that_nothing_excites_is_verified():
    assert yd.simulate(yd.table1().replace(K_1y=0), duration="5 s").checked


@pytest.mark.slow
@pytest.mark.parametrize("command", [*QUICK, *LONGER, follow], ids=lambda command: command.__name__)
def test_every_two_zeros(command):
    for kind, equations, keys in TWO:
        result = command(problem_of(kind, equations, keys))
        if command is not follow:
            assert finite(result), (kind, equations, keys)


@pytest.mark.slow
def test_every_two_zeros_inside_an_fmu(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-compiler")
    for kind, equations, keys in TWO:
        yd.write_fmu(problem_of(kind, equations, keys), tmp_path / "bogie.fmu", replace=True)


@pytest.mark.slow
def test_each_zero_inside_an_fmu(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-compiler")
    for kind, equations, keys in ALONE:
        yd.write_fmu(problem_of(kind, equations, keys), tmp_path / "bogie.fmu", replace=True)

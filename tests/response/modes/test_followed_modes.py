"""Modes followed along a parameter: matrices whose roots are known, and bogies walked in both directions."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

import yawdesign as yd
from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.problem.parameters import parameter_keys
from yawdesign.problem.table import field_name
from yawdesign.response.modes.eigenvectors import spectrum
from yawdesign.response.modes.links import LOST, NEAR, PAIR, REAL, Place
from yawdesign.response.modes.paths import walk
from yawdesign.vehicle.vehicle import Model

# Near the largest decay rate over C_s, K_m and C_m (reciprocal), where two roots all but coincide.
NEARLY_ONE = {"C_s": 2593442.9824561398, "K_m": 1797736.679342566, "C_m": 94186.79555186098}


def places(matrix):
    return lambda value: Place(value, matrix(value), spectrum(matrix(value)))


def real_form(m):
    """Return the real matrix whose eigenvalues are those of a complex one and their conjugates."""
    return np.block([[m.real, -m.imag], [m.imag, m.real]])


def test_two_real_roots_become_a_pair_and_come_back():
    walked = walk(np.linspace(-1, 1, 4), places(lambda p: np.array([[0.0, p * p - 0.25], [1.0, 0.0]])))
    assert [e.kind for e in walked.encounters] == [PAIR, REAL]
    assert [0.5 * (e.low + e.high) for e in walked.encounters] == pytest.approx([-0.5, 0.5], abs=1e-8)
    assert walked.s[0] == pytest.approx(np.sqrt(0.75) * np.array([1, -1]))
    assert walked.s[-1] == pytest.approx(walked.s[0])
    middle = np.flatnonzero(np.abs(walked.values) < 0.4)
    assert np.all(walked.s[middle, 0].imag > 0)  # the larger real root is the one above the axis


@pytest.mark.parametrize("gap", [1e-1, 1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("points", [2, 3, 10])
def test_veering_roots_do_not_cross(gap, points):
    def matrix(p):
        return real_form(np.array([[-1 + 10j + 1j * p, 1j * gap], [1j * gap, -1 + 10j - 1j * p]]))

    walked = walk(np.linspace(-1, 1.1, points), places(matrix))
    above = walked.s[:, walked.s[0].imag > 0]
    assert np.ptp(np.sign(above[:, 0].imag - above[:, 1].imag)) == 0
    expected = 10 + np.sqrt(walked.values**2 + gap**2)
    assert above.imag.max(axis=1) == pytest.approx(expected)
    assert all(e.kind == NEAR for e in walked.encounters)
    assert len(walked.encounters) == (2 * gap < 1e-2)


@pytest.mark.parametrize("gap", [1e-1, 1e-4, 1e-6])
def test_roots_that_differ_in_damping_cross_in_frequency(gap):
    def matrix(p):  # coupled more weakly than their damping differs: frequencies cross, decay rates veer
        return real_form(np.array([[-1 - gap + 10j + 1j * p, gap / 2], [gap / 2, -1 + gap + 10j - 1j * p]]))

    walked = walk(np.linspace(-1, 1.1, 3), places(matrix))
    above = walked.s[:, walked.s[0].imag > 0]
    difference = above[:, 0].imag - above[:, 1].imag
    assert difference[0] * difference[-1] < 0
    assert np.all(np.abs(above[:, 0].real - above[:, 1].real) > gap)


def test_roots_that_coincide_are_said_to_be_lost():
    def matrix(p):
        return real_form(np.array([[-1 + 10j, 1.0], [p, -1 + 10j]], dtype=complex))

    walked = walk(np.array([-1.0, 1.0]), places(matrix))
    assert LOST in {e.kind for e in walked.encounters}
    assert walked.certainty.min() == 0


def test_a_motion_of_its_own_crosses_the_others():
    problem = yd.table1()
    values = np.geomspace(300, 4000, 23)
    paths = yd.follow_modes(problem, J_m=values)
    found = paths.eigenvalues[:, paths.names.index("motor yaw, against each other")]
    K, C = problem.bogie.K_mphi, problem.bogie.C_mphi
    assert found == pytest.approx(-C / (2 * values) + 1j * np.sqrt(K / values - (C / (2 * values)) ** 2))
    others = [k for k in range(len(paths.names)) if paths.names[k] != "motor yaw, against each other"]
    order = np.sign(paths.frequency[:, others] - found.imag[:, None] / (2 * np.pi))
    assert np.sum(np.ptp(order, axis=0) == 2) >= 3  # its frequency passes that of at least three other modes
    assert paths.checked


def ends(paths):
    pairs = zip(paths.eigenvalues[0], paths.eigenvalues[-1], strict=True)
    return sorted(pairs, key=lambda pair: (pair[0].imag, pair[0].real))


def test_a_near_coalescence_is_passed_the_same_way_on_every_grid():
    problem = yd.table1().replace(**NEARLY_ONE)
    s = np.array([mode.eigenvalue for mode in yd.modes(problem).modes])
    assert sorted(np.abs(s - s[1]))[1] < 1e-3  # the case is what it is meant to be
    K_m = NEARLY_ONE["K_m"]
    grids = [np.linspace(0.7, 1.3, n) * K_m for n in (2, 3, 14, 101)]
    walks = [yd.follow_modes(problem, K_m=grid) for grid in grids]
    for paths in walks:
        assert np.array(ends(paths)) == pytest.approx(np.array(ends(walks[0])), nan_ok=True)
        near = [meeting for meeting in paths.meetings if meeting.kind == NEAR]
        assert len(near) == 1
        assert near[0].distance < 1e-3
        assert near[0].low / K_m == pytest.approx(1, abs=1e-4)
        assert paths.checked


def test_paths_agree_with_a_walk_in_very_small_steps():
    problem = yd.table1(equations="as-printed")
    speeds = np.linspace(100, 400, 6001) / 3.6
    s = np.linalg.eigvals(state_matrix(Model.of(problem).at(problem.bogie.parameters(), v=speeds)))
    paths = yd.follow_modes(problem, v=speeds[[0, -1]])
    for name in ("wheelset hunting 1", "motor lateral 1", "motor lateral 2", "frame lateral"):
        at, last = paths.eigenvalues[:, paths.names.index(name)]
        for roots in s:
            at = roots[np.argmin(np.abs(roots - at))]
        assert at == pytest.approx(last)


def problem_of(p, model):
    keys = parameter_keys(model["kind"])
    given = {field_name(k): v for k, v in {**p, "C_s": 4e5}.items() if k in keys}
    return yd.Problem(bogie=yd.Bogie(kind=model["kind"], **given), speed=p["v"], equations=model["equations"])


@pytest.mark.slow
@given(seed=st.integers(0, 2**32 - 1), name=st.sampled_from(["C_s", "v", "K_m", "lambda", "J_m", "C_t", "a"]))
@settings(max_examples=25, deadline=None)
def test_a_path_backwards_is_the_same_path(random_bogies, seed, name):
    p, model = next(iter(random_bogies(1, seed=seed)))
    name = "C_s" if model["kind"] == "trailer" and name in ("K_m", "J_m") else name
    problem, values = problem_of(p, model), np.geomspace(0.4, 2.5, 6) * {**p, "C_s": 4e5}[name]
    there, back = (yd.follow_modes(problem, **{name: order}) for order in (values, values[::-1]))
    assert there.names == back.names
    assert there.eigenvalues == pytest.approx(back.eigenvalues[::-1], rel=1e-6, abs=1e-6, nan_ok=True)
    assert there.certainty == pytest.approx(back.certainty[::-1], abs=1e-3, nan_ok=True)
    assert len(set(there.names)) == len(there.names)
    for value, roots in zip(values, there.eigenvalues, strict=True):
        assert_all_roots(problem, name, value, roots)


def assert_all_roots(problem, name, value, roots):
    """Every root is one mode at each point, alone or with its conjugate, and each mode is there once."""
    vehicle = Model.of(problem).at({**problem.bogie.parameters(), "v": problem.speeds[0], name: value})
    expected = np.linalg.eigvals(state_matrix(vehicle))
    present = roots[~np.isnan(roots)]
    found = np.concatenate([present, present[present.imag > 0].conj()])
    assert len(found) == len(expected)
    cost = np.abs(found[:, None] - expected) / (1 + np.abs(expected))
    assert cost[linear_sum_assignment(cost)].max() < 1e-5  # a double root is known to half the digits


def test_the_number_of_modes_changes_at_the_meetings_only():
    paths = yd.follow_modes(yd.table1(), v=np.linspace(40, 300, 14) / 3.6)
    present = np.sum(~np.isnan(paths.eigenvalues), axis=1)
    for k, (low, high) in enumerate(pairwise(paths.values)):
        kinds = [m.kind for m in paths.meetings if low <= m.low <= high]
        assert present[k + 1] - present[k] == kinds.count(REAL) - kinds.count(PAIR)
    assert present[0] != present[-1]


def test_certainty_is_high_except_at_meetings():
    paths = yd.follow_modes(yd.table1(), C_s=np.geomspace(1e4, 5e6, 40))
    assert np.nanmin(paths.certainty) > 0.75
    assert paths.certainty.shape == (39, len(paths.names))
    unsure = np.argwhere(np.isnan(paths.certainty))
    assert {paths.names[k] for _, k in unsure} == {n for m in paths.meetings for n in m.modes}


def test_texts_with_units_and_plain_data():
    paths = yd.follow_modes(yd.table1(), v=["100 km/h", "200 km/h"])
    assert paths.values == pytest.approx([100 / 3.6, 200 / 3.6])
    assert paths.speed is None
    assert paths.C_s == 1e6
    data = yd.follow_modes(yd.table1(), v=[14.0, 60.0]).to_dict()
    assert [None, None] in data["eigenvalues"][0] + data["eigenvalues"][1]


@pytest.mark.parametrize(
    ("axis", "message"),
    [
        ({}, "along one parameter, not 0"),
        ({"v": [50, 60], "C_s": [1e5, 1e6]}, "along one parameter, not 2"),
        ({"K_mm": [1, 2]}, "did you mean K_m"),
        ({"C_s": [1e5, 1e6, 2e5]}, "all rising or all falling"),
        ({"C_s": [1e5]}, "at least two values"),
        ({"C_s": [0.0, 1e6]}, "takes a damper out"),
        ({"C_s": [-1.0, 1e6, "x"]}, r"C_s\[0\].*outside(.|\n)*C_s\[2\]"),
    ],
)
def test_wrong_axes(axis, message):
    with pytest.raises(yd.ProblemError, match=message):
        yd.follow_modes(yd.table1(), **axis)


def test_a_range_of_speeds_is_refused_unless_the_speed_varies():
    problem = yd.table1().replace(speed=yd.SpeedRange(min="200 km/h", max="300 km/h"))
    with pytest.raises(yd.ProblemError, match="followed at one speed"):
        yd.follow_modes(problem, C_s=[1e5, 1e6])
    assert yd.follow_modes(problem, v=[50, 60]).speed is None


def names_of(problem):
    return {mode.name: mode.eigenvalue for mode in yd.modes(problem).modes}


def assert_same_names(paths, k, named):
    """Every root at the place k of a path has the name that it has by itself."""
    assert len(named) == np.count_nonzero(~np.isnan(paths.eigenvalues[k]))
    for name, s in named.items():
        found = paths.eigenvalues[k, paths.names.index(name)]
        assert found == pytest.approx(s, rel=1e-6, abs=1e-6)


PATHS = ["v", *parameter_keys("power")]


QUICK_PATHS = ("v", "K_m", "C_s", "lambda", "b_0")


@pytest.mark.parametrize("name", [pytest.param(x, marks=() if x in QUICK_PATHS else pytest.mark.slow) for x in PATHS])
def test_a_root_has_one_name_however_it_is_followed(random_bogies, name):
    for p, model in random_bogies(8, seed=PATHS.index(name)):
        if name not in ("v", *parameter_keys(model["kind"])):
            continue
        problem = problem_of(p, model)
        own = {**p, "C_s": 4e5}[name]
        named = names_of(problem)
        for factors in ([0.8, 1, 1.25], [1, 1.6], [1.3, 1]):
            values = np.array(factors) * own
            assert_same_names(yd.follow_modes(problem, **{name: values}), factors.index(1), named)


@given(seed=st.integers(0, 2**32 - 1), name=st.sampled_from(PATHS))
@settings(max_examples=25, deadline=None)
@pytest.mark.slow
def test_the_part_of_an_axis_that_is_looked_at_changes_no_name(random_bogies, seed, name):
    p, model = next(iter(random_bogies(1, seed=seed)))
    name = "C_s" if name not in ("v", *parameter_keys(model["kind"])) else name
    problem, own = problem_of(p, model), {**p, "C_s": 4e5}[name]
    whole = yd.follow_modes(problem, **{name: np.array([0.7, 0.8, 1, 1.3, 1.5]) * own})
    if not whole.checked:
        return
    for part in ([0.7, 0.8], [1.5, 1.3]):  # away from the problem's own value, on either side of it
        paths = yd.follow_modes(problem, **{name: np.array(part) * own})
        k = int(np.flatnonzero(np.isclose(whole.values, paths.values[0]))[0])
        for mode, s in zip(paths.names, paths.eigenvalues[0], strict=True):
            if not np.isnan(s):
                assert whole.eigenvalues[k, whole.names.index(mode)] == pytest.approx(s, rel=1e-6, abs=1e-6)


def test_names_where_the_problem_has_no_value_of_its_own():
    values = [2e5, 1e6, 3e6]
    paths = yd.follow_modes(yd.table1().replace(C_s=None), C_s=values)
    assert_same_names(paths, 0, names_of(yd.table1().replace(C_s=2e5)))
    paths = yd.follow_modes(yd.table1().replace(C_s=0), C_s=values[::-1])
    assert_same_names(paths, 2, names_of(yd.table1().replace(C_s=2e5)))


def test_names_of_a_range_of_speeds_are_those_of_its_modes():
    problem = yd.table1().replace(speed=yd.SpeedRange(min="200 km/h", max="300 km/h"))
    result = yd.modes(problem)
    paths = yd.follow_modes(problem, v=[40.0, result.speed])
    assert_same_names(paths, 1, {mode.name: mode.eigenvalue for mode in result.modes})


def test_two_real_roots_of_a_pair_are_told_apart():
    problem = yd.table1().replace(C_m="1 kN s/m", C_s=1e5)
    paths = yd.follow_modes(problem, C_mphi=np.geomspace(11e3, 1e6, 9))
    pair = [name for name in paths.names if name.startswith("motor yaw, against each other")]
    assert sorted(pair) == ["motor yaw, against each other", "motor yaw, against each other, second root"]
    first, second = (paths.eigenvalues[-1, paths.names.index(name)] for name in sorted(pair, key=len))
    assert first.imag == second.imag == 0
    assert first.real > second.real
    assert np.isnan(paths.eigenvalues[0, paths.names.index(max(pair, key=len))])

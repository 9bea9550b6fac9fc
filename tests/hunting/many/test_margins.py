"""Margins and verdicts on levels, against eigenvalues and against the single route."""

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting.eigenvalues import MARGINS
from yawdesign.hunting.many import margins
from yawdesign.hunting.many.parameter_sets import ParameterSets
from yawdesign.hunting.verdict import stability_at
from yawdesign.vehicle.vehicle import Model

OBJECTIVES = ("decay_rate", "damping_ratio")
MOTORS = ("C_s", "C_m", "C_mphi")


def drawn(table1, model, n, seed, spread=2.0, low=0.0):
    """Return random bogies around Table I; with `low`, their dampers have less damping by up to so many decades."""
    rng = np.random.default_rng(seed)
    base = {name: table1[name] for name in model.parameters if name not in ("C_s", "v")}
    p = {name: x * spread ** rng.uniform(-1, 1, n) for name, x in base.items()}
    p |= {name: p[name] * 10 ** rng.uniform(-low, 0, n) for name in ("C_m", "C_t", "C_mphi") if name in p and low}
    return ParameterSets(model, p | {"v": rng.uniform(150, 450, n) / 3.6, "C_s": 10 ** rng.uniform(4, 7, n)}, n)


def variables(model):
    return MOTORS if model.kind == "power" else ("C_s",)


def by_eigenvalues(sets, objective):
    movable = sets.model.movable(variables(sets.model))
    s = [margins.eigenvalues(sets, motion) for motion in sets.model.motions if motion.name in movable]
    return MARGINS[objective](np.concatenate(s, axis=1))


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_margins_are_those_of_the_eigenvalues(table1, vehicle_model, objective):
    sets = drawn(table1, vehicle_model, 3000, seed=1)
    value, passed = margins.margins(sets, objective, variables(vehicle_model))
    expected = by_eigenvalues(sets, objective)
    assert np.mean(passed) > 0.999
    assert 0.2 < np.mean(expected < 0) < 0.8
    assert value[passed] == pytest.approx(expected[passed], rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_few_margins_are_left_to_the_eigenvalues(table1, vehicle_model, objective, monkeypatch):
    sets, left, every = drawn(table1, vehicle_model, 3000, seed=2, spread=1.3), [], margins.eigenvalues
    monkeypatch.setattr(margins, "eigenvalues", lambda part, motion: left.append(part.size) or every(part, motion))
    margins.margins(sets, objective, variables(vehicle_model))
    assert sum(left) < (0.02 if objective == "decay_rate" else 0.2) * sets.size


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_next_to_undamped_bogies(table1, vehicle_model, objective):
    sets = drawn(table1, vehicle_model, 150, seed=3, spread=3.0, low=8.0)
    value, passed = margins.margins(sets, objective, variables(vehicle_model))
    assert np.mean(passed) > 0.85
    for k in np.flatnonzero(passed):
        single = stability_at(sets.vehicle_at(k), variables(vehicle_model))
        if single.checked:
            assert value[k] == pytest.approx(getattr(single, objective), rel=2e-5, abs=1e-7)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_the_worst_mode_changes_along_an_axis(table1, objective):
    C_s = np.geomspace(5e5, 5e7, 4000)
    sets = ParameterSets(Model(), {**table1, "C_s": C_s}, len(C_s))
    value, passed = margins.margins(sets, objective, ("C_s",))
    assert passed.all()
    assert np.max(np.abs(value - by_eigenvalues(sets, objective))) < 1e-7


@pytest.mark.parametrize("apart", [1, 1j, 1 + 1j], ids=["in decay", "in frequency", "in both"])
def test_coalescing_roots_are_accurate_or_not_found(apart):
    distance = np.geomspace(1e-1, 1e-15, 60)
    others = np.array([-2.0, -0.5 + 3j, -0.5 - 3j])
    first = -0.02 + 0.3j
    rows = []
    for d in distance * apart:
        pairs = np.array([first, first - d])
        rows.append(np.poly([*pairs, *pairs.conj(), *others]).real[::-1])
    p = np.ascontiguousarray(np.array(rows).T)
    with np.errstate(all="ignore"):
        s, found = margins._slowest(p)
    assert found[:10].all() == (apart.real > 0)  # two modes of one decay rate are two
    assert np.abs(s[found].real - first.real).max(initial=0) < 2e-7
    assert not found[-10:].any()


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("level", [-0.5, 0.0, 0.01, 0.05, 1.0])
def test_levels(table1, vehicle_model, objective, level):
    sets = drawn(table1, vehicle_model, 3000, seed=4)
    exceeds, sure = margins.exceeds(sets, objective, level, variables(vehicle_model))
    expected = by_eigenvalues(sets, objective)
    floor = max(level, 0.0) if objective == "damping_ratio" else level
    assert np.mean(sure) > 0.995
    assert np.array_equal(exceeds[sure], (expected > floor)[sure])


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_a_level_for_each(table1, objective):
    sets = drawn(table1, Model(), 500, seed=5)
    expected = by_eigenvalues(sets, objective)
    good = expected > 0
    for factor in (0.999, 1.001):
        exceeds, sure = margins.exceeds(sets, objective, np.where(good, expected * factor, 0.0), MOTORS)
        assert np.mean(sure) > 0.95
        assert np.array_equal(exceeds[sure], (good & (factor < 1))[sure])


def test_a_level_at_the_margin_is_doubted(table1):
    sets = ParameterSets(Model(), {**table1, "C_s": 1e6}, 1)
    (value,), _ = margins.margins(sets, "decay_rate", ("C_s",))
    assert not margins.exceeds(sets, "decay_rate", value, ("C_s",))[1].any()


def test_stable_and_what_no_yaw_damper_reaches(table1, vehicle_model):
    sets = drawn(table1, vehicle_model, 2000, seed=6)
    stable, sure = margins.stable(sets)
    every = [margins.eigenvalues(sets, motion) for motion in vehicle_model.motions]
    assert sure.all()
    assert np.array_equal(stable, np.all([s.real.max(axis=1) < 0 for s in every], axis=0))
    others, sure = margins.others_stable(sets)
    assert (sure & others).all()


@pytest.mark.parametrize("equations", ["as-printed", "reciprocal"])
@pytest.mark.parametrize("C_mphi", [0.0, np.array([0.0, 1e4, 0.0])], ids=["everywhere", "at some"])
def test_undamped_motors_are_sure(table1, equations, C_mphi):
    sets = ParameterSets(Model(equations=equations), {**table1, "C_s": 1e6, "C_mphi": C_mphi}, 3)
    damped = np.broadcast_to(C_mphi, 3) > 0
    asked = [margins.stable(sets), margins.others_stable(sets)]
    asked += [margins.exceeds(sets, objective, 0.001, MOTORS) for objective in OBJECTIVES]
    for yes, sure in asked:
        assert sure.all()
        assert np.array_equal(yes, damped)
    for objective in OBJECTIVES:
        value, passed = margins.margins(sets, objective, MOTORS)
        assert passed.all()
        assert np.array_equal(value > 0, damped)
        assert not value[~damped].any()


def test_a_damper_without_damping_at_some_points_is_left_to_the_single_route(table1):
    sets = ParameterSets(Model(), {**table1, "C_s": 1e6, "C_t": np.array([0.0, 6e4])}, 2)
    for objective in OBJECTIVES:
        assert margins.margins(sets, objective, ("C_s",))[1].tolist() == [False, True]
    everywhere = ParameterSets(Model(), {**table1, "C_s": 1e6, "C_t": 0.0}, 1)
    (value,), (passed,) = margins.margins(everywhere, "decay_rate", ("C_s",))
    assert passed
    assert value == pytest.approx(stability_at(everywhere.vehicle_at(0)).decay_rate, rel=1e-9)


def test_no_number_is_no_margin(table1):
    sets = ParameterSets(Model(), {**table1, "C_s": 1e6, "f_11": np.array([np.nan, 1e7])}, 2)
    assert margins.margins(sets, "decay_rate", ("C_s",))[1].tolist() == [False, True]
    assert margins.exceeds(sets, "decay_rate", 0.0, ("C_s",))[1].tolist() == [False, True]


def test_more_than_one_pair_of_unstable_roots(table1):
    sets = drawn(table1, Model(), 4000, seed=7, spread=3.0)
    s = margins.eigenvalues(sets, sets.model.motions[0])
    chosen = np.flatnonzero(np.sum(s.real > 0, axis=1) > 2)
    assert len(chosen) > 50
    value, passed = margins.margins(sets.part(chosen), "damping_ratio", ("C_s",))
    assert passed.all()
    assert value == pytest.approx(MARGINS["damping_ratio"](s[chosen]), rel=1e-6)


BODY = {"M_c": 34500.0, "J_c": 1.521e6, "I_c": 124304.0, "l_c": 9.5, "h_s": 0.852, "h_t": 0.97, "K_2z": 610e3}
BODY |= {"C_2z": 9800.0}


@pytest.fixture(scope="module", params=["power", "trailer"])
def vehicles(request):
    """Return random vehicles with a car body on two bogies."""
    one = Model(request.param)
    p = yd.table1().bogie.parameters()
    values = {name: float(x) for name, x in p.items() if name in one.parameters} | BODY | {"v": 300 / 3.6}
    model = Model(request.param, parameters=(*one.parameters, *BODY))
    return drawn(values, model, 300, seed=8, spread=1.3)


@pytest.mark.parametrize("pairs", [0, 1, 2])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_margins_of_vehicles(vehicles, objective, pairs):
    value, passed = margins.margins(vehicles, objective, ("C_s",), pairs)
    expected = without_worst(vehicles, objective, pairs)
    assert np.mean(passed) > 0.99
    assert value[passed] == pytest.approx(expected[passed], rel=2e-8, abs=1e-9)


@pytest.mark.parametrize("pairs", [0, 1, 2])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_levels_of_vehicles(vehicles, objective, pairs):
    expected = without_worst(vehicles, objective, pairs)
    is_stable = without_worst(vehicles, "decay_rate", 0) > 0
    assert 0.2 < np.mean(is_stable) < 0.9
    apart = [np.maximum(0.0, expected * factor) for factor in (1.001, 0.999)]
    for level in (0.0, 0.5 if objective == "decay_rate" else 0.03, *apart):
        exceeds, sure = margins.exceeds(vehicles, objective, level, ("C_s",), pairs)
        assert np.mean(sure[is_stable]) > 0.9
        assert np.array_equal(exceeds[sure], (expected > level)[sure])


def without_worst(sets, objective, pairs):
    """Return margins from eigenvalues sorted, with the worst pairs left out."""
    s = margins.eigenvalues(sets, sets.model.motions[0])
    if objective == "decay_rate":
        return np.sort(-s.real, axis=1)[:, 2 * pairs]
    upper = np.where(s.imag < 0, np.inf, -s.real / np.abs(s))
    return np.sort(upper, axis=1)[:, pairs]


@pytest.mark.parametrize("pairs", [1, 2])
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_the_next_margin_over_several_motions(table1, objective, pairs):
    sets = drawn(table1, Model(), 1000, seed=9, spread=1.5, low=2.0)
    s = np.concatenate([margins.eigenvalues(sets, motion) for motion in sets.model.motions], axis=1)
    each = -s.real if objective == "decay_rate" else np.where(s.imag < 0, np.inf, -s.real / np.abs(s))
    rank = pairs * (2 if objective == "decay_rate" else 1)
    expected = np.sort(each, axis=1)[:, rank]
    assert np.mean(expected != np.sort(each[:, :-2], axis=1)[:, rank]) > 0.01, "the motors' yaw is among them"
    value, passed = margins.margins(sets, objective, MOTORS, pairs)
    assert np.mean(passed) > 0.99
    assert value[passed] == pytest.approx(expected[passed], rel=1e-6, abs=1e-8)
    exceeds, sure = margins.exceeds(sets, objective, 0.02, MOTORS, pairs)
    assert np.mean(sure[s.real.max(axis=1) < 0]) > 0.95
    assert np.array_equal(exceeds[sure], (expected > 0.02)[sure])


def test_a_pair_that_is_unstable_and_its_conjugate_are_not_taken_for_two(table1):
    # The ray at level zeta has beyond it the conjugate of a root damped less than -zeta: two roots, but one pair.
    sets = drawn(table1, Model(), 3000, seed=10, spread=2.0)
    s = margins.eigenvalues(sets, sets.model.motions[0])
    worst = np.min(-s.real / np.abs(s), axis=1)
    doubtful = (np.sum(s.real > 0, axis=1) == 2) & (worst < -0.05)
    chosen = sets.part(np.flatnonzero(doubtful))
    assert chosen.size > 10
    exceeds, sure = margins.exceeds(chosen, "damping_ratio", 0.01, ("C_s",), 1)
    expected = np.sort(np.where(s.imag < 0, np.inf, -s.real / np.abs(s)), axis=1)[doubtful, 1] > 0.01
    assert np.array_equal(exceeds[sure], expected[sure])
    assert not sure[expected].any()


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_more_pairs_than_there_are(table1, objective):
    sets = ParameterSets(Model(), {**table1, "C_s": 1e6}, 1)
    assert margins.exceeds(sets, objective, 0.01, ("C_s",), 30)[0].all()

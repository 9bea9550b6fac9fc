"""Critical speeds, against the eigenvalue problem that has all of them."""

import numpy as np
import pytest
import scipy.linalg

from yawdesign.hunting.old import core_eigenvalues, core_matrix
from yawdesign.study.answers import evaluate
from yawdesign.study.question import SEARCHED, Question


def all_critical_speeds(p, C_s, model):
    """Return every speed at which the sum of two eigenvalues is zero and they lie on the imaginary axis.

    The state matrix is A0 + A1/v, and its Kronecker sum with itself is singular exactly at such speeds.
    """
    slow, fast = (core_matrix(p | {"v": v}, C_s, **model) for v in (1.0, 2.0))
    A1 = 2 * (slow - fast)
    A0 = slow - A1
    one = np.eye(len(A0))
    sums = [np.kron(A, one) + np.kron(one, A) for A in (A0, A1)]
    with np.errstate(all="ignore"):
        inverse = scipy.linalg.eigvals(sums[0], -sums[1])
        candidates = 1 / inverse.real[np.isfinite(inverse) & (np.abs(inverse.imag) < 1e-6 * np.abs(inverse))]
    inside = np.sort(candidates[(candidates > SEARCHED[0]) & (candidates < SEARCHED[1])])
    s = [core_eigenvalues(p | {"v": v}, C_s, **model) for v in inside]
    on_axis = [np.min(np.abs(x.real) / np.maximum(1, np.abs(x))) < 1e-5 for x in s]
    speeds = inside[np.array(on_axis, dtype=bool)]
    return speeds[np.concatenate([[True], np.diff(speeds) > 1e-5 * speeds[1:]])] if len(speeds) else speeds


def found(p, C_s, model):
    p = {name: x for name, x in p.items() if name != "v"} | {"C_s": C_s}
    answers = evaluate(Question("critical_speed", model["kind"], model["equations"], SEARCHED), p)
    assert not answers.unverified.any()
    speeds = answers.columns["critical_speed"][0]
    return speeds[~np.isnan(speeds)], answers.columns


def test_trailers_have_all_their_critical_speeds(random_bogies):
    model, several = {"kind": "trailer", "equations": "reciprocal"}, 0
    for k, (p, _) in enumerate(random_bogies(12, seed=8, spread=2.0)):
        p.pop("v")
        C_s = 10 ** (4 + k / 4)
        speeds, _ = found(p, C_s, model)
        assert speeds == pytest.approx(all_critical_speeds(p, C_s, model), rel=1e-6)
        several += len(speeds)
    assert several > 5


def test_a_power_bogie(table1):
    model = {"kind": "power", "equations": "as-printed"}
    p = {name: x for name, x in table1.items() if name != "v"}
    speeds, columns = found(p, 1e5, model)
    assert speeds == pytest.approx(all_critical_speeds(p, 1e5, model), rel=1e-6)
    assert columns["unstable_roots"][0].tolist() == [0, 2]


def test_the_critical_speed_at_the_critical_damping_is_the_speed(table1):
    model = {"kind": "power", "equations": "as-printed"}
    p = {name: x for name, x in table1.items() if name != "v"}
    speeds, columns = found(p, 90702.8897786979, model)
    assert speeds == pytest.approx([300 / 3.6], rel=1e-8)
    assert columns["omega"][0] == pytest.approx([23.15473658], rel=1e-7)


def test_the_range_of_the_problem_is_searched(table1):
    asked = Question("critical_speed", "power", "as-printed", (200 / 3.6, 290 / 3.6))
    p = {name: x for name, x in table1.items() if name != "v"} | {"C_s": np.array([1e4, 90702.0])}
    assert evaluate(asked, p).columns["count"].tolist() == [1, 0]


# Unstable from 219.72 to 221.12 km/h: two changes that undo each other within one of the 2.46 km/h that are looked at.
NARROW = {
    "M_b": 9039.58, "J_b": 9902.78, "M_w": 2217.15, "J_w": 2202.6, "M_m": 1617.43, "J_m": 1261.39, "W": 185130,
    "K_1x": 49286400, "K_1y": 5213830, "K_2x": 931438, "K_2y": 675889, "K_m": 489176, "K_mphi": 333243,
    "K_ds": 29312600, "K_dt": 33808300, "K_dm": 33011400, "C_t": 65410.1, "C_mphi": 16413.4, "C_m": 28991.4,
    "a": 1.5399, "b": 0.91796, "a_0": 1.00365, "b_0": 0.420661, "b_1": 0.811462, "b_2": 1.27891, "b_3": 0.916541,
    "r": 0.748269, "lambda": 0.5, "f_11": 8008740, "f_22": 10645000,
}  # fmt: skip
RECIPROCAL = {"kind": "power", "equations": "reciprocal"}


def test_two_changes_that_undo_each_other():
    speeds, columns = found(NARROW, 117280.942, RECIPROCAL)
    assert speeds[:2] * 3.6 == pytest.approx([219.724254, 221.119203], abs=1e-6)
    assert columns["unstable_roots"][0][:3].tolist() == [0, 2, 0]


@pytest.mark.parametrize("more", [0.0, 10.0, 20.0, 24.0, 30.0, 100.0])
@pytest.mark.slow
def test_ever_narrower_intervals(more):
    # With more damping the unstable interval shrinks; the largest real part between its ends tells whether it is there.
    C_s = 117280.942 + more
    v = np.linspace(219, 222, 6001) / 3.6
    unstable = core_eigenvalues({**NARROW, "v": v}, C_s, **RECIPROCAL).real.max(axis=1) > 0
    speeds, _ = found(NARROW, C_s, RECIPROCAL)
    within = speeds[(speeds > v[0]) & (speeds < v[-1])]
    if unstable.any():
        expected = [v[unstable][0], v[unstable][-1]]
        assert within == pytest.approx(expected, abs=2e-4)
    else:
        assert not len(within)


@pytest.mark.slow
def test_no_change_is_missed_between_the_speeds(random_bogies):
    several, v = 0, np.linspace(*SEARCHED, 4001)
    rng = np.random.default_rng(6)
    for p, model in random_bogies(60, seed=9):
        C_s = 10 ** rng.uniform(4, 7)
        speeds, _ = found(p, C_s, model)
        s = core_eigenvalues({**p, "v": v}, C_s, **model)
        counts = np.sum(s.real > 0, axis=1)
        changes = np.flatnonzero(np.diff(counts))
        # Whatever the dense look sees was found; what was found and not seen must be a pair between two of its speeds.
        for k in changes:
            assert np.any((speeds >= v[k]) & (speeds <= v[k + 1]))
        places = np.searchsorted(v, speeds)
        assert all(k - 1 in changes or np.sum(places == k) % 2 == 0 for k in places)
        several += len(speeds)
    assert several > 40


@pytest.mark.slow
def test_several_changes_in_one_cell(random_bogies, monkeypatch):
    model, found_two = {"kind": "power", "equations": "as-printed"}, 0
    for p, _ in random_bogies(25, seed=5, spread=2.0):
        many, columns = found(p, 1e5, model)
        counts = columns["unstable_roots"][0]
        if counts[~np.isnan(counts)].tolist() == [0, 2, 4]:
            with monkeypatch.context() as coarse:
                coarse.setattr("yawdesign.study.speeds.SPEEDS", 1)
                few, _ = found(p, 1e5, model)
            assert few == pytest.approx(many, rel=1e-8)
            found_two += 1
    assert found_two > 1

"""Stationary root mean squares: integral over the spectrum, Lyapunov equation, and a long run."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_lyapunov

import yawdesign as yd
from yawdesign.problem.parameters import CarBody
from yawdesign.response.run.system import system_at
from yawdesign.response.track.spectra import SPECTRA

PROBLEM = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")


def filters(which, v):
    """Return a, b, c of the filter that makes white noise of intensity 1 into the German low irregularity."""
    W_c, W_r, W_s = 0.8246, 0.0206, 0.4380
    corners = [v * W_c, v * W_r] + ([v * W_s] if which == "cross_level" else [])
    roughness = {"alignment": 2.119e-7, "cross_level": 4.032e-7 / 0.75**2}[which]
    # One-sided density of white noise of intensity 1 is 1/pi per rad/s; that of the track S(w/v)/v.
    gain = np.sqrt(np.pi * roughness * W_c**2 * v**3)
    n = len(corners)
    a = np.diag(-np.array(corners)) + np.diag(np.ones(n - 1), 1)  # a chain of 1 / (s + corner)
    b = np.eye(n)[-1]
    c = np.zeros(n)
    c[0] = 1.0
    return a, b, gain * (c if which == "alignment" else a[0])  # s / (s + corner) is the rate of the first one


def by_lyapunov(system, which):
    """Return the root mean square of all states under noise that comes to each wheelset with its lag.

    With a copy of the filter for each wheelset, driven by w(t - lag): A P + P A' + sum of Bk Bk' + sum over all pairs
    of e^(A (lag l - lag k)) Bk Bl' and its transpose, k the earlier one, is 0.
    """
    a, b, c = filters(which, system.v)
    lags = system.wheelsets.lags
    n, m = len(system.A), len(a)
    column = ["alignment", "cross_level"].index(which)
    A = np.zeros((n + len(lags) * m, n + len(lags) * m))
    A[:n, :n] = system.A
    B = np.zeros((len(lags), len(A), 1))
    for k in range(len(lags)):
        own = slice(n + k * m, n + (k + 1) * m)
        A[:n, own] = np.outer(system.B[:, column + 2 * k], c)
        A[own, own] = a
        B[k, own, 0] = b
    source = sum(Bk @ Bk.T for Bk in B)
    for k, earlier in enumerate(lags):
        for l in range(k + 1, len(lags)):  # noqa: E741
            cross = expm(A * (lags[l] - earlier)) @ B[k] @ B[l].T
            source = source + cross + cross.T
    P = solve_continuous_lyapunov(A, -source)
    return np.sqrt(np.diag(P)[:n])


@pytest.mark.parametrize("kmh", [200, 300])
@pytest.mark.parametrize("which", ["alignment", "cross_level"])
def test_spectrum_and_lyapunov(kmh, which):
    system = system_at(PROBLEM, kmh / 3.6)
    whole = yd.RandomTrack(SPECTRA["german-low"], yd.Band(1e-5, 1e4))
    rms = yd.stationary_response(PROBLEM, whole, speed=kmh / 3.6).rms_of[which]
    expected = by_lyapunov(system, which)
    for k, name in enumerate(system.coordinates):
        assert rms[name] == pytest.approx(expected[k], rel=1e-4)


@pytest.mark.parametrize("which", ["alignment", "cross_level"])
def test_spectrum_and_lyapunov_of_four_wheelsets(which):
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    problem = replace(yd.table1().replace(C_s="1 MN s/m"), car_body=body)
    system = system_at(problem, problem.speeds[0])
    assert system.wheelsets.lags == pytest.approx(np.array([0, 2.5, 19, 21.5]) / system.v)
    whole = yd.RandomTrack(SPECTRA["german-low"], yd.Band(1e-5, 1e4))
    rms = yd.stationary_response(problem, whole).rms_of[which]
    expected = by_lyapunov(system, which)
    for name, size in zip(system.space.states, expected, strict=True):
        if name in rms:
            assert rms[name] == pytest.approx(size, rel=1e-3), name


@pytest.mark.slow
def test_spectrum_and_a_long_run():
    run = yd.simulate(PROBLEM, duration=300).runs[0]
    for name, expected in yd.stationary_response(PROBLEM).rms.items():
        assert run.rms[name] == pytest.approx(expected, rel=0.01)
    assert run.rms_stationary == pytest.approx(yd.stationary_response(PROBLEM).rms, rel=1e-9)


def test_near_the_stability_boundary_the_resonance_is_not_missed():
    """A mode with a damping of 2e-5 is a peak a thousandth of a hertz wide."""
    problem = PROBLEM.replace(C_s=90_710)
    system = system_at(problem, problem.speeds[0])
    whole = yd.RandomTrack(SPECTRA["german-low"], yd.Band(1e-5, 1e4))
    rms = yd.stationary_response(problem, whole).rms_of["alignment"]["y_b"]
    assert rms == pytest.approx(by_lyapunov(system, "alignment")[0], rel=1e-3)


def test_squares_add_up():
    result = yd.stationary_response(PROBLEM, "german-high", speed="250 km/h")
    for name, rms in result.rms.items():
        parts = [result.rms_of[which][name] for which in ("alignment", "cross_level")]
        assert rms == pytest.approx(np.hypot(*parts))
    assert result.to_dict()["method"] == "integral over the spectrum"


def test_what_has_no_stationary_motion():
    with pytest.raises(yd.ProblemError, match="unstable at 300 km/h"):
        yd.stationary_response(PROBLEM.replace(C_s=5e4))
    with pytest.raises(yd.ProblemError, match="harmonic is not random"):
        yd.stationary_response(PROBLEM, "harmonic")

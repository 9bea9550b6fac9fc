"""Steps through time: exact for straight inputs, exact for harmonics, and never too coarse."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import cont2discrete

import yawdesign as yd
from yawdesign.response.run.system import system_at
from yawdesign.response.run.time_steps import clock_of, fastest_motion, first_order_hold, forced, march, settled


@pytest.fixture(scope="module")
def system():
    return system_at(yd.table1().replace(C_s="1 MN s/m"), 80.0)


def test_hold_is_that_of_scipy(system):
    """SciPy moves the input into the state, x' = x + after u; its matrices are the same otherwise."""
    h = 0.01
    hold = first_order_hold(system.A, system.B, h)
    C = np.eye(len(system.A))
    Phi, B, _, D, _ = cont2discrete((system.A, system.B, C, np.zeros_like(system.B)), h, method="foh")
    assert hold.transition == pytest.approx(Phi, rel=1e-9, abs=1e-9)
    assert hold.after == pytest.approx(D, rel=1e-9, abs=1e-12)
    assert hold.transition @ hold.after + hold.before == pytest.approx(B, rel=1e-9, abs=1e-9)


def test_straight_inputs_are_followed_exactly(system):
    """Ten coarse steps of an input with corners, against an integrator of high order."""
    corners = np.random.default_rng(2).normal(size=(11, 4)) * 1e-3
    hold = first_order_hold(system.A, system.B, 0.05)
    x = march(hold.transition, forced(hold, corners), np.zeros(len(system.A)))
    y = np.zeros(len(system.A))
    for k in range(10):

        def rate(t, y, k=k):
            return system.A @ y + system.B @ (corners[k] + (corners[k + 1] - corners[k]) * t / 0.05)

        y = solve_ivp(rate, (0, 0.05), y, method="Radau", rtol=1e-9, atol=1e-13, jac=system.A).y[:, -1]
    assert x[-1] == pytest.approx(y, rel=1e-6, abs=1e-9)


def test_static_equilibrium(system):
    hold = first_order_hold(system.A, system.B, 0.02)
    u = np.tile([1e-3, 2e-3, 1e-3, 2e-3], (2, 1))
    rest = -np.linalg.solve(system.A, system.B @ u[0])
    assert settled(hold.transition, forced(hold, u)) == pytest.approx(rest, rel=1e-8, abs=1e-12)


@pytest.mark.parametrize("start", ["rest", "offset"])
@pytest.mark.parametrize("which", ["alignment", "cross_level"])
def test_a_sinusoid_settles_on_the_frequency_response(start, which):
    problem = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")
    history = yd.simulate(problem, yd.Harmonic("20 m", 1e-3, which), start=start, duration=20, step="2 ms").histories[0]
    expected = yd.frequency_response(problem, 20, which)
    turn = np.exp(2j * np.pi * expected.frequency * history.time)
    late = history.time > 15
    for name in ("y_b", "phi_b", "y_w1", "phi_w2", "y_m1"):
        amplitude = getattr(expected, name)
        exact = (1e-3 * amplitude * turn).real
        assert np.max(np.abs(history[name] - exact)[late]) < 1e-6 * 1e-3 * abs(amplitude)


def test_a_stationary_start_has_no_transient():
    problem = yd.table1()
    history = yd.simulate(problem, yd.Harmonic("30 m", "1 mm"), duration=1).histories[0]
    expected = yd.frequency_response(problem, 30)
    turn = np.exp(2j * np.pi * expected.frequency * history.time)
    assert history["y_b"] == pytest.approx(1e-3 * (expected.y_b * turn).real, abs=1e-12)


def test_accelerations_are_the_slopes_of_velocities():
    history = yd.simulate(yd.table1(), duration=2, step="0.1 ms").histories[0]
    for name, rate in (("y_b", "y_b_velocity"), ("phi_w1_velocity", "phi_w1_acceleration")):
        slope = np.gradient(history[name], history.time)
        assert slope[1:-1] == pytest.approx(history[rate][1:-1], abs=2e-3 * np.abs(history[rate]).max())


def test_a_coarse_step_is_refused():
    problem = yd.table1()
    fastest = fastest_motion(system_at(problem, problem.speeds[0]))
    with pytest.raises(yd.ProblemError, match=r"0\.05 s is too coarse: the bogie moves at"):
        yd.simulate(problem, "smooth", step=0.05)
    with pytest.raises(yd.ProblemError, match=r"the track moves at 40 Hz, which takes 0\.0025 s or less"):
        yd.simulate(problem, step=0.003)
    assert yd.simulate(problem, "smooth", start="offset", duration=2, step=1 / (10 * fastest)).checked


def test_a_stiff_bogie_takes_finer_steps_by_itself():
    problem = yd.table1().replace(K_1y="6 GN/m")
    run = yd.simulate(problem, duration="2 s").runs[0]
    assert run.step < 1e-3
    assert run.checked
    with pytest.raises(yd.ProblemError, match="steps"):
        yd.simulate(problem, duration="1e6 s")
    with pytest.raises(yd.ProblemError, match="run for longer"):
        yd.simulate(problem, "smooth", duration="1 ms")


def test_the_last_instant_is_the_end():
    clock = clock_of(1.0, 0.3e-2)
    assert clock.steps % 2 == 0
    assert clock.time[-1] == pytest.approx(1.0)
    assert clock.step <= 0.3e-2

"""Closed forms of wheelset and bogie hunting, with our elements put together to the textbook vehicle.

A single wheelset on springs to the ground: Wickens, Fundamentals of Rail Vehicle Dynamics. Klingel's wavelength of a
free wheelset, and that of two wheelsets in a rigid frame.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from yawdesign.hunting.eigenvalues import dense, motion_eigenvalues
from yawdesign.vehicle.elements import Link, Mass, Spring, WheelRailContact
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Model

# m, I, k_y, k_psi, f_11, f_22, b, lambda, r, W; then the critical frequency [Hz] and speed [m/s]
PAPER_LIKE = {"m": 3085.0, "I": 2024.0, "k_y": 1e6, "k_psi": 1.21e6, "f_11": 11.511e6, "f_22": 11.511e6, "b": 0.7465}
PAPER_LIKE |= {"lambda": 0.15, "r": 0.625, "W": 0.0}
SMALL = {"m": 1000.0, "I": 600.0, "k_y": 1e5, "k_psi": 2e5, "f_11": 1e7, "f_22": 8e6, "b": 0.75, "lambda": 0.1}
SMALL |= {"r": 0.46, "W": 0.0}


def wheelset(q, v):
    contact = (q[name] for name in ("W", "lambda", "b", "r", "f_11", "f_22"))
    return [
        Mass("y", q["m"]),
        Mass("phi", q["I"]),
        WheelRailContact("y", "phi", *contact, v),
        Link((Spring(q["k_y"]),), {"y": 1}),
        Link((Spring(q["k_psi"]),), {"phi": 1}),
    ]


def modes(elements):
    system = StateSpace(elements)
    return np.linalg.eigvals(dense(system.A, system.size))


def critical_speed(of_speed, low, high):
    """Return the speed at which the least damped mode stops being damped, and its angular frequency."""
    v = brentq(lambda v: float(np.max(of_speed(v).real)), low, high, xtol=1e-12, rtol=1e-14)
    s = of_speed(v)
    return v, abs(s[np.argmax(s.real)].imag)


def closed_form(q):
    """Return the square of the critical frequency and of the speed; the latter is negative if there is none."""
    gravity = q["W"] * q["lambda"]
    k_y, k_psi, f_11, f_22, b = q["k_y"] + gravity / q["b"], q["k_psi"] - gravity * q["b"], q["f_11"], q["f_22"], q["b"]
    w2 = (f_11 * k_psi + f_22 * b**2 * k_y) / (f_11 * q["I"] + f_22 * b**2 * q["m"])
    below = 4 * f_11 * f_22 * b * q["lambda"] / q["r"] + (k_y - q["m"] * w2) * (k_psi - q["I"] * w2)
    return w2, 4 * f_11 * f_22 * b**2 * w2 / below


@pytest.mark.parametrize(
    ("q", "hertz", "speed"),
    [
        (PAPER_LIKE, 3.458213, 138.0413 / 3.6),
        ({**PAPER_LIKE, "W": 2e5}, None, 138.0271 / 3.6),
        (SMALL, 2.431132, 28.374697),
    ],
)
def test_single_wheelset(q, hertz, speed):
    v, omega = critical_speed(lambda v: modes(wheelset(q, v)), 5.0, 100.0)
    w2, v2 = closed_form(q)
    assert (v, omega) == pytest.approx((math.sqrt(v2), math.sqrt(w2)), rel=1e-9)
    assert v == pytest.approx(speed, rel=5e-7)
    if hertz:
        assert omega / (2 * math.pi) == pytest.approx(hertz, rel=5e-7)


def test_bogie_on_an_immovable_frame_is_a_single_wheelset(table1):
    rigid = dict.fromkeys(("M_b", "J_b", "K_2x", "K_2y"), 1e15)
    p = {**table1, **rigid, "K_1x": 1.21e6 / table1["b_1"] ** 2, "K_1y": 1e6}

    def wheelset_modes(v):
        vehicle = Model("trailer").at(p, v=v, C_s=1e6)
        s = motion_eigenvalues(vehicle, vehicle.coupled)
        return s[(np.abs(s.imag) > 10) | (s.real < -0.1)]  # the frame's own two modes stand at +-1j and +-1.1j

    v, omega = critical_speed(wheelset_modes, 20.0, 60.0)
    w2, v2 = closed_form({**PAPER_LIKE, "W": 2e5})
    assert 3.6 * v == pytest.approx(138.0271, rel=5e-7)
    assert (v, omega) == pytest.approx((math.sqrt(v2), math.sqrt(w2)), rel=1e-7)


@pytest.mark.parametrize("W", [0.0, 2e5])
def test_primary_suspension_of_table_1_on_a_rigid_frame_is_never_unstable(table1, W):
    q = {**PAPER_LIKE, "k_y": table1["K_1y"], "k_psi": table1["K_1x"] * table1["b_1"] ** 2, "W": W}
    assert closed_form(q)[1] < 0
    for v in np.geomspace(1, 1e5, 60):
        assert np.all(modes(wheelset(q, v)).real < 0)


def wavelength(s, v):
    """Return the wavelength of the slowest oscillation: the kinematic motion."""
    return 2 * math.pi * v / min(x for x in abs(s.imag) if x > 0)


def test_klingel():
    q = {**PAPER_LIKE, "k_y": 0.0, "k_psi": 0.0}
    expected = 2 * math.pi * math.sqrt(0.625 * 0.7465 / 0.15)
    assert expected == pytest.approx(11.08126, rel=1e-6)
    assert wavelength(modes(wheelset(q, 0.1)), 0.1) == pytest.approx(expected, rel=1e-5)


def test_klingel_of_a_rigid_bogie(table1, rational, exact_roots):
    # Wheelsets fixed in the frame, no suspension to the body, slow; the stiffness takes all digits of a double.
    soft = {"K_2x": 1e-9, "K_2y": 1e-9, "C_t": 1e-9, "W": 1e-9, "K_1x": 1e15, "K_1y": 1e15, "v": 0.01}
    s = exact_roots(Model("trailer").at(rational({**table1, **soft})).coupled.coefficients[0])
    expected = 2 * math.pi * math.sqrt(0.625 * 0.7465 / 0.15 * (1 + (1.25 / 0.7465) ** 2))
    assert expected == pytest.approx(21.61240, rel=1e-6)
    assert wavelength(s, 0.01) == pytest.approx(expected, rel=1e-5)

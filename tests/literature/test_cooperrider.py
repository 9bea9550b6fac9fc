"""The bogie of N. K. Cooperrider (1972): seven degrees of freedom, one of them the frame's roll.

It is put together from our elements as they are, and written as a problem with a frame that rolls and rigid joints.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

import yawdesign as yd
from yawdesign.hunting.eigenvalues import dense, eigenvalues
from yawdesign.hunting.routh import decays_faster
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.determinant import Determinant
from yawdesign.vehicle.elements import Dashpot, Link, Mass, Pair, Spring, WheelRailContact, folded, physical
from yawdesign.vehicle.state_space import StateSpace
from yawdesign.vehicle.vehicle import Vehicle

M_W, M_F, I_W, I_FY, I_FR = 1022.0, 2918.0, 678.0, 6780.0, 6780.0
K1, K2, K3, K4, K5, K6 = 1.823e6, 3.646e6, 3.646e6, 182.3e3, 333.3e3, 2.710e6
D1, D2, D6 = 20e3, 29.2e3, 500.0
A, B, ARM_1, ARM_2, H1, H2 = 0.716, 1.074, 0.620, 0.680, 0.0762, 0.6584
CONICITY, R0, PHI, PSI, G = 0.05, 0.4572, 0.54219, 0.60252, 6.563e6


def cooperrider(v):
    wheelset = (
        Mass("y_w", M_W),
        Mass("psi_w", I_W),
        WheelRailContact("y_w", "psi_w", 0.0, CONICITY, A, R0, G / PHI, G / PSI, v),
        Link((Spring(2 * K1),), {"y_w": 1, "y": -1, "theta": -H1}, lever={"psi": -B}),
        Link((Spring(2 * K2 * ARM_1**2),), {"psi_w": 1, "psi": -1}),
    )
    return [
        Mass("y", M_F),
        Mass("psi", I_FY),
        Mass("theta", I_FR),
        Link((Spring(2 * K4), Dashpot(2 * D2)), {"y": 1, "theta": -H2}),
        Link((Spring(K6), Dashpot(D6)), {"psi": 1}),
        Link((Spring(2 * K5 * ARM_2**2 + 4 * K3 * ARM_1**2), Dashpot(2 * D1 * ARM_2**2)), {"theta": 1}),
        Pair(wheelset, own=frozenset({"y_w", "psi_w"})),
    ]


def modes(v):
    system = StateSpace(physical(cooperrider(v)))
    return np.linalg.eigvals(dense(system.A, system.size))


def test_linear_critical_speed():
    assert len(modes(50.0)) == 14
    v = brentq(lambda v: float(np.max(modes(v).real)), 50, 90, xtol=1e-10)
    s = modes(v)
    assert v == pytest.approx(68.6664, abs=5e-5)
    assert abs(s[np.argmax(s.real)].imag) == pytest.approx(25.123, abs=5e-4)


@pytest.mark.parametrize("arrange", [physical, folded])
@pytest.mark.parametrize(("v", "stable"), [(68.666, True), (68.667, False)])
def test_its_polynomial_says_the_same(arrange, v, stable):
    d = Determinant(polynomial_matrix(arrange(cooperrider(v))))
    assert decays_faster(d.of(d.nodes), 0.0) == stable


# Its numbers in the words of a problem file; the printed bogie has no load on the contact and no lateral dampers apart.
IN_A_FILE = {
    **{"kind": "trailer", "M_b": M_F, "J_b": I_FY, "M_w": M_W, "J_w": I_W, "W": 0.0},
    **{"K_1y": 2 * K1, "K_1x": 2 * K2, "K_2y": 2 * K4, "K_2x": K6 / ARM_2**2},
    **{"K_ds": "rigid", "K_dt": "rigid", "C_s": D6 / 1.2**2, "b_3": 1.2, "C_t": 2 * D2, "b_0": 0.0},
    **{"a": B, "b": A, "b_1": ARM_1, "b_2": ARM_2, "r": R0, "lambda_": CONICITY, "f_11": G / PHI, "f_22": G / PSI},
    **{"I_b": I_FR, "K_1z": K3, "C_1z": 0.0, "h_1": H1, "h_2": H2, "h_2t": H2, "K_2z": K5, "C_2z": D1},
    "gravitational_stiffness": False,
}


def in_a_file(**changes):
    return yd.Problem(bogie=yd.Bogie(**{**IN_A_FILE, **changes}), speed=60.0)


def test_the_same_bogie_from_a_problem():
    (vehicle,) = Vehicle.of(in_a_file())

    def abscissa(v):
        return float(eigenvalues(vehicle.replace(v=v)).real.max())

    v = brentq(abscissa, 50, 90, xtol=1e-10)
    s = eigenvalues(vehicle.replace(v=v))
    assert v == pytest.approx(68.6664, abs=5e-5)
    assert abs(s[0].imag) == pytest.approx(25.123, abs=5e-4)
    for v in (40.0, 68.0, 80.0):
        found, expected = (np.sort_complex(x) for x in (eigenvalues(vehicle.replace(v=v)), modes(v)))
        assert np.allclose(found, expected, rtol=1e-8, atol=1e-8)


def test_its_critical_speed_from_a_sweep():
    result = yd.sweep(in_a_file(), of="critical_speed", h_2=[0.0, H2])
    assert min(abs(v - 68.6664) for v in result.values[1]) < 5e-5
    assert result.known.all()

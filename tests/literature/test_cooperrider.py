"""The bogie of N. K. Cooperrider (1972): seven degrees of freedom, one of them the frame's roll.

None of it is in our vehicles; it is put together from our elements as they are.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from yawdesign.hunting.eigenvalues import dense
from yawdesign.hunting.routh import decays_faster
from yawdesign.vehicle.assembly import polynomial_matrix
from yawdesign.vehicle.determinant import Determinant
from yawdesign.vehicle.elements import Dashpot, Link, Mass, Pair, Spring, WheelRailContact, folded, physical
from yawdesign.vehicle.state_space import StateSpace

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

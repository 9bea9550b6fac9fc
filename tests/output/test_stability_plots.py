"""The picture of stability shows every eigenvalue once, and the margins."""

import numpy as np
import pytest

import yawdesign as yd


@pytest.fixture(scope="module")
def result():
    return yd.stability(yd.table1().replace(requirements={"damping_ratio": 0.05}))


def test_every_slow_eigenvalue_is_drawn_once(result):
    ax = yd.plot(result)
    points = {line.get_label(): line.get_xydata() for line in ax.lines}
    moved, decoupled = points["mode that a design variable moves"], points["decoupled mode"]
    drawn = np.vstack([moved, decoupled])
    slow = [s for s in result.eigenvalues if s.imag >= 0 and s.real > -40]
    others = [s for roots in result.fixed_modes.values() for s in roots if s.imag >= 0 and s.real > -40]
    beside = [s for s in others if min(abs(s - other) for other in result.eigenvalues) > 1e-6]
    assert len(drawn) == len(slow) + len(beside)
    assert len(decoupled) == len(others)
    for s in (*slow, *beside):
        assert np.min(np.hypot(*(drawn - (s.real, s.imag / (2 * np.pi))).T)) < 1e-9


def test_margins_are_lines(result):
    ax = yd.plot(result)
    labels = [line.get_label() for line in ax.lines]
    assert f"least damping ratio {100 * result.damping_ratio:.3g} %" in labels
    assert "required damping ratio 5 %" in labels
    assert f"least decay rate {result.decay_rate:.3g} 1/s" in labels
    title = ax.get_title("left").replace("\n", " ")
    assert title.startswith("Stable, ")
    assert "300 km/h" in title


def test_what_is_unstable_lies_in_the_hatched_half():
    result = yd.stability(yd.table1().replace(C_s=4e4))
    ax = yd.plot(result)
    assert ax.get_xlim()[1] > max(s.real for s in result.eigenvalues) > 0
    assert ax.get_title("left").replace("\n", " ").startswith("Unstable: 2 roots")

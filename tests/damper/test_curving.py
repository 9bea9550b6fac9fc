"""The curving limit, eqs (12) to (14)."""

from dataclasses import replace

import pytest

import yawdesign as yd
from yawdesign.damper.curving import curving_limit, resisting_moment, rotational_resistance

TABLE1 = yd.table1()
P = TABLE1.bogie.parameters()


def test_paper_limit():
    assert curving_limit(P, TABLE1.curve) == pytest.approx(2593442.98245614, rel=1e-12)


def test_wheel_load_halves_what_the_curve_bears():
    assert curving_limit(P, replace(TABLE1.curve, load="wheel")) == pytest.approx(488_180, abs=1)


def test_resistance_at_the_limit_is_the_limit():
    for load in ("axle", "wheel"):
        curve = replace(TABLE1.curve, load=load)
        assert rotational_resistance(P, curving_limit(P, curve), curve) == pytest.approx(0.08, rel=1e-12)


def test_moment_written_out():
    c = TABLE1.curve
    rate = c.L * c.V_r / (2 * c.R * c.l)
    expected = (1e6 * 1.2**2 + 60e3 * 0.3**2) * rate + 0.8e6 * 1.1**2 * c.L / (2 * c.R)
    assert resisting_moment(P, 1e6, c) == pytest.approx(expected, rel=1e-12)

"""What to change, as a table."""

from dataclasses import replace

import pytest
from rich.console import Group

from yawdesign.damper.relaxations import Relaxation
from yawdesign.output.relaxation_tables import relaxation_tables
from yawdesign.output.tables import rendered

SPEED = Relaxation("speed", "speed", 300 / 3.6, 270 / 3.6, -0.1, 10 / 3.6, {"C_s": 5e5}, 1.5, met=True)


@pytest.fixture(autouse=True)
def wide(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")


def shown(conflict, *relaxations):
    return " ".join(rendered(Group(*relaxation_tables(conflict, relaxations, "decay_rate"))).split())


def test_each_number_with_its_own_unit():
    others = [
        replace(SPEED, name="requirements.damping_ratio", kind="requirement", now=0.05, value=0.04, change=-0.2),
        replace(SPEED, name="bogie.K_2x", kind="parameter", now=8e5, value=None, change=None, searched=8e6, met=False),
        replace(SPEED, name="curve.limit", kind="limit", now=0.08, value=None, change=None, searched=0.8, met=False),
    ]
    text = shown(("requirements.damping_ratio", "curve.limit"), SPEED, *others)
    assert "requirements.damping_ratio, curve.limit, whatever else is given up" in text
    assert "speed │ 300 km/h │ 270 km/h │ -10 % │ 500 kN·s/m │ 1.5 1/s" in text
    assert "5 % │ 4 % │ -20 %" in text
    assert "Not enough alone: bogie.K_2x (0 ... 8 MN/m), curve.limit (to 0.8)." in text


def test_nothing_where_nothing_is_known():
    assert relaxation_tables((), (), "decay_rate") == []
    assert "What cannot be had: curve.limit, whatever else is given up." in shown(("curve.limit",))

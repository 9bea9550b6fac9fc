"""Stability over several conditions."""

from dataclasses import replace

import yawdesign as yd
from yawdesign.hunting import all_conditions


def test_one_speed_that_could_not_be_checked_is_told(monkeypatch):
    problem = yd.table1().replace(C_s=1e6, speed=["250 km/h", "275 km/h", "300 km/h"])
    asked = all_conditions.stability_at
    assert yd.stability(problem).checked

    def unsure_at_the_lowest(vehicle, variables=()):
        result = asked(vehicle, variables)
        return replace(result, checked=result.checked and vehicle.v > 70)

    monkeypatch.setattr(all_conditions, "stability_at", unsure_at_the_lowest)
    result = yd.stability(problem)
    assert result.worst_condition == {"speed": result.speed}
    assert result.speed > 70
    assert not result.checked

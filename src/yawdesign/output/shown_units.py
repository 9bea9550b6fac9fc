"""In which unit people see the values of a sweep."""

from yawdesign.study.result import Sweep

SHOWN = {"N·s/m": "kN·s/m", "m/s": "km/h"}


def shown_unit(sweep: Sweep) -> str:
    """Return the unit in which the values of a sweep are shown."""
    return "%" if sweep.quantity == "damping_ratio" else SHOWN.get(sweep.unit, sweep.unit)

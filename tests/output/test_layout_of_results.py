"""Every text in pictures of sweeps, designs and other answers can be read, for one bogie and for a vehicle."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure

import yawdesign as yd
from yawdesign.output.critical_speed_plots import condition_of_curve

TABLE1 = yd.table1().replace(C_s="1046.77 kN s/m")
PRINTED = yd.table1(equations="as-printed")
CONDITIONS = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.5]}
MANY = TABLE1.replace(conditions=CONDITIONS, title="A power bogie with a title that is as long as people write them")
VEHICLE = yd.load(Path(__file__).parents[2] / "problems" / "vehicle.yaml")
CHART = {"C_s": "10 kN s/m:10 MN s/m:12:log", "v": "150 km/h:450 km/h:12"}
PLANE = {"f_m": "1:8:12", "v": "150 km/h:450 km/h:12"}
SPREAD = {"lambda": {"uniform": [0.05, 0.4]}, "creep_factor": {"uniform": [0.5, 1]}, "K_m": {"lognormal": "10 %"}}
DAMPER = yd.Design(variables={"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")})


@pytest.mark.parametrize(
    ("problem", "of", "axes"),
    [
        (TABLE1, "stable", CHART),
        (MANY, "stable", CHART),
        (VEHICLE, "stable", CHART),
        (PRINTED.replace(K_m=0.0), "stable", CHART),
        (PRINTED, "stable", {"C_s": "200 kN s/m:2 MN s/m:5:log", "v": "150 km/h:250 km/h:5"}),
        (MANY, "decay_rate", CHART),
        (VEHICLE, "damping_ratio", {"lambda_": "0.02:0.4:12", "creep_factor": "0.4:1:12"}),
        (PRINTED, "C_sl", PLANE),
        (PRINTED.replace(limit=0.02), "design", PLANE),
        (PRINTED, "critical", PLANE),
        (PRINTED, "critical", {"f_m": "1:8:60"}),
        (MANY, "C_sl", {"f_m": "1:8:20"}),
        (PRINTED, "design", {"f_m": "1:8:20"}),
        (PRINTED, "decay_rate", {"C_s": "10 kN s/m:10 MN s/m:30:log"}),
        (PRINTED, "stable", {"v": "250 km/h:400 km/h:10"}),
    ],
)
def test_sweeps(problem, of, axes, layout_faults):
    assert layout_faults(yd.plot(yd.sweep(problem, of=of, **axes))) == []


@pytest.mark.parametrize(
    "problem",
    [
        PRINTED,
        MANY,
        VEHICLE,
        PRINTED.replace(limit=0.001),
        PRINTED.replace(K_m=0.0, curve=None),
        PRINTED.replace(speed="60 km/h"),
    ],
)
def test_designs(problem, layout_faults):
    result = yd.design(problem)
    assert layout_faults(yd.plot(result)) == []
    small = Figure(figsize=(7, 2.2), layout="constrained").subplots()
    assert layout_faults(yd.plot(result, ax=small)) == []


def test_an_optimum_and_a_front(layout_faults):
    problem = TABLE1.replace(design=DAMPER)
    assert layout_faults(yd.plot(yd.optimise(problem))) == []
    assert layout_faults(yd.plot(yd.trade_off(problem, points=3))) == []


@pytest.mark.parametrize("bounds", [("10 kN s/m", "60 kN s/m"), ("2 MN s/m", "8 MN s/m")])
def test_a_design_as_written_outside_the_bounds_is_inside_the_picture(bounds, layout_faults):
    low, high = bounds
    ax = yd.plot(yd.optimise(TABLE1.replace(design=yd.Design(variables={"C_s": yd.Variable(min=low, max=high)}))))
    assert layout_faults(ax) == []
    left, right = ax.get_xlim()
    (before,) = (line.get_xdata()[0] for line in ax.lines if line.get_marker() == "s")
    assert left < before < right
    assert not 0 < before < 100
    assert "1 047 kN·s/m" in [text.get_text() for text in ax.texts]


def test_a_choice(layout_faults):
    found = yd.choose(yd.load(Path(__file__).parents[2] / "problems" / "table1-catalogue.yaml"))
    assert layout_faults(yd.plot(found)) == []


@pytest.mark.parametrize("C_s", ["200 kN s/m", "1 MN s/m"])
def test_critical_speeds(C_s, layout_faults):
    problem = TABLE1.replace(C_s=C_s, requirements={"critical_speed": "330 km/h"})
    assert layout_faults(yd.plot(yd.critical_speed(problem))) == []


def test_the_curve_of_critical_speeds_is_told_with_its_own_condition():
    found = yd.critical_speed(MANY)
    shown = condition_of_curve(found)
    assert shown.startswith(
        f"lambda {found.worst_condition['lambda']:g}, creep x {found.worst_condition['creep_factor']:g}"
    )
    assert f"least decay rate, {shown}" in yd.plot(found).get_legend_handles_labels()[1]
    assert condition_of_curve(yd.critical_speed(TABLE1)) == "values as given"


def test_uncertainty(layout_faults):
    result = yd.uncertainty(TABLE1.replace(uncertainty=SPREAD), samples=2**10)
    for of in ("both", "C_sl"):
        assert layout_faults(yd.plot(result, of=of)) == []

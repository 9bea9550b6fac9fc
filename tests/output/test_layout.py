"""In every picture of modes and responses each text can be read: none on another, on a line or outside."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

import yawdesign as yd
from yawdesign.problem.parameters import CarBody


def axes():
    ax = Figure(layout="constrained").add_subplot()
    ax.set(xlim=(0, 1), ylim=(0, 1))
    return ax


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ((0.5, 0.5), []),
        ((1.2, 0.5), ["outside the figure: 'here'"]),
        ((0.5, 0.3), ["on each other: 'there' and 'here'"]),
        ((0.5, 0.8), ["on a line: 'here'"]),
    ],
)
def test_the_check_itself(place, words, layout_faults):
    ax = axes()
    ax.plot([0, 1], [0.8, 0.8])
    ax.text(0.5, 0.3, "there")
    ax.text(*place, "here").set_in_layout(False)
    assert layout_faults(ax) == words


def test_the_check_of_sizes(layout_faults):
    ax = axes()
    ax.text(0.5, 0.5, "tiny", fontsize=6)
    assert layout_faults(ax) == ["smaller than 8.0 pt: 'tiny'"]
    ax.texts[0].set(fontsize=8)
    ax.text(0.5, 0.8, "boxed", bbox={"facecolor": "white"})
    ax.plot([0, 1], [0.8, 0.8])
    assert layout_faults(ax) == []


ROAD = "a road of many words, $5 a metre, " * 4 + "x" * 100


@pytest.fixture(scope="module")
def problems():
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    bogie, trailer = (yd.table1(kind).replace(C_s="1 MN s/m") for kind in ("power", "trailer"))
    return {"bogie": bogie, "trailer": trailer, "vehicle": replace(bogie, car_body=body)}


WAVELENGTHS = np.geomspace(200, 4, 60)
DRAWN = {
    "stability": yd.stability,
    "modes": yd.modes,
    "speeds": lambda p: yd.follow_modes(p, v=np.linspace(50, 450, 25) / 3.6),
    "dampings": lambda p: yd.follow_modes(p, C_s=np.geomspace(1e4, 5e6, 25)),
    "answers": lambda p: yd.frequency_response(p, WAVELENGTHS),
    "stationary": yd.stationary_response,
    "long run": lambda p: yd.simulate(p, duration=20, step="2 ms"),
    "growing run": lambda p: yd.simulate(p.replace(C_s=4e4), duration=5, step="2 ms", start="rest"),
}
OPTIONS = {"speeds": [{"target": 0.05}, {"of": "damping_ratio", "target": 0.05}], "dampings": [{}, {"of": "frequency"}]}


@pytest.mark.parametrize(
    "kind", ["bogie", *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("vehicle", "trailer"))]
)
@pytest.mark.parametrize("what", list(DRAWN))
def test_every_text_can_be_read(kind, what, problems, layout_faults):
    result = DRAWN[what](problems[kind])
    for options in OPTIONS.get(what, [{}]):
        assert layout_faults(yd.plot(result, **options)) == []


def test_the_damper_can_be_read(problems, layout_faults):
    damper = yd.simulate(problems["bogie"], duration=2, step="2 ms").damper
    assert layout_faults(yd.plot(damper)) == []
    assert layout_faults(yd.plot(yd.simulate(problems["bogie"].replace(K_ds="rigid"), duration=2).damper)) == []


def test_long_titles_and_several_runs_can_be_read(problems, layout_faults):
    runs = yd.simulate(problems["bogie"], duration=13, step="2 ms", speed=["250 km/h", "300 km/h"])
    assert layout_faults(yd.plot(replace(runs, track=ROAD))) == []
    check = yd.spectrum_check(length="2 km")
    assert layout_faults(yd.plot(replace(check, track=ROAD))) == []
    loads = {"a load with a very long name, longer than what any line of a picture holds": {"W": "120 kN"}}
    loaded = problems["bogie"].replace(conditions={"load": loads})
    found = yd.modes(loaded, condition={"load": next(iter(loads)), "lambda": 0.4})
    assert layout_faults(yd.plot(found)) == []

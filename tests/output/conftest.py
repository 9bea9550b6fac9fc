"""One result of every kind, made once; and whether every text of a picture can be read."""

from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import yawdesign as yd
from yawdesign.output.pictures import own_texts
from yawdesign.output.tables_by_result import TABLES_BY
from yawdesign.study.paper_bogie import paper_bogie
from yawdesign.study.reproduced_tables import table_3

PROBLEMS = Path(__file__).parents[2] / "problems"
FAULTS = {"one of the two yaw dampers of the bogie lost": {"C_s": "50 %", "K_ds": "50 %"}}
LOADS = {"laden": {"W": "210 kN"}, "tare": {"W": "150 kN"}}
CONDITIONS = {"lambda": [0.05, 0.4], "creep_factor": [1.0, 0.5], "load": LOADS}
UNCERTAIN = {"lambda": {"uniform": [0.05, 0.4]}, "creep_factor": {"uniform": [0.5, 1]}}
LEAST = {"damping_ratio": "1 %", "cases": {"damping_ratio": "0.1 %"}}


def problem():
    """Return a problem that has something of everything."""
    given = yd.table1().replace(title="Bogie of Table I", C_s="1 046 770 N s/m", cases=FAULTS, requirements=LEAST)
    design = yd.Design(variables={"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")})
    return given.replace(conditions=CONDITIONS, design=design)


def choice():
    rows = [yd.CatalogueDamper(name=f"damper {k} of a maker", damping=2e5 + 5e3 * k, stiffness=2e7) for k in range(200)]
    return yd.choose(problem().replace(design=yd.Design(catalogue=rows)))


def trade_off():
    point = {"rotational_resistance": 0.0512345, "margin": -0.317031, "C_s": 1e6, "K_m": 62648e2, "C_m": 25799.4}
    point |= {"stable": False, "checked": True, "requirements": ()}
    worst = [{"speed": 250 / 3, "lambda": x, "creep_factor": 0.5, "load": "tare"} for x in (0.05, 0.25)]
    points = [{**point, "worst_condition": each} for each in worst]
    return yd.TradeOff(tuple(points), "decay_rate", 0.08, points[0], None, 0.09, "ok", "found", "all 15 conditions")


def reproduced():
    rows = tuple(table_3(paper_bogie(yd.table1(equations="as-printed"))))
    return yd.Reproduction(agrees=True, checked=True, rows=rows, changed={}, version="1", drawn={})


class Results:
    """Every kind of result; each is made when it is first asked for."""

    names = tuple(TABLES_BY)

    def __init__(self, folder):
        self.folder = folder

    @cache  # noqa: B019 - one object, for the whole session
    def __getitem__(self, name):
        plain, whole = yd.table1().replace(C_s="1 046 770 N s/m"), problem()
        return {
            "Problem": problem,
            "Stability": lambda: yd.stability(whole),
            "CriticalSpeeds": lambda: yd.critical_speed(plain),
            "ForwardDesign": lambda: yd.design(whole),
            "Optimum": lambda: yd.optimise(whole),
            "Choice": choice,
            "TradeOff": trade_off,
            "Sweep": lambda: yd.sweep(plain, of="critical", f_m=[2.0, 3.27]),
            "Uncertainty": lambda: yd.uncertainty(plain.replace(uncertainty=UNCERTAIN), samples=2**10),
            "Simulation": lambda: yd.simulate(yd.load(PROBLEMS / "vehicle.yaml"), duration="2 s"),
            "DamperComponent": lambda: yd.damper_component(plain, duration="2 s"),
            "FrequencyResponse": lambda: yd.frequency_response(plain, wavelength=[5.0, 10.0, 20.0]),
            "StationaryResponse": lambda: yd.stationary_response(plain),
            "SpectrumCheck": lambda: yd.spectrum_check(length="2 km"),
            "Modes": lambda: yd.modes(yd.load(PROBLEMS / "vehicle.yaml")),
            "FollowedModes": lambda: yd.follow_modes(plain, v=[60.0, 70.0, 80.0]),
            "Reproduction": reproduced,
            "Export": lambda: yd.export(plain, self.folder / "export", only="dynamic_stiffness", formats="casadi"),
            "Fmu": lambda: yd.Fmu(str(self.folder / "a.fmu"), None, "there is no compiler", {"values": "as written"}),
            "StateSpaceModel": lambda: yd.state_space(plain),
        }[name]()


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Return one result of every kind by its name, and a problem."""
    return Results(tmp_path_factory.mktemp("results"))


def pytest_generate_tests(metafunc):
    """Run a test that asks for the name of a kind of result once for each."""
    if "kind_of_result" in metafunc.fixturenames:
        metafunc.parametrize("kind_of_result", Results.names)


SMALLEST = 8.0  # points
TOUCHING = 1.0  # pixels by which boxes of texts may overlap: they hold the room for letters that go lower


@pytest.fixture
def layout_faults(monkeypatch):
    """A function that draws the figure of some axes and returns what is wrong with its texts, as a list of words.

    No text may lie on another, on a line or outside the figure, or be smaller than `SMALLEST`. On a line may lie what
    has a box of its own behind it.
    """
    drawn = []
    draw = Text.draw

    def drawing(text, renderer):
        if text.get_visible() and text.get_text():
            drawn.append((text, Text.get_window_extent(text, renderer)))
        draw(text, renderer)

    def faults(axes):
        figure = axes.get_figure(root=True)
        with own_texts(), monkeypatch.context() as patched:
            figure.draw_without_rendering()
            canvas = FigureCanvasAgg(figure)
            patched.setattr(Text, "draw", drawing)
            drawn.clear()
            canvas.draw()
        lines = [points for ax in figure.axes for points in _lines(ax)]
        return [*_outside(drawn, figure.bbox), *_small(drawn), *_overlaps(drawn), *_struck(drawn, lines)]

    return faults


def _outside(drawn, room):
    for text, box in drawn:
        if box.x0 < room.x0 - 1 or box.y0 < room.y0 - 1 or box.x1 > room.x1 + 1 or box.y1 > room.y1 + 1:
            yield f"outside the figure: {text.get_text()!r}"


def _small(drawn):
    yield from (f"smaller than {SMALLEST} pt: {t.get_text()!r}" for t, _ in drawn if t.get_fontsize() < SMALLEST)


def _overlaps(drawn):
    for (one, a), (other, b) in combinations(drawn, 2):
        wide, high = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
        if wide > TOUCHING and high > TOUCHING:
            yield f"on each other: {one.get_text()!r} and {other.get_text()!r}"


def _struck(drawn, lines):
    for text, box in drawn:
        if text.get_bbox_patch() is None and any(_through(points, box) for points in lines):
            yield f"on a line: {text.get_text()!r}"


def _lines(ax):
    """Yield the lines of some axes as points in pixels, parted where they leave the axes."""
    for line in ax.get_lines():
        points = line.get_transform().transform(np.column_stack(np.broadcast_arrays(*line.get_data())).astype(float))
        yield points if not line.get_clip_on() else _within(points, ax.bbox)


def _within(points, room):
    """Return points of a line so close to each other that a box of a text holds some, without those outside."""
    if len(points) < 2:
        return points
    steps = np.linspace(0, 1, 400 // min(len(points), 100), endpoint=False)[:, None]
    dense = (points[:-1, None] + steps * np.diff(points, axis=0)[:, None]).reshape(-1, 2)
    return dense[np.all((dense >= room.min) & (dense <= room.max), axis=1)]


def _through(points, box):
    inner = Bbox.from_extents(box.x0 + 1, box.y0 + 2, box.x1 - 1, box.y1 - 2)
    return inner.count_contains(points) > 0

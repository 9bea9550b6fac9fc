"""The part of the page that computes: its script in a real browser says what Python says, far outside usual values."""

import json
import math
import random
import re
from pathlib import Path

import pytest

import yawdesign as yd
from yawdesign.damper.stable_intervals import others_stable
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.verdict import stability_at
from yawdesign.output.report.live_panel import SLIDERS, live_panel
from yawdesign.problem.condition import Condition
from yawdesign.vehicle.vehicle import Model

PROBLEMS = Path(__file__).parents[3] / "problems"
NAMES = ("table1", "power-bogie", "trailer-bogie", "vehicle")
CLOSE = 1e-8  # a hundredth of what is asked for: all that is found is nearer than 1e-10
LARGEST = 400_000  # characters, of a vehicle with car body
PAGE = """\
<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Page</title><meta http-equiv="Content-Security-Policy"
content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'"></head><body>{}</body></html>"""


class Panel:
    """The panel of a problem in a page, and Python's answers for the same vehicle."""

    def __init__(self, problem, folder, browser):
        self.problem, file = problem, folder / "page.html"
        file.write_text(PAGE.format(live_panel(self.problem, self.problem.bogie.C_s)), encoding="utf-8")
        self.page = browser.open(file)
        self.model = Model.of(self.problem)
        self.p = {key: float(x) for key, x in self.problem.parameters().items()}

    def in_page(self, points):
        return self.page.evaluate(f"{json.dumps(points)}.map((point) => window.yawdesignLive.at(point))")

    def in_python(self, point):
        values = dict(point)
        C_s = values.pop("C_s")
        return self.model.at(Condition(tuple(values.items())).applied({**self.p, "C_s": C_s}))

    def stability(self, point):
        return stability_at(self.in_python(point), self.problem.design.variables)

    def fields(self):
        """Return what stands in the fields, in SI units."""
        texts = self.page.evaluate("[...document.querySelectorAll('[type=number]')].map((field) => field.value)")
        return {slider.key: float(text) * slider.factor for slider, text in zip(SLIDERS, texts, strict=True)}

    def shown(self, name):
        self.page.drawn()
        return self.page.evaluate(f"document.getElementById('live-{name}').textContent")


@pytest.fixture(scope="module", params=NAMES)
def panel(request, tmp_path_factory, browser):
    problem = yd.load(PROBLEMS / f"{request.param}.yaml")
    return Panel(problem, tmp_path_factory.mktemp(request.param), browser)


@pytest.fixture(scope="module")
def bogie(tmp_path_factory, browser):
    return Panel(yd.load(PROBLEMS / "table1.yaml"), tmp_path_factory.mktemp("page"), browser)


def anywhere(count, seed):
    """Return points far outside usual values: 1 kN s/m to 100 MN s/m, 20 to 600 km/h, 0.005 to 0.6, 0.3 to 1.2."""
    rng = random.Random(seed)
    ends = {"C_s": (1e3, 1e8), "v": (20 / 3.6, 600 / 3.6), "lambda": (0.005, 0.6), "creep_factor": (0.3, 1.2)}
    return [{key: low * (high / low) ** rng.random() for key, (low, high) in ends.items()} for _ in range(count)]


def farthest(found, expected):
    """Return the largest distance of roots that belong together, relative to their magnitudes."""
    rest, worst = list(found), 0.0
    for s in expected:
        near = min(rest, key=lambda x: abs(x - s))
        rest.remove(near)
        worst = max(worst, abs(near - s) / abs(s))
    assert not rest
    return worst


@pytest.mark.slow
def test_the_page_says_what_python_says(panel):
    expect_same(panel, anywhere(60 if panel.model.has_car_body else 200, seed=len(panel.p)))


def expect_same(panel, points):
    """Check the answers of the page at some points."""
    for point, answer in zip(points, panel.in_page(points), strict=True):
        expected, damping = panel.stability(point), critical_damping(panel.in_python(point))
        assert answer["checked"], point
        assert answer["stable"] == expected.stable, point
        assert farthest([complex(*s) for s in answer["roots"]], expected.eigenvalues) < CLOSE, point
        for margin in ("decay_rate", "damping_ratio", "spectral_abscissa"):
            assert answer[margin] == pytest.approx(getattr(expected, margin), rel=CLOSE), (margin, point)
        intervals = damping.stable_intervals if others_stable(panel.in_python(point)) else ()
        found = [(low, math.inf if high is None else high) for low, high in answer["stable_intervals"]]
        assert len(found) == len(intervals), point
        assert [x for ends in found for x in ends] == pytest.approx([x for i in intervals for x in i], rel=CLOSE), point


@pytest.mark.slow
@pytest.mark.parametrize("C_mphi", [0, 1.0])
def test_what_no_variable_moves_counts_in_the_verdict_alone(C_mphi, tmp_path, browser):
    """Motors that yaw against each other with hardly any damping, or with none, are beside the margins."""
    panel = Panel(yd.table1().replace(C_mphi=C_mphi), tmp_path, browser)
    points = anywhere(5, seed=3)
    expect_same(panel, points)
    answer = panel.in_page([{**points[0], "C_s": 1e6, "lambda": 0.15, "v": 60, "creep_factor": 1}])[0]
    assert answer["decay_rate"] > 0.1 > -100 * answer["spectral_abscissa"]
    assert answer["stable"] == bool(answer["stable_intervals"]) == (C_mphi > 0)


@pytest.mark.slow
def test_fields_and_sliders_move_what_is_shown(panel):
    for point in anywhere(5, seed=7):
        for slider in SLIDERS:
            panel.page.write(f"[data-key={slider.key}] [type=number]", f"{point[slider.key] / slider.factor!r}")
        assert panel.fields() == pytest.approx(point, rel=1e-12)
        expect_shown(panel)
    for slider, key, times in zip(SLIDERS, ("PageUp", "ArrowLeft", "End", "Home"), (2, 7, 1, 1), strict=True):
        before = panel.fields()
        panel.page.focus(f"#live-{slider.key}")
        panel.page.press(key, times)
        panel.page.drawn()
        assert {x for x, value in panel.fields().items() if value != before[x]} == {slider.key}
        expect_shown(panel)
    panel.page.focus("#live-reset")
    panel.page.press("Enter")
    panel.page.drawn()
    start = {"C_s": panel.problem.bogie.C_s, "v": panel.problem.speeds[-1], "lambda": panel.p["lambda"]}
    assert panel.fields() == pytest.approx({**start, "creep_factor": 1}, rel=1e-12)
    expect_shown(panel)


def expect_shown(panel):
    """Check the numbers in the page, to the four digits that it shows, for the values in its fields."""
    expected = panel.stability(panel.fields())
    assert panel.shown("verdict") == ("Stable." if expected.stable else "Unstable.")
    for name, value in (
        ("decay-rate", expected.decay_rate),
        ("damping-ratio", 100 * expected.damping_ratio),
        ("abscissa", expected.spectral_abscissa),
    ):
        number = panel.shown(name).split()[0].replace("\u2212", "-")
        assert float(number) == pytest.approx(value, rel=5.1e-4)
    growing = sum(s.real >= 0 and s.imag >= 0 for s in expected.eigenvalues)
    assert f"picture, {growing} of all not left" in panel.shown("plane-description")


@pytest.mark.slow
def test_a_root_that_grows_is_in_the_picture_however_fast(bogie):
    for C_s, v in (("60", "330"), ("1", "600")):  # least decay rates of -6.9 and -16 1/s: the axis ends at 5 1/s else
        for key, text in (("C_s", C_s), ("v", v), ("lambda", "0.4")):
            bogie.page.write(f"[data-key={key}] [type=number]", text)
        assert float(bogie.shown("abscissa").split()[0]) > 5
        growing = int(re.search(r"picture, (\d+) of all", bogie.shown("plane-description"))[1])
        shown = "document.querySelectorAll('#live-plane-drawn .growing').length"
        assert bogie.page.evaluate(shown) == growing > 0
        numbers = "[...document.querySelectorAll('#live-plane-drawn text')].map((x) => x.textContent)"
        assert len(bogie.page.evaluate(numbers)) <= 17
    bogie.page.evaluate("document.getElementById('live-reset').click()")


@pytest.mark.slow
def test_intervals_are_shown_in_words_and_on_the_axis(bogie):
    bogie.page.evaluate("document.getElementById('live-reset').click()")
    assert bogie.shown("intervals") == "above 90.7029 kN·s/m"
    bogie.page.write("[data-key=v] [type=number]", "250")
    assert bogie.shown("intervals") == "everywhere"
    assert bogie.page.evaluate("document.querySelectorAll('#live-axis-drawn .stable').length") == 1


@pytest.mark.slow
def test_a_missing_value_is_asked_for(bogie):
    for text in ("", "0", "-3"):
        bogie.page.write("[data-key=C_s] [type=number]", text)
        assert bogie.shown("verdict") == "A value is missing: give a number above zero."
        invalid = "document.querySelector('[data-key=C_s] [type=number]').getAttribute('aria-invalid')"
        assert bogie.page.evaluate(invalid) == "true"
    bogie.page.evaluate("document.getElementById('live-reset').click()")
    assert bogie.shown("verdict") == "Stable."


@pytest.mark.slow
@pytest.mark.parametrize("change", ["C_s 1e-300", "C_s 1e300", "v 1e-300", "lambda 1e300", "creep_factor 1e300"])
def test_values_that_are_too_far_out_are_told(change, bogie):
    key, text = change.split()
    bogie.page.write(f"[data-key={key}] [type=number]", text)
    assert "Not decided here" in bogie.shown("verdict") or "too far out" in bogie.shown("verdict")
    bogie.page.evaluate("document.getElementById('live-reset').click()")
    assert bogie.shown("verdict") == "Stable."


@pytest.mark.slow
def test_the_page_asks_for_nothing_and_forbids_it(panel):
    assert panel.page.requests == []
    assert panel.page.complaints == []


@pytest.mark.slow
def test_every_control_and_picture_has_a_name(bogie):
    bogie.page.send("Accessibility.enable")
    nodes = bogie.page.send("Accessibility.getFullAXTree")["nodes"]
    named = {}
    for node in nodes:
        named.setdefault(node.get("role", {}).get("value"), []).append(node.get("name", {}).get("value", ""))
    assert len(named["slider"]) == len(named["spinbutton"]) == len(SLIDERS)
    assert all(named["slider"] + named["spinbutton"] + named["button"] + named.get("image", named.get("img", [])))
    assert bogie.page.evaluate("document.getElementById('live-verdict').ariaLive") == "polite"


@pytest.mark.slow
def test_it_fits_and_is_not_printed(bogie):
    for width in (1200, 768, 400):
        bogie.page.resize(width, 1200)
        assert bogie.page.evaluate("document.documentElement.scrollWidth") <= width
    bogie.page.media("print")
    assert bogie.page.evaluate("getComputedStyle(document.getElementById('live')).display") == "none"
    bogie.page.media()


def test_a_panel_is_small_and_needs_nothing_else():
    problem = yd.load(PROBLEMS / "vehicle.yaml")
    fragment = live_panel(problem, 1e6)
    assert len(fragment) < LARGEST
    assert not re.search(r"(src|href)=|\bimport\b|fetch\(|XMLHttpRequest", fragment.replace('href="#', ""))
    assert re.findall(r"https?://[^\"]+", fragment) == ["http://www.w3.org/2000/svg"]
    assert not re.search(r"\son\w+=", fragment)

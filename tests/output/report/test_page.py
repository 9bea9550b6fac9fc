"""The page of a design review: it needs nothing but itself, everybody can read it, and what users write is text."""

import base64
import hashlib
import re
from concurrent.futures import BrokenExecutor
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.output import style
from yawdesign.output.pictures import BLANK
from yawdesign.output.report import browser_print, condition_sections, design_sections, motion_sections, verdict
from yawdesign.output.report.page import page
from yawdesign.output.report.report import origin
from yawdesign.study import design_review as reviews

LARGEST = 1_500_000
VOID = {"meta", "link", "input", "br", "path", "use", "rect", "image", "stop", "line", "polygon", "circle", "ellipse"}
LEAST_CONTRAST = 4.5


class Reader(HTMLParser):
    """Reads a page: its elements with their attributes, and the texts of headings and scripts."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.texts, self.open = [], [], []
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.texts.append("")
        if tag not in VOID:
            self.open.append((tag, len(self.elements) - 1))

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.texts.append("")

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        for _, k in self.open:
            self.texts[k] += data

    def all(self, *tags):
        pairs = zip(self.elements, self.texts, strict=True)
        return [(given, text) for (tag, given), text in pairs if tag in tags]


@pytest.fixture(scope="module")
def read(html):
    return Reader(html)


def test_it_needs_nothing_but_itself(html, read):
    for tag, given in read.elements:
        for key in ("src", "href", "xlink:href", "action", "poster", "srcset"):
            assert given.get(key, "#").startswith(("#", "data:")), (tag, key, given[key])
        assert tag not in {"iframe", "object", "embed", "base", "form"}
    for sheet, text in read.all("style"):
        assert "@import" not in text, sheet
        assert all(place.startswith("#") for place in re.findall(r"url\([\"']?(.)", text))
    assert len(html.encode()) < LARGEST


def test_a_browser_may_connect_to_nothing_and_runs_only_the_scripts_of_the_page(read):
    (policy,) = [given["content"] for given, _ in read.all("meta") if given.get("http-equiv")]
    assert policy.startswith("default-src 'none'; ")
    assert "unsafe" not in policy.replace("style-src 'unsafe-inline'", "")
    scripts = [text for given, text in read.all("script") if given.get("type") != "application/json"]
    allowed = [f"'sha256-{base64.b64encode(hashlib.sha256(x.encode()).digest()).decode()}'" for x in scripts]
    assert re.search(r"script-src ([^;]*)", policy)[1].split() == allowed
    assert len(scripts) == 1


def test_names_are_unique_and_lead_somewhere(read):
    every = [given["id"] for _, given in read.elements if "id" in given]
    ids = set(every)
    assert len(every) == len(ids)
    for _, given in read.elements:
        for key in ("aria-labelledby", "for"):
            assert set(given.get(key, "").split()) <= ids, given
        for key in ("href", "xlink:href"):
            if given.get(key, "").startswith("#"):
                assert given[key][1:] in ids, given
    sections = [given["id"] for given, _ in read.all("section")]
    assert [given["href"][1:] for given, _ in read.all("a")][1:] == sections


def test_every_picture_has_a_title_and_a_description(read):
    pictures = read.all("svg")
    assert len(pictures) > 8
    for given, text in pictures:
        assert given["role"] == "img"
        assert len(given["aria-labelledby"].split()) == 2, text[:80]
    texts = {given["id"]: text for given, text in read.all("title", "desc") if "id" in given}
    for given, _ in pictures:
        if not given["aria-labelledby"].startswith("live"):
            title, description = (texts[name] for name in given["aria-labelledby"].split())
            assert title
            assert len(description) > len(title) / 2


def test_headings_come_in_order(read):
    levels = [int(tag[1]) for tag, _ in read.elements if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    assert {"header", "nav", "main", "footer"} <= {tag for tag, _ in read.elements}
    assert read.all("html")[0][0]["lang"] == "en"


def test_tables_name_their_rows_and_columns(read):
    assert all(given.get("scope") in ("row", "col") for given, _ in read.all("th"))
    assert all(text for _, text in read.all("caption"))


def test_what_users_write_is_text(review, read):
    assert review.problem.title in read.all("h1")[0][1]
    assert review.problem.title in read.all("title")[0][1]
    assert any(review.problem.cases[0].name in text for _, text in read.all("th"))
    assert any("<x>.yaml" in text for _, text in read.all("td"))
    assert not read.all("b", "i")


def test_the_verdict_is_told_in_words_and_by_a_sign(review, read):
    ((_, told),) = [(given, text) for given, text in read.all("p") if given.get("class") == "verdict good"]
    assert "✔" in told
    assert "Stable, and every limit is kept" in told
    assert f"{review.optimum.C_s / 1e3:.0f}"[-3:] in told


def test_what_is_not_survived_or_reached_stands_under_the_verdict(review):
    def told(shown):
        return verdict.verdict(shown).body.replace(BLANK, " ")

    lost, fault = replace(review.after.cases[0], stable=False, checked=True), "&lt;i&gt;lost&lt;/i&gt; $5"
    speeds = replace(review.critical_speed, stable_up_to=60.0, speed_wanted=90.0)
    assert f"Unstable with this fault: {fault}." in told(replace(review, after=replace(review.after, cases=(lost,))))
    assert "Stable up to 216 km/h only, below 324 km/h" in told(replace(review, critical_speed=speeds))
    speeds = replace(speeds, speed_wanted=50.0)
    survived = replace(review, after=replace(review.after, cases=(replace(lost, stable=True),)), critical_speed=speeds)
    assert not any(text in told(survived) for text in ("this fault", "only, below"))


def test_motion_stands_still_where_it_is_not_wanted(read):
    (rules,) = [text for _, text in read.all("style") if "@keyframes" in text]
    moving = re.findall(r"\.(film-\d+)\{animation", rules)
    assert len(moving) >= 5
    assert rules.count("@media screen and (prefers-reduced-motion:no-preference)") == len(moving)
    assert {given["id"] for given, _ in read.all("input") if "id" in given} >= {"film-pause"}
    assert sum("moving" in (given.get("class") or "") for given, _ in read.all("g")) == len(moving)


@pytest.fixture(scope="module")
def bare(review):
    """Return a review of which nothing is left that may be missing."""
    without = replace(review, front=None, choice=None, mounts=None, wear=None, chart=None, run=None, modes=None)
    without = replace(without, paths=None, each_condition=(), uncertainty=None, with_body=None, after=None, design=None)
    return replace(without, optimum=replace(without.optimum, requirements=(), relaxations=()))


def test_parts_whose_input_is_missing_are_left_out(bare, html):
    left_out = (
        *(design_sections.front, design_sections.catalogue, verdict.change),
        *(condition_sections.requirements, condition_sections.conditions, condition_sections.faults),
        *(condition_sections.chart, condition_sections.wear, condition_sections.mounts),
        *(motion_sections.damping_over_speed, motion_sections.root_locus, motion_sections.hunting, motion_sections.run),
        *(motion_sections.damper, motion_sections.car_body, motion_sections.live),
    )
    assert [each(bare) for each in left_out] == [None] * len(left_out)
    assert "Margin against rotational resistance" not in html


def test_no_design_gets_a_page_with_the_reason_and_what_to_change():
    problem = yd.table1().replace(limit=1e-5, C_s=None)
    variables = {"C_s": yd.Variable(min="10 kN s/m", max="3 MN s/m")}
    review = reviews.design_review(problem.replace(design=yd.Design(variables=variables)))
    read = Reader(page(review, origin(review.problem, {})))
    assert any("verdict bad" in (given.get("class") or "") and "✘" in text for given, text in read.all("p"))
    sections = {given["id"]: text for given, text in read.all("section")}
    assert "curve.limit" in re.sub(r"\s", "", sections["change"])
    assert not {"locus", "run", "live"} & set(sections)


@pytest.mark.parametrize("change", [{"C_s": 0}, {"lambda": 0}])
def test_no_sliders_where_they_could_not_start(review, change):
    assert motion_sections.live(review) is not None
    assert motion_sections.live(replace(review, design=review.design.replace(**change))) is None


def luminance(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    r, g, b = (x / 12.92 if x <= 0.03928 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_and_lines_stand_out(scheme):
    colours = style.PAGE if scheme == "light" else {**style.PAGE, **style.DARK}
    for name in ("ink", "soft", "link", "good", "bad"):
        assert contrast(colours[name], colours["paper"]) >= LEAST_CONTRAST, name
        assert contrast(colours[name], colours["shade"]) >= LEAST_CONTRAST, name
    for name in ("good", "bad", "doubt"):
        assert contrast(colours[name], colours[f"{name}-back"]) >= LEAST_CONTRAST, name
    if scheme == "dark":
        lines = [x for x in colours if x.startswith(("series-", "becomes-")) or x in ("chosen", "before")]
        assert len(lines) == 11
        for name in lines:
            assert contrast(colours[name], colours["paper"]) >= LEAST_CONTRAST, name
        assert contrast(colours["ink"], colours["stable"]) >= LEAST_CONTRAST
        assert contrast(colours["ink"], colours["unstable"]) >= LEAST_CONTRAST


def run(*arguments):
    return CliRunner().invoke(app, ["report", *map(str, arguments)])


@pytest.fixture
def no_work(monkeypatch):
    """Fail where work begins before everything is checked."""
    monkeypatch.setattr(reviews, "optimise", lambda *_, **__: pytest.fail("it works already"))


@pytest.fixture
def file():
    return Path(__file__).parents[3] / "problems" / "trailer-bogie.yaml"


def test_what_cannot_be_written_is_said_before_work(no_work, file, tmp_path):
    there = tmp_path / "there.html"
    there.write_text("old", encoding="utf-8")
    for to, what in ((there, "exists"), (tmp_path / "x.pdf", ".html"), (tmp_path / "no" / "x.html", "no folder")):
        done = run(file, "--to", to)
        assert (done.exit_code, what in done.stderr) == (2, True), done.output
    assert there.read_text(encoding="utf-8") == "old"


@pytest.mark.parametrize(
    ("error", "code", "said"), [(KeyboardInterrupt(), 130, "interrupted"), (BrokenExecutor(), 3, "worker died")]
)
def test_what_ends_in_the_middle_leaves_no_page(file, tmp_path, monkeypatch, error, code, said):
    def ending(*_, **__):
        raise error

    monkeypatch.setattr(reviews, "design_review", ending)
    done = run(file, "--to", tmp_path / "a.html", "--jobs", 1)
    assert (done.exit_code, list(tmp_path.iterdir())) == (code, [])
    assert said in done.stderr


def test_no_browser_is_said_before_work(no_work, file, tmp_path, monkeypatch):
    monkeypatch.setattr(browser_print.shutil, "which", lambda name: None)
    done = run(file, "--to", tmp_path / "x.html", "--pdf", tmp_path / "x.pdf")
    assert done.exit_code == 2
    assert "needs a browser" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_written_page_is_whole_and_says_from_which_file(bare, file, tmp_path, monkeypatch):
    monkeypatch.setattr(reviews, "design_review", lambda *_, **__: bare)
    target = tmp_path / "page.html"
    done = run(file, "--to", target, "--set", "speed=250 km/h")
    assert done.exit_code == 0, done.output
    assert f"written: {target}" in done.stderr
    text = target.read_text(encoding="utf-8")
    assert hashlib.sha256(file.read_bytes()).hexdigest() in text
    assert "speed=250 km/h" in text
    assert text.endswith("</html>\n")

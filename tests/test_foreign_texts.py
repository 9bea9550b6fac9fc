"""Texts that a user, or somebody whose file a user opens, may write: shown as text by every command and picture."""

import csv
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.output.markup import picture, plain_text, tables
from yawdesign.output.notebooks import html
from yawdesign.output.pictures import write_picture
from yawdesign.output.tables import rendered

NASTY = (
    "<script>alert(1)</script>",
    "</title></svg><b onclick='x()'>",
    "]]> &amp; <!-- --> &#0;",
    "[red]x[/red] [link=http://a.b]y[/link] :bomb:",
    r"$\frac{1}$ \n \x1b[31m $$ a_b^c {",
    "%s {0} {} %(x)d ${y}",
    "right\u202eleft \u2066isolated\u2069",
    "e\u0301 combined Z\u0335\u0336",
    "\U0001f684 rail \U0001f468\u200d\U0001f527",
    "\u05d1\u05d5\u05d2\u05d9 \u0628\u0648\u062c\u064a 12",
    "=1+1",
    "-2+3 @SUM(A1)",
    "\"double\" 'single' `back` \\",
    "日本 台車",
)
QUICK = (0, 4, 6)  # of these, markup, mathematics and directions; the others are slow tests
TURNS = re.compile("[\u202a-\u202e\u2066-\u2069]")
CURVE = {"R": "300 m", "L": "19 m", "l": "60 m", "V_r": "90 km/h", "limit": 0.08}


def data(text):
    """Return a problem as a file has it, with a text wherever a text may stand."""
    dampers = [{"name": f"{text}{k}", "damping": 4e5 + 1e5 * k, "stiffness": 2e7} for k in range(2)]
    return {
        "title": text,
        "bogie": {"base": "table1", "C_s": "1 046 770 N s/m"},
        "speed": "300 km/h",
        "curve": CURVE,
        "conditions": {"load": {text: {"W": "210 kN"}, f"{text} 2": {"W": "190 kN"}}},
        "cases": {text: {"C_s": "50 %", "K_ds": "50 %"}},
        "requirements": {"damping_ratio": "1 %", "cases": {"damping_ratio": "0.1 %"}},
        "design": {"variables": {"C_s": {"min": "10 kN s/m", "max": "10 MN s/m"}}, "catalogue": dampers},
        "uncertainty": {"lambda": {"uniform": [0.1, 0.2]}},
    }


@pytest.fixture(
    params=[pytest.param(x, marks=() if k in QUICK else pytest.mark.slow, id=f"{k}") for k, x in enumerate(NASTY)]
)
def text(request):
    return request.param


@pytest.fixture
def file(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    Path("problem.yaml").write_text(json.dumps(data(text), ensure_ascii=False), encoding="utf-8")
    return "problem.yaml"


def squeezed(text):
    """Return a text without what a table puts between its lines."""
    return re.sub(r"[\s│┃─]+", "", text)


def as_shown(text):
    return squeezed(TURNS.sub("\ufffd", text))


def run(*arguments, codes=(0, 1)):
    done = CliRunner().invoke(app, [str(x) for x in arguments])
    assert done.exit_code in codes, done.output + repr(done.exception)
    assert not TURNS.search(done.output)
    assert "\x1b" not in done.output
    return done.output


@pytest.mark.parametrize("command", ["stability", "design", "choose"])
def test_what_commands_show(command, file, text):
    assert as_shown(text) in squeezed(run(command, file))


@pytest.mark.parametrize("arguments", [("modes", "--condition"), ("critical-speed",)])
def test_what_commands_show_of_conditions(arguments, file, text):
    command, *option = arguments
    assert as_shown(text) in squeezed(run(command, file, *option, *[f"load={text}"] * len(option)))


def test_json_has_it_as_it_was_written(file, text):
    done = CliRunner().invoke(app, ["choose", file, "--json"])
    assert json.loads(done.stdout)["candidates"][0]["name"].startswith(text)


def test_a_mistake_repeats_it_and_sends_no_control_characters(text, tmp_path):
    wrong = data(text) | {"cases": {text: {"C_s": f"{text}\x1b[31m"}}, text: 1}
    path = tmp_path / "wrong.yaml"
    path.write_text(json.dumps(wrong, ensure_ascii=False), encoding="utf-8")
    assert "wrong.yaml" in run("check", path, codes=(2,))


@pytest.mark.parametrize("name", ["a\x1b[31mb.yaml", "right\u202eyaml.py", "[red]a[/red].yaml", "<b>.yaml"])
def test_names_of_files_in_messages(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert name.replace("\x1b", r"\x1b").replace("\u202e", "\ufffd") in run("check", name, codes=(2,))
    run("stability", name, codes=(2,))


class Texts(HTMLParser):
    """Gathers the elements of a page, and the texts in them."""

    def __init__(self, page):
        super().__init__()
        self.elements, self.attributes, self.texts = set(), set(), []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.elements.add(tag)
        self.attributes |= {name for name, _ in attrs}

    def handle_data(self, data):
        self.texts.append(data)


OWN = {"div", "style", "table", "caption", "thead", "tbody", "tr", "th", "td", "bdi", "p"}


def test_html_of_problem_and_results(text, file):
    problem = yd.load(file)
    for shown in (problem, yd.stability(problem), yd.choose(problem)):
        page = Texts(html(shown))
        assert page.elements <= OWN
        assert page.attributes <= {"class", "scope"}
        assert TURNS.sub("\ufffd", text) in "".join(page.texts)


def test_lines_and_titles(text):
    assert TURNS.sub("\ufffd", text) in Texts(tables(text)).texts
    assert not {"<", ">", '"', "'"} & set(plain_text(text))
    assert as_shown(text) in squeezed(rendered(text))


def drawn(problem):
    """Yield pictures that hold texts of a problem."""
    plain = problem.replace(conditions={}, cases={}, requirements={}, uncertainty={})
    load = problem.conditions.loads[0].name
    yield yd.plot(yd.sweep(plain, of="stable", C_s=[1e5, 1e6]))
    yield yd.plot(yd.design(problem))
    yield yd.plot(yd.choose(problem))
    yield yd.plot(yd.critical_speed(problem))
    yield yd.plot(yd.modes(problem, condition={"load": load}))


def test_pictures(text, file, tmp_path):
    for k, ax in enumerate(drawn(yd.load(file))):
        write_picture(ax, tmp_path / f"{k}.png")
        write_picture(ax, tmp_path / f"{k}.svg")
        assert ElementTree.parse(tmp_path / f"{k}.svg").getroot().tag.endswith("svg")
        page = picture(ax, f"p{k}", text, text)
        found = ElementTree.fromstring(page)
        assert [each.text for each in list(found)[:2]] == [TURNS.sub("\ufffd", text)] * 2
        assert not {"script", "b"} & {each.tag.rpartition("}")[2] for each in found.iter()}
        assert not TURNS.search(page)


def test_films(text, file, tmp_path):
    problem = yd.load(file)
    modes = yd.modes(problem, condition={"load": problem.conditions.loads[0].name})
    yd.animate(modes, tmp_path / "a.svg")
    found = ElementTree.parse(tmp_path / "a.svg").getroot()
    texts = [each.text or "" for each in found.iter() if each.tag.endswith("text")]
    assert TURNS.sub("\ufffd", text) in " ".join(texts)
    page = Texts(yd.animate(modes)._repr_html_())
    assert page.elements == {"iframe"}
    assert "sandbox" in page.attributes


FORMULAS = ("=1+1", "+1", "-1", "@SUM(A1)", "a,=1+1", "b;@x")


@pytest.mark.parametrize("name", FORMULAS)
def test_no_cell_of_a_table_is_a_formula(name, tmp_path):
    loads = {name: {"W": "210 kN"}, f"{name} 2": {"W": "190 kN"}}
    problem = yd.table1().replace(title=name, conditions={"load": loads})
    result = yd.sweep(problem, of="stable", C_s=[1e5, 1e6])
    result.to_csv(tmp_path / "sweep.csv")
    lines = (tmp_path / "sweep.csv").read_text(encoding="utf-8").splitlines()
    assert json.loads(lines[1].removeprefix("# "))["problem"]["title"] == name
    point = {"rotational_resistance": 0.05, "margin": 1.0, "C_s": 1e6, "stable": True, "checked": True}
    point |= {"requirements": (), "worst_condition": {"speed": 80.0, "load": name}}
    front = yd.trade_off(yd.table1().replace(limit=0.001), points=2)
    replace(front, front=(point,)).to_csv(tmp_path / "front.csv")
    cells = [cell for line in lines for mark in ",;" for cell in next(csv.reader([line], delimiter=mark))]
    with (tmp_path / "front.csv").open(encoding="utf-8", newline="") as file:
        cells += [cell for row in csv.reader(file) for cell in row]
    assert [cell for cell in cells if cell[:1] in ("=", "+", "@") or cell[:2] == "-1"] == []

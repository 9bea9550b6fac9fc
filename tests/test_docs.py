"""The pages hold what they say: links lead somewhere, Python runs, commands and options exist."""

import re
import shutil
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
import typer

from yawdesign.cli import app

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
# What tests/test_examples_export.py, tests/test_examples_fmu.py and tests/test_readme.py run.
RUN_ELSEWHERE = {"README", "export", "export-casadi", "export-python-control", "fmu"}
RUN_HERE = {
    *("choose", "conditions", "critical-speed", "modes", "problem-file"),
    *("notebooks", "response", "sweeps", "trade-off", "uncertainty"),
}
COMMANDS = typer.main.get_command(app).commands

every_page = pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)


def headings(page):
    """Return the anchors of a page, made from its headings as hosting services do."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def links(text):
    return re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```|`[^`\n]*`(?!\])", "", text, flags=re.DOTALL))


@every_page
def test_links_lead_somewhere(page):
    for link in links(page.read_text(encoding="utf-8")):
        if not re.match(r"https?://|mailto:", link):
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            assert target.exists(), link
            assert not anchor or anchor in headings(target), link


def test_the_description_of_the_package_has_no_links_that_lead_nowhere_outside_the_repository():
    tools = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
    hook = tools["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert [link for link in links(text) if "://" not in link]
    for change in hook["substitutions"]:
        text = re.sub(change["pattern"], change["replacement"], text)
    assert not [link for link in links(text) if "://" not in link]
    assert "listed and mended (`docs/errata.md`)" in text


def test_links_are_found():
    assert links("[a](b.md) `[c](d)` [`e`](f.md#g)\n```\n[h](i)\n```\n![j](k.png)") == ["b.md", "f.md#g", "k.png"]


@every_page
def test_modules_that_a_page_names_are_there(page):
    for name in re.findall(r"`((?:[a-z_]+/)+[a-z_]+\.pyi?)`", page.read_text(encoding="utf-8")):
        assert (ROOT / name).exists() or (ROOT / "src" / "yawdesign" / name).exists(), name


def python_of(page):
    return re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@every_page
def test_python_of_every_page_is_run(page):
    assert bool(python_of(page)) == (page.stem in RUN_HERE | RUN_ELSEWHERE)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(RUN_HERE))
def test_python_of_a_page_runs(name, tmp_path, monkeypatch):
    """The blocks of a page run one after the other, in a folder with a problem file."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(ROOT / "problems" / "table1.yaml", "problem.yaml")
    names = {}
    for block in python_of(ROOT / "docs" / f"{name}.md"):
        exec(compile(block, f"{name}.md", "exec"), names)
    plt.close("all")


@every_page
def test_commands_and_their_options_exist(page):
    for name, arguments in commands_of(page.read_text(encoding="utf-8")):
        assert name in COMMANDS, f"yawdesign {name}"
        known = {option for parameter in COMMANDS[name].params for option in parameter.opts}
        assert set(re.findall(r"(?<!\S)--[a-z][\w-]*", arguments)) <= known | {"--help"}, f"yawdesign {name}{arguments}"


def commands_of(text):
    """Yield the command lines of a page with the name of the command and what follows it."""
    return re.findall(r"(?:^|`|/bin/)yawdesign ([a-z][\w-]*)([^`|\n]*)", text, re.MULTILINE)


def test_commands_are_found():
    text = "`yawdesign new` and\nyawdesign sweep x --of C_sl\n.venv/bin/yawdesign design y"
    assert commands_of(text) == [("new", ""), ("sweep", " x --of C_sl"), ("design", " y")]

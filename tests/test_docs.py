"""The pages hold what they say: links lead somewhere, Python runs, commands and options exist."""

import importlib.util
import itertools
import re
import sys
import tomllib
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
import typer
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("docs/api/*.md")])
# What tests/test_examples_fmu.py, tests/test_readme.py and .ci/run run, and what tests/exports/test_octave.py does.
RUN_ELSEWHERE = {"README", "CONTRIBUTING", "fmu"}
READ_ELSEWHERE = {"matlab", "text", "{toctree}", "{eval-rst}"}
# What a part of a problem file on a page lacks.
NEEDED = {"bogie:": "bogie: {base: table1}", "speed:": "speed: 300 km/h"}


def of_file(path):
    """Return the module that a file holds."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


BLOCKS = of_file(ROOT / "docs" / "blocks.py")
RUN_HERE = {page.stem for page in PAGES if {block.language for block in BLOCKS.blocks(page)} & {"python", "sh"}}
RUN_HERE -= RUN_ELSEWHERE
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


@every_page
def test_every_block_is_run_or_read_by_a_test(page):
    """Of a language that is run here, or a file for what follows, or what a block before prints."""
    for block in BLOCKS.blocks(page):
        known = block.mark.startswith("file ") or block.language in {"python", "sh", "yaml", *READ_ELSEWHERE}
        assert known, f"{page.name}:{block.line}: {block.language or 'a block without a language'}"
        assert not block.printed or block.language in {"python", "sh"}, f"{page.name}:{block.line} prints nothing"
    assert escaped(page.read_text(encoding="utf-8")) == []


def escaped(text):
    """Return lines of a page that look like a block, or a command of one, and are none that is found."""
    rest = BLOCKS.BLOCK.sub("", text)
    programs = "yawdesign|python3?|pip|import|from|>>>|\\$|print"
    return re.findall(rf"^.*(?:```|~~~).*$|^(?: {{4}}|\t) *(?:{programs})\b.*$", rest, re.MULTILINE)


def test_blocks_that_escape_are_found():
    text = "```sh\na\n```\n\n~~~sh\nb\n~~~\n  ```sh\n  c\n  ```\n\n    yawdesign new\n```{code-block} python\nd\n```\n"
    found = ["~~~sh", "~~~", "  ```sh", "  ```", "    yawdesign new", "```{code-block} python", "```"]
    assert escaped(text) == found


@pytest.mark.slow
@pytest.mark.parametrize("page", [page for page in PAGES if page.stem in RUN_HERE], ids=lambda page: page.stem)
def test_a_page_runs(page, tmp_path, monkeypatch):
    """The blocks run one after the other, in a folder with a problem file, and print what the page says."""
    BLOCKS.prepare(tmp_path)
    monkeypatch.setenv("CFLAGS", "-O0")
    BLOCKS.run(page, tmp_path)
    plt.close("all")


def test_commands_that_install_are_run_in_continuous_integration():
    run = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    marks = [block.mark for block in BLOCKS.blocks(ROOT / "README.md") if block.language == "sh"]
    assert marks == ["run", "test"]
    assert all(f"run_readme {mark}" in run for mark in marks)
    here = run + (ROOT / "README.md").read_text(encoding="utf-8")
    for block in (block for block in BLOCKS.blocks(ROOT / "CONTRIBUTING.md") if block.language == "sh"):
        for command in re.split(r" && |\n", block.text.strip()):
            words = command.removeprefix(".venv/bin/")
            assert words in here or words.replace("install ", "install -q ") in here, command


def test_all_pictures_stand_on_one_page_and_are_drawn_by_one_script():
    figures = ROOT / "docs" / "figures"
    named = re.findall(r"\(figures/(\S+?)\)", (ROOT / "docs" / "pictures.md").read_text(encoding="utf-8"))
    assert sorted(named) == sorted(path.name for path in figures.iterdir() if path.suffix in (".png", ".svg"))
    drawing = of_file(ROOT / "docs" / "draw_pictures.py")
    code = "".join((ROOT / script).read_text(encoding="utf-8") for script in drawing.SCRIPTS)
    lines = "".join(block.text for page in drawing.PAGES for block in BLOCKS.blocks(ROOT / "docs" / page))
    for name in named:
        stem = "yd.reproduce().drawn" if name.startswith("fig") else Path(name).stem
        drawn = stem in code or name in lines or name == "rooms.svg"
        assert drawn, f"docs/draw_pictures.py does not draw {name}"


def test_every_public_name_stands_in_the_reference():
    pages = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs" / "api").glob("*.md"))
    named = re.findall(r"^\.\. auto\w+:: yawdesign\.(\w+)$", pages, re.MULTILINE)
    assert sorted(named) == sorted(yd.__all__)


@every_page
def test_extras_that_a_page_installs_exist(page):
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    named = re.findall(r'install (?:-\S+ )?"(?:yawdesign|\.)\[([\w,]+)\]"', page.read_text(encoding="utf-8"))
    assert {extra for names in named for extra in names.split(",")} <= set(extras)


@every_page
def test_problem_files_on_a_page_can_be_read(page, tmp_path, monkeypatch):
    """A part of one is read with the rest from Table I; behind a mistaken one stands what `check` prints of it."""
    monkeypatch.chdir(tmp_path)
    found = BLOCKS.blocks(page)
    for file in (block for block in found if block.mark.startswith("file ")):
        Path(file.mark.removeprefix("file ")).write_text(file.text, encoding="utf-8")
    for block, following in itertools.zip_longest(found, found[1:]):
        messages = following is not None and following.language == "text" and not following.mark
        assert not messages or block.language == "yaml", f"{page.name}:{following.line}: messages of what?"
        if messages:
            Path("problem.yaml").write_text(block.text, encoding="utf-8")
            BLOCKS.compare(following.text, CliRunner().invoke(app, ["check", "problem.yaml"]).output, page.name)
        elif block.language == "yaml":
            with warnings.catch_warnings(action="ignore"):
                yd.loads("".join(f"{line}\n" for key, line in NEEDED.items() if key not in block.text) + block.text)


def test_blocks_are_found_and_compared(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "<!-- file a.txt -->\n```\nx\n```\n\n```python\nprint(2)\n```\n\nprints\n\n```\n...\n2\n```\n"
        "```sh\ncat a.txt && \\\n  false # exit code 1\n```\n"
    )
    written, python, shell = BLOCKS.blocks(page)
    assert (written.mark, python.printed, shell.line) == ("file a.txt", "...\n2\n", 16)
    BLOCKS.run(page, tmp_path)
    page.write_text(page.read_text().replace("print(2)", "print(3)"))
    with pytest.raises(AssertionError, match="does not print: 2"):
        BLOCKS.run(page, tmp_path)
    page.write_text("```sh\nfalse\n```\n")
    with pytest.raises(AssertionError, match="ends with 1, not 0"):
        BLOCKS.run(page, tmp_path)
    BLOCKS.compare("a  1\nb 2", "│ a │ 1 │\n│ b │ 2 │", "here")


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

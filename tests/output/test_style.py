"""Colours stand in one module, so that one meaning has one look in all pictures and pages."""

import re
from pathlib import Path

import pytest

import yawdesign
from yawdesign.output import style
from yawdesign.output.markup import page_colours

ROOT = Path(yawdesign.__file__).parent
LITERAL = re.compile(r"#[0-9a-fA-F]{6}\b|[\"'](?:white|black|red|green|blue|gr[ae]y|orange|tab:\w+)[\"']")
TERMINAL = {"response_tables.py"}  # colours of letters in a terminal


def literals(text):
    return LITERAL.findall(text)


def test_no_other_module_names_a_colour():
    sources = [path for kind in ("*.py", "*.css", "*.js") for path in (ROOT / "output").rglob(kind)]
    found = {path.name: literals(path.read_text(encoding="utf-8")) for path in sources}
    assert found.pop("style.py")
    assert {name for name, colours in found.items() if colours} <= TERMINAL
    assert len(found) > 40


@pytest.mark.parametrize("line", ["x = '#1f4e9e'", 'markerfacecolor="white"', "a { color: #ff9d92 }"])
def test_a_colour_is_found(line):
    assert literals(line)


def test_a_page_has_every_colour_for_both_kinds_of_screen():
    light, dark = page_colours().split("@media")
    for name in style.PAGE:
        assert f"--{name}: {style.PAGE[name]};" in light
        assert f"--{name}: {style.DARK[name]};" in dark

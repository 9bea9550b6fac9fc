"""A damper that is new, over each wheelset, takes two rows of the parameter table and a link in the catalogue.

A copy of the package gets these two edits and nothing else; what is then asked of it stands in end_damper.py.
"""

import ast
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import yawdesign

QUESTIONS = Path(__file__).with_name("end_damper.py")
TESTS = {
    node.name: "slow" in "".join(map(ast.unparse, node.decorator_list))
    for node in ast.parse(QUESTIONS.read_text(encoding="utf-8")).body
    if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
}
QUICK, SLOW = ([name for name, slow in TESTS.items() if slow == which] for which in (False, True))
OWN = Path(yawdesign.__file__).parent

LINK = """\
        Pair((Link(
            (Maxwell(p["K_de"] / 2, p["C_e"]),),
            {"y_b": 1, **_height(p, -1, "h_2t"), **_above(p, "h_t")},
            lever={"phi_b": p["a"], **({"psi_c": times(-1, p["a"])} if body else {})},
            outer={"psi_c": times(-1, p["l_c"])} if body else {},
            name="end damper",
        ),)),
"""
NEXT_TO = "        Pair((lateral_damper,)),\n"


def with_rows(text):
    """Return the parameter table with two more rows, those of the secondary lateral dampers under other names."""
    for old, new, symbol, of in (
        ("C_t", "C_e", r"C_\mathrm{e}", "of each end damper"),
        ("K_dt", "K_de", r"K_\mathrm{de}", "of an end damper"),
    ):
        (row,) = re.findall(rf"^    {old}: .*?\)\n(?=    \w+: |\n)", text, re.DOTALL | re.MULTILINE)
        copy = row.replace(f"    {old}: ", f"    {new}: ")
        copy = re.sub(r"[CK]_\\mathrm\{d?t\}", lambda _, symbol=symbol: symbol, copy)
        copy = re.sub(r"of (the pair of secondary lateral dampers|a secondary lateral damper)", of, copy)
        assert [copy.count(part) for part in (f" {new}:", f'r"{symbol}"', of)] == [1, 1, 1]
        text = text.replace(row, row + copy)
    return text


def with_link(text):
    """Return the catalogue with one more pair of dampers on the frame."""
    assert text.count(NEXT_TO) == 1
    return text.replace(NEXT_TO, NEXT_TO + LINK)


EDITS = {Path("problem/parameters.py"): with_rows, Path("vehicle/catalogue.py"): with_link}


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Return a folder with a copy of the package in which the bogie has an end damper."""
    folder = tmp_path_factory.mktemp("package")
    shutil.copytree(OWN, folder / "yawdesign", ignore=shutil.ignore_patterns("__pycache__"))
    for path, edit in EDITS.items():
        text = (OWN / path).read_text(encoding="utf-8")
        (folder / "yawdesign" / path).write_text(edit(text), encoding="utf-8")
    return folder


def answers(package, mark):
    """Return by the name of each test what failed in it."""
    report = package / "report.xml"
    command = [sys.executable, "-m", "pytest", "-q", "-m", mark, f"--junitxml={report}", str(QUESTIONS)]
    environment = {**os.environ, "PYTHONPATH": str(package), "MPLBACKEND": "agg"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    found = {}
    for case in ET.parse(report).getroot().iter("testcase") if report.exists() else ():
        failed = [child.text for child in case if child.tag in ("failure", "error")]
        found.setdefault(case.get("name").split("[")[0], []).extend(failed)
    return found if found.keys() <= TESTS.keys() else {name: [done.stdout + done.stderr] for name in TESTS}


@pytest.fixture(scope="module")
def quick(package):
    return answers(package, "not slow")


@pytest.fixture(scope="module")
def slow(package):
    return answers(package, "slow")


@pytest.mark.parametrize("name", QUICK)
def test_an_end_damper(name, quick):
    if quick[name]:
        pytest.fail("\n".join(quick[name]), pytrace=False)


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_an_end_damper_slow(name, slow):
    if slow[name]:
        pytest.fail("\n".join(slow[name]), pytrace=False)


def test_the_table_and_the_catalogue_are_all_it_takes(package):
    changed = {}
    for path in (path.relative_to(OWN) for path in OWN.rglob("*.*") if "__pycache__" not in path.parts):
        old, new = (OWN / path).read_bytes(), (package / "yawdesign" / path).read_bytes()
        if old != new:
            changed[path] = len(new.splitlines()) - len(old.splitlines())
    assert set(changed) == set(EDITS)
    assert sum(changed.values()) <= 20

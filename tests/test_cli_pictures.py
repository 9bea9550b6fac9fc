"""The option --plot: a picture beside the answer, checked before the work and never in the place of another file."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from yawdesign.cli import app
from yawdesign.output.plots import DRAWN_BY

PROBLEM = """
bogie: {base: table1}
speed: 300 km/h
curve: {R: 300 m, L: 19 m, l: 60 m, V_r: 90 km/h}
design:
  variables: {C_s: {min: 10 kN s/m, max: 10 MN s/m}}
"""
CATALOGUE = "  catalogue: [{name: A, damping: 500 kN s/m, stiffness: 20 MN/m}]\n"
COMMANDS = {
    "stability": "Stability",
    "design": "ForwardDesign",
    "critical-speed": "CriticalSpeeds",
    "optimise": "Optimum",
    "choose": "Choice",
}


@pytest.fixture
def run(tmp_path):
    def command(name, *options):
        path = tmp_path / "p.yaml"
        path.write_text(PROBLEM + (CATALOGUE if name == "choose" else ""), encoding="utf-8")
        return CliRunner().invoke(app, [name, str(path), *map(str, options)])

    return command


@pytest.mark.parametrize("command", [x for x, result in COMMANDS.items() if result in DRAWN_BY])
def test_a_picture_beside_json(command, run, tmp_path):
    picture = tmp_path / "a.svg"
    done = run(command, "--plot", picture, "--json")
    assert done.exit_code in (0, 1), done.stderr
    assert json.loads(done.stdout)
    assert done.stderr.splitlines()[-1] == f"wrote {picture}"
    assert picture.read_bytes().startswith(b"<?xml")


@pytest.mark.parametrize("command", COMMANDS)
def test_what_cannot_be_written_is_known_before_the_work(command, run, tmp_path):
    there = tmp_path / "there.png"
    there.write_text("mine")
    for name, why in (("a.jpg", "must end in .png"), ("there.png", "exists"), ("no/a.png", "there is no folder")):
        done = run(command, "--plot", tmp_path / name)
        assert done.exit_code == 2
        assert f"error: --plot: {tmp_path / name}" in done.stderr
        assert why in done.stderr
    assert there.read_text() == "mine"


def test_a_picture_is_replaced_where_that_is_asked_for(run, tmp_path):
    there = tmp_path / "there.png"
    there.write_text("mine")
    assert run("design", "--plot", there, "--force").exit_code == 0
    assert there.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("command", "files"),
    [
        (["sweep", "--of", "stable", "--over", "v=200 km/h:300 km/h:3"], {"--csv": "a.csv", "--npz": "a.npz"}),
        (["modes"], {"--plot": "a.png"}),
        (["simulate", "--duration", "3 s"], {"--csv": "a.csv", "--npz": "a.npz"}),
    ],
)
def test_what_was_written_is_said(command, files, run, tmp_path):
    options = [part for option, name in files.items() for part in (option, tmp_path / name)]
    done = run(*command, *options)
    assert done.exit_code in (0, 1), done.stderr
    told = [Path(line.removeprefix("wrote ")).name for line in done.stderr.splitlines() if line.startswith("wrote ")]
    assert told == list(files.values())
    assert "wrote" not in done.stdout


@pytest.mark.parametrize("command", ["optimise", "trade-off"])
def test_an_answer_without_a_picture_is_shown(command, run, tmp_path):
    done = run(command, "--set", "limit=0.001", "--plot", tmp_path / "a.svg", "--json")
    assert done.exit_code == 1
    assert json.loads(done.stdout)["status"] == "infeasible"
    assert f"note: {tmp_path / 'a.svg'} is not written: there is nothing to draw: infeasible" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["p.yaml"]

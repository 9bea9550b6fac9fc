"""A worker that dies ends no command with a traceback, and leaves nothing that is half an answer."""

import os
from functools import partial
from pathlib import Path

import pytest
from typer.testing import CliRunner

from yawdesign.cli import app
from yawdesign.study import executors

PROBLEM = Path(__file__).parents[1] / "problems" / "table1-catalogue.yaml"
UNCERTAIN = ("--set", "uncertainty={lambda: {uniform: [0.1, 0.2]}}")
COMMANDS = {
    "report": ("--to", "x.html"),
    "optimise": ("--xlsx", "x.xlsx"),
    "choose": ("--xlsx", "x.xlsx"),
    "uncertainty": ("--xlsx", "x.xlsx", *UNCERTAIN),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_dead_worker_is_said(command, tmp_path, monkeypatch):
    monkeypatch.setattr(executors, "_leave_interrupts", partial(os._exit, 1))  # every worker ends as it begins
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [command, str(PROBLEM), "--jobs", "2", *COMMANDS[command]])
    assert isinstance(done.exception, SystemExit), done.exception
    assert (done.exit_code, "a worker died" in done.stderr) == (3, True), done.output
    assert not list(tmp_path.iterdir())

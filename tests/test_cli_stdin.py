"""A problem from standard input, and what `check` finds as JSON."""

import io
import json
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from yawdesign.cli import app
from yawdesign.cli.answering import report_of

TABLE_1 = "bogie: {base: table1}\nspeed: 300 km/h\n"


def run(*command, text=TABLE_1):
    return CliRunner().invoke(app, list(map(str, command)), input=text)


def test_a_problem_from_standard_input():
    done = run("stability", "-", "--json", "--set", "C_s=50 kN s/m")
    assert done.exit_code == 1
    assert json.loads(done.stdout)["C_s"] == 5e4
    assert "keyboard" not in done.stderr


def test_messages_name_standard_input():
    done = run("design", "-", text="bogie: {base: table1, K_ds: 3 kg}\nspeed: 300 km/h")
    assert done.exit_code == 2
    assert "<stdin>:1:29: error: bogie.K_ds: 3 kg is a mass" in done.stderr
    assert "<stdin>:1:1: error: the file is empty" in run("check", "-", text="").stderr
    assert run("check", "-").stdout == "<stdin>: no errors\n"


def test_a_catalogue_is_looked_for_in_the_current_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("d.csv").write_text("name,damping [kN s/m],stiffness [MN/m]\nA,400,20\n", encoding="utf-8")
    assert run("check", "-", text=TABLE_1 + "design: {catalogue: d.csv}").exit_code == 0
    done = run("check", "-", text=TABLE_1 + "design: {catalogue: e.csv}")
    assert "e.csv cannot be read" in done.stderr


def test_no_more_is_read_than_a_problem_file_holds(monkeypatch):
    class Endless(io.RawIOBase):
        taken = 0

        def readable(self):
            return True

        def readinto(self, buffer):
            buffer[:] = b"#" * len(buffer)
            self.taken += len(buffer)
            assert self.taken < 2e6
            return len(buffer)

    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BufferedReader(Endless())))
    problem, (found,) = report_of("-", None)
    assert problem is None
    assert found.render() == "<stdin>: error: is larger than 256 KiB"


def test_somebody_at_a_terminal_is_told_what_is_waited_for(monkeypatch):
    class Keyboard(io.TextIOWrapper):
        def isatty(self):
            return True

    told = []
    monkeypatch.setattr(sys, "stdin", Keyboard(io.BytesIO(TABLE_1.encode())))
    monkeypatch.setattr("yawdesign.cli.answering.tell", told.append)
    assert report_of("-", None)[0] is not None
    assert told == ["reading the problem from the keyboard: end it with Ctrl-D on a line of its own"]


@pytest.mark.parametrize("text", [TABLE_1, TABLE_1.replace("300 km/h", "90"), TABLE_1.replace("300 km/h", "3 kg")])
def test_check_as_json(text, tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text(text, encoding="utf-8")
    done = run("check", path, "--json")
    found = json.loads(done.stdout)
    assert found["file"] == str(path)
    assert done.exit_code == (2 if found["errors"] else 0)
    messages = [(each["line"], each["column"], each["key"]) for each in found["errors"] + found["warnings"]]
    assert messages == ([] if text == TABLE_1 else [(2, 8, "speed")])
    assert bool(found["errors"]) == ("kg" in text)
    assert done.stderr == ""


def test_check_as_json_has_the_mistakes_of_all_files_and_options(tmp_path):
    (tmp_path / "d.csv").write_text("name,damping [kN s/m],stiffness [MN/m]\nA,x,20\nB,400,y\n", encoding="utf-8")
    path = tmp_path / "p.yaml"
    path.write_text("bogie: {base: table1, M_q: 3}\nspeed: 300 km/h\ndesign: {catalogue: d.csv}\n", encoding="utf-8")
    done = run("check", path, "--json", "--set", "C_S=3")
    found = json.loads(done.stdout)["errors"]
    assert done.exit_code == 2
    assert {(each["file"] and Path(each["file"]).name, each["line"]) for each in found} == {
        (None, None),
        ("p.yaml", 1),
        ("d.csv", 2),
        ("d.csv", 3),
    }
    assert {"--set C_S=3", "bogie.M_q"} <= {each["key"] for each in found}


def test_a_file_that_is_not_there_as_json(tmp_path):
    done = run("check", tmp_path / "none.yaml", "--json")
    assert done.exit_code == 2
    assert json.loads(done.stdout)["errors"][0]["message"] == "cannot be read: No such file or directory"

"""The command line: exit codes, JSON by the contract, messages, and what is not imported."""

import builtins
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from yawdesign.cli import app, main
from yawdesign.problem import schema

PROBLEMS = Path(__file__).parents[1] / "problems"
RUN = CliRunner()
HEAVY = {"casadi", "numpy", "scipy", "matplotlib"}
DESIGN_KEYS = {"critical", "stable_intervals", "C_sl", "C_su", "C_s", "status", "stable", "sensitivity"}


def run(*arguments):
    return RUN.invoke(app, [str(a) for a in arguments])


def answer(*arguments, code=0):
    result = run(*arguments, "--json")
    assert result.exit_code == code, result.output
    return json.loads(result.stdout)


def test_stability_json():
    data = answer("stability", PROBLEMS / "table1.yaml")
    assert set(data) >= {"stable", "spectral_abscissa", "decay_rate", "damping_ratio", "eigenvalues", "C_s", "speed"}
    assert data["worst_condition"] == {"speed": pytest.approx(300 / 3.6)}
    assert (data["cases"], data["requirements"]) == ([], [])
    assert data["spectral_abscissa"] == pytest.approx(-1.2985370178, rel=1e-9)
    assert len(data["eigenvalues"]) == 25
    assert data["stable"] is True


def test_design_json():
    data = answer("design", PROBLEMS / "table1.yaml")
    assert set(data) >= DESIGN_KEYS
    assert data["C_sl"] == pytest.approx(90702.88978, rel=1e-9)
    assert data["stable_intervals"][0][1] is None
    assert data["critical"][0].keys() >= {"C_s", "omega", "becomes"}


def test_optimise_json_and_alias(tmp_path):
    text = (PROBLEMS / "table1.yaml").read_text()
    file = tmp_path / "one.yaml"
    file.write_text(text[: text.index("  variables:")] + "  variables:\n    C_s: {min: 10 kN s/m, max: 10 MN s/m}\n")
    data = answer("optimize", file)
    keys = {"optimum", "C_s", "objective", "margin", "margin_before", "worst_condition", "active", "status", "C_su"}
    keys |= {"rotational_resistance", "fixed_modes", "requirements", "cases", "forward"}
    assert set(data) >= keys
    assert not {"C_sl", "critical", "stable_intervals", "sensitivity"} & set(data)  # of the golden section
    assert set(data["forward"]) >= DESIGN_KEYS
    assert set(data["optimum"]) == {"C_s", "K_m", "C_m"}
    assert data["C_s"] == data["optimum"]["C_s"] != data["forward"]["C_s"]
    assert (data["status"], data["forward"]["status"]) == ("optimal", "ok")
    assert data["worst_condition"] == {"speed": pytest.approx(300 / 3.6)}
    assert data["margin"] > data["margin_before"]


def test_tables_are_printed():
    text = run("design", PROBLEMS / "trailer-bogie.yaml").stdout
    assert "440.662 kN·s/m" in text
    assert "Q = W" in text
    assert "UNSTABLE" not in run("stability", PROBLEMS / "table1.yaml").stdout


def changed(tmp_path, old, new):
    file = tmp_path / "changed.yaml"
    text = (PROBLEMS / "table1.yaml").read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    return file


def test_unstable_is_exit_code_1(tmp_path):
    file = changed(tmp_path, "C_s: 1 000 kN·s/m", "C_s: 50 kN·s/m   ")
    assert answer("stability", file, code=1)["stable"] is False


def test_no_design_is_exit_code_1(tmp_path):
    file = changed(tmp_path, "limit: 0.08", "limit: 0.001")
    data = answer("design", file, code=1)
    assert data["C_s"] is None
    assert data["status"].startswith("infeasible")


def test_missing_damping_is_bad_input(tmp_path):
    result = run("stability", changed(tmp_path, "  C_s: 1 000 kN·s/m", "  # "))
    assert result.exit_code == 2
    assert "C_s is missing" in result.stderr


@pytest.mark.parametrize("command", ["stability", "design", "optimise", "check"])
def test_bad_input_is_exit_code_2(tmp_path, command):
    file = changed(tmp_path, "K_1x: 40 MN/m", "K_1x: -40 MN/m")
    result = run(command, file)
    assert result.exit_code == 2
    assert "changed.yaml:" in result.stderr
    assert "bogie.K_1x" in result.stderr
    assert result.stdout == ""
    assert run(command, tmp_path / "missing.yaml").exit_code == 2
    assert run(command, tmp_path).exit_code == 2


def test_usage_error_is_exit_code_2():
    assert run("design").exit_code == 2
    assert run("desing").exit_code == 2


def test_new_check_and_force(tmp_path):
    for kind in ("power", "trailer"):
        file = tmp_path / f"{kind}.yaml"
        assert run("new", file, "--kind", kind).exit_code == 0
        assert run("check", file).exit_code == 0
    before = file.read_text()
    refused = run("new", file)
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    assert file.read_text() == before
    assert run("new", file, "--force").exit_code == 0
    assert file.read_text() != before
    assert run("new", tmp_path / "no" / "such" / "folder.yaml").exit_code == 2
    assert run("new", tmp_path / "x.yaml", "--kind", "wagon").exit_code == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["power.yaml", "problem.schema.json", "trailer.yaml"]


def test_new_writes_the_schema_that_its_first_line_names(tmp_path):
    done = run("new", tmp_path / "problem.yaml")
    assert (done.exit_code, done.stderr) == (0, "")
    name = re.match(r"# yaml-language-server: \$schema=(\S+)\n", (tmp_path / "problem.yaml").read_text())[1]
    written = tmp_path / name
    assert json.loads(written.read_text(encoding="utf-8")) == schema()
    assert written.read_text(encoding="utf-8") == run("schema").stdout
    assert run("new", tmp_path / "second.yaml").stderr == ""


def test_new_keeps_another_file_of_the_schemas_name(tmp_path):
    mine = tmp_path / "problem.schema.json"
    mine.write_text("mine")
    done = run("new", tmp_path / "problem.yaml")
    assert done.exit_code == 0
    assert f"note: {mine} was there and is kept" in done.stderr
    assert mine.read_text() == "mine"
    assert run("new", tmp_path / "problem.yaml", "--force").stderr == ""
    assert json.loads(mine.read_text(encoding="utf-8")) == schema()
    refused = run("new", mine, "--force")
    assert refused.exit_code == 2
    assert "choose another name" in refused.stderr
    assert json.loads(mine.read_text(encoding="utf-8")) == schema()


def test_new_to_a_device_writes_nothing_beside_it():
    assert run("new", "/dev/null", "--force").exit_code == 0
    assert not Path("/dev/problem.schema.json").exists()


def test_schema_is_json():
    assert json.loads(run("schema").stdout)["$schema"]


def test_console_without_unicode():
    command = [sys.executable, "-m", "yawdesign", "stability", str(PROBLEMS / "table1.yaml")]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = subprocess.run(command, capture_output=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    assert b"stable" in done.stdout
    assert done.stderr == b""


@pytest.mark.slow
def test_as_a_module():
    """The package itself runs as the command, and its processes find their way back to it."""
    command = [sys.executable, "-m", "yawdesign", "sweep", PROBLEMS / "table1.yaml", "--of", "stable", "--jobs", "2"]
    done = subprocess.run([*command, "--over", "C_s=1e4:1e6:3", "--json"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["values"] == [False, True, True]


def completed(shell, words):
    """Return what a shell is told for the last of some words, and the heavy libraries that were imported for it."""
    code = "import sys\nfrom yawdesign.cli import app\ntry: app(prog_name='yawdesign')\nfinally: print(*sys.modules)"
    variables = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" ")), "_TYPER_COMPLETE_ARGS": words}
    more = {"_TYPER_COMPLETE_FISH_ACTION": "get-args", "_TYPER_COMPLETE_WORD_TO_COMPLETE": words.split()[-1]}
    environment = {**os.environ, "_YAWDESIGN_COMPLETE": f"complete_{shell}", **variables, **more}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=False)
    assert done.stderr == ""
    *lines, modules = done.stdout.splitlines()
    return "\n".join(lines), HEAVY & set(modules.split())


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish", "powershell"])
def test_completion_of_commands_and_options(shell):
    for words, wanted in (("yawdesign opt", "optimise"), ("yawdesign sweep --ov", "--over")):
        text, heavy = completed(shell, words)
        assert wanted in text
        assert not heavy


def test_completion_says_how_it_is_set_up():
    shown = run("--help").stdout
    assert "--install-completion" in shown
    assert "--show-completion" in shown


def test_options_that_take_a_file_say_so():
    commands = get_command(app).commands.values()
    files = {"csv", "npz", "plot", "xlsx", "resume"}
    shown = {(command.name, each.name): each.metavar for command in commands for each in command.params}
    assert {key: text for key, text in shown.items() if key[1] in files and text != "FILE"} == {}
    assert ("sweep", "resume") in shown


def test_help_is_light():
    """--help must answer at once: none of the heavy libraries is imported."""
    code = (
        "import sys\nfrom yawdesign.cli import app\n"
        "try: app(['--help'])\nexcept SystemExit: pass\n"
        f"heavy = {HEAVY} & set(sys.modules)\n"
        "sys.exit(f'imported {heavy}' if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "optimise" in done.stdout


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_request_to_stop_ends_any_command_tidily(number, tmp_path, monkeypatch, capsys):
    """Also SIGTERM and a closed terminal: what stands beside an output is removed."""

    def asked(content, *more):
        assert len(list((tmp_path / "out").iterdir())) == 1
        signal.raise_signal(number)

    monkeypatch.setattr("yawdesign.exports.write.write_text", asked)
    folder = ("--to", str(tmp_path / "out"), "--only", "dynamic_stiffness", "--formats", "c")
    monkeypatch.setattr(sys, "argv", ["yawdesign", "export", str(PROBLEMS / "table1.yaml"), *folder])
    before = [signal.getsignal(x) for x in signal.valid_signals()]
    with pytest.raises(SystemExit) as caught:
        main()
    assert caught.value.code == 128 + number
    assert capsys.readouterr().err == "interrupted\n"
    assert list(tmp_path.iterdir()) == []
    assert [signal.getsignal(x) for x in signal.valid_signals()] == before


def test_a_request_to_stop_while_the_program_starts_has_no_traceback(monkeypatch, capsys):
    asked, imported = [], builtins.__import__

    def importing(name, *more):
        if name == "yawdesign.problem.stopping" and not asked:
            asked.append(name)
            raise KeyboardInterrupt
        return imported(name, *more)

    monkeypatch.setattr("yawdesign.problem.stopping.ignore_requests", lambda: None)
    monkeypatch.setattr(builtins, "__import__", importing)
    with pytest.raises(SystemExit) as caught:
        main()
    assert caught.value.code == 130
    assert capsys.readouterr().err == "interrupted\n"

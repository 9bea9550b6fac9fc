"""No command replaces a file unasked, nor one that it reads; two outputs are two files."""

import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.output.targets import Target, checked_targets

PROBLEM = Path(__file__).parents[2] / "problems" / "table1.yaml"
SHORT = ("--duration", "1 s", "--start", "rest")


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.yaml").write_text(PROBLEM.read_text())


def run(*arguments, code):
    result = CliRunner().invoke(app, list(map(str, arguments)))
    assert result.exit_code == code, result.output + str(result.exception)
    return result


@pytest.mark.parametrize(
    ("command", "option", "file"),
    [
        (("sweep", "p.yaml", "--over", "v=70:80:2"), "--csv", "x.csv"),
        (("sweep", "p.yaml", "--over", "v=70:80:2"), "--npz", "x.npz"),
        (("sweep", "p.yaml", "--over", "v=70:80:2"), "--plot", "x.svg"),
        (("simulate", "p.yaml", *SHORT), "--csv", "x.csv"),
        (("simulate", "p.yaml", *SHORT), "--npz", "x.npz"),
        (("simulate", "p.yaml", *SHORT), "--plot", "x.svg"),
        (("modes", "p.yaml"), "--plot", "x.svg"),
        (("modes", "p.yaml"), "--to", "x.svg"),
        (("new",), "", "x.yaml"),
    ],
)
def test_a_file_is_replaced_only_by_force_and_keeps_its_mode(command, option, file, monkeypatch):
    path = Path(file)
    path.write_text("mine")
    path.chmod(0o600)
    arguments = (*command, option, file) if option else (*command, file)
    refused = run(*arguments, code=2)
    assert f"{file} exists: choose another name, or give --force to replace it" in refused.stderr
    assert path.read_text() == "mine"
    run(*arguments, "--force", code=0)
    assert path.read_bytes() != b"mine"
    assert path.stat().st_mode & 0o777 == 0o600
    beside = ["problem.schema.json"] if command == ("new",) else []
    assert sorted(x.name for x in Path().iterdir()) == sorted(["p.yaml", file, *beside])


@pytest.mark.parametrize(
    "arguments",
    [
        ("sweep", "p.yaml", "--over", "v=70:80:2", "--npz", "p.yaml"),
        ("simulate", "p.yaml", "--track", "t.csv", "--csv", "t.csv"),
        ("modes", "p.svg", "--plot", "p.svg"),
        ("modes", "p.svg", "--to", "p.svg"),
    ],
)
def test_what_a_command_reads_is_not_replaced_by_force_either(arguments):
    Path("t.csv").write_text("distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, {k % 7}" for k in range(1000)))
    Path("p.svg").write_text(PROBLEM.read_text())
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert "is what the command reads" in run(*arguments, "--force", code=2).stderr
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


def test_all_mistakes_at_once():
    os.link("p.yaml", "same.yaml")
    Path("folder").mkdir()
    targets = [
        Target("--csv", "none/x.csv", (".csv",)),
        Target("--npz", "x.zip", (".npz",)),
        Target("--plot", "x.zip"),
        Target("--to", "same.yaml", replaced=True),
        Target("--report", "folder", replaced=True),
        Target("--other", None),
    ]
    with pytest.raises(yd.ProblemError) as caught:
        checked_targets(targets, ["p.yaml", "german-low"])
    texts = ("no folder none", "must end in .npz", "file of --npz", "command reads", "is a folder")
    for diagnostic, text in zip(caught.value.diagnostics, texts, strict=True):
        assert text in diagnostic.render()


def test_devices_are_there_and_can_be_given_twice():
    null = Target("--csv", os.devnull), Target("--npz", os.devnull), Target("--plot", None)
    assert checked_targets(null, []) == [Path(os.devnull), Path(os.devnull), None]


def test_in_python_too(tmp_path):
    result = yd.sweep(yd.table1(), of="stable", C_s=[1e5, 2e5])
    for name, write in (("x.csv", result.to_csv), ("x.npz", result.to_npz), ("x.nc", result.to_netcdf)):
        write(name)
        before = Path(name).read_bytes()
        with pytest.raises(yd.ProblemError, match=f"{name} exists"):
            write(name)
        assert Path(name).read_bytes() == before
        write(name, replace=True)
    Path("p.svg").write_text("mine")
    with pytest.raises(yd.ProblemError, match=r"p\.svg exists"):
        yd.animate(yd.modes(yd.table1()), "p.svg")


@pytest.mark.parametrize("option", ["--csv", "--npz", "--plot", "--resume"])
def test_an_empty_name_is_no_name(option):
    refused = run("sweep", "p.yaml", "--of", "stable", "--over", "v=252 km/h:288 km/h:3", option, "", code=2)
    assert f"{option}: is empty: give the name of a file" in refused.stderr
    assert refused.stdout == ""


@pytest.mark.parametrize(
    "arguments", [("simulate", "p.yaml", "--plot", ""), ("modes", "p.yaml", "--to", ""), ("new", "")]
)
def test_an_empty_name_is_no_name_of_other_outputs(arguments):
    assert "is empty: give the name of a file" in run(*arguments, code=2).stderr


@pytest.mark.parametrize("force", [(), ("--force",)])
@pytest.mark.parametrize(
    ("to", "message"),
    [
        ("nowhere/y.svg", "x.svg is a link to {here}/nowhere/y.svg: there is no folder {here}/nowhere"),
        ("x.svg", "x.svg is a link that leads to itself"),
    ],
)
def test_a_link_that_leads_nowhere(to, message, force):
    Path("x.svg").symlink_to(to)
    refused = run("modes", "p.yaml", "--plot", "x.svg", *force, code=2)
    assert message.format(here=Path.cwd()) in refused.stderr
    assert sorted(x.name for x in Path().iterdir()) == ["p.yaml", "x.svg"]


@pytest.mark.parametrize("force", [(), ("--force",)])
@pytest.mark.parametrize("command", [("sweep", "--over", "v=200 km/h:300 km/h:2"), ("trade-off",)])
def test_a_table_and_a_workbook_are_two_files(command, force):
    refused = run(command[0], "p.yaml", *command[1:], "--csv", "x.xlsx", "--xlsx", "x.xlsx", *force, code=2)
    assert "--xlsx: x.xlsx is also the file of --csv" in refused.stderr
    assert [x.name for x in Path().iterdir()] == ["p.yaml"]

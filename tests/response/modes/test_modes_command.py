"""The command `yawdesign modes`."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from yawdesign.cli import app

TABLE1 = Path(__file__).parents[3] / "problems" / "table1.yaml"


def run(*arguments):
    return CliRunner().invoke(app, ["modes", str(TABLE1), *map(str, arguments)])


def test_json_of_the_modes():
    data = json.loads(run("--json").stdout)
    assert data["modes"][0]["name"] == "wheelset hunting 1"
    assert data["modes"][0]["decay_rate"] == pytest.approx(1.2985370178, rel=1e-8)
    assert sum(2 if mode["frequency"] else 1 for mode in data["modes"]) == 25


def test_json_of_followed_modes():
    data = json.loads(run("--over", "v=50 km/h:450 km/h:5", "--json").stdout)
    assert data["axis"] == "v"
    assert data["values"][-1] == pytest.approx(125)
    assert len(data["eigenvalues"]) == 5
    values = json.loads(run("--over", "C_s=10 kN s/m:1 MN s/m:3:log", "--json").stdout)["values"]
    assert values == pytest.approx([1e4, 1e5, 1e6])


def test_tables():
    text = run().stdout
    assert "wheelset hunting 1" in text
    assert "checked: yes" in text
    text = run("--over", "v=50 km/h:450 km/h:5").stdout
    assert "become a pair" in text
    assert "least certainty" in text


def test_pictures(tmp_path):
    result = run("--plot", tmp_path / "m.png", "--animate", "frame yaw", "--to", tmp_path / "m.svg")
    assert result.exit_code == 0
    assert run("--over", "v=20:80:5", "--of", "damping_ratio", "--plot", tmp_path / "p.pdf").exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.png", "m.svg", "p.pdf"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--over", "C_s=1:2"], "write LOW:HIGH:N"),
        (["--over", "K_mm=1:2:3"], "did you mean K_m"),
        (["--over", "C_s=2 kN s/m:1 kN s/m:3"], "less than min"),
        (["--over", "C_s=1:2:many"], "many"),
        (["--over", "C_s=0:2:3:log"], "must begin"),
        (["--over", "C_s=1:2:3", "--to", "x.gif"], "leave out --over"),
        (["--animate", "frame yow", "--to", "x.gif"], "did you mean frame yaw"),
        (["--to", "x.mp4"], "must end in .gif or .svg"),
        (["--plot", "x.bmp"], "must end in .png or .pdf or .svg"),
        (["--over", "v=20:30:3", "--of", "locus", "--plot", "x.png"], "is not one of"),
        (["--over", "v=20:80:1000000"], "1000000 values are too many"),
        (["--over", "v=80"], "at least two values"),
        (["--animate", "frame yaw"], "--animate: chooses which mode --plot or --to shows"),
        (["--animate", "typo_mode", "--plot", "x.png"], "mode 'typo_mode' is not known here"),
        (["--of", "locus"], "--of: locus is not one of"),
        (["--of", "frequency", "--plot", "x.png"], "--of: chooses what --plot draws with --over"),
        (["--to", "none/x.gif"], "there is no folder none"),
        (["--plot", "none/x.png"], "there is no folder none"),
    ],
)
def test_mistakes_end_with_code_2_and_write_nothing(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert not list(tmp_path.iterdir())

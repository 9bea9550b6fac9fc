"""What users write is shown as they wrote it: no mathematics, no colours, nothing that no file can hold."""

import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.exports.c_files import ascii_text
from yawdesign.output.pictures import literal, write_picture
from yawdesign.output.tables import rendered

PROBLEM = Path(__file__).parents[2] / "problems" / "table1.yaml"
TITLES = ("$x^{$", "costs $5", "$5 to $9", r"a \$ b", "$$", r"\frac{1", "[/red] [bold]x :smile:", "{0} %s %d {{}} ${a}")


def run(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def shown(ax):
    """Return the words of a picture's title as they are drawn."""
    ax.figure.canvas.draw()
    return ax.get_title("left")


@pytest.mark.parametrize("title", TITLES)
def test_any_title_on_a_sweep(title, tmp_path):
    problem = yd.table1().replace(title=title)
    ax = yd.plot(yd.sweep(problem, of="stable", C_s=[1e5, 1e6]))
    assert literal(title) in shown(ax).replace("\n", " ")
    write_picture(ax, tmp_path / "x.svg")
    assert ElementTree.parse(tmp_path / "x.svg").getroot().tag.endswith("svg")


def test_a_dollar_is_drawn_as_a_dollar():
    """Matplotlib takes the signs out that keep it from reading mathematics, beside mathematics of our own too."""
    ax = yd.plot(yd.sweep(yd.table1().replace(title="A $5"), of="critical", f_m=[2.0, 3.0]))
    parse = matplotlib.mathtext.MathTextParser("path")
    assert "held" in shown(ax)
    glyphs = parse.parse(ax.get_title("left").split("\n")[0], dpi=72).glyphs
    assert "$" in [chr(glyph[2]) for glyph in glyphs] or ord("$") in [glyph[2] for glyph in glyphs]


def track_of(name):
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text("distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, {k % 7}" for k in range(1000)))
    return name


@pytest.mark.parametrize("name", ["a$b^{$.csv", "a[/red].csv", ":smile:.csv"])
def test_any_name_of_a_track(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("simulate", PROBLEM, "--track", track_of(name), "--plot", "x.png")
    assert result.exit_code == 0, result.output + repr(result.exception)
    assert name in result.stdout
    assert Path("x.png").stat().st_size > 1000


def test_a_name_that_is_no_unicode_in_a_picture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_over = yd.simulate(yd.table1().replace(C_s=1e6), track_of("\udcff$\x07.csv"))
    assert shown(yd.plot(run_over)).startswith(r"Track ?\$?.csv, ")


@pytest.mark.parametrize("folder", ["e[/red]", "e[bold]", ":smile:"])
def test_any_name_of_a_folder(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path(folder).parent.mkdir(exist_ok=True)
    result = run("export", PROBLEM, "--to", folder, "--only", "rotational_resistance", "--formats", "c")
    assert result.exit_code == 0, result.output + repr(result.exception)
    assert folder in result.stdout
    assert (tmp_path / folder / "yawdesign.h").exists()


@pytest.mark.parametrize("sign", ["\ud800", "\x07", "\x1b[31m", "\x7f", "\x85", "\u2028", "\ufffe", "\x00"])
def test_what_cannot_be_shown_is_no_title(sign, tmp_path):
    with pytest.raises(yd.ProblemError, match=rf"title: holds .*U\+{ord(sign[0]):04X}"):
        yd.table1().replace(title=f"a{sign}b")
    file = tmp_path / "p.yaml"
    text = re.sub(r"(?m)^title:.*$", f'title: "a\\\\u{ord(sign[0]):04x}b"', PROBLEM.read_text())
    file.write_text(text)
    result = run("check", file)
    assert result.exit_code == 2, text[:200]
    line = text[: text.index("title:")].count("\n") + 1
    assert f"p.yaml:{line}:" in result.stderr
    assert f"U+{ord(sign[0]):04X}" in result.stderr


def test_a_title_is_one_line():
    assert yd.table1().replace(title="a b\n").title == "a b"
    with pytest.raises(yd.ProblemError, match=r"U\+000A"):
        yd.table1().replace(title="a\nb")
    assert yd.table1().replace(title="300\u2009km/h µ 中 \U0001f684").title == "300\u2009km/h µ 中 \U0001f684"


def test_no_control_character_reaches_a_header():
    text = ascii_text("a\x07b\x1b[31m*/ \u2028µ\r\n")
    assert text.isascii()
    assert text.isprintable()
    assert "*/" not in text


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_every_file_of_an_export_takes_any_title(tmp_path):
    problem = yd.table1().replace(title='*/ "$a" ${b} %d \\ \U0001f684 中 [/red] </x> ]]> ??/', C_s=1e6)
    yd.export(problem, tmp_path / "out", only="rotational_resistance")
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", str(tmp_path / "out" / "example.c")]
    assert subprocess.run(command, check=False).returncode == 0


def test_latex_is_not_asked_for(tmp_path):
    """Neither while a picture is made nor when it is written, where ticks are made."""
    result = yd.sweep(yd.table1(), of="decay_rate", C_s=[1e5, 1e6], v=[70.0, 80.0])
    with matplotlib.rc_context({"text.usetex": True}):
        write_picture(yd.plot(result), tmp_path / "x.png")
        yd.animate(yd.modes(yd.table1().replace(C_s=1e6)), tmp_path / "x.svg")
    assert (tmp_path / "x.png").stat().st_size > 1000


@pytest.mark.slow
def test_latex_is_not_asked_for_in_a_moving_picture(tmp_path):
    with matplotlib.rc_context({"text.usetex": True}):
        yd.animate(yd.modes(yd.table1().replace(C_s=1e6)), tmp_path / "x.gif")


def test_tables_show_brackets():
    assert "a [m/s] [/red] :x:" in rendered("a [m/s] [/red] :x:")
    text = rendered(yd.output.response_tables.damper_tables(yd.damper_component(yd.table1(), duration="5 s")))
    assert "|Z| [MN/m]" in text


def test_a_spectrum_with_a_name_of_its_own():
    road = yd.SPECTRA["german-low"]
    own = yd.Spectrum("$\\frac{$", road.densities)
    ax = yd.plot(yd.spectrum_check(own, length="2 km"))
    ax.figure.canvas.draw()
    assert np.isfinite(ax.get_ylim()).all()

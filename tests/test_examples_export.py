"""The examples that use exported functions are run, as their first lines say, and their output is checked."""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.hunting.eigenvalues import eigenvalues
from yawdesign.vehicle.vehicle import Model, Vehicle

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
PRINTED = Model("power", "as-printed")
SANITIZED = ["-std=c99", "-O1", "-Wall", "-Werror", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Return the folder with the exported critical damping of Table I as printed."""
    to = tmp_path_factory.mktemp("examples") / "exported"
    yd.export(yd.load(ROOT / "problems" / "table1.yaml"), to, only="critical_damping,critical_equations")
    return to


@pytest.fixture(scope="module")
def program(exported):
    """Return the compiled C program."""
    out = exported.parent / "critical_damping"
    source = EXAMPLES / "c" / "critical_damping.c"
    command = ["cc", *SANITIZED, f"-I{exported}", "-o", out, source, exported / "yawdesign.c", "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return out


def run(*command, code=0, cwd=None):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, cwd=cwd)
    assert done.returncode == code, done.stdout + done.stderr
    return done


@pytest.mark.slow
def test_c_program_finds_the_critical_damping_of_table_1(program):
    lines = [
        line.rsplit(" ", 1) if line.startswith("d ") else line.split()[:2] for line in run(program).stdout.splitlines()
    ]
    answer = {name: float(value) for name, value in lines}
    assert answer["C_sl"] == pytest.approx(90702.8897786979, rel=1e-9)
    assert answer["omega"] == pytest.approx(23.15473658, rel=1e-9)
    f = yd.functions(yd.table1(equations="as-printed")).documented["critical_damping"]
    found = f.function(**{port.name: port.value[0] for port in f.inputs})
    gradient = [answer[f"d C_sl / d {name}"] for name in f.outputs[3].rows]
    assert len(gradient) == 31
    assert gradient == pytest.approx(found["gradient"].full().ravel(), rel=1e-12)


@pytest.mark.slow
def test_c_program_with_another_bogie(program):
    vehicle = PRINTED.at(yd.table1().bogie.parameters(), v=350 / 3.6).replace(lambda_=0.12)
    (expected,) = critical_damping(vehicle).critical
    start = f"C_s_start={1.05 * expected.C_s}", f"omega_start={0.97 * expected.omega}"
    out = run(program, f"v={350 / 3.6}", "lambda=0.12", *start).stdout
    assert float(out.split()[1]) == pytest.approx(expected.C_s, rel=1e-9)


@pytest.mark.slow
def test_c_program_says_what_is_wrong(program):
    # At 200 km/h the bogie is stable for every C_s: Newton's method ends, without an error, at what is no solution.
    assert "no critical damping found" in run(program, f"v={200 / 3.6}", code=3).stderr
    assert "no critical damping found" in run(program, "C_s_start=nan", code=3).stderr
    for argument in ("lambda=abc", "nothing=1", "v", "v="):
        assert "expected a parameter" in run(program, argument, code=2).stderr


def test_critical_damping_inside_an_nlp(exported):
    lines = run(sys.executable, EXAMPLES / "casadi" / "frame_and_damper.py", exported).stdout.splitlines()
    best = {line.split()[0]: float(line.split()[1]) for line in lines}
    vehicle = PRINTED.at(yd.table1().bogie.parameters(), v=300 / 3.6)

    def answer(J_b, C_m):
        return max(x.C_s for x in critical_damping(vehicle.replace(J_b=J_b, C_m=C_m)).critical)

    def cost(J_b, C_m):
        return vehicle.p["J_b"] / J_b + 0.2 * C_m / vehicle.p["C_m"]

    J_b, C_m = best["J_b"], best["C_m"]
    assert answer(J_b, C_m) == pytest.approx(best["C_sl"], rel=1e-8)
    assert best["C_sl"] == pytest.approx(30e3, rel=1e-6)
    # At the optimum no cheaper neighbour keeps the limit.
    for direction in np.linspace(0, 2 * np.pi, 24, endpoint=False):
        near = J_b * (1 + 0.01 * np.cos(direction)), C_m * (1 + 0.03 * np.sin(direction))
        assert cost(*near) > cost(J_b, C_m) or answer(*near) > 30e3


@pytest.mark.slow
def test_python_control(tmp_path):
    picture = tmp_path / "bode.png"
    out = run(
        sys.executable, EXAMPLES / "python-control" / "bode.py", ROOT / "problems" / "table1.yaml", picture
    ).stdout
    assert float(out.split()[3]) == pytest.approx(-1.2985370178, rel=1e-7)
    task = yd.load(ROOT / "problems" / "table1.yaml")
    model, f = yd.state_space(task), float(out.split()[-2])
    s = eigenvalues(Vehicle.of(task)[0].replace(C_s=1e6))
    assert min(abs(s.imag / (2 * np.pi) - f)) < 0.1  # the peak stands at a mode
    x = np.linalg.solve(2j * np.pi * f * np.eye(25) - model.A, model.B[:, 0])
    assert abs((model.C @ x)[0]) == pytest.approx(float(out.split()[7]), rel=1e-3)
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("page", ["export", "export-casadi", "export-python-control"])
def test_python_of_the_documents(page, exported, monkeypatch, capsys):
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert blocks
    monkeypatch.chdir(exported.parent)
    for block in blocks:
        exec(compile(block, page, "exec"), {})
    assert capsys.readouterr().out


def test_the_rootfinder_that_the_page_makes_of_the_equations(exported, monkeypatch, capsys):
    """It reads a file of an older CasADi, and finds the same."""
    text = (ROOT / "docs" / "export-casadi.md").read_text(encoding="utf-8")
    (block,) = [b for b in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "critical_equations" in b]
    monkeypatch.chdir(exported.parent)
    names = {}
    exec(compile(block, "export-casadi", "exec"), names)
    described = json.loads((exported / "manifest.json").read_text(encoding="utf-8"))["functions"]["critical_equations"]
    *p, (C_s,), (omega,) = described["self_test"]["inputs"].values()
    found = names["critical"]([math.log(1.05 * C_s), 0.98 * omega / 100], [x for (x,) in p])
    assert math.exp(found[0]) == pytest.approx(90702.8897786979, rel=1e-9)
    assert float(found[1]) * 100 == pytest.approx(23.15473658, rel=1e-9)
    capsys.readouterr()


def test_yawdesign_can_be_imported_where_its_exports_were_compiled(tmp_path):
    """With every artefact that the Makefile and the pages make; Python looks in the working folder first."""
    to = tmp_path / "exported"
    yd.export(yd.table1(), to, only="dynamic_stiffness", formats="c")
    subprocess.run(["make", "-s", "-C", to, "all", "library"], check=True)
    assert (to / "libyawdesign.so").exists()
    assert "yawdesign" in run(sys.executable, "-c", "import yawdesign; print(yawdesign.Problem)", cwd=to).stdout
    for page in (ROOT / "docs").glob("*.md"):
        assert not re.search(r"-o \S*\byawdesign\.(so|pyd|py)\b", page.read_text(encoding="utf-8")), page


def test_documents_name_every_function_and_file():
    text = (ROOT / "docs" / "export.md").read_text(encoding="utf-8")
    for f in yd.functions(yd.table1()).documented.values():
        assert f"| `{f.function.name()}` |" in text
    for path in re.findall(r"\]\((?:\.\./)?([\w./-]+)\)", text):
        assert (ROOT / "docs" / path).exists() or (ROOT / path).exists()

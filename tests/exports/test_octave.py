"""The MEX gateway and the matrices in a real GNU Octave, as docs/export-matlab.md says."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import yawdesign as yd
from yawdesign.hunting.critical_damping import critical_damping
from yawdesign.vehicle.vehicle import Vehicle

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
DOCS = Path(__file__).parents[2] / "docs" / "export-matlab.md"

pytestmark = pytest.mark.skipif(
    not (OCTAVE and shutil.which("mkoctfile")), reason="there is no GNU Octave with mkoctfile on this machine"
)

# Calls every function as the manifest says, with what the manifest gives, and compares with it.
SELF_TESTS = """
manifest = jsondecode(fileread('manifest.json'));
for name = fieldnames(manifest.functions)'
  entry = manifest.functions.(name{1});
  for [value, key] = entry.self_test.inputs
    eval([key ' = value;']);
  end
  eval([entry.mex_call ';']);
  for [expected, key] = entry.self_test.outputs
    if iscell(expected)
      expected(cellfun(@isempty, expected)) = NaN;
      expected = cell2mat(expected);
    end
    got = eval(key)(:);
    finite = isfinite(expected);
    assert(isfinite(got), finite);
    size = max([abs(expected(finite)); 0]);
    assert(max([abs(got(finite) - expected(finite)); 0]) <= 1e-9 * size + 1e-12);
  end
  printf('%s ok\\n', name{1});
end
"""
MATRICES = """
m = load('state_space.mat');
printf('%s|%s|%s|%s\\n', m.title, m.state_names{1}, m.state_units{end}, fieldnames(m.parameters){1});
printf('%.17g\\n', m.parameters.K_m, m.speed, max(abs(m.C(:))), m.A(14, 1));
"""


def octave(folder, text, code=0):
    """Run a program in a folder and return what it prints."""
    (folder / "program.m").write_text(text)
    command = [OCTAVE, "--quiet", "--norc", "--no-history", "program.m"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module", autouse=True)
def quick():
    """Compile without optimisation."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CFLAGS", "-O0")
        yield


def exported(to, **options):
    yd.export(yd.table1(), to, prefix="front", **options)
    subprocess.run(["make", "-s", "-C", to, "octave"], check=True)
    return to


@pytest.mark.slow
def test_every_function_passes_its_self_test(tmp_path):
    to = exported(tmp_path / "out", formats="c", inputs="C_s,K_m,v")
    ok = octave(to, SELF_TESTS).split("\n")
    manifest = json.loads((to / "manifest.json").read_text(encoding="utf-8"))
    assert [line for line in ok if line] == [f"{name} ok" for name in manifest["functions"]]


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    return exported(tmp_path_factory.mktemp("octave") / "out", only="dynamic_stiffness,c,mat")


def test_one_function_passes_its_self_test(small):
    assert octave(small, SELF_TESTS) == "dynamic_stiffness ok\n"


@pytest.mark.parametrize("arguments", ["'front_nothing', 1", "'front_dynamic_stiffness', 1, 2, 3, 4"])
def test_mistakes_are_errors_of_octave(small, arguments):
    assert "error:" in octave(small, f"front({arguments})", code=1)


def test_matrices(small):
    model = yd.state_space(yd.table1())
    names, *numbers = octave(small, MATRICES).split("\n")
    assert names == f"{model.title}|y_b|m|M_b"
    expected = [626480.0, 300 / 3.6, abs(model.C).max(), model.A[13, 0]]
    assert [float(x) for x in numbers if x] == pytest.approx(expected, rel=1e-15)


def test_the_program_of_the_page(tmp_path):
    yd.export(yd.table1(), tmp_path / "exported", only="critical_damping,c", inputs="v")
    _, program = re.findall(r"```matlab\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    assert program.startswith("cd exported\nmex ")
    values = [x.C_s for x in critical_damping(Vehicle.of(yd.table1())[0]).critical]
    assert float(octave(tmp_path, program + "printf('%.17g', C_sl)")) == pytest.approx(max(values), rel=1e-9)

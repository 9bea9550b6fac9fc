"""Exported files: the C code, the CasADi and MATLAB files, the manifest, and the folder they stand in."""

import ctypes
import errno
import json
import os
import re
import shutil
import signal
import subprocess
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from scipy.io import loadmat
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app
from yawdesign.exports import folder, write
from yawdesign.exports.file_contents import Unavailable

PROBLEMS = Path(__file__).parents[2] / "problems"
DATA = Path(__file__).parents[1] / "data"
CHECKED = ["-std=c99", "-O1", "-Wall", "-Werror", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]


def problem(name):
    if name == "trailer":
        return yd.load(PROBLEMS / "trailer-bogie.yaml").replace(C_s=9e5)
    return yd.table1(equations=name)


@pytest.fixture(scope="module", params=["reciprocal", "trailer"])
def exported(request, tmp_path_factory):
    """Return the folder of a full export and its problem."""
    to = tmp_path_factory.mktemp("export") / request.param
    yd.export(problem(request.param), to, formats="casadi,c,mat")
    return to, problem(request.param)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Return the folder of an export of two functions with three inputs."""
    to = tmp_path_factory.mktemp("small") / "out"
    yd.export(yd.table1(), to, inputs="C_s,v", only="routh_column,critical_damping")
    return to


def manifest_of(to):
    return json.loads((to / "manifest.json").read_text(encoding="utf-8"))


def compiled(to, program, *flags):
    out = to / f"{program}.out"
    command = ["cc", *flags, "-o", out, to / f"{program}.c", to / "yawdesign.c", "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return out


@pytest.mark.slow
def test_c_code_passes_its_self_test_under_sanitizers(exported):
    to, task = exported
    done = subprocess.run([compiled(to, "selftest", *CHECKED)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == ""
    assert done.stdout.count(" ok\n") == len(yd.functions(task)) == 10


def test_the_self_test_sees_a_wrong_number(small, tmp_path):
    to = shutil.copytree(small, tmp_path / "copy")
    source = (to / "selftest.c").read_text()
    begin = source.index("routh_column_outputs[] = {") + len("routh_column_outputs[] = {")
    (to / "selftest.c").write_text(source[:begin] + "1" + source[begin:])
    done = subprocess.run([compiled(to, "selftest")], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "column differs" in done.stdout
    assert "critical_damping             ok" in done.stdout


@pytest.fixture(scope="module")
def library(exported):
    """Return the export's C code as a shared library."""
    out = exported[0] / "yawdesign.so"
    source = exported[0] / "yawdesign.c"
    subprocess.run(["cc", "-std=c99", "-O1", "-shared", "-fPIC", "-o", out, source, "-lm"], check=True)
    return out


@pytest.mark.slow
def test_c_code_equals_casadi_to_the_last_digits(exported, library):
    to, task = exported
    for name, f in yd.functions(task).items():
        external = ca.external(f"yawdesign_{name}", str(library))
        assert external.name_in() == f.name_in()
        assert external.name_out() == f.name_out()
        values = list(manifest_of(to)["functions"][name]["self_test"]["inputs"].values())
        for got, expected in zip(external.call(values), f.call(values), strict=True):
            size = np.abs(expected.full()).max(initial=0)
            assert np.abs(got.full() - expected.full()).max(initial=0) <= 1e-12 * size + 1e-15, name


@pytest.mark.slow
def test_work_vectors_of_the_header_are_long_enough(exported, library):
    to, task = exported
    functions = ctypes.CDLL(str(library))
    header = (to / "yawdesign.h").read_text(encoding="ascii")
    declared = dict(re.findall(r"#define (\w+_SZ_\w+) (\d+)\n", header))
    for name in yd.functions(task):
        sizes = [ctypes.c_longlong() for _ in range(4)]
        assert getattr(functions, f"yawdesign_{name}_work")(*map(ctypes.byref, sizes)) == 0
        for kind, size in zip(("ARG", "RES", "IW", "W"), sizes, strict=True):
            assert size.value <= int(declared[f"yawdesign_{name}_SZ_{kind}"]) <= 2 * size.value + 64


def test_header_compiles_in_cpp_and_survives_any_title(tmp_path):
    task = yd.Problem(bogie=yd.table1().bogie, speed=80.0, title='µ */ int x; "$a" ${b} \\')
    yd.export(task, tmp_path / "out", only="dynamic_stiffness", formats="c")
    subprocess.run(["cc", *CHECKED, "-c", "-o", tmp_path / "a.o", tmp_path / "out" / "example.c"], check=True)
    (tmp_path / "a.cpp").write_text(
        '#include "out/yawdesign.h"\nint main() { return yawdesign_dynamic_stiffness_in_omega; }'
    )
    subprocess.run(["g++", "-Wall", "-Werror", "-c", "-o", tmp_path / "b.o", tmp_path / "a.cpp"], check=True)


MEX_CALL = r"""
#include "yawdesign.c"
int main(void) {
  double values[] = {97.22222222222223, 2.7e5, 22.0};
  mxArray name = {1, 1, 0, "yawdesign_critical_damping"};
  mxArray in[] = {{1, 1, values, 0}, {1, 1, values + 1, 0}, {1, 1, values + 2, 0}};
  const mxArray *argv[] = {&name, in, in + 1, in + 2};
  mxArray *out[4];
  mexFunction(4, out, 4, argv);
  printf("%.17g %.17g %zu\n", out[0]->x[0], out[3]->x[0], out[3]->m);
  return 0;
}
"""


@pytest.mark.slow
def test_mex_gateway(small, tmp_path):
    # MATLAB is not at hand: its interface is a stub, the gateway is the real one.
    (tmp_path / "call.c").write_text(MEX_CALL)
    flags = ["-std=c99", "-O1", "-w", "-DMATLAB_MEX_FILE", f"-I{DATA}", f"-I{small}"]
    subprocess.run(["cc", *flags, "-o", tmp_path / "call", tmp_path / "call.c", "-lm"], check=True)
    out = subprocess.run([tmp_path / "call"], capture_output=True, text=True, check=True).stdout.split()
    assert float(out[0]) == pytest.approx(266059.018759661, rel=1e-9)
    f = yd.functions(yd.table1(), inputs=("v",))["critical_damping"]
    assert float(out[1]) == pytest.approx(float(f(350 / 3.6, 2.7e5, 22.0)[3]), rel=1e-11)
    assert out[2] == "1"


@pytest.mark.slow
def test_makefile_and_example(small, tmp_path):
    to = shutil.copytree(small, tmp_path / "copy")
    done = subprocess.run(["make", "-s", "-C", to, "all", "check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    run = subprocess.run(
        [to / "example", "v=97.22222222222223", "C_s_start=2.7e5"], capture_output=True, text=True, check=True
    )
    assert float(run.stdout.split()[1]) == pytest.approx(266059.018759661, rel=1e-9)
    wrong = subprocess.run([to / "example", "v80"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2


def test_casadi_files(exported):
    to, task = exported
    manifest = manifest_of(to)
    assert manifest["versions"] == {"yawdesign": yd.__version__, "casadi": ca.CasadiMeta.version()}
    for name, entry in manifest["functions"].items():
        f = ca.Function.load(str(to / entry["files"]["casadi"]))
        assert f.name_in() == [port["name"] for port in entry["inputs"]]
        assert f.name_out() == [port["name"] for port in entry["outputs"]]
        assert [list(f.size_out(k)) for k in range(f.n_out())] == [port["shape"] for port in entry["outputs"]]
        found = f(**entry["self_test"]["inputs"])
        for output, expected in entry["self_test"]["outputs"].items():
            got = found[output].full().ravel(order="F")
            assert got == pytest.approx(expected, rel=1e-12, abs=1e-15), (name, output)
    assert len(manifest["functions"]) == len(yd.functions(task))


def test_manifest(exported):
    to, task = exported
    manifest = manifest_of(to)
    assert sorted(manifest["files"]) == sorted(p.name for p in to.iterdir() if p.suffix not in (".out", ".so"))
    units = {key: row.si or "-" for key, row in yd.PARAMETERS.items()}
    symbols = (to / "yawdesign.c").read_text()
    for name, entry in manifest["functions"].items():
        assert entry["c_symbol"] == f"yawdesign_{name}"
        assert f"int {entry['c_symbol']}(" in symbols
        assert entry["time_scale"]["value"] == 100.0
        assert entry["versions"] == manifest["versions"]
        assert entry["baked"] == {}
        assert all(port["unit"] == units[port["name"]] for port in entry["inputs"] if port["name"] in units)
        assert all(port["meaning"] for port in (*entry["inputs"], *entry["outputs"]))
    p = task.bogie.parameters()
    given = {port["name"]: port["value"] for port in manifest["functions"]["routh_column"]["inputs"]}
    assert given == {**{key: [float(x)] for key, x in p.items()}, "v": [300 / 3.6]}


def test_baked_values_are_in_the_manifest(small):
    entry = manifest_of(small)["functions"]["critical_damping"]
    assert [port["name"] for port in entry["inputs"]] == ["v", "C_s_start", "omega_start"]
    assert entry["baked"]["K_m"] == 626480.0
    assert "v" not in entry["baked"]
    assert len(entry["baked"]) == len(yd.table1().bogie.parameters()) - 1


def test_matlab_file(exported):
    to, task = exported
    data, model = loadmat(to / "state_space.mat"), yd.state_space(task)
    for name in "ABCD":
        assert np.array_equal(data[name], getattr(model, name))
    for kind in ("state", "input", "output"):
        assert [str(x[0]) for x in data[f"{kind}_names"].ravel()] == list(getattr(model, kind + "s"))
        assert [str(x[0]) for x in data[f"{kind}_units"].ravel()] == list(getattr(model, kind + "_units"))
    parameters = data["parameters"][0, 0]
    assert {key: parameters[key].item() for key in parameters.dtype.names} == task.bogie.parameters()
    assert data["speed"].item() == 300 / 3.6


def test_what_cannot_be_written_is_left_out_with_a_note(tmp_path, monkeypatch):
    task = yd.table1().replace(C_s=None, speed="200 km/h")
    result = yd.export(task, tmp_path / "out", formats=("casadi", "mat"))
    assert "state_space.mat" not in result.files
    assert len(result.notes) == 2
    assert "no critical damping" in result.notes[0]
    assert "state_space.mat left out: error: C_s" in result.notes[1]
    assert manifest_of(tmp_path / "out")["functions"]["critical_damping"]["self_test"] is None
    assert result.to_dict()["folder"] == str(tmp_path / "out")

    def fails(contents, to):
        raise Unavailable("no compiler")

    monkeypatch.setattr(write, "FORMATS", {"c": write.write_c, "fmu": fails})
    result = yd.export(yd.table1(), tmp_path / "two", only="dynamic_stiffness")
    assert result.notes == ("no compiler",)
    assert "yawdesign.c" in result.files
    with pytest.raises(yd.ProblemError, match="no compiler"):
        yd.export(yd.table1(), tmp_path / "three", formats="fmu")
    assert not (tmp_path / "three").exists()


def run(*arguments):
    return CliRunner().invoke(app, ["export", str(PROBLEMS / "table1.yaml"), *map(str, arguments)])


def test_command_line(tmp_path):
    done = run("--to", tmp_path / "out", "--only", "routh_column,state_matrix", "--inputs", "C_s, K_m,C_m,v", "--json")
    assert done.exit_code == 0, done.output
    data = json.loads(done.stdout)
    assert data["functions"] == ["state_matrix", "routh_column"]
    assert sorted(data["files"]) == sorted(p.name for p in (tmp_path / "out").iterdir())
    inputs = manifest_of(tmp_path / "out")["functions"]["routh_column"]["inputs"]
    assert [port["name"] for port in inputs] == ["K_m", "C_m", "v", "C_s"]
    assert "routh_column.casadi" in run("--to", tmp_path / "two", "--only", "routh_column").stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--only", "routh"], "routh is not known; did you mean routh_column"),
        (["--only", "routh_colum,zzz"], "zzz is not known; there are state_matrix"),
        (["--only", ","], "no function is named"),
        (["--inputs", "K_1Y"], "K_1Y: is not known here; did you mean K_1y"),
        (["--formats", "fmi9,matt"], "there are casadi"),
        (["--formats", ","], "no format is named"),
    ],
)
def test_mistakes_are_exit_code_2(tmp_path, options, message):
    done = run("--to", tmp_path / "out", *options)
    assert done.exit_code == 2, done.output
    assert message in done.stderr.replace(": is not known;", " is not known;")
    assert list(tmp_path.iterdir()) == []


def test_a_place_is_looked_at_before_the_work(tmp_path, monkeypatch):
    monkeypatch.setattr("yawdesign.exports.write.functions_of", None)
    (tmp_path / "mine").write_text("")
    for place, message in ((tmp_path / "no" / "such", "there is no folder"), (tmp_path, "is not empty")):
        done = run("--to", place)
        assert (done.exit_code, message in done.stderr) == (2, True), done.output


def test_places_that_cannot_be_used(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("mine")
    assert "is a file" in run("--to", tmp_path / "file").stderr
    missing = run("--to", tmp_path / "no" / "such")
    assert missing.exit_code == 2
    assert f"{tmp_path / 'no' / 'such'}: there is no folder {tmp_path / 'no'}" in missing.stderr
    (tmp_path / "link").symlink_to(tmp_path / "no" / "such")
    assert "link is a link to what is not there" in run("--to", tmp_path / "link").stderr

    def refuse(*arguments, **options):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), "elsewhere")

    monkeypatch.setattr(folder.tempfile, "mkdtemp", refuse)
    denied = run("--to", tmp_path / "out")
    assert denied.exit_code == 2
    assert denied.stderr.strip() == f"error: Permission denied: {tmp_path / 'out'}"
    assert (tmp_path / "file").read_text() == "mine"


def test_foreign_files_are_never_touched(tmp_path):
    to = tmp_path / "out"
    to.mkdir()
    assert run("--to", to, "--only", "routh_column", "--formats", "c").exit_code == 0  # an empty folder will do
    (to / "notes.txt").write_text("mine")
    refused = run("--to", to, "--only", "routh_column")
    assert refused.exit_code == 2
    assert "not empty" in refused.stderr
    assert "--force" in refused.stderr
    before = (to / "example.c").read_text()
    assert run("--to", to, "--only", "dynamic_stiffness", "--formats", "c", "--force").exit_code == 0
    assert (to / "example.c").read_text() != before
    assert (to / "notes.txt").read_text() == "mine"
    (to / "state_space.mat").write_text("mine too")
    refused = run("--to", to, "--only", "dynamic_stiffness,mat", "--force")
    assert refused.exit_code == 2
    assert "no `yawdesign export` wrote: state_space.mat" in refused.stderr
    assert (to / "state_space.mat").read_text() == "mine too"
    assert not any(p.name.startswith(".") for p in (*to.iterdir(), *tmp_path.iterdir()))


def test_force_in_a_folder_of_somebody_else(tmp_path):
    (tmp_path / "Makefile").write_text("all: mine")
    (tmp_path / "manifest.json").write_text('{"generator": "other", "files": ["Makefile"]}')
    assert run("--to", tmp_path, "--force", "--only", "dynamic_stiffness").exit_code == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["Makefile", "manifest.json"]


def test_a_run_that_fails_leaves_nothing(tmp_path, monkeypatch):
    def breaks(contents, to):
        (to / "half.txt").write_text("half")
        raise RuntimeError("in the middle")

    monkeypatch.setattr(write, "FORMATS", {"c": write.write_c, "last": breaks})
    with pytest.raises(RuntimeError, match="in the middle"):
        yd.export(yd.table1(), tmp_path / "out", only="dynamic_stiffness")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_manifest_tells_how_each_function_is_called(exported, library):
    """With the manifest alone: vectors of the lengths that it gives, and the inputs in its order."""
    to, _ = exported
    manifest, header = manifest_of(to), (to / "yawdesign.h").read_text(encoding="ascii")
    assert manifest["c_types"] == {"casadi_real": "double", "casadi_int": "long long int"}
    code = ctypes.CDLL(str(library))
    for name, entry in manifest["functions"].items():
        assert f"{entry['c_signature']};" in header
        length, test = entry["c_vector_lengths"], entry["self_test"]
        given = [(ctypes.c_double * len(x))(*x) for x in test["inputs"].values()]
        found = [(ctypes.c_double * (port["shape"][0] * port["shape"][1]))() for port in entry["outputs"]]
        arg, res = (ctypes.c_void_p * length["arg"])(), (ctypes.c_void_p * length["res"])()
        for vector, arrays in ((arg, given), (res, found)):
            vector[: len(arrays)] = [ctypes.addressof(x) for x in arrays]
        iw, w = (ctypes.c_longlong * length["iw"])(), (ctypes.c_double * length["w"])()
        assert getattr(code, entry["c_symbol"])(arg, res, iw, w, 0) == 0
        for got, expected, port in zip(found, test["outputs"].values(), entry["outputs"], strict=True):
            expected = [np.nan if x is None else x for x in expected]
            assert list(got) == pytest.approx(expected, rel=1e-9, abs=1e-12, nan_ok=True), (name, port["name"])
            assert len(port.get("units", expected)) == len(expected)
            assert port["unit"] != "SI" or port["units"]


def export_small(to, **options):
    return yd.export(yd.table1(), to, only="dynamic_stiffness", formats="c", **options)


def test_what_a_killed_export_has_left_is_no_content(tmp_path):
    left = tmp_path / ".yawdesign-abcd.part"
    left.mkdir()
    (left / "half.c").write_text("half")
    export_small(tmp_path)
    assert left.exists()  # another export may be at work
    os.utime(left, (0, 0))
    for path in tmp_path.iterdir():
        if path != left:
            path.unlink()
    export_small(tmp_path)
    assert not left.exists()


def test_a_kill_while_files_are_moved(tmp_path, monkeypatch):
    """Between every two of them: the manifest says so, and the next export needs no force."""
    to = tmp_path / "out"
    whole = {path.name: path.read_bytes() for path in Path(export_small(tmp_path / "whole").folder).iterdir()}
    replace = Path.replace
    for moves in range(len(whole)):
        calls = []

        def killed(self, target, *, calls=calls, moves=moves):
            if self.parent.parent == to:
                calls.append(self)
                if len(calls) > moves:
                    raise SystemExit
            return replace(self, target)

        monkeypatch.setattr(Path, "replace", killed)
        with pytest.raises(SystemExit):
            export_small(to)
        monkeypatch.setattr(Path, "replace", replace)
        assert "unfinished" in manifest_of(to)
        assert sorted(manifest_of(to)["files"]) == sorted(whole)
        export_small(to)
        assert {path.name: path.read_bytes() for path in to.iterdir()} == whole
        shutil.rmtree(to)


def test_a_request_to_stop_while_files_are_moved_waits(tmp_path, monkeypatch):
    replace = Path.replace

    def asked(self, target):
        signal.raise_signal(signal.SIGTERM)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", asked)
    with pytest.raises(KeyboardInterrupt):
        export_small(tmp_path / "out")
    manifest = manifest_of(tmp_path / "out")
    assert "unfinished" not in manifest
    assert sorted(manifest["files"]) == sorted(path.name for path in (tmp_path / "out").iterdir())

"""The archive of an FMU: valid, exact, complete, reproducible, and written where there is no compiler too."""

import math
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest
from fmpy.validation import validate_fmu

import yawdesign as yd
from yawdesign.exports.fmu.description import fmi_unit
from yawdesign.problem.parameters import parameter_keys
from yawdesign.problem.units import parse_unit

TABLE_1 = yd.table1()
HEADERS = Path(fmpy.__file__).parent / "c-code"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("fmu") / "bogie.fmu"
    yd.write_fmu(TABLE_1, path)
    return path


@pytest.fixture
def no_compiler(tmp_path, monkeypatch):
    empty = tmp_path / "empty"
    empty.mkdir()
    monkeypatch.setenv("PATH", str(empty))
    monkeypatch.delenv("CC", raising=False)


def description(path):
    return fmpy.read_model_description(str(path), validate=False)


def by_name(path):
    return {variable.name: variable for variable in description(path).modelVariables}


def names_in(path):
    with zipfile.ZipFile(path) as archive:
        return archive.namelist()


def test_it_is_valid(path):
    assert validate_fmu(str(path)) == []


def test_validation_notices_a_mistake(path, tmp_path):
    """The check above can fail: an undefined unit is found."""
    folder = fmpy.extract(str(path), tmp_path)
    file = Path(folder, "modelDescription.xml")
    file.write_text(file.read_text(encoding="utf-8").replace('unit="kg"', 'unit="stone"', 1), encoding="utf-8")
    assert validate_fmu(folder)


@pytest.mark.parametrize("kind", ["power", "trailer"])
def test_every_parameter_is_tunable_and_starts_exactly(tmp_path, kind):
    keys = parameter_keys(kind)
    # Values with as many digits as a double has.
    values = {key: value * (1 + math.pi / 1e3) for key, value in TABLE_1.bogie.parameters().items() if key in keys}
    bogie = yd.Bogie(kind=kind, **{"lambda_" if key == "lambda" else key: x for key, x in values.items()})
    problem = yd.Problem(bogie=bogie, speed=1000 / 9 / 3.6)
    yd.write_fmu(problem, tmp_path / "bogie.fmu")
    assert validate_fmu(str(tmp_path / "bogie.fmu")) == []
    variables = by_name(tmp_path / "bogie.fmu")
    parameters = {name: v for name, v in variables.items() if v.causality == "parameter"}
    assert set(parameters) == {*keys, "v"}
    for name, value in {**values, "v": 1000 / 9 / 3.6}.items():
        assert float(parameters[name].start) == value, name
        assert parameters[name].variability == "tunable"
        assert parameters[name].description


def test_the_library_starts_with_the_same_values(path):
    """What an importer sees that applies no start values: the numbers in the library."""
    variables = by_name(path)
    parameters = [name for name, v in variables.items() if v.causality == "parameter"]
    result = fmpy.simulate_fmu(
        str(path), stop_time=0.01, output_interval=0.01, output=parameters, apply_default_start_values=False
    )
    values = {**TABLE_1.bogie.parameters(), "v": TABLE_1.speed}
    assert {name: result[name][0] for name in parameters} == values


def test_units_are_those_of_the_parameters(path):
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    units = {unit.get("name"): unit for unit in root.iterfind("UnitDefinitions/Unit")}
    variables = {v.get("name"): v for v in root.iterfind("ModelVariables/Float64")}
    for key in TABLE_1.keys:
        row = yd.PARAMETERS[key]
        assert variables[key].get("unit") == fmi_unit(row.si)
        base = units[fmi_unit(row.si)].find("BaseUnit")
        powers = tuple(int(base.get(name, 0)) for name in ("kg", "m", "s"))
        assert powers == parse_unit(row.unit).dimension
        if row.unit != row.si:
            assert variables[key].get("displayUnit") == fmi_unit(row.unit)
    for unit in units.values():
        for shown in unit.iterfind("DisplayUnit"):
            spelled = shown.get("name").replace(".", "·").replace("2", "²")
            assert float(shown.get("factor")) == pytest.approx(1 / float(parse_unit(spelled).factor), rel=1e-15)
    assert units["rad/s2"].find("BaseUnit").attrib == {"rad": "1", "s": "-2"}
    assert units["N.m/rad"].find("BaseUnit").attrib == {"kg": "1", "m": "2", "s": "-2", "rad": "-1"}
    assert all(v.get("unit") for v in variables.values())


def test_names_units_and_meanings_of_inputs_states_and_outputs(path):
    model, variables = yd.state_space(TABLE_1), by_name(path)
    assert [v.name for v in description(path).modelVariables if v.causality == "input"] == list(model.inputs)
    states = [unknown.variable.derivative.name for unknown in description(path).derivatives]
    assert states == list(model.states)
    for kind in ("state", "input", "output"):
        for name, unit in zip(getattr(model, kind + "s"), getattr(model, kind + "_units"), strict=True):
            assert variables[name].unit == unit
    outputs = {v.name for v in variables.values() if v.causality == "output" and v.alias is None}
    accelerations = {f"{name}_acceleration" for name in states if f"{name}_velocity" in states}
    assert outputs == {*model.outputs, *accelerations, "yaw_damper_force", "F_s", "u_s"}
    assert variables["y_w2"].description == "lateral displacement of the rear wheelset"
    assert variables["phi_b_velocity"].description == "rate of the yaw angle of the bogie frame"
    assert variables["cross_level_1"].description == "cross-level angle of the track under the front wheelset"
    assert variables["phi_w1_acceleration"].description == "yaw acceleration of the front wheelset"
    text = "stroke of the dashpot of the {}, without its joints"
    assert variables["yaw_damper_stroke"].description == text.format("yaw dampers")
    assert variables["motor_damper_stroke_1"].description == text.format("front motor damper")


def test_old_names_are_those_of_the_same_values(path):
    variables = by_name(path)
    pairs = {"v_y_b": "y_b_velocity", "z_1": "yaw_damper_stroke", "z_3": "lateral_damper_stroke_2"}
    pairs |= {"der(v_phi_w1)": "der(phi_w1_velocity)", "der(z_5)": "der(motor_damper_stroke_2)"}
    for old, new in pairs.items():
        assert variables[old].valueReference == variables[new].valueReference
    for old, new in (("F_s", "yaw_damper_pair_force"), ("u_s", "yaw_damper_displacement")):
        assert variables[old].description == f"old name of {new}"
        assert variables[old].unit == variables[new].unit


def test_a_range_of_speeds_starts_with_the_highest(tmp_path):
    problem = yd.Problem(bogie=TABLE_1.bogie, speed=yd.SpeedRange(min="200 km/h", max="250 km/h"))
    yd.write_fmu(problem, tmp_path / "bogie.fmu")
    assert float(by_name(tmp_path / "bogie.fmu")["v"].start) == pytest.approx(250 / 3.6, rel=1e-15)


def test_the_same_problem_gives_the_same_code_and_another_one_another_token(path, tmp_path):
    tokens = {}
    for name, problem in {"same": TABLE_1, "other": TABLE_1.replace(a=1.3)}.items():
        yd.write_fmu(problem, tmp_path / f"{name}.fmu")
        tokens[name] = description(tmp_path / f"{name}.fmu").instantiationToken
    assert tokens["same"] == description(path).instantiationToken != tokens["other"]
    with zipfile.ZipFile(path) as one, zipfile.ZipFile(tmp_path / "same.fmu") as two:
        for name in one.namelist():
            if not name.startswith("binaries"):
                assert one.read(name) == two.read(name), name


def test_any_title_is_written_as_valid_xml(tmp_path):
    title = "]]> <b> & &lt; \"q\" 'q' \u00a0 \u200b 轉向架 😀 Drehgestell für 300 km/h"
    yd.write_fmu(yd.Problem(bogie=TABLE_1.bogie, speed=80.0, title=title), tmp_path / "bogie.fmu")
    assert validate_fmu(str(tmp_path / "bogie.fmu")) == []
    assert title in description(tmp_path / "bogie.fmu").description


def test_the_code_fits_the_headers_of_fmi(path, tmp_path):
    """Compiled with FMI's own header before it, every function has its prototype, and none is missing."""
    fmpy.extract(str(path), tmp_path)
    compiler = shutil.which("cc")
    strict = ("-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fPIC", "-shared")
    header = ("-I", str(HEADERS), "-include", str(HEADERS / "fmi3Functions.h"))
    # Every declared function must be there, or the linker complains.
    declared = [word.strip("; \n") for word in (HEADERS / "fmi3Functions.h").read_text().split("FMI3_Export ")[1:]]
    functions = [line.split(";")[0].split()[-1] for line in declared if "TYPE" in line.split(";")[0]]
    calls = "".join(f"  (void *)&{name},\n" for name in functions)
    (tmp_path / "all.c").write_text(f'#include "sources/fmi3.c"\nvoid *const all[] = {{\n{calls}}};\n')
    assert len(functions) == 75
    quiet = ("-Wno-error=pedantic", "-Wno-pedantic")
    command = (compiler, *strict, *header, *quiet, "-Wl,--no-undefined", "-o", "all.so", "all.c")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    alone = (compiler, "-std=c99", *strict[1:], "-o", "alone.so", "sources/fmi3.c")
    done = subprocess.run(alone, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.usefixtures("no_compiler")
def test_without_a_compiler_the_code_is_written(tmp_path):
    fmu = yd.write_fmu(TABLE_1, tmp_path / "bogie.fmu")
    assert fmu.platform is None
    assert "no C compiler was found (none of cc, gcc, clang is on the path)" in fmu.message
    assert "fmpy compile" in fmu.message
    assert validate_fmu(fmu.path) == []
    assert not [name for name in names_in(fmu.path) if name.startswith("binaries")]


def test_the_code_can_be_compiled_elsewhere(path, tmp_path):
    """With what the FMU says of its sources, as an importer does it."""
    folder = Path(fmpy.extract(str(path), tmp_path))
    shutil.rmtree(folder / "binaries")
    (files,) = description(path).buildConfigurations[0].sourceFileSets
    assert files.language == "C99"
    identifier = description(path).modelExchange.modelIdentifier
    assert description(path).buildConfigurations[0].modelIdentifier == identifier
    target = folder / "binaries" / fmpy.platform_tuple
    target.mkdir(parents=True)
    library = target / f"{identifier}{fmpy.sharedLibraryExtension}"
    sources = [str(folder / "sources" / name) for name in files.sourceFiles]
    subprocess.run([shutil.which("cc"), "-std=c99", "-shared", "-fPIC", "-o", library, *sources], check=True)
    ours, theirs = (fmpy.simulate_fmu(str(unit), stop_time=0.2, start_values={"y_b": 1e-3}) for unit in (path, folder))
    assert ours["y_w1"] == pytest.approx(theirs["y_w1"], abs=1e-12)


@pytest.mark.parametrize(
    ("script", "message"),
    [("#!/bin/sh\necho 'fatal error: disk is full' >&2; exit 1\n", "disk is full"), ("#!/bin/sh\nexit 0\n", "failed")],
)
def test_a_compiler_that_fails_is_told(tmp_path, monkeypatch, script, message):
    compiler = tmp_path / "badcc"
    compiler.write_text(script)
    compiler.chmod(0o755)
    monkeypatch.setenv("CC", str(compiler))
    fmu = yd.write_fmu(TABLE_1, tmp_path / "bogie.fmu")
    assert fmu.platform is None
    assert message in fmu.message
    assert str(compiler) in fmu.message


def test_a_compiler_that_hangs_is_stopped(tmp_path, monkeypatch):
    script = tmp_path / "slow-cc"
    script.write_text("#!/bin/sh\nsleep 600 & wait\n")
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    monkeypatch.setattr("yawdesign.exports.fmu.archive._TIME_LIMIT", 0.5)
    fmu = yd.write_fmu(TABLE_1, tmp_path / "bogie.fmu")
    assert fmu.platform is None
    assert "slow-cc did not finish in 0.5 s and was stopped; the FMU holds its C code only" in fmu.message


def test_a_compiler_named_but_not_there(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler -m64")
    assert "CC=no-such-compiler names none" in yd.write_fmu(TABLE_1, tmp_path / "bogie.fmu").message


def test_an_existing_file_is_kept(tmp_path):
    path = tmp_path / "bogie.fmu"
    path.write_text("mine")
    with pytest.raises(yd.ProblemError, match=r"bogie\.fmu exists"):
        yd.write_fmu(TABLE_1, path)
    assert path.read_text() == "mine"
    assert yd.write_fmu(TABLE_1, path, replace=True).path == str(path)
    assert zipfile.is_zipfile(path)


def test_a_name_without_its_ending_is_refused(tmp_path):
    with pytest.raises(yd.ProblemError, match=r"must end in \.fmu"):
        yd.write_fmu(TABLE_1, tmp_path / "bogie.zip")


def test_a_problem_without_damping_is_refused(tmp_path):
    with pytest.raises(yd.ProblemError, match=r"C_s is missing"):
        yd.write_fmu(TABLE_1.replace(C_s=None), tmp_path / "bogie.fmu")
    assert not list(tmp_path.iterdir())


def test_a_place_that_cannot_be_written_is_named_and_left_clean(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(OSError, match=r"bogie\.fmu"):
        yd.write_fmu(TABLE_1, tmp_path / "file" / "bogie.fmu")

    ordinary = Path.open

    def read_only(self, mode="r", *more, **options):
        if "+" in mode and "bogie.fmu" in self.name:
            raise PermissionError(13, "Permission denied", str(self))
        return ordinary(self, mode, *more, **options)

    monkeypatch.setattr(Path, "open", read_only)
    monkeypatch.setattr("yawdesign.exports.fmu.archive._library", lambda texts: (b"", ""))
    with pytest.raises(PermissionError, match=r"Permission denied: '.*bogie\.fmu'"):
        yd.write_fmu(TABLE_1, tmp_path / "bogie.fmu")
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


@pytest.mark.slow
@pytest.mark.parametrize("compiler", [True, False])
def test_export_on_the_command_line(tmp_path, compiler):
    problem = Path(__file__).parents[2] / "problems" / "table1.yaml"
    command = [sys.executable, "-m", "yawdesign", "export", str(problem), "--to", "out", "--only", "fmu"]
    environment = os.environ | ({} if compiler else {"PATH": str(tmp_path), "CC": ""})
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert ("note: bogie.fmu: no C compiler was found" in done.stderr) == (not compiler)
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["bogie.fmu", "manifest.json"]
    assert validate_fmu(str(tmp_path / "out" / "bogie.fmu")) == []


@pytest.mark.parametrize(
    ("only", "formats", "files"),
    [
        ("fmu", None, {"bogie.fmu"}),
        (["fmu"], ["mat"], {"bogie.fmu", "state_space.mat"}),
        ("stability_margin,casadi,fmu", None, {"bogie.fmu", "stability_margin.casadi"}),
        ("stability_margin", ["fmu"], {"bogie.fmu"}),
    ],
)
@pytest.mark.slow
def test_a_kind_of_file_among_the_functions(tmp_path, only, formats, files):
    export = yd.export(TABLE_1, tmp_path / "out", only=only, formats=formats)
    assert set(export.files) == {*files, "manifest.json"}


def test_an_export_without_damping_leaves_the_fmu_out(tmp_path):
    export = yd.export(TABLE_1.replace(C_s=None), tmp_path / "out", only="stability_margin", formats="casadi,fmu")
    assert "bogie.fmu" not in export.files
    assert any("bogie.fmu left out" in note and "C_s is missing" in note for note in export.notes)
    with pytest.raises(yd.ProblemError, match="C_s is missing"):
        yd.export(TABLE_1.replace(C_s=None), tmp_path / "other", only="fmu")

"""The manifest: what every exported function takes and gives, and how to check it."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from yawdesign.exports import described_vehicle
from yawdesign.exports.c_files import signature, vector_sizes
from yawdesign.exports.file_contents import FileContents
from yawdesign.exports.folder import GENERATOR, MANIFEST, write_text
from yawdesign.exports.functions import Documented, Functions, versions
from yawdesign.hunting.routh import TIME_UNIT
from yawdesign.problem.result import plain

TIME_SCALE = {
    "value": TIME_UNIT,
    "unit": "rad/s",
    "meaning": "polynomials and Routh columns are in s divided by this",
}
C_TYPES = {"casadi_real": "double", "casadi_int": "long long int"}
TOLERANCE = {"relative": 1e-9, "absolute": 1e-12, "meaning": "relative to the largest entry of each output"}


def write_manifest(contents: FileContents, files: Sequence[str], notes: Sequence[str], folder: Path) -> str:
    """Write manifest.json and return its name."""
    described = Functions(contents.functions).to_dict()
    manifest = {
        "generator": GENERATOR,
        "versions": versions(),
        "title": contents.problem.title,
        "kind": contents.problem.bogie.kind,
        "equations": contents.problem.equations,
        **described_vehicle.described(contents.problem),
        "condition": contents.condition,
        "load": None if contents.problem.curve is None else contents.problem.curve.load,
        "matrices": "column by column, in C, in the self-tests and in lists of units",
        "c_types": C_TYPES,
        "tolerance": TOLERANCE,
        "files": [*files, MANIFEST],
        "notes": list(notes),
        "functions": {
            name: _entry(name, described[name], f, contents, files) for name, f in contents.functions.items()
        },
    }
    return write_text(folder / MANIFEST, json.dumps(plain(manifest), indent=1, ensure_ascii=False) + "\n")


def _entry(
    name: str, described: Mapping[str, Any], f: Documented, contents: FileContents, files: Sequence[str]
) -> dict[str, Any]:
    names, s = contents.names, contents.names.symbol(name)
    own = {"casadi": f"{name}.casadi", "c": names.source, "header": names.header}
    return {
        "files": {kind: file for kind, file in own.items() if file in files},
        "c_symbol": s,
        "c_signature": signature(s),
        "c_vector_lengths": vector_sizes(s, f),
        "mex_call": _mex_call(names.prefix, s, f),
        **described,
        "time_scale": TIME_SCALE,
        "versions": versions(),
        "self_test": contents.tests[name],
    }


def _mex_call(file: str, symbol: str, f: Documented) -> str:
    """Return how a function is called in MATLAB and Octave."""
    arguments = ", ".join([f"'{symbol}'", *(port.name for port in f.inputs)])
    return f"[{', '.join(port.name for port in f.outputs)}] = {file}({arguments})"

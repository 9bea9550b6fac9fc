"""The public namespace: complete, documented, and deaf to the rooms' names."""

import dataclasses
import importlib
import inspect
import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd


def test_functions_keep_their_names_after_their_rooms_are_imported():
    for room in ("yawdesign.damper.optimise", "yawdesign.hunting.critical_damping"):
        importlib.import_module(room)
    assert callable(yd.design)
    assert callable(yd.stability)
    assert set(yd.__all__) <= set(dir(yd))


def test_unknown_name():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = yd.nothing


@pytest.mark.parametrize("name", yd.__all__)
def test_public_names_document_their_arguments(name):
    public = getattr(yd, name)
    if not callable(public):
        return
    text = inspect.getdoc(public)
    assert text
    if issubclass(public, Exception) if inspect.isclass(public) else False:
        return
    inherited = "".join(inspect.getdoc(base) or "" for base in public.__mro__[1:]) if inspect.isclass(public) else ""
    for argument in inspect.signature(public).parameters:
        assert argument.strip("*") in text + inherited, f"{name} does not document {argument}"


def test_results_are_plain_data_and_readable():
    result = yd.stability(yd.table1())
    assert pickle.loads(pickle.dumps(result)) == result
    assert "spectral_abscissa" in repr(result)
    assert result.to_dict()["eigenvalues"][0] == [result.eigenvalues[0].real, result.eigenvalues[0].imag]
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.stable = False
    assert np.isclose(result.damping_ratio, min(m.damping_ratio for m in result.modes))


def test_long_lists_and_mappings_of_a_result_are_shown_in_part():
    response = yd.stationary_response(yd.table1())
    (line,) = (each for each in repr(response).splitlines() if each.startswith("  rms "))
    assert line.endswith(f", ... ({len(response.rms)} in all)")
    assert line.count("=") == 12
    assert "speed=83.3333333" in repr(yd.stability(yd.table1()))


def test_every_dependency_has_a_lowest_version_that_is_tested():
    """The constraints of .ci/run name every library but the tools of development."""
    root = Path(__file__).parents[1]
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = {name: list_ for name, list_ in project["optional-dependencies"].items() if name != "dev"}
    named = {re.split(r"[\[<>=! ]", text)[0] for text in sum(extras.values(), project["dependencies"])} - {"yawdesign"}
    done = subprocess.run(
        [sys.executable, root / ".ci" / "lowest.py"], capture_output=True, text=True, check=True, encoding="utf-8"
    )
    constraints = dict(line.split("==") for line in done.stdout.splitlines())
    assert named <= set(constraints)
    assert "casadi" in named

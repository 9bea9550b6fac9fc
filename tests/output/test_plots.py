"""Every result that can be shown has a picture."""

from importlib import import_module

import yawdesign as yd
from yawdesign.output.plots import DRAWN_BY
from yawdesign.problem.result import Result

WITHOUT = {"Export", "Fmu", "StateSpaceModel", "Reproduction"}  # files, matrices, tables


def test_every_public_result_is_drawn():
    public = {
        name for name in yd.__all__ if isinstance(getattr(yd, name), type) and issubclass(getattr(yd, name), Result)
    }
    assert public - WITHOUT == set(DRAWN_BY)
    assert all(callable(getattr(import_module(home), name)) for home, name in DRAWN_BY.values())

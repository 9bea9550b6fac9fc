"""Yaw damper design for motor bogies: hunting stability, curving limit and optimum.

The public names are listed in ``__init__.pyi`` and loaded when they are first used, so that importing costs nothing.
"""

import re
from functools import cache
from importlib import import_module
from pathlib import Path
from types import FunctionType
from typing import Any

__version__ = "0.2.0"

_LISTED = Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")
_HOME = {name: home for home, name in re.findall(r"^from (\S+) import (\w+) as", _LISTED, re.MULTILINE)}
__all__ = sorted(_HOME)  # noqa: PLE0605


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'yawdesign' has no attribute {name!r}")
    return _public(name)


@cache
def _public(name: str) -> Any:
    """Return what has a public name; a function looks at its arguments before it begins."""
    found = getattr(import_module(_HOME[name]), name)
    import_module("yawdesign.problem.notebook_view").NotebookView.made_by = _html
    if not isinstance(found, FunctionType):
        return found
    function: Any = import_module("yawdesign.problem.arguments").checked(found)
    if "progress" in found.__annotations__:
        function = import_module("yawdesign.output.progress_shown").with_bar_in_notebooks(function)
    function.__module__, function.__qualname__ = __name__, name  # where pickle finds it
    return function


def _html(shown: Any) -> str:
    """Return the tables of a problem or of a result, for a notebook."""
    made: str = import_module("yawdesign.output.notebooks").html(shown)
    return made


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])

"""Yaw damper design for motor bogies: hunting stability, curving limit and optimum.

The names below are loaded when they are first used, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yawdesign.design.forward import ForwardDesign, design
    from yawdesign.design.optimise import Optimum, optimise
    from yawdesign.problem import (
        PARAMETERS,
        Bogie,
        Curve,
        Design,
        Problem,
        ProblemError,
        SpeedRange,
        Variable,
        load,
        loads,
        schema,
        table1,
    )
    from yawdesign.stability.verdict import Stability, stability

__version__ = "0.1.0"

_HOMES = {
    "yawdesign.problem": (
        *("PARAMETERS", "Bogie", "Curve", "Design", "Problem", "ProblemError", "SpeedRange", "Variable"),
        *("load", "loads", "schema", "table1"),
    ),
    "yawdesign.stability.verdict": ("Stability", "stability"),
    "yawdesign.design.forward": ("ForwardDesign", "design"),
    "yawdesign.design.optimise": ("Optimum", "optimise"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PARAMETERS",
    "Bogie",
    "Curve",
    "Design",
    "ForwardDesign",
    "Optimum",
    "Problem",
    "ProblemError",
    "SpeedRange",
    "Stability",
    "Variable",
    "design",
    "load",
    "loads",
    "optimise",
    "schema",
    "stability",
    "table1",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'yawdesign' has no attribute {name!r}")
    # Importing a room binds its name here ("design", "stability"): the function of that name must win.
    for known, home in _HOME.items():
        if known == name or known in {"design", "stability"}:
            globals()[known] = getattr(import_module(home), known)
    return globals()[name]


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])

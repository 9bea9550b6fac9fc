"""Yaw damper design for motor bogies: hunting stability, curving limit and optimum.

The names below are loaded when they are first used, so that importing the package costs nothing.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yawdesign.design.forward import ForwardDesign, design
    from yawdesign.design.optimise import Optimum, optimise
    from yawdesign.output.plots import plot
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
    from yawdesign.study.result import Sweep
    from yawdesign.study.sweep import IncompleteSweepError, sweep

__version__ = "0.1.0"

_HOMES = {
    "yawdesign.problem": (
        *("PARAMETERS", "Bogie", "Curve", "Design", "Problem", "ProblemError", "SpeedRange", "Variable"),
        *("load", "loads", "schema", "table1"),
    ),
    "yawdesign.stability.verdict": ("Stability", "stability"),
    "yawdesign.design.forward": ("ForwardDesign", "design"),
    "yawdesign.design.optimise": ("Optimum", "optimise"),
    "yawdesign.study.result": ("Sweep",),
    "yawdesign.study.sweep": ("IncompleteSweepError", "sweep"),
    "yawdesign.output.plots": ("plot",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PARAMETERS",
    "Bogie",
    "Curve",
    "Design",
    "ForwardDesign",
    "IncompleteSweepError",
    "Optimum",
    "Problem",
    "ProblemError",
    "SpeedRange",
    "Stability",
    "Sweep",
    "Variable",
    "design",
    "load",
    "loads",
    "optimise",
    "plot",
    "schema",
    "stability",
    "sweep",
    "table1",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'yawdesign' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


class _Package(ModuleType):
    """The package, in which two functions bear the names of the rooms that they live in.

    Importing a room binds the room's name in its package; here the function keeps it.
    """

    @property
    def design(self) -> Any:
        return __getattr__("design")

    @design.setter
    def design(self, module: ModuleType) -> None: ...

    @property
    def stability(self) -> Any:
        return __getattr__("stability")

    @stability.setter
    def stability(self, module: ModuleType) -> None: ...


sys.modules[__name__].__class__ = _Package

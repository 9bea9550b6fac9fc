"""Yaw damper design for motor bogies: hunting stability, curving limit and optimum.

The names below are loaded when they are first used, so that importing the package costs nothing.
"""

import sys
from functools import cache
from importlib import import_module
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yawdesign.design.forward import ForwardDesign, design
    from yawdesign.design.functions import functions
    from yawdesign.design.optimise import Optimum, optimise
    from yawdesign.design.state_space import StateSpaceModel, state_space
    from yawdesign.output.animation import animate
    from yawdesign.output.export.write import Export, export
    from yawdesign.output.fmi.archive import Fmu, write_fmu
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
    from yawdesign.response.component import DamperComponent
    from yawdesign.response.following import FollowedModes, follow_modes
    from yawdesign.response.frequency import FrequencyResponse, frequency_response
    from yawdesign.response.measured import MeasuredTrack, read_track
    from yawdesign.response.modes import Modes, modes
    from yawdesign.response.simulate import Simulation, damper_component, simulate
    from yawdesign.response.spectra import SPECTRA, Spectrum
    from yawdesign.response.stationary import StationaryResponse, stationary_response
    from yawdesign.response.synthesis import SpectrumCheck, spectrum_check
    from yawdesign.response.tabulated import read_spectrum
    from yawdesign.response.track import Band, Harmonic, RandomTrack, Sinusoid
    from yawdesign.stability.verdict import Stability, stability
    from yawdesign.study.result import Sweep
    from yawdesign.study.sweep import IncompleteSweepError, sweep

__version__ = "0.2.0"

_HOMES = {
    "yawdesign.problem": (
        *("PARAMETERS", "Bogie", "Curve", "Design", "Problem", "ProblemError", "SpeedRange", "Variable"),
        *("load", "loads", "schema", "table1"),
    ),
    "yawdesign.stability.verdict": ("Stability", "stability"),
    "yawdesign.response.component": ("DamperComponent",),
    "yawdesign.response.frequency": ("FrequencyResponse", "frequency_response"),
    "yawdesign.response.measured": ("MeasuredTrack", "read_track"),
    "yawdesign.response.tabulated": ("read_spectrum",),
    "yawdesign.response.simulate": ("Simulation", "damper_component", "simulate"),
    "yawdesign.response.spectra": ("SPECTRA", "Spectrum"),
    "yawdesign.response.stationary": ("StationaryResponse", "stationary_response"),
    "yawdesign.response.synthesis": ("SpectrumCheck", "spectrum_check"),
    "yawdesign.response.track": ("Band", "Harmonic", "RandomTrack", "Sinusoid"),
    "yawdesign.response.following": ("FollowedModes", "follow_modes"),
    "yawdesign.response.modes": ("Modes", "modes"),
    "yawdesign.design.forward": ("ForwardDesign", "design"),
    "yawdesign.design.functions": ("functions",),
    "yawdesign.design.optimise": ("Optimum", "optimise"),
    "yawdesign.study.result": ("Sweep",),
    "yawdesign.study.sweep": ("IncompleteSweepError", "sweep"),
    "yawdesign.design.state_space": ("StateSpaceModel", "state_space"),
    "yawdesign.output.export.write": ("Export", "export"),
    "yawdesign.output.fmi.archive": ("Fmu", "write_fmu"),
    "yawdesign.output.animation": ("animate",),
    "yawdesign.output.plots": ("plot",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PARAMETERS",
    "SPECTRA",
    "Band",
    "Bogie",
    "Curve",
    "DamperComponent",
    "Design",
    "Export",
    "Fmu",
    "FollowedModes",
    "ForwardDesign",
    "FrequencyResponse",
    "Harmonic",
    "IncompleteSweepError",
    "MeasuredTrack",
    "Modes",
    "Optimum",
    "Problem",
    "ProblemError",
    "RandomTrack",
    "Simulation",
    "Sinusoid",
    "Spectrum",
    "SpectrumCheck",
    "SpeedRange",
    "Stability",
    "StateSpaceModel",
    "StationaryResponse",
    "Sweep",
    "Variable",
    "animate",
    "damper_component",
    "design",
    "export",
    "follow_modes",
    "frequency_response",
    "functions",
    "load",
    "loads",
    "modes",
    "optimise",
    "plot",
    "read_spectrum",
    "read_track",
    "schema",
    "simulate",
    "spectrum_check",
    "stability",
    "state_space",
    "stationary_response",
    "sweep",
    "table1",
    "write_fmu",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'yawdesign' has no attribute {name!r}")
    return _public(name)


@cache
def _public(name: str) -> Any:
    """Return what has a public name; a function looks at its arguments before it begins."""
    found = getattr(import_module(_HOME[name]), name)
    if not isinstance(found, FunctionType):
        return found
    function: Any = import_module("yawdesign.problem.arguments").checked(found)
    function.__module__, function.__qualname__ = __name__, name  # where pickle finds it
    return function


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

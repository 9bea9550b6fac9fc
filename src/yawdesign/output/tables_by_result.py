"""Which tables show which kind of result: the same in a terminal, in a notebook and in a page."""

from importlib import import_module
from typing import Any

from rich.console import RenderableType

# What makes the tables of which kind of result, as module and function.
TABLES_BY = {
    "Problem": ("yawdesign.output.problem_tables", "problem_tables"),
    "Stability": ("yawdesign.output.tables", "stability_tables"),
    "CriticalSpeeds": ("yawdesign.output.critical_speed_tables", "critical_speed_tables"),
    "ForwardDesign": ("yawdesign.output.tables", "design_tables"),
    "Optimum": ("yawdesign.output.optimum_tables", "optimum_tables"),
    "Choice": ("yawdesign.output.choice_tables", "choice_tables"),
    "TradeOff": ("yawdesign.output.trade_off_tables", "trade_off_tables"),
    "Sweep": ("yawdesign.output.sweep_tables", "sweep_tables"),
    "Uncertainty": ("yawdesign.output.uncertainty_tables", "uncertainty_tables"),
    "Simulation": ("yawdesign.output.response_tables", "simulation_tables"),
    "DamperComponent": ("yawdesign.output.response_tables", "damper_tables"),
    "FrequencyResponse": ("yawdesign.output.harmonic_tables", "frequency_response_tables"),
    "StationaryResponse": ("yawdesign.output.harmonic_tables", "stationary_tables"),
    "SpectrumCheck": ("yawdesign.output.harmonic_tables", "spectrum_tables"),
    "Modes": ("yawdesign.output.mode_tables", "modes_tables"),
    "FollowedModes": ("yawdesign.output.mode_tables", "followed_tables"),
    "Reproduction": ("yawdesign.output.reproduction_tables", "reproduction_tables"),
    "Export": ("yawdesign.output.export_tables", "export_tables"),
    "Fmu": ("yawdesign.output.export_tables", "fmu_tables"),
    "StateSpaceModel": ("yawdesign.output.export_tables", "state_space_tables"),
}


def tables_of(result: Any) -> RenderableType:
    """Return the tables of a problem or of a result.

    Parameters
    ----------
    result : Problem or Result
        One of `TABLES_BY`.
    """
    home, function = TABLES_BY[type(result).__name__]
    shown: RenderableType = getattr(import_module(home), function)(result)
    return shown

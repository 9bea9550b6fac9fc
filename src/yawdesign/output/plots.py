"""Pictures of results. Every function draws into Matplotlib axes and returns them; nothing is computed or shown."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from yawdesign.output.pictures import own_texts
from yawdesign.problem.arguments import checked, refused

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# What draws which kind of result, as module and function.
DRAWN_BY: dict[str, tuple[str, str]] = {
    "Sweep": ("yawdesign.output.sweep_plots", "draw"),
    "CriticalSpeeds": ("yawdesign.output.critical_speed_plots", "draw_critical_speeds"),
    "ForwardDesign": ("yawdesign.output.design_plots", "draw_design"),
    "Uncertainty": ("yawdesign.output.uncertainty_plots", "draw_uncertainty"),
    "Optimum": ("yawdesign.output.optimum_plots", "draw_optimum"),
    "Choice": ("yawdesign.output.choice_plots", "draw_choice"),
    "TradeOff": ("yawdesign.output.trade_off_plots", "draw_trade_off"),
    "DamperComponent": ("yawdesign.output.damper_plots", "damper_component"),
    "FrequencyResponse": ("yawdesign.output.response_plots", "frequency_response"),
    "Simulation": ("yawdesign.output.simulation_plots", "simulation"),
    "SpectrumCheck": ("yawdesign.output.response_plots", "spectrum_check"),
    "FollowedModes": ("yawdesign.output.mode_plots", "mode_paths"),
    "Stability": ("yawdesign.output.stability_plots", "draw_stability"),
    "StationaryResponse": ("yawdesign.output.stationary_plots", "draw_stationary"),
    "Modes": ("yawdesign.output.mode_shape_plots", "mode_shape"),
}


def plot(result: Any, ax: "Axes | None" = None, **options: Any) -> "Axes":
    """Draw any result of this package.

    Texts are set by Matplotlib itself, not by LaTeX. A picture of several panels divides the axes it is given.

    Parameters
    ----------
    result : Result
        What `yawdesign.sweep` and the other functions return.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure if not given.
    **options
        Of the function that draws this kind of result.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ProblemError
        If there is no picture of such a thing.
    """
    kind = type(result).__name__
    if kind not in DRAWN_BY:
        raise refused("result", f"something to draw ({', '.join(sorted(DRAWN_BY))})", result)
    if ax is not None and not hasattr(ax, "get_figure"):
        raise refused("ax", "axes of Matplotlib", ax)
    home, name = DRAWN_BY[kind]
    with own_texts():
        axes: Axes = checked(getattr(import_module(home), name))(result, ax=ax, **options)
    return axes

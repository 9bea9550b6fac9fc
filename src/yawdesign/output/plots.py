"""Pictures of results. Every function draws into Matplotlib axes and returns them; nothing is computed or shown."""

import io
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yawdesign.problem.arguments import checked, refused
from yawdesign.problem.writing import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PICTURES = (".png", ".pdf", ".svg")
ANIMATIONS = (".gif", ".svg")
DOTS_PER_INCH = 150

# What draws which kind of result, as module and function.
DRAWN_BY: dict[str, tuple[str, str]] = {
    "Sweep": ("yawdesign.output.study_plots", "draw"),
    "ForwardDesign": ("yawdesign.output.design_plots", "draw_design"),
    "Optimum": ("yawdesign.output.design_plots", "draw_optimum"),
    "DamperComponent": ("yawdesign.output.response_plots", "damper_component"),
    "FrequencyResponse": ("yawdesign.output.response_plots", "frequency_response"),
    "Simulation": ("yawdesign.output.response_plots", "simulation"),
    "SpectrumCheck": ("yawdesign.output.response_plots", "spectrum_check"),
    "FollowedModes": ("yawdesign.output.mode_plots", "mode_paths"),
    "Modes": ("yawdesign.output.mode_plots", "mode_shape"),
}


def plot(result: Any, ax: "Axes | None" = None, **options: Any) -> "Axes":
    """Draw any result of this package.

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
    axes: Axes = checked(getattr(import_module(home), name))(result, ax=ax, **options)
    return axes


def write_picture(axes: "Axes", path: Path, *, replace: bool = False) -> None:
    """Write the figure of some axes as in `whole_file`; the ending of the name, one of `PICTURES`, tells how."""
    content = io.BytesIO()
    figure: Any = axes.get_figure(root=True)
    figure.savefig(content, format=path.suffix[1:].lower(), dpi=DOTS_PER_INCH)
    write_whole(path, content.getvalue(), replace=replace)


def new_axes(ax: "Axes | None") -> "Axes":
    """Return the axes given, or those of a new figure that no window shows."""
    if ax is not None:
        return ax
    from matplotlib.figure import Figure

    return Figure(figsize=(7.0, 4.5), layout="constrained").add_subplot()

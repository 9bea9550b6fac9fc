"""Figures 2 to 5 of the paper, drawn from runs and sweeps; nothing is computed here."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from yawdesign.output.pictures import own_texts
from yawdesign.output.plots import plot
from yawdesign.problem import PARAMETERS, format_quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.simulate import Simulation
    from yawdesign.study.result import Sweep

SHOWN_TIME = 10.0  # [s]
ACCELERATIONS, DISPLACEMENTS = ("y_b_acceleration", "phi_b_acceleration"), ("y_b", "phi_b")
DAMPING, IRREGULARITY = "kN·s/m", "German low disturbance (0.3 to 40 Hz)"
SIZES = {"runs": (7.0, 5.2), "curves": (7.0, 9.6)}  # [inch]
PANELS_OF_FIGURE_3 = {
    "fig3a-damping-held": r"(a) over the natural frequency, damping $C_\mathrm{m}$ held",
    "fig3a-ratio-held": r"(a) over the natural frequency, damping ratio $\xi_\mathrm{m}$ held",
    "fig3b": "(b) over the damping ratio",
}


def response_panels(run: "Simulation", names: Sequence[str], title: str) -> "Axes":
    """Draw two responses of a run below each other, as the paper does, and return the upper axes."""
    figure, panels = _panels(2, "runs", sharex=True)
    for ax, name, letter in zip(panels, names, "ab", strict=True):
        plot(run, ax, response=name, until=SHOWN_TIME)
        if legend := ax.get_legend():
            legend.remove()
        ax.set_ylabel(ax.get_ylabel().replace(" of the frame", ""))
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
    panels[0].set_xlabel("")
    figure.suptitle(title.replace("C_s", f"${PARAMETERS['C_s'].symbol}$"), fontsize="medium")
    return panels[0]


def curve_panels(curves: Mapping[str, "Sweep"], title: str) -> "Axes":
    """Draw the critical damping over the motor suspension, as Figure 3, and return the uppermost axes."""
    figure, panels = _panels(len(PANELS_OF_FIGURE_3), "curves")
    explained: dict[str, Any] = {}
    for ax, (name, words) in zip(panels, PANELS_OF_FIGURE_3.items(), strict=True):
        plot(curves[name], ax)
        ax.set_title(words, loc="left", fontsize="medium")
        if legend := ax.get_legend():
            explained |= {text.get_text(): mark for text, mark in zip(legend.texts, legend.legend_handles, strict=True)}
            legend.remove()
    with own_texts():
        figure.legend(explained.values(), explained, loc="outside lower center", ncols=len(explained))
    figure.suptitle(title, fontsize="medium")
    return panels[0]


def _panels(rows: int, size: str, **options: Any) -> tuple[Any, Sequence["Axes"]]:
    from matplotlib.figure import Figure

    with own_texts():
        figure = Figure(figsize=SIZES[size], layout="constrained")
        return figure, figure.subplots(rows, 1, **options)


def drawing_of(drawn: Mapping[str, Any]) -> dict[str, tuple[str, Callable[[str], "Axes"]]]:
    """Return by the name of each figure its title and what draws it under a title."""

    def run(name: str, track: str, responses: Sequence[str]) -> tuple[str, Callable[[str], "Axes"]]:
        one = drawn[name]
        at = f"{format_quantity(one.speed, 'km/h')}, C_s = {format_quantity(one.C_s, DAMPING)}"
        return f"Fig. {name.removeprefix('fig')}: {at}, {track}", lambda title: response_panels(one, responses, title)

    of_figure_3 = "Fig. 3: critical yaw damping over the motor suspension, equations as printed"
    return {
        "fig2": run("fig2", "y = sin 6t m of the rail under the front wheelset", ACCELERATIONS),
        "fig3": (of_figure_3, lambda title: curve_panels(drawn, title)),
        "fig4": run("fig4", IRREGULARITY, DISPLACEMENTS),
        "fig5": run("fig5", IRREGULARITY, DISPLACEMENTS),
    }

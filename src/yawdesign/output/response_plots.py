"""Pictures of the bogie in motion: frequency responses, time histories, spectra, and the yaw damper's stiffness."""

from collections.abc import Sequence
from math import degrees
from typing import TYPE_CHECKING

from yawdesign.output.pictures import literal, new_axes
from yawdesign.problem import ProblemError, format_quantity
from yawdesign.vehicle.signals import DIRECTIONS, ENDS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.damper_component import DamperComponent
    from yawdesign.response.run.frequency import FrequencyResponse
    from yawdesign.response.run.simulate import Simulation
    from yawdesign.response.track.spectrum_check import SpectrumCheck

LATERAL, YAW = "#1f5a96", "#c0504d"
COLOURS = (LATERAL, YAW, "#4f8a4b", "#7a5ca8", "#b58900", "#5b6770")
# What people read: SI unit -> (factor, unit shown).
SHOWN = {
    "m": (1e3, "mm"),
    "rad": (1e3, "mrad"),
    "m/s": (1e3, "mm/s"),
    "rad/s": (1e3, "mrad/s"),
    "m/s^2": (1.0, "m/s²"),
    "rad/s^2": (1.0, "rad/s²"),
    "N": (1e-3, "kN"),
}
BODIES = {"b": "frame", "w1": "front wheelset", "w2": "rear wheelset", "m1": "front motor", "m2": "rear motor"}


def meaning(name: str) -> str:
    """Return what a response is called, such as "lateral acceleration of the frame"."""
    direction, body, *rate = name.split("_")
    if direction in DIRECTIONS and body in BODIES:
        return f"{DIRECTIONS[direction]} {rate[0] if rate else 'displacement'} of the {BODIES[body]}"
    words = name.split("_")
    end = f" ({ENDS[words.pop()]})" if words[-1] in ENDS else ""
    return " ".join(words) + end


def simulation(
    result: "Simulation",
    ax: "Axes | None" = None,
    response: str = "y_b",
    speeds: Sequence[float] | None = None,
    until: float | None = None,
) -> "Axes":
    """Draw a response over time, one line for each speed.

    Parameters
    ----------
    result : Simulation
        What `simulate` returns.
    ax : Axes, optional
        Where to draw.
    response : str
        Name of the response, or of a track input.
    speeds : sequence of float, optional
        Speeds to draw [m/s]; all if not given.
    until : float, optional
        Last time that is drawn [s].
    """
    ax = new_axes(ax)
    chosen = [h for h in result.histories if speeds is None or any(abs(h.speed - v) < 1e-6 for v in speeds)]
    if not chosen:
        raise ProblemError(f"speeds: there are runs at {', '.join(f'{h.speed:g}' for h in result.histories)} m/s")
    factor, unit = SHOWN[chosen[0].unit(response)]
    for k, history in enumerate(chosen):
        shown = history.time <= (until or history.time[-1])
        label = format_quantity(history.speed, "km/h", 4)
        colour = COLOURS[k % len(COLOURS)]
        ax.plot(history.time[shown], factor * history[response][shown], lw=0.9, color=colour, label=label)
    ax.axhline(0, color="0.7", lw=0.6, zorder=0)
    ax.margins(x=0)
    ax.set(xlabel="time [s]", ylabel=f"{_first_capital(meaning(response))} [{unit}]")
    ax.set_title(
        f"Track {literal(result.track)}, C_s = {format_quantity(result.C_s, 'kN·s/m')}", fontsize="medium", loc="left"
    )
    ax.legend(frameon=False, ncols=min(len(chosen), 4), loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2)
    return ax


def _first_capital(text: str) -> str:
    return text[0].upper() + text[1:]


def frequency_response(result: "FrequencyResponse", ax: "Axes | None" = None) -> "Axes":
    """Draw the amplitude of the frame over frequency: lateral on the left axis, yaw on the right one.

    Parameters
    ----------
    result : FrequencyResponse
        At several wavelengths.
    ax : Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    right = ax.twinx()
    of = {"alignment": "m of alignment", "cross_level": "rad of cross-level"}[result.input]
    for axes, name, colour, unit in ((ax, "y_b", LATERAL, "m"), (right, "phi_b", YAW, "rad")):
        axes.plot(result.frequency, abs(result.amplitudes[name]), color=colour, lw=1.4)
        axes.set_ylabel(f"{_first_capital(meaning(name))} [{unit} per {of}]", color=colour)
        axes.tick_params(axis="y", colors=colour)
        axes.set_ylim(bottom=0)
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter("{x:g}")
    ax.grid(alpha=0.25, which="both")
    ax.set_xlabel("frequency [Hz]")
    title = f"{format_quantity(result.speed, 'km/h', 4)}, C_s = {format_quantity(result.C_s, 'kN·s/m')}"
    ax.set_title(title + ("" if result.stable else " (unstable: free motions grow)"), fontsize="medium", loc="left")
    ax.margins(x=0)
    return ax


def spectrum_check(result: "SpectrumCheck", ax: "Axes | None" = None) -> "Axes":
    """Draw the spectrum of a synthesised track beside the one it was made from.

    Parameters
    ----------
    result : SpectrumCheck
        What `spectrum_check` returns.
    ax : Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    factor, unit, density = {"alignment": (1e3, "mm", "m²"), "cross_level": (1e3, "mrad", "rad²")}[result.input]
    sample = f"synthesised, RMS {factor * result.rms_sample:.3f} {unit} (Welch)"
    target = f"{literal(result.track)}, RMS {factor * result.rms_target:.3f} {unit} in the band"
    ax.loglog(result.wavenumber, result.sample, color=LATERAL, lw=0.8, label=sample)
    ax.loglog(result.wavenumber, result.target, color=YAW, lw=1.6, label=target)
    ax.set(xlabel="wavenumber [rad/m]", ylabel=f"density of {result.input.replace('_', '-')} [{density}/(rad/m)]")
    ax.grid(alpha=0.25, which="both")
    ax.legend(frameon=False)
    return ax


def damper_component(result: "DamperComponent", ax: "Axes | None" = None) -> "Axes":
    """Draw dynamic stiffness and phase of the pair of yaw dampers over frequency.

    Parameters
    ----------
    result : DamperComponent
        What `damper_component` returns.
    ax : Axes, optional
        Where to draw.
    """
    ax = new_axes(ax)
    right = ax.twinx()
    f = [z.frequency for z in result.over_frequency]
    ax.plot(f, [z.stiffness / 1e6 for z in result.over_frequency], "o-", color=LATERAL, ms=3.5)
    right.plot(f, [degrees(z.phase) for z in result.over_frequency], "s--", color=YAW, ms=3.5)
    ax.axhline(result.K_ds / 1e6, color="0.5", lw=0.8, ls=":")
    ax.annotate(
        "stiffness of the joints", (f[-1], result.K_ds / 1e6), ha="right", va="bottom", color="0.4", fontsize="small"
    )
    if result.hunting_frequency is not None:
        ax.axvline(result.hunting_frequency, color="0.5", lw=0.8)
        ax.annotate(" hunting", (result.hunting_frequency, 0.5), color="0.4", fontsize="small")
    ax.set(xlabel="frequency [Hz]", ylim=(0, 1.12 * result.K_ds / 1e6))
    ax.set_ylabel("|Z| of the pair [MN/m]", color=LATERAL)
    right.set_ylabel("phase [°]", color=YAW)
    right.set_ylim(0, 90)
    for axes, colour in ((ax, LATERAL), (right, YAW)):
        axes.tick_params(axis="y", colors=colour)
    title = f"C_s = {format_quantity(result.C_s, 'kN·s/m')}, K_ds = {format_quantity(result.K_ds, 'MN/m')}"
    ax.set_title(title, fontsize="medium", loc="left")
    return ax

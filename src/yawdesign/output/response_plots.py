"""Pictures of the vehicle in motion: frequency responses, time histories, spectra, and the yaw damper's stiffness."""

from collections.abc import Sequence
from math import ceil, degrees, isinf
from typing import TYPE_CHECKING

from yawdesign.output.pictures import literal, new_axes, with_condition
from yawdesign.problem import ProblemError, format_quantity
from yawdesign.vehicle.elements import parted
from yawdesign.vehicle.signals import BOGIES, DIRECTIONS, ENDS, first_looked_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.damper_component import DamperComponent
    from yawdesign.response.run.frequency import FrequencyResponse
    from yawdesign.response.run.simulate import Simulation
    from yawdesign.response.run.time_history import History
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
BODIES = {"b": "frame", "w": "wheelset", "m": "motor", "c": "car body"}
PER_ROW = 4  # lines in one row of a legend
BY_BODY = {"c": COLOURS[0], "b": COLOURS[1], "b1": COLOURS[1], "b2": COLOURS[2]}


def meaning(name: str) -> str:
    """Return what a response is called, such as "lateral acceleration of the frame"."""
    direction, body, *rate = name.split("_")
    part, ends = parted(body)
    if direction in DIRECTIONS and part in BODIES:
        what = f"{DIRECTIONS[direction]} {rate[0] if rate else 'displacement'} of the"
        bogie, end = _ends(ends, of_bogie=part in "bc")
        where = f"{'above' if part == 'c' else 'of'} the {bogie} bogie" if bogie else ""
        return " ".join(filter(None, (what, end, BODIES[part], where)))
    stem, ends = parted(name)
    bogie, end = _ends(ends, of_bogie=stem.startswith("yaw_damper"))
    where = ", ".join(filter(None, (end, bogie and f"{bogie} bogie")))
    return stem.strip("_").replace("_", " ") + (f" ({where})" if where else "")


def _ends(ends: str, *, of_bogie: bool) -> tuple[str, str]:
    """Return which bogie and which end of it the digits behind a name mean; one digit is the bogie or the end."""
    bogie, end = (ends[:1], ends[1:]) if of_bogie or len(ends) > 1 else ("", ends)
    return BOGIES.get(bogie, ""), ENDS.get(end, "")


def simulation(
    result: "Simulation",
    ax: "Axes | None" = None,
    response: str | Sequence[str] | None = None,
    speeds: Sequence[float] | None = None,
    until: float | None = None,
) -> "Axes":
    """Draw responses over time, one line for each and each speed.

    Parameters
    ----------
    result : Simulation
        What `simulate` returns.
    ax : Axes, optional
        Where to draw.
    response : str or sequence of str, optional
        Names of responses, or of track inputs, in the same unit; if not given, the lateral displacement of the frame,
        or, of a vehicle with a car body, its accelerations above both bogies.
    speeds : sequence of float, optional
        Speeds to draw [m/s]; all if not given.
    until : float, optional
        Last time that is drawn [s].
    """
    ax = new_axes(ax)
    chosen = [h for h in result.histories if speeds is None or any(abs(h.speed - v) < 1e-6 for v in speeds)]
    if not chosen:
        raise ProblemError(f"speeds: there are runs at {', '.join(f'{h.speed:g}' for h in result.histories)} m/s")
    names = _responses(chosen[0], response)
    shared, apart = _shared_words(names)
    factor, unit = SHOWN[chosen[0].unit(names[0])]
    lines = [(history, name) for history in chosen for name in names]
    for k, (history, name) in enumerate(lines):
        shown = history.time <= (until or history.time[-1])
        parts = [apart[name]] if len(names) > 1 else []
        parts += [format_quantity(history.speed, "km/h", 4)] if len(chosen) > 1 or not parts else []
        colour = COLOURS[k % len(COLOURS)]
        ax.plot(history.time[shown], factor * history[name][shown], lw=0.9, color=colour, label=", ".join(parts))
    ax.axhline(0, color="0.7", lw=0.6, zorder=0)
    ax.margins(x=0)
    ax.set(xlabel="time [s]", ylabel=f"{_first_capital(shared)} [{unit}]")
    title = f"Track {literal(result.track)}, C_s = {format_quantity(result.C_s, 'kN·s/m')}"
    if len(names) == 1:
        ax.set_title(with_condition(title, result.condition), fontsize="medium", loc="left")
        ax.legend(frameon=False, ncols=min(len(chosen), 4), loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2)
        return ax
    title += f", {format_quantity(chosen[0].speed, 'km/h', 4)}" if len(chosen) == 1 else ""
    ax.legend(
        frameon=False, ncols=PER_ROW, fontsize="small", loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2
    )
    title = with_condition(title, result.condition)
    ax.set_title(title, fontsize="medium", loc="left", pad=10 + 14 * ceil(len(lines) / PER_ROW))  # above the legend
    return ax


def _responses(history: "History", response: str | Sequence[str] | None) -> tuple[str, ...]:
    """Return the names of the responses to draw, all in the unit of the first one."""
    if response is None:
        first, *others = first_looked_at(history.values)
        response = (first, *(name for name in others if history.unit(name) == history.unit(first)))
        response = response if history.unit(first) == "m/s^2" else first
    names = (response,) if isinstance(response, str) else tuple(response)
    for name in names:
        if (unit := history.unit(name)) != history.unit(names[0]):
            raise ProblemError(f"{name} is counted in {unit}, {names[0]} in {history.unit(names[0])}: draw them apart")
    return names


def _shared_words(names: Sequence[str]) -> tuple[str, dict[str, str]]:
    """Return what several responses are called together, and what each is called apart from that.

    Examples
    --------
    >>> _shared_words(["y_b1", "y_b2"])
    ('lateral displacement of the frame of the bogie', {'y_b1': 'leading', 'y_b2': 'trailing'})
    """
    words = [meaning(name).split(" ") for name in names]
    alike = [all(other == word for other in same) for word, *same in zip(*words, strict=False)]
    shared = " ".join(word for word, same in zip(words[0], alike, strict=False) if same)
    if len({len(each) for each in words}) > 1:
        return shared.removesuffix(" the").removesuffix(" of") or "responses", {name: name for name in names}
    apart = [" ".join(word for word, same in zip(each, alike, strict=True) if not same) for each in words]
    return shared or "responses", dict(zip(names, apart, strict=True))


def _first_capital(text: str) -> str:
    return text[0].upper() + text[1:]


def frequency_response(result: "FrequencyResponse", ax: "Axes | None" = None) -> "Axes":
    """Draw the amplitudes of frames and car body over frequency: lateral on the left axis, yaw on the right one.

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
    for axes, colour, names, unit in ((ax, LATERAL, ("y",), "m"), (right, YAW, ("phi", "psi"), "rad")):
        drawn = [x for x in result.amplitudes if x.split("_")[0] in names and x.split("_")[1] in BY_BODY]
        for name in drawn:
            own, label = (colour, None) if len(drawn) == 1 else (BY_BODY[name.split("_")[1]], name)
            style = "--" if label and axes is right else "-"
            axes.plot(result.frequency, abs(result.amplitudes[name]), lw=1.4, ls=style, color=own, label=label)
        axes.set_ylabel(f"{_first_capital(_shared_words(drawn)[0])} [{unit} per {of}]")
        axes.set_ylim(bottom=0)
        if len(drawn) == 1:
            axes.yaxis.label.set_color(colour)
            axes.tick_params(axis="y", colors=colour)
        else:
            axes.legend(frameon=False, loc="upper left" if axes is ax else "upper right", fontsize="small")
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter("{x:g}")
    ax.grid(alpha=0.25, which="both")
    ax.set_xlabel("frequency [Hz]")
    title = f"{format_quantity(result.speed, 'km/h', 4)}, C_s = {format_quantity(result.C_s, 'kN·s/m')}"
    title += "" if result.stable else " (unstable: free motions grow)"
    ax.set_title(with_condition(title, result.condition), fontsize="medium", loc="left")
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
    rigid, highest = isinf(result.K_ds), result.over_frequency[-1].stiffness / 1e6
    if not rigid:
        highest = result.K_ds / 1e6
        ax.axhline(highest, color="0.5", lw=0.8, ls=":")
        ax.annotate("stiffness of the joints", (f[-1], highest), ha="right", va="bottom", color="0.4", fontsize="small")
    if result.hunting_frequency is not None:
        ax.axvline(result.hunting_frequency, color="0.5", lw=0.8)
        ax.annotate(" hunting", (result.hunting_frequency, 0.5), color="0.4", fontsize="small")
    ax.set(xlabel="frequency [Hz]", ylim=(0, 1.12 * highest))
    ax.set_ylabel("|Z| of the pair [MN/m]", color=LATERAL)
    right.set_ylabel("phase [°]", color=YAW)
    right.set_ylim(0, 95 if rigid else 90)
    for axes, colour in ((ax, LATERAL), (right, YAW)):
        axes.tick_params(axis="y", colors=colour)
    joints = "joints rigid" if rigid else f"K_ds = {format_quantity(result.K_ds, 'MN/m')}"
    title = f"C_s = {format_quantity(result.C_s, 'kN·s/m')}, {joints}"
    ax.set_title(title, fontsize="medium", loc="left")
    return ax

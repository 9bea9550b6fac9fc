"""Tables of runs and of the yaw damper as a component."""

from collections.abc import Iterator, Mapping
from math import degrees
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output.response_plots import SHOWN, meaning
from yawdesign.output.tables import damping, facts, speed, titled, verified
from yawdesign.problem import format_quantity
from yawdesign.vehicle.vehicle import known_coordinates

if TYPE_CHECKING:
    from yawdesign.response.run.damper_component import DamperComponent
    from yawdesign.response.run.simulate import Simulation


def simulation_tables(result: "Simulation") -> RenderableType:
    """Return the tables of a `Simulation`."""
    notes = [Text(f"note: {note}", style="dim") for note in result.notes]
    head = Text(f"Track {result.track}, C_s = {damping(result.C_s)}")
    checked = [] if result.checked else [Text("NOT VERIFIED: the two ways to a number differ", "bold yellow")]
    parts: list[RenderableType] = [head, *notes, _growth(result), *_verdicts(result), *checked]
    parts += [_frame(result), _motions(result), _forces(result)]
    return Group(*parts, *([damper_tables(result.damper)] if result.damper else []))


def _growth(result: "Simulation") -> Table:
    title = "Free motions: growth (+) or decay (-)"
    table = titled(title, "speed", "fitted [1/s]", "eigenvalue [1/s]", "hunting [Hz]", "its damping [%]")
    for one in result.runs:
        frequency = "none" if one.frequency is None else f"{one.frequency:.3f}"
        ratio = "" if one.damping_ratio is None else f"{100 * one.damping_ratio:.2f}"
        rates = f"{one.fitted_rate:+.4f}", f"{one.spectral_abscissa:+.4f}"
        table.add_row(speed(one.speed), *rates, frequency, ratio)
    return table


def _verdicts(result: "Simulation") -> Iterator[Text]:
    for one in result.runs:
        yield Text(f"{speed(one.speed)}: ").append(one.verdict, "green" if one.settles else "bold red")


def _frame(result: "Simulation") -> Table:
    title = "The frame in these runs and, RMS by integral over the spectrum, in an endless one (mm, mrad)"
    names = ("y_b", "phi_b")
    columns = [what for name in names for what in (f"{name} RMS", "peak", "endless")]
    table = titled(title, "speed", *columns, "start")
    for one in result.runs:
        cells = [
            "" if values is None else f"{1e3 * values[name]:.4g}"
            for name in names
            for values in (one.rms, one.peak, one.rms_stationary)
        ]
        table.add_row(speed(one.speed), *cells, one.start)
    return table


def _motions(result: "Simulation") -> Table:
    rates = ("", "_velocity", "_acceleration")
    names = [name for name in result.rms if name in known_coordinates()]
    columns = [what for rate in ("u", "u'", "u''") for what in (f"{rate} RMS", "peak")]
    title = f"Responses at {speed(result.speed)}: displacement u (mm, mrad), u' (mm/s, mrad/s), u'' (m/s², rad/s²)"
    table = titled(title, "", *columns)
    for name in names:
        table.add_row(name, *(_shown(result, name + rate, values) for rate in rates for values in _both(result)))
    return table


def _both(result: "Simulation") -> tuple[Mapping[str, float], Mapping[str, float]]:
    return result.rms, result.peak


def _shown(result: "Simulation", name: str, values: Mapping[str, float]) -> str:
    return f"{SHOWN[result.histories[0].unit(name)][0] * values[name]:.4g}"


def _forces(result: "Simulation") -> Table:
    table = titled(f"Forces and strokes at {speed(result.speed)}", "", "RMS", "peak", "unit")
    for name in (x for x in result.rms if any(what in x for what in ("force", "stroke", "damper"))):
        unit = SHOWN[result.histories[0].unit(name)][1]
        table.add_row(meaning(name), *(_shown(result, name, values) for values in _both(result)), unit)
    return table


def damper_tables(result: "DamperComponent") -> RenderableType:
    """Return the tables of a `DamperComponent`."""
    lost = result.decay_rate - result.decay_rate_rigid
    rows = [
        (
            "each of the two dampers",
            f"{damping(result.C_each)} between two joints of {format_quantity(result.K_ds, 'MN/m')}",
        ),
        ("force of each at 0.1 m/s", format_quantity(result.force_at_rated_velocity, "kN", 4)),
        (f"force of each, run at {speed(result.speed)}", _two(result.force_rms, result.force_peak, 1e-3, "kN")),
        ("stroke of each piston", _two(result.stroke_rms, result.stroke_peak, 1e3, "mm")),
        ("velocity of each piston", _two(result.velocity_rms, result.velocity_peak, 1e3, "mm/s")),
        ("above this the joints give way more", f"{result.corner_frequency:.3f} Hz"),
        ("decay rate with these joints", f"{result.decay_rate:.4f} 1/s"),
        ("decay rate with rigid joints", f"{result.decay_rate_rigid:.4f} 1/s (the joints: {lost:+.4f})"),
        ("checked", verified(result.checked)),
    ]
    return Group(facts("The yaw damper to order", rows), _stiffnesses(result))


def _two(rms: float, peak: float, factor: float, unit: str) -> str:
    return f"{factor * rms:.4g} {unit} RMS, {factor * peak:.4g} {unit} peak"


def _stiffnesses(result: "DamperComponent") -> Table:
    title = "Dynamic stiffness of the pair, joints included: Z = K_ds C_s s / (K_ds + C_s s)"
    table = titled(title, "f [Hz]", "|Z| [MN/m]", "phase [°]", "loss factor", "kN·s/m left", "% of C_s")
    at = [(f"{z.frequency:g}", z) for z in result.over_frequency]
    if result.at_hunting is not None:
        at.append((f"{result.at_hunting.frequency:.3f}, hunting", result.at_hunting))
    for name, z in sorted(at, key=lambda entry: entry[1].frequency):
        cells = f"{z.stiffness / 1e6:.3f}", f"{degrees(z.phase):.1f}", f"{z.loss_factor:.3f}"
        style = "bold" if "hunting" in name else ""
        table.add_row(name, *cells, f"{z.damping / 1e3:.1f}", f"{100 * z.damping / result.C_s:.1f}", style=style)
    return table

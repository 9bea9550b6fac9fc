"""Tables of runs and of the yaw damper as a component."""

from collections.abc import Iterator, Mapping
from math import degrees, isinf
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.output.response_words import SHOWN, meaning
from yawdesign.output.tables import damping, facts, speed, titled, verified
from yawdesign.problem import format_quantity
from yawdesign.vehicle.signals import acceleration, first_looked_at

if TYPE_CHECKING:
    from yawdesign.response.run.damper_component import DamperComponent
    from yawdesign.response.run.simulate import Simulation


def simulation_tables(result: "Simulation") -> RenderableType:
    """Return the tables of a `Simulation`."""
    notes = [Text(f"note: {note}", style="dim") for note in result.notes]
    head = Text(f"Track {result.track}, C_s = {damping(result.C_s)}")
    checked = [] if result.checked else [Text("NOT VERIFIED: the two ways to a number differ", "bold yellow")]
    under = Text(condition_in_words(result.condition))
    parts: list[RenderableType] = [head, under, *notes, _growth(result), *_verdicts(result), *checked]
    parts += [_frame(result), *_ride_comfort(result), _motions(result), _forces(result)]
    return Group(*parts, *map(damper_tables, result.dampers))


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
    title = "What is looked at first, in these runs and, RMS by integral over the spectrum, in one without an end"
    table = titled(title, "speed", "", "RMS", "peak", "without an end", "unit", "start")
    for one in result.runs:
        for name in first_looked_at(one.rms):
            factor, unit = SHOWN[result.histories[0].unit(name)]
            sizes = (one.rms, one.peak, one.rms_stationary)
            cells = ["" if values is None else f"{factor * values[name]:.4g}" for values in sizes]
            table.add_row(speed(one.speed), name, *cells, unit, one.start)
    return table


def _ride_comfort(result: "Simulation") -> Iterator[Table]:
    """Yield the table of ride comfort of a vehicle with a car body."""
    if any(one.rms_weighted for one in result.runs):
        title = "Ride comfort in these runs: lateral acceleration of the car body, RMS weighted by W_d of ISO 2631-1"
        table = titled(title, "speed", *(f"{name} [m/s²]" for name in result.runs[0].rms_weighted))
        for one in result.runs:
            table.add_row(speed(one.speed), *(f"{size:.4g}" for size in one.rms_weighted.values()))
        yield table


def _motions(result: "Simulation") -> Table:
    rates = ("", "_velocity", "_acceleration")
    names = [name for name in result.rms if acceleration(name) in result.rms]
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
    lost, rigid = result.decay_rate - result.decay_rate_rigid, isinf(result.K_ds)
    rows = [
        (
            "each of the two dampers",
            f"{damping(result.C_each)}, rigidly mounted"
            if rigid
            else f"{damping(result.C_each)} between two joints of {format_quantity(result.K_ds, 'MN/m')}",
        ),
        ("force of each at 0.1 m/s", format_quantity(result.force_at_rated_velocity, "kN", 4)),
        (f"force of each, run at {speed(result.speed)}", _in_run(result, "force", 1e-3, "kN")),
        ("stroke of each piston", _in_run(result, "stroke", 1e3, "mm")),
        ("velocity of each piston", _in_run(result, "velocity", 1e3, "mm/s")),
        ("above this the joints are displaced more", "never" if rigid else f"{result.corner_frequency:.3f} Hz"),
        ("decay rate with these joints", f"{result.decay_rate:.4f} 1/s"),
        ("decay rate with rigid joints", f"{result.decay_rate_rigid:.4f} 1/s (the joints: {lost:+.4f})"),
        ("checked", verified(result.checked)),
    ]
    where = meaning(result.name.replace(" ", "_")).removeprefix("yaw damper")
    return Group(facts(f"The yaw damper to order{where}", rows), _stiffnesses(result))


def _in_run(result: "DamperComponent", name: str, factor: float, unit: str) -> str:
    if result.decay_rate <= 0:
        return "none: free motion grows"  # what is reached belongs to the length of the run alone
    rms, peak = (factor * float(getattr(result, f"{name}_{kind}")) for kind in ("rms", "peak"))
    return f"{rms:.4g} {unit} RMS, {peak:.4g} {unit} peak"


def _stiffnesses(result: "DamperComponent") -> Table:
    law = "C_s s" if isinf(result.K_ds) else "K_ds C_s s / (K_ds + C_s s)"
    title = f"Dynamic stiffness of the pair, joints included: Z = {law}"
    table = titled(title, "f [Hz]", "|Z| [MN/m]", "phase [°]", "loss factor", "kN·s/m left", "% of C_s")
    at = [(f"{z.frequency:g}", z) for z in result.over_frequency]
    if result.at_hunting is not None:
        at.append((f"{result.at_hunting.frequency:.3f}, hunting", result.at_hunting))
    for name, z in sorted(at, key=lambda entry: entry[1].frequency):
        cells = f"{z.stiffness / 1e6:.3f}", f"{degrees(z.phase):.1f}", f"{z.loss_factor:.3f}"
        style = "bold" if "hunting" in name else ""
        left = f"{z.damping / 1e3:,.1f}".replace(",", " ")
        table.add_row(name, *cells, left, f"{100 * z.damping / result.C_s:.1f}", style=style)
    return table

"""Measured tracks and spectra from files."""

from dataclasses import dataclass
from os import PathLike, fspath

import numpy as np

from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Diagnostic
from yawdesign.problem.units import parse_unit
from yawdesign.response.columns import Column, Table, read_columns, report
from yawdesign.response.spectra import Spectrum, Tabulated
from yawdesign.response.system import Float, System
from yawdesign.response.text_file import text_of
from yawdesign.response.track import Clock

MEASURED = {
    "distance": Column(("m",)),
    "alignment": Column(("mm",)),
    "cross_level": Column(("mm", "mrad"), required=False),
    "gauge": Column(("mm",), required=False),
}
LARGEST_STEP = 1.0  # [m]: a wavelength of 3 m, the shortest that track geometry cars look at, has three points then
EVEN = 0.05  # part of a step by which a step may differ from the others
# Largest size of what can be right [m], [rad]; beyond it the unit is wrong.
LARGEST = {"alignment": 0.5, "cross_level": 0.5}
GAUGES, DEVIATION = (0.5, 2.0), 0.06


@dataclass(frozen=True, eq=False)
class MeasuredTrack:
    """A measured track; between its points straight lines are drawn.

    Parameters
    ----------
    name : str
        Name of the file.
    distance, alignment, cross_level : ndarray
        Distance [m], rising in equal steps, and irregularity [m].
    is_angle : bool
        Whether cross_level is an angle [rad] and not the difference of the rails' heights [m].
    gauge : ndarray or None
        Gauge, or its deviation [m]; kept for reading, a linear contact has no use for it.
    """

    name: str
    distance: Float
    alignment: Float
    cross_level: Float
    is_angle: bool
    gauge: Float | None = None

    @property
    def spacing(self) -> float:
        """Distance of neighbouring points [m]."""
        return float((self.distance[-1] - self.distance[0]) / (len(self.distance) - 1))

    @property
    def notes(self) -> tuple[str, ...]:
        """Length and spacing, and what is not used."""
        own = f"{self.distance[-1] - self.distance[0]:.6g} m measured every {self.spacing:.4g} m"
        if self.gauge is None:
            return (own,)
        low, mean, high = (1e3 * float(f(self.gauge)) for f in (np.min, np.mean, np.max))
        gauge = f"gauge from {low:.1f} to {high:.1f} mm, {mean:.1f} mm in the mean: this linear model does not use it"
        return own, gauge

    def fastest(self, v: float) -> float:
        """Return the frequency of a wave with four points [Hz], the shortest that straight lines can show."""
        return float(v / (4 * self.spacing))

    def duration(self, system: System) -> float:
        """Return how long both wheelsets are on the measured track [s]."""
        return float((self.distance[-1] - self.distance[0]) / system.v - system.lag)

    def inputs(self, system: System, clock: Clock) -> Float:
        """Return alignment and cross-level angle at the front and the rear wheelset, shape (steps + 1, 4)."""
        width = 1.0 if self.is_angle else 2 * system.p["b"]
        front = self.distance[0] + system.v * (clock.time + system.lag)
        columns = [
            np.interp(x, self.distance, values)
            for x in (front, front - system.v * system.lag)
            for values in (self.alignment, self.cross_level / width)
        ]
        return np.stack(columns, axis=1)


def read_track(path: str | PathLike[str]) -> MeasuredTrack:
    """Read a measured track.

    Parameters
    ----------
    path : path
        A file of numbers separated by commas with the head ``distance [m], alignment [mm], cross_level [mm], gauge
        [mm]`` in any length unit; ``cross_level`` is the difference of heights over the distance of the contact
        points 2 b, or an angle such as ``[mrad]``; it and ``gauge`` may be left out.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong: missing values, units, a distance that does not rise in
        equal steps of at most 1 m.
    """
    table = read_columns(path, MEASURED)
    if len(table.lines) < 3:
        raise ProblemError([Diagnostic(path=table.name, message="there are fewer than three points")])
    report([*_steps(table), *_sizes(table), *_gauge(table)])
    zero = np.zeros_like(table.values["distance"])
    return MeasuredTrack(
        name=table.name,
        distance=table.values["distance"],
        alignment=table.values["alignment"],
        cross_level=table.values.get("cross_level", zero),
        is_angle=not _is_length(table.units.get("cross_level", "m")),
        gauge=table.values.get("gauge"),
    )


def _is_length(unit: str) -> bool:
    return parse_unit(unit).dimension == parse_unit("m").dimension


def _steps(table: Table) -> list[Diagnostic]:
    x = table.values["distance"]
    steps = np.diff(x)
    usual = float(np.median(steps))
    if usual > LARGEST_STEP:
        message = f"the steps of {usual:g} m are too large: at most {LARGEST_STEP:g} m; is the unit right?"
        return [table.mistake(0, "distance", message)]
    found = []
    for k in np.flatnonzero(np.abs(steps - usual) > EVEN * abs(usual)):
        size = float(steps[k])
        what = "is not behind" if size <= 0 else f"is a gap of {size:g} m behind" if size > usual else "is too near to"
        message = f"{x[k + 1]:g} m {what} {x[k]:g} m: the distance must rise in equal steps, here of {usual:g} m"
        found.append(table.mistake(int(k) + 1, "distance", message))
    return found or ([] if usual > 0 else [table.mistake(0, "distance", "the distance must rise in equal steps")])


def _sizes(table: Table) -> list[Diagnostic]:
    found = []
    for name, largest in LARGEST.items():
        size = np.abs(table.values.get(name, np.zeros(1)))
        if size.max() > largest:
            row = int(size.argmax())
            unit = "m" if _is_length(table.units[name]) else "rad"
            message = f"{table.values[name][row]:g} {unit} is more than {largest:g} {unit}: is the unit right?"
            found.append(table.mistake(row, name, message))
    return found


def _gauge(table: Table) -> list[Diagnostic]:
    gauge = table.values.get("gauge", np.zeros(1))
    low, high = float(gauge.min()), float(gauge.max())
    if (GAUGES[0] <= low and high <= GAUGES[1]) or max(-low, high) <= DEVIATION:
        return []
    row = int(gauge.argmax() if high > DEVIATION else gauge.argmin())
    message = f"{gauge[row]:g} m is neither a gauge (0.5 to 2 m) nor the deviation of one (at most 60 mm)"
    return [table.mistake(row, "gauge", f"{message}: is the unit right?")]


# A density per rad/m over the wavenumber, or per cycle/m over the spatial frequency.
WAVENUMBER = {
    "wavenumber": Column(("rad/m",)),
    "alignment": Column(("m^2/(rad/m)",)),
    "cross_level": Column(("rad^2/(rad/m)",), required=False),
}
SPATIAL = {"spatial_frequency": Column(("1/m",))} | {x: c for x, c in WAVENUMBER.items() if x != "wavenumber"}


def read_spectrum(path: str | PathLike[str]) -> Spectrum:
    """Read a spectrum.

    Parameters
    ----------
    path : path
        A file of numbers separated by commas with the head ``wavenumber [rad/m], alignment [m^2/(rad/m)], cross_level
        [rad^2/(rad/m)]``, one-sided densities, or with ``spatial_frequency [1/m]`` (cycles per metre) and densities per
        cycle, ``alignment [m^2/(1/m)]``: the first column decides by what the density is divided.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong, such as a negative density.
    """
    per_cycle = is_spectrum(path) == "spatial_frequency"
    first = "spatial_frequency" if per_cycle else "wavenumber"
    table = read_columns(path, SPATIAL if per_cycle else WAVENUMBER)
    report(_densities(table, first))
    turn = 2 * np.pi if per_cycle else 1.0
    W = table.values[first] * turn
    densities = {x: Tabulated(W, S / turn) for x, S in table.values.items() if x != first}
    return Spectrum(table.name, densities)


def _densities(table: Table, first: str) -> list[Diagnostic]:
    if len(table.lines) < 2:
        return [Diagnostic(path=table.name, message="there are fewer than two points")]
    W = table.values[first]
    found = [
        table.mistake(int(k), first, f"{W[k]:g} must be more than 0 and more than the one before")
        for k in np.flatnonzero(np.diff(W, prepend=0.0) <= 0)
    ]
    for name in table.order:
        for k in np.flatnonzero(table.values[name] < 0) if name != first else ():
            found.append(table.mistake(int(k), name, f"the density {table.values[name][k]:g} is negative"))
    return found


def is_spectrum(path: str | PathLike[str]) -> str:
    """Return the name of the first column of a file if it is that of a spectrum, else an empty text."""
    try:
        lines = text_of(fspath(path)).splitlines()
    except ProblemError:
        return ""
    head = next((line for line in lines if line.strip() and line.lstrip()[0] != "#"), "")
    name = head.split("[")[0].strip()
    return name if name in ("wavenumber", "spatial_frequency") else ""

"""Measured tracks from files."""

from dataclasses import dataclass
from os import PathLike

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.arguments import checked
from yawdesign.problem.diagnostics import Diagnostic
from yawdesign.problem.quantities import to_unit
from yawdesign.problem.units import parse_unit
from yawdesign.response.track.lines import Clock, Wheelsets
from yawdesign.response.track.text_columns import Column, Table, read_columns
from yawdesign.response.track.text_sheets import Sheet, read_sheet, report

MEASURED = {
    "distance": Column(("m",), chainage=True),
    "alignment": Column(("mm",)),
    "cross_level": Column(("mm", "mrad"), required=False),
    "gauge": Column(("mm",), required=False),
}
LARGEST_STEP = 1.0  # [m]: a wavelength of 3 m, the shortest that track geometry cars look at, has three points then
SMALLEST_STEP = 0.01  # [m]: below it the unit is doubted
EVEN = 0.05  # part of a step by which a step may differ from the others
# Largest size of what can be right [m], [rad]; beyond it the unit is wrong. Below the smallest it is doubted.
LARGEST = {"alignment": 0.5, "cross_level": 0.5}
SMALLEST = 1e-4
GAUGES, DEVIATION = (0.5, 2.0), 0.06


@checked
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
    remarks : tuple of str
        How the file was read, and what is doubtful in it.
    """

    name: str
    distance: Float
    alignment: Float
    cross_level: Float
    is_angle: bool
    gauge: Float | None = None
    remarks: tuple[str, ...] = ()

    @property
    def spacing(self) -> float:
        """Distance of neighbouring points [m]."""
        return float((self.distance[-1] - self.distance[0]) / (len(self.distance) - 1))

    @property
    def notes(self) -> tuple[str, ...]:
        """Length and spacing, and what is not used."""
        own = f"{self.distance[-1] - self.distance[0]:.6g} m measured every {self.spacing:.4g} m"
        if self.gauge is None:
            return own, *self.remarks
        low, mean, high = (1e3 * float(f(self.gauge)) for f in (np.min, np.mean, np.max))
        gauge = f"gauge from {low:.1f} to {high:.1f} mm, {mean:.1f} mm in the mean: this linear model does not use it"
        return own, gauge, *self.remarks

    def fastest(self, v: float) -> float:
        """Return the frequency of a wave with four points [Hz], the shortest that straight lines can show."""
        return float(v / (4 * self.spacing))

    def duration(self, wheelsets: Wheelsets) -> float:
        """Return how long all wheelsets are on the measured track [s]."""
        return float((self.distance[-1] - self.distance[0]) / wheelsets.v - max(wheelsets.lags))

    def inputs(self, wheelsets: Wheelsets, clock: Clock) -> Float:
        """Return alignment [m] and cross-level angle [rad] at each wheelset, shape (steps + 1, inputs)."""
        width = 1.0 if self.is_angle else wheelsets.width
        first = self.distance[0] + wheelsets.v * (clock.time + max(wheelsets.lags))
        columns = [
            np.interp(first - wheelsets.v * lag, self.distance, values)
            for lag in wheelsets.lags
            for values in (self.alignment, self.cross_level / width)
        ]
        return np.stack(columns, axis=1)


def read_track(path: str | PathLike[str]) -> MeasuredTrack:
    """Read a measured track.

    Parameters
    ----------
    path : path
        A file of columns separated by commas, semicolons or tabs with the head ``distance [m], alignment [mm],
        cross_level [mm], gauge [mm]`` in any length unit; ``distance`` may be a chainage such as 12+345.6;
        ``cross_level`` is the difference of heights over the distance of the contact points 2 b, or an angle such as
        ``[mrad]``; it and ``gauge`` may be left out. Other columns are not used.

    Returns
    -------
    MeasuredTrack
        The track, in SI.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong: missing values, units, a distance that does not rise or
        fall in equal steps of at most 1 m.
    """
    return track_of(read_sheet(path))


def track_of(sheet: Sheet) -> MeasuredTrack:
    """Return the measured track of a file."""
    table = read_columns(sheet, MEASURED)
    x = table.values["distance"]
    if len(x) < 3:
        raise ProblemError([Diagnostic(path=table.name, message="there are fewer than three points")])
    falls = float(np.median(np.diff(x))) < 0
    report([*_steps(table, falls), *_sizes(table), *_gauge(table)])
    return MeasuredTrack(
        name=table.name,
        distance=x[0] - x if falls else x,
        alignment=table.values["alignment"],
        cross_level=table.values.get("cross_level", np.zeros_like(x)),
        is_angle=not _is_length(table.units.get("cross_level", "m")),
        gauge=table.values.get("gauge"),
        remarks=(*table.notes, *_direction(table, falls), *_doubts(table)),
    )


def _direction(table: Table, falls: bool) -> tuple[str, ...]:
    if not falls:
        return ()
    first = table.values["distance"][0]
    text = "the distance falls: the track is run over in the order of the rows, with their left and right, counted from"
    return (f"{text} {first:g} m",)


def _doubts(table: Table) -> list[str]:
    """Return what is so small that the head may name the wrong unit."""
    sizes = {name: np.abs(table.values.get(name, np.zeros(1))) for name in (*LARGEST, "gauge")}
    small = {f"the largest {name}": (name, float(sizes[name].max()), SMALLEST) for name in LARGEST}
    step = abs(float(np.median(np.diff(table.values["distance"]))))
    small["the step of the distance"] = "distance", step, SMALLEST_STEP
    if GAUGES[0] <= 1e3 * sizes["gauge"].min():
        small["the largest gauge"] = "gauge", float(sizes["gauge"].max()), 1e-3 * GAUGES[1]
    return [_doubt(table, what, name, size) for what, (name, size, least) in small.items() if 0 < size < least]


def _doubt(table: Table, what: str, name: str, size: float) -> str:
    unit = table.units[name]
    larger = {"mm": "m", "mrad": "rad", "m": "km" if name == "distance" else ""}.get(unit)
    right = f"if the values are in {larger}, write {name} [{larger}] in the head" if larger else "is the unit right?"
    return f"{what} is only {to_unit(size, unit):.3g} {unit}: {right}"


def _is_length(unit: str) -> bool:
    return parse_unit(unit).dimension == parse_unit("m").dimension


def _steps(table: Table, falls: bool) -> list[Diagnostic]:
    x = table.values["distance"]
    steps = -np.diff(x) if falls else np.diff(x)
    usual = float(np.median(steps))
    if usual > LARGEST_STEP:
        message = f"the steps of {usual:g} m are too large: at most {LARGEST_STEP:g} m; is the unit right?"
        return [table.mistake(0, "distance", message)]
    must = f"must {'fall' if falls else 'rise'} in equal steps"
    found = []
    for k in np.flatnonzero(np.abs(steps - usual) > EVEN * usual):
        size = float(steps[k])
        what = "is not behind" if size <= 0 else f"is a gap of {size:g} m behind" if size > usual else "is too near to"
        message = f"{x[k + 1]:.9g} m {what} {x[k]:.9g} m: the distance {must}, here of {usual:g} m"
        found.append(table.mistake(int(k) + 1, "distance", message))
    return found or ([] if usual > 0 else [table.mistake(0, "distance", f"the distance {must}")])


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

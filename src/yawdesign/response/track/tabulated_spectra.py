"""Spectra of track irregularity from files.

A spectrum has one variable, and its densities are per unit of this variable: per rad/m over the wavenumber, 2π over the
wavelength, or per cycle per metre over the spatial frequency, one over the wavelength. Both have the dimension 1/m, so
the radians in the units tell which is meant, and name and units must say the same.
"""

from collections.abc import Mapping
from os import PathLike
from types import MappingProxyType

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Diagnostic, nearest
from yawdesign.problem.units import Dimension, parse_unit
from yawdesign.response.track.spectra import Spectrum, Tabulated
from yawdesign.response.track.text_columns import Column, Table, read_columns
from yawdesign.response.track.text_sheets import Heading, Sheet, read_sheet, report

_VARIABLE = "is not clear: write wavenumber [rad/m], 2π over the wavelength, or spatial_frequency [1/m], 1 over it"


def _columns(variable: str, per: str) -> Mapping[str, Column]:
    other = "spatial_frequency [1/m]" if variable == "wavenumber" else "wavenumber [rad/m]"
    densities = {"alignment": f"m^2/({per})", "cross_level": f"rad^2/({per})"}
    wrong = "is not the density over {} [{}], which is [{}]; over {} it would be another"
    return {variable: Column((per,), counted=_VARIABLE)} | {
        name: Column((unit,), name == "alignment", wrong.format(variable, per, unit, other))
        for name, unit in densities.items()
    }


VARIABLES = MappingProxyType(
    {"wavenumber": _columns("wavenumber", "rad/m"), "spatial_frequency": _columns("spatial_frequency", "1/m")}
)
_OVER_TIME = (
    "a spectrum over time belongs to one speed v: write spatial_frequency [1/m], which is f/v of a frequency f in Hz, "
    "and alignment [m^2/(1/m)], which is v times the density in m^2/Hz"
)
_OVER_LENGTH = "write spatial_frequency [1/m], 1 over the wavelength, and alignment [m^2/(1/m)] in place of it"
# What else a spectrum may stand over, by the dimension.
_FOREIGN = {(0, 0, -1): _OVER_TIME, (0, 1, 0): _OVER_LENGTH}
USUAL = (5e-5, 0.5)  # [m], root mean square of an alignment
_DENSITIES = ((0, 3, 0), (0, 2, 1))  # over the way, over time


def read_spectrum(path: str | PathLike[str]) -> Spectrum:
    """Read a spectrum.

    Parameters
    ----------
    path : path
        A file of columns separated by commas, semicolons or tabs with the head ``wavenumber [rad/m], alignment
        [m^2/(rad/m)], cross_level [rad^2/(rad/m)]``, one-sided densities, or with ``spatial_frequency [1/m]`` (cycles
        per metre) and densities per cycle, ``alignment [m^2/(1/m)]``. Other columns are not used.

    Returns
    -------
    Spectrum
        The spectrum, to be given to a track.

    Raises
    ------
    ProblemError
        With file, line and column of everything that is wrong, such as a negative density, or densities that do not
        belong to the variable.
    """
    return spectrum_of(read_sheet(path))


def is_spectrum(sheet: Sheet) -> bool:
    """Return whether a file is meant as a spectrum: by a name, or by a unit that is a density's."""
    names = sheet.names()
    by_name = any(nearest(name, VARIABLES) for name in names)
    return "distance" not in names and (by_name or any(_dimension(head) in _DENSITIES for head in sheet.heads))


def _dimension(head: Heading) -> Dimension | None:
    try:
        return parse_unit(head.unit).dimension if head.unit else None
    except ProblemError:
        return None


def spectrum_of(sheet: Sheet) -> Spectrum:
    """Return the spectrum of a file."""
    variable = _variable(sheet)
    table = read_columns(sheet, VARIABLES[variable])
    report(_densities(table, variable))
    turn = 1.0 if variable == "wavenumber" else 2 * np.pi
    W = table.values[variable] * turn
    densities = {x: Tabulated(W, S / turn) for x, S in table.values.items() if x != variable}
    return Spectrum(table.name, densities, (*table.notes, *_doubts(W, table.values["alignment"] / turn)))


def _doubts(W: Float, S: Float) -> tuple[str, ...]:
    """Return a note if the alignment is too large or too small for a track."""
    with np.errstate(over="ignore"):
        rms = float(np.sqrt(np.sum((S[1:] + S[:-1]) / 2 * np.diff(W))))
    if USUAL[0] <= rms <= USUAL[1]:
        return ()
    return (f"the root mean square of the alignment is {rms:.3g} m: is the unit right?",)


def _variable(sheet: Sheet) -> str:
    heads = [head for head in sheet.heads if head.name in VARIABLES]
    report([sheet.mistake(head, f"a spectrum has one variable, here it is {heads[0].name}") for head in heads[1:]])
    if heads:
        return heads[0].name
    head = next((head for head in sheet.heads if nearest(head.name, VARIABLES)), sheet.heads[0])
    raise ProblemError([sheet.mistake(head, _FOREIGN.get(_dimension(head) or (0, 0, 0), _VARIABLE))])


def _densities(table: Table, variable: str) -> list[Diagnostic]:
    W = table.values[variable]
    if len(W) < 2:
        return [Diagnostic(path=table.name, message="there are fewer than two points")]
    found = [
        table.mistake(int(k), variable, f"{W[k]:g} must be more than 0 and more than the one before")
        for k in np.flatnonzero(np.diff(W, prepend=0.0) <= 0)
    ]
    for name, S in table.values.items():
        for k in np.flatnonzero(S < 0) if name != variable else ():
            found.append(table.mistake(int(k), name, f"the density {S[k]:g} is negative"))
    return found

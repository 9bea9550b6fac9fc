"""Values on a grid with their axes, units and origin: as a table, as arrays and as a labelled data set."""

import csv
import io
import json
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Array, Bools
from yawdesign.problem import ProblemError
from yawdesign.problem.result import Result, plain
from yawdesign.problem.whole_files import refuse_existing, whole_file, write_whole
from yawdesign.study.axes import ROWS, Axis, block
from yawdesign.study.request import UNITS
from yawdesign.study.store import MASKS, write_arrays

if TYPE_CHECKING:
    import xarray

_INSIDE = re.compile("[,;](?=[=+@-])")  # only in texts: JSON has a blank behind its own commas
LINES = 10_000  # of a table that are made at a time
MAIN = {"design": "C_s"}  # the column that `values` shows, where it is not named after the quantity


@dataclass(frozen=True, repr=False, eq=False)
class LabelledData(Result):
    """Values on a grid.

    Parameters
    ----------
    of, quantity : str
        What was asked for, and the same with ``margin`` resolved.
    unit : str
        Unit of the values, SI.
    axes : tuple of Axis
        Name, unit and values of each axis, in the order given.
    columns : mapping name -> ndarray
        All that was found, in SI; `to_dict` has the unit of each. The first dimensions are the axes; a further one
        counts several values at a point, in rising order and filled up with NaN.
    finished, recomputed, unverified : ndarray of bool
        Points that have an answer; that failed a check of the fast way and were computed the thorough way; where two
        independent ways differ, so that there is no number (NaN, or not stable).
    provenance : mapping
        Problem, versions, number of points and time.
    """

    of: str
    quantity: str
    unit: str
    axes: tuple[Axis, ...]
    columns: Mapping[str, NDArray[Any]]
    finished: Bools
    recomputed: Bools
    unverified: Bools
    provenance: Mapping[str, Any]

    @property
    def main(self) -> NDArray[Any]:
        """The column that `values` shows [`unit`]."""
        return self.columns[MAIN.get(self.quantity, self.quantity)]

    @property
    def known(self) -> Bools:
        """Points that have an answer which was verified."""
        return self.finished & ~self.unverified

    def to_csv(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write a table with one line for each point; lines with # before it tell where it comes from.

        Parameters
        ----------
        path : path
            Name of the file; it is there as a whole or not at all.
        replace : bool
            Whether a file that is there is replaced.

        Raises
        ------
        ProblemError
            If there is a file that may not be replaced.
        OSError
            If it cannot be written.
        """
        with whole_file(Path(path), replace=replace) as file:
            text = io.TextIOWrapper(file, encoding="utf-8", newline="")
            # No cell of a spreadsheet begins with a formula that stands inside a title or a name.
            origin = _INSIDE.sub(lambda sign: f"\\u{ord(sign[0]):04x}", self._origin())
            text.write(f"# sweep of {self.of}\n# {origin}\n")
            csv.writer(text).writerows(self._lines())
            text.detach()

    def to_npz(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write arrays that `numpy.load` reads: ``values`` and all columns, ``axis_NAME``, masks, units, provenance.

        Parameters, errors: as in `to_csv`.
        """
        axes = {f"axis_{axis.name}": axis.values for axis in self.axes}
        units = {axis.name: axis.unit for axis in self.axes} | {name: UNITS[name] for name in self.columns}
        texts: dict[str, Any] = {"of": self.of, "axes": [axis.name for axis in self.axes], "units": json.dumps(units)}
        texts["provenance"] = self._origin()
        arrays = {"values": self.main, **self.columns, **axes, **self._masks(), **texts}
        write_arrays(Path(path), arrays, replace=replace)

    def to_xarray(self) -> "xarray.Dataset":
        """Return an `xarray.Dataset` with coordinates, units and provenance; it can be written as netCDF."""
        with _extra_needed():
            import xarray
        names = [axis.name for axis in self.axes]
        coordinates = {
            axis.name: (axis.name, axis.values, {"units": axis.unit, "long_name": ROWS[axis.name].meaning})
            for axis in self.axes
        }
        data = {name: (_dimensions(names, name, x), x, {"units": UNITS[name]}) for name, x in self.columns.items()}
        data |= {name: (names, mask, {}) for name, mask in self._masks().items()}
        return xarray.Dataset(data, coordinates, {"of": self.of, "provenance": self._origin()})

    def to_netcdf(self, path: str | PathLike[str], *, replace: bool = False) -> None:
        """Write what `to_xarray` returns as a netCDF file.

        Parameters, errors: as in `to_csv`.
        """
        refuse_existing(Path(path), replace)
        data = self.to_xarray()
        with TemporaryDirectory() as folder, _extra_needed():
            import h5netcdf

            file = Path(folder, "sweep.nc")
            data.to_netcdf(file, engine=h5netcdf.__name__)
            write_whole(Path(path), file.read_bytes(), replace=replace)

    def _tables(self) -> dict[str, Mapping[str, Any]]:
        points = block(self.axes, 0, self.finished.size)
        columns = {name: column.tolist() for name, column in self._single_columns(lambda name, _: name)}
        return {"points": {**points, **columns, "checked": self.known.ravel()}}

    def _units(self) -> Mapping[str, str]:
        units = {axis.name: axis.unit for axis in self.axes}
        for name, column in self.columns.items():
            several = range(column.shape[-1] + 1) if column.ndim > self.finished.ndim else ()
            units |= dict.fromkeys((name, *(f"{name}_{k}" for k in several)), UNITS[name])
        return units

    def _origin(self) -> str:
        """Return where it comes from, as JSON."""
        return json.dumps(plain(self.provenance))

    def _masks(self) -> dict[str, Bools]:
        return {name: getattr(self, name) for name in MASKS}

    def _lines(self) -> Iterator[list[Any]]:
        """Yield the lines of the table, its head first."""
        columns = dict(self._single_columns(_title))
        titles = [_title(axis.name, axis.unit) for axis in self.axes]
        yield [*titles, *columns, "checked"]
        for start in range(0, self.finished.size, LINES):
            stop = min(start + LINES, self.finished.size)
            cells = [x.tolist() for x in block(self.axes, start, stop).values()]
            cells += [_cells(x[start:stop]) for x in columns.values()]
            yield from map(list, zip(*cells, self.known.ravel()[start:stop].astype(int).tolist(), strict=True))

    def _single_columns(self, title: Callable[[str, str], str]) -> Iterator[tuple[str, Array]]:
        """Yield all columns as those of a table, with what `title` makes of name and unit."""
        for name, column in self.columns.items():
            if column.ndim == self.finished.ndim:
                yield title(name, UNITS[name]), column.ravel()
            else:
                # The number of unstable roots stands below the first critical value, between it and the second, ...
                first = 0 if name == "unstable_roots" else 1
                for k in range(column.shape[-1]):
                    yield title(f"{name}_{k + first}", UNITS[name]), column[..., k].ravel()


def _title(name: str, unit: str) -> str:
    """Return the head of a column, in letters that every spreadsheet can read."""
    return name if unit == "-" else f"{name} [{unit.replace('·', ' ').replace('²', '2')}]"


def _cells(column: Array) -> list[Any]:
    values = (column.astype(int) if column.dtype.kind == "b" else column).tolist()
    return ["" if x != x else x for x in values]


def _dimensions(names: list[str], name: str, column: Array) -> list[str]:
    several = ["interval" if name == "unstable_roots" else "branch"]
    return names + several * (np.ndim(column) - len(names))


@contextmanager
def _extra_needed() -> Iterator[None]:
    try:
        yield
    except ImportError as error:
        raise ProblemError(f"{error.name} is not installed: pip install 'yawdesign[xarray]'") from None

"""A sweep as a table, as arrays and as a labelled data set."""

import csv
import io
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Array
from yawdesign.problem import ProblemError
from yawdesign.problem.result import plain
from yawdesign.problem.whole_files import refuse_existing, whole_file, write_whole
from yawdesign.study.axes import ROWS, block
from yawdesign.study.request import UNITS
from yawdesign.study.result import Sweep
from yawdesign.study.store import MASKS, write_arrays

if TYPE_CHECKING:
    import xarray

LINES = 10_000  # of a table that are made at a time


def origin(sweep: Sweep) -> str:
    """Return where a sweep comes from, as JSON."""
    return json.dumps(plain(sweep.provenance))


def write_npz(sweep: Sweep, path: Path, *, replace: bool) -> None:
    """Write a sweep as arrays."""
    axes = {f"axis_{axis.name}": axis.values for axis in sweep.axes}
    units = {axis.name: axis.unit for axis in sweep.axes} | {name: UNITS[name] for name in sweep.columns}
    texts: dict[str, Any] = {"of": sweep.of, "axes": [axis.name for axis in sweep.axes], "units": json.dumps(units)}
    masks = {name: getattr(sweep, name) for name in MASKS}
    texts["provenance"] = origin(sweep)
    write_arrays(path, {"values": sweep.main, **sweep.columns, **axes, **masks, **texts}, replace=replace)


def write_csv(sweep: Sweep, path: Path, *, replace: bool) -> None:
    """Write a sweep as a table."""
    with whole_file(path, replace=replace) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        text.write(f"# sweep of {sweep.of}\n# {origin(sweep)}\n")
        csv.writer(text).writerows(_rows(sweep))
        text.detach()


def _rows(sweep: Sweep) -> Iterator[list[Any]]:
    columns = dict(_single_columns(sweep))
    titles = [_title(axis.name, axis.unit) for axis in sweep.axes]
    yield [*titles, *columns, "checked"]
    for start in range(0, sweep.finished.size, LINES):
        stop = min(start + LINES, sweep.finished.size)
        cells = [x.tolist() for x in block(sweep.axes, start, stop).values()]
        cells += [_cells(x[start:stop]) for x in columns.values()]
        yield from map(list, zip(*cells, sweep.known.ravel()[start:stop].astype(int).tolist(), strict=True))


def _single_columns(sweep: Sweep) -> Iterator[tuple[str, Array]]:
    for name, column in sweep.columns.items():
        if column.ndim == sweep.finished.ndim:
            yield _title(name, UNITS[name]), column.ravel()
        else:
            first = (
                0 if name == "unstable_roots" else 1
            )  # below the first critical value, between it and the second ...
            for k in range(column.shape[-1]):
                yield _title(f"{name}_{k + first}", UNITS[name]), column[..., k].ravel()


def _title(name: str, unit: str) -> str:
    """Return the head of a column, in letters that every spreadsheet can read."""
    return name if unit == "-" else f"{name} [{unit.replace('·', ' ').replace('²', '2')}]"


def _cells(column: Array) -> list[Any]:
    values = (column.astype(int) if column.dtype.kind == "b" else column).tolist()
    return ["" if x != x else x for x in values]


def write_netcdf(sweep: Sweep, path: Path, *, replace: bool) -> None:
    """Write a sweep as a netCDF file."""
    refuse_existing(path, replace)
    data = dataset(sweep)
    with TemporaryDirectory() as folder, _extra_needed():
        import h5netcdf

        file = Path(folder, "sweep.nc")
        data.to_netcdf(file, engine=h5netcdf.__name__)
        write_whole(path, file.read_bytes(), replace=replace)


@contextmanager
def _extra_needed() -> Iterator[None]:
    try:
        yield
    except ImportError as error:
        raise ProblemError(f"{error.name} is not installed: pip install 'yawdesign[xarray]'") from None


def dataset(sweep: Sweep) -> "xarray.Dataset":
    """Return a sweep as an `xarray.Dataset`."""
    with _extra_needed():
        import xarray
    names = [axis.name for axis in sweep.axes]
    coordinates = {
        axis.name: (axis.name, axis.values, {"units": axis.unit, "long_name": ROWS[axis.name].meaning})
        for axis in sweep.axes
    }
    data = {name: (_dimensions(names, name, x), x, {"units": UNITS[name]}) for name, x in sweep.columns.items()}
    data |= {name: (names, getattr(sweep, name), {}) for name in MASKS}
    return xarray.Dataset(data, coordinates, {"of": sweep.of, "provenance": origin(sweep)})


def _dimensions(names: list[str], name: str, column: Array) -> list[str]:
    several = ["interval" if name == "unstable_roots" else "branch"]
    return names + several * (np.ndim(column) - len(names))

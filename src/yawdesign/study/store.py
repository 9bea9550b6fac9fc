"""Where the answers of a sweep are gathered, block by block."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yawdesign.hunting.arrays import Array
from yawdesign.problem.stopping import held
from yawdesign.problem.whole_files import whole_file
from yawdesign.study.answers import Answers

MASKS = ("finished", "recomputed", "unverified")


def write_arrays(path: Path, arrays: Mapping[str, Any], *, replace: bool = False) -> None:
    """Write arrays that `numpy.load` reads; arguments and errors as in `whole_file`.

    Requests to stop wait: in the middle of an archive they would end as errors of the archive.
    """
    with held(), whole_file(path, replace=replace) as file:
        np.savez_compressed(file, **arrays)


class Store:
    """Answers of a sweep in the order of its points, as far as there are any.

    Parameters
    ----------
    size : int
        Number of points of the grid.
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.finished = np.zeros(size, dtype=bool)
        self.recomputed = np.zeros(size, dtype=bool)
        self.unverified = np.zeros(size, dtype=bool)
        self.columns: dict[str, Array] = {}

    def put(self, start: int, answers: Answers) -> None:
        """Keep the answers of the points from `start` on; an unverified point keeps no number."""
        stop = start + answers.unverified.size
        for name, found in answers.columns.items():
            shown = _blanked(np.asarray(found), answers.unverified)
            self.columns[name] = column = _widened(self.columns.get(name), shown, self.size)
            column[(slice(start, stop), *map(slice, shown.shape[1:]))] = shown
        self.recomputed[start:stop] = answers.recomputed
        self.unverified[start:stop] = answers.unverified
        self.finished[start:stop] = True

    def add(self, other: "Store") -> None:
        """Take over what another store of the same sweep has, and this one has not."""
        for start, stop in _runs(other.finished & ~self.finished):
            part = slice(start, stop)
            columns = {name: x[part] for name, x in other.columns.items()}
            self.put(start, Answers(columns, other.recomputed[part], other.unverified[part]))

    def missing(self, chunk: int) -> Iterator[tuple[int, int]]:
        """Yield start and stop of the blocks that have no answers yet, at most `chunk` points each."""
        for first, last in _runs(~self.finished):
            yield from ((start, min(start + chunk, last)) for start in range(first, last, chunk))


def _runs(mask: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Yield start and stop of the parts in which a mask is true."""
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False))
    return ((int(first), int(last)) for first, last in edges.reshape(-1, 2))


def _empty(kind: np.dtype[Any]) -> Any:
    """Return what stands where there is no answer."""
    return {"f": np.nan, "U": "", "b": False}.get(kind.kind, 0)


def _blanked(found: Array, unverified: Array) -> Array:
    if not unverified.any():
        return found
    if found.dtype.kind == "U":
        return np.where(unverified, "unverified", found)
    found = found.copy()
    found[unverified] = _empty(found.dtype)
    return found


def _widened(column: Array | None, found: Array, size: int) -> Array:
    """Return a column that has room for what was found: its kind, length of texts and number of values."""
    kind = found.dtype if column is None else np.promote_types(column.dtype, found.dtype)
    width = tuple(max(1, n) for n in found.shape[1:])
    if column is not None:
        width = tuple(map(max, column.shape[1:], width))
        if kind == column.dtype and width == column.shape[1:]:
            return column
    wider = np.full((size, *width), _empty(kind), dtype=kind)
    if column is not None:
        wider[(slice(None), *map(slice, column.shape[1:]))] = column
    return wider

"""Where the answers of a sweep are gathered, block by block, and kept in a file until all are there."""

import json
import zipfile
from collections.abc import Iterator
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from yawdesign import __version__
from yawdesign.problem import ProblemError
from yawdesign.problem.result import plain
from yawdesign.problem.writing import whole_file
from yawdesign.study.question import Answers, Array
from yawdesign.study.request import Request

MASKS = ("finished", "recomputed", "unverified")


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

    def missing(self, chunk: int) -> Iterator[tuple[int, int]]:
        """Yield start and stop of the blocks that have no answers yet, at most `chunk` points each."""
        edges = np.flatnonzero(np.diff(self.finished, prepend=True, append=True))
        for first, last in edges.reshape(-1, 2):
            yield from ((start, min(start + chunk, int(last))) for start in range(int(first), int(last), chunk))


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


def identity(asked: Request) -> dict[str, Any]:
    """Return what makes a sweep the same as another: two with the same identity have the same answers."""
    problem = asked.problem.to_dict()
    own = {f"the problem's {key}": problem[key] for key in problem if key != "title"}
    axes = {f"axis {axis.name}": _digest(axis.values.tolist()) for axis in asked.axes}
    question = _digest(plain(asdict(asked.task.question)))
    order = [axis.name for axis in asked.axes]
    mine = {"of": asked.of, "the axes": order, **axes, "hold": asked.task.hold, "the question": question}
    return {**mine, **own, "the version of yawdesign": __version__}


def _digest(data: Any) -> str:
    return sha256(json.dumps(data).encode()).hexdigest()


def save(path: Path, asked: Request, store: Store) -> None:
    """Write what is finished into a file that `restore` reads."""
    masks = {name: getattr(store, name) for name in MASKS}
    columns = {f"column_{name}": column for name, column in store.columns.items()}
    arrays: dict[str, Any] = {**masks, **columns, "identity": np.array(json.dumps(identity(asked)))}
    with whole_file(path) as file:
        np.savez_compressed(file, **arrays)


def restore(path: Path, asked: Request) -> Store:
    """Return the store that a file holds, an empty one if there is no file.

    Raises
    ------
    ProblemError
        If the file is no such file, or belongs to another sweep.
    """
    store = Store(asked.size)
    if not path.exists():
        return store
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        found = json.loads(str(arrays["identity"]))
    except (ValueError, KeyError, EOFError, AttributeError, TypeError, zipfile.BadZipFile):
        text = f"{path} is no unfinished sweep: give another name, or remove it to begin anew"
        raise ProblemError(text) from None
    _compare(path, found, identity(asked))
    for name in MASKS:
        setattr(store, name, arrays[name])
    store.columns = {name.removeprefix("column_"): x for name, x in arrays.items() if name.startswith("column_")}
    return store


def _compare(path: Path, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    different = [key for key in wanted if found.get(key) != wanted[key]]
    different += [key for key in found if key not in wanted]
    if different:
        raise ProblemError(
            f"{path} belongs to another sweep: {', '.join(different)} {'differ' if len(different) > 1 else 'differs'}; "
            "give another name, or remove it to begin anew"
        )

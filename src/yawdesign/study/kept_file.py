"""The file that keeps what is finished of a sweep: checked before it is believed, and shared by runs of one sweep."""

import json
import os
import zipfile
from dataclasses import asdict
from hashlib import sha256
from math import prod
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import format as npy

from yawdesign import __version__
from yawdesign.hunting.arrays import Array
from yawdesign.problem import ProblemError
from yawdesign.problem.result import plain
from yawdesign.problem.stopping import held
from yawdesign.problem.whole_files import whole_file
from yawdesign.study.request import UNITS, Request, memory
from yawdesign.study.store import MASKS, Store

DIGEST = 64  # characters of a SHA-256 of all before it, which end the file as the comment of the archive
TEXTS = ("status",)  # columns that hold texts
SEVERAL = ("critical", "critical_speed", "omega", "unstable_roots")  # columns with several values at a point
REMEDY = "give another name, or remove it to begin anew"


class KeptFile:
    """A file that keeps what is finished of a sweep.

    Parameters
    ----------
    path : Path
        Its name; it need not be there.
    asked : Request
        The sweep it belongs to.
    """

    def __init__(self, path: Path, asked: Request) -> None:
        self.path, self.asked = path, asked
        self._seen: tuple[int, ...] | None = None  # the file as it was when it was read or written
        self._held = np.zeros(asked.size, dtype=bool)  # the points it then had

    def read(self, store: Store) -> None:
        """Add what the file has, and the store has not.

        Raises
        ------
        ProblemError
            If it is no such file, is damaged or belongs to another sweep.
        OSError
            If it cannot be read.
        """
        seen = _stamp(self.path)
        if seen is not None and seen != self._seen:
            found = restore(self.path, self.asked)
            store.add(found)
            self._held = found.finished
        self._seen = seen

    def write(self, store: Store) -> None:
        """Write what is finished, after reading what another run of the sweep has added; requests to stop wait.

        Raises
        ------
        ProblemError, OSError
            As in `read`; or if it cannot be written.
        """
        with held():
            self.read(store)
            if (store.finished & (~self._held | (self._seen is None))).any():
                _write(self.path, self.asked, store, replace=self._seen is not None)
                self._seen, self._held = _stamp(self.path), store.finished.copy()


def _stamp(path: Path) -> tuple[int, ...] | None:
    if not os.path.lexists(path):
        return None
    about = path.stat()
    return about.st_ino, about.st_size, about.st_mtime_ns


def identity(asked: Request) -> dict[str, Any]:
    """Return what makes a sweep the same as another: two with the same identity have the same answers."""
    problem = asked.problem.to_dict()
    own = {f"the problem's {key}": problem[key] for key in problem if key != "title"}
    axes = {f"axis {axis.name}": _digest_of_data(axis.values.tolist()) for axis in asked.axes}
    question = _digest_of_data(plain(asdict(asked.task.question)))
    order = [axis.name for axis in asked.axes]
    mine = {"of": asked.of, "the axes": order, **axes, "hold": asked.task.hold, "the question": question}
    return {**mine, **own, "the version of yawdesign": __version__}


def _digest_of_data(data: Any) -> str:
    return sha256(json.dumps(data, default=sorted).encode()).hexdigest()  # a set has no order of its own


def _write(path: Path, asked: Request, store: Store, *, replace: bool) -> None:
    masks = {name: getattr(store, name) for name in MASKS}
    columns = {f"column_{name}": column for name, column in store.columns.items()}
    arrays: dict[str, Any] = {**masks, **columns, "identity": np.array(json.dumps(identity(asked)))}
    with whole_file(path, replace=replace) as file:
        np.savez_compressed(file, **arrays)
        with zipfile.ZipFile(file, "a") as archive:
            archive.comment = b"0" * DIGEST
        digest = _digest_of_file(file)
        file.seek(-DIGEST, os.SEEK_END)
        file.write(digest)


def _digest_of_file(file: BinaryIO) -> bytes:
    left, digest = file.seek(-DIGEST, os.SEEK_END), sha256()
    file.seek(0)
    while left and (piece := file.read(min(left, 2**20))):
        digest.update(piece)
        left -= len(piece)
    return digest.hexdigest().encode()


def restore(path: Path, asked: Request) -> Store:
    """Return the store that a file holds.

    Raises
    ------
    ProblemError
        If the file is no such file, is damaged or belongs to another sweep.
    OSError
        If it cannot be read.
    """
    if not path.is_file():
        raise ProblemError(f"{path} is no file: {REMEDY}")
    with path.open("rb") as file:
        try:
            arrays = _arrays(file)
            found = dict(json.loads(str(arrays.pop("identity"))))
        except Exception:  # noqa: BLE001 - whatever a foreign or damaged archive makes its readers raise
            raise ProblemError(f"{path} is no unfinished sweep, or a damaged one: {REMEDY}") from None
    _compare(path, found, identity(asked))
    try:
        return _store(arrays, asked.size)
    except (ValueError, KeyError) as error:
        raise ProblemError(f"{path} is a damaged unfinished sweep ({error}): {REMEDY}") from None


def _arrays(file: BinaryIO) -> dict[str, Array]:
    """Return the arrays of a file; none is read before the digest of the file is right."""
    digest = _digest_of_file(file)
    if file.read() != digest:
        raise ValueError("the digest differs")
    with zipfile.ZipFile(file) as archive:
        if sum(info.file_size for info in archive.infolist()) > memory():
            raise ValueError("too large")
        return {info.filename.removesuffix(".npy"): _array(archive, info) for info in archive.infolist()}


def _array(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> Array:
    """Return an array; only as much memory is taken as there is data, whatever its head promises."""
    with archive.open(info) as member:
        if npy.read_magic(member) != (1, 0):
            raise ValueError("an unknown form of arrays")
        shape, by_columns, kind = npy.read_array_header_1_0(member)
        flat: Array = np.frombuffer(member.read(), kind)
    if flat.size != prod(shape):
        raise ValueError("more or less data than the head promises")
    return flat.reshape(shape, order="F" if by_columns else "C").copy()


def _compare(path: Path, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    different = [key for key in wanted if found.get(key) != wanted[key]]
    different += [key for key in found if key not in wanted]
    if different:
        raise ProblemError(
            f"{path} belongs to another sweep: {', '.join(different)} {'differ' if len(different) > 1 else 'differs'}; "
            f"{REMEDY}"
        )


def _store(arrays: dict[str, Array], size: int) -> Store:
    """Return a store of arrays that have the right names, kinds and shapes.

    Raises
    ------
    ValueError, KeyError
        If they have not.
    """
    store = Store(size)
    for name in MASKS:
        mask = arrays.pop(name)
        if mask.dtype != bool or mask.shape != (size,):
            raise ValueError(f"{name} is no mask of {size} points")
        setattr(store, name, mask)
    if ((store.recomputed | store.unverified) & ~store.finished).any():
        raise ValueError("points that are not finished are marked")
    store.columns = {name.removeprefix("column_"): _column(name, x, size) for name, x in arrays.items()}
    if store.finished.any() and not store.columns:
        raise ValueError("there are no columns")
    return store


def _column(name: str, column: Array, size: int) -> Array:
    name = name.removeprefix("column_")
    if name not in UNITS:
        raise ValueError(f"{name} is no column of a sweep")
    if column.dtype.kind not in ("U" if name in TEXTS else "fib"):
        raise ValueError(f"{name} has the kind {column.dtype}")
    if column.shape[:1] != (size,) or column.ndim != (2 if name in SEVERAL else 1) or not column.size:
        raise ValueError(f"{name} has the shape {column.shape}")
    return column

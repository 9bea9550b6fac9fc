"""Files that are there as a whole or not at all, and never in the place of another one unasked."""

import errno
import io
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from .diagnostics import ProblemError
from .stopping import held, let_through

CANNOT_SYNCHRONISE = (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP)  # of some file systems


def write_whole(path: Path, content: bytes, *, replace: bool = False) -> None:
    """Write a file; arguments and errors as in `whole_file`."""
    with whole_file(path, replace=replace) as file:
        file.write(content)


@contextmanager
def whole_file(path: Path, *, replace: bool = False) -> Iterator[BinaryIO]:
    """Give a file to write; it takes its place when it is whole and on the disk, and a crash leaves the old one.

    It stands beside its place until then, under a name of its own. A file that is replaced keeps its mode. A device or
    a pipe is written to, not replaced.

    Parameters
    ----------
    path : Path
        The file.
    replace : bool
        Whether it may take the place of another one.

    Raises
    ------
    ProblemError
        If there is a file, and it may not be replaced.
    OSError
        If it cannot be written, with the name of the file that was meant.
    """
    refuse_existing(path, replace)
    try:
        with _written_to(path) if is_stream(path) else _beside(path, replace) as file:
            yield file
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def refuse_existing(path: Path, replace: bool) -> None:
    """Raise a ProblemError if there is a file that may not be replaced."""
    if not replace and os.path.lexists(path) and not is_stream(path):
        raise ProblemError(f"{path} exists: choose another name, or give --force (replace=True in Python)")


def is_stream(path: Path) -> bool:
    """Return whether there is something that is neither a file nor a folder: a device or a pipe."""
    return path.exists() and not path.is_file() and not path.is_dir()


def place_of(path: Path) -> Path:
    """Return where a file of this name stands, behind all links.

    Raises
    ------
    ProblemError
        If a link leads to itself.
    """
    place = Path(os.path.realpath(path))
    if place.is_symlink():
        raise ProblemError(f"{path} is a link that leads to itself")
    return place


@contextmanager
def _written_to(path: Path) -> Iterator[BinaryIO]:
    content = io.BytesIO()  # an archive cannot be written to what has no places
    yield content
    left = content.getbuffer()
    with let_through(), path.open("wb", buffering=0) as stream:
        while left:
            left = left[stream.write(left) :]


@contextmanager
def _beside(path: Path, replace: bool) -> Iterator[BinaryIO]:
    place = place_of(path) if replace else path
    beside = place.with_name(f".{place.name[:40]}.{secrets.token_hex(4)}.part")
    mode = place.stat().st_mode & 0o777 if place.exists() else None
    with held() as as_outside:
        try:
            beside.touch(0o666 if mode is None else 0o600, exist_ok=False)
            with beside.open("r+b") as file:
                with as_outside():
                    yield file
                file.flush()
                _synchronise(file.fileno())
            if mode is not None:
                beside.chmod(mode)
            _put(beside, place, replace)
            _synchronise_folder(place.parent)
        finally:
            beside.unlink(missing_ok=True)


def _put(beside: Path, place: Path, replace: bool) -> None:
    """Give a file its name, unless another one has it that may not be replaced: renaming would do so without a word."""
    if replace:
        beside.replace(place)
        return
    try:
        place.hardlink_to(beside)
    except FileExistsError:
        raise
    except OSError:  # a file system without links
        if os.path.lexists(place):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST)) from None
        beside.rename(place)


def _synchronise(number: int) -> None:
    try:
        os.fsync(number)
    except OSError as error:
        if error.errno not in CANNOT_SYNCHRONISE:
            raise


def _synchronise_folder(folder: Path) -> None:
    """Have the names in a folder on the disk, where the system knows such a thing."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)

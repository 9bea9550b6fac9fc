"""Files that are there as a whole or not at all."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO


def write_whole(path: Path, content: bytes) -> None:
    """Write a file that takes the place of `path` when it is whole; errors as in `whole_file`."""
    with whole_file(path) as file:
        file.write(content)


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Give a file to write; it takes the place of `path` when it is whole, and a crash leaves the old one.

    Raises
    ------
    OSError
        With the name of the file that was meant.
    """
    try:
        if path.exists() and not path.is_file():  # a device or a pipe is written to, not replaced
            content = io.BytesIO()  # an archive cannot be written to what has no places
            yield content
            with path.open("wb") as file:
                file.write(content.getvalue())
        else:
            with _beside(path.resolve()) as file:
                yield file
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextmanager
def _beside(path: Path) -> Iterator[BinaryIO]:
    beside = path.with_name(path.name + ".part")
    try:
        with beside.open("wb") as file:
            yield file
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)

"""A folder of exported files: written beside its place and moved there, foreign files untouched."""

import errno
import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from yawdesign.problem import ProblemError

MANIFEST = "manifest.json"
GENERATOR = "yawdesign export"


@contextmanager
def exported_folder(to: Path, *, force: bool) -> Iterator[Path]:
    """Give an empty folder to write into; at the end its files move to their place, the manifest last.

    After an error nothing is moved, and what was written is removed.

    Parameters
    ----------
    to : Path
        The place; a folder that is there must be empty, or `force` be given.
    force : bool
        Replace the files of an earlier export. Other files stay, and none of them is ever replaced.

    Raises
    ------
    ProblemError
        If the place is taken.
    OSError
        If it cannot be written.
    """
    check_place(to, force=force)
    try:
        beside = Path(tempfile.mkdtemp(prefix=f".{to.name}.", dir=to if to.exists() else to.parent))
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(to)) from None
    try:
        yield beside
        _move(beside, to)
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def check_place(to: Path, *, force: bool) -> None:
    """Raise an error if an export cannot go to a place; arguments as in `exported_folder`."""
    if not to.absolute().parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(to))
    if to.exists() and not to.is_dir():
        raise ProblemError(f"{to} is a file: give the name of a folder")
    if to.exists() and not force and any(to.iterdir()):
        raise ProblemError(f"{to} is not empty: choose another folder, or give --force to replace an earlier export")


def _move(beside: Path, to: Path) -> None:
    files = sorted((p for p in beside.rglob("*") if p.is_file()), key=lambda p: p.name == MANIFEST)
    names = [path.relative_to(beside) for path in files]
    own = _own_files(to)
    foreign = [str(name) for name in names if (to / name).exists() and name.as_posix() not in own]
    if foreign:
        raise ProblemError(f"{to} has files that no export wrote: {', '.join(foreign)}; move them away")
    try:
        to.mkdir(exist_ok=True)
        for name in names:
            (to / name).parent.mkdir(exist_ok=True)
            (beside / name).replace(to / name)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(to)) from None


def _own_files(to: Path) -> set[str]:
    """Return the files that an earlier export wrote here, by its manifest."""
    try:
        manifest = json.loads((to / MANIFEST).read_text(encoding="utf-8"))
        return {MANIFEST, *manifest["files"]} if manifest["generator"] == GENERATOR else set()
    except (OSError, ValueError, KeyError, TypeError):
        return set()


def write_text(path: Path, text: str) -> str:
    """Write a text with Unix line ends and return the file's name."""
    path.write_text(text, encoding="utf-8", newline="\n")
    return path.name

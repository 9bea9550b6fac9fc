"""A folder of exported files: written beside their place and moved there, foreign files untouched."""

import json
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from yawdesign.problem import ProblemError
from yawdesign.problem.stopping import held
from yawdesign.problem.whole_files import write_whole

MANIFEST = "manifest.json"
GENERATOR = "yawdesign export"
UNFINISHED = "unfinished"  # a key of the manifest while files are moved
PREFIX, SUFFIX = ".yawdesign-", ".part"  # of the folder beside, which a killed export leaves
OLD = 3600.0  # seconds after which no export is still at work


@contextmanager
def exported_folder(to: Path, *, force: bool, generator: str = GENERATOR) -> Iterator[Path]:
    """Give an empty folder to write into; at the end its files move to their place, the manifest last.

    After an error nothing is moved, and what was written is removed. After a kill the folder counts as empty, unless
    it was not; one killed while files were moved has a manifest that says so.

    Parameters
    ----------
    to : Path
        The place; a folder that is there must be empty, or `force` be given.
    force : bool
        Replace the files of an earlier export. Other files stay, and none of them is ever replaced.
    generator : str
        The command that writes, as its manifest names it.

    Raises
    ------
    ProblemError
        If the place is taken.
    OSError
        If it cannot be written.
    """
    check_place(to, force=force, generator=generator)
    new = not to.exists()
    try:
        to.mkdir(exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix=PREFIX, suffix=SUFFIX, dir=to))
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(to)) from None
    try:
        yield beside
        _move(beside, to, generator)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
        if new:
            with suppress(OSError):
                to.rmdir()  # which it is only if it is empty


def check_place(to: Path, *, force: bool, generator: str = GENERATOR) -> None:
    """Raise an error if an export cannot go to a place; arguments as in `exported_folder`."""
    if not to.absolute().parent.is_dir():
        raise ProblemError(f"{to}: there is no folder {to.parent}")
    if to.is_symlink() and not to.exists():
        raise ProblemError(f"{to} is a link to what is not there: give the name of a folder")
    if to.exists() and not to.is_dir():
        raise ProblemError(f"{to} is a file: give the name of a folder")
    if to.exists() and not force and _contents(to, generator):
        earlier = f"to replace what an earlier `{generator}` wrote"
        raise ProblemError(f"{to} is not empty: choose another folder, or give --force {earlier}")


def _contents(to: Path, generator: str) -> set[str]:
    """Return what is in a folder, but for what a killed export has left; of that, what is old is removed."""
    left = set(to.glob(f"{PREFIX}*{SUFFIX}"))
    for path in left:
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > OLD:
                shutil.rmtree(path)
    manifest = _manifest(to, generator)
    return {path.name for path in to.iterdir() if path not in left} - _own(manifest if UNFINISHED in manifest else {})


def _move(beside: Path, to: Path, generator: str) -> None:
    files = sorted((p for p in beside.rglob("*") if p.is_file()), key=lambda p: p.name == MANIFEST)
    names = [path.relative_to(beside) for path in files]
    own = _own(_manifest(to, generator))
    foreign = [str(name) for name in names if (to / name).exists() and name.as_posix() not in own]
    if foreign:
        raise ProblemError(f"{to} has files that no `{generator}` wrote: {', '.join(foreign)}; move them away")
    try:
        with held():  # a request to stop waits: neither the earlier export nor this one would be whole
            _announce(to, own | {name.as_posix() for name in names}, generator)
            for name in names:
                (to / name).parent.mkdir(exist_ok=True)
                (beside / name).replace(to / name)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(to)) from None


def _announce(to: Path, names: set[str], generator: str) -> None:
    """Say in the manifest which files are being moved, so that the next export may replace them after a kill."""
    killed = "killed while files were moved: write it again"
    text = {"generator": generator, UNFINISHED: killed, "files": sorted(names)}
    write_whole(to / MANIFEST, json.dumps(text).encode(), replace=True)


def _manifest(to: Path, generator: str) -> dict[str, Any]:
    """Return the manifest that the same command wrote here; an empty one if none did."""
    try:
        manifest = json.loads((to / MANIFEST).read_text(encoding="utf-8"))
        return manifest if manifest["generator"] == generator and set(manifest["files"]) else {}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}


def _own(manifest: dict[str, Any]) -> set[str]:
    """Return the files that an earlier export wrote, by its manifest."""
    return {MANIFEST, *manifest["files"]} if manifest else set()


def write_text(path: Path, text: str) -> str:
    """Write a text with Unix line ends and return the file's name."""
    path.write_text(text, encoding="utf-8", newline="\n")
    return path.name

"""Compiled libraries and recorded tapes in the user's cache folder.

Nobody else can have put them there, and damaged ones are thrown away: the name of a file ends with the digest of its
content, so whatever is shorter, longer or other does not fit its name.
"""

import os
import stat
import sys
from hashlib import sha256
from pathlib import Path

from yawdesign import __version__
from yawdesign.problem.whole_files import write_whole

LIBRARY = ".dll" if sys.platform == "win32" else ".so"
TAPE = ".tape"
OTHERS = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Return the folder in which this version keeps what it compiled and recorded.

    Raises
    ------
    OSError
        If the user has no home folder.
    """
    base = _base()
    if base is None or not base.is_absolute():
        raise OSError("there is no home folder")
    return base / "yawdesign" / __version__


def _base() -> Path | None:
    """Return the user's cache folder; a relative name in the environment does not count."""
    variable = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME"
    given = Path(os.environ.get(variable, ""))
    if given.is_absolute() and sys.platform != "darwin":
        return given
    places = {"win32": "AppData/Local", "darwin": "Library/Caches"}
    try:
        return Path.home() / places.get(sys.platform, ".cache")
    except RuntimeError:
        return None


def find(key: str, suffix: str) -> Path | None:
    """Return the file that was kept under a key; those that do not fit are removed.

    Raises
    ------
    OSError
        If the folder cannot be used.
    """
    for path in _own_folder().glob(f"{key}-*{suffix}"):
        if _fits(path):
            return path
        path.unlink()
    return None


def keep(key: str, suffix: str, content: bytes) -> Path:
    """Write a file and return where it is.

    Raises
    ------
    OSError
        If it cannot be kept.
    """
    path = _own_folder() / f"{key}-{sha256(content).hexdigest()}{suffix}"
    if path.exists() and _fits(path):  # another process has made the same
        return path
    if path.is_dir():
        raise OSError(f"{path} is a folder")
    write_whole(path, content, replace=True)
    path.chmod(0o600)
    return path


def _fits(path: Path) -> bool:
    state = path.lstat()
    safe = stat.S_ISREG(state.st_mode) and _mine(state) and not _open_to_others(state)
    return safe and sha256(path.read_bytes()).hexdigest() == path.stem.rpartition("-")[2]


def _own_folder() -> Path:
    """Return the folder, made if it is not there, after making sure that nobody else can write to it."""
    folder = cache_folder()
    folder.parent.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    for place in (folder.parent, folder):
        place.mkdir(mode=0o700, exist_ok=True)
        if not (_mine(place.lstat()) and _mine(place.stat())):
            raise PermissionError(f"{place} belongs to another user")
        if _open_to_others(place.stat()):
            _close(place)
    return folder


def _close(folder: Path) -> None:
    """Keep others out from now on, and remove what they may have put there."""
    folder.chmod(0o700)
    for suffix in (LIBRARY, TAPE):
        for path in folder.glob(f"*{suffix}"):
            path.unlink()


def _mine(state: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or state.st_uid == os.geteuid()


def _open_to_others(state: os.stat_result) -> bool:
    return hasattr(os, "geteuid") and bool(state.st_mode & OTHERS)

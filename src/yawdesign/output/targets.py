"""Files to be written: looked at before the work that fills them."""

import os
from pathlib import Path

from yawdesign.problem import ProblemError


def target(name: str | os.PathLike[str], endings: tuple[str, ...] = ()) -> Path:
    """Return the path of a file that can be written.

    Parameters
    ----------
    name : path
        Name of the file; it may be there already.
    endings : tuple of str
        One of which it must have, in small or capital letters; any if none is given.

    Raises
    ------
    ProblemError
        If its ending is another one, its folder does not exist or must not be written, or a folder has this name.
    """
    path = Path(name)
    if endings and path.suffix.lower() not in endings:
        raise ProblemError(f"{name} must end in {' or '.join(endings)}")
    folder = path.absolute().parent
    if not folder.is_dir():
        raise ProblemError(f"{name}: there is no folder {path.parent}")
    if path.is_dir():
        raise ProblemError(f"{name!s} is a folder: give the name of a file")
    if not os.access(path if path.exists() and not path.is_file() else folder.resolve(), os.W_OK):
        raise ProblemError(f"{name}: no permission to write")
    return path

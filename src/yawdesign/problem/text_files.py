"""The text of a file that somebody names: no device, not too large, UTF-8."""

from __future__ import annotations

from pathlib import Path

from .diagnostics import Diagnostic, ProblemError


def text_of(name: str, most_bytes: int) -> str:
    """Return the text of a file.

    Parameters
    ----------
    name : str
        Name of the file.
    most_bytes : int
        What is larger is refused.

    Raises
    ------
    ProblemError
        If it cannot be read, is a device or a pipe, is too large, or is no UTF-8 text.
    """
    try:
        return _decoded(Path(name), most_bytes)
    except UnicodeDecodeError:
        message = "is not UTF-8 text: save the file as UTF-8"
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"cannot be read: {reason}"
    raise ProblemError([Diagnostic(path=name, message=message)])


def _decoded(path: Path, most_bytes: int) -> str:
    if path.is_fifo() or path.is_char_device() or path.is_block_device() or path.is_socket():
        raise OSError("it is a device or a pipe: give the name of a file")
    with path.open("rb") as file:
        content = file.read(most_bytes + 1)
    if len(content) > most_bytes:
        raise OSError(f"it is larger than {most_bytes / 1e6:g} MB: give a part of it")
    return content.decode("utf-8-sig")

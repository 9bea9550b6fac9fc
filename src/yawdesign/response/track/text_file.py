"""Text files, read whole and with an end."""

from pathlib import Path

from yawdesign.problem.diagnostics import Diagnostic, ProblemError

MOST_BYTES = 50_000_000  # about 400 km of track, measured every quarter of a metre


def text_of(name: str) -> str:
    """Return the text of a file.

    Parameters
    ----------
    name : str
        Name of the file.

    Raises
    ------
    ProblemError
        If it cannot be read, is a device or a pipe, is too large, or is no UTF-8 text.
    """
    try:
        return _decoded(Path(name))
    except UnicodeDecodeError:
        message = "is not UTF-8 text: save the file as UTF-8"
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"cannot be read: {reason}"
    raise ProblemError([Diagnostic(path=name, message=message)])


def _decoded(path: Path) -> str:
    if path.is_fifo() or path.is_char_device() or path.is_block_device() or path.is_socket():
        raise OSError("it is a device or a pipe: give the name of a file")
    with path.open("rb") as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise OSError(f"it is larger than {MOST_BYTES / 1e6:g} MB: give a part of it")
    return content.decode("utf-8-sig")

"""Standard output for answers and standard error for messages, also where these are closed or full."""

import os
import sys
from contextlib import suppress
from typing import IO

ANSWER = "the answer"  # stands where the error names a file


def write_answer(text: str) -> None:
    """Write an answer to standard output, at once.

    Raises
    ------
    OSError
        If it cannot be written; the file that it names is `ANSWER`.
    """
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        discard(sys.stdout)
        raise OSError(error.errno, error.strerror, ANSWER) from None


def tell(text: str) -> None:
    """Write a message to standard error, letter by letter; where nobody can read it, nothing else can be done."""
    from yawdesign.problem.characters import in_order

    try:
        sys.stderr.write(in_order(text) + "\n")
        sys.stderr.flush()
    except OSError:
        discard(sys.stderr)


def discard(stream: IO[str]) -> None:
    """Let a stream that cannot be written lead nowhere, so that its rest is not tried again at the end."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def open_streams() -> None:
    """Open standard streams that were closed, so that no other file gets their place.

    What is written to a closed output fails, as it does for every other program; messages are not missed.
    """
    for place, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            setattr(sys, name, _opened(place))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a console without µ or · shows ? and goes on


def _opened(place: int) -> IO[str]:
    """Return a stream on nothing: a standard error that takes everything, an input and an output that do not."""
    found = os.open(os.devnull, os.O_WRONLY if place == 2 else os.O_RDONLY)
    if found != place:
        os.dup2(found, place)
        os.close(found)
    return open(place, "w" if place else "r", encoding="utf-8", closefd=False)

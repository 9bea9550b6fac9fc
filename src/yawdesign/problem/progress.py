"""The progress of long work, put together from that of its parts: shares that never fall."""

from __future__ import annotations

from collections.abc import Iterator

from .arguments import Progress


def unseen(text: str, part: float) -> None:
    """Show no progress."""


def between(progress: Progress, low: float, high: float) -> Progress:
    """Return what tells the progress of a part of the work as that of the whole.

    Parameters
    ----------
    progress : callable
        Of the whole.
    low, high : float
        Shares of the whole that are done before and after the part [-].

    Examples
    --------
    >>> between(lambda text, part: print(text, part), 0.5, 1.0)("searching", 0.5)
    searching 0.75
    """
    return lambda text, part: progress(text, low + (high - low) * part)


def rounds(progress: Progress) -> Iterator[Progress]:
    """Yield the progress of one round after the other, where nobody knows how many come: each has half of the rest."""
    done = 0.0
    while True:
        yield between(progress, done, (1 + done) / 2)
        done = (1 + done) / 2


def rising(progress: Progress) -> Progress:
    """Return what tells the largest share so far: several parts that end at the same time may cross."""
    largest = 0.0

    def told(text: str, part: float) -> None:
        nonlocal largest
        largest = max(largest, min(part, 1.0))
        progress(text, largest)

    return told

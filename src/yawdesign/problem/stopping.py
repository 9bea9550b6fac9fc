"""Requests to stop (Ctrl-C, SIGTERM, a closed terminal), which wait where they would cost finished work.

Inside `held` they wait; inside `let_through` they end the work at once with `Stopped`. Both may stand inside each
other. Only the main thread gets signals, so in other threads both do nothing. A program's own handlers stay.
"""

import _thread
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name))
USUAL = (signal.SIG_DFL, signal.default_int_handler)
SWALLOWS = "casadi"  # whose conversions of numbers take every exception, also a request to stop, for "not this type"
SOON = 0.01  # seconds after which a request is made again that came in there


class Stopped(KeyboardInterrupt):
    """Somebody asked to stop.

    Parameters
    ----------
    number : int
        The signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


class _Requests:
    """What was asked, and whether it may be obeyed now."""

    def __init__(self) -> None:
        self.open = True
        self.waiting: int | None = None
        self.watched = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        if self.open and _is_swallowed(frame):
            again = threading.Timer(SOON, _ask_again, (threading.get_ident(), number))
            again.daemon = True
            again.start()
            return
        self.waiting = number
        self.obey()

    def obey(self) -> None:
        if self.open and (error := self.taken()):
            self.open = False  # a further request does not disturb what this one ends
            raise error

    def taken(self) -> Stopped | None:
        number, self.waiting = self.waiting, None
        return None if number is None else Stopped(number)


def _is_swallowed(frame: FrameType | None) -> bool:
    """Return whether an exception that is raised at a place may not come out of the library around it."""
    while frame is not None:
        if str(frame.f_globals.get("__name__")).partition(".")[0] == SWALLOWS:
            return True
        frame = frame.f_back
    return False


def _ask_again(thread: int, number: int) -> None:
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(thread, number)  # which also ends a wait
    else:
        _thread.interrupt_main(signal.Signals(number))


_REQUESTS = _Requests()


@contextmanager
def watched() -> Iterator[None]:
    """Let SIGTERM and a closed terminal end the block like Ctrl-C does: with an exception, so that it can tidy up."""
    if _REQUESTS.watched or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: handler for number in SIGNALS if (handler := signal.getsignal(number)) in USUAL}
    try:
        _REQUESTS.watched = True
        for number in before:
            signal.signal(number, _REQUESTS)
        yield
    finally:
        try:
            _REQUESTS.open = False
        finally:  # also after a request at the very end of the block
            for number, handler in before.items():
                signal.signal(number, handler)
            _REQUESTS.watched, _REQUESTS.waiting, _REQUESTS.open = False, None, True


@contextmanager
def held() -> Iterator[Callable[[], AbstractContextManager[None]]]:
    """Let requests to stop wait until the block is done; give a block inside which they do what they do outside."""
    outside = _REQUESTS.open
    with _obeying(False):
        yield lambda: _obeying(outside)


@contextmanager
def let_through() -> Iterator[None]:
    """Let requests to stop end the block, also one that has waited.

    Raises
    ------
    Stopped
        When there is one.
    """
    with _obeying(True):
        yield


@contextmanager
def _obeying(obey: bool) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with watched():
        before, _REQUESTS.open = _REQUESTS.open, obey
        try:
            _REQUESTS.obey()
            yield
        finally:
            _REQUESTS.open = before
        _REQUESTS.obey()


def ignore_requests() -> None:
    """Do nothing any more when somebody asks to stop: the program is at its end."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def request_to_stop() -> Stopped | None:
    """Return the request that waits, if there is one; it waits no longer."""
    return _REQUESTS.taken()

"""Requests to stop wait where they would cost work, and come through elsewhere."""

import signal
import threading
import time

import pytest

from yawdesign.problem.stopping import SIGNALS, Stopped, held, let_through, request_to_stop, watched


@pytest.mark.parametrize("number", SIGNALS)
def test_a_request_waits_until_the_block_is_done(number):
    done = []
    with pytest.raises(Stopped, match=signal.Signals(number).name) as caught, held():
        done += [signal.raise_signal(number), signal.raise_signal(number)]
    assert done == [None, None]
    assert caught.value.number == number
    assert isinstance(caught.value, KeyboardInterrupt)


def test_let_through_ends_the_work_at_once():
    done = []
    with held():
        with pytest.raises(Stopped), let_through():
            done += [signal.raise_signal(signal.SIGTERM)]
        signal.raise_signal(signal.SIGTERM)
        with pytest.raises(Stopped), let_through():
            done.append(1)
        with let_through(), pytest.raises(Stopped), held():
            done += [signal.raise_signal(signal.SIGINT)]
    assert done == [None]


def test_a_further_request_does_not_disturb_what_the_first_one_ends():
    ended = []

    def work():
        with let_through():
            try:
                signal.raise_signal(signal.SIGTERM)
            finally:
                ended.append(signal.raise_signal(signal.SIGTERM))

    with pytest.raises(Stopped), watched():
        work()
    assert ended == [None]


SWALLOWING = """
def converted():
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException:
        pass
"""


def test_a_request_inside_a_library_that_swallows_it_is_made_again():
    library = {"__name__": "casadi.casadi", "signal": signal}
    exec(SWALLOWING, library)
    start, done = time.monotonic(), []
    with pytest.raises(Stopped), watched():
        done += [library["converted"](), time.sleep(20)]
    assert time.monotonic() - start < 10
    with pytest.raises(Stopped), held():
        done += [library["converted"]()]
    assert done == [None]


def test_a_request_can_be_taken():
    with held():
        assert request_to_stop() is None
        signal.raise_signal(signal.SIGTERM)
        assert request_to_stop().number == signal.SIGTERM
        assert request_to_stop() is None


def test_handlers_are_as_before():
    before = [signal.getsignal(number) for number in SIGNALS]
    with held(), let_through(), held():
        assert signal.getsignal(signal.SIGTERM) not in before
    assert [signal.getsignal(number) for number in SIGNALS] == before
    with pytest.raises(ValueError, match="odd"), held():
        raise ValueError("odd", signal.raise_signal(signal.SIGTERM))  # what ends the block anyway is not hidden
    assert [signal.getsignal(number) for number in SIGNALS] == before
    with held():
        pass


@pytest.mark.parametrize("own", [signal.SIG_IGN, lambda *_: None])
def test_handlers_of_the_program_stay(own):
    before = signal.signal(signal.SIGTERM, own)
    try:
        with held():
            assert signal.getsignal(signal.SIGTERM) is own
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)


def test_watched_turns_sigterm_into_an_exception():
    with pytest.raises(Stopped), watched():
        signal.raise_signal(signal.SIGTERM)


def test_other_threads_get_no_signals():
    def work():
        with watched(), held(), let_through():
            seen.append(signal.getsignal(signal.SIGTERM))

    before, seen = signal.getsignal(signal.SIGTERM), []
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [before]

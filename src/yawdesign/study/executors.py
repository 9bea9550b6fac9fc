"""Many points in chunks, in this process or by an executor; what is finished stays when something breaks."""

import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from itertools import islice
from math import inf
from multiprocessing import get_context
from signal import SIG_IGN, SIGINT, signal
from time import perf_counter
from typing import Any

from yawdesign.problem import ProblemError
from yawdesign.problem.arguments import as_executor
from yawdesign.problem.stopping import held, let_through
from yawdesign.study.answers import LENGTH, VERDICTS, Answers, evaluate
from yawdesign.study.axes import applied, block
from yawdesign.study.request import Request, Task
from yawdesign.study.store import Store

HERE = VERDICTS * (os.cpu_count() or 1)  # most points of a chunk in this process, whose threads share them
FIRST = 64  # points of the first two chunks in this process
GROWTH = ((0.5, 16), (1.0, 4), (3.0, 1), (inf, 0.5))  # of a chunk after one that took less than so many seconds
LARGEST, SMALLEST = LENGTH, 64  # points of a chunk for an executor
PARTS = 64  # into which a grid is cut for an executor, so that all workers end at about the same time
IN_FLIGHT = 256  # chunks that are handed over at a time
CONNECT = 20  # seconds to wait for a dask scheduler

Blocks = Iterable[tuple[int, int]]


def answer(task: Task, point: Mapping[str, Any], pool: Executor | None = None) -> Answers:
    """Return the answers at some points; this is what a worker runs, in one thread: there are other workers."""
    parameters = applied(task.parameters, point, task.hold)
    return evaluate(task.question, parameters, threads=None if pool else 1, pool=pool)


def fill(
    store: Store, asked: Request, executor: Any, chunk: int | None, done: Callable[[], None]
) -> BaseException | None:
    """Compute what a store has not got yet; requests to stop end it between what is finished, and lose nothing of that.

    Parameters
    ----------
    store : Store
        Where the answers go.
    asked : Request
        What to compute.
    executor : concurrent.futures.Executor or distributed.Client or None
        Who computes; None stands for this process.
    chunk : int or None
        Points of a chunk; by default a good number.
    done : callable
        Called after every chunk.

    Returns
    -------
    BaseException or None
        What went wrong, if not all could be computed.
    """
    with held():
        try:
            if executor is None:
                with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
                    return _fill_here(store, asked, pool, chunk, done)
            chunk = chunk or min(max(asked.size // PARTS, SMALLEST), LARGEST)
            return _Handover(store, asked, as_executor(executor), done).run(store.missing(chunk))
        except (KeyboardInterrupt, Exception) as error:  # noqa: BLE001 - also of `done`; what is finished is in the store
            return error


def _fill_here(
    store: Store, asked: Request, pool: Executor, chunk: int | None, done: Callable[[], None]
) -> BaseException | None:
    failed: BaseException | None = None
    sizes = _sizes()
    size = next(sizes)
    for first, last in list(store.missing(store.size)):
        start = first
        while start < last:
            stop, begin = min(start + (chunk or size), last), perf_counter()
            try:
                with let_through():
                    answers = answer(asked.task, block(asked.axes, start, stop), pool)
                store.put(start, answers)
            except Exception as error:  # noqa: BLE001 - the other chunks are computed, and this one is reported
                failed = failed or error
            done()
            start = stop
            size = sizes.send(perf_counter() - begin)
    return failed


def _sizes() -> Generator[int, float, None]:
    """Yield how many points come next, told how many seconds the last ones took: so that they are seen coming in.

    The first chunk takes the preparation with it, and tells nothing.
    """
    size = min(FIRST, HERE)
    yield size
    while True:
        seconds = yield size
        size = min(max(int(size * next(factor for most, factor in GROWTH if seconds < most)), 1), HERE)


class _Handover:
    """Chunks on their way to an executor and back."""

    def __init__(self, store: Store, asked: Request, executor: Executor, done: Callable[[], None]) -> None:
        self.store, self.asked, self.executor, self.done = store, asked, executor, done
        self.waiting: dict[Future[Answers], int] = {}
        self.failed: BaseException | None = None

    def run(self, blocks: Blocks) -> BaseException | None:
        todo = iter(list(blocks))
        try:
            while self._submit(todo) or self.waiting:
                with let_through():
                    finished, _ = wait(self.waiting, return_when=FIRST_COMPLETED)
                for future in finished:
                    self._take(future)
                self.done()
        except KeyboardInterrupt as error:
            self.failed = error
            self._abandon()
        return self.failed

    def _submit(self, todo: Blocks) -> bool:
        """Hand over as many chunks as there is room for; return whether there were any."""
        if isinstance(self.failed, BrokenExecutor):
            return False
        before = len(self.waiting)
        # The task goes with every chunk, a few kilobytes: data laid out once on a cluster are lost with their worker.
        for start, stop in islice(todo, IN_FLIGHT - before):
            try:
                future = self.executor.submit(answer, self.asked.task, block(self.asked.axes, start, stop))
            except (BrokenExecutor, RuntimeError) as error:
                self.failed = error if isinstance(error, BrokenExecutor) else BrokenExecutor(str(error))
                return False
            self.waiting[future] = start
        return len(self.waiting) > before

    def _take(self, future: Future[Answers]) -> None:
        start = self.waiting.pop(future)
        try:
            self.store.put(start, future.result())
        except Exception as error:  # noqa: BLE001 - whatever befell a worker; the others' answers are kept
            if not isinstance(self.failed, BrokenExecutor):
                self.failed = error if isinstance(error, BrokenExecutor) else self.failed or error

    def _abandon(self) -> None:
        """Keep what is finished and call off the rest."""
        for future in list(self.waiting):
            if not future.cancel() and future.done():
                self._take(future)


@contextmanager
def workers(jobs: int = 1, dask: str | None = None) -> Iterator[Any]:
    """Give an executor for a number of processes or the address of a dask scheduler; None for this process alone."""
    if dask is not None and jobs > 1:
        raise ProblemError("--jobs and --dask: choose one, the scheduler has its own workers")
    if dask is not None:
        with _client(dask) as client:
            yield client
    elif jobs > 1:
        with ProcessPoolExecutor(jobs, mp_context=get_context("spawn"), initializer=_leave_interrupts) as executor:
            if (queue := getattr(executor, "_call_queue", None)) is not None:
                queue.cancel_join_thread()  # Python would not end while work for dead processes waits in a full pipe
            yield executor
    else:
        yield None


def _leave_interrupts() -> None:
    """Leave requests to stop to the first process, which keeps what the others have finished.

    A terminal and most batch systems send them to a group of processes.
    """
    signal(SIGINT, SIG_IGN)
    if hasattr(os, "setpgrp"):
        os.setpgrp()


def _client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError:
        raise ProblemError("dask is not installed: pip install 'yawdesign[dask]'") from None
    try:
        return Client(address, timeout=CONNECT)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise ProblemError(f"--dask: no scheduler answers at {address}: {error}") from None

"""Sweeps and maps: one question at every point of a grid of parameters."""

import time
import warnings
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.arguments import Progress, as_executor
from yawdesign.problem.progress import between
from yawdesign.problem.running import CURVE
from yawdesign.problem.stopping import held, request_to_stop
from yawdesign.study.axes import Axis
from yawdesign.study.chart import charted
from yawdesign.study.executors import fill
from yawdesign.study.kept_file import KeptFile
from yawdesign.study.request import Request, request
from yawdesign.study.result import Sweep, gathered
from yawdesign.study.store import Store

Pairs = Iterable[tuple[str, Any]]

SAVE_EVERY = 30.0  # [s] with a file to resume from
MOST_DRAWN = 5_000  # points of a boundary; no picture shows more
LINES_FROM = 0.9  # share of the work after which a boundary is computed


class IncompleteSweepError(RuntimeError):
    """A sweep did not come to its end; what was finished is in ``result``, and its text says how to go on.

    Parameters
    ----------
    reason : str
        What happened.
    remedy : str
        What to do.
    result : Sweep
        With NaN where there is no answer yet.
    interrupted : bool
        Whether somebody stopped it: Ctrl-C, SIGTERM or a closed terminal.
    """

    def __init__(self, reason: str, remedy: str, result: Sweep, interrupted: bool) -> None:
        super().__init__(f"{reason}. {remedy}")
        self.reason = reason
        self.result = result
        self.interrupted = interrupted


def sweep(
    problem: Problem,
    of: str = "C_sl",
    *,
    hold: str | None = None,
    executor: Any = None,
    resume: str | PathLike[str] | None = None,
    progress: Progress = lambda text, part: None,
    chunk: int | None = None,
    **axes: Any,
) -> Sweep:
    """Answer one question at every point of a grid of one to three axes.

    Parameters
    ----------
    problem : Problem
        Where everything comes from that is no axis. An answer holds for all its conditions, of ranges at some values
        of each; an axis replaces those of its name.
    of : str
        ``stable``, ``decay_rate`` [1/s], ``damping_ratio`` [-], ``margin`` (the problem's objective), ``critical``
        (all critical values of C_s [N s/m]), ``C_sl`` (lower end of the interval the design lies in [N s/m]; 0 where
        every C_s is stable), ``design`` (C_s by the golden section [N s/m]) or ``critical_speed`` (the speeds [m/s]
        at which stability is gained or lost, with the C_s given).
    hold : {"C_m", "xi_m"}, optional
        What stays the same when the motors' frequency ``f_m`` changes: their damping C_m (default), or their damping
        ratio xi_m.
    executor : concurrent.futures.Executor or distributed.Client, optional
        Who computes; by default this process.
    resume : path, optional
        File in which unfinished work is kept, and from which it is taken up again.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.
    chunk : int, optional
        Points that are computed at a time.
    **axes
        By name: any parameter of the problem (``lambda_`` for the conicity), ``v`` [m/s], ``f_m`` [Hz], ``xi_m`` or
        ``creep_factor`` (of f_11 and f_22); of ``design`` and ``C_sl`` any number of the curve. Values in rising order,
        numbers in SI or texts with a unit; or a text ``"150 km/h:450 km/h:60"``, with ``:log`` behind it for equal
        ratios.

    Returns
    -------
    Sweep
        ``values`` has one dimension for each axis, in the order given.

    Raises
    ------
    ProblemError
        With all that is wrong with the axes.
    IncompleteSweepError
        If a worker died, or on Ctrl-C, SIGTERM or a closed terminal; it holds what was finished.

    Examples
    --------
    >>> import yawdesign as yd
    >>> result = yd.sweep(yd.table1(equations="as-printed"), of="critical", f_m=[2.0, 3.27])
    >>> [[round(x / 1000) for x in values] for values in result.values]
    [[281], [12, 204, 358]]
    """
    return swept(problem, of, axes.items(), hold=hold, executor=executor, resume=resume, progress=progress, chunk=chunk)


def swept(
    problem: Problem,
    of: str,
    axes: Pairs,
    *,
    hold: str | None = None,
    executor: Any = None,
    resume: str | PathLike[str] | None = None,
    progress: Progress = lambda text, part: None,
    chunk: int | None = None,
) -> Sweep:
    """Return what `sweep` returns; here the axes are pairs of name and values, in which a name may wrongly recur."""
    asked = request(problem, of, axes, hold)
    return answered(asked, executor=executor, resume=resume, progress=progress, chunk=chunk)


def answered(
    asked: Request,
    *,
    executor: Any = None,
    resume: str | PathLike[str] | None = None,
    progress: Progress = lambda text, part: None,
    chunk: int | None = None,
) -> Sweep:
    """Return the answers to a checked request; the other arguments as in `sweep`."""
    begin = time.perf_counter()
    _check_work(executor, chunk)
    kept = None if resume is None else _Kept(Path(resume), asked)
    store = kept.store if kept else Store(asked.size)

    of_points = between(progress, 0.0, LINES_FROM if _has_boundary(asked) else 1.0)

    def done() -> None:
        of_points(f"{store.finished.sum()} of {asked.size} points", float(store.finished.mean()))
        if kept:
            kept.save_at_times()

    with held():  # requests to stop wait, except where points are computed
        boundary = None
        try:
            failed = fill(store, asked, executor, chunk, done)
        finally:  # also when a program's own handler of signals has raised SystemExit
            if kept:
                kept.save()
        if failed is None:
            failed, boundary = _boundary(asked, executor, between(progress, LINES_FROM, 1.0))
        failed = request_to_stop() or failed
        result = gathered(asked, store, time.perf_counter() - begin, boundary)
        if failed is None:
            result = _charted(result)
        if failed is not None:
            stopped = isinstance(failed, KeyboardInterrupt)
            raise IncompleteSweepError(_reason(store, failed), _remedy(store, kept), result, stopped) from failed
        return result


def _check_work(executor: Any, chunk: int | None) -> None:
    if executor is not None:
        as_executor(executor)
    if chunk is not None and (isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1):
        raise ProblemError(f"chunk: {chunk!r} is not a whole number above 0")


class _Kept:
    """A store with a file that keeps it; a file that cannot be written does not end the sweep."""

    def __init__(self, path: Path, asked: Request) -> None:
        if not path.absolute().parent.is_dir():
            raise ProblemError(f"resume: there is no folder {path.parent}")
        self.path, self.file, self.store = path, KeptFile(path, asked), Store(asked.size)
        self.file.read(self.store)
        self.last = time.monotonic()
        self.trouble = ""

    def save_at_times(self) -> None:
        if time.monotonic() - self.last > SAVE_EVERY:
            self.save()

    def save(self) -> bool:
        try:
            self.file.write(self.store)
        except (OSError, MemoryError, ProblemError) as error:
            room = "" if isinstance(error, ProblemError) else ": make room"
            why = f"{getattr(error, 'strerror', None) or error}{room}"
            text = f"{self.path} could not be written ({why}); the sweep goes on and tries again"
            if not self.trouble:
                warnings.warn(text, RuntimeWarning, stacklevel=2)
            self.trouble = text
        else:
            self.trouble = ""
        self.last = time.monotonic()
        return not self.trouble


def _reason(store: Store, failed: BaseException) -> str:
    happened = f"{type(failed).__name__}: {failed}"
    if isinstance(failed, KeyboardInterrupt):
        happened = f"it was stopped ({failed})" if str(failed) else "it was stopped"
    return f"{store.finished.sum()} of {store.size} points are finished, then {happened.rstrip('.')}"


def _remedy(store: Store, kept: _Kept | None) -> str:
    if not store.finished.any():
        return "There is nothing to keep"
    if kept and not kept.trouble:
        return f"What is finished is in {kept.path}: the same sweep with resume={str(kept.path)!r} does the rest"
    name = str(kept.path) if kept else "FILE.npz"
    return f"Nothing finished is lost: .result has it, .result.keep({name!r}) writes it, resume={name!r} goes on"


def _has_boundary(asked: Request) -> bool:
    """Return whether a picture of the sweep needs all critical values over one axis."""
    axes = _axes_of_boundary(asked)
    if len(axes) != 1 or axes[0].values.size > MOST_DRAWN or axes[0].name in CURVE:
        return False
    return len(asked.about("critical", axes).task.question.conditions) == 1  # of several each has its own


def _boundary(asked: Request, executor: Any, progress: Progress) -> tuple[BaseException | None, Sweep | None]:
    """Return all critical values, where a picture of the sweep needs them, and who stopped their computation.

    Whatever goes wrong here, the sweep itself is finished.
    """
    if not _has_boundary(asked):
        return None, None
    progress("critical lines for a picture", 0.0)
    try:
        lines = asked.about("critical", _axes_of_boundary(asked))
        return None, answered(lines, executor=executor, progress=lambda _, part: progress("critical lines", part))
    except Exception as error:  # noqa: BLE001 - no fault may cost the points that are finished
        if isinstance(error, IncompleteSweepError) and error.interrupted:
            return error.__cause__, None
        _say_without_lines(error)
        return None, None


def _charted(result: Sweep) -> Sweep:
    """Return a sweep with what its picture shows beside the values; whatever goes wrong here, the sweep is finished."""
    try:
        return replace(result, chart=charted(result.request, result.axes, result.columns, result.known, {}))
    except Exception as error:  # noqa: BLE001 - no fault may cost the points that are finished
        _say_without_lines(error)
        return result


def _say_without_lines(error: BaseException) -> None:
    reason = getattr(error, "reason", f"{type(error).__name__}: {error}")
    text = f"the critical lines for a picture are missing ({reason}); the sweep itself is whole"
    with suppress(RuntimeWarning):  # where warnings are errors
        warnings.warn(text, RuntimeWarning, stacklevel=2)


def _axes_of_boundary(asked: Request) -> tuple[Axis, ...]:
    """Return the axis over which the critical values bound what is stable: beside C_s, or with all C_s at once."""
    quantity, axes = asked.task.question.of, asked.axes
    if quantity in ("C_sl", "design"):
        return axes
    with_damping = quantity in ("stable", "decay_rate", "damping_ratio") and len(axes) == 2
    others = tuple(axis for axis in axes if axis.name != "C_s")
    return others if with_damping else ()

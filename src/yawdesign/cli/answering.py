"""What every command does: it reads its problem, says what is wrong, shows its answer and sets the exit code."""

import json
import logging
import sys
import warnings
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from contextlib import AbstractContextManager, contextmanager
from signal import SIGINT
from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.output.streams import ANSWER, tell, write_answer

if TYPE_CHECKING:
    from yawdesign.problem import Problem
    from yawdesign.problem.arguments import Progress
    from yawdesign.problem.reader import Report

DONE, NOTHING_FEASIBLE, BAD_INPUT, SOLVER_FAILED, STOPPED = 0, 1, 2, 3, 128  # 128 and the number of the signal

ProblemFile = Annotated[
    str, typer.Argument(metavar="PROBLEM.YAML", help="The problem file; - for standard input.", show_default=False)
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A value in place of the file's, again and again: C_s='800 kN s/m', speed='280 km/h', "
        "conditions.load.tare.W='120 kN'.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print the result as JSON, in SI units.")]
Jobs = Annotated[int, typer.Option(min=1, help="Number of processes.")]
Dask = Annotated[str | None, typer.Option(help="Address of a dask scheduler that computes.")]
Force = Annotated[bool, typer.Option("--force", help="Replace files that are there.")]


@contextmanager
def mistakes_told() -> Iterator[None]:
    """Say what is wrong, and end the command with the exit code of it."""
    from yawdesign.problem import ProblemError
    from yawdesign.problem.diagnostics import UnitWarning

    try:
        with warnings_told(UnitWarning), long_work_told():
            yield
    except (ProblemError, OSError, KeyboardInterrupt, BrokenExecutor) as error:
        tell(told(error))
        raise typer.Exit(code_of(error)) from None


def told(error: BaseException) -> str:
    """Return what an error says to a person."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted"
    if isinstance(error, BrokenExecutor):
        return "error: a worker died, and nothing is kept; fewer --jobs need less memory"
    if not isinstance(error, OSError):
        return str(error)
    if error.filename == ANSWER:
        return f"error: {ANSWER} could not be written: {error.strerror}"
    return f"error: {error.strerror or error}" + (f": {error.filename}" if error.filename else "")


def code_of(error: BaseException | None) -> int:
    """Return the exit code of an error, or of somebody's request to stop: 130 after Ctrl-C."""
    from yawdesign.problem import ProblemError

    if isinstance(error, KeyboardInterrupt):
        return STOPPED + getattr(error, "number", SIGINT)
    return BAD_INPUT if isinstance(error, (OSError, ProblemError)) else SOLVER_FAILED


def ended(*, checked: bool, feasible: bool) -> typer.Exit:
    """Return what ends a command: whether its answer is verified, and whether there is a stable or feasible design."""
    return typer.Exit((DONE if feasible else NOTHING_FEASIBLE) if checked else SOLVER_FAILED)


class _Telling(logging.Handler):
    """Shows what the package logs as a message."""

    def emit(self, record: logging.LogRecord) -> None:
        tell(record.getMessage())


@contextmanager
def long_work_told() -> Iterator[None]:
    """Say what takes seconds and has no progress of its own, such as a compilation."""
    logger, handler = logging.getLogger("yawdesign"), _Telling()
    before = logger.level
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        logger.removeHandler(handler)
        logger.setLevel(before)


@contextmanager
def warnings_told(kind: type[Warning] = RuntimeWarning) -> Iterator[None]:
    """Show warnings as messages."""
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_: tell(f"warning: {message}")
        warnings.simplefilter("always", kind)
        yield


def progress_shown() -> "AbstractContextManager[Progress]":
    """Show what is going on on standard error."""
    from yawdesign.output.progress_shown import progress_on_stderr

    return progress_on_stderr()


def read_problem(path: str, changes: list[str] | None = None) -> "Problem":
    """Return the problem of a file, with what --set says in it; warnings go to standard error."""
    from yawdesign.problem import ProblemError

    problem, diagnostics = report_of(path, changes)
    if problem is None:
        raise ProblemError(diagnostics)
    for diagnostic in diagnostics:
        tell(diagnostic.render())
    return problem


def report_of(path: str, changes: list[str] | None) -> "Report":
    """Return the problem of a file, or none, and everything that was found in it and in what --set says."""
    from yawdesign.problem import read, read_stream
    from yawdesign.problem.changes import NewValue, written_value
    from yawdesign.problem.diagnostics import Mistakes

    mistakes, values = Mistakes(), list[NewValue]()
    for text in changes or ():
        with mistakes.under(""):
            values.append(written_value(text))
    if path == "-":
        if sys.stdin.isatty():
            tell("reading the problem from the keyboard: end it with Ctrl-D on a line of its own")
        problem, diagnostics = read_stream(sys.stdin.buffer, name_of(path), values)
    else:
        problem, diagnostics = read(path, values)
    return None if mistakes.found else problem, (*mistakes.found, *diagnostics)


def name_of(path: str) -> str:
    """Return what messages call a file."""
    return "<stdin>" if path == "-" else path


def show(result: Any, as_json: bool, indent: int | None = 2) -> None:
    """Write a result to standard output, as tables or as JSON."""
    if as_json:
        write_answer(json.dumps(result.to_dict(), indent=indent, allow_nan=False) + "\n")
        return
    from yawdesign.output.tables import rendered
    from yawdesign.output.tables_by_result import tables_of

    write_answer(rendered(tables_of(result)))

"""Progress of long work as people see it: a bar in a terminal or a notebook, now and then a line in a file."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from importlib import import_module
from time import monotonic
from typing import TYPE_CHECKING, Any, TypeVar, cast

from yawdesign.output.streams import tell
from yawdesign.problem.arguments import Progress
from yawdesign.problem.characters import in_order
from yawdesign.problem.progress import rising

if TYPE_CHECKING:
    from rich.console import Console

F = TypeVar("F", bound=Callable[..., Any])

FIRST = "preparing the equations"
FIRST_LINE, LINES_APART = 5.0, 10.0  # seconds, where no terminal is
UPDATES_APART = 0.1  # seconds, in a notebook


@contextmanager
def progress_on_stderr() -> Iterator[Progress]:
    """Give what shows progress on standard error: a bar on a terminal, lines elsewhere, and nothing of short work."""
    from rich.console import Console

    console = Console(stderr=True)
    with _bar(console) if console.is_terminal else _lines() as progress:
        yield rising(progress)


@contextmanager
def _bar(console: "Console") -> Iterator[Progress]:
    """Give a bar that pulses until there is a share to show."""
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    text = TextColumn("{task.description}", markup=False)
    with Progress(text, BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), console=console, transient=True) as bar:
        task = bar.add_task(FIRST, total=None)

        def told(text: str, part: float) -> None:
            bar.update(task, description=in_order(text), completed=part, total=1.0 if part > 0 else None)

        yield told


@contextmanager
def _lines() -> Iterator[Progress]:
    """Give what writes a line now and then."""
    next_line = monotonic() + FIRST_LINE

    def told(text: str, part: float) -> None:
        nonlocal next_line
        if monotonic() >= next_line:
            tell(f"{100 * part:3.0f} %: {text}")
            next_line = monotonic() + LINES_APART

    yield told


def with_bar_in_notebooks(function: F) -> F:
    """Return a function that shows its progress in a notebook, where the caller does not want to be told of it."""

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        if "progress" in kwargs or not in_notebook():
            return function(*args, **kwargs)
        with notebook_bar() as progress:
            return function(*args, progress=progress, **kwargs)

    return cast(F, call)


def in_notebook() -> bool:
    """Return whether this process is the kernel of a notebook; nothing is imported to find out."""
    find = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)
    return getattr(find(), "kernel", None) is not None


@contextmanager
def notebook_bar() -> Iterator[Progress]:
    """Give a bar in the cell that is running; it is gone when the work is done."""
    ipython: Any = import_module("IPython.display")
    shown = ipython.display(ipython.HTML(_html(FIRST, 0.0)), display_id=True)
    last = monotonic()

    def told(text: str, part: float) -> None:
        nonlocal last
        if monotonic() >= last + UPDATES_APART:
            shown.update(ipython.HTML(_html(text, part)))
            last = monotonic()

    try:
        yield rising(told)
    finally:
        shown.update(ipython.HTML(""))


def _html(text: str, part: float) -> str:
    from yawdesign.output.markup import text as as_html

    value = f' value="{part:.3f}"' if part > 0 else ""  # without one it moves to and fro
    return f'<progress max="1"{value} style="width:20em;vertical-align:middle"></progress> {as_html(text)}'

"""Command that chooses a yaw damper from a catalogue."""

from typing import Annotated

import typer

from yawdesign.cli.answering import (
    AsJson,
    Changes,
    ProblemFile,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
    show,
)


def choose(
    file: ProblemFile,
    changes: Changes = None,
    as_json: AsJson = False,
    jobs: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
    dask: Annotated[str | None, typer.Option(help="Address of a dask scheduler that computes.")] = None,
) -> None:
    """Rank the dampers of the problem's catalogue, with the reason for each that is refused."""
    with mistakes_told():
        problem = read_problem(file, changes)
        from yawdesign.damper.choose import choose as ranked
        from yawdesign.study.executors import workers

        with workers(jobs, dask) as executor, progress_shown() as progress:
            result = ranked(problem, executor=executor, progress=progress)
        show(result, as_json)
    raise ended(checked=result.best is not None or not result.doubtful, feasible=result.best is not None)

"""Command that chooses a yaw damper from a catalogue."""

from yawdesign.cli.answering import (
    AsJson,
    Changes,
    Dask,
    Force,
    Jobs,
    ProblemFile,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
    show,
)
from yawdesign.cli.pictures import Plot, checked_picture, write_drawing


def choose(
    file: ProblemFile,
    changes: Changes = None,
    as_json: AsJson = False,
    jobs: Jobs = 1,
    dask: Dask = None,
    plot: Plot = None,
    force: Force = False,
) -> None:
    """Rank the dampers of the problem's catalogue, with the reason for each that is refused."""
    with mistakes_told():
        picture, problem = checked_picture(file, plot, force), read_problem(file, changes)
        from yawdesign.damper.choose import choose as ranked
        from yawdesign.study.executors import workers

        with workers(jobs, dask) as executor, progress_shown() as progress:
            result = ranked(problem, executor=executor, progress=progress)
        write_drawing(result, picture, force)
        show(result, as_json)
    raise ended(checked=result.best is not None or not result.doubtful, feasible=result.best is not None)

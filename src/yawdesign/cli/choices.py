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
from yawdesign.cli.workbooks import Xlsx, checked_workbook, write_result


def choose(
    file: ProblemFile,
    changes: Changes = None,
    as_json: AsJson = False,
    jobs: Jobs = 1,
    dask: Dask = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    force: Force = False,
) -> None:
    """Rank the dampers of the problem's catalogue, with the reason for each that is refused."""
    with mistakes_told():
        picture, workbook = checked_picture(file, plot, force), checked_workbook(file, xlsx, force)
        problem = read_problem(file, changes)
        from yawdesign.damper.choose import choose as ranked
        from yawdesign.study.executors import workers

        with workers(jobs, dask) as executor, progress_shown() as progress:
            result = ranked(problem, executor=executor, progress=progress)
        write_drawing(result, picture, force)
        write_result(result, workbook, force)
        show(result, as_json)
    raise ended(checked=result.best is not None or not result.doubtful, feasible=result.best is not None)

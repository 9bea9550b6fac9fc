"""The command that judges a vehicle whose parameters have distributions."""

from typing import Annotated

import typer

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


def uncertainty(
    file: ProblemFile,
    changes: Changes = None,
    samples: Annotated[int | None, typer.Option(help="How many; 1 048 576, fewer with many conditions.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the samples.")] = 0,
    jobs: Jobs = 1,
    dask: Dask = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    of: Annotated[str, typer.Option(help="What --plot draws: both (default), tornado, margin or C_sl.")] = "both",
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Tell how likely the vehicle is unstable with its C_s, and which uncertain parameters matter."""
    with mistakes_told():
        from yawdesign.output.uncertainty_plots import OF
        from yawdesign.problem.diagnostics import ProblemError
        from yawdesign.problem.table import as_choice
        from yawdesign.study.executors import workers
        from yawdesign.study.uncertainty import uncertainty as found

        problem = read_problem(file, changes)
        try:
            as_choice(of, OF)
        except ProblemError as error:
            raise error.under("--of") from None
        picture, workbook = checked_picture(file, plot, force), checked_workbook(file, xlsx, force)
        with workers(jobs, dask) as executor, progress_shown() as progress:
            result = found(problem, samples=samples, seed=seed, executor=executor, progress=progress)
        write_drawing(result, picture, force, of=of)
        write_result(result, workbook, force)
        show(result, as_json)
    raise ended(checked=result.checked, feasible=result.stable)

"""The command that sweeps: whatever breaks, what it has finished is kept."""

from typing import Annotated

import typer

from yawdesign.cli.answering import (
    AsJson,
    Changes,
    Force,
    ProblemFile,
    code_of,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
    show,
    warnings_told,
)
from yawdesign.cli.pictures import Plot, tell_written
from yawdesign.cli.workbooks import Xlsx
from yawdesign.output.streams import tell


def sweep(
    file: ProblemFile,
    over: Annotated[
        list[str], typer.Option(metavar="NAME=LOW:HIGH:N[:log]", help="An axis; one to three.", show_default=False)
    ],
    changes: Changes = None,
    of: Annotated[
        str,
        typer.Option(help="stable, decay_rate, damping_ratio, margin, critical, C_sl, design or critical_speed."),
    ] = "C_sl",
    hold: Annotated[str | None, typer.Option(help="C_m (default) or xi_m: what stays when f_m changes.")] = None,
    csv: Annotated[str | None, typer.Option(metavar="FILE", help="Write a table.")] = None,
    npz: Annotated[str | None, typer.Option(metavar="FILE", help="Write arrays for NumPy.")] = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    jobs: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
    dask: Annotated[str | None, typer.Option(help="Address of a dask scheduler that computes.")] = None,
    resume: Annotated[
        str | None, typer.Option(metavar="FILE", help="File that keeps unfinished work, and goes on from it.")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Answer one question at every point of a grid of parameters: curves, maps, stability charts."""
    with mistakes_told():
        problem = read_problem(file, changes)
        from yawdesign.output.sweep_files import Outputs, RescuedError
        from yawdesign.problem.stopping import held, let_through
        from yawdesign.study.executors import workers
        from yawdesign.study.request import request
        from yawdesign.study.sweep import answered

        asked = request(problem, of, [(name, values) for name, _, values in (x.partition("=") for x in over)], hold)
        outputs = Outputs.checked(file, asked.axes, csv=csv, npz=npz, plot=plot, xlsx=xlsx, resume=resume, force=force)
        with workers(jobs, dask) as executor, held():
            try:
                with outputs.rescuing(), progress_shown() as progress, warnings_told():
                    result = answered(asked, executor=executor, resume=resume, progress=progress)
                with outputs.rescuing(result):
                    outputs.write(result)
                    tell_written(outputs.csv, outputs.npz, outputs.picture, outputs.workbook)
                    with let_through():
                        show(result, as_json, indent=None)
            except RescuedError as error:
                tell(str(error))
                raise typer.Exit(code_of(error.reason)) from None
    raise ended(checked=not result.unverified.any(), feasible=bool(result.good.any()))

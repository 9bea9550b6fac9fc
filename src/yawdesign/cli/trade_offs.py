"""The command that trades margin off against rotational resistance."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

from yawdesign.cli.answering import (
    AsJson,
    Changes,
    Dask,
    Force,
    Jobs,
    ProblemFile,
    code_of,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
    show,
)
from yawdesign.cli.pictures import Plot, tell_written, write_drawing
from yawdesign.cli.workbooks import Xlsx, write_result
from yawdesign.output.streams import tell

if TYPE_CHECKING:
    from yawdesign.damper.pareto_front import TradeOff


def trade_off(
    file: ProblemFile,
    changes: Changes = None,
    points: Annotated[int, typer.Option(help="For how many rotational resistances the best design is found.")] = 12,
    csv: Annotated[str | None, typer.Option(metavar="FILE", help="Write a table.")] = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the search points.")] = 0,
    jobs: Jobs = 1,
    dask: Dask = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Find how much margin each rotational resistance allows, and the design that has it."""
    with mistakes_told():
        problem = read_problem(file, changes)
        write = _outputs(file, csv, plot, xlsx, force)
        from yawdesign.damper.trade_off import IncompleteTradeOffError
        from yawdesign.damper.trade_off import trade_off as front
        from yawdesign.study.executors import workers

        with workers(jobs, dask) as executor:
            try:
                with progress_shown() as progress:
                    result = front(problem, points=points, seed=seed, executor=executor, progress=progress)
            except IncompleteTradeOffError as error:
                tell(f"error: {error.reason}; {len(error.result.front)} points are finished")
                if error.result.front:
                    write(error.result)
                    show(error.result, as_json)
                raise typer.Exit(code_of(error.__cause__)) from None
        write(result)
        show(result, as_json)
    raise ended(checked=result.status != "unverified", feasible=bool(result.front))


def _outputs(
    file: str, csv: str | None, plot: str | None, xlsx: str | None, force: bool
) -> "Callable[[TradeOff], None]":
    """Return what writes the files, if they can be written: better known now than after the work."""
    from yawdesign.output.pictures import PICTURES, check_pictures
    from yawdesign.output.targets import Target, checked_targets, workbook_target

    files = Target("--csv", csv, replaced=force), Target("--plot", plot, PICTURES, replaced=force)
    table, picture, workbook = checked_targets((*files, workbook_target(xlsx, force)), [file])
    check_pictures(picture)

    def write(result: "TradeOff") -> None:
        if table is not None:
            result.to_csv(table, replace=force)
            tell_written(table)
        write_result(result, workbook, force)
        write_drawing(result, picture, force)

    return write

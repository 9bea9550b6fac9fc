"""Commands that answer a problem: is it stable, which damping is possible, which is best."""

from importlib import import_module
from typing import Annotated, Any

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


def stability(
    file: ProblemFile,
    changes: Changes = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Tell whether bogie or vehicle is stable with its C_s, under all conditions and with each fault."""
    result = _answer(file, changes, plot, xlsx, force, as_json, "yawdesign.hunting.stability", "stability")
    raise ended(checked=result.checked, feasible=result.stable and _met(result))


def design(
    file: ProblemFile,
    changes: Changes = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Find the stable yaw damping, the curve's limit and the golden section between them."""
    result = _answer(file, changes, plot, xlsx, force, as_json, "yawdesign.damper.forward", "design")
    raise ended(checked=result.checked, feasible=result.stable and _met(result))


def critical_speed(
    file: ProblemFile,
    changes: Changes = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Tell up to which speed bogie or vehicle is stable with its C_s under all conditions, whatever its speeds are."""
    result = _answer(file, changes, plot, xlsx, force, as_json, "yawdesign.hunting.critical_speed", "critical_speed")
    raise ended(checked=result.checked, feasible=result.stable_up_to != 0 and _met(result))


def _answer(
    file: str,
    changes: list[str] | None,
    plot: str | None,
    xlsx: str | None,
    force: bool,
    as_json: bool,
    home: str,
    function: str,
) -> Any:
    with mistakes_told():
        picture, workbook = checked_picture(file, plot, force), checked_workbook(file, xlsx, force)
        problem = read_problem(file, changes)
        result = getattr(import_module(home), function)(problem)
        write_drawing(result, picture, force)
        write_result(result, workbook, force)
        show(result, as_json)
    return result


def _met(result: Any) -> bool:
    return all(each.met for each in result.requirements)


def optimise(
    file: ProblemFile,
    changes: Changes = None,
    as_json: AsJson = False,
    seed: Annotated[
        int, typer.Option(min=0, help="Of the search points; with more than three variables try a few.")
    ] = 0,
    jobs: Jobs = 1,
    dask: Dask = None,
    plot: Plot = None,
    xlsx: Xlsx = None,
    force: Force = False,
) -> None:
    """Find the C_s, K_m and C_m (or other variables) of largest stability margin that the curve allows."""
    with mistakes_told():
        picture, workbook = checked_picture(file, plot, force), checked_workbook(file, xlsx, force)
        problem = read_problem(file, changes)
        from yawdesign.damper.optimise import optimise as best
        from yawdesign.study.executors import workers

        with workers(jobs, dask) as executor, progress_shown() as progress:
            result = best(problem, seed=seed, executor=executor, progress=progress)
        write_drawing(result, picture, force)
        write_result(result, workbook, force)
        show(result, as_json)
    raise ended(checked=result.status != "unverified", feasible=result.status == "optimal")

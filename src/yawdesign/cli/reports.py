"""The command that writes what a design review wants to see as one page."""

from pathlib import Path
from typing import Annotated

import typer

from yawdesign.cli.answering import (
    Changes,
    Dask,
    Force,
    Jobs,
    ProblemFile,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
)
from yawdesign.output.streams import tell


def report(
    file: ProblemFile,
    changes: Changes = None,
    to: Annotated[str, typer.Option(metavar="FILE.html", help="The page.")] = "report.html",
    pdf: Annotated[
        str | None, typer.Option(metavar="FILE.pdf", help="Print it too, by a browser without a window.")
    ] = None,
    jobs: Jobs = 2,
    dask: Dask = None,
    force: Force = False,
) -> None:
    """Write one HTML page for a design review: verdict, optimum, pictures, checks; it needs nothing but itself."""
    with mistakes_told():
        problem = read_problem(file, changes)
        from yawdesign.output.report.browser_print import find_browser, printed
        from yawdesign.output.report.report import PAGES, file_source, rendered
        from yawdesign.output.targets import Target, checked_targets
        from yawdesign.problem.whole_files import write_whole
        from yawdesign.study.design_review import design_review
        from yawdesign.study.executors import workers

        targets = Target("--to", to, PAGES, replaced=force), Target("--pdf", pdf, (".pdf",), replaced=force)
        _, to_print = checked_targets(targets, [file])
        browser = find_browser() if to_print else ""
        source = file_source(Path(file), changes or ())
        with workers(jobs, dask) as executor, progress_shown() as progress:
            review = design_review(problem, executor=executor, progress=progress)
            progress("drawing", 1.0)
            page = rendered(review, source)
        write_whole(Path(to), page, replace=force)
        tell(f"written: {to} ({len(page) / 1000:.0f} kB)")
        if to_print:
            write_whole(to_print, printed(page, browser), replace=force)
            tell(f"written: {to_print}")
    status = review.optimum.status
    raise ended(checked=status != "unverified", feasible=status == "optimal")

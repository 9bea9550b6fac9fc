"""The answers of commands as workbooks."""

from pathlib import Path
from typing import Annotated, Any

import typer

from yawdesign.cli.pictures import tell_written

Xlsx = Annotated[str | None, typer.Option("--xlsx", metavar="FILE", help="Write the result as a workbook: .xlsx.")]


def checked_workbook(file: str, xlsx: str | None, force: bool) -> Path | None:
    """Return the workbook to write, if it can be written: better known now than after the work."""
    from yawdesign.output.targets import checked_targets, workbook_target

    (workbook,) = checked_targets([workbook_target(xlsx, force)], [file])
    return workbook


def write_result(result: Any, workbook: Path | None, force: bool) -> None:
    """Write a result as a workbook if one was asked for."""
    if workbook is not None:
        result.to_excel(workbook, replace=force)
        tell_written(workbook)

"""The command that reproduces the paper."""

from typing import Annotated

import typer

from yawdesign.cli.answering import AsJson, ended, mistakes_told, progress_shown, show
from yawdesign.output.streams import tell


def reproduce(
    to: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder for a page, pictures and tables; new or empty.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace what was written there before.")] = False,
    as_json: AsJson = False,
) -> None:
    """Compute the tables, figures and equations of the paper now, beside what it prints."""
    with mistakes_told():
        from yawdesign.output.reproduction_folder import NAME
        from yawdesign.output.reproduction_folder import reproduce as reproduced

        with progress_shown() as progress:
            result = reproduced(None, to, force=force, progress=progress)
        if to is not None:
            tell(f"wrote {to}/{NAME}.html, its pictures and tables")
        show(result, as_json)
    raise ended(checked=result.checked, feasible=result.agrees)

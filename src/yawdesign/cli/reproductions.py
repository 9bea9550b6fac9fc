"""The command that reproduces the paper."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.cli.answering import AsJson, Changes, ended, mistakes_told, progress_shown, show
from yawdesign.output.streams import tell

if TYPE_CHECKING:
    from yawdesign.problem import Problem


def reproduce(
    to: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder for a page, pictures and tables; new or empty.")
    ] = None,
    changes: Changes = None,
    force: Annotated[bool, typer.Option("--force", help="Replace what was written there before.")] = False,
    as_json: AsJson = False,
) -> None:
    """Compute the tables, figures and equations of the paper now, beside what it prints."""
    with mistakes_told():
        from yawdesign.output.reproduction_folder import NAME
        from yawdesign.output.reproduction_folder import reproduce as reproduced

        with progress_shown() as progress:
            result = reproduced(_problem(changes or ()), to, force=force, progress=progress)
        if to is not None:
            tell(f"wrote {to}/{NAME}.html, its pictures and tables")
        show(result, as_json)
    raise ended(checked=result.checked, feasible=result.agrees)


def _problem(changes: Sequence[str]) -> "Problem":
    """Return the paper's problem with other values."""
    from yawdesign.problem import table1
    from yawdesign.problem.changes import written_value
    from yawdesign.problem.diagnostics import Mistakes

    mistakes, values = Mistakes(), dict[str, Any]()
    for text in changes:
        with mistakes.under(""):
            value = written_value(text)
            values[value.name] = value.value
    mistakes.report()
    return table1(equations="as-printed").replace(values)

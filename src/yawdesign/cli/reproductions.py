"""The command that reproduces the paper."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.cli.answering import AsJson, ended, mistakes_told, progress_shown, show
from yawdesign.output.streams import tell

if TYPE_CHECKING:
    from yawdesign.problem import Problem


def reproduce(
    to: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder for a page, pictures and tables; new or empty.")
    ] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="NAME=VALUE", help="A value in place of Table I's, again and again: M_b='7.3 t'."
        ),
    ] = None,
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


def _problem(changes: Iterable[str]) -> "Problem":
    """Return the paper's problem with other values."""
    from yawdesign.problem import ProblemError, table1
    from yawdesign.problem.document import compose, plain_data

    values: dict[str, Any] = {}
    for text in changes:
        name, sign, value = text.partition("=")
        if not sign:
            raise ProblemError(f"--set {text}: expected NAME=VALUE, such as M_b='7.3 t'")
        values[name.strip()] = plain_data(compose(value, f"--set {text}").root)
    return table1(equations="as-printed").replace(**values)

"""Commands that write and check files: exports, problem files and their schema."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from yawdesign.cli.answering import (
    BAD_INPUT,
    AsJson,
    Changes,
    ProblemFile,
    mistakes_told,
    name_of,
    read_problem,
    report_of,
    show,
)
from yawdesign.cli.asked_condition import AskedCondition, asked_condition, tell_condition
from yawdesign.output.streams import tell, write_answer


def export(
    file: ProblemFile,
    to: Annotated[str, typer.Option(metavar="DIR", help="Folder to write; new or empty.", show_default=False)],
    changes: Changes = None,
    inputs: Annotated[
        str | None, typer.Option(metavar="C_s,K_m,v", help="Parameters that stay inputs; all, if not given.")
    ] = None,
    only: Annotated[
        str | None, typer.Option(metavar="NAMES", help="Functions, or kinds of files, to write; all.")
    ] = None,
    formats: Annotated[str | None, typer.Option(metavar="NAMES", help="Kinds of files to write; all.")] = None,
    prefix: Annotated[
        str, typer.Option(metavar="NAME", help="What C files and symbols begin with; another for each export.")
    ] = "yawdesign",
    force: Annotated[bool, typer.Option("--force", help="Replace the files of an earlier export.")] = False,
    condition: AskedCondition = None,
    as_json: AsJson = False,
) -> None:
    """Write the model as functions for C, MATLAB and CasADi, as matrices and as an FMU, with a manifest."""
    with mistakes_told():
        under, problem = asked_condition(condition), read_problem(file, changes)
        from yawdesign.exports.write import export as write

        result = write(
            problem, to, inputs=inputs, only=only, formats=formats, prefix=prefix, force=force, condition=under
        )
        for note in result.notes:
            tell(f"note: {note}")
        tell_condition(problem, result)
        show(result, as_json)


def new(
    file: Annotated[str, typer.Argument(help="The file to write; .xlsx for a workbook.")] = "problem.yaml",
    kind: Annotated[str, typer.Option(help="power or trailer.")] = "power",
    car_body: Annotated[bool, typer.Option("--car-body", help="With a car body on two such bogies.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
) -> None:
    """Write a commented problem file to start from, and beside it the schema that editors use."""
    from yawdesign.output.targets import Target, checked_targets
    from yawdesign.problem import SCHEMA_FILE, ProblemError, starter
    from yawdesign.problem.problem_workbook import starter_sheets
    from yawdesign.problem.whole_files import write_whole
    from yawdesign.problem.workbook import is_workbook
    from yawdesign.problem.workbook_writing import write_workbook

    with mistakes_told():
        if kind not in ("power", "trailer"):
            raise ProblemError(f"--kind {kind} is not one of power, trailer")
        path = Path(file)
        if path.name == SCHEMA_FILE:
            raise ProblemError(f"{file}: the schema is written under this name beside the problem: choose another name")
        checked_targets([Target("", file, replaced=force)], [])
        if is_workbook(file):
            write_workbook(path, starter_sheets(kind, car_body=car_body), replace=force)
            write_answer(f"wrote {file}; next: yawdesign optimise {file}\n")
            return
        write_whole(path, starter(kind, car_body=car_body).encode(), replace=force)
        schema = path.with_name(SCHEMA_FILE)
        beside = f" and {schema}" if path.is_file() and _write_schema(schema, force) else ""
        write_answer(f"wrote {file}{beside}; next: yawdesign optimise {file}\n")


def _write_schema(path: Path, force: bool) -> bool:
    """Return whether the schema was written; another file of that name stays, with a note, unless `force` is given."""
    from yawdesign.problem.whole_files import write_whole

    content = _schema_text().encode()
    if not path.exists() or force:
        write_whole(path, content, replace=force)
        return True
    if path.read_bytes() != content:
        tell(f"note: {path} was there and is kept; it is not the schema of this version, which --force puts there")
    return False


def check(file: ProblemFile, changes: Changes = None, as_json: AsJson = False) -> None:
    """List every mistake of a problem file, and doubtful values."""
    with mistakes_told():
        if not as_json:
            read_problem(file, changes)
            write_answer(f"{name_of(file)}: no errors\n")
            return
        found = {"error": list[dict[str, Any]](), "warning": list[dict[str, Any]]()}
        for each in report_of(file, changes)[1]:
            found[each.severity].append(each.to_dict())
        answer = {"file": name_of(file), "errors": found["error"], "warnings": found["warning"]}
        write_answer(json.dumps(answer, indent=2) + "\n")
    if found["error"]:
        raise typer.Exit(BAD_INPUT)


def schema() -> None:
    """Print the JSON Schema of the problem file, for editors."""
    with mistakes_told():
        write_answer(_schema_text())


def _schema_text() -> str:
    from yawdesign.problem import schema as problem_schema

    return json.dumps(problem_schema(), indent=2, ensure_ascii=False) + "\n"

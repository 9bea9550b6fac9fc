"""Names of the files that a command is to write, checked before its work: better now than after it."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.whole_files import is_stream, place_of
from yawdesign.problem.workbook import ENDING, openpyxl


@dataclass(frozen=True)
class Target:
    """A file to write.

    Parameters
    ----------
    option : str
        Of the command line, such as ``--csv``.
    name : str or None
        What was given for it.
    endings : tuple of str
        Which the name may have; any if there are none.
    replaced : bool
        Whether a file that is there may be replaced.
    """

    option: str
    name: str | None
    endings: tuple[str, ...] = ()
    replaced: bool = False


def workbook_target(name: str | None, replaced: bool) -> Target:
    """Return the workbook that --xlsx names.

    Raises
    ------
    ProblemError
        If there is one, and the library that writes it is not installed.
    """
    if name:
        openpyxl()
    return Target("--xlsx", name, (ENDING,), replaced)


def checked_targets(targets: Iterable[Target], inputs: Iterable[str]) -> list[Path | None]:
    """Return the paths of the files, if they can be written and nothing is lost.

    Parameters
    ----------
    targets : iterable of Target
        Files to write.
    inputs : iterable of str
        Files that the command reads; what is no file is not looked at.

    Raises
    ------
    ProblemError
        With all mistakes: a folder or ending that is not there, no permission, a file that exists or is read, a name
        given twice.
    """
    mistakes, paths = Mistakes(), []
    taken = [(Path(name), "is what the command reads") for name in inputs if Path(name).is_file()]
    for target in targets:
        path = Path(target.name) if target.name else None
        paths.append(path)
        with mistakes.under(target.option):
            if target.name == "":
                raise ProblemError("is empty: give the name of a file")
            if path is not None:
                others = tuple(taken)
                taken.append((path, f"is also the file of {target.option}"))
                _check_others(path, others)
                _check(path, target)
    mistakes.report()
    return paths


def _check(path: Path, target: Target) -> None:
    if target.endings and path.suffix.lower() not in target.endings:
        raise ProblemError(f"{path} must end in {' or '.join(target.endings)}")
    if not path.absolute().parent.is_dir():
        raise ProblemError(f"{path}: there is no folder {path.parent}")
    if path.is_dir():
        raise ProblemError(f"{path} is a folder: give the name of a file")
    place = place_of(path)
    if not place.parent.is_dir():
        raise ProblemError(f"{path} is a link to {place}: there is no folder {place.parent}")
    if not os.access(path if is_stream(path) else place.parent, os.W_OK):
        raise ProblemError(f"{path}: no permission to write")
    if os.path.lexists(path) and not target.replaced and not is_stream(path):
        raise ProblemError(f"{path} exists: choose another name, or give --force to replace it")


def _check_others(path: Path, others: Iterable[tuple[Path, str]]) -> None:
    for other, why in others:
        if not is_stream(path) and _same(path, other):
            raise ProblemError(f"{path} {why}: choose another name")


def _same(one: Path, other: Path) -> bool:
    return os.path.realpath(one) == os.path.realpath(other) or (one.exists() and other.exists() and one.samefile(other))

"""Writing a problem's functions for other codes: CasADi files, C source, MATLAB matrices, and a manifest."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from yawdesign.exports import c_files
from yawdesign.exports.described_vehicle import in_words, short_name
from yawdesign.exports.file_contents import PREFIX, ExportNames, FileContents, Unavailable
from yawdesign.exports.fmu.archive import write_fmu_of
from yawdesign.exports.folder import check_place, exported_folder, write_text
from yawdesign.exports.functions import c_source, functions_of, listed, self_test, versions
from yawdesign.exports.manifest import write_manifest
from yawdesign.exports.matlab import write_mat
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, chosen, other_condition_in_words
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.diagnostics import Mistakes, unknown_key
from yawdesign.problem.result import Result
from yawdesign.vehicle.vehicle import Model


@dataclass(frozen=True, repr=False)
class Export(Result):
    """What was written.

    Parameters
    ----------
    folder : str
        Where.
    files : tuple of str
        Names in the folder; ``manifest.json`` tells what is in each.
    functions : tuple of str
        Names of the functions.
    notes : tuple of str
        What was left out, and why.
    condition : mapping
        Under which condition: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] if there is one, and what
        else is not as written, in SI units.
    """

    folder: str
    files: tuple[str, ...]
    functions: tuple[str, ...]
    notes: tuple[str, ...]
    condition: Mapping[str, Any]


def write_casadi(contents: FileContents, folder: Path) -> list[str]:
    """Write one .casadi file for each function."""
    for name, f in contents.functions.items():
        f.function.save(str(folder / f"{name}.casadi"))
    return [f"{name}.casadi" for name in contents.functions]


def write_c(contents: FileContents, folder: Path) -> list[str]:
    """Write C source and header of all functions, a self-test, an example and a Makefile."""
    names = contents.names
    source = c_source(names.prefix, {names.symbol(name): f.function for name, f in contents.functions.items()})
    problem = contents.problem
    other = other_condition_in_words(contents.condition)
    kind = ", ".join(filter(None, (problem.bogie.kind, problem.equations, *in_words(problem), other)))
    title = problem.title or short_name(Model.of(problem)).capitalize()
    by = "yawdesign {yawdesign} with CasADi {casadi}".format(**versions())
    about = f"{title} ({kind}): functions written by {by}"
    chosen = "critical_damping" if "critical_damping" in contents.functions else next(iter(contents.functions))
    texts = {
        names.source: source,
        names.header: c_files.header(contents.functions, about, names),
        "selftest.c": c_files.self_test_source({name: test for name, test in contents.tests.items() if test}, names),
        "example.c": c_files.example_source(chosen, contents.functions[chosen], names),
        "Makefile": c_files.makefile(names, source),
    }
    return [write_text(folder / name, text) for name, text in texts.items()]


def write_fmu_file(contents: FileContents, folder: Path) -> list[str]:
    """Write the linear motion as an FMU, which has all parameters whatever stays an input of the functions."""
    name = f"{short_name(Model.of(contents.problem))}.fmu"
    try:
        fmu = write_fmu_of(contents.problem, contents.condition, folder / name)
    except ProblemError as error:
        raise Unavailable(f"{name} left out: {error}") from None
    if fmu.platform is None:
        raise Unavailable(f"{name}: {fmu.message}", (name,))
    return [name]


FORMATS: Mapping[str, Callable[[FileContents, Path], list[str]]] = {
    "casadi": write_casadi,
    "c": write_c,
    "mat": write_mat,
    "fmu": write_fmu_file,
}


def export(
    problem: Problem,
    to: str | PathLike[str],
    *,
    inputs: Collection[str] | None = None,
    only: Collection[str] | None = None,
    formats: Collection[str] | None = None,
    prefix: str = PREFIX,
    force: bool = False,
    condition: Asked = AS_WRITTEN,
) -> Export:
    """Write a problem's functions into a folder, for use in other codes without this package.

    Parameters
    ----------
    problem : Problem
        The problem.
    to : path
        The folder: a new one, or an empty one.
    inputs, only : collection of str, optional
        Parameters that stay inputs, and names of the functions, as in `yawdesign.functions`. A kind of file among the
        names in `only` means nothing but that kind.
    formats : collection of str, optional
        ``casadi``, ``c``, ``mat``, ``fmu``; all if not given.
    prefix : str
        What the names of the C files and all symbols in them begin with: several exports with prefixes of their own
        can be linked into one program.
    force : bool
        Replace the files of an earlier export in a folder that is not empty. Other files are never touched.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    Export
        What was written, and what was left out with the reason.

    Raises
    ------
    ProblemError
        If a name is not known, the prefix is not the beginning of a C identifier, or the folder is taken.
    OSError
        If the folder cannot be written.
    """
    only, formats = _sorted_out(only, formats)
    wanted, names = _formats(formats), ExportNames(prefix)
    check_place(Path(to), force=force)
    asked = chosen(problem, condition)
    documented = functions_of(asked, inputs, only).documented
    if not documented:
        raise ProblemError("no function is named: leave `only` out to export all")
    under = next(iter(documented.values())).condition
    tests = {name: self_test(f) for name, f in documented.items()}
    contents = FileContents(asked.problem, documented, tests, under, names)
    with exported_folder(Path(to), force=force) as folder:
        files, notes = _write(contents, wanted, folder)
        files.append(write_manifest(contents, files, notes, folder))
    return Export(str(to), tuple(files), tuple(documented), tuple(notes), under)


def _sorted_out(
    only: Collection[str] | None, formats: Collection[str] | None
) -> tuple[Collection[str] | None, Collection[str] | None]:
    """Return functions and kinds of files that are wanted, with the kinds that are named among the functions."""
    names = () if only is None else listed(only)
    kinds = [name for name in names if name in FORMATS]
    if not kinds:
        return only, formats
    functions_left = [name for name in names if name not in FORMATS]
    return functions_left or None, [*kinds, *(() if formats is None else listed(formats))]


def _formats(formats: Collection[str] | None) -> tuple[str, ...]:
    mistakes = Mistakes()
    names = tuple(FORMATS) if formats is None else listed(formats)
    for name in names:
        with mistakes.under(f"format {name}"):
            if name not in FORMATS:
                raise ProblemError(f"{unknown_key(name, FORMATS)}; there are {', '.join(FORMATS)}")
    mistakes.report()
    return names


def _write(contents: FileContents, formats: Collection[str], folder: Path) -> tuple[list[str], list[str]]:
    files: list[str] = []
    notes = [
        f"{name} has no self-test: there is no critical damping with the problem's values"
        for name, test in contents.tests.items()
        if test is None
    ]
    for name in formats:
        try:
            files += FORMATS[name](contents, folder)
        except Unavailable as reason:
            notes.append(str(reason))
            files += reason.files
    if not files:
        raise ProblemError("\n".join(notes) or "no format is named")
    return files, notes

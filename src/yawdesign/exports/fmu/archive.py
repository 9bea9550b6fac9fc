"""Writing the archive of an FMU."""

import io
import platform
import sys
import uuid
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from yawdesign.exports.described_vehicle import in_words, short_name
from yawdesign.exports.equations_of_motion import equations_of_motion, motion_source
from yawdesign.exports.fmu.description import build_description, header, model_description
from yawdesign.exports.fmu.variables import variables
from yawdesign.hunting.chosen_condition import AS_WRITTEN, Asked, chosen, other_condition_in_words
from yawdesign.hunting.many.c_compiler import compilers, run, why_none
from yawdesign.hunting.verdict import given_damping
from yawdesign.problem import Problem, ProblemError
from yawdesign.problem.result import Result
from yawdesign.problem.whole_files import refuse_existing, write_whole
from yawdesign.vehicle.vehicle import Model

REMEDY = "the FMU holds its C code only: before it runs it must be compiled, such as with `fmpy compile`"


@dataclass(frozen=True, repr=False)
class Fmu(Result):
    """An FMU that was written.

    Parameters
    ----------
    path : str
        The file.
    platform : str or None
        Machine for which it holds a library, such as ``x86_64-linux``; None if it holds C code only.
    message : str
        Why there is no library; empty if there is one.
    condition : mapping
        Whose values are the start values: ``values`` ("as written", "worst" or "given"), ``speed`` [m/s] and
        what else is not as written, in SI units.
    """

    path: str
    platform: str | None
    message: str
    condition: Mapping[str, Any]


def write_fmu(problem: Problem, path: str | Path, *, replace: bool = False, condition: Asked = AS_WRITTEN) -> Fmu:
    """Write the linear lateral motion of a problem's vehicle as an FMU (FMI 3, model exchange).

    Every parameter of bogie and car body and the speed ``v`` are tunable parameters; the track under each wheelset is
    the input. The FMU holds a library for this machine, if there is a C compiler, and in any case the C code.

    Parameters
    ----------
    problem : Problem
        With a value of ``C_s``. Of several speeds the highest is the start value of ``v``.
    path : str or Path
        The file to write, ``*.fmu``.
    replace : bool
        Whether a file that is there is replaced.
    condition : str or mapping
        ``"as written"`` (default), ``"worst"`` of all conditions, or values such as ``{"lambda": 0.4, "creep_factor":
        0.5, "speed": "330 km/h", "load": "laden", "tolerance.K_m": "-10 %"}``: the others stay as written.

    Returns
    -------
    Fmu
        Where it is and for which machine.

    Raises
    ------
    ProblemError
        If the problem has no ``C_s``, the name does not end in ``.fmu``, or the file exists.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import yawdesign as yd
    >>> fmu = yd.write_fmu(yd.table1(), "bogie.fmu")  # doctest: +SKIP
    """
    asked = chosen(problem, condition)
    return write_fmu_of(asked.problem, asked.described(max(asked.problem.speeds)), Path(path), replace=replace)


def write_fmu_of(problem: Problem, condition: Mapping[str, Any], path: Path, *, replace: bool = False) -> Fmu:
    """Write the FMU of a problem with a condition in its values, as in `write_fmu`."""
    if path.suffix != ".fmu":
        raise ProblemError(f"{path.name} is not the name of an FMU: it must end in .fmu")
    refuse_existing(path, replace)
    name = f"yawdesign_{short_name(Model.of(problem))}"
    texts = _texts(problem, condition, name)
    library, message = _library(texts)
    place = f"binaries/{platform_name()}/{name}{library_suffix()}"
    write_whole(path, _archive({**texts, **({place: library} if library else {})}), replace=replace)
    return Fmu(str(path), platform_name() if library else None, message, condition)


def _texts(problem: Problem, condition: Mapping[str, Any], name: str) -> dict[str, bytes]:
    """Return the files of the FMU, but for the library."""
    vehicle = Model.of(problem).at(problem.parameters(), C_s=given_damping(problem), v=max(problem.speeds))
    motion = equations_of_motion(vehicle)
    table = variables(motion, vehicle.p)
    source, sizes = motion_source(motion)
    title = _title(problem, condition)
    frame = files("yawdesign.exports.fmu").joinpath("fmi3.c").read_text(encoding="utf-8")

    def texts(token: str) -> dict[str, str]:
        return {
            "modelDescription.xml": model_description(table, name=name, token=token, title=title),
            "sources/buildDescription.xml": build_description(name),
            "sources/model.h": header(table, token=token, sizes=sizes),
            "sources/motion.c": source,
            "sources/fmi3.c": frame,
        }

    token = uuid.uuid5(uuid.NAMESPACE_OID, "".join(texts("").values()))
    return {file: text.encode() for file, text in texts(f"{{{token}}}").items()}


def _title(problem: Problem, condition: Mapping[str, Any]) -> str:
    kind = ", ".join((f"{problem.equations} equations", *in_words(problem)))
    under = other_condition_in_words(condition)
    text = f"Lateral motion of a {problem.bogie.kind} bogie ({kind}), linear, in SI units{under and '; '}{under}"
    return f"{problem.title}. {text}" if problem.title else text


def _library(texts: Mapping[str, bytes]) -> tuple[bytes, str]:
    """Return the compiled library, or nothing and the reason."""
    with TemporaryDirectory() as folder:
        for name, text in texts.items():
            Path(folder, Path(name).name).write_bytes(text)
        library = Path(folder, "library")
        try:
            compile_library(Path(folder, "fmi3.c"), library)
        except CannotCompileError as reason:
            return b"", f"{reason}; {REMEDY}"
        return library.read_bytes(), ""


def _archive(contents: Mapping[str, bytes]) -> bytes:
    """Return a ZIP archive without dates: the same problem gives the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, content)
    return buffer.getvalue()


_MACHINES = {"amd64": "x86_64", "arm64": "aarch64", "i386": "x86", "i686": "x86"}
_SYSTEMS = {"win32": ("windows", ".dll"), "darwin": ("darwin", ".dylib")}
_OPTIONS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden", "-shared")
_TIME_LIMIT = 30.0  # s; it takes less than one


class CannotCompileError(Exception):
    """Why there is no library."""


def platform_name() -> str:
    """Return this machine's name in FMI 3, such as ``x86_64-linux``."""
    machine = platform.machine().lower()
    return f"{_MACHINES.get(machine, machine)}-{_SYSTEMS.get(sys.platform, ('linux', ''))[0]}"


def library_suffix() -> str:
    """Return how the name of a library ends on this machine."""
    return _SYSTEMS.get(sys.platform, ("", ".so"))[1]


def compile_library(source: Path, library: Path) -> None:
    """Compile one C file, and what it includes, to a shared library.

    Parameters
    ----------
    source, library : Path
        Where to read and to write.

    Raises
    ------
    CannotCompileError
        If there is no compiler, or it does not succeed.
    """
    found = compilers("CC")
    if not found:
        raise CannotCompileError(why_none("CC"))
    command = [*found[0], *_OPTIONS, "-o", str(library), str(source)]
    try:
        done = run(command, _TIME_LIMIT)
    except TimeoutError as error:
        raise CannotCompileError(f"the C compiler {error}") from None
    except OSError as error:
        raise CannotCompileError(f"the C compiler {command[0]} cannot be run: {error}") from None
    if done.returncode or not library.exists():
        first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr.strip()[:200])
        raise CannotCompileError(f"the C compiler {command[0]} failed: {first or f'exit code {done.returncode}'}")

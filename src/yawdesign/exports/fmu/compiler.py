"""Compiling the C code of an FMU for this machine."""

import platform
import sys
from pathlib import Path

from yawdesign.hunting.many.c_compiler import compilers, run, why_none

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

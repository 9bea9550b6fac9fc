"""C compilers: which there are, and running them for a bounded time.

What does not end is stopped with all that it started.
"""

import contextlib
import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Sequence

NAMES = ("cc", "gcc", "clang")


def compilers(variable: str) -> list[list[str]]:
    """Return the C compilers that are here, each as the beginning of its command: path and options.

    Parameters
    ----------
    variable : str
        An environment variable. A compiler that it names, maybe with options, is the only one that counts.
    """
    wanted = _wanted(variable)
    found = [(shutil.which(name), options) for name, *options in ([wanted] if wanted else [[name] for name in NAMES])]
    return [[path, *options] for path, options in found if path]


def why_none(variable: str) -> str:
    """Return why no compiler was found; `variable` as in `compilers`."""
    wanted = _wanted(variable)
    reason = f"{variable}={wanted[0]} names none" if wanted else f"none of {', '.join(NAMES)} is on the path"
    return f"no C compiler was found ({reason})"


def _wanted(variable: str) -> list[str]:
    text = os.environ.get(variable, "").strip()
    return [text] if shutil.which(text) else shlex.split(text)  # a path may have blanks in it


def run(command: Sequence[str], seconds: float) -> subprocess.CompletedProcess[str]:
    """Run a command and return its exit code and what it wrote.

    Parameters
    ----------
    command : sequence of str
        Path and arguments.
    seconds : float
        The longest time that it may take.

    Raises
    ------
    TimeoutError
        If it did not finish; then it has been stopped, and so have the processes that it started.
    OSError
        If it cannot be started.
    """
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=True,  # what it starts can be stopped with it
    ) as process:
        try:
            out, err = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            _stop(process)
            raise TimeoutError(f"{command[0]} did not finish in {seconds:g} s and was stopped") from None
        except BaseException:  # Ctrl-C
            _stop(process)
            raise
    return subprocess.CompletedProcess(command, process.returncode, out, err)


def _stop(process: subprocess.Popen[str]) -> None:
    """Kill a process with its children."""
    with contextlib.suppress(ProcessLookupError, PermissionError):  # there is nothing left of them
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()

"""Commands of others, such as compilers, for a bounded time: what does not end is stopped with all that it started."""

import contextlib
import os
import signal
import subprocess
from collections.abc import Sequence


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

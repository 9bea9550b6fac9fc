"""Compiled code as an optional speed-up: compiled once, kept in the user's cache folder, and never a reason to fail."""

import contextlib
import ctypes
import hashlib
import logging
import os
import platform
import sys
import tempfile
import warnings
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.hunting.many import library_cache
from yawdesign.hunting.many.c_compiler import compilers, run, why_none
from yawdesign.hunting.many.c_statements import Statements

Run = Callable[[Sequence[Float], Float, int, int], None]

WIDTH = 8  # points in a vector
SWITCH = "YAWDESIGN_CC"  # environment variable that names a compiler; empty: none
# Contraction to fused multiply-add would change the last bits. No warnings: nobody would see them.
FLAGS = ("-O1", "-std=gnu99", "-shared", "-fPIC", "-ffp-contract=off", "-w")
TIME_LIMIT = 20.0  # seconds for a compilation, which takes half a second for a single bogie
TIME_PER_CHARACTER = 1e-4  # seconds at most for a longer one; it takes about 2e-6, 2e-5 without wide vectors
LONG = 300_000  # characters of which the compilation is announced
ANSWER_LIMIT = 5.0  # seconds for a compiler to tell its version

logger = logging.getLogger(__name__)
_hanging: set[str] = set()  # compilers that did not finish; they are not asked again

FRAME = """\
typedef double vector __attribute__((vector_size(%(width)d * sizeof(double)), aligned(8)));
typedef long long mask __attribute__((vector_size(%(width)d * sizeof(long long)), aligned(8)));
#define ZERO ((vector){0})
#define LESS(a, b) ((vector)((mask)((a) < (b)) & (mask)(ZERO + 1.0)))
#define SIZE(a) ((vector)((mask)(a) & ((mask){0} + 0x7fffffffffffffffLL)))

static inline vector load(const double *from, long long stride, long long point, long long end) {
  vector value = ZERO;
  if (!stride) return value + *from;
  if (point + %(width)d <= end) return *(const vector *)(from + point);
  for (long long k = point; k < end; ++k) value[k - point] = from[k];
  return value;
}

static inline void store(double *to, vector value, long long point, long long end) {
  if (point + %(width)d <= end) *(vector *)(to + point) = value;
  else for (long long k = point; k < end; ++k) to[k] = value[k - point];
}

%(functions)s
void run(const double *const *in, const long long *stride, double *out, long long points, long long start,
         long long end) {
%(once)s
  for (long long point = start; point < end; point += %(width)d) {
%(each)s
  }
}
"""

TRIAL = "import ctypes, sys; ctypes.CDLL(sys.argv[1]).run"


class _Compiler(NamedTuple):
    command: tuple[str, ...]
    version: str

    @property
    def path(self) -> str:
        return self.command[0]


def load(code: Statements, *, compiling: bool = True) -> Run | None:
    """Return compiled operations as a function of (inputs, outputs, first point, last point but one).

    A compilation of seconds is announced to the logger of this module.

    Parameters
    ----------
    code : Statements
        The operations in C.
    compiling : bool
        Whether they may be compiled; otherwise they are only looked for among what was kept.

    Returns
    -------
    callable or None
        None where there is no compiler, or it does not accept the code or does not finish; a note says so.
    """
    compiler = _compiler()
    if compiler is None or compiler.path in _hanging:
        return None
    try:
        library = _library(_source(code), compiler, compiling)
        return _callable(library) if library else None
    except TimeoutError as error:
        _hanging.add(compiler.path)
        note(str(error))
    except (OSError, RuntimeError, ValueError, AttributeError) as error:
        note(f"{compiler.path}: {_told(error)}")
    return None


def _source(code: Statements) -> str:
    return FRAME % {"width": WIDTH, "functions": code.functions, "once": code.once, "each": code.each}


@cache
def note(reason: str) -> None:
    """Warn, once for each reason, that NumPy goes on alone."""
    warnings.warn(f"going on without compiled code, which takes longer: {reason}", RuntimeWarning, stacklevel=2)


@cache
def _not_kept(reason: str) -> None:
    warnings.warn(f"compiled code is not kept for the next run: {reason}", RuntimeWarning, stacklevel=2)


def _told(error: Exception) -> str:
    """Return what went wrong in words, without the system's number for it."""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{error.strerror}: {error.filename}"
    return str(error)


def _callable(library: ctypes.CDLL) -> Run:
    pointer, number = ctypes.c_void_p, ctypes.c_longlong
    library.run.argtypes = [pointer, pointer, pointer, number, number, number]
    library.run.restype = None

    def run(inputs: Sequence[Float], out: Float, start: int, end: int) -> None:
        places = np.array([x.ctypes.data for x in inputs], dtype=np.uintp)
        strides = np.array([x.size != 1 for x in inputs], dtype=np.int64)
        library.run(places.ctypes.data, strides.ctypes.data, out.ctypes.data, out.shape[-1], start, end)

    return run


def _library(source: str, compiler: _Compiler, compiling: bool) -> ctypes.CDLL | None:
    """Return the shared library of a source, compiled if this machine has not compiled it yet and may do so."""
    key = hashlib.sha256(
        "\n".join([source, *FLAGS, *compiler.command, compiler.version, _processor()]).encode()
    ).hexdigest()[:20]
    with contextlib.suppress(OSError):
        if kept := library_cache.find(key, library_cache.LIBRARY):
            return _loaded(kept)
    if not compiling:
        return None
    if len(source) > LONG:
        logger.info("compiling the equations for many points, once on this machine: some seconds")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        library = _compile(source, compiler, Path(folder))
        _try(library)
        try:
            library = library_cache.keep(key, library_cache.LIBRARY, library.read_bytes())
        except OSError as error:
            _not_kept(_told(error))
        return ctypes.CDLL(str(library))  # what is loaded stays so without its file


def _loaded(kept: Path) -> ctypes.CDLL:
    """Return a library that was kept; one that does not load is removed."""
    try:
        return ctypes.CDLL(str(kept))
    except OSError:
        kept.unlink(missing_ok=True)
        raise


def _try(library: Path) -> None:
    """Load a library in a process of its own: one that a compiler has cut off would end this one."""
    done = run([sys.executable, "-I", "-c", TRIAL, str(library)], TIME_LIMIT)
    if done.returncode:
        raise RuntimeError("it made a library that does not load")


def _compile(source: str, compiler: _Compiler, folder: Path) -> Path:
    code, library = folder / "code.c", folder / f"code{library_cache.LIBRARY}"
    code.write_text(source, encoding="ascii")
    command = [*compiler.command, *FLAGS, "-o", str(library), str(code)]
    limit = max(TIME_LIMIT, TIME_PER_CHARACTER * len(source))
    for options in (["-march=native"], []):
        done = run([*command, *options], limit)
        if done.returncode == 0 and library.exists():
            return library
    raise RuntimeError(f"exit code {done.returncode}, {done.stderr.strip()[:200] or 'without a library'}")


@cache
def _compiler() -> _Compiler | None:
    """Return a C compiler that answers; the one that is named, if one is."""
    wanted = os.environ.get(SWITCH)
    if wanted == "":
        return None
    found = compilers(SWITCH)
    if wanted and not found:
        note(why_none(SWITCH))
    return next(filter(None, map(_answering, found)), None)


def _answering(command: Sequence[str]) -> _Compiler | None:
    """Return a compiler with its version, if it tells that."""
    try:
        done = run([*command, "--version"], ANSWER_LIMIT)
    except OSError as error:
        note(_told(error))
        return None
    return _Compiler(tuple(command), done.stdout) if done.returncode == 0 else None


@cache
def _processor() -> str:
    """Return what tells processors apart: a home folder may be shared by machines that are not alike."""
    lines = Path("/proc/cpuinfo")
    if lines.exists():
        kinds = {
            line for line in lines.read_text().splitlines() if line.startswith(("flags", "model name", "Features"))
        }
        return "\n".join(sorted(kinds))
    return f"{platform.machine()} {platform.processor()} {platform.platform()}"

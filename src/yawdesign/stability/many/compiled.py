"""Compiled code as an optional speed-up: compiled once, kept in the user's cache folder, and never a reason to fail."""

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from yawdesign import __version__

Float = NDArray[np.float64]
Run = Callable[[Sequence[Float], Float, int, int], None]

WIDTH = 8  # points in a vector
SWITCH = "YAWDESIGN_CC"  # environment variable that names a compiler; empty: none
# Contraction to fused multiply-add would change the last bits. No warnings: nobody would see them.
FLAGS = ("-O1", "-std=gnu99", "-shared", "-fPIC", "-ffp-contract=off", "-w")
TIME_LIMIT = 60.0  # seconds for a compilation

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

void run(const double *const *in, const long long *stride, double *out, long long points, long long start,
         long long end) {
  for (long long point = start; point < end; point += %(width)d) {
%(body)s
  }
}
"""


def load(body: str) -> Run | None:
    """Return compiled operations as a function of (inputs, outputs, first point, last point but one).

    Parameters
    ----------
    body : str
        C statements between ``load`` and ``store``.

    Returns
    -------
    callable or None
        None where there is no compiler, or it does not accept the code, or nothing can be written.
    """
    source = FRAME % {"width": WIDTH, "body": body}
    try:
        library = _library(source)
        return None if library is None else _callable(ctypes.CDLL(str(library)))
    except (OSError, subprocess.SubprocessError, AttributeError):
        return None


def _callable(library: ctypes.CDLL) -> Run:
    pointer, number = ctypes.c_void_p, ctypes.c_longlong
    library.run.argtypes = [pointer, pointer, pointer, number, number, number]
    library.run.restype = None

    def run(inputs: Sequence[Float], out: Float, start: int, end: int) -> None:
        places = np.array([x.ctypes.data for x in inputs], dtype=np.uintp)
        strides = np.array([x.size != 1 for x in inputs], dtype=np.int64)
        library.run(places.ctypes.data, strides.ctypes.data, out.ctypes.data, out.shape[-1], start, end)

    return run


def _library(source: str) -> Path | None:
    """Return the shared library of a source, compiled if this machine has not compiled it yet."""
    compiler = _compiler()
    if compiler is None:
        return None
    key = hashlib.sha256("\n".join([source, *FLAGS, *compiler, _processor()]).encode()).hexdigest()[:20]
    place = cache_folder() / f"{key}{'.dll' if sys.platform == 'win32' else '.so'}"
    if not place.exists():
        place.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        _compile(source, compiler[0], place)
    return place


def _compile(source: str, compiler: str, place: Path) -> None:
    with tempfile.TemporaryDirectory(dir=place.parent) as folder:
        code, library = Path(folder, "code.c"), Path(folder, place.name)
        code.write_text(source, encoding="ascii")
        command = [compiler, *FLAGS, "-o", str(library), str(code)]
        try:
            _call([*command, "-march=native"])
        except subprocess.CalledProcessError:
            _call(command)
        library.replace(place)


def _call(command: list[str]) -> str:
    done = subprocess.run(command, check=True, capture_output=True, timeout=TIME_LIMIT, text=True, errors="replace")
    return done.stdout


@cache
def _compiler() -> tuple[str, str] | None:
    """Return path and version of a C compiler that knows vector types."""
    names = [os.environ[SWITCH]] if SWITCH in os.environ else ["gcc", "clang", "cc"]
    for name in names:
        path = shutil.which(name) if name else None
        if path:
            try:
                return path, _call([path, "--version"])
            except (OSError, subprocess.SubprocessError):
                continue
    return None


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


def cache_folder() -> Path:
    """Return the folder in which this version keeps what it compiled."""
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "yawdesign" / __version__

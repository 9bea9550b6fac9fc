"""Tapes that take long to make are kept in the user's cache folder; this is never a reason to fail.

Making that of a vehicle's verdict takes half a second, reading it a tenth of that. A kept tape belongs to the version
and to the sources of this package, to CasADi's version, and to what was asked for.
"""

import zipfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, wraps
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

import casadi as ca

from yawdesign.hunting.many import library_cache
from yawdesign.hunting.many.recording import packed, unpacked
from yawdesign.hunting.many.tape import Tape
from yawdesign.vehicle.vehicle import Model

T = TypeVar("T", bound=Tape | None)

ROOMS = ("problem", "vehicle", "hunting")  # on whose sources a tape depends
# Coordinates of a model, or coefficients of a polynomial, from which on a tape takes longer to make than to read. Those
# of a single bogie do not.
LARGE = {Model: 13, int: 30}
NOT_A_TAPE = (OSError, ValueError, KeyError, EOFError, NotImplementedError, zipfile.BadZipFile)


def kept(make: Callable[..., T]) -> Callable[..., T]:
    """Return a function that makes tapes, and takes large ones from the cache folder if they are there."""

    @wraps(make)
    def tape(*given: Any) -> T | Tape:
        if not any(_is_large(x) for x in given):
            return make(*given)
        key = None
        with suppress(*NOT_A_TAPE):
            key = _key(make.__name__, *given)
            if path := library_cache.find(key, library_cache.TAPE):
                return Tape(unpacked(path.read_bytes()))
        made = make(*given)
        if key and made is not None:
            with suppress(OSError):
                library_cache.keep(key, library_cache.TAPE, packed(made.recording))
        return made

    return tape  # type: ignore[return-value]


def _is_large(x: Any) -> bool:
    return len(x.coordinates) >= LARGE[Model] if isinstance(x, Model) else type(x) is int and x >= LARGE[int]


def _key(*asked: Any) -> str:
    """Return what a tape is kept under."""
    parts = [_sources(), ca.CasadiMeta.version(), *(part for x in asked for part in _told(x))]
    return sha256("\n".join(parts).encode()).hexdigest()[:20]


def _told(x: Any) -> Iterator[str]:
    """Yield what tells an argument from others, the same in every process: a set has no order of its own."""
    if isinstance(x, Model):
        yield repr((x.kind, x.equations, x.parameters, sorted(x.flags)))
    else:
        yield repr(sorted(x) if isinstance(x, frozenset) else x)


@cache
def _sources() -> str:
    """Return the digest of the sources that make tapes.

    Raises
    ------
    OSError
        If they cannot be read.
    """
    home = Path(__file__).parents[2]
    files = sorted(path for room in ROOMS for path in (home / room).rglob("*.py"))
    if not files:
        raise FileNotFoundError(f"there are no sources in {home}")
    digest = sha256()
    for path in files:
        digest.update(path.relative_to(home).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()

"""What every kind of exported file is written from: the functions, and the names of files and symbols."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from yawdesign.exports.functions import Documented, SelfTest
from yawdesign.problem import Problem, ProblemError

PREFIX = "yawdesign"
LONGEST = 30  # MATLAB and Octave cut names at 63 characters, and that of a function follows
_FORM = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
_OWN = "casadi example matrix mex selftest"
_STANDARD = (
    "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic "
    "stdbool stddef stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype"
)
TAKEN = frozenset([*_OWN.split(), *_STANDARD.split()])


@dataclass(frozen=True)
class ExportNames:
    """Names of files and symbols.

    Parameters
    ----------
    prefix : str
        What they begin with.

    Raises
    ------
    ProblemError
        If that is no beginning of a C identifier, or the name of a file that is there already.
    """

    prefix: str = PREFIX

    def __post_init__(self) -> None:
        if not isinstance(self.prefix, str) or not _FORM.fullmatch(self.prefix) or len(self.prefix) > LONGEST:
            raise ProblemError(
                f"prefix {self.prefix!r}: give a letter, then letters, digits and single underscores between them, "
                f"at most {LONGEST}, such as front_bogie"
            )
        if self.prefix.lower() in TAKEN:
            raise ProblemError(f"prefix {self.prefix} is the name of another C file: take {self.prefix}_bogie or so")

    @property
    def source(self) -> str:
        """Name of the C source."""
        return f"{self.prefix}.c"

    @property
    def header(self) -> str:
        """Name of its header."""
        return f"{self.prefix}.h"

    @property
    def guard(self) -> str:
        """The macro that is defined where the header has been read."""
        return f"{self.prefix}_H".upper()

    def symbol(self, name: str) -> str:
        """Return the C symbol of a function."""
        return f"{self.prefix}_{name}"


@dataclass(frozen=True)
class FileContents:
    """The functions of a problem with all that is written of them.

    Parameters
    ----------
    problem : Problem
        Where they come from, with the condition in its values.
    functions : mapping name -> Documented
        The functions.
    tests : mapping name -> SelfTest or None
        Their self-test vectors.
    condition : mapping
        As results have it.
    names : ExportNames
        Of the C files and their symbols.
    """

    problem: Problem
    functions: Mapping[str, Documented]
    tests: Mapping[str, SelfTest | None]
    condition: Mapping[str, Any]
    names: ExportNames = field(default_factory=ExportNames)


class Unavailable(Exception):  # noqa: N818 - no mistake of the user
    """A kind of file that cannot be written here, or not in full, with the reason; the others are written.

    Parameters
    ----------
    reason : str
        Why.
    files : tuple of str
        What was written all the same.
    """

    def __init__(self, reason: str, files: tuple[str, ...] = ()) -> None:
        super().__init__(reason)
        self.files = files

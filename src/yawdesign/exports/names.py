"""Names of the C files and their symbols, which begin with a prefix, so that several exports fit into one program."""

import re
from dataclasses import dataclass

from yawdesign.problem import ProblemError

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

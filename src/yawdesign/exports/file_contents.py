"""What every kind of exported file is written from."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from yawdesign.exports.functions import Documented, SelfTest
from yawdesign.exports.names import ExportNames
from yawdesign.problem import Problem


@dataclass(frozen=True)
class FileContents:
    """The functions of a problem with all that is written of them.

    Parameters
    ----------
    problem : Problem
        Where they come from.
    functions : mapping name -> Documented
        The functions.
    tests : mapping name -> SelfTest or None
        Their self-test vectors.
    names : ExportNames
        Of the C files and their symbols.
    """

    problem: Problem
    functions: Mapping[str, Documented]
    tests: Mapping[str, SelfTest | None]
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

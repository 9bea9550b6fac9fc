"""A problem as a page for a design review: answered, drawn and written."""

import hashlib
import json
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from os import PathLike
from pathlib import Path

from yawdesign import __version__
from yawdesign.output.report.page import page
from yawdesign.output.targets import Target, checked_targets
from yawdesign.problem import Problem
from yawdesign.problem.arguments import Progress
from yawdesign.problem.whole_files import write_whole
from yawdesign.study.design_review import DesignReview, design_review

PAGES = (".html", ".htm")
LIBRARIES = ("numpy", "scipy", "casadi", "matplotlib")


def report(
    problem: Problem,
    to: str | PathLike[str],
    *,
    replace: bool = False,
    progress: Progress = lambda text, part: None,
) -> Path:
    """Write everything that a design review asks of a problem as one HTML page, which needs nothing but itself.

    Where there is no stable or feasible design the page says so, and what to change.

    Parameters
    ----------
    problem : Problem
        With ``C_s`` as a design variable, or with its value.
    to : path
        The file to write; it ends in .html and is there as a whole or not at all.
    replace : bool
        Whether a file that is there is replaced.
    progress : callable, optional
        Called with a text and the share that is done, 0 ... 1.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ProblemError
        If C_s is neither given nor a design variable, or there is a file that may not be replaced.
    OSError
        If the page cannot be written.
    """
    path = Path(to)
    checked_targets([Target("", str(path), PAGES, replace)], [])
    review = design_review(problem, progress=progress)
    write_whole(path, rendered(review), replace=replace)
    return path


def rendered(review: DesignReview, source: Mapping[str, str] | None = None) -> bytes:
    """Return a design review as the content of a page.

    Parameters
    ----------
    review : DesignReview
        The answers.
    source : mapping, optional
        From which file the problem was read, and what was changed: names and values for the last section.
    """
    return page(review, origin(review.problem, source or {})).encode()


def origin(problem: Problem, source: Mapping[str, str]) -> dict[str, str]:
    """Return when, from what and with what a page was made."""
    written = json.dumps(problem.to_dict(), sort_keys=True).encode()
    return {
        "yawdesign": __version__,
        "made": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        **source,
        "SHA-256 of the problem as read (JSON)": hashlib.sha256(written).hexdigest(),
        "Python": f"{platform.python_version()} on {platform.system()} {platform.machine()}",
        **{name: version(name) for name in LIBRARIES},
    }


def file_source(path: Path, changes: Sequence[str] = ()) -> dict[str, str]:
    """Return the name of a problem file, the hash of its content, and what was set beside it."""
    found = {"problem file": path.name, "SHA-256 of that file": hashlib.sha256(path.read_bytes()).hexdigest()}
    return found | ({"changed by --set": "; ".join(changes)} if changes else {})

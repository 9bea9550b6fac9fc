"""The paper reproduced, and the folder that holds the page, the pictures and the rows."""

import csv
import io
import json
from os import PathLike
from pathlib import Path

from yawdesign.exports.folder import MANIFEST, check_place, exported_folder, write_text
from yawdesign.output.paper_pictures import drawing_of
from yawdesign.output.pictures import check_pictures, write_picture
from yawdesign.output.reproduction_page import page
from yawdesign.problem import Problem
from yawdesign.problem.arguments import Progress
from yawdesign.problem.result import plain
from yawdesign.study.reproduction import ROW_KEYS, Reproduction, reproduction

GENERATOR = "yawdesign reproduce"
NAME = "reproduction"
SUFFIXES = (".png", ".svg")
COMPUTED = 0.9  # share of the work


def reproduce(
    problem: Problem | None = None,
    to: str | PathLike[str] | None = None,
    *,
    force: bool = False,
    progress: Progress = lambda text, part: None,
) -> Reproduction:
    """Compute the tables, figures and equations of the paper now, beside what it prints.

    Parameters
    ----------
    problem : Problem, optional
        With another bogie, speed or curve in the place of the paper's; Table I if not given. Each row has its own
        equations; conditions, cases and requirements are not looked at.
    to : path, optional
        Folder for ``reproduction.html``, ``.csv`` and ``.json`` and the pictures ``fig2`` to ``fig5``.
    force : bool
        Replace what was written there before. Other files are never replaced.
    progress : callable
        Called with a text and the part that is done, 0 to 1.

    Returns
    -------
    Reproduction

    Raises
    ------
    ProblemError
        If the paper's equations are not written for the problem, or the folder is not empty.
    OSError
        If the folder cannot be written.

    Examples
    --------
    >>> import yawdesign as yd
    >>> result = yd.reproduce()
    >>> next(f"{row.computed:.2f} {row.deviation:.2f} %" for row in result.rows if row.what.startswith("C_sl, "))
    '90702.89 -0.03 %'
    """
    if to is None:
        return reproduction(problem, progress)
    folder = Path(to)
    check_place(folder, force=force, generator=GENERATOR)
    check_pictures(*(folder / f"{NAME}{suffix}" for suffix in SUFFIXES))
    result = reproduction(problem, lambda words, part: progress(words, COMPUTED * part))
    with exported_folder(folder, force=force, generator=GENERATOR) as beside:
        progress("pictures and page", COMPUTED)
        _write(result, beside)
    progress("done", 1.0)
    return result


def _write(result: Reproduction, folder: Path) -> None:
    files, pictures = [], {}
    for name, (title, draw) in drawing_of(result.drawn).items():
        pictures[name] = (title, draw(title))
        for suffix in SUFFIXES:
            files.append(f"{name}{suffix}")
            write_picture(pictures[name][1], folder / files[-1])
    entries = result.to_dict()
    files.append(write_text(folder / f"{NAME}.json", json.dumps(entries, indent=1, ensure_ascii=False) + "\n"))
    files.append(write_text(folder / f"{NAME}.csv", _table(result)))
    files.append(write_text(folder / f"{NAME}.html", page(result, pictures)))
    manifest = {"generator": GENERATOR, "version": result.version, "files": [*files, MANIFEST]}
    write_text(folder / MANIFEST, json.dumps(manifest, indent=1) + "\n")


def _table(result: Reproduction) -> str:
    out = io.StringIO()
    rows = csv.DictWriter(out, ROW_KEYS, lineterminator="\n")
    rows.writeheader()
    rows.writerows(plain(row) for row in result.rows)
    return out.getvalue()

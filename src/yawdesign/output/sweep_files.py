"""Files that a sweep leaves behind, and what becomes of it when one cannot be written."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp

from yawdesign.output.pictures import PICTURES, check_pictures, write_picture
from yawdesign.output.plots import plot as draw
from yawdesign.output.streams import ANSWER
from yawdesign.output.sweep_plots import check_drawn
from yawdesign.output.targets import Target, checked_targets, workbook_target
from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.problem.stopping import held, let_through
from yawdesign.study.axes import Axis
from yawdesign.study.result import Sweep
from yawdesign.study.sweep import IncompleteSweepError

MOST_KEPT = 100  # files of one name; then the system's temporary folder is used


class RescuedError(Exception):
    """A sweep that did not come to its end, or was not written or shown; its text says where it is kept.

    Parameters
    ----------
    text : str
        What happened, and how to go on.
    reason : BaseException
        What happened: the error, or somebody's request to stop.
    """

    def __init__(self, text: str, reason: BaseException) -> None:
        super().__init__(text)
        self.reason = reason


@dataclass(frozen=True)
class Outputs:
    """Names of the files to write.

    Parameters
    ----------
    csv, npz, picture, workbook : Path or None
        Table, arrays, picture and workbook.
    resume : Path or None
        File that keeps the finished points anyway.
    problem_file : str
        After which a file is named that keeps them if something breaks.
    replace : bool
        Whether tables, arrays, pictures and workbooks that are there are replaced.
    """

    csv: Path | None
    npz: Path | None
    picture: Path | None
    workbook: Path | None
    resume: Path | None
    problem_file: str
    replace: bool

    @classmethod
    def checked(
        cls,
        problem_file: str,
        axes: Sequence[Axis],
        *,
        csv: str | None,
        npz: str | None,
        plot: str | None,
        xlsx: str | None,
        resume: str | None,
        force: bool,
    ) -> "Outputs":
        """Return the names of the files if they can be written: better now than after the work."""
        mistakes = Mistakes()
        with mistakes.under(""):
            targets = (
                Target("--csv", csv, replaced=force),
                Target("--npz", npz, replaced=force),
                Target("--plot", plot, PICTURES, replaced=force),
                workbook_target(xlsx, force),
                Target("--resume", resume, replaced=True),  # a file of another sweep is refused when it is read
            )
            checked_targets(targets, [problem_file])
        names = (csv, npz, plot, xlsx, resume)
        table, arrays, picture, workbook, kept = (Path(name) if name else None for name in names)
        with mistakes.under("--plot"):
            if picture is not None:
                check_drawn(axes)
                check_pictures(picture)
        mistakes.report()
        return cls(table, arrays, picture, workbook, kept, problem_file, force)

    def write(self, sweep: Sweep) -> None:
        """Write all files; if one cannot be drawn or written, the others are, and the first error is raised."""
        errors: list[Exception] = []
        for path, write in (
            (self.csv, sweep.to_csv),
            (self.npz, sweep.to_npz),
            (self.picture, lambda path, *, replace: write_picture(draw(sweep), path, replace=replace)),
            (self.workbook, sweep.to_excel),
        ):
            try:
                if path is not None:
                    with let_through():
                        write(path, replace=self.replace)
            except Exception as error:  # noqa: BLE001 - the other files are written, and this error is raised
                errors.append(error)
        if errors:
            raise errors[0]

    @contextmanager
    def rescuing(self, sweep: Sweep | None = None) -> Iterator[None]:
        """Keep what is finished of a sweep that does not come to its end, or a whole one if the block fails.

        Parameters
        ----------
        sweep : Sweep, optional
            What the block writes and shows.

        Raises
        ------
        RescuedError
            In place of what happened.
        """
        try:
            yield
        except IncompleteSweepError as error:
            reason = error.__cause__ if error.interrupted and error.__cause__ else error
            raise RescuedError(self._rescued(error.result, error.reason), reason) from None
        except (KeyboardInterrupt, Exception) as error:  # whatever it is, it may not cost the sweep
            if sweep is None:
                raise
            raise RescuedError(self._rescued(sweep, _unwritten(error)), error) from None

    def _rescued(self, sweep: Sweep, reason: str) -> str:
        """Keep a sweep where there is room for it, and return what to tell; requests to stop wait."""
        if not sweep.finished.any():
            return f"error: {reason}"
        with held():
            for path in self._places():
                try:
                    sweep.keep(path)
                except (OSError, ProblemError):  # no room, or a file of another sweep
                    continue
                again = f"repeat the command with --resume {path}{self._force()}"
                return f"error: {reason}\nAll that is finished is in {path}: {again}"
        return f"error: {reason}\nIt could not be kept, neither here nor in the system's temporary folder: make room"

    def _places(self) -> Iterator[Path]:
        if self.resume is not None:
            yield self.resume
        stem = f"{'problem' if self.problem_file == '-' else Path(self.problem_file).stem}.sweep"
        for k in range(1, MOST_KEPT):
            yield Path(f"{stem}.npz" if k == 1 else f"{stem}-{k}.npz")
        try:
            yield Path(mkdtemp(prefix="yawdesign-"), f"{stem}.npz")  # nobody else can write there
        except OSError:
            return

    def _force(self) -> str:
        """Return what allows the repeated command to replace the files that this one has written."""
        written = any(path is not None and path.is_file() for path in (self.csv, self.npz, self.picture, self.workbook))
        return " --force" if written else ""


def _unwritten(error: BaseException) -> str:
    if isinstance(error, KeyboardInterrupt):
        return f"it was stopped ({error})"
    if isinstance(error, OSError):
        return f"{error.filename or ANSWER} could not be written: {error.strerror}"
    if isinstance(error, ProblemError):
        return f"the results could not be written: {str(error).removeprefix('error: ')}"
    return f"the results could not be shown: {type(error).__name__}: {error}"

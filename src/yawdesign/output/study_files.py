"""Files that a sweep leaves behind, and what becomes of it when one cannot be written."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import gettempdir

from yawdesign.output.plots import PICTURES, write_picture
from yawdesign.output.plots import plot as draw
from yawdesign.problem import ProblemError
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.study.result import Sweep


@dataclass(frozen=True)
class Outputs:
    """Names of the files to write.

    Parameters
    ----------
    csv, npz, picture : Path or None
        Table, arrays and picture.
    kept : Path
        Where the finished points go if something breaks.
    """

    csv: Path | None
    npz: Path | None
    picture: Path | None
    kept: Path

    @classmethod
    def checked(
        cls,
        problem_file: str,
        axes: Sequence[str],
        *,
        csv: str | None,
        npz: str | None,
        plot: str | None,
        resume: str | None,
    ) -> "Outputs":
        """Return the names of the files if they can be written: better now than after the work."""
        names = {"--csv": csv, "--npz": npz, "--plot": plot, "--resume": resume}
        mistakes = Mistakes()
        for option, name in names.items():
            with mistakes.under(option):
                if name is not None and not Path(name).absolute().parent.is_dir():
                    raise ProblemError(f"there is no folder {Path(name).parent}")
        with mistakes.under("--plot"):
            if plot is not None and Path(plot).suffix.lower() not in PICTURES:
                raise ProblemError(f"{plot} does not end in {', '.join(PICTURES)}")
            if plot is not None and len(axes) > 2:
                raise ProblemError("a picture has one or two axes")
        mistakes.report()
        kept = resume or f"{Path(problem_file).stem}.sweep.npz"
        csv_path, npz_path, picture = (None if name is None else Path(name) for name in (csv, npz, plot))
        return cls(csv_path, npz_path, picture, Path(kept))

    def write(self, sweep: Sweep) -> None:
        """Write all files; if one cannot be written, the others are, and the first error is raised."""
        errors = []
        for path, write in (
            (self.csv, sweep.to_csv),
            (self.npz, sweep.to_npz),
            (self.picture, lambda path: write_picture(draw(sweep), path)),
        ):
            try:
                if path is not None:
                    write(path)
            except OSError as error:
                errors.append(error)
        if errors:
            raise errors[0]

    def rescued(self, sweep: Sweep, reason: str) -> str:
        """Keep a sweep where there is room for it, and return what to tell."""
        for path in (self.kept, Path(gettempdir()) / self.kept.name):
            try:
                sweep.keep(path)
            except OSError:
                continue
            return f"error: {reason}\nAll that is finished is in {path}: repeat the command with --resume {path}"
        return f"error: {reason}\nIt could not be kept in {self.kept} either: make room"

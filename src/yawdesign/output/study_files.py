"""Files that a sweep leaves behind, and what becomes of it when one cannot be written."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import gettempdir

from yawdesign.output.plots import picture_target, write_picture
from yawdesign.output.plots import plot as draw
from yawdesign.output.study_plots import check_drawn
from yawdesign.output.targets import target
from yawdesign.problem.diagnostics import Mistakes
from yawdesign.study.axes import Axis
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
        axes: Sequence[Axis],
        *,
        csv: str | None,
        npz: str | None,
        plot: str | None,
        resume: str | None,
    ) -> "Outputs":
        """Return the names of the files if they can be written: better now than after the work."""
        mistakes, paths = Mistakes(), {}
        for option, name in {"--csv": csv, "--npz": npz, "--plot": plot, "--resume": resume}.items():
            with mistakes.under(option):
                check = picture_target if option == "--plot" else target
                paths[option] = None if name is None else check(name)
        with mistakes.under("--plot"):
            if plot is not None:
                check_drawn(axes)
        mistakes.report()
        kept = paths["--resume"] or Path(f"{Path(problem_file).stem}.sweep.npz")
        return cls(paths["--csv"], paths["--npz"], paths["--plot"], kept)

    def write(self, sweep: Sweep) -> None:
        """Write all files; if one cannot be drawn or written, the others are, and the first error is raised."""
        errors = []
        for path, write in (
            (self.csv, sweep.to_csv),
            (self.npz, sweep.to_npz),
            (self.picture, lambda path: write_picture(draw(sweep), path)),
        ):
            try:
                if path is not None:
                    write(path)
            except Exception as error:  # noqa: BLE001 - whatever it is, it may not cost the other files
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

"""The option by which a command draws its answer, and what is said of the files that a command has written."""

from pathlib import Path
from typing import Annotated, Any

import typer

from yawdesign.output.streams import tell

Plot = Annotated[str | None, typer.Option(metavar="FILE", help="Draw a picture: .png, .pdf or .svg.")]


def checked_picture(file: str, plot: str | None, force: bool) -> Path | None:
    """Return the path of the picture if it can be drawn and written: better known now than after the work."""
    if plot is None:
        return None
    from yawdesign.output.pictures import PICTURES, check_pictures
    from yawdesign.output.targets import Target, checked_targets

    (path,) = checked_targets([Target("--plot", plot, PICTURES, replaced=force)], [file])
    check_pictures(path)
    return path


def write_drawing(result: Any, path: Path | None, force: bool, **options: Any) -> None:
    """Draw a result into a file, if there is one, and say so; where there is nothing to draw, say that and go on."""
    if path is None:
        return
    from yawdesign.output.pictures import NothingToDrawError, write_picture
    from yawdesign.output.plots import plot

    try:
        write_picture(plot(result, **options), path, replace=force)
        tell_written(path)
    except NothingToDrawError as error:
        tell(f"note: {path} is not written: {error.diagnostics[0].message}")


def tell_written(*paths: Path | None) -> None:
    """Say which files were written."""
    for path in filter(None, paths):
        tell(f"wrote {path}")

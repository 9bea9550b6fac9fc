"""What every picture needs: axes to draw into, texts that Matplotlib sets itself, and the file it is written to."""

import io
import textwrap
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unicodedata import category

from yawdesign.hunting.chosen_condition import other_condition_in_words
from yawdesign.output.style import HEIGHT, SETTINGS, WIDTH
from yawdesign.problem import ProblemError
from yawdesign.problem.stopping import held
from yawdesign.problem.whole_files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PICTURES = (".png", ".pdf", ".svg")
ANIMATIONS = (".gif", ".svg")
WRITTEN_BY = {".png": "agg", ".gif": "agg", ".pdf": "pdf", ".svg": "svg"}  # backends of Matplotlib
DOTS_PER_INCH = 150
LINE = 80  # signs of a title that fit into one line
# Whatever a user's matplotlibrc says: the texts hold Matplotlib's own mathematics, which LaTeX does not understand.
TEXTS = {"text.usetex": False, "text.parse_math": True, **SETTINGS}


@contextmanager
def own_texts() -> Iterator[None]:
    """Let Matplotlib set the texts that are made meanwhile, and draw in the style of this package."""
    import matplotlib

    with matplotlib.rc_context(TEXTS), warnings.catch_warnings():  # type: ignore[arg-type]
        warnings.filterwarnings("ignore", "Glyph .* missing from font")  # a box stands there
        yield


def literal(text: str) -> str:
    """Return a text as Matplotlib shows it letter by letter: what users write is no mathematics.

    Examples
    --------
    >>> literal("costs $5") == "costs " + chr(92) + "$5"
    True
    """
    shown = (sign if sign.isprintable() or category(sign) == "Zs" else "?" for sign in text)
    return "".join(shown).replace("$", r"\$")


def with_condition(title: str, condition: Mapping[str, Any]) -> str:
    """Return a title with the condition of a result in a line below, unless its values are as written."""
    return "\n".join(filter(None, (title, literal(other_condition_in_words(condition)))))


def under_conditions(title: str, conditions: str, line: int = LINE) -> str:
    """Return a title that says under which conditions it holds, in lines that fit into a picture."""
    return textwrap.fill(f"{title}, under {literal(conditions)}", line)


def check_pictures(*paths: Path | None) -> None:
    """Raise a ProblemError if there are pictures to draw, and Matplotlib does not start.

    Requests to stop wait: in the middle of its start they would end as errors of Matplotlib.
    """
    for path in filter(None, paths):
        try:
            with held():
                import_module("matplotlib.figure")
                import_module(f"matplotlib.backends.backend_{WRITTEN_BY[path.suffix.lower()]}")
        except Exception as error:  # noqa: BLE001 - a faulty setting of the user's shows itself in many ways
            raise ProblemError(f"{path} cannot be drawn, Matplotlib does not start: {error}") from None


def write_picture(axes: "Axes", path: Path, *, replace: bool = False) -> None:
    """Write the figure of some axes as in `whole_file`; the ending of the name, one of `PICTURES`, tells how."""
    content = io.BytesIO()
    figure: Any = axes.get_figure(root=True)
    with own_texts():
        figure.savefig(content, format=path.suffix[1:].lower(), dpi=DOTS_PER_INCH)
    write_whole(path, content.getvalue(), replace=replace)


def new_axes(ax: "Axes | None") -> "Axes":
    """Return the axes given, or those of a new figure that no window shows."""
    if ax is not None:
        return ax
    from matplotlib.figure import Figure

    return Figure(figsize=(WIDTH, HEIGHT), layout="constrained").add_subplot()

"""What every picture needs: axes to draw into, texts that Matplotlib sets itself, and the file it is written to."""

import io
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from itertools import chain, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unicodedata import category

from yawdesign.hunting.chosen_condition import other_condition_in_words
from yawdesign.output.minus import with_minus
from yawdesign.output.style import HEIGHT, SETTINGS, WIDTH
from yawdesign.problem import PARAMETERS, ProblemError, format_quantity
from yawdesign.problem.stopping import held
from yawdesign.problem.whole_files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

PICTURES = (".png", ".pdf", ".svg")
ANIMATIONS = (".gif", ".svg")
WRITTEN_BY = {".png": "agg", ".gif": "agg", ".pdf": "pdf", ".svg": "svg"}  # backends of Matplotlib
DOTS_PER_INCH = 150
BLANK = "\u00a0"  # at which no line ends
SIGN, SMALL_SIGN, MARGIN = 6.0, 5.1, 62.0  # width of a sign, of one of a legend, of what stands left of the axes [pt]
HANDLE, MOST_COLUMNS = 42.0, 4  # width of a mark of a legend with the spaces beside it [pt]; columns side by side
LARGE = 1000.0  # from where on digits stand in groups
WIDEST = 200.0  # ratio up to which a logarithmic axis has numbers between the powers of ten
# Where no line ends: before a unit, inside of a range.
_TOGETHER = re.compile(r"(?<=[\d=]) (?=[\w%])|(?<=\$) (?==)|(?<=\d) (?=\.\.\. )|(?<= \.\.\.) (?=\d)")
# Whatever a user's matplotlibrc says: the texts hold Matplotlib's own mathematics, which LaTeX does not understand.
TEXTS = {"text.usetex": False, "text.parse_math": True, **SETTINGS}


class NothingToDrawError(ProblemError):
    """An answer that has nothing of what its picture shows."""


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


def quantity(name: str, value: float, digits: int = 4) -> str:
    r"""Return a parameter and its value for a picture: its symbol as in equations, in the unit in which people see it.

    Examples
    --------
    >>> print(quantity("C_s", 1e6))
    $C_\mathrm{s}$ = 1 000 kN·s/m
    """
    row = PARAMETERS[name]
    return f"${row.symbol}$ = {format_quantity(value, row.unit, digits)}"


def put_title(ax: "Axes", title: str, condition: Mapping[str, Any] | None = None, *, left: float = MARGIN) -> None:
    """Set a title above the left end of some axes, with the condition of a result below, in lines that fit."""
    set_title(ax, title if condition is None else with_condition(title, condition), left=left)


def with_condition(title: str, condition: Mapping[str, Any]) -> str:
    """Return a title with the condition of a result: in a line below, or that its values are as written."""
    other = literal(other_condition_in_words(condition))
    return f"{title}\n{other}" if other else f"{title}, values{BLANK}as{BLANK}written"


def set_title(ax: "Axes", title: str, conditions: str = "", *, left: float = MARGIN, pad: float | None = None) -> None:
    """Set a title, and under which conditions it holds, in lines that fit into the picture.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Above which it stands.
    title, conditions : str
        What to tell; conditions as users write them.
    left : float
        How much room what stands left of the axes takes [pt].
    pad : float, optional
        How far above the axes it stands [pt].
    """
    text = f"{title}, under {literal(conditions)}" if conditions else title
    together = _TOGETHER.sub(BLANK, text)
    lines = wrapped(together, max(20, int((_room(ax) - left) / SIGN))).replace(BLANK, " ")
    ax.set_title(with_minus(lines), loc="left", fontsize="medium", pad=pad)


def wrapped(text: str, signs: int) -> str:
    r"""Return a text in lines of at most so many signs, as they are seen: mathematics is set in fewer.

    Examples
    --------
    >>> wrapped(r"yaw damping $C_\mathrm{s}$ [N s/m]", 14).splitlines()[0]
    'yaw damping $C_\\mathrm{s}$'
    """
    return "\n".join(line for whole in text.split("\n") for line in _lines(whole, signs))


def _lines(text: str, signs: int) -> list[str]:
    lines = [""]
    for word in chain.from_iterable(_parts(whole, signs) for whole in text.split(" ")):
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if lines[-1] and len(_seen(longer)) > signs:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def _parts(word: str, signs: int) -> list[str]:
    """Return a word that is too long for a line in parts; mathematics stays together."""
    letters = re.findall(r"\\.|.", word, re.DOTALL)
    if len(letters) <= signs or "$" in letters:
        return [word]
    return ["".join(letters[k : k + signs]) for k in range(0, len(letters), signs)]


def _seen(text: str) -> str:
    """Return about what is seen of a text with mathematics."""
    return re.sub(r"\\[a-z]+|[\\${}_]", "", text.replace(r"\mathrm", ""))


def _room(ax: "Axes") -> float:
    """Return the width that belongs to some axes, or those they are a part of, and what stands beside them [pt]."""
    figure: Any = ax.get_figure(root=True)
    place = ax.get_subplotspec()
    width = ax.get_position().width if place is None else place.get_topmost_subplotspec().get_position(figure).width
    pars = figure.subplotpars
    return float(72.0 * figure.get_figwidth() * min(1.0, width / (pars.right - pars.left)))


def legend_below(ax: "Axes", handles: "list[Any] | None" = None, *, left: float = MARGIN) -> int:
    """Explain a picture below it, where it covers nothing, in as many columns as fit; return how many lines it takes.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        With its labels already set.
    handles : list, optional
        What is explained; what has a label, if not given.
    left : float
        How much room what stands left of the axes takes [pt].
    """
    from matplotlib.transforms import ScaledTranslation

    handles = ax.get_legend_handles_labels()[0] if handles is None else handles
    if not handles:
        return 0
    under = 26 + 13 * (1 + ax.get_xlabel().count("\n")) if ax.get_xlabel() else 20
    figure = ax.get_figure(root=True)
    place = ax.transAxes + ScaledTranslation(0, -under / 72, figure.dpi_scale_trans)  # type: ignore[union-attr]
    room = _room(ax) - left
    signs = max(20, int((room - HANDLE) / SMALL_SIGN))
    labels = [wrapped(with_minus(str(handle.get_label())), signs) for handle in handles]
    widths = [max(len(_seen(line)) for line in label.split("\n")) for label in labels]
    count = _columns(widths, room)
    ax.legend(
        handles=handles,
        labels=labels,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=place,
        ncols=count,
        borderaxespad=0.0,
        columnspacing=1.6,
        handlelength=2.4,
    )
    rows = -(-len(labels) // count)
    return max(sum(1 + x.count("\n") for x in labels[k : k + rows]) for k in range(0, len(labels), rows))


def _columns(signs: list[int], room: float) -> int:
    """Return into how many columns the entries of a legend fit."""
    for count in range(min(MOST_COLUMNS, len(signs)), 1, -1):
        rows, longer = divmod(len(signs), count)
        ends = [k * rows + min(k, longer) for k in range(count + 1)]  # the first columns are the longer ones
        if sum(max(signs[a:b]) * SMALL_SIGN + HANDLE for a, b in pairwise(ends)) <= room:
            return count
    return 1


def grouped(value: float) -> str:
    r"""Return a number beside an axis with its digits in groups of three.

    Examples
    --------
    >>> grouped(12500.0), grouped(0.05), grouped(-5.0) == chr(0x2212) + "5"
    ('12 500', '0.05', True)
    """
    return f"{value:,.6g}".replace(",", " ").replace("-", "\u2212")


def large_numbers(axis: "Axis") -> None:
    """Write the numbers beside an axis, its limits set, in groups of three where they are large."""
    if max(map(abs, axis.get_view_interval())) >= LARGE:
        axis.set_major_formatter(lambda value, _: grouped(value))


def log_axis(ax: "Axes", *, upright: bool = False) -> None:
    """Give an axis, its limits set, a logarithmic scale with numbers that people read: 10, 20, 50, 100, 1 000."""
    (ax.set_yscale if upright else ax.set_xscale)("log")
    axis = ax.yaxis if upright else ax.xaxis
    low, high = sorted(axis.get_view_interval())
    log_numbers(axis, few=high < WIDEST * low)


def log_numbers(axis: "Axis", *, few: bool) -> None:
    """Write numbers that people read beside a logarithmic axis, in few decades more of them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: grouped(value)))
    axis.set_minor_locator(LogLocator(subs=tuple(range(1, 10))))
    axis.set_minor_formatter(NullFormatter())


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

"""Labels of marks along an axis: beside each other where they fit, above each other where they do not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STEP, GAP = 13.0, 6.0  # between two lines of labels, beside a label [pt]


@dataclass(frozen=True)
class MarkLabel:
    """A label of a mark.

    Parameters
    ----------
    x : float
        Where the mark is, in data.
    text, colour : str
        Of the label.
    """

    x: float
    text: str
    colour: str


def draw_labels(ax: "Axes", labels: Sequence[MarkLabel], first: float) -> float:
    """Write labels above axes over their marks, in as many lines as they need; none leaves the axes' sides.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Laid out already.
    labels : sequence of MarkLabel
        What to write.
    first : float
        How far above the axes the first line is [pt].

    Returns
    -------
    float
        How much room the lines take [pt].
    """
    ends: list[float] = []  # of each line, where its last label ends
    frame, place = ax.get_window_extent(), ax.get_xaxis_transform()
    point = ax.get_figure(root=True).dpi / 72  # type: ignore[union-attr]
    for label in sorted(labels, key=lambda label: label.x):
        look: dict[str, Any] = {"ha": "left", "va": "bottom", "fontsize": "small", "color": label.colour}
        note = ax.annotate(
            label.text,
            (label.x, 1.0),
            (0, 0),
            xycoords=place,
            textcoords="offset points",
            annotation_clip=False,
            **look,
        )
        box = note.get_window_extent()
        start = min(max(box.x0 - box.width / 2, frame.x0), max(frame.x0, frame.x1 - box.width))
        line = next((k for k, end in enumerate(ends) if start > end), len(ends))
        ends[line:] = [start + box.width + GAP * point, *ends[line + 1 :]]
        note.set_position(((start - box.x0) / point, first + STEP * line))
    return first + STEP * len(ends) if ends else 0.0


def write_inside(ax: "Axes", row: float, start: float, stop: float, text: str, marks: Sequence[float]) -> None:
    """Write a text at the lower end of a bar inside it, where there is room between the marks.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Laid out already.
    row : float
        Ordinate of the bar.
    start, stop : float
        Its ends, in data.
    text : str
        What to write.
    marks : sequence of float
        Where lines cross it, in data.
    """
    note = ax.annotate(text, (start, row), (3, 0), textcoords="offset points", va="center", fontsize="small")
    box = note.get_window_extent()
    crossed = [ax.transData.transform((x, row))[0] for x in (stop, *(x for x in marks if x > start * (1 + 1e-6)))]
    if box.x1 + 1 > min(crossed):
        note.remove()

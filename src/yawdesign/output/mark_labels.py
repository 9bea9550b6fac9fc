"""Labels of marks along an axis: beside each other where they fit, above each other where they do not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from yawdesign.output.minus import with_minus
from yawdesign.output.style import halo

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
            with_minus(label.text),
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
    """Write a text at the lower end of a bar: inside it, or before it where a mark leaves no room; else not at all.

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
    look: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": "small"}
    lines = sorted(ax.transData.transform((x, row))[0] for x in marks)
    first, last = (ax.transData.transform((x, row))[0] for x in (start, stop))
    for side, align in ((3, "left"), (-3, "right")):
        note = ax.annotate(text, (start, row), (side, 0), ha=align, path_effects=halo(), **look)
        box = note.get_window_extent()
        low, high = (first, min(last, ax.bbox.x1)) if side > 0 else (ax.bbox.x0, first)
        struck = any(box.x0 - 1 < x < box.x1 + 1 for x in lines)
        if low <= box.x0 and box.x1 + 1 <= high and not struck:
            return
        note.remove()

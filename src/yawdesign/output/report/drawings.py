"""Pictures that stand in this page only: bars by name, marks on maps, two curves beside each other."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from yawdesign.hunting.chosen_condition import condition_in_words
from yawdesign.output import style
from yawdesign.output.minus import with_minus
from yawdesign.output.pictures import legend_below, literal, new_axes, own_texts
from yawdesign.output.sweep_style import axis_label, axis_values
from yawdesign.problem import to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.study.result import Sweep

BAR, LINE, AROUND = (
    0.16,
    0.16,
    1.0,
)  # heights [inch] of a bar, a line of its name, and of what stands around all of them
SIGNS, LINES = 44, 3  # of a name: in a line, and how many lines are shown of what users name at length
ROOM = 0.2  # for the numbers beside the bars, in the width of the picture


def bars(names: Sequence[str], values: Sequence[float], label: str, texts: Sequence[str], below: str) -> "Axes":
    """Draw values by name, the first on top, each with its number.

    Those below zero are hatched, as what they are: `below` is the colour of an area or `LESS`.
    """
    names = ["\n".join(map(_shortened, name.split("\n"))) for name in names]
    with own_texts():
        ax = new_axes(None)
        negative = style.LESS_BAR if below == style.LESS else style.area(below)
        lines = max(name.count("\n") for name in names) + 1
        ax.get_figure(root=True).set_size_inches(style.WIDTH, AROUND + (BAR + LINE * lines) * len(names))  # type: ignore[union-attr]
        ax.spines["left"].set_visible(False)
        ax.tick_params(axis="y", length=0)
        for row, (value, text) in enumerate(zip(values, texts, strict=True)):
            look = negative if value < 0 else {"facecolor": style.CHOSEN}
            ax.barh(row, value, height=0.62, **look)
            side, align = (4, "left") if value >= 0 else (-4, "right")
            ax.annotate(
                with_minus(text),
                (value, row),
                (side, 0),
                textcoords="offset points",
                ha=align,
                va="center",
                fontsize="small",
            )
        ax.axvline(0, color=style.LIMIT, linewidth=0.8)
        ax.set_yticks(
            range(len(names)), ["\n".join(map(literal, name.split("\n"))) for name in names], fontsize="small"
        )
        ax.set(ylim=(len(names) - 0.4, -0.6), xlabel=label)
        low, high = min(0.0, *values), max(0.0, *values)
        ax.set_xlim(low - ROOM * (high - low) * (low < 0), high + ROOM * (high - low) * (high > 0))
    return ax


def _shortened(name: str) -> str:
    return "\n".join(textwrap.wrap(name, SIGNS, max_lines=LINES, placeholder=" ..."))


MARKS: dict[str, dict[str, Any]] = {
    "design": {"marker": "D", "markersize": 8, "markerfacecolor": style.CHOSEN, "markeredgecolor": style.HALO},
    "before": {"marker": "s", "markersize": 7, "markerfacecolor": style.HALO, "markeredgecolor": style.BEFORE},
    "condition": {"marker": "o", "markersize": 4, "markerfacecolor": style.LIMIT, "markeredgecolor": style.HALO},
}


def marked(ax: "Axes", kind: str, points: Sequence[tuple[float, float]], **more: Any) -> "Axes":
    """Mark points of a picture by the sign of a kind, one of `MARKS`; `more` goes to Matplotlib.

    Points outside the axes are left out: a sign that stands there takes the room of the whole picture.
    """
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    whole = "transform" in more  # whose ordinate is a share of the axes
    inside = [(x, y) for x, y in points if left <= x <= right and (whole or low <= y <= high)]
    if not inside:
        return ax
    with own_texts():
        x, y = zip(*inside, strict=True)
        ax.plot(x, y, linestyle="none", zorder=5, clip_on=False, **MARKS[kind], **more)
        if "label" in more:
            legend_below(ax)
    return ax


def of_design(ax: "Axes") -> "Axes":
    """Call what is as written by its name in this page: there the design stands in the place of the problem."""
    from matplotlib.text import Text

    for each in ax.findobj(Text):
        text: Any = each
        text.set_text(text.get_text().replace("values as written", "as written").replace("as written", "this design"))
    return ax


def under_words(condition: Mapping[str, Any]) -> str:
    """Return the condition of a result of the design in words."""
    return condition_in_words(condition).replace("values as written", "values of this design")


def curves_over(sweeps: "Sequence[Sweep]", names: Sequence[str], unit: str, label: str) -> "Axes":
    """Draw the values of sweeps over the same axis."""
    with own_texts():
        ax = new_axes(None)
        for k, (sweep, name) in enumerate(zip(sweeps, names, strict=True)):
            x, y = axis_values(sweep.axes[0]), sweep.main * to_unit(1.0, unit)
            ax.plot(x, y, label=name, **style.line_of(k))
        ax.set(xlim=(x[0], x[-1]), xlabel=axis_label(sweeps[0].axes[0]), ylabel=f"{label} [{unit}]")
        ax.set_ylim(bottom=0)
        ax.grid(visible=True)
        legend_below(ax)
    return ax

"""Picture of a forward design: an axis of the yaw damping, what is stable on it, the curve's limit and the choice."""

from collections.abc import Sequence
from itertools import pairwise
from math import inf, log
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.output.condition_texts import condition_text
from yawdesign.output.mark_labels import MarkLabel, draw_labels, write_inside
from yawdesign.output.pictures import MARGIN, legend_below, literal, log_axis, new_axes, set_title
from yawdesign.output.style import BECOMES, CHOSEN, CHOSEN_LINE, EXCLUDED, LIMIT, LIMIT_LINE, STABLE, UNSTABLE, area
from yawdesign.output.tables import critical_shown
from yawdesign.problem import format_quantity, to_unit
from yawdesign.problem.quantities import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.damper.forward import Critical, ForwardDesign

Intervals = Sequence[tuple[float, float]]

DAMPING = to_unit(1.0, "kN·s/m")
ASIDE = 3.0  # how far the axis goes beyond the marks, as a ratio
BAR = 0.7  # height of the bars, of a row
HEIGHT, ROW = 2.4, 0.24  # of a picture with one bar, of each one more [inch]
LOWEST_ROW, AROUND = 13.0, 75.0  # [pt], in which a condition can still be read; of title, labels and legend
SIGNS_OF_ROW, LETTER = 38, 5.0  # of a condition's name, and their width [pt]


def draw_design(result: "ForwardDesign", ax: "Axes | None" = None, *, beside: Sequence[float] = ()) -> "Axes":
    """Draw the stable intervals of the yaw damping, its critical values, the curve's limit and the choice.

    Parameters
    ----------
    result : ForwardDesign
        Of `yawdesign.design`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; 7 x 2.2 inch are enough. Of many conditions those are drawn for which there is room.
    beside : sequence of float
        Other values of C_s that the axis has room for [N s/m].
    """
    rows = _rows(result)
    given, ax = ax, new_axes(ax)
    figure: Any = ax.get_figure(root=True)
    if given is None:
        figure.set_size_inches(figure.get_figwidth(), HEIGHT + ROW * len(rows))
    else:
        rows = _nearest(result, rows, int((_points(ax) - AROUND) / LOWEST_ROW) - 1)
    low, high = _ends(result, beside)
    ax.set(xlim=(low, high), xlabel=r"damping of the pair of yaw dampers $C_\mathrm{s}$ [kN·s/m]")
    log_axis(ax)
    bars = [(_every(result, rows) or "this vehicle", result.stable_intervals), *rows]
    for k, (_, intervals) in enumerate(bars):
        _bar(ax, k, intervals, result.C_su)
    names = [name for name, _ in bars] if rows else []
    ax.set_yticks(range(len(names)), [literal(name) for name in names], fontsize="small")
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    ax.set_ylim(len(rows) + BAR / 2 + 0.1, -BAR / 2 - 0.1)
    marks = _marks(ax, result)
    title = f"Forward design: {result.status}".replace("C_s", r"$C_\mathrm{s}$")
    left = max((LETTER * len(name) for name in names), default=0.0) + MARGIN / 2
    set_title(ax, title, result.searched, left=left)
    legend_below(ax)
    figure.draw_without_rendering()  # lays out, so that labels find their places
    left = ax.get_window_extent().x0 * 72 / figure.dpi
    set_title(ax, title, result.searched, left=left, pad=draw_labels(ax, marks, 3.0) + 5.0)
    for k, (_, intervals) in enumerate(bars):
        for start, stop in intervals:
            if start > 0 and not (k == 0 and start == result.C_sl):
                at = [mark.x for mark in marks]
                text = " ... ".join(format_number(end * DAMPING, 4) for end in (start, stop) if end < inf)
                write_inside(ax, k, start * DAMPING, min(stop * DAMPING, high), text, at)
    return ax


def _points(ax: "Axes") -> float:
    """Return the height of axes [pt]."""
    return float(ax.get_window_extent().height * 72 / ax.get_figure(root=True).dpi)  # type: ignore[union-attr]


def _damping(value: float) -> str:
    return format_quantity(value, "kN·s/m", 4)


def _ends(result: "ForwardDesign", beside: Sequence[float]) -> tuple[float, float]:
    marks = [x.C_s for x in critical_shown(result)]
    marks += [x for x in (result.C_su, result.C_s, *beside) if x is not None and x > 0]
    marks = [x * DAMPING for x in marks] or [1000.0]
    return min(marks) / ASIDE, max(marks) * ASIDE


def _conditions(result: "ForwardDesign") -> dict[str, list["Critical"]]:
    """Return the critical values under each condition that has any."""
    out: dict[str, list[Critical]] = {}
    for x in result.critical:
        out.setdefault(condition_text(x.condition), []).append(x)
    return out


def _rows(result: "ForwardDesign") -> list[tuple[str, Intervals]]:
    """Return what is stable under each condition, of many under those that are nearest to the ends of the intervals."""
    each, rows = _conditions(result), []
    shown = dict.fromkeys(condition_text(x.condition) for x in critical_shown(result))
    if len(each) > 1:
        rows = [(_short(name), _intervals(each[name])) for name in shown]
    if result.single_bogie is not None:
        rows.append(("one bogie, car body standing still", result.single_bogie.stable_intervals))
    return rows


def _every(result: "ForwardDesign", rows: Sequence[tuple[str, Intervals]]) -> str:
    """Return the name of what is stable under every condition; it says how many stand below, if not all do."""
    names = [_short(name) for name in _conditions(result)]
    shown = sum(name in names for name, _ in rows)
    every = "every condition" if shown == len(names) else f"every condition ({shown} shown)"
    return every if len(names) > 1 else ""


def _nearest(result: "ForwardDesign", rows: list[tuple[str, Intervals]], count: int) -> list[tuple[str, Intervals]]:
    """Return so many rows: those with an end that is nearest to where the design becomes stable."""
    place = result.C_sl or 1.0

    def distance(k: int) -> float:
        ends = [end for interval in rows[k][1] for end in interval if 0 < end < inf]
        return min((abs(log(end / place)) for end in ends), default=inf)

    return [rows[k] for k in sorted(sorted(range(len(rows)), key=distance)[: max(0, count)])]


def _short(name: str) -> str:
    return name if len(name) <= SIGNS_OF_ROW else f"{name[: SIGNS_OF_ROW - 3]}..."


def _intervals(critical: Sequence["Critical"]) -> Intervals:
    """Return what lies between critical values and is stable: what begins with one is, and ends with the next one."""
    ends = [0.0, *(x.C_s for x in critical), inf]
    kinds = ["stable" if critical[0].becomes == "unstable" else "unstable", *(x.becomes for x in critical)]
    return [pair for pair, kind in zip(pairwise(ends), kinds, strict=True) if kind == "stable"]


def _bar(ax: "Axes", row: int, intervals: Intervals, limit: float | None) -> None:
    """Draw what is unstable, stable, and stable beyond what the curve allows."""
    low, high = ax.get_xlim()
    end = high if limit is None else float(np.clip(limit * DAMPING, low, high))
    beyond, stable = list[tuple[float, float]](), list[tuple[float, float]]()
    for start, stop in intervals:
        a, b = max(start * DAMPING, low), min(stop * DAMPING, high)
        stable.append((a, min(b, end)))
        beyond.append((max(a, end), b))
    whole = any(start * DAMPING <= low and stop * DAMPING >= high for start, stop in intervals)
    parts = {
        "unstable": (UNSTABLE, [] if whole else [(low, high)]),
        "stable": (STABLE, stable),
        "stable, beyond the curve's limit": (EXCLUDED, beyond),
    }
    for text, (colour, found) in parts.items():
        label = "_" if text in ax.get_legend_handles_labels()[1] else text
        for a, b in found:
            if a < b:
                ax.barh(row, b - a, BAR, left=a, label=label, **area(colour))
                label = "_"


def _frequency(x: "Critical") -> str:
    return f"{x.omega / (2 * np.pi):.3g} Hz"


def _marks(ax: "Axes", result: "ForwardDesign") -> list[MarkLabel]:
    """Draw C_sl, C_su and the chosen C_s; return their values to be written."""
    labels = []
    if result.C_sl:
        at = [x for x in result.critical if np.isclose(x.C_s, result.C_sl, rtol=1e-6)]
        text = rf"$C_\mathrm{{sl}}$ = {_damping(result.C_sl)}" + (f", {_frequency(at[0])}" if at else "")
        labels.append(MarkLabel(result.C_sl * DAMPING, text, BECOMES["stable"]))
        ax.axvline(result.C_sl * DAMPING, color=BECOMES["stable"], linewidth=1.8)
    if result.C_su is not None and result.C_su > 0:
        text = rf"$C_\mathrm{{su}}$ = {_damping(result.C_su)}, limit of the curve"
        labels.append(MarkLabel(result.C_su * DAMPING, text, LIMIT))
        ax.axvline(result.C_su * DAMPING, **LIMIT_LINE)
    if result.C_s is not None:
        text = rf"$C_\mathrm{{s}}$ = {_damping(result.C_s)}, golden section"
        labels.append(MarkLabel(result.C_s * DAMPING, text, CHOSEN))
        ax.axvline(result.C_s * DAMPING, **CHOSEN_LINE)
    return labels

"""Pictures of runs over a track: responses over time, long ones as envelopes with a part of them in detail."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from yawdesign.hunting.arrays import Float
from yawdesign.output.panels import divided
from yawdesign.output.pictures import (
    large_numbers,
    legend_below,
    literal,
    new_axes,
    put_title,
    quantity,
    with_condition,
)
from yawdesign.output.response_words import SHOWN, meaning
from yawdesign.output.style import BEFORE, LIMIT, REST, line_of
from yawdesign.problem import ProblemError, format_quantity
from yawdesign.vehicle.signals import first_looked_at

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from yawdesign.response.run.run import Run
    from yawdesign.response.run.simulate import Simulation
    from yawdesign.response.run.time_history import History

LONG = 12.0  # [s]: of longer runs only the envelope can be drawn
DETAIL = 5.0  # how much of a long run is drawn in detail [s]
PARTS = 150  # of a long run, of each of which the largest and the least value are drawn
SIGNS_BESIDE = 48  # of a label beside a picture
HEIGHT_OF_PANEL, HEIGHT_OF_REST = 1.4, 1.5  # of a picture with a panel for each speed [inch]
FEW_LINES = 8  # of a legend below a picture of the usual height
LINE = 0.18  # by which each further one heightens the picture [inch]
STARTS = {"stationary": "stationary motion", "rest": "rest", "offset": "a displacement"}


@dataclass(frozen=True)
class TimeCurve:
    """One response in one run, in the unit in which people see it.

    Parameters
    ----------
    time, values : ndarray
        [s], and the response.
    run : Run
        What was read from the run.
    label : str
        In the legend.
    look : mapping
        Colour and dashes.
    """

    time: Float
    values: Float
    run: "Run"
    label: str
    look: dict[str, Any]


def simulation(
    result: "Simulation",
    ax: "Axes | None" = None,
    response: str | Sequence[str] | None = None,
    speeds: Sequence[float] | None = None,
    until: float | None = None,
) -> "Axes":
    """Draw responses over time, one line for each and each speed.

    Of more than 12 s the envelope is drawn, and below it five seconds around the largest value.

    Parameters
    ----------
    result : Simulation
        What `simulate` returns.
    ax : Axes, optional
        Where to draw.
    response : str or sequence of str, optional
        Names of responses, or of track inputs, in the same unit; if not given, the lateral displacement of the frame,
        or, of a vehicle with a car body, its accelerations above both bogies.
    speeds : sequence of float, optional
        Speeds to draw [m/s]; all if not given.
    until : float, optional
        Last time that is drawn [s].
    """
    chosen = [
        (h, one)
        for h, one in zip(result.histories, result.runs, strict=True)
        if speeds is None or any(abs(h.speed - v) < 1e-6 for v in speeds)
    ]
    if not chosen:
        raise ProblemError(f"speeds: there are runs at {', '.join(f'{h.speed:g}' for h in result.histories)} m/s")
    names = _responses(chosen[0][0], response)
    shared, apart = _shared_words(names)
    unit = SHOWN[chosen[0][0].unit(names[0])][1]
    curves = [*_curves(chosen, names, apart, until)]
    panels, drawn, below = _draw(new_axes(ax), curves, len(chosen))
    whole = f"{_first_capital(shared)} [{unit}]"
    label = textwrap.fill(whole, SIGNS_BESIDE) if len(panels) == 1 else f"[{unit}]"
    for panel in panels:
        panel.set_ylabel(label)
    panels[-1].set_xlabel("time [s]")
    first = f"{whole}, {drawn}\n" if len(panels) > 1 else ""
    title = with_condition(_title(result, [one for _, one in chosen]), result.condition)
    put_title(panels[0], f"{first}{title}{below}")
    known = {str(x.get_label()): x for panel in panels for x in panel.get_legend_handles_labels()[0]}
    if len({curve.look["color"] for curve in curves}) == 1:  # a single curve is explained by the title
        known = {label: x for label, x in known.items() if label not in {curve.label for curve in curves}}
    lines = legend_below(panels[-1], handles=[*known.values()])
    if ax is None and lines > FEW_LINES:
        figure: Any = panels[0].get_figure(root=True)
        figure.set_figheight(figure.get_figheight() + LINE * (lines - FEW_LINES))
    return panels[0]


def _title(result: "Simulation", runs: "Sequence[Run]") -> str:
    starts = " or ".join(dict.fromkeys(STARTS[one.start] for one in runs))
    parts = [f"Track {literal(result.track)}", quantity("C_s", result.C_s)]
    parts += [format_quantity(runs[0].speed, "km/h", 4)] if len(runs) == 1 else []
    parts += [f"started from {starts}"]
    parts += [_growth(runs[0])] if len(runs) == 1 else []
    return ", ".join(parts)


def _curves(
    chosen: "Sequence[tuple[History, Run]]", names: Sequence[str], apart: dict[str, str], until: float | None
) -> Iterator[TimeCurve]:
    lines = [(history, one, name) for history, one in chosen for name in names]
    long = min(until or np.inf, max(history.time[-1] for history, _ in chosen)) > LONG
    for k, (history, one, name) in enumerate(lines):
        shown = history.time <= (until or history.time[-1])
        speed = format_quantity(history.speed, "km/h", 4)
        parts = [apart[name]] if len(names) > 1 else []
        parts += [speed] if (len(chosen) > 1 and not long) or not parts else []
        label = ", ".join(parts)
        label += f": {_growth(one)}" if len(chosen) > 1 and name == names[0] and not long else ""
        factor = SHOWN[history.unit(name)][0]
        look = line_of(k % len(names) if long else k)
        yield TimeCurve(history.time[shown], factor * history[name][shown], one, label, look)


def _draw(ax: "Axes", curves: Sequence[TimeCurve], runs: int) -> tuple[list["Axes"], str, str]:
    """Draw all curves; return the axes, and what the title of the first ones says besides, before and below."""
    if max(curve.time[-1] for curve in curves) <= LONG:
        _draw_lines(ax, curves)
        return [ax], "", ""
    if runs == 1:
        return _draw_long(ax, curves), "envelope and a part in detail", ""
    if len(ax.figure.axes) == 1:
        ax.figure.set_figheight(HEIGHT_OF_REST + HEIGHT_OF_PANEL * runs)  # type: ignore[union-attr]
    panels = divided(ax, rows=[1] * runs, shared=True)
    each = len(curves) // runs
    for k, panel in enumerate(panels):
        of_panel = curves[k * each : (k + 1) * each]
        _draw_envelopes(panel, of_panel)
        one = of_panel[0].run
        heads = f"{format_quantity(one.speed, 'km/h', 4)}: {_growth(one)}"
        if k:
            panel.set_title(heads, loc="left", fontsize="small")
        else:
            first = heads
    return panels, "envelopes", f"\n{first}"


def _growth(one: "Run") -> str:
    """Return in words how a free motion of a run grows or decays."""
    rate = one.spectral_abscissa
    return f"free motion {'grows' if rate > 0 else 'decays'} by {abs(rate):.3g} 1/s"


def _draw_lines(ax: "Axes", curves: Sequence[TimeCurve]) -> None:
    for curve in curves:
        ax.plot(curve.time, curve.values, linewidth=1.1, label=curve.label, **curve.look)
    _over_time(ax, curves)


def _over_time(ax: "Axes", curves: Sequence[TimeCurve]) -> None:
    ax.axhline(0, color=LIMIT, linewidth=0.6, zorder=1)
    ax.grid()
    large_numbers(ax.yaxis)
    ax.set_xlim(0, max(curve.time[-1] for curve in curves))
    for curve in curves:
        _growing(ax, curve)


def _growing(ax: "Axes", curve: TimeCurve) -> None:
    """Draw how a motion that grows does so by its eigenvalue, through its largest value."""
    if curve.run.spectral_abscissa <= 0:
        return
    place = int(np.argmax(np.abs(curve.values)))
    size = abs(curve.values[place]) * np.exp(curve.run.spectral_abscissa * (curve.time - curve.time[place]))
    label = r"growth by the eigenvalue, $\pm\,\mathrm{e}^{\sigma t}$"
    known = ax.get_legend_handles_labels()[1]
    for sign in (1, -1):
        text = label if sign == 1 and label not in known else "_"
        ax.plot(curve.time, sign * size, color=BEFORE, linewidth=1.0, linestyle=(0, (4, 2)), label=text)


def _draw_envelopes(ax: "Axes", curves: Sequence[TimeCurve]) -> None:
    for curve in curves:
        edges = np.linspace(0, len(curve.time) - 1, PARTS + 1).astype(int)
        low, high = (f.reduceat(curve.values, edges[:-1]) for f in (np.minimum, np.maximum))
        middle = (curve.time[edges[:-1]] + curve.time[edges[1:]]) / 2
        ax.fill_between(middle, low, high, color=curve.look["color"], alpha=0.18, linewidth=0, zorder=1)
        ax.plot(middle, high, linewidth=1.1, label=curve.label, **curve.look)
        ax.plot(middle, low, linewidth=1.1, label="_", **curve.look)
    _over_time(ax, curves)


def _draw_long(ax: "Axes", curves: Sequence[TimeCurve]) -> list["Axes"]:
    """Draw envelopes, and below them in detail what is around the largest value."""
    upper, lower = divided(ax, rows=(1, 1))
    _draw_envelopes(upper, curves)
    largest = max(curves, key=lambda curve: float(np.max(np.abs(curve.values))))
    peak = float(largest.time[int(np.argmax(np.abs(largest.values)))])
    start = float(np.clip(peak - DETAIL / 2, 0, max(0.0, largest.time[-1] - DETAIL)))
    upper.axvspan(start, start + DETAIL, facecolor=REST, alpha=0.5, zorder=0, label="in detail below")
    for curve in curves:
        inside = (curve.time >= start) & (curve.time <= start + DETAIL)
        lower.plot(curve.time[inside], curve.values[inside], linewidth=1.1, **curve.look)
    lower.axhline(0, color=LIMIT, linewidth=0.6, zorder=1)
    lower.grid()
    lower.set_xlim(start, start + DETAIL)
    return [upper, lower]


def _responses(history: "History", response: str | Sequence[str] | None) -> tuple[str, ...]:
    """Return the names of the responses to draw, all in the unit of the first one."""
    if response is None:
        first, *others = first_looked_at(history.values)
        response = (first, *(name for name in others if history.unit(name) == history.unit(first)))
        response = response if history.unit(first) == "m/s^2" else first
    names = (response,) if isinstance(response, str) else tuple(response)
    for name in names:
        if (unit := history.unit(name)) != history.unit(names[0]):
            raise ProblemError(f"{name} is counted in {unit}, {names[0]} in {history.unit(names[0])}: draw them apart")
    return names


def _shared_words(names: Sequence[str]) -> tuple[str, dict[str, str]]:
    """Return what several responses are called together, and what each is called apart from that.

    Examples
    --------
    >>> _shared_words(["y_b1", "y_b2"])
    ('lateral displacement of the frame of the bogie', {'y_b1': 'leading', 'y_b2': 'trailing'})
    """
    words = [meaning(name).split(" ") for name in names]
    alike = [all(other == word for other in same) for word, *same in zip(*words, strict=False)]
    shared = " ".join(word for word, same in zip(words[0], alike, strict=False) if same)
    if len({len(each) for each in words}) > 1:
        return shared.removesuffix(" the").removesuffix(" of") or "responses", {name: name for name in names}
    apart = [" ".join(word for word, same in zip(each, alike, strict=True) if not same) for each in words]
    return shared or "responses", dict(zip(names, apart, strict=True))


def _first_capital(text: str) -> str:
    return text[0].upper() + text[1:]

"""A mode in plan view: where it moves the bodies of a vehicle, and with which phase."""

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from yawdesign.output.panels import divided
from yawdesign.output.pictures import legend_below, new_axes, put_title
from yawdesign.output.plan_view import (
    COLOURS,
    Body,
    Corner,
    bodies,
    caption,
    extent,
    find_mode,
    half_size,
    labels,
    rolls,
    scale_note,
    subtitle,
)
from yawdesign.output.response_words import body_name
from yawdesign.output.style import LIMIT, REST, WIDTH

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.patches import Polygon

    from yawdesign.response.modes.named_modes import Modes, NamedMode

Drawn = list[tuple["Polygon", Body, tuple[Corner, ...]]]
QUARTER = {"fill": False, "edgecolor": LIMIT, "linewidth": 0.9, "linestyle": (0, (3, 2))}
AT_REST = {"fill": False, "edgecolor": REST, "linewidth": 1.2}
PLAN, LINE = 3.0, 0.185  # height of the plan view of a vehicle, and of a line of the table [inch]
NEARLY_SQUARE, OF_LEGEND = 3.8, 1.8  # heights of the picture of a bogie, and of room for its legend [inch]
COLUMN = 0.31  # of numbers, relative to the width of the table
SEEN = 0.005  # of the largest displacement: what moves less has no phase in the table


def mode_shape(result: "Modes", ax: "Axes | None" = None, *, mode: str | None = None, phase: float = 0.0) -> "Axes":
    """Draw a mode in plan view over the vehicle at rest, and a quarter of a cycle later; what rolls from behind too.

    Without axes given there is a table beside it: amplitude and phase of every body.

    Parameters
    ----------
    result : Modes
        What `yawdesign.modes` returns.
    ax : matplotlib.axes.Axes, optional
        Where to draw.
    mode : str, optional
        Its name; the one of least decay rate if not given.
    phase : float
        Of the cycle [rad]; a mode that does not oscillate has died out to 1.5 % after 2 pi.
    """
    chosen = find_mode(result, mode)
    plan, explained = _with_table(result, chosen) if ax is None else (ax, None)
    drawn = draw_plan(plan, result, chosen)
    move(drawn, chosen, phase)
    if chosen.frequency:
        later = [body for body in bodies(result, chosen) if body.kind != "yaw damper"]
        move(_outlines(plan, later, QUARTER), chosen, phase + math.pi / 2)
        plan.plot([], [], color=LIMIT, linewidth=0.9, linestyle=(0, (3, 2)), label="a quarter of a cycle later")
    put_title(plan, f"{_capital(caption(chosen))}\n{subtitle(result)}", result.condition)
    if explained is None:
        legend_below(plan)
    else:
        explained.legend(*plan.get_legend_handles_labels(), loc="lower right")
    return plan


def draw_plan(ax: "Axes", result: "Modes", chosen: "NamedMode") -> Drawn:
    """Draw track, outlines at rest and the bodies of a vehicle; return what moves."""
    from matplotlib.patches import Polygon

    shown, p = bodies(result, chosen), result.parameters
    _track(ax, p)
    _outlines(ax, shown, AT_REST)
    ax.plot([], [], color=REST, linewidth=1.2, label="at rest")
    drawn: Drawn = []
    for body, outline in _parts(shown):
        look: dict[str, Any] = {"facecolor": COLOURS[body.kind], "edgecolor": LIMIT, "linewidth": 0.7, "zorder": 2}
        new = body.kind not in {patch.get_label() for patch in ax.patches}
        patch = Polygon(_placed(body, outline, 0j), closed=True, label=body.kind if new else "_", **look)
        patch.set_facecolor((COLOURS[body.kind], body.opacity))
        ax.add_patch(patch)
        drawn.append((patch, body, outline))
    for x, y, text in labels(p):
        ax.text(x, y, text, ha="center", va="center", fontsize="small")
    ax.set_xlabel(scale_note(p), fontsize="small")
    return drawn


def move(drawn: Drawn, chosen: "NamedMode", phase: float) -> None:
    """Put bodies where they are at a phase of the cycle [rad]."""
    factor = cmath.exp(1j * phase) if chosen.frequency else complex(math.exp(-phase / 1.5))
    for patch, body, outline in drawn:
        patch.set_xy(_placed(body, outline, factor))


def _parts(shown: Sequence[Body]) -> Iterator[tuple[Body, tuple[Corner, ...]]]:
    yield from ((body, outline) for body in shown for outline in body.outlines)


def _outlines(ax: "Axes", shown: Sequence[Body], look: "Mapping[str, Any]") -> Drawn:
    from matplotlib.patches import Polygon

    order, drawn = 3 if look is QUARTER else 1, []
    for body, outline in _parts(shown):
        patch = Polygon(_placed(body, outline, 0j), closed=True, zorder=order, label="_", **look)
        ax.add_patch(patch)
        drawn.append((patch, body, outline))
    return drawn


def _track(ax: "Axes", p: "Mapping[str, float]") -> None:
    left, right, bottom, top = extent(p)
    end = half_size(p)[0]
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[])
    ax.spines[:].set_visible(False)
    for side in (1, -1):
        ax.plot([left, end], [side * p["b"]] * 2, color=REST, linewidth=3, zorder=0, label="_")
    ax.annotate(
        "", (end - 0.1, bottom + 0.14), (end - 0.8, bottom + 0.14), arrowprops={"arrowstyle": "-|>", "color": LIMIT}
    )
    ax.text(end - 0.88, bottom + 0.14, "direction of travel", ha="right", va="center", fontsize="small")


def _placed(body: Body, outline: Sequence[Corner], factor: complex) -> list[tuple[float, float]]:
    x, y = (rest + (shift * factor).real for rest, shift in zip(body.rest, body.shift, strict=True))
    c, s = math.cos(phi := (body.phi * factor).real), math.sin(phi)
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in outline]


def _with_table(result: "Modes", chosen: "NamedMode") -> tuple["Axes", "Axes"]:
    """Return new axes for the plan view and those with the table of amplitudes and phases beside or below it."""
    rows = [*_rows(chosen, rolling=rolls(result.parameters))]
    left, right, bottom, top = extent(result.parameters)
    height = LINE * (len(rows) + 0.3)
    if right - left > 2 * (top - bottom):
        ax = new_axes(None)
        ax.figure.set_size_inches(WIDTH, PLAN + height)  # type: ignore[union-attr]
        plan, table = divided(ax, rows=(PLAN, height))
        _write_table(table, rows, 0.72, height)
    else:
        ax = new_axes(None)
        ax.figure.set_size_inches(WIDTH, height := max(NEARLY_SQUARE, height + OF_LEGEND))  # type: ignore[union-attr]
        plan, table = divided(ax, columns=(1.2, 1.0))
        _write_table(table, rows, 1.0, height)
    plan.set_anchor("N")
    return plan, table


def _rows(chosen: "NamedMode", *, rolling: bool) -> Iterator[list[str]]:
    """Yield the head of the table, and for each body amplitude and phase of its displacement and of its angles."""
    angles = (("phi", "psi"), ("th",)) if rolling else (("phi", "psi"),)
    yield [
        "amplitude ∠ phase",
        r"$y$ [m]",
        *(rf"${symbol}$ [rad]" for symbol in (r"\varphi", r"\theta")[: len(angles)]),
    ]
    parts = dict.fromkeys(name.split("_")[1] for name in chosen.shape)
    largest = max(abs(value) for value in chosen.shape.values())
    for body in parts:
        cells = [_phasor(chosen, (f"{x}_{body}" for x in names), largest) for names in (("y",), *angles)]
        yield [body_name(body), *cells]


def _phasor(chosen: "NamedMode", names: Iterator[str], largest: float) -> str:
    value = next((chosen.shape[name] for name in names if name in chosen.shape), None)
    if value is None:
        return ""
    if abs(value) < SEEN * largest:
        return "0"
    degrees = round(math.degrees(cmath.phase(value)))
    return f"{abs(value):.2f} ∠ {degrees}°".replace("-", "−")


def _write_table(ax: "Axes", rows: Sequence[Sequence[str]], width: float, height: float) -> None:
    """Write lines of a table into axes of a height [inch]; it takes a part of their width."""
    ax.axis("off")
    ax.set(xlim=(0, 1), ylim=(height, 0))
    cells = len(rows[0]) - 1
    ends = [width * (1 - min(COLUMN, 0.72 / cells) * (cells - k)) for k in range(cells + 1)]
    for k, row in enumerate(rows):
        for place, (x, cell) in enumerate(zip(ends, row, strict=True)):
            down = LINE * (k + 0.4 + 0.2 * (k > 0))
            ax.text(x if place else 0.0, down, cell, va="center", ha="right" if place else "left", fontsize="small")
    ax.plot([0, width], [LINE * 0.93] * 2, color=LIMIT, linewidth=0.8)


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]

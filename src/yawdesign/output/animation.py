"""A mode in motion, in plan view: as a GIF, or as an SVG that moves by a few lines of script."""

import io
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from yawdesign.hunting.chosen_condition import other_condition_in_words
from yawdesign.output.film import Film
from yawdesign.output.markup import plain_text
from yawdesign.output.mode_shape_plots import draw_plan, move
from yawdesign.output.pictures import ANIMATIONS, legend_below, own_texts, put_title
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
    scale_note,
    subtitle,
)
from yawdesign.output.style import LIMIT, REST
from yawdesign.output.targets import Target, checked_targets
from yawdesign.problem import PARAMETERS
from yawdesign.problem.whole_files import write_whole
from yawdesign.response.modes.named_modes import Modes, NamedMode

FRAMES, PERIOD = 24, 1.6  # pictures and seconds of a cycle
FILM_DOTS = 120  # of the pictures, in an inch: 960 beside each other
SIGN = 6.5  # width of a letter in the SVG
SCALE, LINE = 100.0, 16  # units of the SVG in a metre, and in a line of text
WIDE = 640.0  # of an SVG: in a wider one letters are larger
INK = "currentColor"  # of the page around it; black where it stands alone
C_S = '<tspan font-style="italic">C</tspan><tspan dy="3" font-size="75%">s</tspan><tspan dy="-3"> </tspan>'

SCRIPT = """(function () {
  var svg = document.currentScript.closest("svg"), parts = svg.querySelectorAll("g[data-y]");
  function number(part, name) { return part.getAttribute("data-" + name).split(" ").map(Number); }
  function step(time) {
    var phase = 2 * Math.PI * (time / 1000 / PERIOD % 1), c = Math.cos(phase), s = Math.sin(phase);
    if (REAL) { c = Math.exp(-phase / 1.5); s = 0; }
    parts.forEach(function (part) {
      function at(name) { var z = number(part, name); return z[0] * c - z[1] * s + (z[2] || 0); }
      part.setAttribute("transform", "translate(" + at("x") + "," + -at("y") + ") rotate(" +
        -at("phi") * 180 / Math.PI + ")");
    });
    requestAnimationFrame(step);
  }
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) { requestAnimationFrame(step); }
})();"""


def animate(
    result: Modes, to: str | Path | None = None, *, mode: str | None = None, replace: bool = False
) -> Path | Film:
    """Show a mode in motion in a notebook, or write it to a file.

    An oscillating mode is shown over one cycle, without its decay or growth; another one with its decay.

    Parameters
    ----------
    result : Modes
        What `yawdesign.modes` returns.
    to : str or Path, optional
        The file; without one a notebook shows what is returned. Its ending, .gif or .svg, says what is written. The SVG
        needs nothing but itself, and a viewer that runs scripts.
    mode : str, optional
        Name of the mode; the one of least decay rate if not given.
    replace : bool
        Whether a file that is there is replaced.

    Returns
    -------
    Path or Film
        The file, or what a notebook shows; ``to_jshtml()`` of it is its HTML.

    Raises
    ------
    ProblemError
        If the ending or the mode is not known, there is no such folder, or there is a file that may not be replaced.
    OSError
        If it cannot be written.
    """
    if to is None:
        return Film(svg(result, mode).decode())
    path = Path(to)
    checked_targets([Target("", str(path), ANIMATIONS, replace)], [])
    find_mode(result, mode)
    makers = {".gif": gif, ".svg": svg}
    with own_texts():
        write_whole(path, makers[path.suffix.lower()](result, mode), replace=replace)
    return path


def gif(result: Modes, mode: str | None = None) -> bytes:
    """Return a GIF of a mode, as wide as a slide. Arguments as in `animate`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    chosen = find_mode(result, mode)
    figure = Figure(figsize=_figure_size(result), dpi=FILM_DOTS, layout="constrained")
    ax = figure.add_subplot()
    canvas: Any = FigureCanvasAgg(figure)
    drawn = draw_plan(ax, result, chosen)
    put_title(ax, f"{caption(chosen)}\n{subtitle(result)}", result.condition)
    legend_below(ax)
    pictures = []
    for k in range(FRAMES):
        move(drawn, chosen, 2 * math.pi * k / FRAMES)
        canvas.draw()
        figure.set_layout_engine("none")  # from the second picture on everything stays where it is
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
        pictures.append(picture.quantize(64))
    out = io.BytesIO()
    duration = int(1000 * PERIOD / FRAMES)
    pictures[0].save(out, "GIF", save_all=True, append_images=pictures[1:], duration=duration, loop=0)
    return out.getvalue()


def _figure_size(result: Modes) -> tuple[float, float]:
    """Return width and height of the pictures [in]: one bogie in plan view is nearly a square, a vehicle is long."""
    left, right, bottom, top = extent(result.parameters)
    return (8.0, 5.6) if right - left < 2 * (top - bottom) else (8.0, 4.2)


def svg(result: Modes, mode: str | None = None) -> bytes:
    """Return an SVG of a mode, to stand alone or inside an HTML page. Arguments as in `animate`."""
    chosen = find_mode(result, mode)
    return _svg(result, chosen).encode()


def _svg(result: Modes, mode: NamedMode) -> str:
    p = result.parameters
    left, right, bottom, top = (SCALE * x for x in extent(p))
    shown, length = bodies(result, mode), SCALE * half_size(p)[0]
    rails = [_line(-length, length, side * SCALE * p["b"]) for side in (1, -1)]
    at_rest = [_group(body, f'fill="none" stroke="{REST}"') for body in shown]
    middle, large = (left + right) / 2, max(1.0, (right - left) / WIDE)
    point = subtitle(result).replace(f"${PARAMETERS['C_s'].symbol}$ ", C_S)
    head = [*filter(None, (caption(mode), point, plain_text(other_condition_in_words(result.condition))))]
    texts = [
        *(_text(middle, -top - large * (4 + LINE * k), line, large) for k, line in enumerate(reversed(head))),
        *(_text(SCALE * x, -SCALE * y, text, large) for x, y, text in labels(p)),
        _text(middle, -bottom + 8 * large, f"{scale_note(p)}; direction of travel: to the right →", large),
        *_legend(shown, middle, -bottom + 14 * large, large),
    ]
    height = top - bottom + large * (24 + LINE * (len(head) + 1))
    box = f"{left:.1f} {-top - large * (4 + LINE * len(head)):.1f} {right - left:.1f} {height:.1f}"
    size = f'width="{right - left:.0f}" height="{height:.0f}" style="max-width:100%;height:auto"'
    script = SCRIPT.replace("PERIOD", f"{PERIOD}").replace("REAL", "true" if mode.frequency == 0 else "false")
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {size} role="img">',
            f"<title>{caption(mode)}</title>",
            *texts,
            *rails,
            *at_rest,
            *(_moving(body) for body in shown),
            f"<script>{script}</script>",
            "</svg>\n",
        ]
    )


def _legend(shown: Sequence[Body], middle: float, top: float, large: float) -> Iterator[str]:
    """Yield a row of marks with the names of what they stand for."""
    kinds = [*dict.fromkeys(body.kind for body in shown)]
    widths = [large * (SIGN * len(kind) + 26) for kind in kinds]
    for k, kind in enumerate(kinds):
        x = middle - sum(widths) / 2 + sum(widths[:k])
        opacity = next(body.opacity for body in shown if body.kind == kind)
        size = f'width="{14 * large:.1f}" height="{10 * large:.1f}"'
        yield f'<rect x="{x:.1f}" y="{top:.1f}" {size} {_fill(kind, opacity)}/>'
        yield _text(x + 18 * large, top + 9 * large, kind, large, "start")


def _text(x: float, y: float, text: str, large: float, anchor: str = "middle") -> str:
    style = f'text-anchor="{anchor}" font-size="{12 * large:.1f}" font-family="sans-serif" fill="{INK}"'
    return f'<text x="{x:.1f}" y="{y:.1f}" {style}>{text}</text>'


def _fill(kind: str, opacity: float) -> str:
    colour = INK if COLOURS[kind] == LIMIT else COLOURS[kind]
    return f'fill="{colour}" fill-opacity="{opacity}" stroke="{INK}"'


def _line(start: float, end: float, y: float) -> str:
    return f'<line x1="{start:.1f}" x2="{end:.1f}" y1="{y:.1f}" y2="{y:.1f}" stroke="{REST}" stroke-width="3"/>'


def _moving(body: Body) -> str:
    style = _fill(body.kind, body.opacity)
    (x, y), (dx, dy) = body.rest, body.shift
    motion = f'data-x="{_path(dx, x)}" data-y="{_path(dy, y)}" data-phi="{body.phi.real:.6f} {body.phi.imag:.6f}"'
    return _group(body, f"{style} {motion}", 1.0)


def _path(shift: complex, rest: float) -> str:
    return f"{SCALE * shift.real:.4f} {SCALE * shift.imag:.4f} {SCALE * rest:.2f}"


def _group(body: Body, style: str, moved: float = 0.0) -> str:
    """Return a body at rest (moved 0) or where it is at phase zero (moved 1)."""
    x, y = (rest + moved * shift.real for rest, shift in zip(body.rest, body.shift, strict=True))
    turn = math.degrees(moved * body.phi.real)
    place = f'transform="translate({SCALE * x:.2f},{-SCALE * y:.3f}) rotate({-turn:.4f})"'
    return f"<g {style} {place}>{''.join(_polygon(outline) for outline in body.outlines)}</g>"


def _polygon(outline: tuple[Corner, ...]) -> str:
    return f'<polygon points="{" ".join(f"{SCALE * x:.1f},{-SCALE * y:.1f}" for x, y in outline)}"/>'

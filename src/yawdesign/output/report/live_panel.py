"""The part of the page that answers for other values: sliders, and a script that computes in the page."""

import json
import re
from collections.abc import Iterator
from importlib.resources import files
from typing import NamedTuple

from yawdesign.exports.javascript import page_equations
from yawdesign.output.markup import VARIABLES, plain_text, text
from yawdesign.problem import PARAMETERS, Problem
from yawdesign.problem.condition import CREEP_FACTOR
from yawdesign.problem.running import SPEED

SCRIPTS = ("arithmetic.js", "polynomial.js", "eigenvalues.js", "answers.js", "live.js")
STYLE = "live.css"


class Slider(NamedTuple):
    """One value that may be moved.

    Parameters
    ----------
    key : str
        Its name in the script.
    label, unit : str
        What people read.
    factor : float
        SI value of one unit.
    low, high : float
        Ends of the slider, in its unit; the number beside it goes farther.
    scale : {"log", "linear"}
        How the slider runs between them.
    """

    key: str
    label: str
    unit: str
    factor: float
    low: float
    high: float
    scale: str


SLIDERS = (
    Slider("C_s", PARAMETERS["C_s"].meaning, "kN\u00b7s/m", 1e3, 1, 1e5, "log"),
    Slider("v", SPEED.meaning, "km/h", 1 / 3.6, 20, 600, "linear"),
    Slider("lambda", PARAMETERS["lambda"].meaning, "", 1, 0.005, 0.6, "log"),
    Slider("creep_factor", CREEP_FACTOR.meaning, "", 1, 0.3, 1.2, "linear"),
)

PAGE = """\
<section id="live" class="live" aria-labelledby="live-title" hidden>
<style>{style}</style>
<h2 id="live-title">Other values</h2>
<p>{about}</p>
<div class="values" role="group" aria-label="Values">
{rows}
</div>
<button type="button" id="live-reset">Back to the design</button>
<p class="answer"><output id="live-verdict" aria-live="polite"></output></p>
<dl>
<dt>Decay rate</dt><dd><output id="live-decay-rate"></output></dd>
<dt>Damping ratio</dt><dd><output id="live-damping-ratio"></output></dd>
<dt>Largest real part of all modes</dt><dd><output id="live-abscissa"></output></dd>
<dt>Stable for C_s</dt><dd><output id="live-intervals"></output></dd>
</dl>
<p>Decay rate and damping ratio are the least over the modes that a design variable moves.</p>
<svg viewBox="0 0 600 78" role="img" aria-labelledby="live-axis-title live-intervals">
<title id="live-axis-title">Stable intervals of C_s [kN\u00b7s/m], and C_s</title>
<desc>Stable where it is plain, unstable where it is hatched; the line is C_s. In words they stand above.</desc>
<defs><pattern id="live-hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">\
<path class="hatch" d="M0 0v7"/></pattern></defs><g id="live-axis-drawn"></g></svg>
<svg viewBox="0 0 600 300" role="img" aria-labelledby="live-plane-title live-plane-description">
<title id="live-plane-title">Roots of the characteristic polynomial</title>
<desc id="live-plane-description"></desc><g id="live-plane-drawn"></g></svg>
<p>Crosses: roots now; triangles: roots that grow; circles: roots of the design. \
<span id="live-plane-note"></span></p>
<script type="application/json" id="live-data">{data}</script>
<script>(() => {{
"use strict";
{script}
}})();</script>
</section>
"""

ABOUT = (
    "Computed in this page, for one condition: the values given here, while all other parameters stay as designed. The "
    "verdict and the stable intervals come from the characteristic polynomial of every motion of the vehicle, the "
    "roots from its state matrix. That each of them is a root of the polynomial, and that both count as many unstable "
    "ones, is checked every time."
)


def live_panel(problem: Problem, C_s: float) -> str:
    """Return the part of a page in which C_s, speed, conicity and creep can be moved, as an HTML fragment.

    It needs nothing but itself: the page may forbid every connection. What a page adds: the variables of
    `yawdesign.output.markup.VARIABLES`, where they are to be other colours than in print.

    Parameters
    ----------
    problem : Problem
        Its parameters, without conditions, are those of the page; the slider of the speed starts at its highest one.
    C_s : float
        Damping of the pair of yaw dampers at which the sliders start [N s/m].
    """
    start = {
        "C_s": float(C_s),
        "v": float(problem.speeds[-1]),
        "lambda": float(problem.parameters()["lambda"]),
        "creep_factor": 1.0,
    }
    return PAGE.format(
        style=_style(),
        about=text(ABOUT),
        rows="\n".join(_rows(start)),
        data=json.dumps({"start": start, **page_equations(problem)}, separators=(",", ":")),
        script="\n".join(_read(name) for name in SCRIPTS),
    )


def _read(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def _style() -> str:
    """Return the style sheet, with the colours of print where a page does not set a variable."""
    colours = {f"--{variable}": colour for colour, variable in VARIABLES.items()}
    return re.sub(r"var\((--[\w-]+)\)", lambda found: f"var({found[1]}, {colours[found[1]]})", _read(STYLE))


def _rows(start: dict[str, float]) -> Iterator[str]:
    for slider in SLIDERS:
        label, unit = plain_text(f"{slider.key}: {slider.label}"), plain_text(slider.unit)
        value = f"{start[slider.key] / slider.factor:.15g}"
        yield (
            f'<div class="value" data-key="{slider.key}" data-factor="{slider.factor!r}" data-unit="{unit}" '
            f'data-low="{slider.low}" data-high="{slider.high}" data-scale="{slider.scale}">'
            f'<label for="live-{slider.key}">{label}</label>'
            f'<input type="range" id="live-{slider.key}" min="0" max="1000" step="1">'
            f'<span><input type="number" aria-label="{label}, {unit or "number"}" min="0" step="any" value="{value}"> '
            f"{unit}</span></div>"
        )

"""A mode in motion inside a page: moved by rules of its style, still on paper and where motion is not wanted."""

import math
import re
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from yawdesign.output import animation, markup

if TYPE_CHECKING:
    from yawdesign.response.modes.named_modes import Modes

FRAMES = 24
SVG = "http://www.w3.org/2000/svg"
Numbers = tuple[float, float, float]


def film(result: "Modes", mode: str | None, name: str, title: str, description: str) -> str:
    """Return a mode as an SVG element that moves, with a box to tick that stops it.

    Parameters
    ----------
    result : Modes
        What `yawdesign.modes` returns.
    mode : str or None
        Name of the mode; the one of least decay rate if not given.
    name, title, description : str
        As of `yawdesign.output.markup.picture`.
    """
    ElementTree.register_namespace("", SVG)
    root = ElementTree.fromstring(animation.svg(result, mode))
    grows = next(x for x in result.modes if mode in (None, x.name)).frequency == 0
    rules = []
    for k, part in enumerate(x for x in root.iter(f"{{{SVG}}}g") if "data-y" in x.attrib):
        part.set("class", f"moving {name}-{k}")
        rules.append(_rules(f"{name}-{k}", part, dies_out=grows))
    for script in root.findall(f"{{{SVG}}}script"):
        root.remove(script)
    for own in root.findall(f"{{{SVG}}}title"):
        root.remove(own)
    for key in ("role", "width", "height", "style"):
        root.attrib.pop(key, None)
    svg = markup.embedded(ElementTree.tostring(root, encoding="unicode"), name, title, description)
    control = (
        f'<input type="checkbox" id="{name}-pause" class="pause"><label for="{name}-pause">Pause the motion</label>'
    )
    return f"{control}\n<style>{''.join(rules)}</style>\n{svg}"


def _rules(name: str, part: "ElementTree.Element", *, dies_out: bool) -> str:
    """Return the rule that moves a part through one cycle, and take away the data of which it is made."""
    x, y, phi = (_numbers(part.attrib.pop(f"data-{key}")) for key in ("x", "y", "phi"))
    frames = []
    for k in range(FRAMES + 1):
        phase = 2 * math.pi * k / FRAMES
        c, s = (math.exp(-phase / 1.5), 0.0) if dies_out else (math.cos(phase), math.sin(phase))
        right, up, turned = (a * c - b * s + rest for a, b, rest in (x, y, phi))
        place = f"translate({right:.2f}px,{-up:.2f}px) rotate({-math.degrees(turned):.3f}deg)"
        frames.append(f"{100 * k / FRAMES:.4g}%{{transform:{place}}}")
    move = f"animation:{name} {animation.PERIOD}s linear infinite"
    moving = f"@media screen and (prefers-reduced-motion:no-preference){{.{name}{{{move}}}}}"
    return f"{moving}@keyframes {name}{{{''.join(frames)}}}"


def _numbers(text: str) -> Numbers:
    real, imaginary, *rest = map(float, re.split(r"\s+", text.strip()))
    return real, imaginary, rest[0] if rest else 0.0

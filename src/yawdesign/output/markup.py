"""HTML of tables, texts and pictures: what users write is shown as text, whatever it holds."""

import io
import re
from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from yawdesign.output import style
from yawdesign.output.minus import with_minus
from yawdesign.output.pictures import BLANK, own_texts
from yawdesign.output.table_widths import unbroken
from yawdesign.problem.characters import in_order

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Colours of pictures that a page may set anew, for a dark screen, by the name of a variable of its style sheet.
VARIABLES = {
    style.LIMIT: "ink",
    style.HALO: "paper",
    style.STABLE: "stable",
    style.UNSTABLE: "unstable",
    style.UNKNOWN: "unknown",
    style.EXCLUDED: "excluded",
    style.HATCH_COLOUR: "hatch",
    style.EXCLUDED_HATCH: "excluded-hatch",
    style.CHOSEN: "chosen",
    style.BEFORE: "before",
    style.GRID: "grid",
    style.REST: "rest",
    **{colour: f"becomes-{kind}" for kind, colour in style.BECOMES.items()},
    **{
        colour: f"series-{k}"
        for k, colour in enumerate(style.SERIES)
        if colour not in (style.CHOSEN, style.BEFORE, style.LIMIT)
    },
}


def page_colours() -> str:
    """Return the part of a page's style sheet that sets its colours, for light and dark screens."""
    light, dark = (
        f":root {{ color-scheme: {scheme}; {' '.join(f'--{name}: {colour};' for name, colour in colours.items())} }}"
        for scheme, colours in (("light", style.PAGE), ("dark", style.DARK))
    )
    return f"{light}\n@media screen and (prefers-color-scheme: dark) {{ {dark} }}\n"


def text(value: str) -> str:
    """Return a text as HTML shows it letter by letter, without touching the direction of what stands around it.

    Examples
    --------
    >>> text("<b>5 µm</b>")
    '<bdi>&lt;b&gt;5 µm&lt;/b&gt;</bdi>'
    """
    return f"<bdi>{plain_text(value)}</bdi>"


def sentence(value: str) -> str:
    """Return a text of several lines as `text` does; none ends inside of a number, or between it and its unit.

    Examples
    --------
    >>> sentence("at 1 200 kN") == f"<bdi>at 1{BLANK}200{BLANK}kN</bdi>"
    True
    """
    return text(unbroken(value, BLANK))


def plain_text(value: str) -> str:
    """Return a text for a place where there are no elements, such as a title or an attribute, with minus signs."""
    return escape(with_minus(in_order(value)))


def tables(shown: RenderableType) -> str:
    """Return the tables and lines that a terminal shows as HTML."""
    return "\n".join(_parts(shown))


def _parts(shown: Any) -> Iterator[str]:
    if isinstance(shown, Group):
        for part in shown.renderables:
            yield from _parts(part)
    elif isinstance(shown, Table):
        yield _table(shown)
    else:
        line = shown.plain if isinstance(shown, Text) else str(shown)
        if line.strip():
            yield f"<p>{sentence(line)}</p>"


def _table(table: Table) -> str:
    columns = [(column.justify, column.header, list(column.cells)) for column in table.columns]
    rows = zip(*(cells for _, _, cells in columns), strict=True)
    caption = f"<caption>{text(_plain(table.title))}</caption>" if table.title else ""
    head = ""
    if table.show_header:
        cells = "".join(
            f'<th scope="col"{_align(justify)}>{text(_plain(header))}</th>' for justify, header, _ in columns
        )
        head = f"<thead><tr>{cells}</tr></thead>"
    body = "".join(f"<tr>{''.join(_cells(row, [justify for justify, _, _ in columns]))}</tr>" for row in rows)
    return f"<table>{caption}{head}<tbody>{body}</tbody></table>"


def _cells(row: tuple[Any, ...], justified: list[str]) -> Iterator[str]:
    for k, (cell, justify) in enumerate(zip(row, justified, strict=True)):
        tag, scope = ("th", ' scope="row"') if k == 0 else ("td", "")
        yield f"<{tag}{scope}{_align(justify)}>{text(_plain(cell))}</{tag}>"


def _align(justify: str) -> str:
    return ' class="number"' if justify == "right" else ""


def _plain(cell: Any) -> str:
    return cell.plain if isinstance(cell, Text) else str(cell)


def picture(axes: "Axes", name: str, title: str, description: str) -> str:
    """Return a picture as an SVG element for a page, with texts for who cannot see it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Of the figure to show.
    name : str
        Of the picture in its page, in small letters, figures and hyphens; another for each picture.
    title, description : str
        What the picture is of, and what it shows.
    """
    content = io.StringIO()
    figure: Any = axes.get_figure(root=True)
    with own_texts():
        figure.savefig(content, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    return embedded(content.getvalue(), name, title, description)


def embedded(svg: str, name: str, title: str, description: str) -> str:
    """Return an SVG document as an element for a page; the other parameters as of `picture`."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, count=1, flags=re.DOTALL)
    svg = re.sub(r'\b(id="|xlink:href="#|url\(#)', rf"\g<1>{name}-", svg)
    svg = re.sub(r"(?<=[\d ])(-?\d+\.\d{2})\d+", r"\1", svg)  # a hundredth of a point is not seen
    for colour, variable in VARIABLES.items():
        svg = svg.replace(colour, f"var(--{variable},{colour})")
    opening = f'<svg role="img" aria-labelledby="{name}-title {name}-description" '
    texts = (
        f'<title id="{name}-title">{plain_text(title)}</title>'
        f'<desc id="{name}-description">{plain_text(description)}</desc>'
    )
    head, rest = svg.removeprefix("<svg ").split(">", 1)
    return opening + head + ">" + texts + rest

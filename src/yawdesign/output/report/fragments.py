"""What the sections of a page are made of: headings, paragraphs, tables, pictures with captions."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from yawdesign.output import markup

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import RenderableType


TALL = 0.8  # of its width: a picture that is higher gets more room on paper


@dataclass(frozen=True)
class Section:
    """A part of the page with a heading, to which the table of contents leads.

    Parameters
    ----------
    name : str
        Its anchor, in small letters and hyphens; the names of its pictures begin with it.
    title : str
        Its heading.
    body : str
        HTML: what stands below the heading, or the whole section.
    on_paper : bool
        Whether it is printed.
    whole : bool
        Whether the body has its own heading and is the section.
    """

    name: str
    title: str
    body: str
    on_paper: bool = True
    whole: bool = False

    @property
    def html(self) -> str:
        """The section as an element."""
        if self.whole:
            return self.body
        opening = f'<section id="{self.name}" aria-labelledby="{self.name}-heading"{self.kind}>'
        return f'{opening}\n<h2 id="{self.name}-heading">{self.title}</h2>\n{self.body}\n</section>'

    @property
    def kind(self) -> str:
        """The attribute of what is not printed."""
        return of_class("" if self.on_paper else "screen")


def paragraph(text: str, kind: str = "") -> str:
    """Return a text as a paragraph, shown as it is."""
    return f"<p{of_class(kind)}>{markup.sentence(text)}</p>"


def of_class(kind: str) -> str:
    """Return the attribute that gives an element its look, none for an empty name."""
    return f' class="{kind}"' if kind else ""


def subheading(title: str) -> str:
    """Return a heading inside a section."""
    return f"<h3>{markup.text(title)}</h3>"


def items(texts: Iterable[str]) -> str:
    """Return texts as a list."""
    return f"<ul>{''.join(f'<li>{markup.sentence(text)}</li>' for text in texts)}</ul>"


def folded(summary: str, body: str) -> str:
    """Return what is shown when it is asked for; on paper it is left out."""
    return f"<details><summary>{markup.text(summary)}</summary>{body}</details>"


def tables(*shown: "RenderableType") -> str:
    """Return tables and lines of a terminal as HTML; a table that is too wide for its page is scrolled alone."""
    html = "\n".join(markup.tables(each) for each in shown)
    html = re.sub(r"<table>", '<div class="wide" role="group" tabindex="0"><table>', html)
    return html.replace("</table>", "</table></div>")


def figure(axes: "Axes", name: str, title: str, description: str, caption: str = "") -> str:
    """Return a picture with a caption.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Of the figure to show.
    name : str
        Of the picture in the page.
    title, description : str
        For who cannot see it.
    caption : str
        Below it; the description if not given.
    """
    svg = markup.picture(axes, name, title, description)
    width, height = axes.get_figure(root=True).get_size_inches()  # type: ignore[union-attr]
    kind = of_class("tall" if height > TALL * width else "")
    return f"<figure{kind}>{svg}<figcaption>{markup.sentence(caption or description)}</figcaption></figure>"

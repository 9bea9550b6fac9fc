"""A moving picture inside a page or a notebook."""

import re
from dataclasses import dataclass
from html import escape

NAME, WIDEST = "A mode in motion", 900  # pixels


@dataclass(frozen=True)
class Film:
    """A picture that moves by its own script, in a frame of its own: nothing of the page around it is touched.

    Parameters
    ----------
    svg : str
        The picture, with its script.
    """

    svg: str

    def to_jshtml(self) -> str:
        """Return it as HTML, as films of Matplotlib do."""
        width, height = (float(x) for x in re.findall(r'\b(?:width|height)="([\d.]+)"', self.svg)[:2])
        style = "body{margin:0;overflow:hidden}svg{display:block;width:100%;height:auto}"
        page = f"<!doctype html><title>{NAME}</title><style>{style}</style>{self.svg}"
        frame = f"width:100%;max-width:{min(width, WIDEST):.0f}px;aspect-ratio:{width:.0f}/{height:.0f};border:0"
        return f'<iframe title="{NAME}" sandbox="allow-scripts" style="{frame}" srcdoc="{escape(page)}"></iframe>'

    def _repr_html_(self) -> str:
        return self.to_jshtml()

    def __repr__(self) -> str:
        return "Film of a mode: a notebook shows it, animate(..., to=FILE) writes it"

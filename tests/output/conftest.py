"""What all tests of pictures ask: whether every text can be read."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from yawdesign.output.pictures import own_texts

SMALLEST = 8.0  # points
TOUCHING = 1.0  # pixels by which boxes of texts may overlap: they hold the room for letters that go lower


@pytest.fixture
def layout_faults(monkeypatch):
    """A function that draws the figure of some axes and returns what is wrong with its texts, as a list of words.

    No text may lie on another, on a line or outside the figure, or be smaller than `SMALLEST`. On a line may lie what
    has a box of its own behind it.
    """
    drawn = []
    draw = Text.draw

    def drawing(text, renderer):
        if text.get_visible() and text.get_text():
            drawn.append((text, Text.get_window_extent(text, renderer)))
        draw(text, renderer)

    def faults(axes):
        figure = axes.get_figure(root=True)
        with own_texts(), monkeypatch.context() as patched:
            figure.draw_without_rendering()
            canvas = FigureCanvasAgg(figure)
            patched.setattr(Text, "draw", drawing)
            drawn.clear()
            canvas.draw()
        lines = [points for ax in figure.axes for points in _lines(ax)]
        return [*_outside(drawn, figure.bbox), *_small(drawn), *_overlaps(drawn), *_struck(drawn, lines)]

    return faults


def _outside(drawn, room):
    for text, box in drawn:
        if box.x0 < room.x0 - 1 or box.y0 < room.y0 - 1 or box.x1 > room.x1 + 1 or box.y1 > room.y1 + 1:
            yield f"outside the figure: {text.get_text()!r}"


def _small(drawn):
    yield from (f"smaller than {SMALLEST} pt: {t.get_text()!r}" for t, _ in drawn if t.get_fontsize() < SMALLEST)


def _overlaps(drawn):
    for (one, a), (other, b) in combinations(drawn, 2):
        wide, high = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
        if wide > TOUCHING and high > TOUCHING:
            yield f"on each other: {one.get_text()!r} and {other.get_text()!r}"


def _struck(drawn, lines):
    for text, box in drawn:
        if text.get_bbox_patch() is None and any(_through(points, box) for points in lines):
            yield f"on a line: {text.get_text()!r}"


def _lines(ax):
    """Yield the lines of some axes as points in pixels, parted where they leave the axes."""
    for line in ax.get_lines():
        points = line.get_transform().transform(np.column_stack(np.broadcast_arrays(*line.get_data())).astype(float))
        yield points if not line.get_clip_on() else _within(points, ax.bbox)


def _within(points, room):
    """Return points of a line so close to each other that a box of a text holds some, without those outside."""
    if len(points) < 2:
        return points
    steps = np.linspace(0, 1, 400 // min(len(points), 100), endpoint=False)[:, None]
    dense = (points[:-1, None] + steps * np.diff(points, axis=0)[:, None]).reshape(-1, 2)
    return dense[np.all((dense >= room.min) & (dense <= room.max), axis=1)]


def _through(points, box):
    inner = Bbox.from_extents(box.x0 + 1, box.y0 + 2, box.x1 - 1, box.y1 - 2)
    return inner.count_contains(points) > 0

"""Names of curves stand apart, in the order of the curves, and their lines do not cross."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.figure import Figure

from yawdesign.output.label_places import Named, names_beside, names_inside
from yawdesign.output.style import line_of


@pytest.fixture
def ax():
    axes = Figure(figsize=(7, 4.5), layout="constrained").add_subplot()
    axes.set(xlim=(0, 1), ylim=(0, 1))
    return axes


def named(points):
    return [Named(f"curve {k}", np.array([point]), line_of(k)) for k, point in enumerate(points)]


@pytest.mark.parametrize("heights", [[0.5, 0.5, 0.5, 0.51], [0.0, 0.0, 0.0, 1.0], [0.9, 1.4, 0.1, -3.0]])
def test_names_beside_keep_the_order_of_the_curves(heights, ax, layout_faults):
    names_beside(ax, named([(1.0, height) for height in heights]))
    places = [text.xyann[1] for text in ax.texts]
    assert layout_faults(ax) == []
    assert np.all(np.diff(places) > 0)
    order = np.argsort(heights, kind="stable")
    assert [text.get_text() for text in ax.texts] == [f"curve {k}" for k in order]
    assert 0 <= min(places) <= max(places) <= 1


def test_names_inside_find_room_in_a_crowd(ax, layout_faults):
    random = np.random.default_rng(5)
    points = 0.6 + 0.03 * random.standard_normal((8, 2))
    ax.plot([0.2, 0.9], [0.5, 0.72])
    for point in points:
        ax.plot(*point, "o")
    names_inside(ax, named(points), 0.0, 0.8)
    assert layout_faults(ax) == []
    right = ax.transData.transform((0.8, 0))[0]
    assert all(text.get_window_extent().x1 <= right for text in ax.texts if text.get_text())
    lines = [np.array([text.xy, ax.transData.inverted().transform(_end(ax, text))]) for text in ax.texts[1::2]]
    assert len(lines) == 8
    assert not any(_cross(one, other) for one, other in combinations(lines, 2))


def _end(ax, leader):
    return ax.transData.transform(leader.xy) + np.array(leader.xyann) * ax.get_figure().dpi / 72


def _cross(one, other):
    a, b = one[1] - one[0], other[1] - other[0]
    matrix = np.column_stack([a, -b])
    if abs(np.linalg.det(matrix)) < 1e-12:
        return False
    s, t = np.linalg.solve(matrix, other[0] - one[0])
    return 1e-6 < s < 1 - 1e-6 and 1e-6 < t < 1 - 1e-6

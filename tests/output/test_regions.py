"""Areas and lines on a grid: no point on the wrong side, and no place twice or never."""

from itertools import pairwise

import numpy as np
import pytest

from yawdesign.output.regions import Regions

NONE = np.nan


def regions(kinds, across=None, upright=None):
    kinds = np.array(kinds, dtype=np.int8)
    rows, columns = kinds.shape
    across = np.full((rows, columns - 1), NONE) if across is None else np.array(across)
    upright = np.full((rows - 1, columns), NONE) if upright is None else np.array(upright)
    return Regions(np.arange(columns, dtype=float), np.arange(rows, dtype=float), kinds, across, upright)


def size(path):
    """Return the size of an area whose outer lines run counterclockwise."""
    starts = [*np.flatnonzero(path.codes == path.MOVETO), len(path.codes)]
    total = 0.0
    for first, last in pairwise(starts):
        x, y = path.vertices[first:last].T
        total += 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
    return total


def test_a_line_passes_through_the_places_where_the_kind_changes():
    found = regions([[0, 1], [0, 1], [0, 1]], across=[[0.1], [0.7], [0.4]])
    assert found.lines(0) == [[(0.1, 0.0), (0.7, 1.0), (0.4, 2.0)]]
    assert found.lines(1) == [[(0.4, 2.0), (0.7, 1.0), (0.1, 0.0)]]
    assert size(found.outline(0)) == pytest.approx(0.4 + 0.55)


@pytest.mark.parametrize("seed", range(10))
def test_every_place_belongs_to_one_kind(seed):
    random = np.random.default_rng(seed)
    kinds = random.integers(0, 3, (6, 7))
    i, j = np.arange(6), np.arange(5)[:, None]
    found = regions(kinds, i + random.uniform(0.1, 0.9, (6, 6)), j + random.uniform(0.1, 0.9, (5, 7)))
    assert sum(size(found.outline(kind)) for kind in found.found()) == pytest.approx(5 * 6)
    for (row, column), kind in np.ndenumerate(kinds):
        inner = min(max(column, 1e-6), 6 - 1e-6), min(max(row, 1e-6), 5 - 1e-6)
        assert [k for k in found.found() if found.outline(k).contains_point(inner)] == [kind]


def test_an_island_and_a_whole_grid():
    found = regions([[1, 1, 1], [1, 0, 1], [1, 1, 1]])
    (loop,) = found.lines(0)
    assert loop[0] == loop[-1]
    assert size(found.outline(0)) == pytest.approx(0.5)
    assert size(found.outline(1)) == pytest.approx(3.5)
    assert size(regions([[1, 1], [1, 1]]).outline(1)) == pytest.approx(1.0)


def test_a_line_around_another_kind_can_be_left_out():
    found = regions([[0, 1, 2], [0, 1, 2]])
    assert found.lines(1) == [[(0.5, 1.0), (0.5, 0.0)], [(1.5, 0.0), (1.5, 1.0)]]
    assert found.lines(1, without=2) == [[(0.5, 1.0), (0.5, 0.0)]]

"""In every picture of modes and responses each text can be read: none on another, on a line or outside."""

import pytest
from matplotlib.figure import Figure


def axes():
    ax = Figure(layout="constrained").add_subplot()
    ax.set(xlim=(0, 1), ylim=(0, 1))
    return ax


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ((0.5, 0.5), []),
        ((1.2, 0.5), ["outside the figure: 'here'"]),
        ((0.5, 0.3), ["on each other: 'there' and 'here'"]),
        ((0.5, 0.8), ["on a line: 'here'"]),
    ],
)
def test_the_check_itself(place, words, layout_faults):
    ax = axes()
    ax.plot([0, 1], [0.8, 0.8])
    ax.text(0.5, 0.3, "there")
    ax.text(*place, "here").set_in_layout(False)
    assert layout_faults(ax) == words


def test_the_check_of_sizes(layout_faults):
    ax = axes()
    ax.text(0.5, 0.5, "tiny", fontsize=6)
    assert layout_faults(ax) == ["smaller than 8.0 pt: 'tiny'"]
    ax.texts[0].set(fontsize=8)
    ax.text(0.5, 0.8, "boxed", bbox={"facecolor": "white"})
    ax.plot([0, 1], [0.8, 0.8])
    assert layout_faults(ax) == []

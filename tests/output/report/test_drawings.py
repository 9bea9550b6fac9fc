"""Pictures of a report keep their room: whatever long names users give, and wherever a mark stands."""

import warnings

import pytest
from matplotlib.figure import Figure

import yawdesign as yd
from yawdesign.output import style
from yawdesign.output.pictures import legend_below
from yawdesign.output.report.drawings import bars, marked
from yawdesign.output.report.fragments import figure

LONG = "a road of many words " * 9 + "x" * 300


def drawn(axes):
    """Draw as a page does, where a layout that does not fit is an error."""
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="constrained_layout")
        return figure(axes, "picture", "title", "description")


def test_long_names_of_bars_are_cut():
    axes = bars([LONG, "short"], [1.0, -2.0], "margin", ["1", "-2"], style.UNSTABLE)
    first, second = (label.get_text() for label in axes.get_yticklabels())
    assert first.startswith("a road of many words")
    assert first.endswith("...")
    assert (first.count("\n"), second) == (2, "short")
    drawn(axes)


def test_a_long_label_of_a_legend_is_wrapped():
    axes = Figure(layout="constrained", figsize=(6.4, 3.5)).add_subplot()
    axes.plot([0, 1], [0, 1], label=LONG[:250])
    legend_below(axes)
    assert axes.get_legend().get_texts()[0].get_text().count("\n") > 1
    drawn(axes)


@pytest.mark.parametrize("C_s", [1.0, 3e5, 1e8])
def test_the_axis_of_the_damping_holds_the_design(C_s):
    axes = yd.plot(yd.design(yd.table1()), beside=[C_s])
    low, high = axes.get_xlim()
    assert low < C_s / 1e3 < high
    assert len(marked(axes, "design", [(C_s / 1e3, 0.5)], transform=axes.get_xaxis_transform()).lines) > 0
    drawn(axes)


def test_a_mark_outside_the_axes_is_left_out():
    axes = Figure(layout="constrained").add_subplot()
    axes.set(xlim=(1, 2), ylim=(1, 2))
    assert not marked(axes, "before", [(9.0, 1.5), (1.5, 0.0)]).lines
    (line,) = marked(axes, "before", [(1.5, 1.5), (9.0, 1.5)]).lines
    assert list(line.get_xdata()) == [1.5]

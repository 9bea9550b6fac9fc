"""Every result that can be shown has a picture."""

from importlib import import_module

from matplotlib.figure import Figure

import yawdesign as yd
from yawdesign.output.pictures import set_title
from yawdesign.output.plots import DRAWN_BY
from yawdesign.problem.result import Result

WITHOUT = {"Export", "Fmu", "StateSpaceModel", "Reproduction"}  # files, matrices, tables


def test_every_public_result_is_drawn():
    public = {
        name for name in yd.__all__ if isinstance(getattr(yd, name), type) and issubclass(getattr(yd, name), Result)
    }
    assert public - WITHOUT == set(DRAWN_BY)
    assert all(callable(getattr(import_module(home), name)) for home, name in DRAWN_BY.values())


def test_no_line_of_a_title_ends_inside_of_a_range_or_before_a_unit():
    ax = Figure(figsize=(7.0, 4.5)).add_subplot()
    for signs in range(40, 70):
        set_title(ax, f"{'x' * signs} 300 km/h, lambda 0.05 ... 0.4 (9 values)")
        lines = ax.get_title("left").split("\n")
        assert not any(line.startswith(("...", "0.4", "km/h")) for line in lines), lines


def test_a_distribution_without_unstable_samples_explains_no_unstable_area():
    slow = yd.table1().replace(speed="100 km/h", uncertainty={"K_m": {"normal": "5 %"}})
    ax = yd.plot(yd.uncertainty(slow, samples=1024), of="margin")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["stable"]

"""Pictures of sweeps, designs and optima: what they show, in which units, and that nothing is opened or changed."""

import dataclasses
from pathlib import Path as Place

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

import yawdesign as yd
from yawdesign.output import style
from yawdesign.output.branches import CriticalColumn, curves, partners, stable_areas
from yawdesign.output.contours import draw_contours
from yawdesign.output.sweep_style import LIMIT_TEXT

PROBLEMS = Place(__file__).parents[2] / "problems"
PRINTED = yd.table1(equations="as-printed")


def drawn(result):
    """Return the axes of a picture that could be saved."""
    ax = yd.plot(result)
    ax.figure.canvas.draw()
    return ax


def words(ax):
    legend = ax.get_legend()
    texts = [text.get_text() for text in legend.get_texts()] if legend else []
    return " | ".join([ax.get_title(loc="left"), ax.get_xlabel(), ax.get_ylabel(), *texts])


def pieces(ax, label):
    """Return the points of the curves with a label."""
    (lines,) = [c for c in ax.collections if c.get_label() == label]
    return [np.asarray(piece) for piece in lines.get_segments()]


def test_a_curve_with_all_its_branches_and_the_stable_side_shaded():
    result = yd.sweep(PRINTED, of="critical", f_m="3:4:101")
    ax = drawn(result)
    for text in ("[Hz]", "kN·s/m", "300 km/h", "held", "becomes stable above", "becomes unstable above", "stable"):
        assert text in words(ax)
    rising = np.concatenate(pieces(ax, "becomes stable above"))
    falling = np.concatenate(pieces(ax, "becomes unstable above"))
    for k, values in enumerate(result.values):
        f, roots = result.axes[0].values[k], result.columns["unstable_roots"][k]
        for value, below in zip(values, roots, strict=False):
            branch = rising if below > 0 else falling
            assert np.min(np.hypot(branch[:, 0] - f, branch[:, 1] / value * 1e3 - 1)) < 1e-9
    assert ax.get_yscale() == "log"


def test_the_stable_area_is_where_no_root_is_unstable():
    result = yd.sweep(PRINTED, of="critical", f_m="3:4:41")
    ax = drawn(result)
    (area,) = [patch for patch in ax.patches if patch.get_label() == "stable"]
    for f, C_s in [(3.1, 30), (3.1, 200), (3.45, 20), (3.45, 200), (3.45, 700), (3.8, 100), (3.8, 900)]:
        inside = area.get_path().contains_point((f, C_s))
        single = PRINTED.replace(K_m=PRINTED.bogie.M_m * (2 * np.pi * f) ** 2, C_s=C_s * 1e3)
        assert inside == yd.stability(single).stable


def test_curves_end_where_they_fold_or_leave():
    nan = np.nan
    left = CriticalColumn(np.array([10.0, nan, nan]), np.array([5.0, nan, nan]), np.array([2, 0, nan, nan]))
    right = CriticalColumn(np.array([9.0, 40.0, 60.0]), np.array([5.0, 7.0, 7.0]), np.array([2, 0, 2, 0]))
    gone = CriticalColumn(np.array([nan]), np.array([nan]), np.array([0.0, nan]))
    x = np.array([1.0, 2.0])
    assert partners(left, right) == [(0, 0)]
    found = curves(x, [left, right], 1.0, 100.0)
    assert found["unstable"] == [[(2.0, 40.0), (1.5, pytest.approx(np.sqrt(2400)))]]
    assert [(2.0, 60.0), (1.5, pytest.approx(np.sqrt(2400)))] in found["stable"]
    assert curves(x, [left, gone], 1.0, 100.0)["stable"] == [[(1.0, 10.0), (1.5, 1.0)]]
    never = CriticalColumn(np.array([nan]), np.array([nan]), np.array([2.0, nan]))
    assert curves(x, [left, never], 1.0, 100.0)["stable"] == [[(1.0, 10.0), (1.5, 100.0)]]
    assert list(stable_areas(x, [never, never], 1.0, 100.0)) == []
    assert len(list(stable_areas(x, [gone, gone], 1.0, 100.0))) == 1


def test_the_stability_chart_with_its_boundary():
    result = yd.sweep(PRINTED, of="stable", C_s=np.geomspace(1e4, 1e6, 30), v="250 km/h:400 km/h:31")
    ax = drawn(result)
    for text in ("running speed $v$ [km/h]", "[kN·s/m]", "stable | unstable", "boundary of stability", "as written"):
        assert text in words(ax)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
    assert ax.get_ylim() == pytest.approx((250, 400))
    line = np.concatenate(pieces(ax, "boundary of stability"))
    at_300 = line[np.argmin(np.abs(line[:, 1] - 300))]
    assert at_300 == pytest.approx([90.7028897787, 300], rel=1e-3)
    swapped = yd.sweep(PRINTED, of="stable", v="250 km/h:400 km/h:31", C_s=np.geomspace(1e4, 1e6, 30))
    assert words(drawn(swapped)) == words(ax)
    others = pieces(drawn(swapped), "boundary of stability")
    assert np.concatenate(others) == pytest.approx(line)


@pytest.mark.parametrize(
    ("of", "axes", "texts"),
    [
        ("decay_rate", {"C_s": "1e4:1e7:30:log"}, ["least decay rate [1/s]", "stable"]),
        ("damping_ratio", {"C_s": "1e4:1e7:30:log"}, ["least damping ratio [%]", "unstable"]),
        ("stable", {"v": "250 km/h:400 km/h:20"}, ["[km/h]", "stable"]),
        ("C_sl", {"f_m": "1:8:50"}, ["kN·s/m", "of the interval chosen", "becomes stable above"]),
        ("design", {"f_m": "1:8:50"}, ["golden section", "limit of the curve", "minimum for stability"]),
        ("critical_speed", {"C_s": "1e4:1e6:20:log"}, ["critical speed $v$ [km/h]", "becomes unstable above"]),
        ("critical", {"xi_m": "0.05:1:50"}, ["damping ratio of the motor suspension"]),
        ("margin", {"C_s": "1e4:1e6:9:log", "lambda_": "0.05:0.4:8"}, ["equivalent", "boundary of stability"]),
        ("decay_rate", {"lambda_": "0.05:0.4:8", "v": "200 km/h:400 km/h:9"}, ["km/h"]),
        ("critical", {"f_m": "1:8:9", "v": "200 km/h:400 km/h:9"}, ["stable for every"]),
        ("C_sl", {"f_m": "1:8:9", "v": "200 km/h:400 km/h:9"}, ["stable without a yaw damper"]),
        ("design", {"f_m": "1:8:9", "v": "200 km/h:400 km/h:9"}, ["natural frequency"]),
        ("critical_speed", {"C_s": "1e4:1e7:5:log", "lambda_": "0.05:0.4:5"}, ["stable at every speed"]),
    ],
)
def test_every_quantity_over_one_and_two_axes(of, axes, texts):
    ax = drawn(yd.sweep(PRINTED, of=of, **axes))
    for text in texts:
        assert text in words(ax)


def test_answers_without_a_value_are_drawn_by_their_reason():
    motionless = PRINTED.replace(K_m=0.0)
    assert "stable for none" in words(drawn(yd.sweep(motionless, of="C_sl", lambda_=[0.1, 0.2, 0.3])))
    over = {"lambda_": [0.1, 0.2, 0.3], "v": [70, 80, 90]}
    assert r"stable for no $C_\mathrm{s}$" in words(drawn(yd.sweep(motionless, of="C_sl", **over)))
    tight = PRINTED.replace(curve=dataclasses.replace(PRINTED.curve, limit=0.001))
    assert "no design" in words(drawn(yd.sweep(tight, of="design", lambda_=[0.1, 0.2, 0.3])))
    assert "no design" in words(drawn(yd.sweep(tight, of="design", **over)))


@pytest.mark.parametrize("of", ["critical", "C_sl", "design", "critical_speed", "stable", "decay_rate"])
def test_an_axis_of_one_value_stands_in_the_title(of):
    several = {"f_m": [2.0, 3.0, 4.0]} | ({"C_s": [1e5, 1e6]} if of in ("stable", "decay_rate") else {})
    for number in range(1, len(several) + 1):
        axes = dict(list(several.items())[-number:])
        ax = drawn(yd.sweep(PRINTED.replace(C_s=1e6), of=of, lambda_=0.15, **axes))
        assert r"$\lambda$ = 0.15" in words(ax).replace("\n", " ")
        assert ("frequency" in ax.get_xlabel()) == ("f_m" in axes)


def test_a_single_point_has_no_picture():
    with pytest.raises(yd.ProblemError, match="a single point has no picture"):
        yd.plot(yd.sweep(PRINTED, of="critical", f_m=3.0, v="300 km/h"))


def test_three_axes_need_a_plane():
    whole = yd.sweep(PRINTED, of="stable", C_s=[5e4, 5e5], v=[70, 90], lambda_=[0.1, 0.2])
    with pytest.raises(yd.ProblemError, match="choose a plane"):
        yd.plot(whole)
    assert r"$\lambda$ = 0.1" in words(drawn(whole.at(lambda_=0.1)))


def test_a_range_of_speeds_is_named():
    problem = PRINTED.replace(speed=yd.SpeedRange(min="250 km/h", max="350 km/h", steps=3))
    ax = drawn(yd.sweep(problem, of="C_sl", lambda_="0.1:0.3:9"))
    assert "250, 300, 350 km/h" in words(ax)
    assert "stable above the curve" in words(ax)


def test_axes_that_are_given_are_used():
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert yd.plot(yd.sweep(PRINTED, of="critical", f_m="1:8:9"), ax=left) is left
    assert yd.plot(yd.design(PRINTED), ax=right) is right


def notes(ax):
    return " | ".join(text.get_text() for text in ax.texts)


def test_forward_design():
    ax = drawn(yd.design(PRINTED))
    assert "Forward design: ok" in words(ax)
    assert "unstable | stable | stable, beyond the curve's limit" in words(ax)
    for text in ("= 90.7 kN·s/m, 3.69 Hz", "= 2 593 kN·s/m, limit of the curve", "= 1 047 kN·s/m, golden section"):
        assert text in notes(ax)
    assert ax.get_xscale() == "log"
    assert not ax.get_yticks().size
    nothing = yd.design(PRINTED.replace(K_m=0.0, curve=None))
    assert "stable for none" in words(drawn(nothing))


def test_a_chart_is_hatched_throughout_where_the_curve_allows_nothing():
    for limit, line in ((0.04, True), (0.001, False)):  # C_su of 626 and -811 kN s/m
        ax = drawn(yd.sweep(PRINTED.replace(limit=limit), of="stable", C_s="1e5:1e6:5:log", v="200 km/h:400 km/h:5"))
        assert "beyond the limit of the curve" in words(ax)
        assert (LIMIT_TEXT in words(ax)) == line
    ax = drawn(yd.sweep(PRINTED, of="stable", C_s="1e5:1e6:5:log", v="200 km/h:400 km/h:5"))
    assert "limit of the curve" not in words(ax)


def test_the_legend_of_a_forward_design_names_what_is_seen_in_any_row_and_nothing_else():
    vehicle = yd.load(PROBLEMS / "vehicle.yaml").replace(**{"lambda": 0.05})
    assert "| unstable | stable, beyond the curve's limit | stable" in words(drawn(yd.design(vehicle)))
    assert "unstable" not in words(drawn(yd.design(PRINTED.replace(speed="100 km/h"))))


def test_every_line_at_a_critical_speed_is_explained():
    found = yd.critical_speed(PRINTED.replace(C_s="10 kN s/m"))
    (first, *_) = found.critical_speeds
    others = tuple(dataclasses.replace(first, v=first.v + k, becomes="neither") for k in (5.0, 6.0))
    ax = drawn(dataclasses.replace(found, critical_speeds=(first, *others)))
    assert words(ax).count("critical speed, unstable on both sides") == 1
    assert "unstable on both sides" not in words(drawn(found))


def bars(ax, colour):
    """Return row, left and right end of the bars with a colour."""
    found = [patch for patch in ax.patches if patch.get_facecolor() == to_rgba(colour)]
    return [(round(p.get_y() + p.get_height() / 2), p.get_x(), p.get_x() + p.get_width()) for p in found]


def test_nothing_beyond_the_limit_of_the_curve_is_green():
    ax = drawn(yd.design(PRINTED))
    assert bars(ax, style.STABLE) == [(0, pytest.approx(90.7029, rel=1e-5), pytest.approx(2593.443, rel=1e-5))]
    assert bars(ax, style.EXCLUDED) == [(0, pytest.approx(2593.443, rel=1e-5), pytest.approx(ax.get_xlim()[1]))]
    low = drawn(yd.design(PRINTED.replace(limit=0.001)))
    assert not bars(low, style.STABLE)
    assert bars(low, style.EXCLUDED)


def test_a_row_for_each_condition():
    problem = PRINTED.replace(conditions={"lambda": [0.15, 0.3]})
    result = yd.design(problem)
    ax = drawn(result)
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names == ["every condition", "lambda 0.15, 300 km/h", "lambda 0.3, 300 km/h"]
    starts = {row: start for row, start, _ in bars(ax, style.STABLE)}
    single = [yd.design(PRINTED.replace(lambda_=conicity)).C_sl / 1e3 for conicity in (0.15, 0.3)]
    assert [starts[k] for k in (1, 2)] == pytest.approx(single, rel=1e-6)
    assert starts[0] == pytest.approx(max(single), rel=1e-6)
    small = Figure(figsize=(7, 2.2)).subplots()
    many = yd.design(PRINTED.replace(conditions={"lambda": np.linspace(0.05, 0.4, 9).tolist()}))
    assert len(yd.plot(many, ax=small).get_yticks()) < len(drawn(many).get_yticks())


def test_of_many_conditions_it_is_said_how_many_are_drawn():
    many = {"lambda": [0.05, 0.10, 0.15, 0.25, 0.40], "creep_factor": [1, 0.7, 0.5]}
    ax = drawn(yd.design(PRINTED.replace(conditions=many)))
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names[0] == f"every condition ({len(names) - 1} shown)"
    assert len(names) - 1 < 15


def test_optimum():
    variables = {"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")}
    best = yd.optimise(PRINTED.replace(design=yd.Design(variables=variables)))
    ax = drawn(best)
    assert "1.29854 1/s" in words(ax)
    assert "before" in words(ax)
    assert "2 593 kN·s/m" in notes(ax)
    with pytest.raises(yd.ProblemError, match="nothing to draw"):
        yd.plot(dataclasses.replace(best, margin=None))


def test_no_value_of_a_map_is_left_white():
    values = np.geomspace(0.02, 8.0, 400).reshape(20, 20)
    values[0, 0] = 0.001
    x = np.arange(20.0)
    ax = Figure().add_subplot()
    whole = [Path.unit_rectangle().transformed(Affine2D().scale(19.0))]
    steps = draw_contours(ax, x, x, values, whole, signed=True)
    assert steps.levels[0] > values.min()  # a few values lie below the lowest step
    assert any(path.contains_point((0.1, 0.1)) for path in steps.get_paths())


def test_every_end_of_an_interval_is_told():
    problem = PRINTED.replace(conditions={"lambda": np.linspace(0.05, 0.4, 5).tolist()})
    ax = drawn(yd.design(problem))
    rows = sum(start > ax.get_xlim()[0] for row, start, _ in bars(ax, style.STABLE) if row)
    told = [note for note in ax.texts if note.get_text().replace(" ", "").replace(".", "").isdigit()]
    assert len(told) >= rows > 2

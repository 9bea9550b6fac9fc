"""Pictures of modes: what is drawn, with which units, and files that move."""

import io
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from rich.console import Console

import yawdesign as yd
from yawdesign.output.animation import FRAMES, gif, svg
from yawdesign.output.mode_plots import mode_paths
from yawdesign.output.mode_tables import modes_tables
from yawdesign.output.plan_view import bodies, extent, find_mode
from yawdesign.output.root_locus import _arrow
from yawdesign.problem.parameters import CarBody

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def modes():
    return yd.modes(yd.table1())


@pytest.fixture(scope="module")
def over_speed():
    return yd.follow_modes(yd.table1(), v=np.linspace(50, 450, 30) / 3.6)


@pytest.fixture(scope="module")
def over_damping():
    return yd.follow_modes(yd.table1(), C_s=np.geomspace(1e4, 5e6, 30))


def test_root_locus(over_damping):
    ax = yd.plot(over_damping)
    assert ax.get_xlabel() == "real part [1/s]"
    assert ax.get_ylabel() == "frequency [Hz]"
    assert legend(ax) == ["10 kN·s/m", "100, 1 000 kN·s/m", "5 000 kN·s/m"]
    texts = {text.get_text() for text in ax.texts}
    assert {"unstable", "wheelset hunting 1", "frame yaw", "yaw damper relaxation"} <= texts
    assert "300 km/h" in ax.get_title("left").replace("\n", " ")


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_lines_of_equal_damping_ratio_are_straight(over_speed):
    ax = yd.plot(over_speed, target=0.05)
    ray = next(line for line in ax.lines if line.get_label() == "damping ratio 5 %").get_xydata()
    points = ax.transData.transform([ray[0], 0.3 * ray[1], ray[1]])
    (x, y), (w, h) = points[1] - points[0], points[2] - points[0]
    assert x / y == pytest.approx(w / h)
    assert -ray[1, 0] / np.hypot(ray[1, 0], 2 * np.pi * ray[1, 1]) == pytest.approx(0.05)


def test_damping_over_speed(over_speed):
    ax = yd.plot(over_speed, of="damping_ratio", target=0.05)
    assert "km/h" in ax.get_xlabel()
    assert ax.get_xlim() == pytest.approx((50, 450))
    k = over_speed.names.index("wheelset hunting 1")
    assert any(np.allclose(line.get_ydata(), 100 * over_speed.damping_ratio[:, k]) for line in ax.lines[:-2])
    assert "wheelset hunting 1" in names(ax)
    assert legend(ax) == ["required, 5 %"]
    assert yd.plot(over_speed, of="damping_ratio").get_legend() is None


def names(ax):
    return {name for text in ax.texts for name in text.get_text().split("\n")}


def test_where_the_vehicle_becomes_stable_is_marked(over_damping):
    ax = yd.plot(over_damping, of="damping_ratio")
    assert legend(ax) == ["becomes stable at about 63.8 kN·s/m"]
    (mark,) = ax.collections
    assert mark.get_segments()[0][0][0] == pytest.approx(63.6, rel=5e-3)


def test_frequency_on_a_logarithmic_axis(over_damping, over_speed):
    ax = yd.plot(over_damping, of="frequency")
    assert ax.get_xscale() == "log"
    assert ax.xaxis.get_major_formatter()(1000.0, 0) == "1 000"
    assert yd.plot(over_speed, of="frequency").get_xscale() == "linear"


def test_paths_from_zero_have_a_linear_axis():
    for values in (np.linspace(0, 0.4, 5), np.linspace(0.4, 0, 5)):
        ax = mode_paths(yd.follow_modes(yd.table1(), **{"lambda": values}), of="frequency")
        assert ax.get_xscale() == "linear"


def test_wrong_options(over_speed):
    with pytest.raises(yd.ProblemError, match="is not one of: root_locus"):
        mode_paths(over_speed, of="locus")
    with pytest.raises(yd.ProblemError, match="give a larger `widest`"):
        mode_paths(over_speed, widest=0.1)


def test_mode_shape_in_plan_view(modes):
    ax = yd.plot(modes, mode="frame yaw")
    title = "Frame yaw: 9.73 Hz, damping ratio 52.4 %\n300 km/h, $C_\\mathrm{s}$ = 1 000 kN·s/m, values as written"
    assert ax.get_title("left") == title
    moved = bodies(modes, find_mode(modes, "frame yaw"))
    assert [body.kind for body in moved] == [*2 * ["wheelset"], *2 * ["motor"], "frame", *2 * ["yaw damper"]]
    assert [body.x for body in moved[:5]] == pytest.approx([1.25, -1.25, 0.75, -0.75, 0])
    with pytest.raises(yd.ProblemError, match="did you mean frame yaw"):
        yd.plot(modes, mode="frame yow")


def test_a_positive_yaw_turns_the_front_to_the_left(modes):
    mode = find_mode(modes, None)
    frame = next(body for body in bodies(modes, mode) if body.kind == "frame")
    ax = yd.plot(modes)
    beam = next(patch for patch in ax.patches if patch.get_label() == "frame")
    drawn = beam.get_xy()[:4]  # the left one: front left, rear left, ...
    lift = drawn[0][1] - drawn[1][1]
    assert np.sign(lift) == np.sign(frame.phi.real)
    assert drawn[:, 1].mean() == pytest.approx(frame.y.real + modes.parameters["b_1"] * np.cos(frame.phi.real))


@pytest.mark.slow
def test_a_body_without_an_outline_is_not_drawn(modes):
    mode = find_mode(modes, "frame yaw")
    shape = {name: value for name, value in mode.shape.items() if name not in ("y_m1", "phi_m1")}
    drawn = bodies(modes, replace(mode, shape={**shape, "y_c": 1.0, "phi_c": 0.1, "th_c": 0.0}))
    assert drawn == tuple(body for k, body in enumerate(bodies(modes, mode)) if k != 2)


@pytest.fixture(scope="module")
def vehicle():
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    return replace(yd.table1(), car_body=body)


def test_a_vehicle_is_drawn_from_above_and_from_behind(vehicle):
    result = yd.modes(vehicle)
    shown = bodies(result, find_mode(result, "lower sway"))
    assert [body.kind for body in shown].count("wheelset") == 5  # four from above, one from behind
    above, behind = (body for body in shown if body.kind == "car body")
    shape, size = find_mode(result, "lower sway").shape, 0.16 * 1.25
    assert above.y == pytest.approx(size * (shape["y_c"] + 0.852 * shape["th_c"]))
    for sign, bogie in ((1, shown[4]), (-1, shown[9])):  # over a bogie it moves by what it moves there
        assert bogie.kind == "frame"
        over = size * (shape["y_c"] + 0.852 * shape["th_c"] + sign * 9.5 * shape["psi_c"])
        assert above.y + bogie.x * above.phi == pytest.approx(over)
    assert behind.phi == pytest.approx(-size * shape["th_c"])  # left, which is left here, goes up with th_c
    assert behind.shift[0].real < 0 < behind.y.real
    left, right, bottom, top = extent(result.parameters)
    for body in shown:
        corners = np.array([corner for outline in body.outlines for corner in outline]) + body.rest
        assert np.all((corners > (left, bottom)) & (corners < (right, top)))
    texts = {text.get_text() for text in yd.plot(result, mode="lower sway").texts}
    assert "leading bogie from behind" in texts
    assert len([g for g in ET.fromstring(svg(result)).iter(SVG + "g") if "data-y" in g.attrib]) == len(shown)


def test_what_is_optional_is_drawn_too(vehicle):
    roll = {"I_b": 3000, "K_1z": 1.2e6, "C_1z": 1e4, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.1}
    result = yd.modes(vehicle.replace(**roll, C_1y=2e4))
    assert any(mode.name.startswith("frame roll") for mode in result.modes)
    yd.plot(result, mode=next(mode.name for mode in result.modes if mode.name.startswith("frame roll")))
    alone = yd.modes(yd.table1().replace(**roll, K_2z=6e5, C_2z=1e4))
    texts = {text.get_text() for text in yd.plot(alone).texts}
    assert "from behind" in texts


def test_damping_of_a_vehicle_shows_what_matters(vehicle):
    paths = yd.follow_modes(vehicle, v=np.linspace(200, 400, 12) / 3.6)
    shown = names(yd.plot(paths, of="damping_ratio")) - {"unstable"}
    assert len(shown) == 10
    assert shown >= {"lower sway", "upper sway", "leading bogie hunting", "trailing bogie hunting", "frame lateral"}
    yd.plot(paths)


def test_the_table_tells_low_conicity_sway(vehicle):
    page = Console(width=200, record=True, file=io.StringIO())
    page.print(modes_tables(yd.modes(vehicle.replace(C_s=1.047e6, lambda_=0.05))))
    assert "LOW-CONICITY SWAY: leading bogie hunting grows, and the car body moves 1.7 times" in page.export_text()
    page.print(modes_tables(yd.modes(vehicle)))
    assert "SWAY:" not in page.export_text()


def test_the_yaw_dampers_join_frame_and_car_body(modes, vehicle):
    alone, carried = modes, yd.modes(vehicle)
    mode = find_mode(alone, "frame yaw")
    frame = next(body for body in bodies(alone, mode) if body.kind == "frame")
    rods, cylinders = (body for body in bodies(alone, mode) if body.kind == "yaw damper")
    assert (rods.y, rods.phi, cylinders.y, cylinders.phi) == (frame.y, frame.phi, 0, 0)
    shown = bodies(carried, find_mode(carried, "lower sway"))
    above = next(body for body in shown if body.kind == "car body")
    trailing = [body for body in shown if body.kind == "yaw damper"][-1]
    assert trailing.y == pytest.approx(above.y + trailing.x * above.phi)
    assert abs(trailing.x) > 1
    without = yd.modes(yd.table1().replace(C_s=0))
    assert "yaw damper" not in {body.kind for body in bodies(without, without.modes[0])}


def test_the_table_holds_amplitude_and_phase(modes):
    ax = yd.plot(modes, mode="frame yaw")
    shape = find_mode(modes, "frame yaw").shape
    cells = [text.get_text() for text in ax.figure.axes[1].texts]
    value = shape["phi_b"]
    degrees = round(np.degrees(np.angle(value)))
    assert cells[cells.index("frame") + 2] == f"{abs(value):.2f} ∠ {degrees}°".replace("-", "−")
    assert len(yd.plot(modes, ax, mode="frame yaw").figure.axes) == 2  # none beside given axes


def test_gif_has_one_cycle(modes):
    picture = Image.open(io.BytesIO(gif(modes)))
    assert picture.n_frames == FRAMES
    frames = []
    for k in (0, FRAMES // 2):
        picture.seek(k)
        frames.append(np.asarray(picture.convert("L"), dtype=float))
    assert np.abs(frames[0] - frames[1]).max() > 50


def test_svg_holds_the_shape(modes):
    root = ET.fromstring(svg(modes, "motor yaw, against each other"))
    moving = [group for group in root.iter(SVG + "g") if "data-y" in group.attrib]
    assert len(moving) == 7
    front, rear = (complex(*map(float, group.get("data-phi").split())) for group in moving[2:4])
    assert front == pytest.approx(-rear)
    assert abs(front) > 0
    assert "requestAnimationFrame" in root.find(SVG + "script").text
    assert root.find(SVG + "title").text.startswith("motor yaw, against each other: 2.86 Hz")


def test_animate_writes_what_the_ending_says(modes, tmp_path):
    assert yd.animate(modes, tmp_path / "a.svg", mode="yaw damper relaxation").read_text().startswith("<svg")
    with pytest.raises(yd.ProblemError, match=r"must end in \.gif or \.svg"):
        yd.animate(modes, tmp_path / "a.png")
    assert [path.name for path in tmp_path.iterdir()] == ["a.svg"]


def test_animate_looks_at_the_file_and_the_mode_before_it_draws(modes, tmp_path, monkeypatch):
    monkeypatch.setattr("yawdesign.output.animation.draw_plan", None)
    (tmp_path / "b.gif").mkdir()
    for name, mode, message in (
        ("none/a.gif", None, "there is no folder"),
        ("b.gif", None, "is a folder"),
        ("a.gif", "frame yow", "did you mean frame yaw"),
    ):
        with pytest.raises(yd.ProblemError, match=message):
            yd.animate(modes, tmp_path / name, mode=mode)


def test_letters_of_a_wide_svg_are_larger(modes, vehicle):
    def size(found):
        image = svg(found).decode()
        width = float(re.search(r'viewBox="\S+ \S+ (\S+) ', image)[1])
        return float(re.search(r'font-size="([\d.]+)"', image)[1]) / width

    assert size(yd.modes(vehicle)) > 0.6 * size(modes)


def test_no_arrow_stands_where_a_path_has_left_the_picture():
    ax = Figure().add_subplot()
    ax.set(xlim=(-10, 0), ylim=(-1, 10))
    away = np.array([[-9.0, 0.0], [-9.5, 0.0], [-20.0, 5.0], [-9.0, 9.0], [-5.0, 9.0], [-1.0, 9.0]])
    _arrow(ax, away, "black")
    assert ax.texts[0].xyann[1] == pytest.approx(9.0)

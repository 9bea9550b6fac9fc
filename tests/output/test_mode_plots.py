"""Pictures of modes: what is drawn, with which units, and files that move."""

import io
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

import yawdesign as yd
from yawdesign.output.animation import FRAMES, gif, svg
from yawdesign.output.mode_plots import mode_paths
from yawdesign.output.mode_tables import modes_tables
from yawdesign.output.plan_view import bodies, extent, find_mode
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
    bar = ax.figure.axes[1]
    assert "kN·s/m" in bar.get_ylabel()
    assert bar.get_ylim() == pytest.approx((10, 5000))
    texts = {text.get_text() for text in ax.texts}
    assert {"stable", "unstable", "wheelset hunting 1", "frame yaw"} <= texts


def test_damping_over_speed(over_speed):
    ax = yd.plot(over_speed, of="damping_ratio", target=0.05)
    assert "km/h" in ax.get_xlabel()
    assert ax.get_xlim() == pytest.approx((50, 450))
    lines = {line.get_label(): line for line in ax.lines}
    k = over_speed.names.index("wheelset hunting 1")
    assert lines["wheelset hunting 1"].get_ydata() == pytest.approx(100 * over_speed.damping_ratio[:, k])
    assert "target 5 %" in lines
    assert "target 5 %" not in {line.get_label() for line in yd.plot(over_speed, of="damping_ratio").lines}


def test_frequency_on_a_logarithmic_axis(over_damping, over_speed):
    assert yd.plot(over_damping, of="frequency").get_xscale() == "log"
    assert yd.plot(over_speed, of="frequency").get_xscale() == "linear"


def test_wrong_options(over_speed):
    with pytest.raises(yd.ProblemError, match="is not one of: root_locus"):
        mode_paths(over_speed, of="locus")
    with pytest.raises(yd.ProblemError, match="give a larger `widest`"):
        mode_paths(over_speed, widest=0.1)


def test_mode_shape_in_plan_view(modes):
    ax = yd.plot(modes, mode="frame yaw")
    assert ax.get_title().startswith("frame yaw: 9.73 Hz, damping ratio 52.4 %\n300 km/h, C_s = 1 000 kN·s/m")
    moved = bodies(modes, find_mode(modes, "frame yaw"))
    assert [body.kind for body in moved] == ["wheelset", "wheelset", "motor", "motor", "frame"]
    assert [body.x for body in moved] == pytest.approx([1.25, -1.25, 0.75, -0.75, 0])
    with pytest.raises(yd.ProblemError, match="did you mean frame yaw"):
        yd.plot(modes, mode="frame yow")


def test_a_positive_yaw_turns_the_front_to_the_left(modes):
    mode = find_mode(modes, None)
    frame = bodies(modes, mode)[-1]
    ax = yd.plot(modes)
    drawn = [patch.get_xy() for patch in ax.patches][-5][:4]  # the frame's left beam: front left, rear left, ...
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
    names = {line.get_label() for line in yd.plot(paths, of="damping_ratio").lines}
    shown = {name for name in names if not name.startswith("_")}
    assert len(shown) == 10
    assert shown >= {"lower sway", "upper sway", "leading bogie hunting", "trailing bogie hunting", "frame lateral"}
    yd.plot(paths)


def test_the_table_tells_low_conicity_sway(vehicle):
    page = Console(width=200, record=True, file=io.StringIO())
    page.print(modes_tables(yd.modes(vehicle.replace(C_s=1.047e6, lambda_=0.05))))
    assert "LOW-CONICITY SWAY: leading bogie hunting grows, and the car body moves 1.7 times" in page.export_text()
    page.print(modes_tables(yd.modes(vehicle)))
    assert "SWAY:" not in page.export_text()


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
    assert len(moving) == 5
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
    monkeypatch.setattr("yawdesign.output.animation.mode_shape", None)
    (tmp_path / "b.gif").mkdir()
    for name, mode, message in (
        ("none/a.gif", None, "there is no folder"),
        ("b.gif", None, "is a folder"),
        ("a.gif", "frame yow", "did you mean frame yaw"),
    ):
        with pytest.raises(yd.ProblemError, match=message):
            yd.animate(modes, tmp_path / name, mode=mode)

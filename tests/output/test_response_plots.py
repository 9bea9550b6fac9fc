"""Pictures and tables of motion: they draw what the result holds, with units."""

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

import yawdesign as yd
from yawdesign.output.response_tables import damper_tables, simulation_tables
from yawdesign.output.response_words import meaning
from yawdesign.problem.parameters import CarBody

PROBLEM = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")


@pytest.fixture(scope="module")
def result():
    return yd.simulate(PROBLEM, speed=["250 km/h", "300 km/h"], duration=5)


def test_time_history(result):
    ax = yd.plot(result)
    assert ax.get_ylabel() == "Lateral displacement of the frame [mm]"
    decays = [f"{v} km/h: free motion decays by {rate} 1/s" for v, rate in ((250, 1.68), (300, 1.37))]
    assert legend(ax) == decays
    assert "started from stationary motion" in title(ax)
    assert ax.lines[1].get_ydata() == pytest.approx(1e3 * result.histories[1]["y_b"])
    part = yd.plot(result, response="yaw_damper_force", speeds=[300 / 3.6], until=1.0)
    assert part.get_ylabel() == "Yaw damper force [kN]"
    assert part.lines[0].get_xdata()[-1] == pytest.approx(1.0)
    with pytest.raises(yd.ProblemError, match="did you mean y_b"):
        yd.plot(result, response="yb")


def test_frequency_response():
    response = yd.frequency_response(PROBLEM, [10, 20, 40])
    ax = yd.plot(response)
    assert ax.lines[0].get_ydata() == pytest.approx(abs(response.y_b))
    lower = ax.figure.axes[1]
    assert lower.get_xlabel() == "frequency [Hz]"
    assert lower.lines[0].get_ydata() == pytest.approx(abs(response.phi_b))
    with pytest.raises(yd.ProblemError, match="give several"):
        yd.plot(yd.frequency_response(PROBLEM))
    assert "unstable" in yd.plot(yd.frequency_response(PROBLEM.replace(C_s=5e4), [10, 20])).get_title("left")


def test_spectrum_and_damper(result):
    ax = yd.plot(yd.spectrum_check(length="5 km"))
    assert "rad/m" in ax.get_xlabel()
    assert "Welch" in legend(ax)[0]
    given = ax.figure.add_subplot()
    assert yd.plot(result.damper, given) is given
    assert given.get_ylabel() == "|Z| of the pair [MN/m]"


def test_the_damper_is_a_curve_between_what_it_is_made_of(result):
    damper = result.damper
    ax = yd.plot(damper)
    for z in damper.over_frequency:
        Z = damper.complex_stiffness(z.frequency)
        assert (abs(Z), np.angle(Z)) == pytest.approx((z.stiffness, z.phase))
    curve, alone = ax.lines[:2]
    assert len(curve.get_xdata()) > 100
    assert np.all(curve.get_ydata() < np.minimum(alone.get_ydata(), damper.K_ds / 1e6))
    assert any(
        text.startswith(f"at the hunting, {damper.hunting_frequency:.3g} Hz") for text in legend(ax.figure.axes[1])
    )


def test_a_long_run_is_an_envelope():
    run = yd.simulate(PROBLEM, speed="300 km/h", duration=20, step="2 ms")
    ax = yd.plot(run)
    upper, lower = ax.figure.axes
    high, low = (line.get_ydata() for line in upper.lines[:2])
    values = 1e3 * run.histories[0]["y_b"]
    assert max(high) == pytest.approx(values.max())
    assert min(low) == pytest.approx(values.min())
    start, stop = lower.get_xlim()
    inside = (run.histories[0].time >= start) & (run.histories[0].time <= stop)
    assert max(abs(values[inside])) == pytest.approx(max(abs(values)))
    assert "free motion decays by 1.37 1/s" in title(ax)
    assert len(yd.plot(run, until=5.0).figure.axes) == 1
    several = yd.simulate(PROBLEM, speed=["250 km/h", "300 km/h"], duration=15, step="2 ms")
    assert [panel.get_title("left") for panel in yd.plot(several).figure.axes[1:]] == [
        "300 km/h: free motion decays by 1.37 1/s"
    ]


def test_growth_is_drawn_beside_the_motion_that_grows():
    run = yd.simulate(PROBLEM.replace(C_s=4e4), speed="300 km/h", duration=6, step="2 ms", start="rest")
    ax = yd.plot(run)
    grown = next(line for line in ax.lines if line.get_label().startswith("growth by"))
    t, y = grown.get_data()
    assert np.log(y[-1] / y[0]) / (t[-1] - t[0]) == pytest.approx(run.runs[0].spectral_abscissa)
    assert max(abs(ax.lines[0].get_ydata())) <= max(y) * (1 + 1e-9)
    assert f"free motion grows by {run.runs[0].spectral_abscissa:.3g} 1/s" in title(ax)
    assert "started from rest" in title(ax)


def test_stationary_responses_are_bars(vehicle):
    found = yd.stationary_response(vehicle)
    ax = yd.plot(found)
    lateral, yaw, accelerations, forces = ax.figure.axes
    names = [text.get_text() for text in lateral.get_yticklabels()]
    widths = {name: bar.get_width() for name, bar in zip(names, lateral.patches, strict=True)}
    assert widths["frame, trailing"] == pytest.approx(1e3 * found.rms["y_b2"])
    assert widths["car body, leading"] == pytest.approx(1e3 * found.rms["y_c1"])
    alone = dict(zip(names, lateral.lines[0].get_xdata(), strict=True))
    assert alone["car body"] == pytest.approx(1e3 * found.rms_of["alignment"]["y_c"])
    assert [panel.get_xlabel() for panel in (yaw, accelerations, forces)] == [
        "yaw [mrad]",
        "lateral acceleration [m/s²]",
        "force [kN]",
    ]
    assert len(forces.patches) == sum("force" in name and "pair" not in name for name in found.rms)


@pytest.fixture(scope="module")
def vehicle():
    body = CarBody(M_c=34500, J_c=1.521e6, I_c=124304, l_c=9.5, h_s=0.852, h_t=0.97, K_2z=610e3, C_2z=9800)
    return replace(yd.table1().replace(C_s="1 MN s/m"), car_body=body)


def title(ax):
    """Return a title as it is read, in one line."""
    return ax.get_title("left").replace("\n", " ")


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_pictures_of_a_vehicle(vehicle):
    result = yd.simulate(vehicle, speed=["250 km/h", "300 km/h"], duration=3)
    ax = yd.plot(result)
    assert ax.get_ylabel() == "Lateral acceleration of the car body above the\nbogie [m/s²]"
    ends = [label.split(":")[0] for label in legend(ax)]
    assert ends == [f"{end}, {v} km/h" for v in (250, 300) for end in ("leading", "trailing")]
    assert ax.lines[3].get_ydata() == pytest.approx(result.histories[1]["y_c2_acceleration"])
    both = yd.plot(result, response=["y_b1", "y_b2"], speeds=[300 / 3.6])
    assert legend(both) == ["leading", "trailing"]
    assert "300 km/h" in title(both)
    assert legend(yd.plot(result, response=["y_b1", "y_w12"], speeds=[300 / 3.6])) == ["y_b1", "y_w12"]
    with pytest.raises(yd.ProblemError, match="phi_b1 is counted in rad, y_b1 in m"):
        yd.plot(result, response=["y_b1", "phi_b1"])
    response = yd.plot(yd.frequency_response(vehicle, [10, 20]))
    assert legend(response.figure.axes[1]) == ["car body", "frame, leading", "frame, trailing"]
    assert len({line.get_color() for line in response.lines}) == 3
    assert {line.get_linestyle() for line in response.lines} == {"-", "--"}
    assert response.get_ylabel() == "Lateral [m per\nm of alignment]"


def test_many_speeds_leave_room_for_their_curves(vehicle):
    one = yd.simulate(vehicle, duration=0.5, start="rest", speed=50)
    (history,), (run,) = one.histories, one.runs
    many = {"histories": [replace(history, speed=50 + k) for k in range(11)]}
    many |= {"runs": [replace(run, speed=50 + k) for k in range(11)]}
    ax = yd.plot(replace(one, **many))
    ax.figure.draw_without_rendering()  # it warns where a layout does not fit
    assert ax.get_window_extent().height > 0.25 * ax.figure.bbox.height


def test_tables_of_a_vehicle(vehicle):
    text = printed(simulation_tables(yd.simulate(vehicle, duration=5)))
    for part in ("y_c1_acceleration", "W_d of ISO", "phi_m22", "to order (leading bogie)", "to order (trailing bogie)"):
        assert part in text
    assert "lateral force (rear, trailing bogie)" in text


def test_a_motion_that_grows_leaves_no_forces_to_order_a_damper_by():
    damper = yd.simulate(yd.table1().replace(C_s="20 kN s/m", **{"lambda": 0.4}), duration=3).damper
    shown = printed(damper_tables(damper))
    assert damper.decay_rate < 0
    assert shown.count("none: free motion grows") == 3
    assert "RMS" not in shown


def test_pictures_and_tables_of_rigid_dampers():
    damper = yd.simulate(yd.table1().replace(C_s="200 kN s/m", K_ds="rigid"), duration=3).damper
    ax = yd.plot(damper)
    assert "rigid joints" in ax.get_title("left")
    assert len(ax.figure.axes[1].get_lines()) == 3  # the phase, and where it hunts: no line of joints
    assert "rigidly mounted" in printed(damper_tables(damper))


def test_what_responses_are_called():
    assert meaning("phi_w2_velocity") == "yaw velocity of the rear wheelset"
    assert meaning("motor_damper_stroke_1") == "motor damper stroke (front)"
    assert meaning("alignment_1") == "alignment (front)"
    assert meaning("phi_b_acceleration") == "yaw acceleration of the frame"
    assert meaning("y_w12") == "lateral displacement of the rear wheelset of the leading bogie"
    assert meaning("th_b2_velocity") == "roll velocity of the frame of the trailing bogie"
    assert meaning("psi_c") == "yaw displacement of the car body"
    assert meaning("y_c1_acceleration") == "lateral acceleration of the car body above the leading bogie"
    assert meaning("alignment_21") == "alignment (front, trailing bogie)"
    assert meaning("yaw_damper_pair_force_2") == "yaw damper pair force (trailing bogie)"


def printed(tables):
    console = Console(file=io.StringIO(), width=100)
    console.print(tables)
    return console.file.getvalue()


def test_tables(result):
    text = printed(simulation_tables(result))
    for part in ("amplitudes settle", "-1.6832", "-1.3697", "(mm, mrad)", "hunting", "The yaw damper to order"):
        assert part in text
    assert "phi_m2" in text
    trailer = yd.simulate(yd.table1("trailer").replace(C_s="1 MN s/m"), "fra-2", duration=5)
    assert "y_m1" not in printed(simulation_tables(trailer))
    assert "from memory" in printed(simulation_tables(trailer))
    assert "1.3697 1/s" in printed(damper_tables(result.damper))


def test_tables_without_damper_and_unstable():
    text = printed(simulation_tables(yd.simulate(yd.table1().replace(C_s=0), duration=5)))
    assert "UNSTABLE" in text
    assert "to order" not in text

"""Pictures and tables of motion: they draw what the result holds, with units."""

import io

import pytest
from rich.console import Console

import yawdesign as yd
from yawdesign.output.response_plots import meaning
from yawdesign.output.response_tables import damper_tables, simulation_tables

PROBLEM = yd.table1(equations="as-printed").replace(C_s="1 046 770 N s/m")


@pytest.fixture(scope="module")
def result():
    return yd.simulate(PROBLEM, speed=["250 km/h", "300 km/h"], duration=5)


def test_time_history(result):
    ax = yd.plot(result)
    assert ax.get_ylabel() == "Lateral displacement of the frame [mm]"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["250 km/h", "300 km/h"]
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
    assert ax.get_xlabel() == "frequency [Hz]"
    assert ax.figure.axes[1].lines[0].get_ydata() == pytest.approx(abs(response.phi_b))
    assert "unstable" in yd.plot(yd.frequency_response(PROBLEM.replace(C_s=5e4), [10, 20])).get_title("left")


def test_spectrum_and_damper(result):
    ax = yd.plot(yd.spectrum_check(length="5 km"))
    assert "rad/m" in ax.get_xlabel()
    assert "Welch" in ax.get_legend().get_texts()[0].get_text()
    given = ax.figure.add_subplot()
    assert yd.plot(result.damper, given) is given
    assert given.get_ylabel() == "|Z| of the pair [MN/m]"


def test_what_responses_are_called():
    assert meaning("phi_w2_velocity") == "yaw velocity of the rear wheelset"
    assert meaning("motor_damper_stroke_1") == "motor damper stroke (front)"
    assert meaning("alignment_1") == "alignment (front)"


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

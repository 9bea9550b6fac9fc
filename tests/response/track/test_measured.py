"""Measured tracks and spectra in files: what is read, and every mistake with its place."""

import numpy as np
import pytest

import yawdesign as yd

HEAD = "distance [m], alignment [mm], cross_level [mm], gauge [mm]"


def written(tmp_path, text, name="track.csv"):
    file = tmp_path / name
    file.write_text(text)
    return file


def rows(n=2000, spacing=0.25, gauge=1435.0):
    x = spacing * np.arange(n)
    y, z = 5 * np.sin(2 * np.pi * x / 25), 4 * np.cos(2 * np.pi * x / 40)
    return [f"{a:.4f}, {b:.6f}, {c:.6f}, {gauge}" for a, b, c in zip(x, y, z, strict=True)]


def test_measured_track(tmp_path):
    track = yd.read_track(written(tmp_path, "\n".join(["# a comment", HEAD, *rows()])))
    assert track.spacing == pytest.approx(0.25)
    assert np.max(np.abs(track.alignment)) == pytest.approx(5e-3, rel=1e-3)
    assert "1435.0 to 1435.0 mm" in track.notes[1]
    assert "does not use it" in track.notes[1]
    history = yd.simulate(yd.table1(), track, speed=50).histories[0]
    where = history.distance
    assert where[-1] == pytest.approx(1999 * 0.25 - 2.5)
    assert history["alignment_2"] == pytest.approx(5e-3 * np.sin(2 * np.pi * where / 25), abs=1e-5)
    assert history["alignment_1"] == pytest.approx(5e-3 * np.sin(2 * np.pi * (where + 2.5) / 25), abs=1e-5)
    angle = 4e-3 / (2 * yd.table1().bogie.b)
    assert history["cross_level_2"] == pytest.approx(angle * np.cos(2 * np.pi * where / 40), abs=1e-5)


def test_units_and_columns_that_may_be_left_out(tmp_path):
    text = "distance [km]; alignment [m]; cross_level [mrad]\n" + "\n".join(
        f"{k / 2000}; {1e-3 * (k % 2)}; 2" for k in range(50)
    )
    track = yd.read_track(written(tmp_path, text))
    assert track.spacing == pytest.approx(0.5)
    assert track.alignment[1] == pytest.approx(1e-3)
    assert track.is_angle
    assert track.cross_level[0] == pytest.approx(2e-3)
    assert len(track.notes) == 1
    alone = yd.read_track(written(tmp_path, "distance [m], alignment [mm]\n0, 1\n0.5, 2\n1, 3\n"))
    assert not alone.cross_level.any()


def test_a_run_starts_settled_on_the_first_values(tmp_path):
    text = "distance [m], alignment [mm]\n" + "\n".join(f"{k / 4}, 3" for k in range(400))
    history = yd.simulate(yd.table1(), written(tmp_path, text)).histories[0]
    assert np.ptp(history["y_b"]) < 1e-9
    assert 0 < history["y_b"][0] < 3e-3


def test_a_sampled_wave_is_answered_like_a_harmonic_track(tmp_path):
    text = "\n".join([HEAD, *(f"{k / 5}, {10 * np.cos(2 * np.pi * k / 100)}, 0, 1435" for k in range(6000))])
    problem = yd.table1()
    history = yd.simulate(problem, written(tmp_path, text), speed="200 km/h").histories[0]
    expected = yd.frequency_response(problem, 20, speed="200 km/h")
    late = history["y_b"][len(history.time) // 2 :]
    assert np.max(np.abs(late)) == pytest.approx(10e-3 * abs(expected.y_b), rel=2e-3)


def mistakes(tmp_path, text, read=yd.read_track):
    with pytest.raises(yd.ProblemError) as error:
        read(written(tmp_path, text))
    return str(error.value).replace(str(tmp_path), "")


def test_all_mistakes_with_their_places(tmp_path):
    lines = rows(50)
    lines[3] = "0.75, , 0, 1435"
    lines[5] = "1.25, 1, x, 1435"
    lines[7] = "1.75, 1, 2"
    text = mistakes(tmp_path, "\n".join([HEAD, *lines]))
    assert "/track.csv:5:7: error: alignment: the value is missing" in text
    assert "/track.csv:7:10: error: cross_level: 'x' is not a number" in text
    assert "/track.csv:9:1: error: there are 3 values, expected 4" in text


def test_distance_that_is_not_even(tmp_path):
    lines = rows(100)
    gap = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], *lines[34:]]))
    assert "track.csv:32:1: error: distance: 8.5 m is a gap of 1.25 m behind 7.25 m" in gap
    swapped = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], lines[31], lines[30], *lines[32:]]))
    assert "is not behind" in swapped
    assert swapped.count("error") == 3
    near = mistakes(tmp_path, "\n".join([HEAD, *lines[:30], "7.35, 0, 0, 1435", *lines[30:]]))
    assert "7.35 m is too near to 7.25 m" in near
    assert "too large" in mistakes(tmp_path, "\n".join([HEAD, *rows(50, spacing=5)]))
    assert "equal steps" in mistakes(tmp_path, "\n".join([HEAD, *["1, 1, 1, 1435"] * 5]))


def test_wrong_units(tmp_path):
    body = "\n".join(rows(10))
    for head, message in (
        ("distance [s], alignment [mm], cross_level [mm], gauge [mm]", "s is a time, expected m"),
        ("distance, alignment [mm], cross_level [mm], gauge [mm]", r"has no unit: write distance [m]"),
        ("distance [m], alignement [mm], cross_level [mm], gauge [mm]", "did you mean alignment"),
        ("distance [m], alignment [mm], alignment [mm], gauge [mm]", "stands twice"),
        ("distance [m], alignment [m], cross_level [mm], gauge [mm]", "is more than 0.5 m: is the unit right?"),
        ("distance [m], alignment [mm], cross_level [mm], gauge [m]", "is neither a gauge"),
        ("distance [m], cross_level [mm], gauge [mm], alinment [mm]", "there is no column alignment [mm]"),
        ("distance [foot], alignment [mm], cross_level [mm], gauge [mm]", "foot"),
    ):
        assert message in mistakes(tmp_path, f"{head}\n{body}")


def test_many_mistakes_are_not_all_listed(tmp_path):
    text = mistakes(tmp_path, "\n".join([HEAD, *["x, 1, 1, 1435"] * 100]))
    assert text.count("is not a number") == 20
    assert "and 80 more" in text


def test_files_that_are_none(tmp_path):
    assert "empty" in mistakes(tmp_path, "\n# nothing\n")
    assert "fewer than three" in mistakes(tmp_path, f"{HEAD}\n0,0,0,1435\n")
    with pytest.raises(yd.ProblemError, match="cannot be read"):
        yd.read_track(tmp_path / "missing.csv")
    file = tmp_path / "latin.csv"
    file.write_bytes("distance [m], alignment [µm]".encode("latin-1"))
    with pytest.raises(yd.ProblemError, match="UTF-8"):
        yd.read_track(file)


def test_a_run_longer_than_the_track(tmp_path):
    file = written(tmp_path, "\n".join([HEAD, *rows(400)]))
    with pytest.raises(yd.ProblemError, match="the measured track ends after"):
        yd.simulate(yd.table1(), file, length="200 m")
    assert yd.simulate(yd.table1(), file, length="50 m").runs[0].duration == pytest.approx(50 * 3.6 / 300)


def track(tmp_path, *lines):
    return yd.read_track(written(tmp_path, "\n".join(lines)))


PLAIN = ("distance [m], alignment [mm]", "0, 1.5", "0.25, -2", "0.5, 3", "0.75, 4e-1")


@pytest.mark.parametrize(
    ("lines", "note"),
    [
        (("distance [m];alignment [mm]", "0;1,5", "0,25;-2", "0,5;3", "0,75;4e-1"), "decimal sign: 1,5 is 1.5"),
        (("distance [m]\talignment [mm]", "0\t1.5", "0.25\t-2", "0.5\t3", "0.75\t0.4\t"), None),
        (("distance [m]\talignment [mm]", "0\t1,5", "0,25\t-2", "0,5\t3", "0,75\t0,4"), "decimal sign: 1,5 is 1.5"),
        (("distance, alignment", "m, mm", "0, 1.5", "0.25, -2", "0.5, 3", "0.75, 0.4"), None),
        (("distance;alignment", "[m];[mm]", "0; 1.5", "0.25; -2", "0.5; 3", "0.75; 0.4;"), None),
        (("distance [m], alignment [mm]", "m, mm", *PLAIN[1:]), None),
        (("distance [m], alignment", ", mm", *PLAIN[1:]), None),
        (
            (
                "n, distance [m], alignment [mm], twist, speed [km/h], ",
                "a, 0, 1.5, ,x, ",
                "b, 0.25, -2, ,, ",
                "c, 0.5, 3,,1_0,",
                "d, .75, .4,#,,",
            ),
            "not used: n, twist, speed, column 6",
        ),
        (("distance [km+m], alignment [mm]", "12+999.5, 1.5", "12+999.75, -2", "13+000, 3", "13+000.25, 0.4"), None),
        (("distance [m], alignment [mm]", "12+999.5, 1.5", "12+999.75, -2", "13+000, 3", "13+000.25, 0.4"), None),
        (("distance [km]; alignment [mm]", "0+000,5; 1,5", "0+000,75; -2", "0+001; 3", "0,00125; 0,4"), "1,5 is 1.5"),
        (("distance [m], alignment [mm]", "7, 1.5", "6.75, -2", "6.5, 3", "6.25, 0.4"), "the distance falls"),
        (("distance [km+m], alignment [mm]", "7+000.25, 1.5", "7+000, -2", "6+999.75, 3", "6+999.5, 0.4"), "7000.25 m"),
        (('"distance [m]","alignment [mm]"', '"0","1.5"', '"0.25","\u22122"', '"0.5","3"', '"0.75","0.4"'), None),
    ],
)
def test_ways_to_write_the_same_track(tmp_path, lines, note):
    found, plain = track(tmp_path, *lines), track(tmp_path, *PLAIN)
    assert np.diff(found.distance) == pytest.approx(np.diff(plain.distance))
    assert found.alignment == pytest.approx(plain.alignment, rel=1e-12)
    assert found.spacing == pytest.approx(0.25)
    notes = "\n".join(found.notes[1:])
    assert notes == "" if note is None else note in notes


def test_a_falling_distance_is_run_over_in_the_order_of_the_rows(tmp_path):
    rows = [f"{100 - k / 4}, {np.sin(k / 40)}" for k in range(400)]
    found = track(
        tmp_path,
        "distance [m], alignment [m]".replace("[m]", "[m]", 1).replace("alignment [m]", "alignment [mm]"),
        *rows,
    )
    assert found.distance[:2] == pytest.approx([0, 0.25])
    assert found.alignment[40] == pytest.approx(1e-3 * np.sin(1))
    assert "counted from 100 m" in found.notes[-1]
    assert "the distance must fall in equal steps" in mistakes(tmp_path, "\n".join([PLAIN[0], *rows[:30], *rows[33:]]))
    result = yd.simulate(yd.table1(), written(tmp_path, "\n".join([PLAIN[0], *rows])))
    assert "the distance falls" in "\n".join(result.notes)


@pytest.mark.parametrize(
    ("head", "row", "note"),
    [
        (
            "distance [m], alignment [mm]",
            "{x}, 0.005",
            "the largest alignment is only 0.005 mm: if the values are in m, write alignment [m] in the head",
        ),
        ("distance [m], alignment [mm], cross_level [mrad]", "{x}, 5, 0.003", "write cross_level [rad] in the head"),
        ("distance [m], alignment [m]", "{x}, 5e-6", "the largest alignment is only 5e-06 m: is the unit right?"),
        ("distance [m], alignment [mm], gauge [mm]", "{x}, 5, 1.435", "write gauge [m] in the head"),
        ("distance [mm], alignment [mm]", "{x}, 5", "the step of the distance is only 0.25 mm: if the values are in m"),
    ],
)
def test_values_of_a_larger_unit_are_noted(tmp_path, head, row, note):
    found = track(tmp_path, head, *(row.format(x=k / 4) for k in range(9)))
    assert note in found.notes[-1]
    assert not any("only" in x or "unit" in x for x in track(tmp_path, *PLAIN).notes)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            ("distance [m];alignment [mm]", "0;1,5", "0.25;2", "0.5;3"),
            ":2:3: error: alignment: '1,5' has a comma, other",
        ),
        (
            ("distance [m];alignment [mm]", "0;1,500", "1;2,000", "2;3"),
            "'1,500' may be 1.500 or 1500: write the decimal",
        ),
        (("distance [m]\talignment [mm]", "0\t1,234,5", "1\t2", "2\t3"), ":2:3: error: alignment: '1,234,5' is not a"),
        (
            ("distance [m], alignment [mm]", "0,0,1,5", "0,25,2,0"),
            ":2:1: error: there are 4 values, expected 2 separated by "
            "commas: distance, alignment; with decimal commas, separate columns by semicolons",
        ),
        (("distance [m]\talignment [mm]", "0, 1", "1, 2"), "there are 1 values, expected 2 separated by tabs"),
        (("distance [m] alignment [mm]", "0 1", "1 2"), ":1:1: error: 'distance [m] alignment [mm]' is not one head"),
        (("distance (m), alignment [mm]", *PLAIN[1:]), "is not known here; did you mean distance [m]?"),
        (
            ("distance [m], alignment [mm]", "km, mm", *PLAIN[1:]),
            ":2:1: error: distance: the unit here is km, in the head",
        ),
        (("distance [m], alignment", *PLAIN[1:]), ":1:15: error: alignment: has no unit: write alignment [mm]"),
        (
            ("distance [m], alignment [mm], cross level [mm]", "0,1,1"),
            "cross level: is not known here; did you mean cross_l",
        ),
        (
            ("distance [m], alignment_left [mm]", "0,1"),
            "alignment_left: is not known here; did you mean alignment [mm]?",
        ),
        (
            ("distance [m], alignment [mm]", "12+34.5, 1", "1, 2", "2, 3"),
            "'12+34.5' is not kilometres, + and three digits",
        ),
        (
            ("distance [km+m], alignment [mm]", "12.5, 1", "1+001, 2"),
            ":2:1: error: distance: '12.5' is not km+m, such as 12+",
        ),
        (("distance [m], alignment [km+m]", "0, 1", "1, 2"), "alignment: '+m' is not part of a unit; expected mm"),
        (("distance [m], alignment []", "0, 1", "1, 2"), "alignment: [] is a plain number, expected mm"),
        (("distance [m], alignment [mm]", "0, 1_0", "1, 2", "2, 3"), ":2:4: error: alignment: '1_0' is not a number"),
        (("distance [m], alignment [mm]", "0, \u0661", "1, 2", "2, 3"), "is not a number"),
        (
            ("distance [m], alignment [mm]", "0, nan", "1, inf", "2, 0x1p3"),
            ":4:4: error: alignment: '0x1p3' is not a number",
        ),
        (("distance [m], alignment [mm]", "0, 1e400", "1, 2", "2, 3"), "'1e400' is too large to compute with"),
        (("distance [m], alignment [Gm]", "0, 1e305", "1, 2", "2, 3"), "'1e305' is too large to compute with"),
        (("distance [m], alignment [mm]", "0, 1e-400", "1, 2", "2, 3"), "'1e-400' is too small to compute with"),
        (
            ("distance [m], alignment [mm]", "0, " + "9" * 100_000, "1, 2", "2, 3"),
            "(100000 characters)' is too large to",
        ),
        (("distance [m], alignment [((((((((((mm^9)^9)^9)^9)^9)^9)^9)^9)^9)^9)]", "0, 1"), "has more than 9 brackets"),
        (("distance [m], alignment [(((((((mm^9)^9)^9)^9)^9)^9)^9)^9]", "0, 1"), "too large or too small a unit"),
    ],
)
def test_what_to_change_in_a_track(tmp_path, lines, message):
    assert message in mistakes(tmp_path, "\n".join(lines))

"""Parts of a page where something is missing: no curve, no front, nothing that the curve allows, an unstable design."""

from types import SimpleNamespace

import pytest

import yawdesign as yd
from yawdesign.output.report.condition_sections import chart, mounts
from yawdesign.output.report.design_sections import before_and_after, intervals

BOGIE = yd.table1().replace(design={"variables": {"C_s": {"min": "10 kN s/m", "max": "60 kN s/m"}}}, **{"lambda": 0.4})
TIGHT = yd.table1().replace(limit=0.001)
GRID = {"C_s": "100 kN s/m:1 MN s/m:4:log", "v": "200 km/h:300 km/h:3"}


def review(problem, **parts):
    """Return what the sections look at, without what takes long."""
    nothing = dict.fromkeys(("front", "before", "after", "chart", "mounts", "optimum", "forward"))
    return SimpleNamespace(**nothing | {"problem": problem, "design": problem, "each_condition": ()} | parts)


def test_without_a_front_there_is_no_golden_section_beside_the_design():
    stable = yd.table1().replace(curve=None, design={"variables": {"C_s": {"min": "10 kN s/m", "max": "10 MN s/m"}}})
    optimum = yd.optimise(stable)
    body = before_and_after(review(stable, optimum=optimum, before=yd.stability(stable))).body
    assert "golden section" not in body
    assert "not given" not in body
    assert "rotational resistance" not in body
    assert optimum.message == "best design found within the bounds"


def test_margins_below_zero_have_a_minus_sign():
    optimum = yd.optimise(BOGIE)
    body = before_and_after(review(BOGIE, optimum=optimum, before=yd.stability(BOGIE))).body
    assert f"\u2212{-optimum.margin:.6g} 1/s" in body
    assert f"-{-optimum.margin:.6g}" not in body
    assert "not computed" in body


def test_a_curve_that_allows_nothing_is_told_in_words():
    forward = yd.design(TIGHT)
    body = intervals(review(TIGHT, optimum=SimpleNamespace(C_s=None), forward=forward)).body
    assert "none: K_2x and C_t alone exceed the limit" in body
    assert f"{forward.C_su / 1e3:.6g}" not in body
    assert "... no limit" in body


@pytest.mark.parametrize(("problem", "line"), [(TIGHT, False), (TIGHT.replace(limit=0.04), True)])
def test_the_dashed_line_is_told_of_where_it_is_drawn(problem, line):
    body = chart(review(problem, chart=yd.sweep(problem, of="stable", **GRID))).body
    assert ("the dashed line" in body) == line


def test_the_square_is_told_of_where_the_motor_suspension_changes():
    sweep = yd.sweep(yd.table1(), of="decay_rate", f_m="1:8:4", xi_m="0.1:1:4")
    for written, told in ((yd.table1(), False), (yd.table1().replace(K_m="1 MN/m"), True)):
        assert ("the square" in mounts(review(written, design=yd.table1(), mounts=sweep)).body) == told

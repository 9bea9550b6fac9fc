"""How mistakes are shown, and the nearest right name."""

import pickle

import pytest

from yawdesign.problem import Diagnostic, ProblemError
from yawdesign.problem.diagnostics import Mistakes, nearest

SHOWN = Diagnostic(
    path="problem.yaml",
    line=8,
    column=9,
    key="bogie.K_ds",
    message="-40 MN/m is outside 1e-06 ... 1e+12 MN/m",
    source_line="  K_ds: -40 MN/m",
    length=8,
)


def test_a_diagnostic_shows_place_text_line_and_underline():
    assert SHOWN.render() == (
        "problem.yaml:8:9: error: bogie.K_ds: -40 MN/m is outside 1e-06 ... 1e+12 MN/m\n"
        "     8 |   K_ds: -40 MN/m\n"
        "       |         ^^^^^^^^"
    )


def test_a_diagnostic_without_a_place_is_one_line():
    assert Diagnostic(message="too heavy", key="bogie.W").render() == "error: bogie.W: too heavy"
    assert Diagnostic(message="odd", severity="warning", path="a.yaml").render() == "a.yaml: warning: odd"


def test_a_long_line_is_cut_around_the_mistake():
    long = Diagnostic(message="m", line=1, column=5001, source_line="x" * 5000 + "HERE" + "y" * 5000, length=4)
    _, shown, carets = long.render().splitlines()
    assert len(shown) < 200
    assert shown[carets.index("^") : carets.rindex("^") + 1] == "HERE"


def test_control_characters_do_not_reach_the_terminal():
    assert "\x1b" not in Diagnostic(message="m", line=1, column=1, source_line="a\x1b[31mb\tc").render()
    assert Diagnostic(message="\x1b[31m", key="\ud800", path="a\nb").render() == r"a\nb: error: \ud800: \x1b[31m"


def test_the_error_shows_all_and_travels():
    error = ProblemError([SHOWN, Diagnostic(message="second")])
    assert str(error).endswith("error: second")
    assert pickle.loads(pickle.dumps(error)).diagnostics == error.diagnostics
    assert ProblemError("text").under("W").diagnostics[0].key == "W"


def test_mistakes_let_other_exceptions_through():
    mistakes = Mistakes()
    with pytest.raises(ZeroDivisionError), mistakes.under("x"):
        raise ZeroDivisionError
    mistakes.report()


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("K1x", "K_1x"),
        ("k_1x", "K_1x"),
        ("K-1x", "K_1x"),
        ("conicity", "lambda"),
        ("Lambda", "lambda"),
        ("v", "speed"),
        ("spede", "speed"),
        ("qqqq", None),
        ("x" * 10**6, None),
    ],
)
def test_nearest(name, found):
    assert nearest(name, ["K_1x", "K_1y", "lambda", "speed"]) == found

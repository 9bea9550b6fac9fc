"""What people see of long work: in a terminal, in a file, in a notebook; and that its shares grow with the work."""

import sys
import time
from itertools import pairwise
from types import ModuleType, SimpleNamespace

import pytest

import yawdesign as yd
from yawdesign.output import progress_shown
from yawdesign.output.progress_shown import FIRST, progress_on_stderr
from yawdesign.problem.progress import between, rising, rounds
from yawdesign.study import executors

PLAIN = yd.table1().replace(C_s="1 046 770 N s/m")
C_S = {"C_s": yd.Variable(min="10 kN s/m", max="10 MN s/m")}
UNCERTAIN = {"lambda": {"uniform": [0.05, 0.4]}, "K_m": {"normal": "10 %"}}
DAMPERS = tuple(yd.CatalogueDamper(name=f"D{k}", damping=2e5 + 1e5 * k, stiffness=2e7) for k in range(12))
# More than any yaw damping gives: what excludes it is looked for, and what to change.
MISSED = PLAIN.replace(design=yd.Design(variables=C_S), requirements={"damping_ratio": "20 %"})


def without_answer(told):
    return yd.optimise(MISSED, progress=told)


@pytest.mark.parametrize(
    ("work", "least"),
    [
        (lambda told: yd.sweep(PLAIN, lambda_="0.05:0.4:30", f_m="1:6:30", progress=told), 5),
        (
            lambda told: yd.sweep(
                PLAIN, of="stable", lambda_="0.05:0.4:30", C_s="0.1 MN s/m:1 MN s/m:30", progress=told
            ),
            5,
        ),
        (lambda told: yd.optimise(PLAIN.replace(design=yd.Design(variables=C_S)), progress=told), 10),
        pytest.param(without_answer, 15, marks=pytest.mark.slow),
        (lambda told: yd.choose(PLAIN.replace(design=yd.Design(catalogue=DAMPERS)), progress=told), 8),
        pytest.param(
            lambda told: yd.uncertainty(PLAIN.replace(uncertainty=UNCERTAIN), samples=2**10, progress=told),
            50,
            marks=pytest.mark.slow,
        ),
        (lambda told: yd.simulate(PLAIN, speed=[70.0, 80.0], duration=15.0, progress=told), 6),
        pytest.param(lambda told: yd.trade_off(PLAIN, points=3, progress=told), 50, marks=pytest.mark.slow),
    ],
    ids=["sweep", "sweep with lines", "optimise", "conflict", "choose", "uncertainty", "simulate", "trade-off"],
)
def test_shares_grow_with_the_work(work, least, monkeypatch):
    monkeypatch.setattr(executors, "HERE", 200)
    calls = []
    work(lambda text, part: calls.append((text, part)))
    texts, shares = zip(*calls, strict=True)
    assert shares[0] < 0.5
    assert all(0.0 <= one <= other <= 1.0 + 1e-12 for one, other in pairwise(shares))
    assert len(set(shares)) >= least
    assert max(other - one for one, other in pairwise(shares)) < 0.5
    assert shares[-1] > 0.4  # a search that finds something is spared the looking for what to change
    assert "starting" not in texts
    if work is without_answer:
        assert any(text.startswith("relaxing ") for text in texts)
        assert any(text.startswith("looking for a design without ") for text in texts)


def test_the_first_points_of_a_sweep_are_told_soon():
    """A grid of any size begins with few points: what comes first is not a chunk of many thousands."""
    calls = []
    yd.sweep(PLAIN, of="stable", lambda_="0.05:0.4:200", f_m="1:6:200", progress=lambda *call: calls.append(call))
    assert [text for text, _ in calls[:2]] == ["64 of 40000 points", "128 of 40000 points"]


def test_parts_of_a_whole():
    told = []
    between(lambda *call: told.append(call), 0.5, 1.0)("x", 0.5)
    for _, one in zip(range(3), rounds(lambda *call: told.append(call)), strict=False):
        one("y", 1.0)
    assert [part for _, part in told] == [0.75, 0.5, 0.75, 0.875]
    up = []
    for part in (0.2, 0.1, 3.0):
        rising(lambda text, share: up.append(share))("z", part)
    largest = rising(lambda text, share: up.append(share))
    for part in (0.2, 0.1, 3.0):
        largest("z", part)
    assert up[-3:] == [0.2, 0.2, 1.0]


def test_a_line_now_and_then_where_no_terminal_is(monkeypatch, capsys):
    seconds = iter([0.0, 1.0, 4.9, 5.1, 5.1, 9.0, 15.0, 15.2, 15.2])
    monkeypatch.setattr(progress_shown, "monotonic", lambda: next(seconds))
    with progress_on_stderr() as told:
        for part in (0.01, 0.1, 0.2, 0.3, 0.35, 0.4):
            told("searching [red]\u202e", part)
    shown = capsys.readouterr()
    assert shown.err == " 20 %: searching [red]\ufffd\n 40 %: searching [red]\ufffd\n"
    assert shown.out == ""


def test_short_work_is_silent_where_no_terminal_is(capsys):
    with progress_on_stderr() as told:
        told("quick", 0.5)
    assert capsys.readouterr() == ("", "")


def test_a_bar_in_a_terminal_moves_to_and_fro_until_there_is_a_share(monkeypatch, capsys):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setenv("COLUMNS", "100")
    with progress_on_stderr() as told:
        time.sleep(0.25)
        told("[red]at[/red] work", 0.42)
        time.sleep(0.25)
    text = capsys.readouterr().err
    assert FIRST in text
    assert "[red]at[/red] work" in text
    assert "42%" in text
    assert "0%" not in text.split("[red]")[0]


@pytest.fixture
def kernel(monkeypatch):
    """Return what a notebook was told to show, with a kernel that is none."""
    shown = []

    class Handle:
        def update(self, what):
            shown.append(what)

    def display(what, display_id):
        shown.append(what)
        return Handle()

    ipython, displays = ModuleType("IPython"), ModuleType("IPython.display")
    ipython.get_ipython = lambda: SimpleNamespace(kernel=object())
    displays.HTML, displays.display = str, display
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", displays)
    monkeypatch.setattr(progress_shown, "UPDATES_APART", 0.0)
    return shown


def test_a_bar_in_a_notebook(kernel):
    yd.sweep(PLAIN, of="stable", lambda_="0.05:0.4:9")
    assert FIRST in kernel[0]
    assert 'value="1.000"' in kernel[-2]
    assert "9 of 9 points" in kernel[-2]
    assert kernel[-1] == ""


def test_a_bar_goes_when_the_work_fails(kernel):
    with pytest.raises(yd.ProblemError):
        yd.sweep(PLAIN, of="stable", lambda_=[-1.0])
    assert kernel[-1] == ""


def test_who_asks_for_progress_gets_no_bar_and_a_wrong_call_neither(kernel):
    yd.sweep(PLAIN, of="stable", lambda_=[0.1], progress=lambda text, part: None)
    yd.stability(PLAIN)
    assert kernel == []


def test_no_bar_in_scripts(kernel, monkeypatch):
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", SimpleNamespace)  # IPython in a terminal
    yd.sweep(PLAIN, of="stable", lambda_=[0.1])
    monkeypatch.delitem(sys.modules, "IPython")
    yd.sweep(PLAIN, of="stable", lambda_=[0.1])
    assert kernel == []

"""The rooms of the house: imports go one way, between rooms and between modules, and a name stands for one thing."""

import ast
import importlib
import importlib.util
import inspect
import sys
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import yawdesign

FILE = Path(__file__).parents[1] / "docs" / "figures" / "rooms.py"
SPEC = importlib.util.spec_from_file_location("rooms", FILE)
rooms = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(rooms)
ROOT, MODULES, NAMED, ROOMS = rooms.ROOT, rooms.MODULES, rooms.NAMED, (*rooms.ROOMS, "__main__")
# What a room may import from outside, where that is restricted.
FORBIDDEN = {"problem": {"casadi", "scipy", "numpy", "matplotlib"}, "output": {"casadi"}}
# Names of files that say nothing of what is inside.
VAGUE = {
    *("block", "choice", "chunks", "columns", "draft", "following", "kernels", "linking", "march", "model", "models"),
    *("modes", "motion", "points", "question", "runs", "speeds", "starts", "states", "thorough", "track", "walking"),
}


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_go_to_the_left(path):
    own = rooms.room_of(path)
    assert own in ROOMS, f"{own} has no place in the order of rooms"
    for room in rooms.rooms_before(path):
        assert room in ROOMS, f"{path.name} imports yawdesign.{room}, which is in no room"
        assert ROOMS.index(room) <= ROOMS.index(own), f"{own} must not import from {room}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_rooms_may_import_from_outside(path):
    outside = {name.split(".")[0] for name in rooms.imports(path)} - {"yawdesign"}
    if rooms.room_of(path) == "vehicle":
        assert outside <= set(sys.stdlib_module_names)
    assert not outside & FORBIDDEN.get(rooms.room_of(path), set())


def modules_of(path):
    """Return the modules of the package that a module imports, or imports something from."""
    found = {name if name in NAMED else name.rpartition(".")[0] for name in rooms.imports(path)}
    return found & set(NAMED) - {rooms.name_of(path)}


def test_no_module_comes_back_to_itself():
    """Not by imports inside functions either: who opens a module goes on, and never around."""
    try:
        TopologicalSorter({name: modules_of(path) for name, path in NAMED.items()}).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_file_names_say_what_is_inside():
    assert not {path for path in MODULES if path.stem in VAGUE}


def test_a_class_name_stands_for_one_class():
    trees = (ast.parse(path.read_text(encoding="utf-8")) for path in MODULES)
    names = Counter(node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    assert not [name for name, count in names.items() if count > 1]


@pytest.mark.parametrize(("home", "name"), [("output.plots", "DRAWN_BY"), ("output.tables_by_result", "TABLES_BY")])
def test_what_shows_a_result_is_there(home, name):
    for kind, (module, function) in getattr(importlib.import_module(f"yawdesign.{home}"), name).items():
        assert inspect.isclass(getattr(yawdesign, kind))
        assert callable(getattr(importlib.import_module(module), function))


def test_the_drawing_is_of_these_rooms():
    drawn = FILE.with_suffix(".svg").read_text(encoding="utf-8")
    assert drawn == rooms.drawing(), "python docs/figures/rooms.py draws it anew"


@pytest.mark.parametrize("path", sorted((ROOT / "response").glob("*/*.py")), ids=lambda path: "/".join(path.parts[-2:]))
def test_the_response_goes_from_modes_over_the_track_to_the_run(path):
    order = ("modes", "track", "run")
    used = {name.split(".")[2] for name in rooms.imports(path) if name.startswith("yawdesign.response.")}
    assert used <= set(order[: order.index(path.parent.name) + 1])


def test_something_was_looked_at():
    assert "yawdesign.hunting.verdict" in modules_of(ROOT / "response" / "run" / "simulate.py")
    assert "yawdesign.output.sweep_plots" in modules_of(ROOT / "output" / "plots.py")
    assert {rooms.room_of(path) for path in MODULES} >= {"problem", "vehicle", "hunting"}
    assert "yawdesign.vehicle.polynomials.Number" in set(rooms.imports(ROOT / "vehicle" / "elements.py"))

"""The rooms of the house: imports go one way, between rooms and between modules, and a name stands for one thing."""

import ast
import importlib
import inspect
import sys
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import yawdesign

ROOMS = ("problem", "vehicle", "hunting", "response", "damper", "study", "exports", "output", "cli", "__main__")
ROOT = Path(yawdesign.__file__).parent
MODULES = sorted(path for path in ROOT.rglob("*.py") if path != ROOT / "__init__.py")
# What a room may import from outside, where that is restricted.
FORBIDDEN = {"problem": {"casadi", "scipy", "numpy", "matplotlib"}, "output": {"casadi"}}
# Names of files that say nothing of what is inside.
VAGUE = {
    *("block", "choice", "chunks", "columns", "draft", "following", "kernels", "linking", "march", "model", "models"),
    *("modes", "motion", "points", "question", "runs", "speeds", "starts", "states", "thorough", "track", "walking"),
}


def room_of(path):
    """Return the room a module stands in: the first folder, or the module's own name."""
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def name_of(path):
    """Return the full name of a module."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(["yawdesign", *(part for part in parts if part != "__init__")])


NAMES = {name_of(path): path for path in MODULES}


def imports(path):
    """Yield the full name of everything that a module imports: in functions, for type checkers, by a text."""
    package = ("yawdesign", *path.relative_to(ROOT).parts[:-1])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and node.value in NAMES:
            yield node.value
        elif isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level] if node.level else ()
            origin = ".".join([*base, *filter(None, [node.module])])
            yield from (f"{origin}.{name.name}" for name in node.names)


def inside(path):
    """Yield the rooms a module imports from. The version stands above all rooms and is open to each."""
    for name in imports(path):
        first, *rest = name.split(".")
        if first == "yawdesign" and rest != ["__version__"]:
            yield rest[0] if rest else "the package as a whole"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_go_to_the_left(path):
    own = room_of(path)
    assert own in ROOMS, f"{own} has no place in the order of rooms"
    for room in inside(path):
        assert room in ROOMS, f"{path.name} imports yawdesign.{room}, which is in no room"
        assert ROOMS.index(room) <= ROOMS.index(own), f"{own} must not import from {room}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_rooms_may_import_from_outside(path):
    outside = {name.split(".")[0] for name in imports(path)} - {"yawdesign"}
    if room_of(path) == "vehicle":
        assert outside <= set(sys.stdlib_module_names)
    assert not outside & FORBIDDEN.get(room_of(path), set())


def modules_of(path):
    """Return the modules of the package that a module imports, or imports something from."""
    found = {name if name in NAMES else name.rpartition(".")[0] for name in imports(path)}
    return found & set(NAMES) - {name_of(path)}


def test_no_module_comes_back_to_itself():
    """Not by imports inside functions either: who opens a module goes on, and never around."""
    try:
        TopologicalSorter({name: modules_of(path) for name, path in NAMES.items()}).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_file_names_say_what_is_inside():
    assert not {path for path in MODULES if path.stem in VAGUE}


def test_a_class_name_stands_for_one_class():
    trees = (ast.parse(path.read_text(encoding="utf-8")) for path in MODULES)
    names = Counter(node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    assert not [name for name, count in names.items() if count > 1]


@pytest.mark.parametrize(("home", "name"), [("output.plots", "DRAWN_BY"), ("cli.answering", "TABLES_BY")])
def test_what_shows_a_result_is_there(home, name):
    for kind, (module, function) in getattr(importlib.import_module(f"yawdesign.{home}"), name).items():
        assert inspect.isclass(getattr(yawdesign, kind))
        assert callable(getattr(importlib.import_module(module), function))


def test_something_was_looked_at():
    assert "yawdesign.hunting.verdict" in modules_of(ROOT / "response" / "run" / "simulate.py")
    assert "yawdesign.output.sweep_plots" in modules_of(ROOT / "output" / "plots.py")
    assert {room_of(path) for path in MODULES} >= {"problem", "vehicle", "hunting"}
    assert "yawdesign.vehicle.polynomials.Number" in set(imports(ROOT / "vehicle" / "elements.py"))

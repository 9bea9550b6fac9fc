"""The rooms of the house: a module imports only from its own room or from rooms to its left."""

import ast
import sys
from pathlib import Path

import pytest

import yawdesign

ROOMS = ("problem", "vehicle", "hunting", "response", "damper", "study", "exports", "output", "cli", "__main__")
ROOT = Path(yawdesign.__file__).parent
MODULES = sorted(path for path in ROOT.rglob("*.py") if path != ROOT / "__init__.py")
# What a room may import from outside, where that is restricted.
FORBIDDEN = {"problem": {"casadi", "scipy", "numpy", "matplotlib"}, "output": {"casadi"}}


def room_of(path):
    """Return the room a module stands in: the first folder, or the module's own name."""
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imports(path):
    """Yield the full name of everything that a module imports, also inside its functions."""
    package = ("yawdesign", *path.relative_to(ROOT).parts[:-1])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
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


@pytest.mark.parametrize("path", sorted((ROOT / "response").glob("*/*.py")), ids=lambda path: "/".join(path.parts[-2:]))
def test_the_response_goes_from_modes_over_the_track_to_the_run(path):
    order = ("modes", "track", "run")
    used = {name.split(".")[2] for name in imports(path) if name.startswith("yawdesign.response.")}
    assert used <= set(order[: order.index(path.parent.name) + 1])


def test_something_was_looked_at():
    assert {room_of(path) for path in MODULES} >= {"problem", "vehicle", "hunting"}
    assert "yawdesign.vehicle.polynomials.Number" in set(imports(ROOT / "vehicle" / "elements.py"))

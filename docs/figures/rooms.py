"""Draws docs/figures/rooms.svg from the imports of the code: python docs/figures/rooms.py."""

import ast
import textwrap
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import escape

ROOT = Path(__file__).parents[2] / "src" / "yawdesign"
# In this order; a module imports only from its own room or from rooms before it.
ROOMS = ("problem", "vehicle", "hunting", "response", "damper", "study", "exports", "output", "cli")
MODULES = sorted(path for path in ROOT.rglob("*.py") if path != ROOT / "__init__.py")

WIDTH, TOP, LINE, MARGIN, CELL = 900, 92, 16, 12, 24
NAMES, MATRIX = 180, WIDTH - MARGIN - CELL * len(ROOMS)  # where the modules begin, and the matrix
LETTERS = 80  # of a line of modules


def room_of(path: Path) -> str:
    """Return the room a module stands in: the first folder, or the module's own name."""
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def name_of(path: Path) -> str:
    """Return the full name of a module."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(["yawdesign", *(part for part in parts if part != "__init__")])


NAMED = {name_of(path): path for path in MODULES}


def imports(path: Path) -> Iterator[str]:
    """Yield the full name of everything that a module imports: in functions, for type checkers, by a text."""
    package = ("yawdesign", *path.relative_to(ROOT).parts[:-1])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and node.value in NAMED:
            yield node.value
        elif isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level] if node.level else ()
            origin = ".".join([*base, *filter(None, [node.module])])
            yield from (f"{origin}.{name.name}" for name in node.names)


def rooms_before(path: Path) -> Iterator[str]:
    """Yield the rooms a module imports from. The version stands above all rooms and is open to each."""
    for name in imports(path):
        first, *rest = name.split(".")
        if first == "yawdesign" and rest != ["__version__"]:
            yield rest[0] if rest else "the package as a whole"


def modules_of(room: str) -> Iterator[str]:
    """Yield the names of the modules of a room in lines, those of a folder in it behind the folder's name."""
    folders: dict[str, list[str]] = {}
    for path in (path for path in MODULES if room_of(path) == room and not path.stem.startswith("__")):
        folders.setdefault("/".join(path.relative_to(ROOT / room).parts[:-1]), []).append(path.stem)
    for folder, names in sorted(folders.items()):
        yield from textwrap.wrap((f"{folder}/ " if folder else "") + ", ".join(names), LETTERS)


def question(room: str) -> str:
    """Return what a room answers: its docstring up to the colon."""
    text = ast.get_docstring(ast.parse((ROOT / room / "__init__.py").read_text(encoding="utf-8")))
    return str(text).partition(":")[0]


def drawing() -> str:
    """Return the drawing: a row for each room, its modules, and a dot for each room that it imports from."""
    parts = [_text(MATRIX + (k + 0.66) * CELL, TOP - 8, room, turned=True) for k, room in enumerate(ROOMS)]
    parts += [_text(MARGIN, TOP - 8, "room", small=True), _text(NAMES, TOP - 8, "modules", small=True)]
    y = float(TOP)
    for row, room in enumerate(ROOMS):
        lines = list(modules_of(room))
        height = max(2, len(lines)) * LINE + 14
        parts.append(f'<line x1="{MARGIN}" x2="{WIDTH - MARGIN}" y1="{y:.0f}" y2="{y:.0f}" stroke="#999999"/>')
        parts += [_text(MARGIN, y + LINE + 3, f"{room}/", bold=True), _text(MARGIN, y + 2 * LINE + 3, question(room))]
        parts += [_text(NAMES, y + (k + 1) * LINE + 3, line) for k, line in enumerate(lines)]
        parts += _cells(row, y, height)
        y += height
    said = "A dot: some module of the room of this row imports from the room of this column."
    parts.append(_text(WIDTH - MARGIN, y + LINE + 4, said, small=True, end=True))
    size = f'width="{WIDTH}" height="{y + 30:.0f}" viewBox="0 0 {WIDTH} {y + 30:.0f}"'
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="Helvetica, Arial, sans-serif" role="img">',
            "<title>The rooms of the house, their modules and their imports</title>",
            '<rect width="100%" height="100%" fill="white"/>',
            *parts,
            "</svg>\n",
        ]
    )


def _cells(row: int, y: float, height: float) -> Iterator[str]:
    """Yield the cells of a row of the matrix: its own room, those it imports from, and those behind it."""
    used = {room for path in MODULES if room_of(path) == ROOMS[row] for room in rooms_before(path)}
    for k, room in enumerate(ROOMS):
        x = MATRIX + k * CELL
        if k >= row:
            colour = "#444444" if k == row else "#eeeeee"
            yield f'<rect x="{x + 1}" y="{y + 1:.0f}" width="{CELL - 2}" height="{height - 2:.0f}" fill="{colour}"/>'
        if k != row and room in used:
            yield f'<circle cx="{x + CELL / 2:.0f}" cy="{y + height / 2:.0f}" r="6" fill="black"/>'


def _text(
    x: float, y: float, text: str, *, bold: bool = False, small: bool = False, turned: bool = False, end: bool = False
) -> str:
    style = f'font-size="{11 if small else 12}"' + ' font-weight="bold"' * bold + ' text-anchor="end"' * end
    place = f'transform="translate({x:.0f},{y:.0f}) rotate(-90)"' if turned else f'x="{x:.0f}" y="{y:.0f}"'
    return f'<text {place} {style} fill="{"#555555" if small else "black"}">{escape(text)}</text>'


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(drawing(), encoding="utf-8")

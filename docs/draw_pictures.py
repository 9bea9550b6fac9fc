"""Draws every picture of the pages anew: python docs/draw_pictures.py."""

import runpy
import shutil
import tempfile
from pathlib import Path

from blocks import prepare, run

DOCS = Path(__file__).parent
SCRIPTS = ("examples/figures.py", "examples/sweeps.py", "docs/figures/rooms.py", "docs/figures/trade_off.py")
PAGES = ("first-design.md", "gallery.md")  # whose own lines draw what they show


def draw_page(page: Path) -> None:
    """Run a page and keep the pictures that it shows."""
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder))
        run(page, Path(folder))
        for picture in Path(folder).glob("*.png"):
            if f"(figures/{picture.name})" in page.read_text(encoding="utf-8"):
                shutil.copy(picture, DOCS / "figures")


if __name__ == "__main__":
    for script in SCRIPTS:
        runpy.run_path(str(DOCS.parent / script), run_name="__main__")
    for name in PAGES:
        draw_page(DOCS / name)

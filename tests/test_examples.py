"""The example scripts run, and draw the pictures that the documents show."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.slow
def test_pictures_of_the_documents(tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location("figures", ROOT / "examples" / "figures.py")
    figures = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(figures)
    monkeypatch.setattr(figures, "FOLDER", tmp_path / "figures")
    figures.main()
    drawn = {file.name for file in (tmp_path / "figures").iterdir()}
    texts = "".join(file.read_text() for file in (ROOT / "docs").glob("*.md"))
    assert all(f"figures/{name}" in texts and (ROOT / "docs" / "figures" / name).exists() for name in drawn)

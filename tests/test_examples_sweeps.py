"""The example of sweeps runs, and draws the pictures that the page on sweeps shows."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.slow
def test_pictures_of_the_page_on_sweeps(tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location("sweeps", ROOT / "examples" / "sweeps.py")
    sweeps = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sweeps)
    monkeypatch.setattr(sweeps, "FOLDER", tmp_path / "figures")
    sweeps.main(tmp_path)
    drawn = {file.name for file in (tmp_path / "figures").iterdir()}
    text = (ROOT / "docs" / "sweeps.md").read_text()
    assert all(f"figures/{name}" in text for name in drawn)
    assert all((ROOT / "docs" / "figures" / name).stat().st_size < 150_000 for name in drawn)
    assert len(list(tmp_path.glob("*.csv"))) == len(drawn)

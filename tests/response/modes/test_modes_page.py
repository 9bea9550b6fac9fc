"""The page on modes prints what it says."""

import contextlib
import io
import re
from pathlib import Path

PAGE = (Path(__file__).parents[3] / "docs" / "modes.md").read_text(encoding="utf-8")


def test_python_of_the_page_prints_what_it_says():
    code = re.search(r"```python\n(.*?)```\n\nprints\n\n```\n(.*?)```", PAGE, re.DOTALL)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code[1], "modes.md", "exec"), {})
    assert printed.getvalue() == code[2]


def test_pictures_of_the_page_are_there_and_small():
    for name in re.findall(r"!\[.*?\]\((.*?)\)", PAGE):
        assert (Path(__file__).parents[3] / "docs" / name).stat().st_size < 100_000

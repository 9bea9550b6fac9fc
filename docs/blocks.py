"""The blocks of a page, and a run of them in order in a folder, by the tests and for the pictures of the pages.

A block behind a line `<!-- file NAME -->` is written to that file, Python and commands are run. What stands between
"prints" and the end of the block behind it is printed by the block before, among other lines. A command whose line ends
with `# exit code 1` ends with it.
"""

import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

BLOCK = re.compile(r"(?:^<!-- ([^\n]*) -->\n)?^```([\w{}-]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PRINTS = re.compile(r"(?:\n\n|\A)(?:It )?prints[^\n]*\s*\Z")
INSTALLS = ("pip install ", "python3 -m venv ", "source ")  # left to continuous integration
RULES = re.compile(r"[\u2500-\u257f\s]+")  # lines of tables, and blanks


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, the mark before it, what it prints (if the page says so), its line."""

    language: str
    text: str
    mark: str
    printed: str
    line: int


def blocks(page: Path) -> list[Block]:
    """Return the blocks of a page."""
    text, found, end = page.read_text(encoding="utf-8"), [], 0
    for match in BLOCK.finditer(text):
        mark, language, inside = match.groups()
        if PRINTS.search(text[end : match.start()]) and found and not language:
            found[-1] = Block(found[-1].language, found[-1].text, found[-1].mark, inside, found[-1].line)
        else:
            found.append(Block(language, inside, mark or "", "", text.count("\n", 0, match.start(2)) + 1))
        end = match.end()
    return found


def prepare(folder: Path) -> None:
    """Put into a folder what the pages take for granted: problem files, and the examples of the repository."""
    root = Path(__file__).parents[1]
    for name, file in {"problem.yaml": "table1.yaml", "vehicle.yaml": "vehicle.yaml"}.items():
        shutil.copy(root / "problems" / file, folder / name)
    for name in ("problems", "examples"):
        shutil.copytree(root / name, folder / name)


def run(page: Path, folder: Path) -> None:
    """Run all blocks of a page in a folder, which is left as they leave it."""
    names: dict[str, Any] = {"__name__": page.stem}
    for block in blocks(page):
        place = f"{page.name}:{block.line}"
        with contextlib.chdir(folder):
            if block.mark.startswith("file "):
                Path(block.mark.removeprefix("file ")).write_text(block.text, encoding="utf-8")
            elif block.language == "python":
                printed = io.StringIO()
                with contextlib.redirect_stdout(printed):
                    exec(compile("\n" * block.line + block.text, page.name, "exec"), names)
                compare(block.printed, printed.getvalue(), place)
            elif block.language == "sh":
                compare(block.printed, "\n".join(map(answer, commands(block.text))), place)


def commands(text: str) -> Iterator[str]:
    """Yield the commands of a block, those over several lines in one."""
    for line in text.replace("\\\n", " ").splitlines():
        if line.strip() and not line.startswith(("#", *INSTALLS)):
            yield line


def answer(command: str) -> str:
    """Run a command in a shell, with this Python and its programs, and return what it says."""
    wanted = int((re.search(r"# exit code (\d+)", command) or [0, 0])[1])
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    shell = ["bash", "-c", command]
    done = subprocess.run(
        shell, env={**os.environ, "PATH": path, "COLUMNS": "120"}, capture_output=True, text=True, check=False
    )
    if done.returncode != wanted:
        raise AssertionError(f"{command}\nends with {done.returncode}, not {wanted}:\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def compare(expected: str, printed: str, place: str) -> None:
    """Fail if a line that a page shows is not among what was printed, in this order; lines of tables do not count."""
    rest = RULES.sub(" ", printed)
    for line in filter(None, (RULES.sub(" ", line).strip() for line in expected.splitlines())):
        if line != "..." and line not in rest:
            raise AssertionError(f"{place} does not print: {line}\nbut:\n{printed}")
        rest = rest.partition(line)[2] if line != "..." else rest

"""A page as PDF, printed by a browser that runs without a window."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from yawdesign.problem import ProblemError

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
    "microsoft-edge",
)
PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
PATIENCE = 120  # seconds
OPTIONS = ("--headless", "--disable-gpu", "--no-first-run", "--no-pdf-header-footer")


def find_browser() -> str:
    """Return the program of a browser that prints.

    Raises
    ------
    ProblemError
        If none is found.
    """
    found = next(filter(None, map(shutil.which, (*BROWSERS, *PLACES))), None)
    if found is None:
        raise ProblemError(
            f"--pdf needs a browser, and none of {', '.join(BROWSERS)} is found: install one, or leave --pdf out and "
            "print the page from the browser you have"
        )
    return found


def printed(page: bytes, browser: str) -> bytes:
    """Return an HTML page as PDF.

    Parameters
    ----------
    page : bytes
        Its content.
    browser : str
        The program.

    Raises
    ------
    ProblemError
        If the browser does not print it.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        source, target = folder / "page.html", folder / "page.pdf"
        source.write_bytes(page)
        # As the administrator, in containers say, a browser refuses to start inside its own cage.
        caged = ("--no-sandbox",) if getattr(os, "geteuid", lambda: 1)() == 0 else ()
        options = (*OPTIONS, *caged, f"--user-data-dir={folder / 'profile'}", f"--print-to-pdf={target}")
        try:
            done = subprocess.run(
                [browser, *options, source.as_uri()], capture_output=True, timeout=PATIENCE, check=False
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise ProblemError(f"--pdf: {browser} does not print: {error}") from None
        if not target.is_file():
            lines = done.stderr.decode(errors="replace").strip().splitlines() or [f"exit code {done.returncode}"]
            raise ProblemError(f"--pdf: {browser} printed nothing: {lines[-1]}")
        return target.read_bytes()

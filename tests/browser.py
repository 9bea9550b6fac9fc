"""A headless browser that is driven over two pipes, by its DevTools protocol: the standard library is enough."""

import base64
import contextlib
import fcntl
import json
import os
import select
import shutil
import signal
import tempfile
import time
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)
PATIENCE = 120.0  # seconds for an answer
MISSING = f"there is no browser on this machine: none of {', '.join(NAMES)}"


def found():
    """Return the path of a browser, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


def _started(command, incoming, outgoing):
    """Return the number of a process that has the protocol on its descriptors 3 and 4, where it looks for it."""
    # Out of the way of both first: a pipe may have one of these numbers already.
    incoming, outgoing = (fcntl.fcntl(x, fcntl.F_DUPFD_CLOEXEC, 10) for x in (incoming, outgoing))
    actions = [(os.POSIX_SPAWN_OPEN, k, os.devnull, os.O_RDWR, 0) for k in range(3)]
    actions += [(os.POSIX_SPAWN_DUP2, incoming, 3), (os.POSIX_SPAWN_DUP2, outgoing, 4)]
    process = os.posix_spawn(command[0], command, os.environ, file_actions=actions)
    os.close(incoming)
    os.close(outgoing)
    return process


class Browser:
    """A running browser; leave it by `with`."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        self._process = _started([found(), *FLAGS, f"--user-data-dir={self._folder.name}"], theirs_in, theirs_out)
        os.close(theirs_in)
        os.close(theirs_out)
        self._in, self._out, self._buffer, self._number = ours_in, ours_out, b"", 0
        self.events = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError, TimeoutError, EOFError):
            self.send("Browser.close")
        deadline = time.monotonic() + 10
        while not os.waitpid(self._process, os.WNOHANG)[0]:
            if time.monotonic() > deadline:
                os.kill(self._process, signal.SIGKILL)
            time.sleep(0.02)
        os.close(self._in)
        os.close(self._out)
        self._folder.cleanup()

    def send(self, method, session=None, **parameters):
        """Return the answer to one command of the protocol."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        message |= {"sessionId": session} if session else {}
        os.write(self._out, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def receive(self, deadline):
        """Return the next message."""
        while b"\0" not in self._buffer:
            if not select.select([self._in], [], [], max(0, deadline - time.monotonic()))[0]:
                raise TimeoutError(f"the browser did not answer within {PATIENCE:.0f} s")
            more = os.read(self._in, 1 << 20)
            if not more:
                raise EOFError("the browser has ended")
            self._buffer += more
        message, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(message)

    def open(self, path, width=1200, height=1600):
        """Return a file as a page that has been loaded."""
        return Page(self, Path(path).resolve().as_uri(), width, height)


class Page:
    """A page of a browser, in a window of its own."""

    def __init__(self, browser, address, width, height):
        self.browser, self.address = browser, address
        target = browser.send("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.send(f"{domain}.enable")
        self.resize(width, height)
        self.send("Page.navigate", url=address)
        self.wait("document.readyState === 'complete'", fresh=address)

    def send(self, method, **parameters):
        """Return the answer to one command."""
        return self.browser.send(method, self.session, **parameters)

    def resize(self, width, height):
        """Give the window another size in CSS pixels."""
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def media(self, kind="", *, scheme="light"):
        """Show the page as on a kind of medium, ``print`` or ``screen``, in a light or dark scheme."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.send("Emulation.setEmulatedMedia", media=kind, features=features)

    def evaluate(self, expression):
        """Return the value of an expression, or of its promise, as JSON has it."""
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise AssertionError(answer["exceptionDetails"]["exception"].get("description", answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait(self, condition, fresh=""):
        """Wait until an expression is true, in a document with an address."""
        deadline = time.monotonic() + PATIENCE
        wanted = f"location.href.startsWith({json.dumps(fresh)}) && ({condition})"
        while not self.evaluate(wanted):
            if time.monotonic() > deadline:
                raise TimeoutError(f"{condition} has not become true")
            time.sleep(0.02)

    def drawn(self):
        """Wait until what was changed has been drawn."""
        self.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def focus(self, selector):
        """Give an element the focus."""
        self.evaluate(f"document.querySelector({json.dumps(selector)}).focus()")

    def press(self, key, times=1):
        """Press a key: ArrowRight, Home, Tab, Enter ..."""
        codes = {"ArrowRight": 39, "ArrowLeft": 37, "Home": 36, "End": 35, "PageUp": 33, "Tab": 9, "Enter": 13}
        text = {"text": "\r"} if key == "Enter" else {}
        about = {"key": key, "code": key, "windowsVirtualKeyCode": codes[key], **text}
        for _ in range(times):
            self.send("Input.dispatchKeyEvent", type="keyDown", **about)
            self.send("Input.dispatchKeyEvent", type="keyUp", **about)

    def write(self, selector, text):
        """Write a text into a field in the place of what stands there, as by keyboard."""
        self.focus(selector)
        self.evaluate("document.activeElement.select()")
        self.send("Input.insertText", text=text)

    def screenshot(self, path):
        """Save the whole page as a PNG."""
        answer = self.send("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        Path(path).write_bytes(base64.b64decode(answer["data"]))

    def pdf(self, path):
        """Save the page as a PDF for A4."""
        answer = self.send("Page.printToPDF", paperWidth=8.27, paperHeight=11.69, printBackground=True)
        Path(path).write_bytes(base64.b64decode(answer["data"]))

    @property
    def told(self):
        """What the browser told of this page."""
        self.evaluate("0")
        return [event for event in self.browser.events if event.get("sessionId") == self.session]

    @property
    def requests(self):
        """The addresses that were asked for beside the page itself."""
        sent = [event["params"]["request"]["url"] for event in self.told if event["method"].endswith("WillBeSent")]
        return [url for url in sent if not url.startswith((self.address, "data:"))]

    @property
    def complaints(self):
        """Errors of scripts, and what the page's security policy forbade."""
        kinds = ("Runtime.exceptionThrown", "Log.entryAdded")
        return [event["params"] for event in self.told if event["method"] in kinds]

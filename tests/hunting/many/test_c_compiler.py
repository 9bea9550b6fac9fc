"""Compilers are found the way a user names them; commands end in a bounded time, with all that they started."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from yawdesign.hunting.many.c_compiler import compilers, run, why_none


def program(folder, name):
    path = folder / name
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return str(path)


def test_the_compilers_on_the_path_in_order(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    assert compilers("CC") == []
    assert why_none("CC") == "no C compiler was found (none of cc, gcc, clang is on the path)"
    clang, cc = (program(tmp_path, name) for name in ("clang", "cc"))
    assert compilers("CC") == [[cc], [clang]]


def test_the_compiler_that_is_named_is_the_only_one(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    program(tmp_path, "cc")
    own = program(tmp_path, "my cc")
    monkeypatch.setenv("CC", own)
    assert compilers("CC") == [[own]]
    monkeypatch.setenv("CC", f"'{own}' -m64 -w")
    assert compilers("CC") == [[own, "-m64", "-w"]]
    monkeypatch.setenv("CC", "other -m64")
    assert compilers("CC") == []
    assert why_none("CC") == "no C compiler was found (CC=other names none)"


def test_what_a_command_writes():
    done = run([sys.executable, "-c", "import sys; print(1); sys.stderr.write('two'); sys.exit(3)"], 20)
    assert (done.returncode, done.stdout, done.stderr) == (3, "1\n", "two")


def test_a_command_that_waits_for_input_gets_none():
    assert run([sys.executable, "-c", "import sys; print(repr(sys.stdin.read()))"], 20).stdout == "''\n"


def test_a_child_that_holds_the_output_does_not_hold_us():
    begin = time.monotonic()
    with pytest.raises(TimeoutError, match=r"sh did not finish in 0\.5 s and was stopped"):
        run(["/bin/sh", "-c", "sleep 600 & exit 0"], 0.5)
    assert time.monotonic() - begin < 60


def test_a_command_that_is_not_there():
    with pytest.raises(OSError, match="no-such-command"):
        run(["no-such-command"], 1)


def test_ctrl_c_stops_the_command_with_its_children(tmp_path):
    child = tmp_path / "child"
    shell = f"sleep 600 & echo $! > {child}; wait"
    text = f"from yawdesign.hunting.many.c_compiler import run; run(['/bin/sh', '-c', {shell!r}], 60)"
    with subprocess.Popen([sys.executable, "-c", text], stderr=subprocess.PIPE) as process:
        while not (child.exists() and child.read_text().strip()):
            time.sleep(0.01)
        time.sleep(0.3)  # the child may be faster than the start of its parent is over
        process.send_signal(signal.SIGINT)
        assert b"KeyboardInterrupt" in process.communicate(timeout=20)[1]
    state = Path(f"/proc/{int(child.read_text())}/stat")
    for _ in range(100):
        if not state.exists() or " Z " in state.read_text():
            return
        time.sleep(0.01)
    pytest.fail("the child still runs")

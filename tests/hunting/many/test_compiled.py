"""Compiled code: kept where nobody else writes, thrown away where damaged, and never a reason to fail or to wait."""

import os
import stat
import time
import warnings
from hashlib import sha256
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from yawdesign import __version__
from yawdesign.hunting.many import compiled, library_cache, tape
from yawdesign.hunting.many.recording import record
from yawdesign.hunting.many.tape import Tape

VALUES = {"x": np.arange(1.0, 5.0), "y": 2.0}


@pytest.fixture(autouse=True)
def fresh(monkeypatch, tmp_path):
    """Compile at once, into a folder of the test's own, and remember nothing of other tests."""
    monkeypatch.setattr(tape, "MANY", 0)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    forget()
    yield
    forget()


def forget():
    for remembered in (compiled.note, compiled._not_kept, compiled._compiler):
        remembered.cache_clear()
    compiled._hanging.clear()


def is_compiled():
    """Compute something, check it, and return whether compiled code did it."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    one = Tape(record(ca.Function("f", [x, y], [ca.vertcat(x + y, x * y)], ["x", "y"], ["out"])))
    assert one(VALUES).tolist() == [[3.0, 4.0, 5.0, 6.0], [2.0, 4.0, 6.0, 8.0]]
    return one._fast is not None


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "cache" / "yawdesign" / __version__


@pytest.fixture
def library(folder):
    """Return the library that the first use leaves."""
    assert is_compiled(), "there is a compiler on the machines that test this"
    (path,) = folder.iterdir()
    return path


def compiles(monkeypatch):
    """Return a list that grows with each compilation."""
    calls, compile_ = [], compiled._compile
    monkeypatch.setattr(compiled, "_compile", lambda *given: calls.append(given) or compile_(*given))
    return calls


def test_compiled_once(library, monkeypatch):
    calls = compiles(monkeypatch)
    assert is_compiled()
    assert not calls
    assert stat.S_IMODE(library.stat().st_mode) == 0o600
    assert stat.S_IMODE(library.parent.stat().st_mode) == 0o700


def damage(kind, path):
    content = path.read_bytes()
    path.unlink()  # this process has it loaded, and what it has loaded stays as it is
    damaged = {
        "truncated": content[: len(content) // 3],  # loaded, this would end the process with SIGBUS
        "empty": b"",
        "longer": content + b"x",
        "a byte changed": content[:-1] + bytes([content[-1] ^ 1]),
        "no library": b"x" * len(content),
    }
    if kind == "a link":
        path.symlink_to(path.parent.parent / "elsewhere")
        path = path.resolve()
    path.write_bytes(damaged.get(kind, content))
    path.chmod(0o666 if kind == "writable by others" else 0o600)


DAMAGE = ["truncated", "empty", "longer", "a byte changed", "no library", "writable by others", "a link"]


@pytest.mark.parametrize("kind", DAMAGE)
def test_what_does_not_fit_is_thrown_away_and_compiled_again(kind, library, monkeypatch):
    damage(kind, library)
    calls = compiles(monkeypatch)
    assert is_compiled()
    assert len(calls) == 1
    assert is_compiled()
    assert len(calls) == 1, "the new one was kept"
    assert [path.is_symlink() for path in library.parent.iterdir()] == [False]


def test_what_others_may_have_planted_in_an_open_folder_is_removed(library, monkeypatch):
    library.parent.chmod(0o777)
    calls = compiles(monkeypatch)
    assert is_compiled()
    assert len(calls) == 1
    assert stat.S_IMODE(library.parent.stat().st_mode) == 0o700


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="there are no owners on this system")
@pytest.mark.parametrize("level", [0, 1])
def test_a_folder_of_another_user_is_neither_read_nor_written(level, library, monkeypatch):
    place = [library.parent, library.parent.parent][level]
    before, mine = library.read_bytes(), os.geteuid()
    lstat = Path.lstat
    monkeypatch.setattr(Path, "lstat", lambda path: Owned(lstat(path), mine + (path == place)))
    calls = compiles(monkeypatch)
    with pytest.warns(RuntimeWarning, match=r"not kept for the next run: .* belongs to another user"):
        assert is_compiled()
    assert len(calls) == 1
    assert [path.read_bytes() for path in library.parent.iterdir()] == [before]


class Owned:
    """A file's state with another owner."""

    def __init__(self, state, owner):
        self.st_mode, self.st_uid = state.st_mode, owner


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="there are no owners on this system")
def test_a_library_of_another_user_is_thrown_away(library, monkeypatch):
    mine, lstat = os.geteuid(), Path.lstat
    monkeypatch.setattr(Path, "lstat", lambda path: Owned(lstat(path), mine + (path == library)))
    calls = compiles(monkeypatch)
    assert is_compiled()
    assert len(calls) == 1


def test_no_home_folder(monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME")

    def none():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", none)
    with pytest.warns(RuntimeWarning, match="not kept for the next run: there is no home folder"):
        assert is_compiled()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert is_compiled(), "and it is said once"


def test_a_relative_cache_folder_does_not_count(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", "cache")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path)
    assert is_compiled()
    assert [path.name for path in tmp_path.iterdir()] == ["home"]


def test_no_place_to_write(tmp_path):
    (tmp_path / "cache").write_text("")
    with pytest.warns(RuntimeWarning, match="not kept for the next run: .*cache"):
        assert is_compiled()


def script(folder, text):
    path = folder / "compiler"
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o700)
    return str(path)


ANSWERS = '[ "$1" = --version ] && { echo 1; exit; }\n'
FAILING = {
    "that fails": ("echo no such option >&2; exit 1", "exit code 1, no such option"),
    "that writes nothing": ("exit 0", "without a library"),
    "whose library has nothing in it": (
        'while [ "$1" != -o ]; do shift; done; echo "int x;" | cc -shared -o "$2" -xc -',
        "a library that does not load",
    ),
    "whose library is none": ('while [ "$1" != -o ]; do shift; done; echo x > "$2"', "a library that does not load"),
}


@pytest.mark.parametrize("kind", FAILING)
def test_a_compiler(kind, monkeypatch, tmp_path):
    text, reason = FAILING[kind]
    monkeypatch.setenv(compiled.SWITCH, script(tmp_path, ANSWERS + text))
    with pytest.warns(RuntimeWarning, match=f"without compiled code.*compiler.*({reason})"):
        assert not is_compiled()


def test_a_compiler_that_is_not_there(monkeypatch):
    monkeypatch.setenv(compiled.SWITCH, "no-such-compiler")
    with pytest.warns(RuntimeWarning, match=r"no C compiler was found \(YAWDESIGN_CC=no-such-compiler names none\)"):
        assert not is_compiled()


@pytest.mark.parametrize("way", ["none is wanted", "there is none"])
def test_no_compiler_is_no_news(way, monkeypatch, tmp_path):
    if way == "none is wanted":
        monkeypatch.setenv(compiled.SWITCH, "")
    else:
        monkeypatch.setenv("PATH", str(tmp_path))
    assert not is_compiled()


def test_wrong_code_is_not_used(monkeypatch):
    monkeypatch.setattr(compiled, "FRAME", compiled.FRAME.replace("value + *from", "value - *from"))
    with pytest.warns(RuntimeWarning, match="not give the numbers of NumPy"):
        assert not is_compiled()


@pytest.mark.parametrize("when", ["asked for its version", "compiling"])
def test_a_compiler_that_hangs_is_stopped_with_its_children(when, monkeypatch, tmp_path):
    child = tmp_path / "child"
    hangs = f"sleep 600 & echo $! >> {child}; wait"
    monkeypatch.setenv(compiled.SWITCH, script(tmp_path, (ANSWERS if when == "compiling" else "") + hangs))
    for limit in ("TIME_LIMIT", "ANSWER_LIMIT"):
        monkeypatch.setattr(compiled, limit, 1.0)
    with pytest.warns(RuntimeWarning, match=r"compiler did not finish in 1 s and was stopped"):
        assert not is_compiled()
    assert not is_compiled()
    (number,) = child.read_text().split()  # it is asked once
    assert has_ended(int(number))


def has_ended(number):
    """Return whether a process ends within a second; one that is dead but not yet taken note of has."""
    for _ in range(100):
        try:
            state = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.01)
    return False


@pytest.mark.parametrize("ending", [': > "$o"', 'gcc "$@" && truncate -s 5000 "$o"'], ids=["empty", "cut off"])
def test_a_library_that_does_not_load_is_not_kept(ending, monkeypatch, tmp_path, folder):
    fake = tmp_path / "fake-cc"
    fake.write_text(
        '#!/bin/sh\ncase "$1" in --version) exec gcc --version;; esac\n'
        'for x in "$@"; do [ "$before" = -o ] && o=$x; before=$x; done\n' + ending + "\n"
    )
    fake.chmod(0o700)
    monkeypatch.setenv("YAWDESIGN_CC", str(fake))
    with pytest.warns(RuntimeWarning, match="a library that does not load"):
        assert not is_compiled()
    assert not folder.exists() or not list(folder.iterdir())


def test_a_library_with_the_right_digest_that_does_not_load_is_removed(library, folder, monkeypatch):
    empty = folder / f"{library.name.split('-')[0]}-{sha256(b'').hexdigest()}{library.suffix}"
    library.unlink()
    empty.write_bytes(b"")
    empty.chmod(0o600)
    calls = compiles(monkeypatch)
    assert is_compiled()
    assert len(calls) == 1
    assert [path.name for path in folder.iterdir()] == [library.name]


def test_what_another_process_has_kept_meanwhile_is_used(library, monkeypatch):
    monkeypatch.setattr(library_cache, "find", lambda key, suffix: None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert is_compiled()
    assert library.exists()

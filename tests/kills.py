"""Kills the command sweep again and again, and looks at what is left. Run by test_kills.py in a process of its own.

python tests/kills.py FOLDER RANDOM STEP: RANDOM kills at random moments, and one at every STEP-th file operation.
The answer is JSON: how many kills there were, by signal and outcome, and what was lost.
"""

import json
import os
import random
import signal
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import yawdesign as yd
from yawdesign import cli
from yawdesign.output import plots, sweep_files, sweep_plots, sweep_tables, targets  # noqa: F401 - before the forks
from yawdesign.problem import ProblemError, stopping, whole_files
from yawdesign.study import executors, kept_file, sweep
from yawdesign.study.kept_file import KeptFile
from yawdesign.study.request import request
from yawdesign.study.store import Store

PROBLEM = Path(__file__).parents[1] / "problems" / "table1.yaml"
AXIS, POINTS, CHUNK = "2:4:24", 24, 4
ASKED = request(yd.load(PROBLEM), "critical", [("f_m", AXIS)], None)
OUTPUTS = ("x.csv", "x.npz", "x.svg")
SOFT = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
OPERATIONS = ("open", "os.rename", "os.link", "os.remove", "os.chmod", "os.mkdir", "os.rmdir", "os.truncate")
PATIENCE = 60.0  # seconds for a process to end


class Trial:
    """One run of the command in a folder of its own, in a child process that tells what it has finished."""

    def __init__(self, folder, *, resume, picture, save_every):
        folder.mkdir()
        self.folder, self.resume, self.save_every = folder, resume, save_every
        self.outputs = OUTPUTS if picture else OUTPUTS[:2]

    def arguments(self):
        written = [f"--{option}={name}" for option, name in zip(("csv", "npz", "plot"), self.outputs, strict=False)]
        kept = ["--resume=mine.npz"] if self.resume else []
        return ["sweep", str(PROBLEM), "--of=critical", f"--over=f_m={AXIS}", *written, *kept]

    def start(self, at=0, number=0):
        """Start the command; before the file operation `at` it kills itself."""
        self.told, told = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            os.close(self.told)
            self._be_the_child(told, at, number)
        os.close(told)

    def _be_the_child(self, told, at, number):
        code = 99
        try:
            os.chdir(self.folder)
            out = os.open(os.devnull, os.O_WRONLY)
            err = os.open("../stderr", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            os.dup2(out, 1)
            os.dup2(err, 2)
            executors.HERE, sweep.SAVE_EVERY = CHUNK, self.save_every
            tell(Store, "put", told, lambda store, *_: f"finished {store.finished.sum()}")
            tell(kept_file, "_write", told, lambda path, asked, store, **_: f"kept {store.finished.sum()}")
            if at:
                kill_at(at, number, str(self.folder), told)
            sys.argv = ["yawdesign", *self.arguments()]
            try:
                cli.main()
            except SystemExit as end:
                code = end.code or 0
        except KeyboardInterrupt as error:  # before the command or after it; inside nothing may escape
            code = 99 if isinstance(error, stopping.Stopped) else 130
        finally:
            os._exit(code)

    def wait(self):
        """Wait for the end; return how it ended: an exit code, or minus the signal."""
        text = b""
        while piece := os.read(self.told, 65536):
            text += piece
        os.close(self.told)
        lines = [line.split() for line in text.decode().splitlines()]
        self.counts = {what: int(count) for what, count in lines}
        _, status = os.waitpid(self.pid, 0)
        return os.waitstatus_to_exitcode(status)


def tell(home, name, told, text):
    """Let a function tell what is done when it has returned."""
    function = getattr(home, name)

    def telling(*arguments, **options):
        found = function(*arguments, **options)
        os.write(told, f"{text(*arguments, **options)}\n".encode())
        return found

    setattr(home, name, telling)


def kill_at(at, number, folder, told):
    """Let this process kill itself before its file operation `at` in a folder."""
    count = 0

    def step(what):
        nonlocal count
        count += 1
        if count == at:
            os.write(told, b"reached 1\n")
            os.kill(os.getpid(), number)

    def hook(event, arguments):
        if event in OPERATIONS and inside(arguments[0]):
            step(event)

    def inside(x):
        return isinstance(x, (str, bytes, os.PathLike)) and str(Path(os.fsdecode(x)).absolute()).startswith(folder)

    synchronise = os.fsync
    whole_files.os.fsync = lambda number: (step("fsync"), synchronise(number))
    sys.addaudithook(hook)


def reference():
    result = yd.sweep(yd.load(PROBLEM), of="critical", f_m=AXIS, chunk=CHUNK)
    return result, {name: x.reshape(POINTS, *x.shape[1:]) for name, x in result.columns.items()}


WHOLE, COLUMNS = reference()


def faults(trial, number, end):
    """Yield what is wrong after a kill."""
    finished, kept = trial.counts.get("finished", 0), trial.counts.get("kept", 0)
    names = {path.name for path in trial.folder.iterdir()}
    written = names & set(trial.outputs)
    yield from (f"{name} is damaged" for name in written if not is_whole(trial.folder / name))
    files = [name for name in names if name == "mine.npz" or name.startswith("table1.sweep")]
    strange = names - written - set(files)
    if strange and not (number == signal.SIGKILL and all(name.endswith(".part") for name in strange)):
        yield f"{strange} is left"
    left = 0
    for name in files:
        store = Store(POINTS)
        try:
            KeptFile(trial.folder / name, ASKED).read(store)
        except ProblemError as error:
            yield f"{name}: {error}"
            continue
        left = max(left, int(store.finished.sum()))
        if not same(store):
            yield f"{name} has other values"
        result = yd.sweep(yd.load(PROBLEM), of="critical", resume=trial.folder / name, f_m=AXIS, chunk=CHUNK)
        if not np.array_equal(result.main, WHOLE.main, equal_nan=True):
            yield f"the sweep that went on from {name} has other values"
    if number == signal.SIGKILL:
        promised = kept if trial.resume else 0
    else:
        promised = 0 if written == set(trial.outputs) else finished
        outside = end == 130 and (not finished or written == set(trial.outputs))  # of the command: Python's own answer
        if end not in (0, 128 + number, -number) and not outside:
            yield f"exit code {end}"
    if left < promised:
        yield f"{promised - left} of {promised} finished points are lost"


def same(store):
    done = store.finished
    for name, x in store.columns.items():
        found, expected = x[done], COLUMNS[name][done]
        if found.ndim > 1:
            width = min(found.shape[1], expected.shape[1])
            found, expected = found[:, :width], expected[:, :width]
        if not np.array_equal(found, expected, equal_nan=True):
            return False
    return True


def is_whole(path):
    try:
        if path.suffix == ".npz":
            with np.load(path) as arrays:
                return all(arrays[name] is not None for name in arrays.files) and np.array_equal(
                    arrays["values"], WHOLE.main, equal_nan=True
                )
        text = path.read_text()
        return text.endswith("</svg>\n") if path.suffix == ".svg" else text.count("\n") == 3 + POINTS
    except Exception:  # noqa: BLE001 - whatever is wrong with it
        return False


def random_kills(folder, count, draw):
    """Yield signal, end and faults of kills at random moments."""
    begin = time.perf_counter()
    first = Trial(folder / "first", resume=True, picture=True, save_every=0.02)
    first.start()
    assert first.wait() == 0, (folder / "stderr").read_text()
    duration = time.perf_counter() - begin
    for k in range(count):
        number = (*SOFT, signal.SIGKILL)[k % 4]
        trial = Trial(folder / f"random-{k}", resume=k // 4 % 2 == 0, picture=True, save_every=0.02)
        trial.start()
        time.sleep(draw.uniform(0, 1.05 * duration))
        end = killed(trial, number, again=draw.random() < 0.3)
        yield number, end, list(faults(trial, number, end))


def killed(trial, number, *, again):
    os.kill(trial.pid, number)
    if again:
        time.sleep(0.02)
        os.kill(trial.pid, number)
    return trial.wait()


def kills_at_operations(folder, step):
    """Yield signal, end and faults of kills before file operations."""
    for number in (signal.SIGKILL, signal.SIGTERM):
        for resume in (True, False):
            at, reached = 1, True
            while reached:
                trial = Trial(folder / f"at-{number}-{resume}-{at}", resume=resume, picture=False, save_every=0.0)
                trial.start(at, number)
                end = trial.wait()
                reached = "reached" in trial.counts
                if reached:
                    yield number, end, list(faults(trial, number, end))
                at += step


def main(folder, count, step):
    folder = Path(folder).resolve()
    draw = random.Random(7)
    signal.alarm(3600)
    found = {"random": random_kills(folder, int(count), draw), "operations": kills_at_operations(folder, int(step))}
    answer = {}
    for kind, kills in found.items():
        kills = list(kills)
        answer[kind] = {
            "kills": len(kills),
            "ends": dict(Counter(f"{signal.Signals(number).name} -> {end}" for number, end, _ in kills)),
            "lost": [f"{signal.Signals(number).name} -> {end}: {what}" for number, end, all_ in kills for what in all_],
        }
    sys.stdout.write(json.dumps(answer))


if __name__ == "__main__":
    main(*sys.argv[1:])

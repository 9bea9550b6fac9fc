"""Kills of the command sweep lose nothing that was finished: at random moments, and between file operations.

The environment variable YAWDESIGN_CAMPAIGN=1 asks for all of them; otherwise a tenth is made.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

FULL = os.environ.get("YAWDESIGN_CAMPAIGN") == "1"
RANDOM, STEP = (120, 1) if FULL else (12, 10)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="the kills need os.fork, which this system has not")
def test_kills_lose_nothing_that_was_finished(tmp_path, capsys):
    command = [sys.executable, str(Path(__file__).with_name("kills.py")), str(tmp_path), str(RANDOM), str(STEP)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    with capsys.disabled():
        for kind, where in (("random", "at random moments"), ("operations", "between file operations")):
            about = found[kind]
            sys.stdout.write(f"\n{about['kills']} kills {where}, {len(about['lost'])} with a loss: {about['ends']}")
        sys.stdout.write("\n")
    assert found["random"]["kills"] == RANDOM
    assert found["operations"]["kills"] >= 100 // STEP
    lost = [*found["random"]["lost"], *found["operations"]["lost"]]
    assert not lost, "\n".join(lost)

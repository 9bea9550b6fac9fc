"""Prefixes: several exports in one program, and names that cannot be taken."""

import re
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

import yawdesign as yd
from yawdesign.cli import app

PROBLEM = Path(__file__).parents[2] / "problems" / "table1.yaml"
CHECKED = ["-std=c99", "-O1", "-Wall", "-Werror", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]


def export(*arguments):
    return CliRunner().invoke(app, ["export", str(PROBLEM), *map(str, arguments)])


TWO_IN_ONE = r"""
#include <stdio.h>
#include "front.h"
#include "rear_bogie.h"
#define PRINT(f) { \
  double x[] = f##_VALUES, y, w[f##_SZ_W], *res[f##_SZ_RES] = {0}; \
  const double *arg[f##_SZ_ARG] = {x, x + 1, x + 2}; \
  casadi_int iw[f##_SZ_IW]; \
  res[f##_out_K_dyn] = &y; \
  if (f(arg, res, iw, w, 0)) return 1; \
  printf("%.17g\n", y); \
}
int main(void) {
  PRINT(front_dynamic_stiffness)
  PRINT(rear_bogie_dynamic_stiffness)
  return 0;
}
"""


def test_two_exports_in_one_program(tmp_path):
    tasks = {"front": yd.table1(), "rear_bogie": yd.table1().replace(C_s=3e5)}
    for name, task in tasks.items():
        yd.export(task, tmp_path / name, only="dynamic_stiffness,c", prefix=name)
        subprocess.run(["make", "-s", "-C", tmp_path / name, "check"], check=True)
    (tmp_path / "two.c").write_text(TWO_IN_ONE)
    folders = [tmp_path / name for name in tasks]
    sources = [tmp_path / "two.c", *(folder / f"{folder.name}.c" for folder in folders)]
    command = ["cc", *CHECKED, *(f"-I{folder}" for folder in folders), "-o", tmp_path / "two", *sources, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    found = subprocess.run([tmp_path / "two"], capture_output=True, text=True, check=True).stdout.split()
    for task, text in zip(tasks.values(), found, strict=True):
        f = yd.functions(task).documented["dynamic_stiffness"]
        assert float(text) == pytest.approx(float(f.function.call([port.value for port in f.inputs])[2]), rel=1e-12)


def test_every_symbol_begins_with_the_prefix(tmp_path):
    assert export("--to", tmp_path / "out", "--only", "critical_damping,c", "--prefix", "front").exit_code == 0
    subprocess.run(["cc", "-c", "-o", tmp_path / "a.o", tmp_path / "out" / "front.c"], check=True)
    command = ["nm", "-g", "--defined-only", tmp_path / "a.o"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    symbols = [line.split()[-1] for line in listed.splitlines()]
    assert symbols
    assert all(name.startswith("front_") for name in symbols)
    header = (tmp_path / "out" / "front.h").read_text()
    assert not re.search(r"(?i)yawdesign_", header)


MISFITS = ["", "1a", "a-b", "a b", "_a", "a_", "a__b", "ä", "../a", "a.c", "a\n", "a" * 31, "math", "Stdio", "selftest"]


@pytest.mark.parametrize("prefix", MISFITS)
def test_prefixes_that_do_not_fit(tmp_path, prefix):
    done = export("--to", tmp_path / "out", "--only", "dynamic_stiffness", "--prefix", prefix)
    assert done.exit_code == 2
    assert "prefix" in done.stderr
    assert list(tmp_path.iterdir()) == []

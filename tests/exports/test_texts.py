"""Whatever stands in a title: it reaches every exported file, and none of them is broken by it."""

import json
import re
import subprocess
import zipfile
from xml.etree import ElementTree

import casadi as ca
import pytest
from scipy.io import loadmat

import yawdesign as yd

CHECKED = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]


TITLES = {
    "spaces": "one\u00a0two\u200bthree\u2009four end",
    "comment marks": "*/ int x; /* y // z * / *\u00a0/ **// /*/ \\",
    "trigraphs": "µµ/ ?\u003f/",
    "markup": '<a b="c">&amp;]]><!-- $x ${y} $(CC) %s',
    "directions": "\u202e\u2066\ufeff\U000e0001 end",
}


@pytest.mark.parametrize("kind", TITLES)
def test_any_title_goes_into_every_kind_of_file(kind, tmp_path):
    task = yd.Problem(bogie=yd.table1().bogie, speed=80.0, title=TITLES[kind])
    to = tmp_path / "out"
    result = yd.export(task, to, only="dynamic_stiffness")
    assert not result.notes
    for name in ("yawdesign.h", "yawdesign.c", "selftest.c", "example.c", "Makefile"):
        text = (to / name).read_bytes()
        assert not re.findall(rb"[^\n\t -~]", text), name  # printable ASCII
    subprocess.run(["cc", *CHECKED, "-c", "-o", tmp_path / "a.o", to / "example.c"], check=True)
    comment = (to / "yawdesign.h").read_text().split("*/")[0]
    assert comment.splitlines()[0].endswith(f"with CasADi {ca.CasadiMeta.version()}")
    assert json.loads((to / "manifest.json").read_text(encoding="utf-8"))["title"] == TITLES[kind]
    assert not re.search(r"[\x00-\x09\x0b-\x1f]", (to / "manifest.json").read_text(encoding="utf-8"))
    with zipfile.ZipFile(to / "bogie.fmu") as archive:
        described = ElementTree.fromstring(archive.read("modelDescription.xml"))
    assert described.get("description").startswith(TITLES[kind])
    assert loadmat(to / "state_space.mat")["title"].item().isprintable()

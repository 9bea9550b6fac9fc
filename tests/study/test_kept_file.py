"""Kept files: damaged, foreign and shared ones. What is not exactly what was written is refused, and never changed."""

import io
import json
import zipfile
from hashlib import sha256

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.study import executors as chunks
from yawdesign.study import kept_file as keeping
from yawdesign.study.kept_file import DIGEST, KeptFile
from yawdesign.study.request import request
from yawdesign.study.store import Store

PRINTED = yd.table1(equations="as-printed")
GRID = {"of": "C_sl", "v": np.linspace(70, 100, 12)}
ASKED = request(PRINTED, "C_sl", [("v", GRID["v"])], None)


@pytest.fixture(scope="module")
def whole():
    return yd.sweep(PRINTED, **GRID)


@pytest.fixture(scope="module")
def content(whole, tmp_path_factory):
    file = tmp_path_factory.mktemp("kept") / "kept.npz"
    whole.keep(file)
    return file.read_bytes()


@pytest.fixture(scope="module")
def arrays(content):
    with np.load(io.BytesIO(content)) as file:
        return dict(file)


def refused(tmp_path, content, text="unfinished sweep"):
    file = tmp_path / "kept.npz"
    file.write_bytes(content)
    with pytest.raises(yd.ProblemError, match=text):
        yd.sweep(PRINTED, resume=file, **GRID)
    assert file.read_bytes() == content


def sealed(members):
    """Return an archive whose digest is right."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, x in members.items():
            archive.writestr(f"{name}.npy", x if isinstance(x, bytes) else npy(x))
        archive.comment = b"0" * DIGEST
    body = out.getvalue()[:-DIGEST]
    return body + sha256(body).hexdigest().encode()


def npy(x):
    out = io.BytesIO()
    np.save(out, x)
    return out.getvalue()


def test_what_was_written_is_read(content, arrays, whole, tmp_path):
    for text in (content, sealed(arrays)):
        (tmp_path / "kept.npz").write_bytes(text)
        store = Store(ASKED.size)
        KeptFile(tmp_path / "kept.npz", ASKED).read(store)
        assert store.finished.all()
        assert store.columns["C_sl"].tolist() == whole.values.tolist()
        assert store.columns["status"].tolist() == whole.columns["status"].tolist()


def test_every_flipped_byte_is_seen(content, tmp_path):
    rng = np.random.default_rng(5)
    for place in rng.choice(len(content), 150, replace=False):
        damaged = bytearray(content)
        damaged[place] ^= 1 << rng.integers(8)
        refused(tmp_path, bytes(damaged))


def test_every_cut_is_seen(content, tmp_path):
    for length in [*range(0, len(content), 41), *range(len(content) - 70, len(content))]:
        refused(tmp_path, content[:length])
    refused(tmp_path, content + b"0")
    refused(tmp_path, content[:500] + content[600:])


def test_an_archive_that_was_written_anew_with_other_values_is_refused(arrays, tmp_path):
    np.savez_compressed(tmp_path / "other.npz", **{**arrays, "column_C_sl": arrays["column_C_sl"] * 2})
    refused(tmp_path, (tmp_path / "other.npz").read_bytes())


SIZE = ASKED.size


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"finished": np.ones(SIZE + 1, bool)}, "finished"),
        ({"finished": np.ones(SIZE)}, "finished"),
        ({"finished": np.zeros(SIZE, bool), "recomputed": np.ones(SIZE, bool)}, "not finished"),
        ({"unverified": np.ones((SIZE, 2), bool)}, "unverified"),
        ({"recomputed": None}, "recomputed"),
        ({"identity": None}, "no unfinished sweep"),
        ({"identity": np.array("[]")}, "another sweep"),
        ({"identity": np.array("[" * 100_000)}, "no unfinished sweep"),
        ({"identity": np.array("7")}, "no unfinished sweep"),
        ({"column_C_sl": None, "column_status": None}, "no columns"),
        ({"column_C_sl": np.zeros(SIZE - 1)}, "C_sl has the shape"),
        ({"column_C_sl": np.zeros((SIZE, 2, 2))}, "C_sl has the shape"),
        ({"column_C_sl": np.zeros((SIZE, 1))}, "C_sl has the shape"),
        ({"column_critical": np.zeros(SIZE)}, "critical has the shape"),
        ({"column_critical": np.zeros((SIZE, 0))}, "critical has the shape"),
        ({"column_C_sl": np.full(SIZE, "1")}, "C_sl has the kind"),
        ({"column_C_sl": np.zeros(SIZE, complex)}, "C_sl has the kind"),
        ({"column_status": np.zeros(SIZE)}, "status has the kind"),
        ({"column_C_ls": np.zeros(SIZE)}, "C_ls is no column"),
        ({"finished": b"\x93NUMPY\x01\x00"}, "no unfinished sweep"),
        ({"finished": b"\x93NUMPY\x02\x00v\x00\x00\x00{}"}, "no unfinished sweep"),
        ({"finished": b""}, "no unfinished sweep"),
    ],
)
def test_what_has_a_right_digest_is_looked_at_too(arrays, changes, text, tmp_path):
    members = {name: x for name, x in {**arrays, **changes}.items() if x is not None}
    refused(tmp_path, sealed(members), text)


def head(shape, kind="<f8"):
    text = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00v\x00" + text.encode()


@pytest.mark.parametrize("shape", ["(9895604649984,)", "(12, 10**9)", "(-1,)", "(12, 99999999999999999999)"])
def test_a_head_that_promises_72_tebibytes(arrays, shape, tmp_path):
    assert 9895604649984 * 8 == 72 * 2**40
    refused(tmp_path, sealed({**arrays, "column_C_sl": head(shape) + bytes(8 * SIZE)}))


def test_an_archive_larger_than_the_memory(content, tmp_path, monkeypatch):
    monkeypatch.setattr(keeping, "memory", lambda: 100.0)
    refused(tmp_path, content)


def test_what_is_no_file(tmp_path):
    for path in (tmp_path, "/dev/zero"):
        with pytest.raises(yd.ProblemError, match="is no file"):
            yd.sweep(PRINTED, resume=path, **GRID)


def test_a_kept_file_of_another_sweep_is_not_overwritten(content, whole, tmp_path):
    other = yd.sweep(PRINTED, of="C_sl", v=[70.0, 71.0])
    file = tmp_path / "kept.npz"
    file.write_bytes(content)
    with pytest.raises(yd.ProblemError, match="belongs to another sweep"):
        other.keep(file)
    assert file.read_bytes() == content
    whole.keep(file)
    assert file.read_bytes() == content  # all is in it already


def halves():
    """Return two stores that have half of the points each."""
    whole = yd.sweep(PRINTED, of="critical", v=GRID["v"])
    stores = Store(SIZE), Store(SIZE)
    columns = {name: x.reshape(SIZE, *x.shape[1:]) for name, x in whole.columns.items()}
    no = np.zeros(SIZE, bool)
    for start in range(0, SIZE, 2):
        part = slice(start, start + 2)
        stores[start // 2 % 2].put(start, chunks.Answers({n: x[part] for n, x in columns.items()}, no[part], no[part]))
    return whole, stores


def test_two_runs_of_one_sweep_add_to_one_file(tmp_path):
    asked = request(PRINTED, "critical", [("v", GRID["v"])], None)
    whole, (one, other) = halves()
    files = [KeptFile(tmp_path / "kept.npz", asked) for _ in range(2)]
    files[0].write(one)
    files[1].write(other)
    assert other.finished.all()
    files[0].write(one)
    assert one.finished.all()
    again = Store(SIZE)
    KeptFile(tmp_path / "kept.npz", asked).read(again)
    assert again.finished.all()
    assert np.array_equal(again.columns["critical"], whole.main, equal_nan=True)


def test_a_file_that_another_sweep_takes_meanwhile_stays(monkeypatch, content, tmp_path):
    """The sweep does not overwrite it, and says so."""
    file, answer = tmp_path / "kept.npz", chunks.answer

    def taken(*arguments):
        file.write_bytes(content)
        return answer(*arguments)

    monkeypatch.setattr(chunks, "answer", taken)
    with pytest.warns(RuntimeWarning, match="belongs to another sweep"):
        result = yd.sweep(PRINTED, of="stable", C_s=[1e5, 2e5], resume=file)
    assert result.known.all()
    assert file.read_bytes() == content


def test_the_identity_is_readable(arrays):
    assert json.loads(str(arrays["identity"]))["of"] == "C_sl"

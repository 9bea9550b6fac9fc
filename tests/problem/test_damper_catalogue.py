"""A catalogue of dampers: from a file of columns, or inline; every mistake with its place."""

import json

import pytest

import yawdesign as yd
from yawdesign.problem import catalogue_file, read
from yawdesign.problem.catalogue_file import read_catalogue

HEAD = "name,damping [kN s/m],stiffness [MN/m]"
PROBLEM = "bogie: {base: table1}\nspeed: 300 km/h\ndesign: {catalogue: dampers.csv}\n"


@pytest.fixture
def file(tmp_path):
    """Return a function that writes a catalogue and returns its path."""

    def written(content, name="dampers.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return written


def mistakes(path):
    with pytest.raises(yd.ProblemError) as caught:
        read_catalogue(path)
    return [(each.line, each.column, each.message) for each in caught.value.diagnostics]


def test_a_row_is_one_damper_and_the_pair_has_one_on_each_side():
    one = yd.CatalogueDamper(name="A", damping="400 kN s/m", stiffness="20 MN/m")
    two = yd.CatalogueDamper(name="A", damping="400 kN s/m", stiffness="20 MN/m", per_side=2)
    assert (one.C_s, one.K_ds) == (800e3, 40e6)
    assert (two.C_s, two.K_ds) == (1600e3, 80e6)
    assert yd.CatalogueDamper(name="A", damping="626.48 kN s/m", stiffness="rigid").C_s.exact == 1252960


@pytest.mark.parametrize("separator", [",", ";", "\t", " , "])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_a_file_of_columns(file, separator, end, mark):
    rows = [
        ("# invented",),
        ("name", "per_side", "stiffness [kN/mm]", "damping [N s/mm]", "blow_off [kN]"),
        ("A", "2", "20", "400", ""),
        (),
        ("B 1", "", "rigid", "0.4 MN s/m", "9"),
    ]
    text = end.join(separator.join(row) for row in rows)
    first, second = read_catalogue(file(mark + text.encode()))
    assert (first.name, first.per_side, first.damping, first.stiffness) == ("A", 2, 400e3, 20e6)
    assert (second.name, second.K_ds, second.C_s, second.blow_off) == ("B 1", float("inf"), 800e3, 9e3)
    assert second.damping_after is None


@pytest.mark.parametrize(
    ("text", "line", "column", "says"),
    [
        ("name,damping [kN s/m]\nA,400\n", 1, 1, "column stiffness is missing"),
        ("name\nA\n", 1, 1, "column damping and the column stiffness is missing"),
        (HEAD + ",bellow_off [kN]\nA,4,2,3\n", 1, 40, "did you mean blow_off?"),
        ("name,damping (kN s/m),stiffness [MN/m]\nA,400,20\n", 1, 6, "did you mean damping?"),
        (HEAD + ",stiffness [N/m]\nA,400,20,3\n", 1, 40, "stands twice"),
        (HEAD.replace("MN/m", "kN") + "\nA,400,20\n", 1, 23, "[kN] is the unit of a force, expected a stiffness"),
        (HEAD + ",per_side [m]\nA,400,20,1\n", 1, 40, "per_side has no unit"),
        (HEAD.replace("MN/m", "MNm") + "\nA,400,20\n", 1, 23, "not a known unit"),
        ("name,damping,stiffness [MN/m]\nA,400,20\n", 2, 3, "head the column damping [kN·s/m]"),
        (HEAD + "\nA,4,2\nB,5,2\nA,6,2\n", 4, 1, "A stands twice, first on line 2"),
        (HEAD + "\n,4,2\n", 2, 1, "has no value"),
        (HEAD + "\nA,,2\n", 2, 3, "has no value"),
        (HEAD + "\nA,much,2\n", 2, 3, "is not a number"),
        (HEAD + "\nA, -4,2\n", 2, 4, "-4 kN s/m is outside 0"),
        (HEAD + "\nA,4,rigid \nB,rigid,4\n", 3, 3, "is not a number"),
        (HEAD + "\nA,4 m,2\n", 2, 3, "is a length, expected a damping"),
        (HEAD + ',per_side\nA,4,2,1.5\n', 2, 7, "not a whole number from 1 to 10"),
        (HEAD + '\nA,"4,5",2\n', 2, 3, "the decimal sign is a point, 4.5"),
        (HEAD.replace(",", ";") + "\nA;4,5;2\n", 2, 3, "the decimal sign is a point, 4.5"),
        (HEAD + "\nA,4,5,2\n", 2, 7, "the row has 4 cells, and there are 3 columns; the decimal sign is a point"),
        (HEAD + "\nA,4\n", 2, 3, "the row has 2 cells"),
        (HEAD + '\nA,"4,2\n', 2, 1, "cannot be read as cells"),
    ],
)  # fmt: skip
def test_mistakes_have_their_place(file, text, line, column, says):
    (found,) = mistakes(file(text))
    assert found[:2] == (line, column)
    assert says in found[2]


def test_all_mistakes_come_at_once_but_not_thousands(file):
    found = mistakes(file(HEAD + "\n" + "".join(f"D{k},x,2\n" for k in range(500))))
    assert len(found) == 21
    assert found[-1][2] == "and 480 more mistakes"


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("# only a remark\n", "is empty"),
        (HEAD, "has no damper in it"),
        (b"name,damping\xff", "is not UTF-8 text"),
        (HEAD + "\nA,4,2\nB,4,2\nC,4,2\n", "has more than 2 dampers"),
        (HEAD + "\n" + " " * 2000, "it is larger than 0.001 MB"),
    ],
)
def test_files_that_are_no_catalogue(file, monkeypatch, content, says):
    monkeypatch.setattr(catalogue_file, "MOST_ROWS", 2)
    monkeypatch.setattr(catalogue_file, "MOST_BYTES", 1000)
    (found,) = mistakes(file(content))
    assert says in found[2]


def test_a_file_is_looked_for_beside_the_problem(file, tmp_path):
    file(HEAD + "\nA,400,20\n")
    path = file(PROBLEM, "problem.yaml")
    assert yd.load(path).design.catalogue == (yd.CatalogueDamper(name="A", damping=400e3, stiffness=20e6),)


def test_mistakes_of_both_files_are_told(file):
    path = file(PROBLEM.replace("speed: 300", "speed: 300 x"), "problem.yaml")
    _, (missing, _) = read(path)
    assert (missing.line, missing.column, missing.key) == (3, 21, "design.catalogue") or missing.line == 2
    file(HEAD + "\nA,-400,20\n")
    _, found = read(path)
    assert {(each.path.rpartition("/")[2], each.line) for each in found} == {("dampers.csv", 2), ("problem.yaml", 2)}


def test_a_file_that_is_not_there(file):
    _, (found,) = read(file(PROBLEM, "problem.yaml"))
    assert (found.line, found.column, found.key) == (3, 21, "design.catalogue")
    assert "dampers.csv cannot be read: No such file" in found.message


def inline(rows):
    return yd.loads(f"bogie: {{base: table1}}\nspeed: 300 km/h\ndesign:\n  catalogue: {rows}\n")


def test_dampers_in_the_problem_file_and_back():
    problem = inline("[{name: A, damping: 400 kN s/m, stiffness: rigid}, {name: B, damping: 3, stiffness: 4}]")
    assert [each.name for each in problem.design.catalogue] == ["A", "B"]
    written = problem.to_dict()
    assert written["design"]["catalogue"][0] == {"name": "A", "damping": 4e5, "stiffness": "rigid", "per_side": 1}
    assert yd.loads(json.dumps({key: written[key] for key in ("bogie", "speed", "design")})).design == problem.design
    assert "catalogue" not in yd.table1().to_dict()["design"]


@pytest.mark.parametrize(
    ("rows", "column", "says"),
    [
        ("[]", 14, "has no damper in it"),
        ("", 3, "has no value"),
        ("{name: A}", 14, "expected a catalogue"),
        ("[A]", 15, "is no damper"),
        ("[{name: A, damping: 3}]", 15, "stiffness is missing"),
        ("[{name: A, damping: -3, stiffness: 4}]", 34, "outside 0"),
        ("[{name: '', damping: 3, stiffness: 4}]", 22, "needs a name"),
        ("[{name: A, damping: 3, stiffness: 4}, {name: A, damping: 3, stiffness: 4}]", 59, "stands twice"),
        ("[{name: A, damping: 3, stiffness: 4, per_sid: 4}]", 60, "did you mean per_side?"),
        ("[{name: A, damping: 3 m, stiffness: 4}]", 34, "is a length"),
    ],
)
def test_mistakes_in_dampers_of_a_problem_file(rows, column, says):
    with pytest.raises(yd.ProblemError) as caught:
        inline(rows)
    (found,) = caught.value.diagnostics
    assert says in found.message
    assert (found.line, found.column) == (4, column)


def test_in_python_a_file_is_read_first():
    with pytest.raises(yd.ProblemError, match=r"design.catalogue: .*read_catalogue"):
        yd.Design(catalogue="dampers.csv")

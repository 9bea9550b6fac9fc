"""Every public function and constructor, every argument, every wrong type: the error names all three.

A new public name is tested by standing in ``__all__``; an argument that it needs gets a right value in `RIGHT`.
"""

import inspect
import pickle
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import yawdesign as yd
from yawdesign.problem.arguments import ArgumentError, checked, expected, fits
from yawdesign.problem.result import Result

# A number may be a speed that somebody meant in km/h: that is another test's matter.
pytestmark = pytest.mark.filterwarnings("ignore::yawdesign.problem.diagnostics.UnitWarning")


class Enough(BaseException):
    """The arguments were accepted: what follows need not be computed."""

    def __init__(self) -> None: ...


def enough(*_):
    raise Enough


WRONG = {
    "None": None,
    "a number": 5,
    "not a number": float("nan"),
    "a truth value": True,
    "a text": "no-such-thing",
    "a path": Path("/no/such/folder/file"),
    "bytes": b"abc",
    "a mapping": {"x": 1},
    "an empty list": [],
    "a list": ["x"],
    "a nested list": [[1.0], object],
    "an object": object(),
    "a class": Enough,
    "a function": len,
    "an array": np.full(3, np.nan),
    "a wide array": np.ones((2, 2)),
    "a complex number": 1j,
}

ALWAYS = {"progress", "only", "formats", *yd.PARAMETERS}

FUNCTIONS = [name for name in yd.__all__ if inspect.isfunction(getattr(yd, name))]
CLASSES = [
    name
    for name in yd.__all__
    if inspect.isclass(getattr(yd, name)) and not issubclass(getattr(yd, name), (Result, Exception))
]


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """Return right values of what functions need, and of what makes them quick, by function or for all."""
    folder, problem = tmp_path_factory.mktemp("arguments"), yd.table1()
    damper = yd.CatalogueDamper(name="x", damping=4e5, stiffness=2e7)
    uncertain = problem.replace(uncertainty={"lambda": {"uniform": [0.1, 0.2]}})
    choosing = problem.replace(design=yd.Design(catalogue=(damper,)))
    modes = yd.modes(problem)
    numbers = iter(range(10**6))
    return lambda name: {
        "problem": {"choose": choosing, "uncertainty": uncertain}.get(name, problem),
        "result": modes,
        "to": folder / f"{next(numbers)}{'.html' if name == 'report' else '.svg'}",
        "path": folder / f"{next(numbers)}.fmu",
        "text": "{bogie: {base: table1}, speed: 250 km/h}",
        "progress": enough,
        "only": ["dynamic_stiffness"],
        "formats": ["casadi"],
        "length": 200.0,
        "bogie": problem.bogie,
        "speed": 80.0,
        "min": 20.0,
        "max": 30.0,
        "spectrum": yd.SPECTRA["german-low"],
        "name": "x",
        **{"damping": 4e5, "stiffness": 2e7},
        "densities": {"alignment": np.ones_like},
        "is_angle": False,
        **dict.fromkeys(("distance", "alignment", "cross_level"), np.arange(9.0)),
        **{"R": 300, "L": 19, "l": 60, "V_r": 25},
        **{"I_b": 3e3, "K_1z": 1.2e6, "C_1z": 1e4, "h_1": 0.1, "h_2": 0.2, "h_2t": 0.1, "C_1x": 2e4, "C_1y": 2e4},
        **{"M_c": 34500.0, "J_c": 1.5e6, "I_c": 1.2e5, "h_s": 0.9, "h_t": 1.0, "K_2z": 6e5, "C_2z": 1e4},
        **{key.replace("lambda", "lambda_"): value for key, value in problem.bogie.parameters().items()},
        "axes": {"v": [50.0, 60.0]},
        "axis": {"v": [50.0, 60.0]},
        "options": {"mode": "wheelset hunting 1"} if name == "plot" else {"duration": 1.0},
    }


def arguments_of(public):
    return inspect.signature(public).parameters


def called(name, right, argument=None, value=None):
    """Call a public name with right arguments, but for one."""
    public, known, given = getattr(yd, name), right(name), {}
    for key, parameter in arguments_of(public).items():
        if parameter.kind is parameter.VAR_KEYWORD:
            given |= known[key] if key != argument else dict.fromkeys(known[key], value)
        elif key in known and (parameter.default is parameter.empty or key in ALWAYS):
            given[key] = known[key]
        elif parameter.default is parameter.empty:
            pytest.fail(f"{name} needs {key}: give a right value for it in this test")
        if argument == key == "offset":
            given["start"] = "offset"
        if key == argument and parameter.kind is not parameter.VAR_KEYWORD:
            given[key] = value
    with suppress(Enough, yd.IncompleteSweepError):
        public(**given)


def names(public, argument, value, text):
    """Return whether a message says which argument it is about; a file is called by its name."""
    called = {"only": "function", "formats": "format", "axes": "v", "axis": "v", "options": "mode|duration"}
    words = [argument.rstrip("_"), *called.get(argument, "").split("|")]
    is_file = isinstance(value, (str, Path)) and Path(value).name in text
    return is_file or any(re.search(rf"(?<!\w){word}(?!\w)", text) for word in words if word)


def shows(value, text):
    """Return whether a message says what came: the value, an entry of it, or its type."""
    several = [*value] if isinstance(value, (list, dict, np.ndarray)) else []
    said = [type(value).__name__, *(" ".join(show(x).split())[:20] for x in (value, *several) for show in (repr, str))]
    text = " ".join(text.replace("\\n", " ").split())  # an array is written in several lines
    said += SAID_OF.get(str(value), ())
    return any(word.casefold() in text.casefold() for word in (*said, "single value", "dimensions", "two values"))


SAID_OF = {"None": ("no value", "missing"), "[]": ("empty", "no "), "/no/such/folder/file": ("/no/such/folder", "file")}


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES])
def test_right_arguments_are_accepted(name, right):
    if "path" not in arguments_of(getattr(yd, name)) or name == "write_fmu":
        called(name, right)


@pytest.mark.parametrize(
    ("name", "argument"), [(n, key) for n in [*FUNCTIONS, *CLASSES] for key in arguments_of(getattr(yd, n))]
)
def test_a_wrong_argument_is_named(name, argument, right, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a text may be the name of a file to write
    missed = []
    for kind, value in WRONG.items():
        try:
            called(name, right, argument, value)
        except (yd.ProblemError, TypeError, ValueError, OSError) as error:
            text = str(error)
            if not names(getattr(yd, name), argument, value, text) or not shows(value, text):
                missed.append(f"{kind}: {type(error).__name__}: {text}")
        except Exception as error:  # noqa: BLE001 - that is what must not come
            missed.append(f"{kind}: {type(error).__name__}: {error}")
    assert not missed, "\n".join(missed)


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES])
def test_an_unknown_name_gets_the_nearest(name, right):
    public = getattr(yd, name)
    names = [key for key, parameter in arguments_of(public).items() if parameter.kind is not parameter.VAR_KEYWORD]
    if len(names) == len(arguments_of(public)) > 0:
        wrong = names[-1] + "_"
        given = {key: right(name)[key] for key in names[:-1] if key in right(name)}
        with pytest.raises(TypeError, match=f"{wrong}.*did you mean {names[-1]}"):
            public(**given, **{wrong: None})


@pytest.mark.parametrize("name", FUNCTIONS)
def test_public_functions_go_to_other_processes(name):
    assert pickle.loads(pickle.dumps(getattr(yd, name))) is getattr(yd, name)


def test_the_example_of_a_problem_that_is_a_file_name():
    with pytest.raises(ArgumentError) as caught:
        yd.design("problem.yaml")
    assert str(caught.value) == (
        "error: problem: expected a Problem (yawdesign.load reads one from a file, yawdesign.loads from a text), "
        "got 'problem.yaml' (str)"
    )
    assert isinstance(caught.value, (TypeError, yd.ProblemError))


def test_all_mistakes_at_once():
    with pytest.raises(ArgumentError) as caught:
        yd.optimise("x", seed="y", progress=3)
    assert [d.key for d in caught.value.diagnostics] == ["problem", "seed", "progress"]
    with pytest.raises(ArgumentError, match="problem"):
        yd.design()
    with pytest.raises(ArgumentError, match="too many"):
        yd.design(1, 2)


@pytest.mark.parametrize(
    ("hint", "good", "bad", "words"),
    [
        (int, np.int64(3), 3.0, "a whole number"),
        (float, np.float32(3), True, "a number"),
        (str | None, None, 1, "a text or None"),
        (dict[str, int], {"x": 1}, {"x": "1"}, "a dict"),
        (list[str] | str, ["a"], ["a", 1], "a list or a text"),
    ],
)
def test_hints(hint, good, bad, words):
    assert fits(good, hint)
    assert not fits(bad, hint)
    assert expected(hint) == words


def test_a_class_may_be_checked_by_its_hints():
    @checked
    class Thing:
        def __init__(self, size: float) -> None:
            self.size = size

    assert Thing(size=2.0).size == 2.0
    with pytest.raises(ArgumentError, match="size: expected a number, got 'x'"):
        Thing("x")


@pytest.mark.parametrize("field", ["bogie", "speed", "curve", "design", "title", "equations", "C_s", "lambda_"])
def test_a_wrong_replacement_is_named(field):
    for value in WRONG.values():
        with suppress(yd.ProblemError):
            assert yd.table1().replace(**{field: value}) is not None
    with pytest.raises(yd.ProblemError, match=field.rstrip("_")):
        yd.table1().replace(**{field: object()})

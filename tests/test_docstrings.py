"""Docstrings of what is public: every argument and every field is described, and every physical number has its unit."""

import dataclasses
import inspect
import re
import typing
from pathlib import Path

import pytest

import yawdesign as yd
from yawdesign.problem.running import CURVE
from yawdesign.problem.units import UnitError, parse_unit
from yawdesign.study.axes import ROWS
from yawdesign.study.request import UNITS
from yawdesign.vehicle.vehicle import Model

NUMBER = re.compile(r"float|complex|ndarray")
NO_NUMBERS = re.compile(r"Callable\[\[.*?\]|ndarray\[[^]]*\]?, numpy.dtype\[numpy.(bool|str)")
# What an untyped argument takes, by the type in words that stands in the docstring.
WORDS = re.compile(r"\b(float|complex|number|numbers)\b")
# Where the unit depends on a key or stands in another field: "in SI", "[`unit`]".
ELSEWHERE = re.compile(r"\bSI\b|\[`\w+`\]")


def units_by_name():
    """Return the unit of every name that means the same everywhere: of the table, of sweeps, of the state space."""
    bogie = yd.table1().bogie
    space = Model().at({**bogie.parameters(), "v": 80.0}).state_space
    names, units = (*space.states, *space.inputs, *space.outputs), (space.state_units, space.input_units)
    signals = dict(zip(names, (*units[0], *units[1], *space.output_units), strict=True))
    rows = {key: "Hz" if row.unit == "Hz" else row.si for key, row in {**CURVE, **ROWS}.items()}
    return {**UNITS, **signals, **rows, "lambda_": "-", "speed": "m/s", "eigenvalue": "1/s", "frequency": "Hz"}


UNIT_OF = units_by_name()


@dataclasses.dataclass
class Entry:
    """What a docstring says of an argument or a field, and of those that share its description."""

    names: tuple[str, ...]
    kind: str
    text: str = ""


def entries(text):
    """Return what stands in the sections on arguments and fields of a numpydoc text, by name."""
    found, section, lines = {}, "", inspect.cleandoc(text or "").splitlines()
    for k, line in enumerate(lines):
        if k + 1 < len(lines) and re.fullmatch("-{3,}", lines[k + 1]):
            section = line
        elif section in ("Parameters", "Attributes") and line and not re.fullmatch("-{3,}", line):
            if not line.startswith(" "):
                head, _, kind = line.partition(" : ")
                entry = Entry(tuple(name.strip().strip("*`") for name in head.split(",")), kind)
                found |= dict.fromkeys(entry.names, entry)
            else:
                entry.text += f" {line.strip()}"
    return found


def units_in(text):
    """Return the units that stand in square brackets in a text."""
    for written in re.findall(r"\[([^][]+)\]", text):
        try:
            parse_unit(written)
        except UnitError:
            continue
        yield written


def measure(unit):
    """Return what makes a unit the same as another."""
    parsed = parse_unit(unit)
    return parsed.factor, parsed.dimension, parsed.angle, "Hz" in unit


def unit_faults(name, entry, annotation, known=UNIT_OF):
    """Yield what is wrong with the unit of an argument, a field or a property."""
    if not NUMBER.search(NO_NUMBERS.sub("", annotation)) and not WORDS.search(entry.kind):
        return
    units = list(units_in(entry.text))
    if not units and not ELSEWHERE.search(entry.text):
        yield f"{name} ({annotation or entry.kind}) has no unit: {entry.text.strip()!r}"
    if len(entry.names) == len(units):
        units = [units[entry.names.index(name)]]
    if units and name in known and measure(known[name]) not in map(measure, units):
        yield f"{name} is in {known[name]}, not in {', '.join(units)}"


def shown(annotation):
    return "" if annotation is inspect.Parameter.empty else inspect.formatannotation(annotation)


def faults_of(described, annotations, known=UNIT_OF):
    """Yield what is wrong with the descriptions of arguments or fields."""
    for name, annotation in annotations.items():
        if name not in described:
            yield f"{name} is not described"
        else:
            yield from unit_faults(name, described[name], annotation, known)


def annotations_of(function):
    parameters = inspect.signature(function).parameters
    return {name: shown(x.annotation) for name, x in parameters.items() if name not in ("self", "cls")}


def faults_of_function(function):
    return faults_of(entries(inspect.getdoc(function)), annotations_of(function))


def faults_of_class(cls):
    """Yield what is wrong with the docstrings of a class, of its properties, and of its methods that have sections."""
    own = [base for base in cls.__mro__ if base.__module__.startswith("yawdesign")]
    described = {name: entry for base in reversed(own) for name, entry in entries(base.__doc__).items()}
    yield from faults_of(described, annotations_of(cls))
    for name, member in ((name, member) for base in own for name, member in vars(base).items()):
        if isinstance(member, property) and not name.startswith("_"):
            annotation = shown(inspect.signature(member.fget).return_annotation)
            yield from unit_faults(name, Entry((name,), "", inspect.getdoc(member) or ""), annotation)
        elif inspect.isfunction(member) and entries(inspect.getdoc(member)):
            found = faults_of(entries(inspect.getdoc(member)), annotations_of(member), {})
            yield from (f"{name}: {fault}" for fault in found)


def parts(hint):
    """Yield the dataclasses of this package that a type hint names."""
    if dataclasses.is_dataclass(hint) and hint.__module__.startswith("yawdesign"):
        yield hint
    for inner in typing.get_args(hint):
        yield from parts(inner)


def with_parts(classes):
    """Return classes and all classes of what they contain."""
    found, new = set(), set(classes)
    while new:
        found |= new
        hints = [hint for cls in new if dataclasses.is_dataclass(cls) for hint in typing.get_type_hints(cls).values()]
        new = {part for hint in hints for part in parts(hint)} - found
    return sorted(found, key=lambda cls: cls.__name__)


PUBLIC = {name: getattr(yd, name) for name in yd.__all__}
FUNCTIONS = {name: public for name, public in PUBLIC.items() if inspect.isfunction(public)}
CLASSES = with_parts(public for public in PUBLIC.values() if inspect.isclass(public))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_arguments_are_described_with_their_units(name):
    assert not list(faults_of_function(FUNCTIONS[name]))


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_fields_are_described_with_their_units(cls):
    assert not list(faults_of_class(cls))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_is_returned_is_described(name):
    returned = inspect.signature(FUNCTIONS[name]).return_annotation
    assert returned is None or re.search("^Returns\n-{7}\n", inspect.getdoc(FUNCTIONS[name]), re.MULTILINE)


def test_every_part_of_a_result_stands_in_the_reference():
    pages = "".join(page.read_text(encoding="utf-8") for page in Path(__file__).parents[1].glob("docs/api/*.md"))
    named = set(re.findall(r"^\.\. auto\w+:: yawdesign\.(?:\w+\.)*(\w+)$", pages, re.MULTILINE))
    asked = {"Condition", "Model", "Question", "Request", "Task"}  # what was asked, as workers get it
    assert {cls.__name__ for cls in CLASSES} - asked - named == set()


def test_faults_are_found():
    def drive(speed: float, distance: float, gauge: float, name: str) -> None:
        """Go.

        Parameters
        ----------
        speed, distance : float
            How fast [km/h] and how far [m].
        gauge : float
            Of the rails.
        """

    assert list(faults_of_function(drive)) == [
        "speed is in m/s, not in km/h",
        "gauge (float) has no unit: 'Of the rails.'",
        "name is not described",
    ]
    assert {"Sweep", "Axis", "Mode", "History"} <= {cls.__name__ for cls in CLASSES}

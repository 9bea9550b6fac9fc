"""The text of a problem file from its data: in the units people use, with what each key means."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.nodes import ScalarNode

from .condition import CREEP_FACTOR
from .damper_catalogue import QUANTITIES
from .diagnostics import ProblemError
from .document import compose
from .faults import TOP
from .parameters import BOGIE, CAR_BODY, PARAMETERS
from .quantities import decimal_text
from .requirements import MEASURES
from .running import CURVE, SPEED
from .table import Parameter

FIRST_LINE = "# yaml-language-server: $schema=problem.schema.json"
_WIDTH = 200
_COMMENTS_AT = 30  # column


class _Plain(str):
    """A text that needs no quotes: a number with its unit, or a word of a problem file."""

    __slots__ = ()


def problem_text(data: Mapping[str, Any]) -> str:
    """Return the text of a problem file.

    Parameters
    ----------
    data : mapping
        With the keys of a problem file and exact numbers in SI.

    Raises
    ------
    ProblemError
        If it is larger than a problem file may be.
    """
    parts = CommentedMap()
    for key in TOP:
        if data.get(key):
            parts[key] = _PARTS[key](data[key])
    for key in [*parts][1:]:
        parts.yaml_set_comment_before_after_key(key, before="\n")
    text = f"{FIRST_LINE}\n\n{_dumped(parts)}"
    try:
        compose(text, "the problem")
    except ProblemError as error:
        why = error.diagnostics[0].message
        raise ProblemError(f"the problem cannot be written as one file: {why}; is the catalogue that large?") from None
    return text


def _dumped(parts: CommentedMap) -> str:
    yaml = YAML()
    yaml.width = _WIDTH
    yaml.indent(mapping=2, sequence=4, offset=2)

    def represent(representer: Any, text: _Plain) -> Any:
        tag = yaml.resolver.resolve(ScalarNode, str(text), (True, False))
        return representer.represent_scalar(tag, str(text))

    yaml.representer.add_representer(_Plain, represent)
    stream = io.StringIO()
    yaml.dump(parts, stream)
    return stream.getvalue()


def _quantity(row: Parameter, value: Any) -> Any:
    """Return a value of a row of the table as a text with its unit; what is a text already stays."""
    if isinstance(value, str):
        return _Plain(value)
    unit = "%" if row.key == "damping_ratio" else row.unit.strip("-")
    if unit:
        return _Plain(f"{decimal_text(value, unit)} {unit}")
    return _Plain(decimal_text(value).replace(" ", ""))


def _in_a_line(values: Mapping[str, Any]) -> CommentedMap:
    found = CommentedMap(values)
    found.fa.set_flow_style()
    return found


def _listed(row: Parameter, values: Iterable[Any]) -> CommentedSeq:
    found = CommentedSeq(_quantity(row, value) for value in values)
    found.fa.set_flow_style()
    return found


def _taken(row: Parameter, value: Any) -> Any:
    """Return a value, a list of values or a range."""
    if isinstance(value, Mapping):
        return _in_a_line({key: value[key] if key == "steps" else _quantity(row, value[key]) for key in value})
    return _listed(row, value) if isinstance(value, (list, tuple)) else _quantity(row, value)


def _block(rows: Mapping[str, Parameter]) -> Callable[[Mapping[str, Any]], CommentedMap]:
    """Return what writes bogie or car body: a line for each key, with its meaning."""

    def block(values: Mapping[str, Any]) -> CommentedMap:
        found = CommentedMap()
        for key, value in values.items():
            found[key] = _quantity(rows[key], value) if key in rows else value
            if key in rows:
                found.yaml_add_eol_comment(rows[key].meaning, key, column=_COMMENTS_AT)
        return found

    return block


def _curve(values: Mapping[str, Any]) -> CommentedMap:
    return _in_a_line({key: _quantity(CURVE[key], x) if key in CURVE else x for key, x in values.items()})


def _sets(sets: Mapping[str, Mapping[str, Any]]) -> CommentedMap:
    """Return named sets of values of parameters: faults or loads."""
    return CommentedMap(
        {name: _in_a_line({key: _of_parameter(key, x) for key, x in values.items()}) for name, values in sets.items()}
    )


def _of_parameter(key: str, value: Any) -> Any:
    return _taken(_ROWS[key.rpartition(".")[2]], value)


def _conditions(values: Mapping[str, Any]) -> CommentedMap:
    found = CommentedMap()
    for key, value in values.items():
        if key == "load":
            found[key] = _sets(value)
        elif key == "tolerance":
            found[key] = _in_a_line({name: _Plain(share) for name, share in value.items()})
        else:
            found[key] = _of_parameter(key, value)
    return found


def _requirements(values: Mapping[str, Any]) -> CommentedMap:
    return CommentedMap(
        {key: _requirements(x) if key == "cases" else _quantity(MEASURES[key], x) for key, x in values.items()}
    )


def _design(values: Mapping[str, Any]) -> CommentedMap:
    found = CommentedMap({"objective": values["objective"]})
    bounds = values.get("variables", {})
    found["variables"] = CommentedMap({key: _of_parameter(key, bounds[key]) for key in bounds})
    if "catalogue" in values:
        found["catalogue"] = CommentedSeq(_in_a_line(dict(_damper(each))) for each in values["catalogue"])
    return found


def _damper(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    yield from ((key, _quantity(QUANTITIES[key], x) if key in QUANTITIES else x) for key, x in values.items())


def _uncertainty(values: Mapping[str, Mapping[str, Any]]) -> CommentedMap:
    return CommentedMap(
        {name: _in_a_line({k: _of_parameter(name, x) for k, x in values[name].items()}) for name in values}
    )


_ROWS: Mapping[str, Parameter] = {**PARAMETERS, CREEP_FACTOR.key: CREEP_FACTOR, SPEED.key: SPEED}
_PARTS: Mapping[str, Callable[[Any], Any]] = {
    "title": str,
    "equations": str,
    "bogie": _block(BOGIE),
    "car_body": _block(CAR_BODY),
    "speed": lambda value: _taken(SPEED, value),
    "curve": _curve,
    "conditions": _conditions,
    "cases": _sets,
    "requirements": _requirements,
    "design": _design,
    "uncertainty": _uncertainty,
}

"""The JSON Schema of a problem file, for completion, hover texts and checks in an editor."""

from __future__ import annotations

from typing import Any

from .file_shape import problem_model
from .parameters import MOTOR_KEYS, PARAMETERS, parameter_keys

_TRAILER = {"required": ["kind"], "properties": {"kind": {"const": "trailer"}}}
_PRESET = {"required": ["base"]}
SCHEMA_FILE = "problem.schema.json"  # the name that the first line of a problem file refers to


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a problem file.

    It is generated from the same models that read the file. It knows keys, choices, ranges of plain numbers, names of
    units, and what the usual units measure; only reading the file checks unusual products of units and the range of
    texts with a unit.

    Returns
    -------
    dict
        The schema, ready for ``json.dumps``.

    Examples
    --------
    >>> sorted(schema()["required"])
    ['bogie', 'speed']
    """
    texts: dict[str, Any] = {}
    found = _shared(_tidied(problem_model("power").model_json_schema()), texts)
    found["$defs"] |= texts
    bogie = found["$defs"]["Bogie"]
    bogie.pop("required")
    bogie["allOf"] = _bogie_rules()
    found["allOf"] = [_variables_rule()]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **found, "title": "yawdesign problem"}


def _tidied(part: Any) -> Any:
    """Remove the titles pydantic makes up and the null defaults of keys that may be left out."""
    if isinstance(part, list):
        return [_tidied(item) for item in part]
    if not isinstance(part, dict):
        return part
    made_up = {"title": isinstance(part.get("title"), str), "default": part.get("default") is None}
    return {key: _tidied(value) for key, value in part.items() if not made_up.get(key)}


def _shared(part: Any, texts: dict[str, Any]) -> Any:
    """Move the texts with a unit into `texts`, and put references in their place: their patterns are long."""
    if isinstance(part, list):
        return [_shared(item, texts) for item in part]
    if not isinstance(part, dict):
        return part
    if "pattern" in part:
        name = part["description"].removeprefix("a ").replace(" ", "-")
        texts[name] = part
        return {"$ref": f"#/$defs/{name}"}
    return {key: _shared(value, texts) for key, value in part.items()}


def _bogie_rules() -> list[dict[str, Any]]:
    """Return which parameters must be there: none with a preset, those of the motors only where there are motors."""
    always = [key for key in parameter_keys("trailer") if not PARAMETERS[key].optional]
    motors = {"if": _PRESET, "else": {"required": list(MOTOR_KEYS)}}
    return [
        {"if": _PRESET, "else": {"required": always}},
        {"if": _TRAILER, "then": {"properties": dict.fromkeys(MOTOR_KEYS, False)}, "else": motors},
    ]


def _variables_rule() -> dict[str, Any]:
    no_motors = {"properties": dict.fromkeys(MOTOR_KEYS, False)}
    return {
        "if": {"properties": {"bogie": _TRAILER}},
        "then": {"properties": {"design": {"properties": {"variables": no_motors}}}},
    }

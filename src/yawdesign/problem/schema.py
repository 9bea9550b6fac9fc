"""The JSON Schema of a problem file, for completion, hover texts and checks in an editor."""

from __future__ import annotations

from typing import Any

from .models import problem_model
from .parameters import MOTOR_KEYS, PARAMETERS, parameter_keys

_TRAILER = {"required": ["kind"], "properties": {"kind": {"const": "trailer"}}}
_PRESET = {"required": ["base"]}


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a problem file.

    It is generated from the same models that read the file. It knows keys, choices, ranges of plain numbers and the
    shape of texts with a unit; only reading the file checks what a unit measures.

    Returns
    -------
    dict
        The schema, ready for ``json.dumps``.

    Examples
    --------
    >>> sorted(schema()["required"])
    ['bogie', 'speed']
    """
    found = _tidied(problem_model("power").model_json_schema())
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

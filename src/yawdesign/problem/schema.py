"""The JSON Schema of a problem file, for completion, hover texts and checks in an editor."""

from __future__ import annotations

from typing import Any

from .cases import BOGIES
from .condition import CREEP_FACTOR
from .creep import MADE
from .distributions import MOST_LOGNORMAL, MOST_NORMAL
from .file_shape import problem_model, quantity_schema
from .parameters import BOGIE, CAR_BODY, MOTOR_KEYS, PARAMETERS, ROLL_KEYS, VERTICAL, parameter_keys
from .requirements import MEASURES

_TRAILER = {"required": ["kind"], "properties": {"kind": {"const": "trailer"}}}
_PRESET = {"required": ["base"]}
_SHARE = {
    "type": "string",
    "pattern": r"^\s*\d[\d _.]*\s*%\s*$",
    "description": "Share of the value as designed.",
    "examples": ["50 %"],
}
_NO_TOLERANCE = r"^\s*(-.*|0*(\.0*)?\s*%?|0*[1-9]\d{2,}(\.\d*)?\s*%)\s*$"  # less than nothing, nothing, 100 % and more
_TOLERANCE = {
    "description": "Share of its value by which it may deviate to either side.",
    "anyOf": [
        {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
        {"$ref": "#/$defs/plain-number", "not": {"pattern": _NO_TOLERANCE}},
    ],
    "examples": ["10 %"],
}
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
    found = _tidied(problem_model("power").model_json_schema())
    found["properties"]["conditions"] |= _conditions()
    found["properties"]["requirements"] |= _requirements()
    found = _shared(found, texts)
    found["$defs"] |= texts
    found["$defs"]["tolerance"] = _TOLERANCE
    bogie = found["$defs"]["Bogie"]
    bogie.pop("required")
    bogie["allOf"] = _bogie_rules()
    body = found["$defs"]["CarBody"]
    body["allOf"] = [{"if": _PRESET, "else": {"required": body.pop("required")}}]
    found["properties"]["cases"] |= _cases()
    found["properties"]["uncertainty"] |= _uncertainty()
    found["$defs"]["share"] = _SHARE
    found["allOf"] = [_trailer_rule(), _car_body_rule(), _cases_rule()]
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
    always = [key for key in parameter_keys("trailer") if not BOGIE[key].optional and key not in MADE]
    by_creep = {"required": ["creep"]}
    motors = {"if": _PRESET, "else": {"required": list(MOTOR_KEYS)}}
    own = [key for key in ROLL_KEYS if key not in VERTICAL]
    together = {key: [other for other in own if other != key] for key in own} | {"K_d1x": ["C_1x"], "K_d1y": ["C_1y"]}
    return [
        {"if": _PRESET, "else": {"required": always}},
        {"if": _TRAILER, "then": {"properties": dict.fromkeys(MOTOR_KEYS, False)}, "else": motors},
        {"dependentRequired": together},
        {"if": by_creep, "then": {"properties": dict.fromkeys(MADE, False)}},
        {"if": {"not": {"anyOf": [by_creep, _PRESET]}}, "then": {"required": list(MADE)}},
    ]


def _car_body_rule() -> dict[str, Any]:
    """Return what a car body excludes, and where the vertical stiffness of a rolling frame stands without one."""
    apart = {"bogie": {"properties": dict.fromkeys(VERTICAL, False)}, "equations": {"const": "reciprocal"}}
    together = {"I_b": list(VERTICAL)} | {key: ["I_b"] for key in VERTICAL}
    alone = {"bogie": {"dependentRequired": together}}
    return {"if": {"required": ["car_body"]}, "then": {"properties": apart}, "else": {"properties": alone}}


def _cases() -> dict[str, Any]:
    """Return what faults may be: changes of parameters of both bogies, of the car body, or of one bogie."""
    places = {key: f"#/$defs/Bogie/properties/{key}" for key in BOGIE}
    places |= {key: f"#/$defs/CarBody/properties/{key}" for key in CAR_BODY}
    values = {key: {"anyOf": [{"$ref": "#/$defs/share"}, {"$ref": place}]} for key, place in places.items()}
    same = "#/properties/cases/additionalProperties/properties"
    of_one = {f"{bogie}.{key}": {"$ref": f"{same}/{key}"} for bogie in BOGIES for key in BOGIE}
    changes = {"type": "object", "minProperties": 1, "additionalProperties": False, "properties": values | of_one}
    return {"type": "object", "additionalProperties": changes}


def _conditions() -> dict[str, Any]:
    """Return what conditions may be: values and ranges, tolerances, named loads."""
    values = {key: {"$ref": f"#/$defs/Bounds_{key}/properties/min"} for key in PARAMETERS if key != "C_s"}
    given = {key: _given(PARAMETERS[key].meaning, value, f"#/$defs/Bounds_{key}") for key, value in values.items()}
    one = "#/properties/conditions/properties/creep_factor/anyOf/0"
    ends = {"type": "object", "additionalProperties": False, "required": ["min", "max"]}
    factor = {**_given(CREEP_FACTOR.meaning, quantity_schema(CREEP_FACTOR)), "examples": [{"min": 0.5, "max": 1}]}
    factor["anyOf"][1]["items"] = {"$ref": one}
    factor["anyOf"].append({**ends, "properties": {"min": {"$ref": one}, "max": {"$ref": one}}})
    load = {"type": "object", "minProperties": 1, "additionalProperties": False, "properties": values}
    own = {
        CREEP_FACTOR.key: factor,
        "tolerance": {
            "description": "By which share of their values parameters may deviate, design variables too.",
            "type": "object",
            "minProperties": 1,
            "additionalProperties": False,
            "properties": {key: {"$ref": "#/$defs/tolerance"} for key in PARAMETERS},
        },
        "load": {
            "description": "Named sets of values, of which one at a time comes.",
            "type": "object",
            "minProperties": 1,
            "additionalProperties": load,
        },
    }
    return {"type": "object", "additionalProperties": False, "properties": given | own}


def _given(meaning: str, value: dict[str, Any], bounds: str = "") -> dict[str, Any]:
    """Return what may be given of a parameter: a value, several, or a range by its definition."""
    several = {"type": "array", "minItems": 1, "items": value}
    kinds = [value, several, *([{"$ref": bounds}] if bounds else [])]
    return {"description": f"{meaning[:1].upper()}{meaning[1:]}: values or a range.", "anyOf": kinds}


def _requirements() -> dict[str, Any]:
    """Return what may be required, of the design and of the faults."""
    place = "#/properties/requirements/properties"
    of_cases = {
        "description": "What every fault must reach.",
        "type": "object",
        "minProperties": 1,
        "additionalProperties": False,
        "properties": {key: {"$ref": f"{place}/{key}"} for key in MEASURES},
    }
    measures = {key: quantity_schema(row) for key, row in MEASURES.items()}
    return {"type": "object", "additionalProperties": False, "properties": {**measures, "cases": of_cases}}


def _cases_rule() -> dict[str, Any]:
    """Return that what faults must reach needs faults."""
    wanted = {"requirements": {"required": ["cases"]}}
    some = {"required": ["cases"], "properties": {"cases": {"minProperties": 1}}}
    return {"if": {"required": ["requirements"], "properties": wanted}, "then": some}


def _uncertainty() -> dict[str, Any]:
    """Return what distributions may be; what the ends of a uniform one measure is only checked by reading the file."""
    end = {"anyOf": [{"type": "number"}, {"type": "string"}]}
    kinds: dict[str, Any] = {"uniform": {"type": "array", "minItems": 2, "maxItems": 2, "items": end}}
    for kind, most in (("normal", MOST_NORMAL), ("lognormal", MOST_LOGNORMAL)):
        number = {"type": "number", "exclusiveMinimum": 0, "maximum": most}
        kinds[kind] = {"anyOf": [{"$ref": "#/$defs/share"}, number]}
    one = {"type": "object", "minProperties": 1, "maxProperties": 1, "additionalProperties": False, "properties": kinds}
    names = [*dict.fromkeys((*BOGIE, *CAR_BODY)), CREEP_FACTOR.key, "speed"]
    return {"type": "object", "propertyNames": {"enum": names}, "additionalProperties": one}


def _trailer_rule() -> dict[str, Any]:
    """Return that a trailer bogie has no motors to be changed."""
    no_motors: dict[str, Any] = {"properties": dict.fromkeys(MOTOR_KEYS, False)}
    conditions = {"properties": {**no_motors["properties"], "tolerance": no_motors}}
    return {
        "if": {"properties": {"bogie": _TRAILER}},
        "then": {"properties": {"design": {"properties": {"variables": no_motors}}, "conditions": conditions}},
    }
